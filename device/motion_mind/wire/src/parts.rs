//! Commands as a number and values, and registers as named fields: the words in which settings, screens and scripts speak of any
//! family.

use super::command::Command;
use super::frame::number;
use super::register::{REGISTERS, Register};
use brushwork_values::{Field, Kind as WireKind, Unit};
use std::sync::LazyLock;

/// One command: its numbers in both protocols, and what it takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CommandRow {
    /// The command byte.
    pub number: u8,
    /// The letter in text; `None` if the command has no such form.
    pub letter: Option<char>,
    /// Its name in the manual.
    pub name: &'static str,
    /// Its values in order, by name.
    pub values: &'static [&'static str],
    /// What it does.
    pub help: &'static str,
}

macro_rules! commands {
    ($($constant:ident $letter:expr, $name:literal $values:expr, $help:literal;)*) => {
        /// Every command of the binary protocol, by number (Motion Mind manual 5.3 to 5.12).
        pub static COMMANDS: &[CommandRow] = &[$(CommandRow {
            number: number::$constant, letter: $letter, name: $name, values: $values, help: $help,
        }),*];
    };
}

commands! {
    CHANGE_SPEED Some('C'), "CHANGE_SPEED" &["duty"], "mode 3: drive, -1023 to 1023, ramped by VELOCITYLIMIT every TIMER";
    MOVE_TO_ABSOLUTE Some('P'), "MOVETO_ABSOLUTE" &["position"], "modes 4 and 5: move to a position";
    MOVE_TO_RELATIVE Some('M'), "MOVETO_RELATIVE" &["distance"], "modes 4 and 5: move by a distance from where the motor is";
    MOVE_AT_VELOCITY Some('V'), "MOVEAT_VELOCITY" &["velocity"], "mode 4: turn at so many counts per PID loop";
    WRITE Some('W'), "WRITE" &["register", "value"], "change a register in RAM";
    WRITE_STORE Some('S'), "WRITE_STORE" &["register", "value"], "change a register in RAM and EEPROM; stops the motor";
    READ None, "READ" &["mask"], "read the registers whose bits are set, lowest first; in text R reads one, or the bits or all by index 97 to 99";
    RESTORE Some('X'), "RESTORE" &[], "factory values in RAM and EEPROM; stops the motor";
    RESET Some('Y'), "RESET" &[], "restart the firmware, which loads EEPROM; stops the motor";
    READ_REGISTER Some('R'), "READ REGISTER" &["register"], "read one register";
}

/// Command bytes by name, for code that speaks in numbers.
pub mod numbers {
    use super::super::frame::number;

    /// Drive in mode 3.
    pub const CHANGE_SPEED: u8 = number::CHANGE_SPEED;
    /// A move to a position.
    pub const MOVE_TO_ABSOLUTE: u8 = number::MOVE_TO_ABSOLUTE;
    /// A move by a distance.
    pub const MOVE_TO_RELATIVE: u8 = number::MOVE_TO_RELATIVE;
    /// A velocity.
    pub const MOVE_AT_VELOCITY: u8 = number::MOVE_AT_VELOCITY;
    /// A write to RAM.
    pub const WRITE: u8 = number::WRITE;
    /// A write to RAM and EEPROM.
    pub const WRITE_STORE: u8 = number::WRITE_STORE;
    /// A read by mask.
    pub const READ: u8 = number::READ;
    /// Factory values.
    pub const RESTORE: u8 = number::RESTORE;
    /// A new start.
    pub const RESET: u8 = number::RESET;
    /// A read of one register.
    pub const READ_REGISTER: u8 = number::READ_REGISTER;
}

/// The row of a command byte.
pub fn command_row(number: u8) -> Option<&'static CommandRow> {
    COMMANDS.iter().find(|row| row.number == number)
}

impl Command {
    /// The command of that number with these values in order. READ without a value reads all registers.
    pub fn from_parts(number: u8, values: &[i64]) -> Option<Self> {
        Some(match (number, values) {
            (number::CHANGE_SPEED, [duty]) => Self::ChangeSpeed((*duty).try_into().ok()?),
            (number::MOVE_TO_ABSOLUTE, [position]) => Self::MoveToAbsolute((*position).try_into().ok()?),
            (number::MOVE_TO_RELATIVE, [distance]) => Self::MoveToRelative((*distance).try_into().ok()?),
            (number::MOVE_AT_VELOCITY, [velocity]) => Self::MoveAtVelocity((*velocity).try_into().ok()?),
            (number::WRITE, [index, value]) => {
                Self::Write { register: (*index).try_into().ok()?, value: *value }
            }
            (number::WRITE_STORE, [index, value]) => {
                Self::WriteStore { register: (*index).try_into().ok()?, value: *value }
            }
            (number::READ, []) => Self::Read(u32::MAX),
            (number::READ, [mask]) => Self::Read((*mask).try_into().ok()?),
            (number::RESTORE, []) => Self::Restore,
            (number::RESET, []) => Self::Reset,
            (number::READ_REGISTER, [index]) => Self::ReadRegister((*index).try_into().ok()?),
            _ => return None,
        })
    }

    /// Its command byte; that of READ REGISTER for a read in text.
    pub fn number(&self) -> u8 {
        match self {
            Self::ChangeSpeed(_) => number::CHANGE_SPEED,
            Self::MoveToAbsolute(_) => number::MOVE_TO_ABSOLUTE,
            Self::MoveToRelative(_) => number::MOVE_TO_RELATIVE,
            Self::MoveAtVelocity(_) => number::MOVE_AT_VELOCITY,
            Self::Write { .. } => number::WRITE,
            Self::WriteStore { .. } => number::WRITE_STORE,
            Self::Read(_) => number::READ,
            Self::ReadRegister(_) | Self::ReadText(_) => number::READ_REGISTER,
            Self::Restore => number::RESTORE,
            Self::Reset => number::RESET,
        }
    }
}

/// The registers as named fields, by number: what a read of all gives.
pub fn fields() -> &'static [Field] {
    static FIELDS: LazyLock<Vec<Field>> = LazyLock::new(|| REGISTERS.iter().map(field_of).collect());
    &FIELDS
}

fn field_of(row: &'static Register) -> Field {
    let kind = match row.kind.bytes() {
        1 => WireKind::U8,
        2 if *row.kind.range().start() < 0 => WireKind::I16,
        2 => WireKind::U16,
        _ if *row.kind.range().start() < 0 => WireKind::I32,
        _ => WireKind::U32,
    };
    Field {
        name: row.name,
        label: row.name,
        kind,
        unit: Unit::None,
        scale: row.scale,
        decimals: 0,
        raw_range: Some((*row.range.start(), *row.range.end())),
        codes: &[],
        fixed: None,
        rank: row.number,
        doc: row.help,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_a_row_and_comes_back_from_its_number_and_values() {
        for row in COMMANDS {
            let values = vec![1; row.values.len()];
            let command = Command::from_parts(row.number, &values).unwrap();
            assert_eq!(command.number(), row.number, "{}", row.name);
        }
        assert_eq!(Command::from_parts(number::READ, &[]), Some(Command::Read(u32::MAX)));
        assert_eq!(Command::from_parts(number::CHANGE_SPEED, &[40_000]), None, "it does not fit its bytes");
        assert_eq!(Command::from_parts(0x99, &[]), None);
    }

    #[test]
    fn the_fields_are_the_registers_in_order() {
        assert_eq!(fields().len(), REGISTERS.len());
        assert!(fields().iter().zip(&REGISTERS).all(|(field, row)| field.name == row.name));
    }
}
