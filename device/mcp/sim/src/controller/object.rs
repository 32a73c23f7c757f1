//! Commands carried out past packet serial: by the objects of the CANopen node.

use super::Controller;
use super::answer::{Answer, Named, find};
use super::dispatch::handler;
use brushwork_mcp_wire::packet_serial::{Form, Generation, lookup};
use brushwork_values::{Value, Values};

/// What came of a command.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Outcome {
    /// It was carried out.
    Done,
    /// It has these values.
    Values(Vec<Named>),
    /// The firmware does not take it.
    Refused,
}

impl Controller {
    /// How a command looks in the generation of this unit; `None` where it has none or runs nothing.
    pub(super) fn form_of(&self, command: u8) -> Option<&'static Form> {
        let firmware = self.firmware.as_ref()?;
        if firmware.loader.is_some() {
            return None;
        }
        handler(command)?;
        lookup(command)?.form(self.config.generation)
    }

    /// The generation of its firmware.
    pub(super) fn generation(&self) -> Generation {
        self.config.generation
    }

    /// Carries a command out for the CAN bus. Its functions act at all priority levels (MCP manual 1.9.4).
    pub(super) fn carry_out(&mut self, command: u8, args: &[i64]) -> Outcome {
        let now = self.now;
        let Some(form) = self.form_of(command) else { return Outcome::Refused };
        let Some(firmware) = &mut self.firmware else { return Outcome::Refused };
        firmware.now = now;
        firmware.from_can = true;
        let values = Values::new(form.request, args.iter().map(|&value| Value::Int(value)).collect());
        let answer = firmware.answer(command, &values);
        firmware.from_can = false;
        match answer {
            Answer::Ack => Outcome::Done,
            Answer::Data(values) => Outcome::Values(values),
            Answer::Silence | Answer::Refused | Answer::AckThenStatus { .. } => Outcome::Refused,
        }
    }

    /// The motors stop because the CAN bus's master is no longer heard.
    pub(super) fn stop_for_can(&mut self) {
        if let Some(firmware) = &mut self.firmware {
            firmware.stop_both();
        }
    }
}

/// A number among the values of an outcome.
pub(super) fn number(values: &[Named], name: &str) -> Option<i64> {
    find(values, name)?.as_int()
}
