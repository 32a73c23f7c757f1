//! An [`Axis`] in packet serial: which commands make its calls, whatever carries them.
//!
//! The device thread of the program and the simulated link of the tuning bench both carry them, so that what is measured is what is
//! shipped. [`McpLaw`] is what the tuner knows of the controller's loops.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod derivative;
mod law;
mod probe;
mod probed;
mod registers;
mod table;

pub use probe::{LawFindings, Timing, probe_law};
pub use registers::{
    McpHeld, McpLaw, McpNote, McpRegisters, McpWrite, PositionRegisters, VelocityRegisters, gains_of,
    position_registers, velocity_gains, velocity_registers,
};

use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::status::{Condition, decode};
use brushwork_mcp_wire::packet_serial::{Generation, Given, Read, Typed, commands, give, scale};
use brushwork_tuning::axis::{Axis, AxisError, EncoderClass, Exchange, Sample, Status, TestedLoop, Want};
use brushwork_tuning::setup::{LoopAxis, Setup};
use brushwork_values::Motor;
use std::collections::BTreeSet;
use std::time::Duration;

/// How often a command that not every controller has is tried before its silence counts as an answer.
const TRIES: usize = 4;

/// A reply with the times of its exchange.
pub type Timed<const LAYOUT: u8> = Result<(Exchange, Read<LAYOUT>), AxisError>;

/// What carries commands to one unit.
pub trait Carrier {
    /// Sends a command with its values by name and gives its reply.
    fn transact<const LAYOUT: u8>(
        &mut self,
        command: Typed<LAYOUT>,
        given: &[Given<LAYOUT>],
    ) -> Timed<LAYOUT>;
    /// The time.
    fn now(&mut self) -> Duration;
    /// Waits until a time.
    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError>;
    /// The unit's generation.
    fn generation(&self) -> Generation;
    /// The stream that this link is on, as far as it is known: its index in command 145.
    fn stream(&self) -> Option<usize>;
    /// Whether the unit is a simulated one, so that it may be sent what nobody knows the meaning of.
    fn is_simulated(&self) -> bool;
    /// How long, since this was last asked, waits and replies had to wait for a processor of this computer.
    fn stolen(&mut self) -> Duration {
        Duration::ZERO
    }
    /// Tells whoever waits what is going on.
    fn progress(&mut self, _text: &str) {}
}

/// An axis behind a carrier.
#[derive(Debug)]
pub struct PacketAxis<C> {
    /// The carrier.
    pub carrier: C,
    motor: Motor,
    encoder: EncoderClass,
    stream: Option<Vec<i64>>,
    /// Commands that were answered, and commands that this controller answers with silence.
    answered: BTreeSet<u8>,
    absent: BTreeSet<u8>,
}

impl<C: Carrier> PacketAxis<C> {
    /// The axis of one motor. What its encoder is the caller knows from the settings or the user.
    pub fn new(carrier: C, motor: Motor, encoder: EncoderClass) -> Self {
        Self { carrier, motor, encoder, stream: None, answered: BTreeSet::new(), absent: BTreeSet::new() }
    }

    /// Asks for what not every controller reports; `None` where this one does not. A controller says no by silence, so only a command
    /// that was never answered counts as missing, and only after some tries.
    fn optional<const L: u8>(&mut self, command: Typed<L>) -> Result<Option<(Exchange, Read<L>)>, AxisError> {
        let number = command.number();
        if self.absent.contains(&number) {
            return Ok(None);
        }
        for _ in 0..TRIES {
            match self.carrier.transact(command, &[]) {
                Ok(reply) => {
                    self.answered.insert(number);
                    return Ok(Some(reply));
                }
                Err(AxisError::NoReply) if self.answered.contains(&number) => {
                    return Err(AxisError::NoReply);
                }
                Err(AxisError::NoReply) => {}
                Err(AxisError::Refused(_)) => break,
                Err(error) => return Err(error),
            }
        }
        self.absent.insert(number);
        Ok(None)
    }

    /// The same of this motor's of two commands, its values alone.
    fn optional_of<const L: u8>(&mut self, of_motors: [Typed<L>; 2]) -> Result<Option<Read<L>>, AxisError> {
        Ok(self.optional(of_motors[self.motor.index()])?.map(|(_, values)| values))
    }

    /// Counts of both motors; of this one alone where the controller does not report both at once.
    fn read_counts(&mut self) -> Result<(Exchange, [i32; 2]), AxisError> {
        // The casts are the register's own wrap.
        if let Some((at, counts)) = self.optional(commands::READ_ENCODERS)? {
            return Ok((at, [counts.int(ENCODER_M1) as i32, counts.int(ENCODER_M2) as i32]));
        }
        let commands = [commands::READ_ENCODER_M1, commands::READ_ENCODER_M2];
        let (at, values) = self.carrier.transact(commands[self.motor.index()], &[])?;
        let mut counts = [0; 2];
        counts[self.motor.index()] = values.int(ENCODER) as i32;
        Ok((at, counts))
    }

    fn send<const L: u8>(
        &mut self,
        of_motors: [Typed<L>; 2],
        given: &[Given<L>],
    ) -> Result<Exchange, AxisError> {
        self.carrier.transact(of_motors[self.motor.index()], given).map(|(at, _)| at)
    }

    fn read<const L: u8>(&mut self, of_motors: [Typed<L>; 2]) -> Result<Read<L>, AxisError> {
        self.carrier.transact(of_motors[self.motor.index()], &[]).map(|(_, values)| values)
    }

    fn write_velocity(&mut self, registers: VelocityRegisters) -> Result<(), AxisError> {
        let values = [
            give(D, i64::from(registers.d)),
            give(P, i64::from(registers.p)),
            give(I, i64::from(registers.i)),
            give(QPPS, i64::from(registers.qpps)),
        ];
        self.send([commands::SET_VELOCITY_PID_M1, commands::SET_VELOCITY_PID_M2], &values).map(|_| ())
    }

    fn write_position(&mut self, registers: PositionRegisters) -> Result<(), AxisError> {
        let values = [
            give(D, i64::from(registers.d)),
            give(P, i64::from(registers.p)),
            give(I, i64::from(registers.i)),
            give(MAX_I, i64::from(registers.max_i)),
            give(DEADZONE, i64::from(registers.deadzone)),
            give(MIN, i64::from(registers.min)),
            give(MAX, i64::from(registers.max)),
        ];
        self.send([commands::SET_POSITION_PID_M1, commands::SET_POSITION_PID_M2], &values).map(|_| ())
    }

    fn read_status(&mut self) -> Result<Status, AxisError> {
        let Some((_, values)) = self.optional(commands::READ_STATUS)? else { return Ok(Status::default()) };
        let raw = values.int(STATUS) as u32;
        let set = decode(raw, self.carrier.generation());
        let over_current = match self.motor {
            Motor::M1 => [Condition::M1OverCurrentWarning, Condition::M1CurrentError],
            Motor::M2 => [Condition::M2OverCurrentWarning, Condition::M2CurrentError],
        };
        let faults = [
            Condition::EStop,
            Condition::Temperature1Error,
            Condition::Temperature2Error,
            Condition::MainBatteryHighError,
            Condition::LogicBatteryHighError,
            Condition::LogicBatteryLowError,
            Condition::M1DriverFault,
            Condition::M2DriverFault,
        ];
        let low = [Condition::MainBatteryLowError, Condition::MainBatteryLowWarning];
        let any = |wanted: &[Condition]| wanted.iter().any(|condition| set.contains(*condition));
        Ok(Status { over_current: any(&over_current), battery_low: any(&low), fault: any(&faults), raw })
    }

    /// The stream's settings by command 146; `None` where the firmware or the caller does not tell which stream it is.
    fn read_stream(&mut self) -> Result<Option<u32>, AxisError> {
        let Some(index) = self.carrier.stream() else { return Ok(None) };
        let Some((_, values)) = self.optional(commands::READ_STREAMS)? else { return Ok(None) };
        let Some(record) = values.records().nth(index) else { return Ok(None) };
        self.stream = Some(vec![index as i64, record.int(TYPE), record.int(RATE)]);
        Ok(u32::try_from(record.int(TIMEOUT)).ok())
    }
}

impl<C: Carrier> Axis for PacketAxis<C> {
    fn now(&mut self) -> Duration {
        self.carrier.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.carrier.wait_until(time)
    }

    fn sample(&mut self, want: Want) -> Result<Sample, AxisError> {
        let (counts_at, counts) = self.read_counts()?;
        let duty_raw = if want.duty { self.optional(commands::READ_PWMS)? } else { None };
        let motor = self.motor.index();
        let duty_raw =
            duty_raw.map(|(at, values)| (at, [values.int(DUTY_M1), values.int(DUTY_M2)][motor] as i16));
        let current_raw = if want.current { self.optional(commands::READ_CURRENTS)? } else { None };
        let current_raw =
            current_raw.map(|(_, values)| [values.int(CURRENT_M1), values.int(CURRENT_M2)][motor] as i16);
        let volts_raw = if want.volts { self.optional(commands::READ_MAIN_BATTERY)? } else { None };
        let volts_raw = volts_raw.map(|(_, values)| values.int(MAIN_BATTERY) as u16);
        let status = self.read_status()?;
        Ok(Sample { counts_at, counts, status, duty_raw, current_raw, volts_raw })
    }

    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        let accel = scale::MAX_DUTY_ACCEL_RAW;
        let values = [give(DUTY, i64::from(duty_raw)), give(ACCEL, accel)];
        self.send([commands::DUTY_ACCEL_M1, commands::DUTY_ACCEL_M2], &values)
    }

    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        self.send([commands::SPEED_M1, commands::SPEED_M2], &[give(SPEED, i64::from(counts_per_s))])
    }

    fn command_position(&mut self, counts: i32, speed: u32) -> Result<Exchange, AxisError> {
        let values = [
            give(ACCEL, 0),
            give(SPEED, i64::from(speed)),
            give(DECEL, 0),
            give(POSITION, i64::from(counts)),
            give(BUFFER, 1),
        ];
        self.send([commands::POSITION_PROFILE_M1, commands::POSITION_PROFILE_M2], &values)
    }

    fn write_winding(&mut self, [inductance, resistance]: [u32; 2]) -> Result<(), AxisError> {
        let values = [give(INDUCTANCE, i64::from(inductance)), give(RESISTANCE, i64::from(resistance))];
        let commands = [commands::SET_INDUCTANCE_RESISTANCE_M1, commands::SET_INDUCTANCE_RESISTANCE_M2];
        self.send(commands, &values).map(|_| ())
    }

    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError> {
        let values = [give(MAX, i64::from(max_raw)), give(MIN, i64::from(min_raw))];
        self.send([commands::SET_CURRENT_LIMITS_M1, commands::SET_CURRENT_LIMITS_M2], &values).map(|_| ())
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        let values = self.read([commands::READ_RAW_SPEED_M1, commands::READ_RAW_SPEED_M2])?;
        let magnitude = values.int(SPEED) as u32 as i32;
        // Generations that report the direction beside the speed set the lowest bit of the status byte for backwards.
        let backwards = magnitude > 0 && values.try_int(STATUS).is_some_and(|status| status & 1 != 0);
        Ok(if backwards { -magnitude } else { magnitude })
    }

    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError> {
        let Some(stream) = self.stream.clone() else {
            return Err(AxisError::Refused("command 145".into()));
        };
        let [index, kind, rate] = stream[..] else { return Err(AxisError::Refused("command 145".into())) };
        let values =
            [give(INDEX, index), give(TYPE, kind), give(RATE, rate), give(TIMEOUT, i64::from(milliseconds))];
        self.carrier.transact(commands::SET_STREAM, &values).map(|_| ())
    }

    /// Commands 84 to 87. Which unit the period has, how the test ends and what it does where the wiring is wrong is not public: real controllers are not sent it.
    fn start_own_test(
        &mut self,
        tested: TestedLoop,
        height_raw: u32,
        hysteresis: u32,
    ) -> Result<(Exchange, u32), AxisError> {
        if !self.carrier.is_simulated() {
            return Err(AxisError::OnlySimulated);
        }
        let command = match tested {
            TestedLoop::Velocity => [commands::AUTOTUNE_VELOCITY_M1, commands::AUTOTUNE_VELOCITY_M2],
            TestedLoop::Position => [commands::AUTOTUNE_POSITION_M1, commands::AUTOTUNE_POSITION_M2],
        };
        let has_hysteresis = self.carrier.generation() >= Generation::Gen3;
        let taken = if has_hysteresis { hysteresis } else { 0 };
        let values = [give(AMPLITUDE, i64::from(height_raw)), give(HYSTERESIS, i64::from(taken))];
        let given = if has_hysteresis { &values[..] } else { &values[..1] };
        self.send(command, given).map(|at| (at, taken))
    }

    /// Commands 88 and 89; that the period is in µs is assumed, as the simulator does.
    fn read_own_test(&mut self) -> Result<[u32; 2], AxisError> {
        if !self.carrier.is_simulated() {
            return Err(AxisError::OnlySimulated);
        }
        let commands = [commands::READ_AUTOTUNE_M1, commands::READ_AUTOTUNE_M2];
        let values = self.optional_of(commands)?.ok_or_else(|| AxisError::Refused("command 88".into()))?;
        Ok([values.int(AMPLITUDE) as u32, values.int(PERIOD) as u32])
    }

    fn stolen(&mut self) -> Duration {
        self.carrier.stolen()
    }

    fn progress(&mut self, text: &str) {
        self.carrier.progress(text);
    }
}

impl<C: Carrier> LoopAxis<McpLaw> for PacketAxis<C> {
    fn read_setup(&mut self) -> Result<Setup<McpLaw>, AxisError> {
        let velocity = self.read([commands::READ_VELOCITY_PID_M1, commands::READ_VELOCITY_PID_M2])?;
        let position = self.read([commands::READ_POSITION_PID_M1, commands::READ_POSITION_PID_M2])?;
        let current =
            self.optional_of([commands::READ_CURRENT_LIMITS_M1, commands::READ_CURRENT_LIMITS_M2])?;
        let winding = self.optional_of([
            commands::READ_INDUCTANCE_RESISTANCE_M1,
            commands::READ_INDUCTANCE_RESISTANCE_M2,
        ])?;
        let volts = self.optional(commands::READ_MAIN_VOLTAGES)?.map(|(_, values)| values);
        let stream_timeout_ms = self.read_stream()?;
        let held = McpHeld {
            velocity: VelocityRegisters {
                p: velocity.int(P) as u32,
                i: velocity.int(I) as u32,
                d: velocity.int(D) as u32,
                qpps: velocity.int(QPPS) as u32,
            },
            position: PositionRegisters {
                p: position.int(P) as u32,
                i: position.int(I) as u32,
                d: position.int(D) as u32,
                max_i: position.int(MAX_I) as u32,
                deadzone: position.int(DEADZONE) as u32,
                min: position.int(MIN) as i32,
                max: position.int(MAX) as i32,
            },
        };
        Ok(Setup {
            held,
            max_current_raw: current.as_ref().map_or(0, |values| values.int(MAX) as u32),
            min_current_raw: current.as_ref().map_or(0, |values| values.int(MIN) as i32),
            min_volts_raw: volts.map_or(0, |values| values.int(MIN) as u16),
            inductance_resistance_raw: winding
                .map_or([0, 0], |values| [values.int(INDUCTANCE) as u32, values.int(RESISTANCE) as u32]),
            stream_timeout_ms,
            encoder: self.encoder,
        })
    }

    fn write(&mut self, write: McpWrite) -> Result<(), AxisError> {
        match write {
            McpWrite::Velocity(registers) => self.write_velocity(registers),
            McpWrite::PositionLoop(registers) => self.write_position(registers),
        }
    }
}
