//! Homing at power-up: motor 1 first, then motor 2; off the switch if the motor stands on it, then backward until it meets it
//! (the vendor's support forum, 2019; RoboClaw manual 2018, commands 105 and 106).

use super::super::firmware::Firmware;
use super::pins::PINS;
use super::state::Homing;
use crate::motion::MotionCommand;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_mcp_wire::roboclaw::{ControlPin, PinFunction, SwitchFunction};
use brushwork_values::Motor;
use std::time::Duration;

/// How long a motor runs forward off its switch.
const LEAVING: Duration = Duration::from_secs(3);
/// A quarter of full duty, where no setting says another.
const DUTY_WITHOUT_SETTING: i16 = i16::MAX / 4;

impl Firmware {
    /// Whether motors move by themselves.
    pub(super) fn is_homing(&self) -> bool {
        self.control.homing != Homing::Done
    }

    /// One step of it.
    pub(crate) fn run_homing(&mut self) {
        if self.is_held {
            self.control.homing = Homing::Done;
        }
        match self.control.homing {
            Homing::Done => {}
            Homing::Next(motor) => match self.home_command(motor) {
                None => self.control.homing = after(motor),
                Some((duty_raw, _)) if self.is_at_switch(motor) => {
                    self.control.homing = Homing::Leaving(motor, self.now + LEAVING);
                    self.command_for_homing(motor, MotionCommand::Duty { duty_raw, acceleration_raw: None });
                }
                Some(_) => self.seek(motor),
            },
            Homing::Leaving(motor, until) => {
                if !self.is_at_switch(motor) || self.now >= until {
                    self.seek(motor);
                }
            }
            Homing::Seeking(motor) => {
                if !self.channels[motor.index()].is_homing() {
                    self.control.homing = after(motor);
                }
            }
        }
    }

    fn seek(&mut self, motor: Motor) {
        let Some((duty_raw, timeout_300ths)) = self.home_command(motor) else {
            self.control.homing = after(motor);
            return;
        };
        self.control.homing = Homing::Seeking(motor);
        self.command_for_homing(motor, MotionCommand::Home { duty_raw: -duty_raw, timeout_300ths });
    }

    /// Duty and time-out of a motor that looks for its switch.
    fn home_command(&self, motor: Motor) -> Option<(i16, u32)> {
        let (pin, ..) = PINS.into_iter().find(|(_, _, own)| *own == Some(motor))?;
        let is_auto =
            matches!(self.pin_function(pin).0, PinFunction::Switch(SwitchFunction { auto: true, .. }));
        let registers = &self.settings.motors[motor.index()];
        let duty_raw = match self.generation {
            Generation::Gen4 => DUTY_WITHOUT_SETTING,
            Generation::Gen1 | Generation::Gen2 | Generation::Gen3 => {
                i16::try_from(registers.homing_duty_raw).unwrap_or(i16::MAX)
            }
        };
        let timeout = registers.homing_timeout_ticks;
        (is_auto && duty_raw > 0 && timeout > 0 && self.has_pin(pin)).then_some((duty_raw, timeout))
    }

    fn has_pin(&self, pin: ControlPin) -> bool {
        PINS.iter().any(|(own, name, _)| *own == pin && self.model.control_pins.contains(name))
    }

    /// Past [`Firmware::command`], which ends homing.
    fn command_for_homing(&mut self, motor: Motor, command: MotionCommand) {
        let settings = self.motion_settings(motor);
        // A refused command leaves the motor where it is, and homing goes on to the next.
        let _ = self.channels[motor.index()].command(command, &settings);
    }
}

fn after(motor: Motor) -> Homing {
    match motor {
        Motor::M1 => Homing::Next(Motor::M2),
        Motor::M2 => Homing::Done,
    }
}
