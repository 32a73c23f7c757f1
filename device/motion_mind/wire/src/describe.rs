//! Commands and replies in words, for the traffic view.

use super::address::Address;
use super::command::{Command, Part, registers_of};
use super::register::register;
use super::reply::Reply;

/// A command in words: "unit 1: write PTERM 6000".
pub fn describe_command(address: Address, command: &Command) -> String {
    let what = match *command {
        Command::ChangeSpeed(duty) => format!("drive {duty} of 1023"),
        Command::MoveToAbsolute(position) => format!("move to {position} counts"),
        Command::MoveToRelative(distance) => format!("move by {distance} counts"),
        Command::MoveAtVelocity(velocity) => format!("turn at {velocity} counts per loop"),
        Command::Write { register, value } => format!("write {} {value}", name(register)),
        Command::WriteStore { register, value } => format!("write and store {} {value}", name(register)),
        Command::Read(mask) => {
            let names: Vec<_> = registers_of(mask).map(|row| row.name).collect();
            if names.is_empty() { "read nothing".to_owned() } else { format!("read {}", names.join(", ")) }
        }
        Command::ReadRegister(index) | Command::ReadText(Part::Register(index)) => {
            format!("read {}", name(index))
        }
        Command::ReadText(Part::StatusBits) => "read the bits of STATUS".to_owned(),
        Command::ReadText(Part::FunctionBits) => "read the bits of FUNCTION".to_owned(),
        Command::ReadText(Part::All) => "read all registers".to_owned(),
        Command::Restore => "restore the factory's values".to_owned(),
        Command::Reset => "reset".to_owned(),
    };
    format!("{address}: {what}")
}

/// A reply in words: "PTERM 6000, ITERM 35".
pub fn describe_reply(reply: &Reply) -> String {
    match reply {
        Reply::Acknowledged => "acknowledged".to_owned(),
        Reply::NotUnderstood => "not understood".to_owned(),
        Reply::Returned(returned) => {
            let parts = [
                returned.position.map(|position| format!("POSITION {position}")),
                returned.velocity.map(|velocity| format!("VELOCITY {velocity}")),
                returned.time.map(|time| format!("TIME {time}")),
            ];
            parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
        }
        Reply::Registers(values) => {
            let parts = values.iter().map(|(index, value)| format!("{} {value}", name(*index)));
            parts.collect::<Vec<_>>().join(", ")
        }
        Reply::Bits(bits) => {
            let set = bits.iter().enumerate().filter(|(_, on)| **on).map(|(number, _)| number.to_string());
            let set: Vec<_> = set.collect();
            if set.is_empty() { "no bit set".to_owned() } else { format!("bits {} set", set.join(", ")) }
        }
    }
}

fn name(index: u8) -> String {
    register(index).map_or_else(|| format!("register {index}"), |row| row.name.to_owned())
}
