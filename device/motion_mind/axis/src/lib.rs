//! An [`Axis`] on a Motion Mind 3 in mode 4: which commands make its calls, whatever carries them.
//!
//! The unit has no command for a duty in this mode, and none is needed: with PTERM, ITERM and DTERM 0 and VELOCITYFF 255 a speed command
//! of n gives a duty of n steps, since only the feed-forward is left (Motion Mind manual 3.13). DISABLEPID takes every duty away.
//! Between the two kinds of drive the unit is off, and MOVETO_RELATIVE 0 makes it forget where it was going.
//!
//! The unit has no time-out on its serial line. A fence does its work: VNLIMIT and VPLIMIT are kept a little ahead of the motor,
//! so that it goes no farther when the host has died.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod clock;
mod fence;
pub mod law;
mod timing;

pub use timing::{BITS_PER_BYTE, worked_at};

use brushwork_motion_mind_wire::{Command, Part, Protocol, Reply, register_number as number, status};
use brushwork_tuning::axis::{Axis, AxisError, EncoderClass, Exchange, FULL_DUTY_RAW, Sample, Status, Want};
use brushwork_tuning::setup::{LoopAxis, Setup};
use clock::UnitClock;
use fence::Fence;
use law::{
    FULL_FEED_FORWARD, MotionMindHeld, MotionMindLaw, MotionMindRegisters, MotionMindSetup, MotionMindWrite,
    bits,
};
use std::time::Duration;

/// Steps of a full duty.
const FULL_PWM: i32 = law::FULL_PWM as i32;
/// Counts in a loop for counts/s.
const LOOPS_PER_S: i32 = law::LOOPS_PER_S as i32;
/// Steps of 10 mA in a step of AMPS.
const CURRENT_STEP: i64 = 2;
/// Bits per second from which on the line of all registers (up to 190 characters) takes about as long as two single ones.
const QUICK_LINE: u32 = 115_200;
/// Registers in RAM.
const REGISTERS: usize = 32;
/// Time between two looks at a motor that is to stand, and how long it may take to.
const LOOK_AGAIN: Duration = Duration::from_millis(30);
const STAND_LIMIT: Duration = Duration::from_secs(2);
/// It stands when so many looks in a row find it within so many counts of each other, and a loop holds it when it stays for so many
/// within so many of where it stood. The device thread's Stop looks as long.
const STILL_LOOKS: u32 = 4;
const STILL_COUNTS: i64 = 2;
const HELD_LOOKS: u32 = 10;
const HELD_COUNTS: i64 = 4;
/// How often a look is tried: of many one is lost more often than not.
const LOOK_TRIES: usize = 4;

/// What a run reads before it begins.
const SETUP: [u8; 13] = [
    number::VELOCITYFF,
    number::FUNCTION,
    number::PTERM,
    number::ITERM,
    number::DTERM,
    number::PIDSCALAR,
    number::MODE,
    number::VNLIMIT,
    number::VPLIMIT,
    number::DEADBAND,
    number::AMPSLIMIT,
    number::FUNCTION2,
    number::STATUS,
];

/// What carries commands to one unit.
pub trait MindCarrier {
    /// Sends a command and gives its reply. The exchange is that of the command's work: when the unit took it, as nearly as the
    /// carrier can tell.
    fn transact(&mut self, command: &Command) -> Result<(Exchange, Reply), AxisError>;
    /// Which protocol the unit speaks: only frames can ask for several registers at once.
    fn protocol(&self) -> Protocol;
    /// Bits per second of the line, as far as they are known.
    fn bits_per_second(&self) -> Option<u32>;
    /// The time.
    fn now(&mut self) -> Duration;
    /// Waits until a time.
    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError>;
    /// How long, since this was last asked, waits and replies had to wait for a processor of this computer.
    fn stolen(&mut self) -> Duration {
        Duration::ZERO
    }
    /// Tells whoever waits what is going on.
    fn progress(&mut self, _text: &str) {}
}

/// What drives the motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Driving {
    /// Whatever was before.
    Unknown,
    /// Nothing: DISABLEPID is set.
    Off,
    /// The feed-forward alone.
    Duty,
    /// The loop.
    Loop,
}

/// What became of the loop when the registers were put back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopAfter {
    /// It is as it was before the run, or as arming has made it: on.
    AsBefore,
    /// It did not hold the motor still, so that DISABLEPID is set.
    LeftOff,
}

/// An axis behind a carrier.
#[derive(Debug)]
pub struct MindAxis<C> {
    /// The carrier.
    pub carrier: C,
    before: Option<MotionMindRegisters>,
    trial: Option<MotionMindRegisters>,
    driving: Driving,
    /// What is known to be in RAM.
    known: [Option<i64>; REGISTERS],
    fence: Fence,
    clock: UnitClock,
    last_status: Status,
    /// Which line was asked for last besides the position.
    turn: usize,
}

impl<C: MindCarrier> MindAxis<C> {
    /// The axis of a unit.
    pub fn new(carrier: C) -> Self {
        Self {
            carrier,
            before: None,
            trial: None,
            driving: Driving::Unknown,
            known: [None; REGISTERS],
            fence: Fence::default(),
            clock: UnitClock::default(),
            last_status: Status::default(),
            turn: 0,
        }
    }

    /// Puts registers back, proven by reading them, without moving the motor. Where a run was cut short the loop may still want to be
    /// somewhere else: it is off meanwhile, and on again once the motor stands, to hold it there. `leaves_off` is for a run that has
    /// found the machine to be such that a loop could drive the motor away.
    ///
    /// # Errors
    /// Those of the carrier, and registers that read otherwise than they were written.
    pub fn put_back(
        &mut self,
        registers: MotionMindRegisters,
        leaves_off: bool,
    ) -> Result<LoopAfter, AxisError> {
        let off = bits::DISABLEPID;
        // A loop that was off before the run was switched on by arming, if anything was changed at all.
        let on = MotionMindRegisters { function: registers.function & !off, ..registers };
        let was_off = MotionMindRegisters { function: on.function | off, ..on };
        let found = self.held()?;
        if found == registers || found == on || (leaves_off && found == was_off) {
            return Ok(LoopAfter::AsBefore);
        }
        self.write(number::FUNCTION, i64::from(found.function | off))?;
        self.write_gains(&registers)?;
        self.write(number::VNLIMIT, i64::from(registers.virtual_limits.0))?;
        self.write(number::VPLIMIT, i64::from(registers.virtual_limits.1))?;
        self.write(number::FUNCTION, i64::from(was_off.function))?;
        let is_on = !leaves_off && self.switch_on(on.function)?;
        if self.held()? != if is_on { on } else { was_off } {
            return Err(AxisError::Refused("registers that read otherwise than they were written".into()));
        }
        Ok(if is_on || leaves_off { LoopAfter::AsBefore } else { LoopAfter::LeftOff })
    }

    /// The registers as they are.
    fn held(&mut self) -> Result<MotionMindRegisters, AxisError> {
        let setup: Setup<MotionMindLaw> = self.read_setup()?;
        setup.held.motion_mind.map(|unit| unit.registers).ok_or(AxisError::NoReply)
    }

    /// Switches the loop on where the motor stands, and off again if it moves the motor. Gives whether it is on.
    fn switch_on(&mut self, function: u16) -> Result<bool, AxisError> {
        let Some(here) = self.position_at_rest()? else { return Ok(false) };
        // A write to POSITION makes it the setpoint; the count stays what it is.
        self.write(number::POSITION, here)?;
        self.write(number::FUNCTION, i64::from(function))?;
        for _ in 0..HELD_LOOKS {
            if (self.look_again()? - here).abs() > HELD_COUNTS {
                self.write(number::FUNCTION, i64::from(function | bits::DISABLEPID))?;
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Where a motor without drive stands; `None` where it does not.
    fn position_at_rest(&mut self) -> Result<Option<i64>, AxisError> {
        let until = self.carrier.now() + STAND_LIMIT;
        let mut before = self.look_again()?;
        let mut still_looks = 0;
        while self.carrier.now() < until {
            let position = self.look_again()?;
            still_looks = if (position - before).abs() <= STILL_COUNTS { still_looks + 1 } else { 0 };
            if still_looks == STILL_LOOKS {
                return Ok(Some(position));
            }
            before = position;
        }
        Ok(None)
    }

    /// POSITION, a moment later.
    fn look_again(&mut self) -> Result<i64, AxisError> {
        let at = self.carrier.now() + LOOK_AGAIN;
        self.carrier.wait_until(at)?;
        for _ in 0..LOOK_TRIES {
            match self.registers(&[number::POSITION]) {
                Err(AxisError::NoReply | AxisError::Late) => {}
                other => {
                    let (_, values) = other?;
                    return values.first().map(|(_, position)| *position).ok_or(AxisError::NoReply);
                }
            }
        }
        Err(AxisError::NoReply)
    }

    fn registers(&mut self, wanted: &[u8]) -> Result<(Exchange, Vec<(u8, i64)>), AxisError> {
        if self.carrier.protocol() == Protocol::Binary {
            let mask = wanted.iter().fold(0, |mask, number| mask | 1 << number);
            return self.read(&Command::Read(mask));
        }
        let mut all = Vec::with_capacity(wanted.len());
        let mut first = None;
        for number in wanted {
            let (at, values) = self.read_line(*number)?;
            first.get_or_insert(at);
            all.extend(values);
        }
        first.map(|at| (at, all)).ok_or(AxisError::NoReply)
    }

    fn read(&mut self, command: &Command) -> Result<(Exchange, Vec<(u8, i64)>), AxisError> {
        match self.carrier.transact(command)? {
            (at, Reply::Registers(values)) => Ok((at, values)),
            _ => Err(AxisError::NoReply),
        }
    }

    /// One register of a line, asked for again once: of many lines one is lost more often than not.
    fn read_line(&mut self, register: u8) -> Result<(Exchange, Vec<(u8, i64)>), AxisError> {
        let command = Command::ReadText(Part::Register(register));
        match self.read(&command) {
            Err(AxisError::NoReply | AxisError::Late) if register != number::POSITION => self.read(&command),
            other => other,
        }
    }

    /// Whether a poll is one exchange, so that all of it is of one moment, the unit's time with it: a frame, or the line of all
    /// registers where that is as quick as two single ones.
    fn reads_whole(&self) -> bool {
        let is_quick = || self.carrier.bits_per_second().is_some_and(|bits| bits >= QUICK_LINE);
        self.carrier.protocol() == Protocol::Binary || is_quick()
    }

    /// What a poll in single lines asks for: the position, and one of the others in turn, since each line takes its time.
    fn next_lines(&mut self, want: Want) -> Vec<u8> {
        let others =
            [Some(number::STATUS), want.duty.then_some(number::PWMOUT), want.current.then_some(number::AMPS)];
        let others: Vec<u8> = others.into_iter().flatten().collect();
        self.turn = (self.turn + 1) % others.len();
        vec![number::POSITION, others[self.turn]]
    }

    /// Writes a register unless it is known to hold the value.
    fn set(&mut self, register: u8, value: i64) -> Result<(), AxisError> {
        if self.known[usize::from(register)] == Some(value) {
            return Ok(());
        }
        self.write(register, value).map(|_| ())
    }

    fn write(&mut self, register: u8, value: i64) -> Result<Exchange, AxisError> {
        self.known[usize::from(register)] = None;
        let (at, _) = self.carrier.transact(&Command::Write { register, value })?;
        self.known[usize::from(register)] = Some(value);
        Ok(at)
    }

    fn send(&mut self, command: Command) -> Result<Exchange, AxisError> {
        self.carrier.transact(&command).map(|(at, _)| at)
    }

    fn before(&self) -> Result<MotionMindRegisters, AxisError> {
        self.before.ok_or_else(|| AxisError::Refused("a command before the registers were read".into()))
    }

    /// FUNCTION during the run: a duty of 0 brakes, the fence holds, moves are not slowed down.
    fn running(function: u16) -> i64 {
        let set = bits::ACTIVESTOP | bits::VIRTLIMIT;
        i64::from((function | set) & !(bits::DISABLEPID | bits::VELLIMIT))
    }

    /// Takes the duty away, whatever gave it.
    fn off(&mut self) -> Result<Exchange, AxisError> {
        let function = self.before()?.function;
        let at = self.write(number::FUNCTION, Self::running(function) | i64::from(bits::DISABLEPID))?;
        self.send(Command::MoveAtVelocity(0))?;
        self.driving = Driving::Off;
        Ok(at)
    }

    fn end(&mut self, registers: MotionMindRegisters) -> Result<(), AxisError> {
        self.off()?;
        self.write_gains(&registers)?;
        let (low, high) = registers.virtual_limits;
        self.write(number::VNLIMIT, i64::from(low))?;
        self.write(number::VPLIMIT, i64::from(high))?;
        self.send(Command::MoveToRelative(0))?;
        self.write(number::FUNCTION, i64::from(registers.function))?;
        self.driving = Driving::Unknown;
        Ok(())
    }

    fn write_gains(&mut self, registers: &MotionMindRegisters) -> Result<(), AxisError> {
        let values = [
            (number::PTERM, i64::from(registers.pterm)),
            (number::ITERM, i64::from(registers.iterm)),
            (number::DTERM, i64::from(registers.dterm)),
            (number::PIDSCALAR, i64::from(registers.pidscalar)),
            (number::VELOCITYFF, i64::from(registers.velocity_ff)),
            (number::DEADBAND, i64::from(registers.deadband)),
            (number::FUNCTION2, i64::from(registers.function2)),
        ];
        values.into_iter().try_for_each(|(register, value)| self.set(register, value))
    }

    /// Gives the motor to the loop of the registers that were written last: it holds where it is.
    fn close(&mut self) -> Result<(), AxisError> {
        if self.driving == Driving::Loop {
            return Ok(());
        }
        let Some(trial) = self.trial else {
            return Err(AxisError::Refused("a loop before its gains".into()));
        };
        if self.driving != Driving::Off {
            self.off()?;
        }
        self.write_gains(&trial)?;
        self.send(Command::MoveToRelative(0))?;
        self.write(number::FUNCTION, Self::running(trial.function))?;
        self.driving = Driving::Loop;
        Ok(())
    }

    /// Moves the fence where it has come too near.
    fn mend_fence(&mut self) -> Result<(), AxisError> {
        let (low, high) = self.fence.due();
        if let Some(counts) = low {
            self.write(number::VNLIMIT, i64::from(counts))?;
            self.fence.low = Some(counts);
        }
        if let Some(counts) = high {
            self.write(number::VPLIMIT, i64::from(counts))?;
            self.fence.high = Some(counts);
        }
        Ok(())
    }
}

impl<C: MindCarrier> Axis for MindAxis<C> {
    fn now(&mut self) -> Duration {
        self.carrier.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.carrier.wait_until(time)
    }

    fn sample(&mut self, want: Want) -> Result<Sample, AxisError> {
        let is_whole = self.reads_whole();
        let wanted = if is_whole { whole(want) } else { self.next_lines(want) };
        let (read_at, values) = if self.carrier.protocol() == Protocol::Text && is_whole {
            self.read(&Command::ReadText(Part::All))?
        } else {
            self.registers(&wanted)?
        };
        let value = |wanted: u8| values.iter().find(|(number, _)| *number == wanted).map(|(_, value)| *value);
        // The casts are those of the registers' own widths.
        let counts = value(number::POSITION).ok_or(AxisError::NoReply)? as i32;
        let at = match value(number::TIME) {
            Some(time) => self.clock.stamp(read_at, time as u32),
            None => read_at,
        };
        if let Some(word) = value(number::STATUS) {
            self.last_status = status_of(word as u16);
        }
        let duty_raw = value(number::PWMOUT).filter(|_| want.duty).map(|steps| (at, duty_of(steps as i32)));
        let current_raw =
            value(number::AMPS).filter(|_| want.current).map(|steps| (steps * CURRENT_STEP) as i16);
        self.fence.see(at.middle_s(), counts);
        let word = self.last_status.raw;
        let is_at = |mask: u16, up: bool| word & u32::from(mask) != 0 && !self.fence.is_travel(up);
        if self.driving != Driving::Off && (is_at(status::VPLIMIT, true) || is_at(status::VNLIMIT, false)) {
            self.fence.was_hit();
        }
        if matches!(self.driving, Driving::Duty | Driving::Loop) {
            // A fence that cannot be moved stops the motor; the next poll tries again.
            match self.mend_fence() {
                Err(AxisError::NoReply | AxisError::Late) | Ok(()) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Sample {
            counts_at: at,
            counts: [counts, 0],
            status: self.last_status,
            duty_raw,
            current_raw,
            volts_raw: None,
        })
    }

    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        let steps = steps_of(duty_raw);
        self.fence.drive(f64::from(steps) / f64::from(FULL_PWM));
        if self.driving != Driving::Duty {
            let at = self.off()?;
            if steps == 0 {
                return Ok(at);
            }
            let before = self.before()?;
            self.write_gains(&MotionMindRegisters {
                pterm: 0,
                iterm: 0,
                dterm: 0,
                velocity_ff: FULL_FEED_FORWARD,
                function2: before.function2 & !(bits::NEWVELMODE | bits::FASTPID),
                ..before
            })?;
        }
        if steps != 0 {
            self.mend_fence()?;
        }
        let mut at = self.send(Command::MoveAtVelocity(steps))?;
        if self.driving != Driving::Duty {
            let function = self.before()?.function & !bits::ENABLEDB;
            at = self.write(number::FUNCTION, Self::running(function))?;
            self.driving = Driving::Duty;
        }
        Ok(at)
    }

    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        self.close()?;
        self.fence.head_at(f64::from(counts_per_s));
        self.mend_fence()?;
        let counts = counts_per_s.div_euclid(LOOPS_PER_S);
        self.send(Command::MoveAtVelocity(counts.clamp(-32_768, 32_767) as i16))
    }

    fn command_position(&mut self, counts: i32, _speed: u32) -> Result<Exchange, AxisError> {
        self.close()?;
        self.fence.head_for(f64::from(counts));
        self.mend_fence()?;
        self.send(Command::MoveToAbsolute(counts))
    }

    fn write_winding(&mut self, _: [u32; 2]) -> Result<(), AxisError> {
        Err(AxisError::Refused("inductance and resistance".into()))
    }

    fn write_current_limits(&mut self, max_raw: u32, _: i32) -> Result<(), AxisError> {
        let steps = (i64::from(max_raw) / CURRENT_STEP).min(1023);
        self.write(number::AMPSLIMIT, steps).map(|_| ())
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        Err(AxisError::Refused("a speed that is not a mean".into()))
    }

    fn set_stream_timeout(&mut self, _: u32) -> Result<(), AxisError> {
        Err(AxisError::Refused("a time-out".into()))
    }

    fn set_travel(&mut self, counts: (i64, i64)) -> Result<(), AxisError> {
        self.fence.travel = Some(counts);
        Ok(())
    }

    fn stolen(&mut self) -> Duration {
        self.carrier.stolen()
    }

    fn progress(&mut self, text: &str) {
        self.carrier.progress(text);
    }
}

impl<C: MindCarrier> LoopAxis<MotionMindLaw> for MindAxis<C> {
    fn read_setup(&mut self) -> Result<Setup<MotionMindLaw>, AxisError> {
        let (_, values) = self.registers(&SETUP)?;
        for (number, value) in &values {
            self.known[usize::from(*number)] = Some(*value);
        }
        let value = |wanted: u8| {
            let found = values.iter().find(|(number, _)| *number == wanted);
            found.map(|(_, value)| *value).ok_or(AxisError::NoReply)
        };
        // The casts are those of the registers' own widths.
        let registers = MotionMindRegisters {
            pterm: value(number::PTERM)? as u16,
            iterm: value(number::ITERM)? as u16,
            dterm: value(number::DTERM)? as u16,
            pidscalar: value(number::PIDSCALAR)? as u8,
            velocity_ff: value(number::VELOCITYFF)? as u8,
            deadband: value(number::DEADBAND)? as u16,
            function: value(number::FUNCTION)? as u16,
            function2: value(number::FUNCTION2)? as u16,
            virtual_limits: (value(number::VNLIMIT)? as i32, value(number::VPLIMIT)? as i32),
        };
        self.before = Some(registers);
        let mode = value(number::MODE)? as u8;
        let unit = MotionMindSetup { mode, registers, is_undated: !self.reads_whole() };
        Ok(Setup {
            held: MotionMindHeld { motion_mind: Some(unit) },
            max_current_raw: (value(number::AMPSLIMIT)? * CURRENT_STEP) as u32,
            encoder: EncoderClass::Quadrature,
            ..Setup::default()
        })
    }

    fn write(&mut self, write: MotionMindWrite) -> Result<(), AxisError> {
        match write {
            MotionMindWrite::Loop(registers) => {
                self.off()?;
                self.write_gains(&registers)?;
                self.trial = Some(registers);
                Ok(())
            }
            MotionMindWrite::End(registers) => self.end(registers),
        }
    }
}

/// The registers of a poll that is one exchange.
fn whole(want: Want) -> Vec<u8> {
    let mut wanted = vec![number::POSITION, number::TIME, number::STATUS];
    wanted.extend(want.duty.then_some(number::PWMOUT));
    wanted.extend(want.current.then_some(number::AMPS));
    wanted
}

/// What STATUS says to a run. A limit input or the brake keeps the motor from what it is commanded.
fn status_of(word: u16) -> Status {
    let has = |mask: u16| word & mask != 0;
    Status {
        over_current: has(status::CURRENTLIMIT),
        battery_low: false,
        fault: has(status::TEMPFAULT | status::BRAKE | status::NEGLIMIT | status::POSLIMIT),
        raw: u32::from(word),
    }
}

fn steps_of(duty_raw: i16) -> i16 {
    let full = i32::from(FULL_DUTY_RAW);
    let scaled = i32::from(duty_raw) * FULL_PWM;
    ((scaled + scaled.signum() * full / 2) / full).clamp(-FULL_PWM, FULL_PWM) as i16
}

fn duty_of(steps: i32) -> i16 {
    (steps * i32::from(FULL_DUTY_RAW) / FULL_PWM).clamp(-32_767, 32_767) as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn duties_and_steps_are_each_others_inverse() {
        for steps in -1023..=1023 {
            assert_eq!(steps_of(duty_of(steps)), steps as i16);
        }
    }
}
