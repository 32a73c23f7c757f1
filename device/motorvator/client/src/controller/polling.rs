//! What is read from half a board in a sweep: the state of the motors, and now and then display and inputs.

use crate::controller::indicators::{INDICATORS, NO_LIBRARY, word_of};
use crate::controller::speaker::Found;
use crate::controller::unit::Board;
use crate::messages::MotorvatorCauseMessage;
use brushwork_link::device::controller::{Line, PollItem, PollList};
use brushwork_link::device::{Channel, Sample, StatusReport};
use brushwork_link::exchange::ExchangeError;
use brushwork_motorvator_wire::host::HostOrder;
use brushwork_values::Motor;

const STATE: PollItem = PollItem { id: 0, name: "state of the motors" };
const DISPLAY: PollItem = PollItem { id: 1, name: "display and inputs" };

pub fn list() -> PollList {
    PollList { fast: vec![STATE], slow: vec![DISPLAY], status: Some(STATE), signals: None }
}

/// Reads one item. Where the library is not there, it is looked for instead.
pub fn read(
    board: &mut Board,
    line: &mut Line<'_>,
    item: PollItem,
    sample: &mut Sample,
) -> Result<Option<StatusReport>, ExchangeError> {
    if item == DISPLAY {
        if board.speaker.has_library {
            let (answer, _) = board.speaker.ask(line, &HostOrder::Display([0; 2]))?;
            board.display = answer.display().unwrap_or(board.display);
        }
        return Ok(None);
    }
    let report = |board: &Board, at, word| Some(StatusReport::new(board.half.number(), at, word, INDICATORS));
    if board.speaker.has_library {
        match board.speaker.ask(line, &HostOrder::State) {
            Ok((answer, span)) => {
                let speeds = answer.speeds().unwrap_or_default();
                for (motor, channel) in Motor::BOTH.into_iter().zip([Channel::M1_PWM, Channel::M2_PWM]) {
                    let percent = speeds[usize::from(board.half.motor(motor) - 1)];
                    sample.set(channel, percent.into(), span.requested_at, span.replied_at);
                }
                return Ok(report(board, span.replied_at, word_of(answer.flags, board.display)));
            }
            // While motors may run, nothing is waited for.
            Err(error) if !error.is_no_answer() || line.permit().motion => return Err(error),
            Err(_) => {}
        }
    }
    let found = board.speaker.look(line)?;
    let now = line.exchange().clock().now();
    match found {
        Found::Library(_) | Found::CommandLine => Ok(report(board, now, NO_LIBRARY)),
        Found::Bytes | Found::Nothing => Err(ExchangeError::impossible(MotorvatorCauseMessage::NoLibrary)),
    }
}
