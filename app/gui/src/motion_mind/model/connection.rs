//! What a connection says of the Motion Mind that it is linked to, and what its screens ask for.

use brushwork_link::{Identity, SettingValue, SettingsImage};
use brushwork_motion_mind_axis::law::MotionMindSetup;
use brushwork_motion_mind_client::MotionMindFacts;
use brushwork_motion_mind_wire::{Register, register_named};

use brushwork_values::Motor;

use super::drive::{ANALOG_FULL, PULSE_FULL};
use super::registers::{self, bit_key, key};
use super::steps::touched;
use super::{Driven, MotionMindConnection};
use crate::family::Known;
use crate::model::{Connection, Direction};

impl Connection {
    /// What is kept of its own.
    pub fn mind(&self) -> &MotionMindConnection {
        self.own()
    }

    pub fn mind_mut(&mut self) -> &mut MotionMindConnection {
        self.own_mut()
    }

    /// The mode that a Motion Mind's switches selected at power-up.
    pub fn mode(&self) -> Option<u8> {
        Some(self.link.identity().and_then(MotionMindFacts::of)?.mode.number())
    }

    /// What of a Motion Mind can be driven from here.
    pub fn driven(&self) -> Driven {
        driven(self.link.identity(), &|key| self.settings.unit()?.on_controller(key))
    }
}

/// What of a unit can be driven over serial.
pub fn driven(identity: Option<&Identity>, known: Known<'_>) -> Driven {
    let takes_serial = known(&bit_key("FUNCTION", "ADSERIAL")) == Some(SettingValue::Bool(true));
    let facts = identity.and_then(MotionMindFacts::of);
    facts.map_or(Driven::Nothing, |facts| Driven::of(facts.mode.number(), takes_serial))
}

/// Why a unit cannot be tuned as it is set, where it cannot.
pub fn cannot_tune(identity: Option<&Identity>, known: Known<'_>) -> Option<&'static str> {
    let mode = identity.and_then(MotionMindFacts::of).map(|facts| facts.mode.number());
    if mode.is_some_and(|mode| mode != MotionMindSetup::SERIAL_PID) {
        return Some(
            "Guided tuning needs mode 4, serial PID with an encoder: no other mode takes both a duty and a position. Switch the power off, \
             set SW1 to mode 4 (MODE2 off, MODE1 on, MODE0 on), and switch it on again. The step response assistant works here too.",
        );
    }
    let is_pulsed = known(&bit_key("FUNCTION2", "PULSEFB")) == Some(SettingValue::Bool(true));
    is_pulsed.then_some(
        "Guided tuning needs an encoder, and this unit is set to pulse feedback. Clear PULSEFB in FUNCTION2 on the Registers screen, \
         or use the step response assistant.",
    )
}

impl Connection {
    /// The raw value of a register, by its name, as far as it was read. A setting's is that of the settings' model, which takes note
    /// of every write; what the unit measures was read while a screen showed it.
    pub fn register(&self, name: &str) -> Option<i64> {
        let register = register_named(name)?;
        self.setting(register).or_else(|| self.mind().live.get(register))
    }

    fn setting(&self, register: &Register) -> Option<i64> {
        self.settings.unit()?.confirmed(&key(register))?.int()
    }

    /// Raw register values as settings, as far as the unit's table has them.
    pub fn as_settings(&self, raw: &[(&str, i64)]) -> SettingsImage {
        let Some(unit) = self.settings.unit() else { return SettingsImage::default() };
        let setting = |(name, raw): &(&str, i64)| {
            let row = unit.table().row(&key(register_named(name)?))?;
            Some((row.key.clone(), row.coding.decode(row.kind, *raw)))
        };
        raw.iter().filter_map(setting).collect()
    }

    /// Whether a bit of FUNCTION or FUNCTION2 is known to be set, by the register's and the bit's name.
    pub fn has_bit(&self, register: &str, bit: &str) -> bool {
        let key = bit_key(register, bit);
        let of_settings = self.settings.unit().and_then(|unit| unit.on_controller(&key));
        of_settings == Some(SettingValue::Bool(true))
    }
}

impl Connection {
    /// Where a position may be asked for: the scale of an analog or pulse feedback, the virtual limits, or what was set.
    pub fn mind_travel(&self) -> (f64, f64) {
        let span = self.mind().reach.span_counts;
        let has_encoder = self.has_bit(registers::FUNCTION, "RCPOS-ENCFDBCK");
        if self.mode() == Some(5) && !has_encoder {
            return (0.0, ANALOG_FULL);
        }
        if self.mode() == Some(4) && self.has_bit(registers::FUNCTION2, "PULSEFB") {
            return (0.0, PULSE_FULL);
        }
        self.virtual_travel().unwrap_or((-span, span))
    }

    /// Asks for a position within the travel.
    pub fn ask_position(&mut self, counts: f64) {
        let (low, high) = self.mind_travel();
        if counts.is_finite() {
            self.position.setpoints.set_one(Motor::M1, counts.clamp(low, high));
        }
    }

    /// Asks for a position so far from the one asked for last, or from where the motor is.
    pub fn ask_step(&mut self, counts: f64) {
        let from = self.position.setpoints.values[0];
        self.ask_position(from + counts);
    }

    /// Asks for a velocity, counts per loop.
    pub fn ask_velocity(&mut self, counts_per_loop: f64) {
        let top = self.mind().reach.top_counts_per_loop;
        if counts_per_loop.is_finite() {
            let whole = counts_per_loop.round().clamp(-top, top);
            self.velocity.setpoints.set_one(Motor::M1, whole);
        }
    }

    /// What the jog buttons of the velocity screen ask for in this frame.
    pub fn jog_velocity(&mut self, held: Option<Direction>) {
        if let Some(begun) = self.velocity.setpoints.jog(Motor::M1, held) {
            let speed = self.mind().reach.jog_counts_per_loop;
            self.ask_velocity(begun.map_or(0.0, |direction| direction.sign() * speed));
        }
    }

    /// What the registers of the assistant hold now.
    pub fn step_registers(&self) -> Option<SettingsImage> {
        let ram = self.settings.unit()?.ram()?;
        touched().map(|key| Some((key.clone(), ram.get(&key)?))).collect()
    }
}

#[cfg(test)]
mod tests {
    use brushwork_link::device::{ArmScope, Drive, DriveCommand};

    use super::*;
    use crate::motion_mind::model::drive::to_send;

    #[test]
    fn a_velocity_goes_out_in_whole_counts_per_loop() {
        let mut connection = Connection::default();
        connection.ask_velocity(-12.4);
        let wanted = DriveCommand::Speed { speed_counts_per_s: -2400, accel_counts_per_s2: None };
        assert_eq!(
            to_send(ArmScope::Velocity, connection.velocity.setpoints),
            Some(Drive::one(Motor::M1, wanted))
        );
        connection.ask_velocity(5000.0);
        assert_eq!(connection.velocity.setpoints.values[0], 50.0, "the slider's end");
    }

    #[test]
    fn a_jog_runs_while_it_is_held() {
        let mut connection = Connection::default();
        connection.jog_velocity(Some(Direction::Backward));
        assert_eq!(connection.velocity.setpoints.values[0], -10.0);
        connection.jog_velocity(None);
        assert_eq!(connection.velocity.setpoints.values[0], 0.0);
    }

    #[test]
    fn steps_add_up_and_stay_in_the_travel() {
        let mut connection = Connection::default();
        connection.ask_step(15_000.0);
        connection.ask_step(15_000.0);
        assert_eq!(connection.position.setpoints.values[0], 20_000.0);
    }
}
