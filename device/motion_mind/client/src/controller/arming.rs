//! Whether motion may be allowed: the mode must take serial commands, and nothing may hold the drive back.

use crate::controller::driving;
use crate::controller::registers::{mask, value_in};
use crate::controller::stopping::{give_back, read_ramp, switch_on};
use crate::controller::unit::MotionMind;
use crate::messages::MotionMindDriverMessage;
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
            Hold::Moves => objections.push((
                "its loop is switched off (DISABLEPID in FUNCTION), and the motor does not stand still when it is switched on"
                    .to_owned(),
                "See that nothing turns the motor, and lower PTERM and ITERM",
            )),
        }
    }
    if objections.is_empty() {
        give_back(unit, line, number::VELOCITYLIMIT)?;
        warnings.push(MotionMindDriverMessage::NoTimeout.into());
        warnings.extend(ramp_warning(unit, line)?);
    }
    let reasons = objections
        .into_iter()
        .map(|(came_back, remedy)| Failure::new("arm the motor", on.as_str(), came_back, remedy))
        .collect();
    Ok(ArmCheck { reasons, controller_timeout: None, warnings })
}

/// What speaks against it, each with its cure.
fn objections(unit: &MotionMind, mode: i64, function: i64, status: i64) -> Vec<(String, &'static str)> {
    let is_function = |bit: u16| function & i64::from(bit) != 0;
    let is_status = |bit: u16| status & i64::from(bit) != 0;
    let mut found = Vec::new();
    if mode != i64::from(unit.mode().number()) {
        found.push((
            format!("it is in mode {mode} now and was in {} when it was found", unit.mode()),
            "Connect again",
        ));
    }
    match unit.mode() {
        Mode::Serial | Mode::SerialPid => {}
        Mode::AnalogPid if is_function(function::ADSERIAL) => {}
        Mode::AnalogPid => found.push((
            "in mode 5 its setpoint is the analog input".to_owned(),
            "Set ADSERIAL in FUNCTION, so that the setpoint comes over the serial line",
        )),
        other @ (Mode::RadioControl
        | Mode::Analog
        | Mode::Buttons
        | Mode::FactoryRestore
        | Mode::FactoryTest) => found.push((
            format!("in {other} it takes {}", driving::taken(other)),
            "Set switches 2 to 4 for mode 3 or 4, and switch the power off and on",
        )),
    }
    if is_status(status::BRAKE) {
        found.push(("its brake input is at ground".to_owned(), "Release the brake input, J4 pin 12"));
    }
    if is_status(status::TEMPFAULT) {
        found.push(("it is too hot; its bridge is off".to_owned(), "Let it cool down below 80 °C"));
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

fn ramp_warning(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Option<Message>, ExchangeError> {
    if unit.mode() != Mode::Serial {
        return Ok(None);
    }
    read_ramp(unit, line)?;
    let long = unit.ramp.time_to_zero().filter(|time| *time > LONG_RAMP);
    Ok(long.map(|time| MotionMindDriverMessage::LongRamp { seconds: time.as_secs_f64() }.into()))
}
