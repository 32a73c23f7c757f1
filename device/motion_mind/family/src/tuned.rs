//! The loop of a Motion Mind over the device thread.

use brushwork_family::messages::LoopActMessage;
use brushwork_family::tuned::{
    OtherTuned, Quickest, Registers, Restored, Target, Tuned, failed, reported, thrice,
};
use brushwork_link::Failure;
use brushwork_link::device::JobContext;
use brushwork_motion_mind_axis::law::{MotionMindLaw, MotionMindPart};
use brushwork_motion_mind_axis::{BITS_PER_BYTE, LoopAfter, MindAxis, MindCarrier, worked_at};
use brushwork_motion_mind_client::{MOTION_MIND, MotionMindFacts};
use brushwork_motion_mind_wire::{
    Address, Command, Part, Protocol, Reply, encode_frame, encode_line, register,
};
use brushwork_tuning::axis::{Axis, AxisError, Exchange};
use brushwork_tuning::setup::{LoopAxis, Setup};
use brushwork_values::Motor;
use std::time::Duration;

/// Registers that a run writes, by their names in keys.
const TRIED: [&str; 9] =
    ["velocityff", "pterm", "iterm", "dterm", "pidscalar", "vnlimit", "vplimit", "deadband", "ampslimit"];

/// The wire of a job as the tuner's carrier. The device thread knows which protocol the unit speaks; here all is commands.
struct MindJobCarrier<'a, 'b> {
    context: &'a mut JobContext<'b>,
    /// Of the readings, and of the other exchanges.
    quickest: [Quickest; 2],
}

impl<'a, 'b> MindJobCarrier<'a, 'b> {
    /// The carrier of a job.
    fn new(context: &'a mut JobContext<'b>) -> Self {
        Self { context, quickest: [Quickest::default(); 2] }
    }

    /// When a command did its work, from when it was sent and its reply complete.
    fn worked(&self, span: (Duration, Duration), command: &Command, reply: &Reply) -> Exchange {
        let Some(bits_per_second) = self.bits_per_second() else {
            return Exchange { sent: span.0, received: span.1 };
        };
        let protocol = self.protocol();
        worked_at(span, lengths(protocol, command, reply), bits_per_second, (protocol, command))
    }
}

/// Bytes of a command and of its reply on the wire.
fn lengths(protocol: Protocol, command: &Command, reply: &Reply) -> (usize, usize) {
    let request = match protocol {
        Protocol::Binary => encode_frame(Address::FACTORY, command).map_or(0, |frame| frame.len()),
        Protocol::Text => encode_line(Address::FACTORY, command).map_or(0, |line| line.len()),
    };
    let reply = match (protocol, reply) {
        (Protocol::Binary, Reply::Registers(values)) => {
            2 + values.iter().filter_map(|(number, _)| Some(register(*number)?.kind.bytes())).sum::<usize>()
        }
        (Protocol::Binary, _) => 1,
        // "APOS=20000" and the end of the line; all of them stand in one line, each with its comma.
        (Protocol::Text, Reply::Registers(values)) => {
            let digits: usize = values.iter().map(|(_, value)| value.to_string().len() + 1).sum();
            if values.len() == 1 { digits + 6 } else { digits + 2 }
        }
        (Protocol::Text, _) => 4,
    };
    (request, reply)
}

impl MindCarrier for MindJobCarrier<'_, '_> {
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn transact(&mut self, command: &Command) -> Result<(Exchange, Reply), AxisError> {
        let Some((number, values)) = wire_form(command) else {
            return Err(AxisError::Refused("a command that no run sends".into()));
        };
        let reply = self.context.transact_timed(number, &values).map_err(|error| reported(&error))?;
        let span = (reply.span.requested_at, reply.span.replied_at);
        let mask = match command {
            Command::ReadText(Part::All) => u32::MAX,
            command => command.named_registers(),
        };
        let is_vague = self.quickest[usize::from(mask != 0)].is_vague(span.1.saturating_sub(span.0));
        let answer = if mask == 0 {
            Reply::Acknowledged
        } else {
            let named = |number: u8| Some((number, reply.values.try_int(register(number)?.name)?));
            Reply::Registers((0..32).filter(|number| mask >> number & 1 == 1).filter_map(named).collect())
        };
        let at = self.worked(span, command, &answer);
        if mask != 0 && is_vague { Err(AxisError::Late) } else { Ok((at, answer)) }
    }

    fn protocol(&self) -> Protocol {
        self.context.facts().get::<MotionMindFacts>().map_or(Protocol::Binary, |facts| facts.protocol)
    }

    fn bits_per_second(&self) -> Option<u32> {
        let per_byte_s = self.context.byte_time()?.as_secs_f64();
        // Ten bits a byte; the cast saturates.
        (per_byte_s > 0.0).then(|| (BITS_PER_BYTE / per_byte_s).round() as u32)
    }

    fn now(&mut self) -> Duration {
        self.context.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        let left = time.saturating_sub(self.context.now());
        self.context.sleep(left).map_err(|error| reported(&error))
    }

    fn stolen(&mut self) -> Duration {
        self.context.take_stolen()
    }

    fn progress(&mut self, text: &str) {
        self.context.progress(None, text);
    }
}

/// A command that a run sends as the device thread takes it, which finds the words of the unit's protocol: number and values in
/// their order on the wire.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn wire_form(command: &Command) -> Option<(u8, Vec<i64>)> {
    let asked = match *command {
        Command::ReadText(Part::Register(number)) => Command::ReadRegister(number),
        Command::ReadText(Part::All) => Command::Read(u32::MAX),
        other => other,
    };
    Some((asked.number(), values_of(&asked)?))
}

/// The values of a command that a run sends, in their order on the wire.
fn values_of(command: &Command) -> Option<Vec<i64>> {
    Some(match *command {
        Command::Read(mask) => vec![i64::from(mask)],
        Command::ReadRegister(number) => vec![i64::from(number)],
        Command::Write { register, value } => vec![i64::from(register), value],
        Command::MoveAtVelocity(counts) => vec![i64::from(counts)],
        Command::MoveToAbsolute(counts) | Command::MoveToRelative(counts) => vec![i64::from(counts)],
        Command::ChangeSpeed(_)
        | Command::WriteStore { .. }
        | Command::ReadText(_)
        | Command::Restore
        | Command::Reset => return None,
    })
}

/// The loop of a Motion Mind.
#[derive(Clone, Copy, Debug)]
pub struct MotionMindTuned;

impl OtherTuned for MotionMindTuned {
    type Part = MotionMindPart<MotionMindLaw>;
}

impl Tuned for MotionMindTuned {
    type Law = MotionMindLaw;

    fn is_at(context: &JobContext<'_>) -> bool {
        context.address().family() == MOTION_MIND
    }

    fn axis<'a>(
        context: &'a mut JobContext<'_>,
        _target: Target,
        _own_timeout: bool,
    ) -> Box<dyn LoopAxis<MotionMindLaw> + 'a> {
        Box::new(MindAxis::new(MindJobCarrier::new(context)))
    }

    fn is_tried(_motor: Motor, key: &str) -> bool {
        key.strip_prefix("register.").is_some_and(|name| TRIED.contains(&name))
            || key.starts_with("function.")
            || key.starts_with("function2.")
    }

    fn restore(
        context: &mut JobContext<'_>,
        _target: Target,
        before: &Setup<MotionMindLaw>,
        kept: &Registers<MotionMindLaw>,
        leaves_off: bool,
    ) -> Result<Restored, Failure> {
        let place = context.describe();
        let held = before.held.motion_mind.map(|unit| unit.registers);
        let Some(registers) = kept.motion_mind.or(held) else { return Ok(Restored::default()) };
        let mut axis = MindAxis::new(MindJobCarrier::new(context));
        let put_back = thrice(|| axis.write_current_limits(before.max_current_raw, 0))
            .and_then(|()| thrice(|| axis.put_back(registers, leaves_off)))
            .map_err(|error| failed(LoopActMessage::WriteRegistersBack, &place, &error))?;
        Ok(Restored { loop_left_off: put_back == LoopAfter::LeftOff })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_length_of_what_goes_over_the_wire_is_that_of_the_manuals_examples() {
        let one = Reply::Registers(vec![(0, 20_000)]);
        // "R01 00" and its end; "APOS=20000" and its end.
        let line = Command::ReadText(Part::Register(0));
        assert_eq!(lengths(Protocol::Text, &line, &one), (8, 12));
        // 1A 01 mask checksum; 01 20 4E 00 00 6F.
        assert_eq!(lengths(Protocol::Binary, &Command::Read(1), &one), (7, 6));
        let write = Command::Write { register: 3, value: 0 };
        assert_eq!(lengths(Protocol::Binary, &write, &Reply::Acknowledged), (6, 1));
        assert_eq!(wire_form(&line), Some((0x1D, vec![0])));
    }

    #[test]
    fn what_a_run_sends_comes_back_as_the_same_command_and_eeprom_is_never_among_it() {
        let commands = [
            Command::Read(0b1001),
            Command::Write { register: 3, value: 0x4080 },
            Command::ReadRegister(21),
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
