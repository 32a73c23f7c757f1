//! R/C and analog inputs on S1 and S2, and simple serial (RoboClaw manual 2018, "RC Control", "Analog Control", "Standard Serial").

use super::super::firmware::Firmware;
use super::state::Input;
use crate::motion::{FULL_DUTY_RAW, MotionCommand, mixed_duties};
use crate::settings::ControlInput;
use brushwork_mcp_wire::roboclaw::{ConfigWord, ControlMode, ControlPin, PinFunction};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::{PinState, World};
use brushwork_values::Motor;
use std::time::Duration;

/// Pulses that stop for so long are lost.
const SIGNAL_LOSS: Duration = Duration::from_millis(250);
/// Pulses from full backward over center to full forward (RoboClaw data sheets: 1 ms to 2 ms).
const PULSE_MICROSECONDS: Span = Span { min: 1000.0, center: 1500.0, max: 2000.0 };
/// How far from the middle a center may be that is found at first.
const CENTER_SPREAD_MICROSECONDS: f64 = 200.0;
/// Voltages from full backward over stop to full forward (RoboClaw manual 2018, "Analog Mode"), in mV.
const ANALOG_MILLIVOLTS: Span = Span { min: 0.0, center: 1000.0, max: 2000.0 };
/// A dead band of 100 % (RoboClaw manual 2018, command 76: tenths of a percent).
const DEADBAND_FULL: f64 = 1000.0;

#[derive(Clone, Copy)]
struct Span {
    min: f64,
    center: f64,
    max: f64,
}

impl Firmware {
    /// Reads S1 and S2 and gives the motors what they say.
    pub(crate) fn steer_by_inputs(&mut self, world: &mut World) {
        let word = self.control.word;
        if word.is_serial() || self.is_homing() {
            return;
        }
        let now = self.now;
        for at in 0..self.control.inputs.len() {
            let settings = self.settings.roboclaw.inputs[at];
            let state = world.pin(at);
            self.control.inputs[at].update(state, word, &settings, now);
        }
        if self.is_held {
            // What the inputs say counts again once the stop is over.
            self.steered = [None; 2];
            return;
        }
        let [Some(first), second] = self.control.inputs.map(|input| input.share) else { return };
        let mut shares = [first, second.unwrap_or(0.0)];
        if self.is_flipped(world) {
            shares = shares.map(|share| -share);
        }
        let mut values = shares.map(|share| share * f64::from(FULL_DUTY_RAW));
        if word.has_mixing() {
            let [drive, turn] = values.map(|value| value.round() as i16);
            values = mixed_duties(drive, turn).map(f64::from);
        }
        for motor in Motor::BOTH {
            self.steer(motor, values[motor.index()]);
        }
    }

    /// The flip switch on S3: a level, or a pulse of a receiver.
    fn is_flipped(&self, world: &mut World) -> bool {
        if self.pin_function(ControlPin::S3).0 != PinFunction::Default {
            return false;
        }
        if !self.control.word.has_rc_flip() {
            return self.is_low(world, "S3");
        }
        let place = self.model.control_pins.iter().position(|pin| *pin == "S3");
        place.is_some_and(|place| {
            matches!(world.pin(place), PinState::Pulse { microseconds } if microseconds > PULSE_MICROSECONDS.center)
        })
    }

    /// Whether single bytes on a stream command the motors.
    pub(crate) fn hears_simple_serial(&self, stream: StreamIndex) -> bool {
        self.is_roboclaw() && stream != StreamIndex::Usb && self.control.mode() == ControlMode::SimpleSerial
    }

    /// A byte of simple serial: 0 stops both motors, 1 to 127 are motor 1 from full backward to full forward, 128 to 255 motor 2.
    pub(crate) fn take_simple_serial(&mut self, byte: u8) {
        let duty = |offset: i16, below: i16, above: i16| {
            let share = f64::from(offset) / f64::from(if offset < 0 { below } else { above });
            (share * f64::from(FULL_DUTY_RAW)).round() as i16
        };
        let (motor, duty_raw) = match byte {
            0 => return self.stop_both(),
            1..=127 => (Motor::M1, duty(i16::from(byte) - 64, 63, 63)),
            128..=255 => (Motor::M2, duty(i16::from(byte) - 192, 64, 63)),
        };
        self.command(motor, MotionCommand::Duty { duty_raw, acceleration_raw: None });
    }
}

impl Input {
    fn update(&mut self, state: PinState, word: ConfigWord, settings: &ControlInput, now: Duration) {
        match (word.mode(), state) {
            (ControlMode::Rc, PinState::Pulse { microseconds }) => {
                self.heard_at = Some(now);
                let center = if word.is_for_mcu() {
                    PULSE_MICROSECONDS.center
                } else {
                    *self.center_microseconds.get_or_insert(microseconds)
                };
                let spread = CENTER_SPREAD_MICROSECONDS;
                let middle = PULSE_MICROSECONDS.center;
                let span =
                    Span { center: center.clamp(middle - spread, middle + spread), ..PULSE_MICROSECONDS };
                self.share = Some(shaped(microseconds, span, word, settings));
            }
            (ControlMode::Analog, PinState::Volts(volts)) => {
                self.share = Some(shaped(volts * 1000.0, ANALOG_MILLIVOLTS, word, settings));
            }
            (ControlMode::Analog, _) => self.share = Some(0.0),
            (ControlMode::Rc, _) => {
                let is_lost = self.heard_at.is_some_and(|at| now.saturating_sub(at) > SIGNAL_LOSS);
                let holds_on = word.is_for_mcu() && !word.has_rc_timeout();
                if is_lost && !holds_on {
                    self.share = Some(0.0);
                }
            }
            (ControlMode::SimpleSerial | ControlMode::PacketSerial, _) => {}
        }
    }
}

/// A reading as a command from -1 to 1: range, dead band, curve, limits.
fn shaped(reading: f64, usual: Span, word: ConfigWord, settings: &ControlInput) -> f64 {
    let own = Span { min: settings.min.into(), center: settings.center.into(), max: settings.max.into() };
    let span = if own.min < own.center && own.center < own.max { own } else { usual };
    let offset = reading - span.center;
    let length = if offset < 0.0 { span.center - span.min } else { span.max - span.center };
    let share = (offset.abs() / length).min(1.0);
    let (deadband, limit) = if offset < 0.0 {
        (settings.reverse_deadband, settings.reverse_limit)
    } else {
        (settings.forward_deadband, settings.forward_limit)
    };
    let deadband = f64::from(deadband) / DEADBAND_FULL;
    let share = ((share - deadband) / (1.0 - deadband)).max(0.0);
    let share = if word.has_exponential() { share * share } else { share };
    let most = if limit == 0 { 1.0 } else { (f64::from(limit) / f64::from(FULL_DUTY_RAW)).min(1.0) };
    share.min(most).copysign(offset)
}
