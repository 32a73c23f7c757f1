//! Commands that a program gives to the board it runs on, beside motion commands: an instruction hands over their arguments, in the order
//! in which they are written, and takes back what they give.

use crate::listed::listed;

listed! {
    /// A command of a board.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Board {
        /// A tone: two figures whose units the maker does not give.
        Beep "Beep",
        /// Two characters on the display.
        DisplayChars "DisplayChars",
        /// A byte on the display, as two hexadecimal digits.
        DisplayHex "DisplayHex",
        /// A timer and after how many ticks it raises its event.
        SetTimer "SetTimer",
        /// Gives the clock.
        GetClock "GetClock",
        /// A motor, a direction and a speed in percent.
        SetMotor "SetMotor",
        /// A motor.
        StopMotor "StopMotor",
        /// All motors.
        StopMotors "StopMotors",
        /// A stepper, waits at its highest and its lowest speed, and the current that holds it in percent.
        ConfigStepper "ConfigStepper",
        /// A stepper, a direction and a number of steps.
        SetStepper "SetStepper",
        /// A servo, a direction and an angle in degrees.
        SetServo "SetServo",
        /// Gives an analog input.
        ReadAnalogue "ReadAnalogue",
        /// Gives the number by which the program was started.
        GetProgramNumber "GetProgramNumber",
        /// Does nothing; a debugger stops here.
        Debug "Debug",
    }
    /// Its word.
    #[must_use]
    fn word;
}

impl Board {
    /// How many arguments it has.
    #[must_use]
    pub const fn arguments(self) -> usize {
        match self {
            Self::StopMotors | Self::GetClock | Self::GetProgramNumber | Self::Debug => 0,
            Self::DisplayHex | Self::StopMotor | Self::ReadAnalogue => 1,
            Self::Beep | Self::DisplayChars | Self::SetTimer => 2,
            Self::SetMotor | Self::SetStepper | Self::SetServo => 3,
            Self::ConfigStepper => 4,
        }
    }

    /// Whether it gives a value.
    #[must_use]
    pub const fn gives(self) -> bool {
        matches!(self, Self::GetClock | Self::ReadAnalogue | Self::GetProgramNumber)
    }
}
