//! What a Motion Mind 3 has of its own in the window: what its mode lets this program drive, and the state of its assistants.

use super::desk::Desk;
use super::screen::Screen;

pub mod registers;

/// The state of a Motion Mind's screens.
#[derive(Debug, Default)]
pub struct MotionMindDesk {}

/// What serial commands can move, by the mode and two bits (Motion Mind manual, chapter 4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driven {
    /// Mode 3: a duty.
    Duty,
    /// Mode 4: a velocity, and positions.
    Loop,
    /// Mode 5 with ADSERIAL: positions.
    Position,
    /// Something else moves the motor, or nothing does.
    Nothing,
    /// The mode has not been read.
    Unknown,
}

impl Driven {
    /// What the mode and FUNCTION say.
    pub fn of(mode: Option<i64>, takes_serial_setpoint: bool) -> Self {
        match mode {
            None => Self::Unknown,
            Some(3) => Self::Duty,
            Some(4) => Self::Loop,
            Some(5) if takes_serial_setpoint => Self::Position,
            Some(_) => Self::Nothing,
        }
    }

    /// The screens that drive, or the one that says why there is none.
    pub const fn screens(self) -> &'static [Screen] {
        match self {
            Self::Duty => &[Screen::Pwm],
            Self::Loop => &[Screen::Velocity, Screen::Position],
            Self::Position => &[Screen::Position],
            Self::Nothing | Self::Unknown => &[Screen::Motion],
        }
    }
}

impl MotionMindDesk {
    /// What can be driven from here.
    pub fn driven_by(&self, desk: &Desk) -> Driven {
        let serial_setpoint =
            desk.has_bit(registers::FUNCTION, brushwork_protocol::motion_mind::function::ADSERIAL);
        Driven::of(desk.register(registers::MODE), serial_setpoint)
    }
}
