//! What a client can ask of a Motion Mind 3 (Motion Mind manual 5.3 to 5.12).

use super::register::{Register, register};

/// A command, the same in both protocols but for reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// Drives the motor in mode 3, -1023 to 1023 of full duty, ramped.
    ChangeSpeed(i16),
    /// Moves to a position in modes 4 and 5, counts.
    MoveToAbsolute(i32),
    /// Moves by a distance in modes 4 and 5, counts.
    MoveToRelative(i32),
    /// Turns at a velocity in mode 4, counts per PID loop.
    MoveAtVelocity(i16),
    /// Changes a register in RAM.
    Write {
        /// Its number.
        register: u8,
        /// Its new value.
        value: i64,
    },
    /// Changes a register in RAM and in EEPROM, and stops the motor.
    WriteStore {
        /// Its number.
        register: u8,
        /// Its new value.
        value: i64,
    },
    /// Reads the registers whose bits are set. Binary only.
    Read(u32),
    /// Reads one register, whatever its number. Binary only.
    ReadRegister(u8),
    /// Reads in text.
    ReadText(Part),
    /// Brings back the factory's values, in RAM and in EEPROM, and stops the motor.
    Restore,
    /// Starts the firmware anew, and stops the motor.
    Reset,
}

/// What a read in text asks for, by its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// One register, index 0 to 31.
    Register(u8),
    /// The bits of STATUS, index 97.
    StatusBits,
    /// The bits of FUNCTION, index 98.
    FunctionBits,
    /// All registers, index 99.
    All,
}

/// What a command may do to the motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Only reads.
    Query,
    /// Moves the motor to or at a given value: sent twice it does the same.
    Motion,
    /// Moves the motor by a distance: sent twice it moves twice.
    RelativeMotion,
    /// Changes a register.
    Setting,
    /// Stops the motor to write EEPROM or to start anew.
    Stopping,
}

impl Command {
    /// The registers that a read names, as the mask of [`Command::Read`]; 0 for what names none, such as the read of all in text.
    pub fn named_registers(&self) -> u32 {
        match *self {
            Self::Read(mask) => mask,
            Self::ReadRegister(number) | Self::ReadText(Part::Register(number)) => {
                1_u32.checked_shl(number.into()).unwrap_or(0)
            }
            Self::ReadText(Part::StatusBits | Part::FunctionBits | Part::All)
            | Self::ChangeSpeed(_)
            | Self::MoveToAbsolute(_)
            | Self::MoveToRelative(_)
            | Self::MoveAtVelocity(_)
            | Self::Write { .. }
            | Self::WriteStore { .. }
            | Self::Restore
            | Self::Reset => 0,
        }
    }

    /// What it may do to the motor.
    pub fn effect(&self) -> Effect {
        match self {
            Self::ChangeSpeed(_) | Self::MoveToAbsolute(_) | Self::MoveAtVelocity(_) => Effect::Motion,
            Self::MoveToRelative(_) => Effect::RelativeMotion,
            Self::Write { .. } => Effect::Setting,
            Self::WriteStore { .. } | Self::Restore | Self::Reset => Effect::Stopping,
            Self::Read(_) | Self::ReadRegister(_) | Self::ReadText(_) => Effect::Query,
        }
    }

    /// Whether the return bits of FUNCTION replace its acknowledge (Motion Mind manual, figure 20).
    pub fn takes_returns(&self) -> bool {
        !matches!(self.effect(), Effect::Query)
            && !matches!(self, Self::Write { .. } | Self::WriteStore { .. })
    }
}

impl Part {
    /// The index that stands for it in a line.
    pub fn index(self) -> u8 {
        match self {
            Self::Register(number) => number,
            Self::StatusBits => 97,
            Self::FunctionBits => 98,
            Self::All => 99,
        }
    }

    /// What an index stands for, if anything.
    pub fn from_index(index: u8) -> Option<Self> {
        match index {
            97 => Some(Self::StatusBits),
            98 => Some(Self::FunctionBits),
            99 => Some(Self::All),
            number => register(number).map(|found| Self::Register(found.number)),
        }
    }
}

/// The registers of a mask, lowest number first, as they stand in the reply to [`Command::Read`].
pub(super) fn registers_of(mask: u32) -> impl Iterator<Item = &'static Register> {
    (0..32).filter(move |number| mask >> number & 1 == 1).filter_map(register)
}
