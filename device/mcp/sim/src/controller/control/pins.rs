//! Control pins as inputs: emergency stop, limit and home switches.

use super::super::firmware::Firmware;
use crate::signals::{MotorTriggers, Triggers};
use brushwork_mcp_wire::roboclaw::{ControlPin, PinFunction, SwitchFunction};
use brushwork_plant::world::{PinState, World};
use brushwork_values::Motor;

/// Below this a pin reads low: between the highest low level of 0.8 V and the lowest high one of 2 V (RoboClaw data sheets).
const LOW_VOLTS: f64 = 1.5;

/// A pin whose function is set: its place among the world's pins, where the model has it, and its motor.
pub(super) const PINS: [(ControlPin, &str, Option<Motor>); 3] = [
    (ControlPin::S3, "S3", None),
    (ControlPin::S4, "S4", Some(Motor::M1)),
    (ControlPin::S5, "S5", Some(Motor::M2)),
];

impl Firmware {
    /// What a pin does, and whether it is inverted.
    pub(super) fn pin_function(&self, pin: ControlPin) -> (PinFunction, bool) {
        let raw = self.settings.roboclaw.pin_functions[pin as usize];
        pin.function(raw, self.generation)
    }

    /// Whether a pin is low; one that the model does not have is not.
    pub(super) fn is_low(&self, world: &mut World, name: &str) -> bool {
        let place = self.model.control_pins.iter().position(|pin| *pin == name);
        place.is_some_and(|place| matches!(world.pin(place), PinState::Volts(volts) if volts < LOW_VOLTS))
    }

    /// Reads the pins and does what they ask for.
    pub(crate) fn update_control_pins(&mut self, world: &mut World) {
        let mut triggers = Triggers::default();
        let mut is_held = false;
        for (at, (pin, name, motor)) in PINS.into_iter().enumerate() {
            let (function, is_inverted) = self.pin_function(pin);
            let is_there = self.model.control_pins.contains(&name);
            let is_active = is_there && self.is_low(world, name) != is_inverted;
            let is_new = is_active && !self.control.pins[at].is_active;
            if is_new {
                let duty = motor.map_or(0, |motor| self.channels[motor.index()].duty_raw());
                self.control.pins[at].was_forward = duty > 0;
            }
            self.control.pins[at].is_active = is_active;
            if !is_active {
                continue;
            }
            match (function, motor) {
                (PinFunction::Default, _) => triggers.estop |= self.control.word.is_serial(),
                (PinFunction::EStop { is_latching: true }, _) => triggers.estop = true,
                (PinFunction::EStop { is_latching: false }, _) => is_held = true,
                (PinFunction::Switch(switch), Some(motor)) => {
                    let was_forward = self.control.pins[at].was_forward;
                    meet(switch, was_forward, is_new, &mut triggers.motors[motor.index()]);
                }
                (
                    PinFunction::Switch(_)
                    | PinFunction::Disabled
                    | PinFunction::VoltageClamp
                    | PinFunction::Brake
                    | PinFunction::User
                    | PinFunction::NoEffect,
                    _,
                ) => {}
            }
        }
        self.control.is_held = is_held;
        self.take_triggers(triggers, None);
    }

    /// Whether a motor's limit or home switch is closed.
    pub(super) fn is_at_switch(&self, motor: Motor) -> bool {
        let at = PINS.iter().position(|(_, _, own)| *own == Some(motor));
        at.is_some_and(|at| self.control.pins[at].is_active)
    }
}

/// What a closed switch asks of its motor.
fn meet(switch: SwitchFunction, was_forward: bool, is_new: bool, motor: &mut MotorTriggers) {
    let at_forward_end = switch.forward && (!switch.reverse || was_forward);
    motor.forward_limit = at_forward_end;
    motor.backward_limit = !at_forward_end;
    motor.at_home = true;
    if switch.home && !at_forward_end && is_new {
        motor.load_home = Some(0);
    }
}
