//! Input pins at work: reading them, deciding who commands the motors, and steering by signals.
//!
//! Assumed: 5.1 V at an analog pin read 4095 (as for absolute encoders, MCP manual 2.4.8); a digital pin with nothing on it reads high
//! (its pull-up); an input other than a pulse counts as Analog among the priority levels; motors stop when the commanding
//! source changes and when it times out with no other active.

use super::firmware::Firmware;
use super::pins::PinFunctions;
use crate::motion::{Buffering, EncoderInput, MotionCommand, PositionMove, PositionTarget, mixed_duties};
use crate::priority::{self, Activity, Source};
use crate::signals::{FULL_SCALE, PinReading, Triggers};
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_mcp_wire::roboclaw::{ControlMode, ENCODER_ABSOLUTE, ENCODER_IN_RC, ENCODER_REVERSED};
use brushwork_plant::world::{PinState, World};
use brushwork_plant::{ABSOLUTE_FULL_SCALE_VOLTS, ABSOLUTE_MAX_COUNTS, EncoderKind, EncoderReading};
use brushwork_script::debug::StopCause;
use brushwork_values::Motor;
use std::time::Duration;

const KIND_NONE: u8 = 0;
const KIND_ANALOG: u8 = 1;
const KIND_PULSE: u8 = 2;
const KIND_ENCODER: u8 = 3;
/// Stream type "disabled".
const STREAM_DISABLED: u8 = 2;
/// Level above which a digital pin reads high.
const DIGITAL_THRESHOLD_VOLTS: f64 = 2.5;

impl Firmware {
    /// Reads every pin that has a function, and from them the encoder of each motor.
    pub(super) fn update_signals(&mut self, world: &mut World) {
        let (mut triggers, mut stops_script) = (Triggers::default(), None);
        let one_byte_actions = self.generation == Generation::Gen1;
        for index in 0..self.signals.len() {
            let settings = &self.settings.signals[index];
            if settings.kind == KIND_NONE && !settings.digital {
                continue;
            }
            let state = self.pin_state(world, index);
            if let PinState::Counts(counts) = state {
                self.counts[index] = counts;
            }
            let reading = self.pin_reading(state, index);
            let settings = &self.settings.signals[index];
            let had_stopped = triggers.stop_script;
            self.signals[index].update(reading, settings, one_byte_actions, self.now, &mut triggers);
            if triggers.stop_script && !had_stopped {
                stops_script = Some(index);
            }
        }
        self.readings.encoders = Motor::BOTH.map(|motor| self.encoder_input(motor));
        self.take_triggers(triggers, stops_script);
    }

    /// Finds out which kind of input commands the motors, and stops them when that changes or ends.
    pub(super) fn update_source(&mut self) {
        let before = self.source;
        self.source = match self.model.family {
            Family::Mcp => priority::select(self.settings.priority, self.activity()),
            Family::RoboClaw => Some((
                0,
                match self.control.mode() {
                    ControlMode::Rc => Source::Pulse,
                    ControlMode::Analog => Source::Analog,
                    ControlMode::SimpleSerial | ControlMode::PacketSerial => Source::Serial,
                },
            )),
        };
        if before.is_some() && before.map(|(_, source)| source) != self.source.map(|(_, source)| source) {
            self.stop_what_no_script_drives();
            self.steered = [None; 2];
        }
        self.check_serial_timeout();
    }

    /// Whether the command at hand may move the motors now: one of packet serial where Serial commands, one of the CAN bus always
    /// (MCP manual 1.9.4).
    pub(super) fn serial_commands(&self) -> bool {
        self.from_can || matches!(self.source, Some((_, Source::Serial)))
    }

    /// Gives the motors what the commanding inputs say, where that has changed.
    pub(super) fn steer_by_signals(&mut self) {
        let Some((_, source @ (Source::Pulse | Source::Analog))) = self.source else {
            return;
        };
        let mut commands = [None; 2];
        for (signal, settings) in self.signals.iter().zip(&self.settings.signals) {
            let (has_function, is_targeted) =
                (settings.kind != KIND_NONE || settings.digital, settings.target != 0);
            if !has_function || !is_targeted || source_of(settings.kind) != source {
                continue;
            }
            for motor in Motor::BOTH {
                if settings.target & (1 << motor.index()) != 0 {
                    commands[motor.index()] = Some(signal.command(settings));
                }
            }
        }
        if self.settings.unit.mixed != 0 {
            let [drive, turn] = commands.map(|command| clamp_raw(command.unwrap_or(0.0)));
            commands = mixed_duties(drive, turn).map(|duty| Some(f64::from(duty)));
        }
        for motor in Motor::BOTH {
            if let Some(value) = commands[motor.index()] {
                self.steer(motor, value);
            }
        }
    }

    /// Gives a motor a command of -32767 to 32767, unless it has it.
    pub(super) fn steer(&mut self, motor: Motor, value: f64) {
        let command = self.steering_command(motor, value);
        if self.steered[motor.index()] != Some(command) {
            self.command(motor, command);
            self.steered[motor.index()] = Some(command);
        }
    }

    /// Duty, speed or position, by the gains of the motor (MCP manual 1.9.11).
    fn steering_command(&self, motor: Motor, value: f64) -> MotionCommand {
        let settings = self.motion_settings(motor);
        let has_encoder = self.has_encoder(motor);
        let has_position_loop =
            settings.position_p_raw | settings.position_i_raw | settings.position_d_raw != 0;
        if has_encoder && has_position_loop && settings.allows_position() {
            let target = PositionTarget::Percent(clamp_raw(value));
            let to =
                PositionMove { acceleration: None, speed_counts_per_s: None, deceleration: None, target };
            return MotionCommand::Position(to, Buffering::Immediate);
        }
        if has_encoder && !settings.simple_position() {
            let speed_counts_per_s = (value / FULL_SCALE * f64::from(settings.qpps)) as i32;
            return MotionCommand::Speed {
                speed_counts_per_s,
                acceleration: Some(settings.default_acceleration()),
            };
        }
        MotionCommand::Duty { duty_raw: clamp_raw(value), acceleration_raw: None }
    }

    /// Does what the pins ask for; `stops_script` is the one that stops the script.
    pub(super) fn take_triggers(&mut self, triggers: Triggers, stops_script: Option<usize>) {
        self.triggers = triggers;
        for motor in Motor::BOTH {
            let asked = triggers.motors[motor.index()];
            self.reversed[motor.index()] ^= asked.reverse;
            if let Some(position) = asked.load_home {
                self.channels[motor.index()].encoder_mut().set(position as u32);
                self.channels[motor.index()].reach_home();
            }
        }
        if triggers.stop_script {
            self.script.stop_for(StopCause::PinAction(stops_script));
        }
        let up_for = self.up_for();
        // There is nobody to tell of a script that does not start.
        if triggers.run_script {
            let _ = self.script.start(&self.memory.script, up_for);
        }
        if triggers.reset_script && self.script.is_running() {
            let _ = self.script.restart(&self.memory.script, up_for);
        }
    }

    fn activity(&self) -> Activity {
        let serial = priority::serial_is_active(&self.settings.streams, &self.ports.last_bytes, self.now);
        let mut activity = Activity { serial, ..Activity::default() };
        for (signal, settings) in self.signals.iter().zip(&self.settings.signals) {
            if settings.target == 0 || (settings.kind == KIND_NONE && !settings.digital) {
                continue;
            }
            match source_of(settings.kind) {
                Source::Pulse => activity.pulse |= signal.is_active(settings, self.now),
                Source::Analog => activity.analog = true,
                Source::Serial => {}
            }
        }
        activity
    }

    /// Commands 14 and 15: the motors stop when no byte has come for that long.
    fn check_serial_timeout(&mut self) {
        let tenths = self.settings.unit.serial_timeout_tenths;
        let last = self.ports.last_bytes.iter().flatten().max().copied();
        let (Some(last), true) = (last, tenths != 0 && self.serial_commands()) else {
            return;
        };
        let is_late = self.now.saturating_sub(last) > Duration::from_millis(100) * u32::from(tenths);
        if is_late && !self.ports.timed_out {
            self.stop_what_no_script_drives();
        }
        self.ports.timed_out = is_late;
    }

    /// Whether inputs command a motor by its encoder.
    fn has_encoder(&self, motor: Motor) -> bool {
        let mode = self.settings.motors[motor.index()].encoder_mode;
        match self.model.family {
            Family::RoboClaw => mode & ENCODER_IN_RC != 0,
            Family::Mcp => usize::from(mode) < self.signals.len(),
        }
    }

    /// What a motor takes for its encoder (commands 91 to 93). Assumed, besides the numbering of
    /// [`ENCODER_PIN_NONE`](brushwork_mcp_wire::codes::ENCODER_PIN_NONE): the number of a pin without a function leaves the motor its
    /// own encoder input, so that clients which set RoboClaw modes 0 and 1 find one; a number beyond the pins is none.
    fn encoder_input(&self, motor: Motor) -> EncoderInput {
        let mode = self.settings.motors[motor.index()].encoder_mode;
        let index = usize::from(mode);
        let plug = if self.swaps_encoders() { 1 - motor.index() } else { motor.index() };
        let own = self.readings.plugs[plug];
        match (self.model.family, self.settings.signals.get(index)) {
            (Family::RoboClaw, _) => roboclaw_encoder(mode, own),
            (Family::Mcp, None) => EncoderInput::Quadrature(0),
            (Family::Mcp, Some(pin)) => match (pin.kind, pin.digital) {
                (KIND_ENCODER, false) => EncoderInput::Quadrature(self.counts[index]),
                (KIND_NONE, false) => own_encoder(own),
                _ => EncoderInput::Absolute(self.signals[index].raw() as i32),
            },
        }
    }

    /// The axis encoder that is plugged into a pin, by the pin's ENC function.
    fn plug_on(&self, index: usize) -> Option<EncoderReading> {
        self.readings.plugs.get(self.usable_pin(index)?.encoder?).copied()
    }

    /// The pin, unless a UART that shares it is in use (MCP manual 1.9.7).
    fn usable_pin(&self, index: usize) -> Option<PinFunctions> {
        let pin = self.pins.get(index).copied()?;
        let stream = pin.stream.and_then(|stream| self.settings.streams.get(stream));
        let in_use = stream.is_some_and(|stream| stream.kind != STREAM_DISABLED);
        (!in_use).then_some(pin)
    }

    fn pin_reading(&self, state: PinState, index: usize) -> PinReading {
        let Some(pin) = self.usable_pin(index) else {
            return PinReading::Nothing;
        };
        let settings = &self.settings.signals[index];
        if settings.digital {
            let is_high = match state {
                PinState::Volts(volts) => volts > DIGITAL_THRESHOLD_VOLTS,
                PinState::Open => true,
                PinState::Pulse { .. } | PinState::Counts(_) => false,
            };
            return PinReading::Level(if is_high { ABSOLUTE_MAX_COUNTS as f64 } else { 0.0 });
        }
        match (settings.kind, state) {
            (KIND_ANALOG, PinState::Volts(volts)) if pin.is_analog => PinReading::Level(analog_counts(volts)),
            (KIND_ANALOG, _) if pin.is_analog => PinReading::Level(0.0),
            (KIND_PULSE, PinState::Pulse { microseconds }) if pin.is_pulse => PinReading::Pulse(microseconds),
            (KIND_ENCODER, _) if pin.encoder.is_some() => PinReading::Level(self.encoder_level(index)),
            _ => PinReading::Nothing,
        }
    }

    /// What is on a pin: what a person connected, else the axis encoder that is plugged in there.
    fn pin_state(&self, world: &mut World, index: usize) -> PinState {
        match (world.pin(index), self.plug_on(index)) {
            (PinState::Open, Some(reading)) if reading.present => match reading.kind {
                EncoderKind::Quadrature => PinState::Counts(reading.counts),
                EncoderKind::Analog => PinState::Volts(reading.volts()),
                EncoderKind::Pulse => PinState::Pulse { microseconds: reading.counts as f64 },
            },
            (state, _) => state,
        }
    }

    /// An encoder pin's value: the register of the motor it serves, else what its encoder has counted.
    fn encoder_level(&self, index: usize) -> f64 {
        let serves = Motor::BOTH
            .into_iter()
            .find(|motor| usize::from(self.settings.motors[motor.index()].encoder_mode) == index);
        match serves {
            Some(motor) => f64::from(self.channels[motor.index()].encoder().position()),
            None => self.counts[index] as f64,
        }
    }
}

fn own_encoder(own: EncoderReading) -> EncoderInput {
    match own.kind {
        EncoderKind::Quadrature => EncoderInput::Quadrature(own.counts),
        EncoderKind::Analog | EncoderKind::Pulse => EncoderInput::Absolute(own.counts as i32),
    }
}

/// A RoboClaw is told which kind of encoder it has, and which way round; of another kind it hears nothing.
fn roboclaw_encoder(mode: u8, own: EncoderReading) -> EncoderInput {
    let expects_absolute = mode & ENCODER_ABSOLUTE != 0;
    let is_reversed = mode & ENCODER_REVERSED != 0;
    match (own_encoder(own), expects_absolute) {
        (EncoderInput::Quadrature(_), true) => EncoderInput::Absolute(0),
        (EncoderInput::Absolute(_), false) => EncoderInput::Quadrature(0),
        (EncoderInput::Quadrature(counts), false) if is_reversed => EncoderInput::Quadrature(-counts),
        (EncoderInput::Absolute(value), true) if is_reversed => {
            EncoderInput::Absolute(ABSOLUTE_MAX_COUNTS as i32 - value)
        }
        (matching, _) => matching,
    }
}

fn source_of(kind: u8) -> Source {
    if kind == KIND_PULSE { Source::Pulse } else { Source::Analog }
}

fn analog_counts(volts: f64) -> f64 {
    let counts = (volts / ABSOLUTE_FULL_SCALE_VOLTS * ABSOLUTE_MAX_COUNTS as f64).round();
    counts.clamp(0.0, ABSOLUTE_MAX_COUNTS as f64)
}

fn clamp_raw(value: f64) -> i16 {
    value.round().clamp(-FULL_SCALE, FULL_SCALE) as i16
}
