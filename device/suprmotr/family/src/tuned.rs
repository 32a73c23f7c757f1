//! The loop of a SuprMotr over the device thread.

use brushwork_family::messages::LoopActMessage;
use brushwork_family::tuned::{
    OtherTuned, Quickest, Registers, Restored, Target, Tuned, failed, reported, thrice,
};
use brushwork_link::Failure;
use brushwork_link::device::JobContext;
use brushwork_suprmotr_axis::law::{SuprMotrLaw, SuprMotrPart, SuprMotrSetup};
use brushwork_suprmotr_axis::{Answer, SuprMotrAxis, SuprMotrCarrier, worked_at};
use brushwork_suprmotr_client::SUPRMOTR;
use brushwork_suprmotr_wire::{
    Command, Line, Mnemonic, Radix, ReportForm, ReportLine, Reports, Single, Status, encode_report,
};
use brushwork_tuning::axis::{AxisError, Exchange};
use brushwork_tuning::setup::{LoopAxis, Setup};
use brushwork_values::{Motor, Values};
use std::time::Duration;

/// Settings that a run changes: gains and the pace of moves.
const TRIED: [&str; 6] =
    ["loop.p", "loop.i", "loop.d", "loop.integral_limit", "motion.velocity", "motion.acceleration"];

/// The wire of a job as the tuner's carrier.
struct JobCarrier<'a, 'b> {
    context: &'a mut JobContext<'b>,
    /// Of the readings of a position.
    quickest: Quickest,
}

impl<'a, 'b> JobCarrier<'a, 'b> {
    fn new(context: &'a mut JobContext<'b>) -> Self {
        Self { context, quickest: Quickest::default() }
    }
}

/// Bytes up to the last of a command, and of its report, in the form of the manual.
fn lengths(command: &Command) -> (usize, usize) {
    let selection = 2;
    let by_character = Single::ALL.into_iter().any(|single| single.mnemonic() == Some(command.mnemonic))
        && command.number.is_none();
    let up =
        if by_character { 1 } else { Line::of(*command).encode(Radix::Decimal).map_or(0, |line| line.len()) };
    let told = if let Reports::Number { .. } = command.row().reports {
        ReportLine::Number { of: command.mnemonic, value: 0 }
    } else {
        ReportLine::Status(Status::default())
    };
    let address = brushwork_suprmotr_wire::Address::FACTORY;
    let down = encode_report(ReportForm::Full, Radix::Decimal, address, &[told]).len();
    // `!` is followed by the `%` that says what became of it, and so is a line that reports nothing; its work is done by then.
    (selection + up, down + usize::from(command.row().reports == Reports::Nothing))
}

fn answer_of(command: &Command, values: &Values) -> Option<Answer> {
    if let Reports::Number { .. } = command.row().reports {
        let number = values.try_int(command.mnemonic.name())?;
        return i32::try_from(number).ok().map(Answer::Number);
    }
    let byte = |name: &str| values.try_int(name).and_then(|value| u8::try_from(value).ok());
    let bytes = ["operation", "motion", "limits", "inputs", "mode", "error"].map(byte);
    let bytes: Option<Vec<u8>> = bytes.into_iter().collect();
    Status::from_bytes(&bytes?).map(Answer::Status)
}

impl SuprMotrCarrier for JobCarrier<'_, '_> {
    fn transact(&mut self, command: Command) -> Result<(Exchange, Answer), AxisError> {
        let number: Vec<i64> = command.number.into_iter().map(i64::from).collect();
        let reply = self
            .context
            .transact_timed(command.mnemonic.number(), &number)
            .map_err(|error| reported(&error))?;
        let span = (reply.span.requested_at, reply.span.replied_at);
        let answer = answer_of(&command, &reply.values).ok_or(AxisError::NoReply)?;
        if command.mnemonic == Mnemonic::TP && self.quickest.is_vague(span.1.saturating_sub(span.0)) {
            return Err(AxisError::Late);
        }
        let at = match self.context.byte_time() {
            Some(byte_time) => worked_at(span, lengths(&command), byte_time),
            None => Exchange { sent: span.0, received: span.1 },
        };
        Ok((at, answer))
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

/// The loop of a SuprMotr.
#[derive(Clone, Copy, Debug)]
pub struct SuprMotrTuned;

impl OtherTuned for SuprMotrTuned {
    type Part = SuprMotrPart<SuprMotrLaw>;
}

impl Tuned for SuprMotrTuned {
    type Law = SuprMotrLaw;

    fn is_at(context: &JobContext<'_>) -> bool {
        context.address().family() == SUPRMOTR
    }

    fn axis<'a>(
        context: &'a mut JobContext<'_>,
        _target: Target,
        _own_timeout: bool,
    ) -> Box<dyn LoopAxis<SuprMotrLaw> + 'a> {
        Box::new(SuprMotrAxis::new(JobCarrier::new(context)))
    }

    fn is_tried(_motor: Motor, key: &str) -> bool {
        TRIED.contains(&key)
    }

    fn restore(
        context: &mut JobContext<'_>,
        _target: Target,
        before: &Setup<SuprMotrLaw>,
        kept: &Registers<SuprMotrLaw>,
        leaves_off: bool,
    ) -> Result<Restored, Failure> {
        let place = context.describe();
        let Some(held) = before.held.suprmotr else { return Ok(Restored::default()) };
        let setup = SuprMotrSetup { registers: kept.suprmotr.unwrap_or(held.registers), ..held };
        let mut axis = SuprMotrAxis::new(JobCarrier::new(context));
        thrice(|| axis.put_back(setup, leaves_off))
            .map_err(|error| failed(LoopActMessage::WriteRegistersBack, &place, &error))?;
        Ok(Restored::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `^A0'` and `0P0:+0000000000` with its end; `^A0MA500<CR>`, `%` and six bytes of status.
    #[test]
    fn the_length_of_what_goes_over_the_wire_is_that_of_the_manuals_forms() {
        assert_eq!(lengths(&Command::plain(Mnemonic::TP)), (3, 18));
        assert_eq!(lengths(&Command::with(Mnemonic::MA, 500)), (8, 24));
        assert_eq!(lengths(&Command::plain(Mnemonic::AB)), (3, 24));
        assert_eq!(lengths(&Command::plain(Mnemonic::GP)).0, 5);
    }

    #[test]
    fn a_status_by_name_is_the_status_again() {
        let status = Status { operation: 0x81, motion: 0x80, limits: 1, inputs: 2, mode: 0, error: 0 };
        let names = ["operation", "motion", "limits", "inputs", "mode", "error"];
        static FIELDS: [brushwork_values::Field; 6] = {
            use brushwork_values::{Field, Kind};
            [
                Field::new("operation", Kind::U8, ""),
                Field::new("motion", Kind::U8, ""),
                Field::new("limits", Kind::U8, ""),
                Field::new("inputs", Kind::U8, ""),
                Field::new("mode", Kind::U8, ""),
                Field::new("error", Kind::U8, ""),
            ]
        };
        assert_eq!(FIELDS.each_ref().map(|field| field.name), names);
        let values = Values::new(
            &FIELDS,
            status.bytes().map(|byte| brushwork_values::Value::Int(byte.into())).to_vec(),
        );
        assert_eq!(answer_of(&Command::plain(Mnemonic::TS), &values), Some(Answer::Status(status)));
        assert_eq!(answer_of(&Command::plain(Mnemonic::TP), &values), None);
    }
}
