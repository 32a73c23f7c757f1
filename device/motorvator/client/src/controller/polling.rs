//! What is read from half a board in a sweep: the state of the motors, and now and then the display and the inputs.

use crate::controller::channels::ANALOG;
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

/// Four analog inputs are told at once: those from 1 and those from 3 on are all six.
const ANALOG_FROM: [(PollItem, u8); 2] = [
    (PollItem { id: 2, name: "analog inputs 1 to 4" }, 1),
    (PollItem { id: 3, name: "analog inputs 3 to 6" }, 3),
];

pub fn list() -> PollList {
    // The display is asked for between them, as often as both together.
    let [(low, _), (high, _)] = ANALOG_FROM;
    PollList {
        fast: vec![STATE],
        slow: vec![DISPLAY, low, DISPLAY, high],
        status: Some(STATE),
        signals: None,
    }
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
    if let Some((_, first)) = ANALOG_FROM.into_iter().find(|(known, _)| *known == item) {
        if board.speaker.has_library {
            let (answer, span) = board.speaker.ask(line, &HostOrder::Analog(first))?;
            for (channel, value) in ANALOG[usize::from(first) - 1..].iter().zip(answer.values) {
                sample.set(*channel, value.into(), span.requested_at, span.replied_at);
            }
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
