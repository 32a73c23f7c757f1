//! Stopping a board: at once without asking, then again with the library's word that nothing is driven, and what can still drive it.
//!
//! The library knows one stop for all motors and steppers of the board. A program that is not the library hears of it as of any data.

use crate::controller::unit::Board;
use crate::messages::{MotorvatorCauseMessage, MotorvatorDriverMessage, MotorvatorRemedyMessage};
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{StopBytes, UnitStop};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_link::messages::ActMessage;
use brushwork_motorvator_wire::host::{HostAnswer, HostOrder, flags, stop_bytes};
use std::time::Duration;

/// A stepper that was told to make no more steps tells so within this.
const LIMIT: Duration = Duration::from_millis(600);
/// A reply that was on its way when the stop broke in is done within this: 28 characters at 9600 baud, a USB adapter.
const BROKEN_INTO: Duration = Duration::from_millis(60);

/// The bytes that stop a board, whichever half is spoken to.
pub fn bytes() -> StopBytes {
    StopBytes::at_once(vec![stop_bytes()])
}

/// Stops with confirmation. Only what breaks in and a lost link are errors.
pub fn confirm(board: &mut Board, line: &mut Line<'_>) -> Result<UnitStop, ExchangeError> {
    let on = board.name(line);
    let mut stop = UnitStop {
        address: board.half.number(),
        confirmed: false,
        script_ended: None,
        buffers_empty: None,
        still_driven_by: Vec::new(),
        loop_left_off: false,
        failures: Vec::new(),
    };
    if line.exchange().may_hear_late_replies() {
        let (exchange, watch) = line.parts();
        let lateness = if exchange.is_late() { exchange.longest_turnaround() } else { Duration::ZERO };
        exchange.drain(BROKEN_INTO + lateness, watch)?;
    }
    let failed =
        |came_back: Message| Failure::new(ActMessage::Stop, on, came_back, MotorvatorRemedyMessage::CutPower);
    match stand(board, line) {
        Ok(None) => stop.confirmed = true,
        Ok(Some(cause)) => stop.failures.push(failed(cause.into())),
        Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
        Err(error) => stop.failures.push(failed(error.message())),
    }
    Ok(stop)
}

/// Orders the stop and waits until the library says that nothing moves; else why not.
fn stand(board: &mut Board, line: &mut Line<'_>) -> Result<Option<MotorvatorCauseMessage>, ExchangeError> {
    let begun_at = line.exchange().clock().now();
    let (mut answer, _) = board.speaker.ask(line, &HostOrder::Stop)?;
    loop {
        let cause = moves(&answer);
        if cause.is_none() || line.exchange().clock().now() >= begun_at + LIMIT {
            return Ok(cause);
        }
        (answer, _) = board.speaker.ask(line, &HostOrder::State)?;
    }
}

/// What of the board still moves by the library's account.
fn moves(answer: &HostAnswer) -> Option<MotorvatorCauseMessage> {
    if answer.speeds().is_none_or(|speeds| speeds.iter().any(|speed| *speed != 0)) {
        return Some(MotorvatorCauseMessage::StillDriven);
    }
    let steps = answer.flags & (flags::STEPPER_1 | flags::STEPPER_2) != 0;
    steps.then_some(MotorvatorCauseMessage::StillMoves)
}

/// What drives the motors without this program: any program but the library.
pub fn other_drivers(board: &Board) -> Vec<Message> {
    let told = (!board.speaker.has_library).then_some(MotorvatorDriverMessage::NotTheLibrary);
    told.into_iter().map(Message::from).collect()
}
