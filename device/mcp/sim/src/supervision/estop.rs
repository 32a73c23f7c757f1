//! The emergency stop and the three ways out of it (commands 200 to 202).

/// How a tripped emergency stop is released once nothing presses it any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EStopReset {
    /// Only by a restart of the unit.
    Hardware,
    /// By command 200.
    Software,
    /// By itself (generation 4).
    Automatic,
}

impl EStopReset {
    /// Lock byte of command 201: 0xAA unlocks; in generation 4, 0x55 makes the reset automatic; the rest locks.
    pub fn from_wire(lock: u8, has_automatic: bool) -> Self {
        match lock {
            0xaa => Self::Software,
            0x55 if has_automatic => Self::Automatic,
            _ => Self::Hardware,
        }
    }
}

/// The emergency stop's state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EStop {
    tripped: bool,
    pressed: bool,
}

impl EStop {
    /// Takes the state of the button and of inputs whose action is a stop.
    pub fn update(&mut self, pressed: bool, reset: EStopReset) {
        self.pressed = pressed;
        if pressed {
            self.tripped = true;
        } else if reset == EStopReset::Automatic {
            self.tripped = false;
        }
    }

    /// Command 200: releases the stop if it is unlocked and nothing presses it.
    pub fn reset(&mut self, reset: EStopReset) {
        if reset != EStopReset::Hardware && !self.pressed {
            self.tripped = false;
        }
    }

    /// Whether the motors are stopped.
    pub fn is_tripped(self) -> bool {
        self.tripped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tripped() -> EStop {
        let mut estop = EStop::default();
        estop.update(true, EStopReset::Hardware);
        estop.update(false, EStopReset::Hardware);
        assert!(estop.is_tripped());
        estop
    }

    #[test]
    fn locked_it_stays_whatever_is_sent() {
        let mut estop = tripped();
        estop.reset(EStopReset::Hardware);
        assert!(estop.is_tripped());
    }

    #[test]
    fn unlocked_command_200_releases_it_but_not_while_it_is_pressed() {
        let mut estop = tripped();
        estop.update(true, EStopReset::Software);
        estop.reset(EStopReset::Software);
        assert!(estop.is_tripped());
        estop.update(false, EStopReset::Software);
        estop.reset(EStopReset::Software);
        assert!(!estop.is_tripped());
    }

    #[test]
    fn automatic_it_ends_with_the_press() {
        let mut estop = EStop::default();
        estop.update(true, EStopReset::Automatic);
        assert!(estop.is_tripped());
        estop.update(false, EStopReset::Automatic);
        assert!(!estop.is_tripped());
    }

    #[test]
    fn the_lock_byte_is_read_as_its_generation_reads_it() {
        assert_eq!(EStopReset::from_wire(0xaa, false), EStopReset::Software);
        assert_eq!(EStopReset::from_wire(0x55, false), EStopReset::Hardware);
        assert_eq!(EStopReset::from_wire(0x55, true), EStopReset::Automatic);
        assert_eq!(EStopReset::from_wire(0, true), EStopReset::Hardware);
        assert_eq!(EStopReset::from_wire(1, false), EStopReset::Hardware);
    }
}
