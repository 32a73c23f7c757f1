//! What bytes on the wire mean, for the traffic view and the terminal: lines of triplets, and what they are to the host library.

use brushwork_link::device::Described;
use brushwork_motorvator_wire::host::{HostAnswer, HostOrder};
use brushwork_motorvator_wire::{LINE_END, Order, bytes_text, parse_line_of_board};
use brushwork_values::hex;

/// The lines that a write holds, in words.
#[must_use]
pub fn describe_sent(bytes: &[u8]) -> Described {
    let lines = bytes.strip_suffix(&[LINE_END]);
    let each = lines.unwrap_or(bytes).split(|byte| *byte == LINE_END);
    let (words, sound): (Vec<String>, Vec<bool>) = each.map(describe_line).unzip();
    Described { text: words.join(", "), sound: lines.is_some() && sound.iter().all(|sound| *sound) }
}

fn describe_line(line: &[u8]) -> (String, bool) {
    match Order::of_line(line) {
        Some(Order::Data(frame)) => match HostOrder::parse(&frame) {
            Some((order, number)) => (format!("order {number}: {order}"), true),
            None => (Order::Data(frame).describe(), true),
        },
        Some(order @ (Order::Go | Order::Help | Order::Ignored)) => (order.describe(), true),
        Some(Order::Unknown) => (format!("{}: {}", Order::Unknown.describe(), plain(line)), false),
        None => ("an empty line".to_owned(), false),
    }
}

/// What came, in words, line by line.
#[must_use]
pub fn describe_received(reply: &[u8]) -> Described {
    let mut words = Vec::new();
    let mut sound = !reply.is_empty();
    for line in reply.split_inclusive(|byte| *byte == LINE_END) {
        let whole = line.strip_suffix(&[LINE_END]);
        let line = whole.unwrap_or(line);
        let line = line.strip_prefix(b"\n").unwrap_or(line);
        match (HostAnswer::parse(line), parse_line_of_board(line)) {
            (Some(answer), _) => words.push(answer.to_string()),
            (None, Some(bytes)) => words.push(format!("frame {}", bytes_text(&bytes))),
            (None, None) if line.is_empty() => continue,
            (None, None) => words.push(plain(line)),
        }
        sound &= whole.is_some();
    }
    Described { text: words.join(", "), sound }
}

/// Characters as people type them.
fn plain(bytes: &[u8]) -> String {
    if bytes.iter().all(|byte| matches!(byte, 0x20..=0x7E)) {
        String::from_utf8_lossy(bytes).into_owned()
    } else {
        hex(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_over_the_line_is_told_in_words() {
        let sent = describe_sent(b"I077007003066060\r");
        assert_eq!((sent.text.as_str(), sent.sound), ("order 7: motor 3 backward 60 %", true));
        let heard = describe_received(b"073082077007000000188000000\r");
        assert_eq!((heard.text.as_str(), heard.sound), ("answer 7 to M: motors 0, 0, -60, 0 %", true));
        assert_eq!(describe_sent(b"I001002003\r").text, "data for the program: 1 2 3 0 0 0 0 0");
        assert_eq!(describe_received(b"073084088032021082088032001\r").text, "frame 84 88 32 21 82 88 32 1");
        assert_eq!(describe_sent(b"H\r").text, "version and help");
        assert!(!describe_sent(b"I2\r").sound && !describe_sent(b"G").sound);
        assert!(!describe_received(b"0730820").sound);
        assert_eq!(describe_received(b"MotorVator AWOS 2.32\r\n").text, "MotorVator AWOS 2.32");
    }
}
