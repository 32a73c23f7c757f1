//! The tuner's axis on a Motion Mind over the device thread.

use std::time::Duration;

use brushwork_link::device::JobContext;
use brushwork_link::wire::Wire;
use brushwork_protocol::motion_mind::{Command, Protocol, Reply, register};
use brushwork_tuning::axis::{AxisError, Exchange};
use brushwork_tuning_bench::mind::axis::MindCarrier;

use super::told;

/// An exchange that took so much longer than the quickest of its kind had a retry in it, so that nobody can say when the unit did
/// its work.
const LATE: Duration = Duration::from_millis(35);

/// The wire of a job as the tuner's carrier. The device thread knows which protocol the unit speaks; here all is commands.
pub(super) struct MindJobCarrier<'a, 'b> {
    context: &'a mut JobContext<'b>,
    /// The quickest reading and the quickest of the other exchanges so far.
    quickest: [Option<Duration>; 2],
}

impl<'a, 'b> MindJobCarrier<'a, 'b> {
    /// The carrier of a job.
    pub(super) fn new(context: &'a mut JobContext<'b>) -> Self {
        Self { context, quickest: [None; 2] }
    }

    fn is_vague(&mut self, is_reading: bool, took: Duration) -> bool {
        let quickest = &mut self.quickest[usize::from(is_reading)];
        let least = quickest.map_or(took, |quickest| quickest.min(took));
        *quickest = Some(least);
        took > least + LATE
    }
}

impl MindCarrier for MindJobCarrier<'_, '_> {
    fn transact(&mut self, command: &Command) -> Result<(Exchange, Reply), AxisError> {
        let Some(values) = values_of(command) else {
            return Err(AxisError::Refused("a command that no run sends".into()));
        };
        let reply = self.context.transact_timed(command.number(), &values).map_err(|error| told(&error))?;
        let at = Exchange { sent: reply.span.requested_at, received: reply.span.replied_at };
        let mask = match command {
            Command::Read(mask) => *mask,
            _ => 0,
        };
        let is_vague = self.is_vague(mask != 0, at.received.saturating_sub(at.sent));
        if mask == 0 {
            return Ok((at, Reply::Acknowledged));
        }
        let named = |number: u8| Some((number, reply.values.try_int(register(number)?.name)?));
        let read = (0..32).filter(|number| mask >> number & 1 == 1).filter_map(named).collect();
        if is_vague { Err(AxisError::NoReply) } else { Ok((at, Reply::Registers(read))) }
    }

    /// Whatever it is: the device thread reads by mask in both.
    fn protocol(&self) -> Protocol {
        Protocol::Binary
    }

    fn bits_per_second(&self) -> Option<u32> {
        None
    }

    fn now(&mut self) -> Duration {
        self.context.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        let left = time.saturating_sub(self.context.now());
        self.context.sleep(left).map_err(|error| told(&error))
    }

    fn progress(&mut self, text: &str) {
        self.context.progress(None, text);
    }
}

/// The values of a command that a run sends, in their order on the wire.
fn values_of(command: &Command) -> Option<Vec<i64>> {
    Some(match *command {
        Command::Read(mask) => vec![i64::from(mask)],
        Command::Write { register, value } => vec![i64::from(register), value],
        Command::MoveAtVelocity(counts) => vec![i64::from(counts)],
        Command::MoveToAbsolute(counts) | Command::MoveToRelative(counts) => vec![i64::from(counts)],
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_run_sends_comes_back_as_the_same_command_and_eeprom_is_never_among_it() {
        let commands = [
            Command::Read(0b1001),
            Command::Write { register: 3, value: 0x4080 },
            Command::MoveAtVelocity(-7),
            Command::MoveToAbsolute(-123_456),
            Command::MoveToRelative(0),
        ];
        for command in commands {
            let values = values_of(&command).expect("a run sends it");
            assert_eq!(Command::from_parts(command.number(), &values), Some(command));
        }
        assert_eq!(values_of(&Command::WriteStore { register: 3, value: 0 }), None);
        assert_eq!(values_of(&Command::Restore), None);
    }
}
