//! The frames that an adapter carries, in words for the traffic view.

use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_link::device::Described;
use brushwork_mcp_wire::canopen::describe_frame;
use brushwork_values::hex;

/// The frames in bytes of an adapter, in words.
#[must_use]
pub fn describe(bytes: &[u8], form: Form) -> Described {
    let mut decoder = Decoder::new(form);
    let frames = decoder.feed_all(bytes);
    if frames.is_empty() {
        return Described { text: hex(bytes), sound: false };
    }
    let text = frames.iter().map(describe_frame).collect::<Vec<_>>().join("; ");
    Described { text, sound: decoder.discarded() == 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn traffic_is_told_in_words() {
        let reported = describe(b":S703N05;", Form::Ascii);
        assert_eq!((reported.text.as_str(), reported.sound), ("node 3 heartbeat: operational", true));
        assert_eq!(describe(b"x", Form::Ascii).text, "78");
    }
}
