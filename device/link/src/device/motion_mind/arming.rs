//! Whether motion may be allowed: the mode must take serial commands, and nothing may hold the drive back.

use super::stopping::{give_back, read_ramp};
use super::{MotionMind, driving, mask, number, value_in};
use crate::device::controller::{ArmCheck, Line};
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use brushwork_protocol::motion_mind::{Command, Mode, function, status};
use std::time::Duration;

/// A ramp that takes longer is worth knowing.
const LONG_RAMP: Duration = Duration::from_millis(300);

const NO_TIME_OUT: &str = "A Motion Mind has no serial time-out: if this program or the cable dies, the motor goes on with what it \
                           was last told. Have a switch for the motor power at hand.";

/// Reads all that arming depends on, and lists what speaks against it. Nothing is changed unless nothing does.
pub fn check(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<ArmCheck, ExchangeError> {
    let on = unit.name(line);
    let wanted = mask(&[number::FUNCTION, number::STATUS, number::MODE]);
    let (reply, _) = unit.speaker.ask(line, &Command::Read(wanted))?;
    let word = |index: u8| value_in(&reply, index).unwrap_or_default();
    let objections = objections(unit, word(number::MODE), word(number::FUNCTION), word(number::STATUS));
    let reasons: Vec<_> = objections
        .into_iter()
        .map(|(came_back, mend)| Failure::new("arm the motor", on.as_str(), came_back, mend))
        .collect();
    let mut warnings = Vec::new();
    if reasons.is_empty() {
        switch_on(unit, line)?;
        warnings.push(NO_TIME_OUT.to_owned());
        warnings.extend(ramp_warning(unit, line)?);
    }
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
        other => found.push((
            format!("in {other} it takes {}", driving::taken(other)),
            "Set switches 2 to 4 for mode 3 or 4, and switch the power off and on",
        )),
    }
    let is_ours = unit.borrowed.iter().any(|borrowed| borrowed.register == number::FUNCTION);
    if unit.mode() != Mode::Serial && is_function(function::DISABLEPID) && !is_ours {
        found.push((
            "the output of its loop is switched off".to_owned(),
            "Clear DISABLEPID in FUNCTION: the motor is held where it then stands",
        ));
    }
    if is_status(status::BRAKE) {
        found.push(("its brake input is at ground".to_owned(), "Release the brake input, J4 pin 12"));
    }
    if is_status(status::TEMPFAULT) {
        found.push(("it is too hot; its bridge is off".to_owned(), "Let it cool down below 80 °C"));
    }
    found
}

/// Puts back what an earlier stop switched off. The setpoint is set to where the motor stands first, so that it does not move.
fn switch_on(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<(), ExchangeError> {
    if unit.borrowed.iter().any(|borrowed| borrowed.register == number::FUNCTION) {
        let here = super::stopping::read(unit, line, number::POSITION)?;
        // A write to POSITION makes it the setpoint; the count stays what it is.
        unit.speaker.ask(line, &Command::Write { register: number::POSITION, value: here })?;
        give_back(unit, line, number::FUNCTION)?;
    }
    give_back(unit, line, number::VELOCITYLIMIT)
}

fn ramp_warning(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Option<String>, ExchangeError> {
    if unit.mode() != Mode::Serial {
        return Ok(None);
    }
    read_ramp(unit, line)?;
    Ok(unit.ramp.time_to_zero().filter(|time| *time > LONG_RAMP).map(|time| {
        format!(
            "Its ramp takes {:.1} s from full drive to 0 (VELOCITYLIMIT, TIMER). Stop takes the ramp away for as long as it needs.",
            time.as_secs_f64()
        )
    }))
}
