//! What bytes on the wire mean, for the traffic view.

use brushwork_link::device::Described;
use brushwork_mcp_wire::packet_serial::{
    ACK, FramerEvent, Generation, ReplyProgress, Request, RequestFramer, parse_reply,
};
use brushwork_mcp_wire::packet_serial::{describe_event, describe_reply};
use brushwork_values::hex;
use std::time::Duration;

/// The requests that a write holds, in words; a stop is several.
pub fn describe_sent(bytes: &[u8], generation: Generation) -> Described {
    let events = events(bytes, generation);
    let reported: Vec<_> = events.iter().map(|event| describe_event(event, generation)).collect();
    let text = if reported.is_empty() { hex(bytes) } else { reported.join("; ") };
    let is_request = |event: &FramerEvent| matches!(event, FramerEvent::Request(_));
    Described { text, sound: !events.is_empty() && events.iter().all(is_request) }
}

/// What came after a write, in words: read as the reply to its last request, else as plain bytes.
pub fn describe_received(sent: &[u8], reply: &[u8], generation: Generation) -> Described {
    let Some(request) = last_request(sent, generation) else {
        return Described { text: hex(reply), sound: false };
    };
    let text = match parse_reply(&request, generation, reply) {
        ReplyProgress::Done { values, used } if used == reply.len() => {
            return Described { text: describe_reply(&request, &values, generation), sound: true };
        }
        ReplyProgress::Done { values, used } => {
            format!("{}, then {}", describe_reply(&request, &values, generation), hex(&reply[used..]))
        }
        ReplyProgress::BadCrc { expected, got, .. } => {
            format!("checksum {got:04X} instead of {expected:04X}: {}", hex(reply))
        }
        ReplyProgress::BadAck { .. } | ReplyProgress::Malformed { .. } => {
            format!("no reply to it: {}", hex(reply))
        }
        ReplyProgress::NeedMore { .. } => format!("part of a reply: {}", hex(reply)),
    };
    // Each of several writes at once is acknowledged with one byte.
    let acknowledgements = reply.len() > 1 && reply.iter().all(|byte| *byte == ACK);
    Described { text, sound: acknowledgements }
}

fn last_request(sent: &[u8], generation: Generation) -> Option<Request> {
    events(sent, generation).into_iter().rev().find_map(|event| match event {
        FramerEvent::Request(framed) => Some(framed.request()),
        FramerEvent::Discarded(_) => None,
    })
}

/// What a controller would make of a write, all of it sent at once.
fn events(bytes: &[u8], generation: Generation) -> Vec<FramerEvent> {
    let mut framer = RequestFramer::new(generation);
    let mut events: Vec<_> = bytes.iter().filter_map(|byte| framer.feed(*byte, Duration::ZERO)).collect();
    events.extend(framer.silence(Duration::from_secs(1)));
    events
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::testing::{reply_to, with_crc};

    const G1: Generation = Generation::Gen1;

    #[test]
    fn requests_and_replies_are_told_in_words() {
        // 0x80, command 24, no CRC; then 24.3 V.
        let request = [0x80, 24];
        let sent = describe_sent(&request, G1);
        assert!(sent.text.contains("main battery") && sent.sound, "{sent:?}");
        let reported = describe_received(&request, &reply_to(&request, &[0x00, 0xF3]), G1);
        assert!(reported.text.contains("24.3") && reported.sound, "{reported:?}");
    }

    #[test]
    fn a_stop_is_told_packet_by_packet() {
        let duty_zero = with_crc(&[0x80, 54, 0, 0, 0x00, 0x09, 0xFF, 0xFF, 0, 0, 0x00, 0x09, 0xFF, 0xFF]);
        let stop = [with_crc(&[0x80, 249]), duty_zero].concat();
        let reported = describe_sent(&stop, G1);
        assert!(reported.sound, "{reported:?}");
        let reported = reported.text;
        assert!(
            reported.contains("stop script") && reported.contains("; ") && reported.contains("duty"),
            "{reported}"
        );
        assert!(describe_received(&stop, &[0xFF, 0xFF], G1).sound);
    }

    #[test]
    fn what_is_no_reply_is_shown_as_it_came() {
        let request = [0x80, 24];
        for (reply, word) in [
            (&[0x00][..], "part of a reply"),
            (&[0, 1, 2, 3], "checksum"),
            (&[0x00, 0xF3, 0xE8, 0x86, 9], "then 09"),
        ] {
            let reported = describe_received(&request, reply, G1);
            assert!(reported.text.contains(word) && !reported.sound, "{reported:?}");
        }
        let ack = with_crc(&[0x80, 249]);
        assert!(describe_received(&ack, &[0x11], G1).text.contains("no reply to it"));
        assert_eq!(describe_received(&[], &[0xAB], G1).text, "AB");
    }
}
