//! Lines of a MotorVator as they are typed in a terminal; the carriage return is added.

use brushwork_link::device::Described;
use brushwork_motorvator_client::{MotorvatorFacts, describe_received, describe_sent};
use brushwork_motorvator_wire::host::HostOrder;
use brushwork_motorvator_wire::{LINE_END, Order};

use crate::family::Terminal;

/// What is typed for a unit that was so when it was found.
pub struct Typed(pub MotorvatorFacts);

impl Terminal for Typed {
    fn set_up(&self) -> String {
        match self.0.library {
            Some(version) => format!("G, H, or I and triplets; host library {version} runs"),
            None => "G, H, or I and triplets; the host library does not answer".to_owned(),
        }
    }

    fn bytes_of(&self, line: &str) -> Result<Vec<u8>, String> {
        let mut bytes = line.trim().as_bytes().to_vec();
        bytes.push(LINE_END);
        Ok(bytes)
    }

    fn stops_the_motor(&self, bytes: &[u8]) -> bool {
        match Order::of_line(bytes.strip_suffix(&[LINE_END]).unwrap_or(bytes)) {
            Some(Order::Data(frame)) => {
                self.0.library.is_some() && matches!(HostOrder::parse(&frame), Some((HostOrder::Stop, _)))
            }
            Some(Order::Go | Order::Help | Order::Ignored | Order::Unknown) | None => false,
        }
    }

    fn shown(&self, bytes: &[u8]) -> String {
        let text: String = bytes.iter().copied().map(char::from).collect();
        text.trim_end().replace("\r\n", " | ").replace('\r', " | ")
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        describe_sent(bytes)
    }

    fn describe_received(&self, _sent: &[u8], reply: &[u8]) -> Described {
        describe_received(reply)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_motorvator_client::Half;

    #[test]
    fn a_line_gets_its_end_and_a_stop_is_known() {
        let typed = Typed(MotorvatorFacts { half: Half::First, library: Some(2) });
        assert_eq!(typed.bytes_of(" I001 ").unwrap(), b"I001\r");
        assert!(typed.stops_the_motor(b"I088001\r") && !typed.stops_the_motor(b"I083001\r"));
        let without = Typed(MotorvatorFacts { half: Half::First, library: None });
        assert!(!without.stops_the_motor(b"I088001\r"));
        assert_eq!(typed.shown(b"AWOS\r\n073001\r"), "AWOS | 073001");
    }
}
