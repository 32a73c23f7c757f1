//! Control pins and CTRL pins as outputs: voltage clamp, brake, and what a command sets (RoboClaw manual 2018, commands 74 and 100).

use super::super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_mcp_wire::roboclaw::{ControlPin, PinFunction};
use brushwork_values::Motor;

/// CTRL modes of command 100.
const CTRL_USER: u8 = 1;
const CTRL_CLAMP: u8 = 2;
const CTRL_BRAKE: u8 = 3;

impl Firmware {
    /// What an output does: S3, S4, S5, and CTRL1 and CTRL2 or D1 and D2, counted from 0.
    pub(crate) fn output_function(&self, output: usize) -> PinFunction {
        let Some(pin) = ControlPin::ALL.get(output).copied() else { return PinFunction::Disabled };
        let ctrl = match pin {
            ControlPin::S3 | ControlPin::S4 | ControlPin::S5 => return self.pin_function(pin).0,
            ControlPin::D1 => 0,
            ControlPin::D2 => 1,
        };
        if self.model.control_outputs <= ctrl {
            return PinFunction::Disabled;
        }
        match self.generation {
            Generation::Gen1 => PinFunction::Disabled,
            Generation::Gen2 | Generation::Gen3 => match self.settings.roboclaw.control_modes[ctrl] {
                CTRL_USER => PinFunction::User,
                CTRL_CLAMP => PinFunction::VoltageClamp,
                CTRL_BRAKE => PinFunction::Brake,
                _ => PinFunction::Disabled,
            },
            Generation::Gen4 => self.pin_function(pin).0,
        }
    }

    /// Which of them are on.
    pub(crate) fn control_outputs(&self, over_voltage: bool) -> Vec<bool> {
        let is_on = |output: usize| match self.output_function(output) {
            PinFunction::VoltageClamp => over_voltage,
            PinFunction::Brake => {
                let motor = if matches!(ControlPin::ALL[output], ControlPin::S5 | ControlPin::D2) {
                    Motor::M2
                } else {
                    Motor::M1
                };
                self.channels[motor.index()].duty_raw() == 0
            }
            PinFunction::User => self.user_level(output) > 0,
            PinFunction::Disabled
            | PinFunction::Default
            | PinFunction::EStop { .. }
            | PinFunction::Switch(_)
            | PinFunction::NoEffect => false,
        };
        (0..ControlPin::ALL.len()).map(is_on).collect()
    }

    /// The level that commands 102 and 103 set.
    fn user_level(&self, output: usize) -> u16 {
        match self.generation {
            Generation::Gen4 => self.auxiliary_duties[output],
            Generation::Gen1 | Generation::Gen2 | Generation::Gen3 => {
                let ctrl = output.saturating_sub(ControlPin::D1 as usize);
                self.settings.roboclaw.control_duties[ctrl]
            }
        }
    }
}
