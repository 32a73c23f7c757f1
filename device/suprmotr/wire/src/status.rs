//! The six bytes of the status and the numbers of the errors (SuprMotr manual, "Tell Status").

use std::fmt;

use serde::Serialize;

/// One bit of a byte of the status.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bit {
    /// Its number, from 0.
    pub number: u8,
    /// Its name.
    pub name: &'static str,
    /// What it says when it is set.
    pub set_means: &'static str,
}

impl Bit {
    /// The byte that has only this bit set.
    pub const fn mask(self) -> u8 {
        1 << self.number
    }
}

macro_rules! bits {
    ($(#[$doc:meta])* $module:ident, $table:ident: $($number:literal $constant:ident $name:literal $means:literal;)*) => {
        $(#[$doc])*
        pub static $table: &[Bit] = &[$(Bit { number: $number, name: $name, set_means: $means }),*];

        /// Masks of the bits of the table of the same name.
        pub mod $module {
            $(#[doc = $means] pub const $constant: u8 = 1 << $number;)*
        }
    };
}

bits! {
    /// The first byte: what the controller is about.
    operation, OPERATION_BITS:
    0 ECHO "Echo" "received characters come back";
    1 WAIT "Wait" "a wait is in process";
    2 COMMAND_ERROR "Command error" "a command was refused";
    3 ZEROS_SUPPRESSED "Zero suppression" "leading zeros are left out";
    4 MACRO "Macro" "a macro is running";
    5 ZEROS_KEPT "Zeros kept" "leading zeros are not left out";
    6 HEXADECIMAL "Hexadecimal" "numbers are hexadecimal (assumed: the manual says \"number mode\")";
    7 ADDRESSED "Addressed" "the controller is selected";
}

bits! {
    /// The second byte: the motion.
    motion, MOTION_BITS:
    0 MOTOR_OFF "Motor off" "the motor is free";
    1 ERROR_POLARITY "Error polarity" "polarity of the dynamic error";
    2 FORWARD "Forward" "the move is in the positive direction";
    3 MOVE_ERROR "Move error" "a move went wrong";
    4 DECELERATION_POLARITY "Deceleration polarity" "polarity of the move when it began to decelerate";
    5 PHASE "Encoder phase" "phase of the encoder";
    6 EXCESSIVE_ERROR "Excessive error" "the position lagged further behind than SM allows";
    7 COMPLETE "Trajectory complete" "no move is in process";
}

bits! {
    /// The third byte: what limit switches do.
    limits, LIMIT_BITS:
    0 ENABLED "Limits on" "limit switches stop the motor";
    1 ACTIVE_HIGH "Active high" "a limit switch is on while its input is high";
    2 FIND_EDGE "Find edge" "an edge is being looked for";
    3 EDGE_STATE "Edge state" "state of the input when the search began";
}

bits! {
    /// The fourth byte: the inputs as they are. Assumed: a limit's bit is set while the switch is on, whichever level that is.
    inputs, INPUT_BITS:
    1 POSITIVE "Positive limit" "the positive limit switch is on";
    2 REFERENCE "Reference" "the reference switch is on";
    3 NEGATIVE "Negative limit" "the negative limit switch is on";
}

/// What TS and `%` report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Status {
    /// [`OPERATION_BITS`].
    pub operation: u8,
    /// [`MOTION_BITS`].
    pub motion: u8,
    /// [`LIMIT_BITS`].
    pub limits: u8,
    /// [`INPUT_BITS`].
    pub inputs: u8,
    /// The mode of moving, which the manual does not describe.
    pub mode: u8,
    /// The number of the last error, 0 for none: [`ErrorCode`].
    pub error: u8,
}

impl Status {
    /// The bytes in the order of the wire.
    pub const fn bytes(self) -> [u8; 6] {
        [self.operation, self.motion, self.limits, self.inputs, self.mode, self.error]
    }

    /// The status of these bytes. The last one is the error, whether the mode stands before it or not.
    pub const fn from_bytes(bytes: &[u8]) -> Option<Self> {
        match *bytes {
            [operation, motion, limits, inputs, mode, error] => {
                Some(Self { operation, motion, limits, inputs, mode, error })
            }
            [operation, motion, limits, inputs, error] => {
                Some(Self { operation, motion, limits, inputs, mode: 0, error })
            }
            _ => None,
        }
    }

    /// Whether no move is in process.
    pub const fn is_complete(self) -> bool {
        self.motion & motion::COMPLETE != 0
    }

    /// Whether the loop drives the motor.
    pub const fn is_motor_on(self) -> bool {
        self.motion & motion::MOTOR_OFF == 0
    }
}

macro_rules! errors {
    ($($number:literal $name:ident $text:literal;)*) => {
        /// Why a command was refused.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
        #[serde(rename_all = "snake_case")]
        #[repr(u8)]
        pub enum ErrorCode {
            $(#[doc = $text] $name = $number,)*
        }

        impl ErrorCode {
            /// All of them, by number.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// Its words.
            pub const fn text(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }
        }
    };
}

errors! {
    0x01 NotAvailable "there is no such command";
    0x02 NotALetter "a command must start with a letter";
    0x03 NoCommand "a command is missing";
    0x04 Negative "the number must not be negative";
    0x05 NotANumber "a number must follow the command";
    0x06 TooLarge "the number is too large";
    0x07 TooSmall "the number is too small";
    0x08 NoComma "a comma must follow";
    0x09 LineOverflow "the line is too long";
    0x0A MacroOverflow "the macro is too long";
}

impl ErrorCode {
    /// Its number.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The error of that number; `None` for 0 and for what the manual does not have.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.iter().find(|code| code.number() == number).copied()
    }
}

impl fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}
