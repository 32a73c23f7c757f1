//! Stopping a unit: at once without asking, then again with its confirmation and a look at its motor, and what can still drive it.
//!
//! A Motion Mind has no command "stop". Mode 3 is stopped by duty 0, which follows its ramp: so the ramp is taken away first and put
//! back when the motor stands. Modes 4 and 5 are stopped by a setpoint that stands, which their loop must follow: where it does not,
//! the output of the loop is switched off (DISABLEPID) until the motor stands, and is left so, until the next arming, where the loop
//! does not hold the motor still then either. Both are writes to RAM alone.

use crate::controller::borrowed::{Borrowed, Ramp, STEEPEST};
use crate::controller::registers::{mask, value_in};
use crate::controller::speaker::{GAP, Speaker};
use crate::controller::unit::MotionMind;
use crate::messages::{
    MotionMindActMessage, MotionMindCauseMessage, MotionMindDriverMessage, MotionMindRemedyMessage,
};
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{StopBytes, UnitStop};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_motion_mind_wire::{Address, Command, Mode, Protocol, function, register_number as number};
use std::time::Duration;

/// A loop that holds its motor may move it by so many counts between two looks.
const STILL_COUNTS: i64 = 2;
/// Time between two looks at the motor.
const LOOK_AGAIN: Duration = Duration::from_millis(30);
/// So many looks in a row must find it still: a motor that oscillates stands still where it turns.
const STILL_LOOKS: u32 = 4;
/// A loop that has not brought its motor to a stand within this is switched off.
const LOOP_LIMIT: Duration = Duration::from_millis(800);
/// How long a motor may take to stand once its loop is off: it coasts, or something turns it.
const STAND_LIMIT: Duration = Duration::from_secs(2);
/// A loop that was switched on again must hold its motor for so many looks, within so many counts of where it stood. A loop that oscillates
/// needs a few turns to show it: more looks than a motor that is only stopped.
const HELD_LOOKS: u32 = 10;
const HELD_COUNTS: i64 = 4;
/// Drive in mode 3 changes at the next update of TIMER, which is at most 1.3 s away.
const DUTY_LIMIT: Duration = Duration::from_millis(1600);

/// A reply that was on its way when the stop broke in is done within this: 10 ms of the controller, a line of text, a USB adapter.
const BROKEN_INTO: Duration = Duration::from_millis(40);
/// The longest reply is done within this: all registers in text, about 500 characters at 19,200 baud.
const LATE_REPLY: Duration = Duration::from_millis(300);

/// What stands a motor in a mode; nothing where serial commands do not move it.
fn commands(mode: Mode) -> Option<Command> {
    match mode {
        Mode::Serial => Some(Command::ChangeSpeed(0)),
        Mode::SerialPid => Some(Command::MoveAtVelocity(0)),
        Mode::AnalogPid => Some(Command::MoveToRelative(0)),
        Mode::RadioControl | Mode::Analog | Mode::Buttons | Mode::FactoryRestore | Mode::FactoryTest => None,
    }
}

/// The frames that stop a unit. In a mode in which serial commands move nothing, duty 0 all the same: it does no harm.
pub fn bytes(speaker: &Speaker, mode: Mode, ramp: Ramp) -> StopBytes {
    let stop = commands(mode).unwrap_or(Command::ChangeSpeed(0));
    let steepest = Command::Write { register: number::VELOCITYLIMIT, value: STEEPEST };
    let ramp_away = (mode == Mode::Serial && ramp.is_slow()).then_some(steepest);
    // These commands fit both protocols at every address of one unit.
    let frame = |command: Command| speaker.encode(&command).ok();
    StopBytes {
        first: frame(stop).into_iter().collect(),
        after: ramp_away.and_then(frame).into_iter().collect(),
        gap: GAP,
    }
}

/// The frames that stop every unit of the bus in these modes, in one of the protocols: all hear them and none answers.
pub fn broadcast(modes: &[Mode], protocol: Protocol) -> StopBytes {
    of_modes(&Speaker::new(Address::BROADCAST, protocol), modes)
}

/// The frames that stop a unit, or all of them, in whichever of these modes it is.
pub fn of_modes(speaker: &Speaker, modes: &[Mode]) -> StopBytes {
    let mut stops: Vec<Command> = modes.iter().filter_map(|mode| commands(*mode)).collect();
    stops.dedup();
    let first = stops.iter().filter_map(|stop| speaker.encode(stop).ok()).collect();
    StopBytes { first, after: Vec::new(), gap: GAP }
}

/// Stops with confirmation: by the acknowledge, and by reading that the drive is 0 or the motor stands. Only what breaks in and a
/// lost link are errors.
pub fn confirm(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<UnitStop, ExchangeError> {
    let on = unit.name(line);
    let mut stop = UnitStop::new(unit.identity.address);
    // The answers of the unit do not say which question they answer, so none may be late any more.
    if line.exchange().may_hear_late_replies() {
        let (exchange, watch) = line.parts();
        let quiet = if exchange.is_slow_to_reply() { LATE_REPLY } else { BROKEN_INTO };
        // On a late line what the stop broke into is still on its way for as long as any reply takes there.
        let lateness = if exchange.is_late() { exchange.longest_turnaround() } else { Duration::ZERO };
        exchange.drain(quiet + lateness, watch)?;
    }
    let failed = |came_back: Message| {
        Failure::new(MotionMindActMessage::Stop, on, came_back, MotionMindRemedyMessage::CutPower)
    };
    match stand(unit, line) {
        Ok(Ended::Stands) => stop.confirmed = true,
        Ok(Ended::SwitchedOff) => {
            stop.confirmed = true;
            stop.loop_left_off = true;
            stop.still_driven_by.push(MotionMindDriverMessage::LoopLeftOff.into());
        }
        Ok(Ended::Calmed) => {
            stop.confirmed = true;
            stop.still_driven_by.push(MotionMindDriverMessage::LoopCalmed.into());
        }
        Ok(Ended::StillDriven) => {
            stop.failures.push(failed(MotionMindCauseMessage::NotAtRest.into()));
        }
        Err(error) => {
            pass_on(&error)?;
            stop.failures.push(failed(error.message()));
        }
    }
    Ok(stop)
}

enum Ended {
    Stands,
    SwitchedOff,
    /// It was switched off for a while.
    Calmed,
    StillDriven,
}

fn stand(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Ended, ExchangeError> {
    let mode = unit.mode();
    let Some(stop) = commands(mode) else {
        // Nothing of this program moves it; that it answers is all there is to know.
        look(unit, line)?;
        return Ok(Ended::Stands);
    };
    unit.speaker.ask(line, &stop)?;
    if mode == Mode::Serial { stand_open_loop(unit, line) } else { stand_closed_loop(unit, line) }
}

/// Mode 3: takes a slow ramp away, waits until the drive is 0, and puts the ramp back.
fn stand_open_loop(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Ended, ExchangeError> {
    // The bytes of the stop have taken a ramp away that was known to be slow.
    if let Some(value) = unit.ramp.step.filter(|_| unit.ramp.is_slow()) {
        lend(unit, Borrowed { register: number::VELOCITYLIMIT, value });
    }
    read_ramp(unit, line)?;
    if unit.ramp.is_slow() {
        let value = unit.ramp.step.unwrap_or(STEEPEST);
        borrow(unit, line, Borrowed { register: number::VELOCITYLIMIT, value }, STEEPEST)?;
    }
    let begun_at = line.exchange().clock().now();
    loop {
        let (_, duty) = look(unit, line)?;
        if duty == 0 {
            give_back(unit, line, number::VELOCITYLIMIT)?;
            return Ok(Ended::Stands);
        }
        if line.exchange().clock().now() >= begun_at + DUTY_LIMIT {
            return Ok(Ended::StillDriven);
        }
        rest(line)?;
    }
}

/// Modes 4 and 5: waits until the motor stands; a loop that does not bring it there is switched off.
fn stand_closed_loop(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Ended, ExchangeError> {
    let begun_at = line.exchange().clock().now();
    let (mut before, _) = look(unit, line)?;
    let mut still_looks = 0;
    loop {
        rest(line)?;
        let (position, duty) = look(unit, line)?;
        if duty == 0 && was_switched_off(unit, line)? {
            return Ok(Ended::SwitchedOff);
        }
        still_looks = if (position - before).abs() <= STILL_COUNTS { still_looks + 1 } else { 0 };
        if still_looks == STILL_LOOKS {
            return Ok(Ended::Stands);
        }
        if line.exchange().clock().now() >= begun_at + LOOP_LIMIT {
            break;
        }
        before = position;
    }
    let function = read(unit, line, number::FUNCTION)?;
    let off = function | i64::from(function::DISABLEPID);
    borrow(unit, line, Borrowed { register: number::FUNCTION, value: function }, off)?;
    rest(line)?;
    let (_, duty) = look(unit, line)?;
    if duty != 0 {
        return Ok(Ended::StillDriven);
    }
    Ok(if switch_on(unit, line, function)? { Ended::Calmed } else { Ended::SwitchedOff })
}

/// Switches on a loop whose output is off, by writing FUNCTION as it is then to be. The motor must stand, its setpoint is first set to
/// where it stands, and it is watched for not moving: a loop that moves it is switched off again. Gives whether it is on.
pub fn switch_on(unit: &mut MotionMind, line: &mut Line<'_>, function: i64) -> Result<bool, ExchangeError> {
    let Some(here) = place_at_rest(unit, line)? else { return Ok(false) };
    // A write to POSITION makes it the setpoint; the count stays what it is.
    unit.speaker.ask(line, &Command::Write { register: number::POSITION, value: here })?;
    lend(unit, Borrowed { register: number::FUNCTION, value: function });
    unit.speaker.ask(line, &Command::Write { register: number::FUNCTION, value: function })?;
    for _ in 0..HELD_LOOKS {
        rest(line)?;
        let (position, _) = look(unit, line)?;
        if (position - here).abs() > HELD_COUNTS {
            let off = function | i64::from(function::DISABLEPID);
            unit.speaker.ask(line, &Command::Write { register: number::FUNCTION, value: off })?;
            return Ok(false);
        }
    }
    unit.borrowed.retain(|borrowed| borrowed.register != number::FUNCTION);
    Ok(true)
}

/// Whether an earlier stop has left the loop off.
fn was_switched_off(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<bool, ExchangeError> {
    let is_ours = unit.borrowed.iter().any(|borrowed| borrowed.register == number::FUNCTION);
    Ok(is_ours && read(unit, line, number::FUNCTION)? & i64::from(function::DISABLEPID) != 0)
}

/// Where a motor without drive stands; `None` where it does not.
fn place_at_rest(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Option<i64>, ExchangeError> {
    let begun_at = line.exchange().clock().now();
    let (mut before, _) = look(unit, line)?;
    let mut still_looks = 0;
    while line.exchange().clock().now() < begun_at + STAND_LIMIT {
        rest(line)?;
        let (position, _) = look(unit, line)?;
        still_looks = if (position - before).abs() <= STILL_COUNTS { still_looks + 1 } else { 0 };
        if still_looks == STILL_LOOKS {
            return Ok(Some(position));
        }
        before = position;
    }
    Ok(None)
}

/// POSITION and PWMOUT.
fn look(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<(i64, i64), ExchangeError> {
    if unit.speaker.protocol == Protocol::Text {
        // All registers at once take longer than two lines.
        return Ok((read(unit, line, number::POSITION)?, read(unit, line, number::PWMOUT)?));
    }
    let registers = mask(&[number::POSITION, number::PWMOUT]);
    let (reply, _) = unit.speaker.ask(line, &Command::Read(registers))?;
    let value = |index| value_in(&reply, index).unwrap_or(i64::MAX);
    Ok((value(number::POSITION), value(number::PWMOUT)))
}

fn rest(line: &mut Line<'_>) -> Result<(), ExchangeError> {
    let (exchange, watch) = line.parts();
    exchange.wait(LOOK_AGAIN, watch)
}

pub fn read(unit: &mut MotionMind, line: &mut Line<'_>, register: u8) -> Result<i64, ExchangeError> {
    let (reply, _) = unit.speaker.ask(line, &Command::ReadRegister(register))?;
    value_in(&reply, register)
        .ok_or_else(|| ExchangeError::impossible(MotionMindCauseMessage::RegisterMissing { register }))
}

/// Reads VELOCITYLIMIT and TIMER.
pub fn read_ramp(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<(), ExchangeError> {
    let borrowed = unit.borrowed.iter().any(|borrowed| borrowed.register == number::VELOCITYLIMIT);
    let registers = mask(&[number::VELOCITYLIMIT, number::TIMER]);
    let (reply, _) = unit.speaker.ask(line, &Command::Read(registers))?;
    if !borrowed {
        unit.ramp.step = value_in(&reply, number::VELOCITYLIMIT);
    }
    unit.ramp.timer = value_in(&reply, number::TIMER);
    Ok(())
}

/// Changes a register in RAM for a while. What it held before is remembered first: the write may have been done though its
/// acknowledge is lost.
fn borrow(
    unit: &mut MotionMind,
    line: &mut Line<'_>,
    borrowed: Borrowed,
    value: i64,
) -> Result<(), ExchangeError> {
    lend(unit, borrowed);
    unit.speaker.ask(line, &Command::Write { register: borrowed.register, value }).map(drop)
}

/// Remembers what a register held before a stop changed it.
fn lend(unit: &mut MotionMind, borrowed: Borrowed) {
    if !unit.borrowed.iter().any(|known| known.register == borrowed.register) {
        unit.borrowed.push(borrowed);
    }
}

/// Puts a register back that a stop has changed.
pub fn give_back(unit: &mut MotionMind, line: &mut Line<'_>, register: u8) -> Result<(), ExchangeError> {
    let Some(at) = unit.borrowed.iter().position(|borrowed| borrowed.register == register) else {
        return Ok(());
    };
    let Borrowed { register, value } = unit.borrowed[at];
    unit.speaker.ask(line, &Command::Write { register, value })?;
    unit.borrowed.remove(at);
    Ok(())
}

/// What moves the motor without this program: the inputs of its mode, or the loop that holds it.
pub fn other_drivers(unit: &mut MotionMind, line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError> {
    let function = read(unit, line, number::FUNCTION)?;
    let is_set = |bit: u16| function & i64::from(bit) != 0;
    let is_off = is_set(function::DISABLEPID);
    let reported = match unit.mode() {
        Mode::RadioControl if is_set(function::RCPOS) && is_off => None,
        Mode::RadioControl => Some(MotionMindDriverMessage::RadioInput),
        Mode::Analog => Some(MotionMindDriverMessage::AnalogInput),
        Mode::Buttons => Some(MotionMindDriverMessage::Buttons),
        Mode::AnalogPid if !is_off && !is_set(function::ADSERIAL) => {
            Some(MotionMindDriverMessage::AnalogSetpoint)
        }
        Mode::SerialPid | Mode::AnalogPid if !is_off => Some(MotionMindDriverMessage::LoopHolds),
        Mode::Serial | Mode::SerialPid | Mode::AnalogPid | Mode::FactoryRestore | Mode::FactoryTest => None,
    };
    Ok(reported.map(Message::from).into_iter().collect())
}

/// A lost link and what breaks in are not a matter of one unit.
fn pass_on(error: &ExchangeError) -> Result<(), ExchangeError> {
    if error.is_link_lost() || error.interruption().is_some() { Err(error.clone()) } else { Ok(()) }
}
