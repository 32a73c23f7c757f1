//! What bytes on the wire mean, for the traffic view.

use brushwork_protocol::packet_serial::{
    FramerEvent, Generation, ReplyProgress, Request, RequestFramer, parse_reply,
};
use brushwork_protocol::packet_serial::{describe_event, describe_reply, hex};
use std::time::Duration;

/// The requests that a write holds, in words; a stop is several.
pub fn describe_sent(bytes: &[u8], generation: Generation) -> String {
    let told: Vec<_> =
        events(bytes, generation).iter().map(|event| describe_event(event, generation)).collect();
    if told.is_empty() { hex(bytes) } else { told.join("; ") }
}

/// What came after a write, in words: read as the reply to its last request, else as plain bytes.
pub fn describe_received(sent: &[u8], reply: &[u8], generation: Generation) -> String {
    let Some(request) = last_request(sent, generation) else { return hex(reply) };
    match parse_reply(&request, generation, reply) {
        ReplyProgress::Done { values, used } if used == reply.len() => {
            describe_reply(&request, &values, generation)
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
    }
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
    use crate::testing::{reply_to, with_crc};

    const G1: Generation = Generation::Gen1;

    #[test]
    fn requests_and_replies_are_told_in_words() {
        // 0x80, command 24, no CRC; then 24.3 V.
        let request = [0x80, 24];
        assert!(describe_sent(&request, G1).contains("main battery"), "{}", describe_sent(&request, G1));
        let told = describe_received(&request, &reply_to(&request, &[0x00, 0xF3]), G1);
        assert!(told.contains("24.3"), "{told}");
    }

    #[test]
    fn a_stop_is_told_packet_by_packet() {
        let duty_zero = with_crc(&[0x80, 54, 0, 0, 0x00, 0x09, 0xFF, 0xFF, 0, 0, 0x00, 0x09, 0xFF, 0xFF]);
        let told = describe_sent(&[with_crc(&[0x80, 249]), duty_zero].concat(), G1);
        assert!(told.contains("stop script") && told.contains("; ") && told.contains("duty"), "{told}");
    }

    #[test]
    fn what_is_no_reply_is_shown_as_it_came() {
        let request = [0x80, 24];
        for (reply, word) in [
            (&[0x00][..], "part of a reply"),
            (&[0, 1, 2, 3], "checksum"),
            (&[0x00, 0xF3, 0xE8, 0x86, 9], "then 09"),
        ] {
            let told = describe_received(&request, reply, G1);
            assert!(told.contains(word), "{told}");
        }
        let ack = with_crc(&[0x80, 249]);
        assert!(describe_received(&ack, &[0x11], G1).contains("no reply to it"));
        assert_eq!(describe_received(&[], &[0xAB], G1), "AB");
    }
}
