//! MCP controllers as nodes of a CANopen bus, through an adapter on a serial port.
//!
//! [`CanOpen`] finds nodes. Each is driven by the same code as over packet serial (module `mcp`): only how a command and its values
//! reach the unit differs, and that is here. Commands are objects (`brushwork_mcp_wire::canopen::objects`), read and written by
//! SDO; heartbeats are listened for on the way.

mod access;
mod command;
mod discover;
mod monitor;

pub use command::{Probe, carry_out, probe};
pub use discover::CanOpen;
pub use monitor::{BusTransport, Monitor};

use access::{read, write};
use brushwork_mcp_wire::canopen::adapter::{Decoder, Form};
use brushwork_mcp_wire::canopen::nmt::objects;
use brushwork_mcp_wire::canopen::sdo::Transfer;
use brushwork_mcp_wire::canopen::{Frame, Function, NodeId, describe_frame};
use brushwork_mcp_wire::packet_serial::{hex, number};
use std::time::Duration;

use super::controller::Line;
use super::described::Described;
use super::stop::StopBytes;
use crate::exchange::ExchangeError;

/// The node that this program is on the bus, by its heartbeat: the highest, since other masters take low ones. Assumed free.
pub const MASTER: NodeId = NodeId::new(NodeId::MAX).expect("127 is a node id");
/// After how much silence of this program a node that watches it stops its motors.
pub const MASTER_LIMIT: Duration = Duration::from_millis(1000);

/// A node and the adapter's language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The node.
    pub node: NodeId,
    /// How the adapter writes frames.
    pub form: Form,
}

impl Place {
    /// The bytes of one SDO request.
    fn request(self, data: [u8; 8]) -> Vec<u8> {
        let frame = Frame::full(Function::SdoRequest(self.node).id(), data);
        self.form.encode(&frame).expect("both forms have frames with standard identifiers, a test says so")
    }

    /// The frames that stop the node's motors: duty 0 on each; with `scripts` the end of the script and duty 0 again follow. Each waits
    /// for no answer.
    #[must_use]
    pub fn stop_bytes(self, scripts: bool) -> StopBytes {
        use brushwork_mcp_wire::canopen::objects::{TRIGGER, index_of};
        let frame = |transfer: Transfer| self.request(transfer.begin());
        let duty_zero: Vec<u8> = [number::DUTY_M1, number::DUTY_M2]
            .into_iter()
            .flat_map(|duty| frame(Transfer::download(index_of(duty), 0, &[0; 2])))
            .collect();
        let end_script = || frame(Transfer::download(index_of(number::STOP_SCRIPT), 0, &TRIGGER));
        let after = if scripts { vec![end_script(), duty_zero.clone()] } else { Vec::new() };
        StopBytes { first: vec![duty_zero], after, gap: Duration::ZERO }
    }

    /// Makes the node watch this program's heartbeat, and sees whether it does.
    pub fn watch_master(self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        let [low, high] = u16::try_from(MASTER_LIMIT.as_millis()).unwrap_or(u16::MAX).to_le_bytes();
        let value = [low, high, MASTER.get(), 0];
        write(line, self, objects::CONSUMER_HEARTBEAT, 1, &value)?;
        let kept = read(line, self, objects::CONSUMER_HEARTBEAT, 1)?.0;
        if kept != value {
            let what = "the node did not keep whose heartbeat it should watch".to_owned();
            return Err(ExchangeError::Impossible { what });
        }
        Ok(())
    }

    /// Lets the node stop watching.
    pub fn unwatch_master(self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        write(line, self, objects::CONSUMER_HEARTBEAT, 1, &[0; 4]).map(drop)
    }
}

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
    fn stop_is_one_frame_for_each_motor_then_one_for_the_script_and_each_motor_again() {
        let place = Place { node: NodeId::new(3).unwrap(), form: Form::Ascii };
        // 603: SDO to node 3. 2F: one byte; object 20F9 (249), subindex 0, a byte 0.
        // 2B: two bytes; objects 2020 (32) and 2021 (33), subindex 0, duty 0.
        let duty_zero = ":S603N2B20200000000000;:S603N2B21200000000000;";
        let expected = [duty_zero, ":S603N2FF9200000000000;", duty_zero].concat();
        assert_eq!(String::from_utf8(place.stop_bytes(true).concat()).unwrap(), expected);
        assert_eq!(String::from_utf8(place.stop_bytes(false).concat()).unwrap(), duty_zero);
    }

    #[test]
    fn every_request_has_a_frame_in_both_forms() {
        for form in Form::ALL {
            for node in NodeId::all() {
                assert!(!Place { node, form }.request([0xFF; 8]).is_empty());
            }
        }
    }

    #[test]
    fn traffic_is_told_in_words() {
        let told = describe(b":S703N05;", Form::Ascii);
        assert_eq!((told.text.as_str(), told.sound), ("node 3 heartbeat: operational", true));
        assert_eq!(describe(b"x", Form::Ascii).text, "78");
    }
}
