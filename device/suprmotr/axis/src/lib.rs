//! An [`Axis`] on a SuprMotr V9: which commands make its calls, whatever carries them.
//!
//! The board takes no duty: its loop always has the motor, and a run moves it by places alone. Moves go with the highest DV and DA, so that the loop
//! and not the trajectory says how quick they are; both are put back at the end. The end of every drive is `!`, which makes the place where the motor
//! is the target.
//!
//! What fences a move whose host has died is on the board: its limit switches, and the following error that SM allows.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod law;
mod timing;

pub use timing::worked_at;

use brushwork_suprmotr_wire::{Command, Mnemonic, Status, inputs, limits, motion};
use brushwork_tuning::axis::{Axis, AxisError, EncoderClass, Exchange, Sample, Status as AxisStatus, Want};
use brushwork_tuning::setup::{LoopAxis, Setup};
use law::{MovePace, SuprMotrHeld, SuprMotrLaw, SuprMotrRegisters, SuprMotrSetup, SuprMotrWrite, quickest};
use std::time::Duration;

/// The status is read with every so many positions: its report is half as long again as a position's.
const STATUS_EVERY: u32 = 4;

/// What a unit says to a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The number that was asked for.
    Number(i32),
    /// The status: asked for, or behind a command that reports nothing.
    Status(Status),
}

/// What carries commands to one unit. AB without its number is `!`.
pub trait SuprMotrCarrier {
    /// Sends a command and gives its answer. The exchange is that of the command's work: when the unit took it, as nearly as the carrier can tell.
    fn transact(&mut self, command: Command) -> Result<(Exchange, Answer), AxisError>;
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

/// A number that a run writes: the command that writes it and the one that tells it.
type Held = (Mnemonic, Mnemonic);

const P: Held = (Mnemonic::DP, Mnemonic::GP);
const I: Held = (Mnemonic::DI, Mnemonic::GI);
const D: Held = (Mnemonic::DD, Mnemonic::GD);
const INTEGRAL_LIMIT: Held = (Mnemonic::DL, Mnemonic::GL);
const VELOCITY: Held = (Mnemonic::DV, Mnemonic::GV);
const ACCELERATION: Held = (Mnemonic::DA, Mnemonic::GA);

/// An axis behind a carrier.
#[derive(Debug)]
pub struct SuprMotrAxis<C> {
    /// The carrier.
    pub carrier: C,
    /// What is known to be in force.
    known: Vec<(Mnemonic, i32)>,
    /// A move of the run was commanded: from here on a motor that is off, or a move that a limit ends, is a fault.
    is_driven: bool,
    last_status: AxisStatus,
    polls: u32,
}

impl<C: SuprMotrCarrier> SuprMotrAxis<C> {
    /// The axis of a unit.
    pub fn new(carrier: C) -> Self {
        Self { carrier, known: Vec::new(), is_driven: false, last_status: AxisStatus::default(), polls: 0 }
    }

    /// Puts gains and pace back, proven by reading them; moves nothing. `leaves_off` lets the motor go.
    ///
    /// # Errors
    /// Those of the carrier, and numbers that read otherwise than they were written.
    pub fn put_back(&mut self, setup: SuprMotrSetup, leaves_off: bool) -> Result<(), AxisError> {
        if leaves_off {
            self.carrier.transact(Command::plain(Mnemonic::MF))?;
        }
        if self.held()? == setup {
            return Ok(());
        }
        self.write_all(setup)?;
        if self.held()? == setup {
            Ok(())
        } else {
            Err(AxisError::Refused("gains that read otherwise than they were written".into()))
        }
    }

    fn number(&mut self, (write, read): Held) -> Result<i32, AxisError> {
        match self.carrier.transact(Command::plain(read))?.1 {
            Answer::Number(number) => {
                self.note(write, number);
                Ok(number)
            }
            Answer::Status(_) => Err(AxisError::NoReply),
        }
    }

    fn note(&mut self, write: Mnemonic, number: i32) {
        self.known.retain(|(known, _)| *known != write);
        self.known.push((write, number));
    }

    /// Writes a number unless it is known to be in force.
    fn set(&mut self, (write, _): Held, number: i32) -> Result<(), AxisError> {
        if self.known.contains(&(write, number)) {
            return Ok(());
        }
        self.known.retain(|(known, _)| *known != write);
        self.carrier.transact(Command::with(write, number))?;
        self.note(write, number);
        Ok(())
    }

    fn held(&mut self) -> Result<SuprMotrSetup, AxisError> {
        // The board's range is a byte.
        let mut byte = |of: Held| self.number(of).map(|number| number.clamp(0, 0xFF) as u8);
        let registers = SuprMotrRegisters {
            p: byte(P)?,
            i: byte(I)?,
            d: byte(D)?,
            integral_limit: byte(INTEGRAL_LIMIT)?,
        };
        let pace = MovePace { velocity: self.number(VELOCITY)?, acceleration: self.number(ACCELERATION)? };
        Ok(SuprMotrSetup { registers, pace })
    }

    /// The gains. D before P where P goes up, and after it where P goes down: what damps is there as long as what has to be damped.
    fn write_gains(&mut self, registers: SuprMotrRegisters) -> Result<(), AxisError> {
        let p = i32::from(registers.p);
        let is_stiffer = !self.known.iter().any(|(known, before)| *known == Mnemonic::DP && *before >= p);
        self.set(INTEGRAL_LIMIT, registers.integral_limit.into())?;
        self.set(I, registers.i.into())?;
        if is_stiffer {
            self.set(D, registers.d.into())?;
        }
        self.set(P, p)?;
        self.set(D, registers.d.into())
    }

    fn set_pace(&mut self, pace: MovePace) -> Result<(), AxisError> {
        self.set(VELOCITY, pace.velocity)?;
        self.set(ACCELERATION, pace.acceleration)
    }

    fn write_all(&mut self, setup: SuprMotrSetup) -> Result<(), AxisError> {
        self.write_gains(setup.registers)?;
        self.set_pace(setup.pace)
    }

    fn stop(&mut self) -> Result<Exchange, AxisError> {
        self.carrier.transact(Command::plain(Mnemonic::AB)).map(|(at, _)| at)
    }

    /// What the status says to a run.
    fn status_of(&self, status: Status) -> AxisStatus {
        let is_off = !status.is_motor_on() || status.motion & motion::EXCESSIVE_ERROR != 0;
        let at_limit = status.limits & limits::ENABLED != 0
            && status.inputs & (inputs::NEGATIVE | inputs::POSITIVE) != 0
            && status.motion & motion::MOVE_ERROR != 0;
        AxisStatus {
            fault: self.is_driven && (is_off || at_limit),
            raw: status.motion.into(),
            ..AxisStatus::default()
        }
    }
}

impl<C: SuprMotrCarrier> Axis for SuprMotrAxis<C> {
    fn now(&mut self) -> Duration {
        self.carrier.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.carrier.wait_until(time)
    }

    fn sample(&mut self, _want: Want) -> Result<Sample, AxisError> {
        self.polls = self.polls.wrapping_add(1);
        if self.polls.is_multiple_of(STATUS_EVERY)
            && let Answer::Status(status) = self.carrier.transact(Command::plain(Mnemonic::TS))?.1
        {
            self.last_status = self.status_of(status);
        }
        let (at, answer) = self.carrier.transact(Command::plain(Mnemonic::TP))?;
        let Answer::Number(counts) = answer else { return Err(AxisError::NoReply) };
        Ok(Sample {
            counts_at: at,
            counts: [counts, 0],
            status: self.last_status,
            duty_raw: None,
            current_raw: None,
            volts_raw: None,
        })
    }

    /// None but 0, which ends whatever move there is.
    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        if duty_raw != 0 {
            return Err(AxisError::Refused("a duty".into()));
        }
        self.stop()
    }

    fn command_speed(&mut self, _: i32) -> Result<Exchange, AxisError> {
        Err(AxisError::Refused("a speed".into()))
    }

    fn command_position(&mut self, counts: i32, speed: u32) -> Result<Exchange, AxisError> {
        let most = quickest();
        let velocity = i32::try_from(speed).unwrap_or(i32::MAX).clamp(1, most.velocity);
        self.set_pace(MovePace { velocity, ..most })?;
        self.is_driven = true;
        self.carrier.transact(Command::with(Mnemonic::MA, counts)).map(|(at, _)| at)
    }

    fn write_winding(&mut self, _: [u32; 2]) -> Result<(), AxisError> {
        Err(AxisError::Refused("inductance and resistance".into()))
    }

    fn write_current_limits(&mut self, _: u32, _: i32) -> Result<(), AxisError> {
        Err(AxisError::Refused("a current limit".into()))
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        Err(AxisError::Refused("a speed that is not a mean".into()))
    }

    fn set_stream_timeout(&mut self, _: u32) -> Result<(), AxisError> {
        Err(AxisError::Refused("a time-out".into()))
    }

    fn stolen(&mut self) -> Duration {
        self.carrier.stolen()
    }

    fn progress(&mut self, text: &str) {
        self.carrier.progress(text);
    }
}

impl<C: SuprMotrCarrier> LoopAxis<SuprMotrLaw> for SuprMotrAxis<C> {
    fn read_setup(&mut self) -> Result<Setup<SuprMotrLaw>, AxisError> {
        let held = SuprMotrHeld { suprmotr: Some(self.held()?) };
        Ok(Setup { held, encoder: EncoderClass::Quadrature, ..Setup::default() })
    }

    /// The target becomes the place first, so that other gains find nothing to do.
    fn write(&mut self, write: SuprMotrWrite) -> Result<(), AxisError> {
        self.stop()?;
        match write {
            SuprMotrWrite::Loop(registers) => self.write_gains(registers),
            SuprMotrWrite::End(setup, is_off) => {
                if is_off {
                    self.carrier.transact(Command::plain(Mnemonic::MF))?;
                }
                self.write_all(setup)
            }
        }
    }
}

#[cfg(test)]
mod tests;
