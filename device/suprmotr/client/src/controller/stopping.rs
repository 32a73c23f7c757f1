//! Stopping a unit: at once without asking, then again with its confirmation and a look at its motor, and what can still drive it.
//!
//! `!` ends a move of every controller of the line, selected or not; backspace ends a macro of those that are selected, which could have begun
//! another move in between, so that `!` stands on both sides of it. A loop that does not hold its motor still after that is switched off
//! (MF), and left so until the next arming.

use crate::controller::speaker::Speaker;
use crate::controller::unit::SuprMotr;
use crate::messages::{
    SuprMotrActMessage, SuprMotrCauseMessage, SuprMotrDriverMessage, SuprMotrRemedyMessage,
};
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{StopBytes, UnitStop};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_suprmotr_wire::{Command, Line as Commands, Mnemonic, Selection, Single, Status, operation};
use std::time::Duration;

/// A loop that holds its motor may move it by so many counts between two looks.
const STILL_COUNTS: i32 = 4;
/// Time between two looks at the motor.
const LOOK_AGAIN: Duration = Duration::from_millis(30);
/// So many looks in a row must find it still: a motor that oscillates stands still where it turns.
const STILL_LOOKS: u32 = 4;
/// A unit that has not ended its move, or a loop that does not hold its motor still within this, is stopped otherwise.
const LIMIT: Duration = Duration::from_millis(1200);
/// A reply that was on its way when the stop broke in is done within this: 40 characters at 9600 baud, a USB adapter.
const BROKEN_INTO: Duration = Duration::from_millis(80);

/// The bytes that stop who is selected: `!`, backspace, `!`.
pub fn bytes(selection: Selection) -> StopBytes {
    let abort = Single::Abort.character();
    let [select, who] = selection.bytes();
    StopBytes::at_once(vec![vec![abort, select, who, Single::EndMacro.character(), abort]])
}

/// Stops with confirmation: by the end of the trajectory in its status, and by reading that the motor stands. Only what breaks in and a lost
/// link are errors.
pub fn confirm(unit: &mut SuprMotr, line: &mut Line<'_>) -> Result<UnitStop, ExchangeError> {
    let on = unit.name(line);
    let mut stop = UnitStop::new(unit.identity.address);
    if line.exchange().may_hear_late_replies() {
        let (exchange, watch) = line.parts();
        let lateness = if exchange.is_late() { exchange.longest_turnaround() } else { Duration::ZERO };
        exchange.drain(BROKEN_INTO + lateness, watch)?;
    }
    let failed = |came_back: Message| {
        Failure::new(SuprMotrActMessage::Stop, on, came_back, SuprMotrRemedyMessage::CutPower)
    };
    match stand(unit, line) {
        Ok(Ended::Stands) => stop.confirmed = true,
        Ok(Ended::SwitchedOff) => {
            stop.confirmed = true;
            stop.loop_left_off = true;
            stop.still_driven_by.push(SuprMotrDriverMessage::LoopLeftOff.into());
        }
        Ok(Ended::StillMoves) => stop.failures.push(failed(SuprMotrCauseMessage::Unsettled.into())),
        Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
        Err(error) => stop.failures.push(failed(error.message())),
    }
    Ok(stop)
}

enum Ended {
    Stands,
    /// The motor was switched off: its loop did not hold it still.
    SwitchedOff,
    StillMoves,
}

fn stand(unit: &mut SuprMotr, line: &mut Line<'_>) -> Result<Ended, ExchangeError> {
    for again in [false, true] {
        if again {
            write(unit.speaker, line)?;
        }
        let (status, is_still) = settles(unit, line)?;
        if is_still {
            return Ok(if status.is_motor_on() { Ended::Stands } else { stands_free(unit) });
        }
        if is_ended(status) && status.is_motor_on() {
            // The move has ended and the motor moves all the same: its loop does not hold it.
            unit.speaker.order(line, &Commands::of(Command::plain(Mnemonic::MF)))?;
            unit.switched_off = true;
            let (status, is_still) = settles(unit, line)?;
            return Ok(if is_still && !status.is_motor_on() {
                Ended::SwitchedOff
            } else {
                Ended::StillMoves
            });
        }
    }
    Ok(Ended::StillMoves)
}

/// A motor that is off was switched off by an earlier stop, or by somebody who wanted it.
fn stands_free(unit: &SuprMotr) -> Ended {
    if unit.switched_off { Ended::SwitchedOff } else { Ended::Stands }
}

/// Writes the stop once more.
fn write(speaker: Speaker, line: &mut Line<'_>) -> Result<(), ExchangeError> {
    line.exchange().write_stop(&bytes(Selection::Unit(speaker.address))).map(drop)
}

/// Whether no move, macro or wait is in process.
fn is_ended(status: Status) -> bool {
    status.is_complete() && status.operation & (operation::MACRO | operation::WAIT) == 0
}

/// Waits until the move has ended and the motor stands; the last status, and whether it does.
fn settles(unit: &mut SuprMotr, line: &mut Line<'_>) -> Result<(Status, bool), ExchangeError> {
    let begun_at = line.exchange().clock().now();
    let mut before = None;
    let mut still_looks = 0;
    loop {
        let (status, _) = unit.speaker.status(line)?;
        let position = position(unit, line)?;
        let moved =
            before.map_or(i32::MAX, |before: i32| position.abs_diff(before).try_into().unwrap_or(i32::MAX));
        let is_quiet = (is_ended(status) || !status.is_motor_on()) && moved <= STILL_COUNTS;
        still_looks = if is_quiet { still_looks + 1 } else { 0 };
        if still_looks == STILL_LOOKS {
            return Ok((status, true));
        }
        if line.exchange().clock().now() >= begun_at + LIMIT {
            return Ok((status, false));
        }
        before = Some(position);
        let (exchange, watch) = line.parts();
        exchange.wait(LOOK_AGAIN, watch)?;
    }
}

fn position(unit: &mut SuprMotr, line: &mut Line<'_>) -> Result<i32, ExchangeError> {
    let (report, _) = unit.speaker.ask_single(line, Single::Position)?;
    Ok(report.number(Mnemonic::TP).unwrap_or_default())
}

/// What moves the motor without this program: a macro, or the loop that holds it.
pub fn other_drivers(unit: &mut SuprMotr, line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError> {
    let (status, _) = unit.speaker.status(line)?;
    let runs = status.operation & operation::MACRO != 0;
    let told = [
        runs.then_some(SuprMotrDriverMessage::MacroRuns),
        status.is_motor_on().then_some(SuprMotrDriverMessage::LoopHolds),
    ];
    Ok(told.into_iter().flatten().map(Message::from).collect())
}
