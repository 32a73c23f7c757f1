//! A node of the bus behind its adapter, and the frames that stop its motors.

use brushwork_canopen::adapter::Form;
use brushwork_canopen::sdo::Transfer;
use brushwork_canopen::{Frame, Function, NodeId};
use brushwork_link::device::StopBytes;
use brushwork_mcp_wire::packet_serial::number;
use std::time::Duration;

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
    pub(super) fn request(self, data: [u8; 8]) -> Vec<u8> {
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
}
