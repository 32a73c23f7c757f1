//! Any bytes with any pauses into a controller: no panic, and after a silence a valid request is taken.
#![no_main]

use std::time::Duration;

use brushwork_mcp_wire::packet_serial::{FramerEvent, Generation, PACKET_GAP, RequestFramer, describe_event, encode_reply_named};
use brushwork_values::Kind;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&first, arrivals)) = data.split_first() else { return };
    let generation = Generation::ALL[usize::from(first % 4)];
    let mut framer = RequestFramer::new(generation);
    let mut now = Duration::ZERO;
    for arrival in arrivals.chunks_exact(2) {
        // The low bits of the second byte are the pause in milliseconds, mostly none.
        now += Duration::from_millis(u64::from(arrival[1].saturating_sub(240)));
        let Some(event) = framer.feed(arrival[0], now) else { continue };
        let _ = describe_event(&event, generation);
        if let FramerEvent::Request(framed) = event {
            if framed.native {
                let again = framed.request().encode(generation).expect("what was framed can be sent");
                // Padding behind a serial number need not be zero; everything else is given back to the byte.
                let padded = framed
                    .values
                    .fields()
                    .iter()
                    .any(|field| matches!(field.kind, Kind::Ascii36 | Kind::Utf16Le36));
                assert!(again.len() == framed.raw.len() && (padded || again == *framed.raw));
            }
            let _ = encode_reply_named(&framed.request(), generation, |_| Some(0.into()));
        }
    }
    now += PACKET_GAP + Duration::from_nanos(1);
    framer.feed(0x80, now);
    assert!(matches!(framer.feed(0x15, now), Some(FramerEvent::Request(_))));
});
