//! Whether motion may be allowed: the mode must take serial commands, and nothing may hold the drive back.

use crate::controller::borrowed::Borrowed;
use crate::controller::driving;
use crate::controller::registers::{mask, value_in};
use crate::controller::stopping::{give_back, read_ramp, switch_on};
use crate::controller::unit::MotionMind;
use crate::messages::{
    MotionMindActMessage, MotionMindCauseMessage, MotionMindDriverMessage, MotionMindRemedyMessage,
};
use brushwork_link::Message;
use brushwork_link::device::controller::{ArmCheck, Line};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_motion_mind_wire::{Command, Mode, function, register_number as number, status};
use std::time::Duration;

/// A ramp that takes longer is worth knowing.
const LONG_RAMP: Duration = Duration::from_millis(300);

/// What became of a loop whose output was switched off.
enum Hold {
    /// It was not off, or the mode has no loop.
    AsItWas,
    SwitchedOn,
    /// The motor did not stand still, before or after.
    Moves,
}

/// Reads all that arming depends on, and lists what speaks against it. Nothing is changed unless nothing does.
pub fn check(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<ArmCheck, ExchangeError> {
    let on = unit.name(line);
    let wanted = mask(&[number::FUNCTION, number::STATUS, number::MODE]);
    let (reply, _) = unit.speaker.ask(line, &Command::Read(wanted))?;
    let word = |index: u8| value_in(&reply, index).unwrap_or_default();
    let function = word(number::FUNCTION);
    let mut objections = objections(unit, word(number::MODE), function, word(number::STATUS));
    let mut warnings = Vec::new();
    if objections.is_empty() {
        match hold(unit, line, function)? {
            Hold::AsItWas => {}
            Hold::SwitchedOn => warnings.push(MotionMindDriverMessage::LoopSwitchedOn.into()),
            Hold::Moves => {
                objections.push((MotionMindCauseMessage::LoopMoves, MotionMindRemedyMessage::LowerGains));
            }
        }
    }
    if objections.is_empty() {
        give_back(unit, line, number::VELOCITYLIMIT)?;
        warnings.push(MotionMindDriverMessage::NoTimeout.into());
        warnings.extend(ramp_warning(unit, line)?);
        unit.lends = lends(unit);
    }
    let reasons = objections
        .into_iter()
        .map(|(came_back, remedy)| Failure::new(MotionMindActMessage::Arm, on.as_str(), came_back, remedy))
        .collect();
    Ok(ArmCheck { reasons, controller_timeout: None, warnings })
}

/// What speaks against it, each with its cure.
fn objections(
    unit: &MotionMind,
    mode: i64,
    function: i64,
    status: i64,
) -> Vec<(MotionMindCauseMessage, MotionMindRemedyMessage)> {
    let is_function = |bit: u16| function & i64::from(bit) != 0;
    let is_status = |bit: u16| status & i64::from(bit) != 0;
    let mut found = Vec::new();
    if mode != i64::from(unit.mode().number()) {
        found.push((
            MotionMindCauseMessage::OtherMode { now: mode, found: unit.mode() },
            MotionMindRemedyMessage::ConnectAgain,
        ));
    }
    match unit.mode() {
        Mode::Serial | Mode::SerialPid => {}
        Mode::AnalogPid if is_function(function::ADSERIAL) => {}
        Mode::AnalogPid => {
            found.push((MotionMindCauseMessage::AnalogSetpoint, MotionMindRemedyMessage::SetAdserial));
        }
        other @ (Mode::RadioControl
        | Mode::Analog
        | Mode::Buttons
        | Mode::FactoryRestore
        | Mode::FactoryTest) => found.push((
            MotionMindCauseMessage::Takes { mode: other, taken: driving::taken(other) },
            MotionMindRemedyMessage::SetSwitches,
        )),
    }
    if is_status(status::BRAKE) {
        found.push((MotionMindCauseMessage::Braked, MotionMindRemedyMessage::ReleaseBrake));
    }
    if is_status(status::TEMPFAULT) {
        found.push((MotionMindCauseMessage::TooHot, MotionMindRemedyMessage::CoolDown));
    }
    found
}

/// Switches a loop on that a stop, a run or somebody else has switched off: who arms asks for motion.
fn hold(unit: &mut MotionMind, line: &mut Line<'_>, function: i64) -> Result<Hold, ExchangeError> {
    let off = i64::from(function::DISABLEPID);
    if unit.mode() == Mode::Serial || function & off == 0 {
        unit.borrowed.retain(|borrowed| borrowed.register != number::FUNCTION);
        return Ok(Hold::AsItWas);
    }
    Ok(if switch_on(unit, line, function & !off)? { Hold::SwitchedOn } else { Hold::Moves })
}

/// What a stop of the unit may change for a while: a slow ramp in mode 3; else the output of the loop, which is on now.
fn lends(unit: &MotionMind) -> Option<Borrowed> {
    match unit.mode() {
        Mode::Serial => {
            let value = unit.ramp.step.filter(|_| unit.ramp.is_slow())?;
            Some(Borrowed { register: number::VELOCITYLIMIT, value })
        }
        Mode::SerialPid | Mode::AnalogPid => Some(Borrowed { register: number::FUNCTION, value: 0 }),
        Mode::RadioControl | Mode::Analog | Mode::Buttons | Mode::FactoryRestore | Mode::FactoryTest => None,
    }
}

fn ramp_warning(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Option<Message>, ExchangeError> {
    if unit.mode() != Mode::Serial {
        return Ok(None);
    }
    read_ramp(unit, line)?;
    let long = unit.ramp.time_to_zero().filter(|time| *time > LONG_RAMP);
    Ok(long.map(|time| MotionMindDriverMessage::LongRamp { seconds: time.as_secs_f64() }.into()))
}
