//! What an input does to motors and script when it reaches its lowest or highest value (MCP manual 1.9.8, command 143).

use brushwork_mcp_wire::codes;
use brushwork_mcp_wire::codes::SIGNAL_ACTIONS_GENERATION_1;

/// What min and max actions ask for at one moment: some as long as they hold, some once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triggers {
    /// Per motor.
    pub motors: [MotorTriggers; 2],
    /// Once: start the user script.
    pub run_script: bool,
    /// Once: stop the user script.
    pub stop_script: bool,
    /// Once: start the user script from the beginning if it runs.
    pub reset_script: bool,
    /// While it holds: trigger the emergency stop.
    pub estop: bool,
}

/// What min and max actions ask of one motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MotorTriggers {
    /// While it holds: stop at the highest deceleration and stay stopped until the input is back at its center.
    pub safe_stop: bool,
    /// While it holds: coast.
    pub off: bool,
    /// While it holds: stop and do not move forward.
    pub forward_limit: bool,
    /// While it holds: stop and do not move backward.
    pub backward_limit: bool,
    /// Once: reverse the direction.
    pub reverse: bool,
    /// While it holds: the home switch is closed.
    pub at_home: bool,
    /// Once: set the encoder register.
    pub load_home: Option<i32>,
}

impl MotorTriggers {
    /// Whether the motor is homed or at a limit switch, which is what the M1HM and M2HM indicators show (MCP manual 1.2.5).
    pub fn is_limited(self) -> bool {
        self.safe_stop || self.off || self.forward_limit || self.backward_limit || self.at_home
    }
}

/// An action as bits: motor 1 in the low byte, motor 2 in the high byte (MCP manual 3.1, SIGNALMINACTION).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ActionBits(u16);

const SAFE_STOP: u16 = 0x01;
const OFF: u16 = 0x02;
const REVERSE: u16 = 0x04;
const FORWARD_LIMIT: u16 = 0x08;
const BACKWARD_LIMIT: u16 = 0x10;
const LOAD_HOME: u16 = 0x20;
const RUN_SCRIPT: u16 = 0x0040;
const STOP_SCRIPT: u16 = 0x4000;
const RESET_SCRIPT: u16 = 0x0080;
const ESTOP: u16 = 0x8000;

impl ActionBits {
    /// From the raw field: one byte that counts the actions in generation 1, the bits themselves later.
    pub fn from_raw(raw: u16, one_byte: bool) -> Self {
        if !one_byte {
            return Self(raw);
        }
        let listed = SIGNAL_ACTIONS_GENERATION_1.iter().position(|code| code.raw == i64::from(raw));
        let bits = listed.and_then(|index| codes::SIGNAL_ACTIONS.get(index)).map_or(0, |code| code.raw);
        Self(bits as u16)
    }

    /// From the bits themselves.
    pub fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// The bits.
    pub fn bits(self) -> u16 {
        self.0
    }

    /// The raw field; none for a combination that the one-byte numbering does not have.
    pub fn to_raw(self, one_byte: bool) -> Option<u16> {
        if !one_byte {
            return Some(self.0);
        }
        let listed = codes::SIGNAL_ACTIONS.iter().position(|code| code.raw == i64::from(self.0))?;
        SIGNAL_ACTIONS_GENERATION_1.get(listed).map(|code| code.raw as u16)
    }

    /// Whether nothing is to be done.
    pub fn is_none(self) -> bool {
        self.0 == 0
    }

    /// Adds what lasts while the input is at its end.
    pub fn hold(self, triggers: &mut Triggers) {
        for (motor, bits) in self.per_motor(triggers) {
            motor.off |= bits & OFF != 0;
            motor.forward_limit |= bits & FORWARD_LIMIT != 0;
            motor.backward_limit |= bits & BACKWARD_LIMIT != 0;
            motor.at_home |= bits & LOAD_HOME != 0;
        }
        triggers.estop |= self.0 & ESTOP != 0;
    }

    /// Adds what lasts from the end until the input is back at its center.
    pub fn hold_until_center(self, triggers: &mut Triggers) {
        for (motor, bits) in self.per_motor(triggers) {
            motor.safe_stop |= bits & SAFE_STOP != 0;
        }
    }

    /// Adds what happens once, when the input arrives at its end.
    pub fn fire(self, load_home: i32, triggers: &mut Triggers) {
        for (motor, bits) in self.per_motor(triggers) {
            motor.reverse |= bits & REVERSE != 0;
            if bits & LOAD_HOME != 0 {
                motor.load_home = Some(load_home);
            }
        }
        triggers.run_script |= self.0 & RUN_SCRIPT != 0;
        triggers.stop_script |= self.0 & STOP_SCRIPT != 0;
        triggers.reset_script |= self.0 & RESET_SCRIPT != 0;
    }

    fn per_motor(self, triggers: &mut Triggers) -> impl Iterator<Item = (&mut MotorTriggers, u16)> {
        let bits = [self.0 & 0xff, self.0 >> 8];
        triggers.motors.iter_mut().zip(bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_of(bits: ActionBits) -> Triggers {
        let mut triggers = Triggers::default();
        bits.hold(&mut triggers);
        bits.hold_until_center(&mut triggers);
        bits.fire(500, &mut triggers);
        triggers
    }

    #[test]
    fn every_action_of_the_manuals_list_does_something_of_its_own() {
        let mut seen = Vec::new();
        for code in codes::SIGNAL_ACTIONS {
            let triggers = all_of(ActionBits::from_raw(code.raw as u16, false));
            assert!(!seen.contains(&triggers), "{} does what another action does", code.label);
            seen.push(triggers);
        }
        assert_eq!(seen[0], Triggers::default());
    }

    #[test]
    fn the_one_byte_codes_of_generation_1_mean_the_same_actions() {
        for (short, long) in SIGNAL_ACTIONS_GENERATION_1.iter().zip(codes::SIGNAL_ACTIONS) {
            assert_eq!(short.key, long.key);
            assert_eq!(ActionBits(long.raw as u16).to_raw(true), Some(short.raw as u16));
            assert_eq!(
                ActionBits::from_raw(short.raw as u16, true),
                ActionBits::from_raw(long.raw as u16, false)
            );
        }
        assert!(ActionBits::from_raw(200, true).is_none());
    }

    #[test]
    fn script_and_estop_bits_are_not_taken_for_motor_actions() {
        for raw in [RUN_SCRIPT, STOP_SCRIPT, RESET_SCRIPT, ESTOP] {
            assert_eq!(all_of(ActionBits(raw)).motors, [MotorTriggers::default(); 2]);
        }
    }

    #[test]
    fn load_home_hands_over_its_value() {
        let triggers = all_of(ActionBits(0x2000));
        assert_eq!(triggers.motors[0].load_home, None);
        assert_eq!(triggers.motors[1].load_home, Some(500));
    }
}
