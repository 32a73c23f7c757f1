//! The reference page of both protocols, drawn from the tables of commands, registers and bits.

use super::bits::{Bit, FUNCTION_BITS, FUNCTION2_BITS, STATUS_BITS};
use super::contradictions::{CONTRADICTIONS, Contradiction};
use super::parts::{COMMANDS, CommandRow};
use super::register::{REGISTERS, Register};
use serde::Serialize;
use std::fmt::Write as _;

/// The whole page as data.
#[derive(Debug, Clone, Serialize)]
pub struct Reference {
    /// Every command.
    pub commands: Vec<CommandEntry>,
    /// Every register.
    pub registers: Vec<RegisterEntry>,
    /// The bits of FUNCTION, FUNCTION2 and STATUS, by register.
    pub bits: Vec<BitEntry>,
    /// Where the manual contradicts itself.
    pub contradictions: &'static [Contradiction],
}

/// One command.
#[derive(Debug, Clone, Serialize)]
pub struct CommandEntry {
    /// The command byte.
    pub number: u8,
    /// The letter in text.
    pub letter: Option<char>,
    /// Its name in the manual.
    pub name: &'static str,
    /// Its values in order.
    pub values: &'static [&'static str],
    /// Its binary form, field by field.
    pub frame: String,
    /// Its line in text, for unit 1; empty if it has none.
    pub line: String,
    /// What it does.
    pub help: &'static str,
}

/// One register.
#[derive(Debug, Clone, Serialize)]
pub struct RegisterEntry {
    /// Its number.
    pub number: u8,
    /// Its name in the manual.
    pub name: &'static str,
    /// Bytes on the wire.
    pub bytes: usize,
    /// Whether a write changes it.
    pub writable: bool,
    /// The least the manual allows.
    pub min: i64,
    /// The most.
    pub max: i64,
    /// The factory's value.
    pub default: Option<i64>,
    /// The unit of a step.
    pub unit: &'static str,
    /// One step in that unit.
    pub scale: f64,
    /// What it is for.
    pub help: &'static str,
}

/// One bit of a register.
#[derive(Debug, Clone, Serialize)]
pub struct BitEntry {
    /// The register.
    pub register: &'static str,
    /// Its number.
    pub bit: u8,
    /// Its name.
    pub name: &'static str,
    /// What it means when it is set.
    pub set_means: &'static str,
}

/// The page as data.
pub fn reference() -> Reference {
    let bits = [("FUNCTION", FUNCTION_BITS), ("FUNCTION2", FUNCTION2_BITS), ("STATUS", STATUS_BITS)];
    Reference {
        commands: COMMANDS.iter().map(command_entry).collect(),
        registers: REGISTERS.iter().map(register_entry).collect(),
        bits: bits
            .into_iter()
            .flat_map(|(register, bits)| bits.iter().map(move |bit| bit_entry(register, bit)))
            .collect(),
        contradictions: CONTRADICTIONS,
    }
}

/// The page as text.
pub fn reference_page() -> String {
    let page = reference();
    let mut text = String::from(HEAD);
    text.push_str("\nCommands\n--------\n");
    page.commands.iter().for_each(|command| text.push_str(&command_text(command)));
    text.push_str("\nRegisters\n---------\n");
    page.registers.iter().for_each(|register| text.push_str(&register_text(register)));
    let mut of = "";
    for bit in &page.bits {
        if bit.register != of {
            of = bit.register;
            push(&mut text, format_args!("\nBits of {of}\n"));
        }
        push(&mut text, format_args!("  {:>2}  {:<14} {}\n", bit.bit, bit.name, bit.set_means));
    }
    text.push_str("\nWhere the manual contradicts itself, and what counts here\n--------------------------------------------------------\n");
    for Contradiction { number, at, says, counts } in page.contradictions {
        push(&mut text, format_args!("  {number:>2}  {at}: {says}.\n      Here: {counts}.\n"));
    }
    text
}

/// The entries of commands and registers of that name, number or letter, as text; `None` if there is none.
pub fn reference_entry(name: &str) -> Option<String> {
    let page = reference();
    let number =
        name.strip_prefix("0x").map_or_else(|| name.parse().ok(), |hex| u8::from_str_radix(hex, 16).ok());
    let wanted = name.replace([' ', '-'], "_");
    let is_command = |command: &&CommandEntry| {
        command.name.replace(' ', "_").eq_ignore_ascii_case(&wanted) || number == Some(command.number)
    };
    let is_register = |register: &&RegisterEntry| register.name.eq_ignore_ascii_case(name);
    let commands = page.commands.iter().filter(is_command).map(command_text);
    let registers = page.registers.iter().filter(is_register).map(register_text);
    let bits = page.bits.iter().filter(|bit| bit.register.eq_ignore_ascii_case(name));
    let bits = bits.map(|bit| format!("      bit {:>2}  {:<14} {}\n", bit.bit, bit.name, bit.set_means));
    let found: String = commands.chain(registers).chain(bits).collect();
    (!found.is_empty()).then_some(found)
}

const HEAD: &str = "Motion Mind 3: both serial protocols (Motion Mind manual, chapters 5 and 6)\n\n\
Binary: command, address, data (least significant byte first), sum of all bytes before it. Bytes of a frame come within 5 ms\n\
of each other; leave 5 ms between frames. An accepted frame is acknowledged with 06; anything else is met with silence.\n\
Text: a letter, the address in two digits, a space, the index of a register, a space, a number, CR LF. OK or BAD COMMAND.\n\
Address 99 is every unit; none answers. The return bits of FUNCTION put POSITION, VELOCITY and TIME in place of the\n\
acknowledge of every command but reads and writes. Z, the self-test, is never sent: a unit needs a power cycle after it.\n";

fn command_entry(row: &CommandRow) -> CommandEntry {
    let data: String = row.values.iter().map(|value| format!(" {value}")).collect();
    let index = |name: &&&str| **name == "register";
    let line = row.letter.map_or_else(String::new, |letter| {
        let values: String = row
            .values
            .iter()
            .map(|value| if index(&value) { " nn".to_owned() } else { format!(" <{value}>") })
            .collect();
        format!("{letter}01{values}")
    });
    CommandEntry {
        number: row.number,
        letter: row.letter,
        name: row.name,
        values: row.values,
        frame: format!("{:02X} address{data} sum", row.number),
        line,
        help: row.help,
    }
}

fn register_entry(row: &Register) -> RegisterEntry {
    RegisterEntry {
        number: row.number,
        name: row.name,
        bytes: row.kind.bytes(),
        writable: row.is_writable(),
        min: *row.range.start(),
        max: *row.range.end(),
        default: row.default,
        unit: row.unit,
        scale: row.scale,
        help: row.help,
    }
}

fn bit_entry(register: &'static str, bit: &'static Bit) -> BitEntry {
    BitEntry { register, bit: bit.number, name: bit.name, set_means: bit.set_means }
}

fn command_text(command: &CommandEntry) -> String {
    let mut text = String::new();
    push(
        &mut text,
        format_args!("\n{}\n    {}\n    Binary: {}\n", command.name, command.help, command.frame),
    );
    if !command.line.is_empty() {
        push(&mut text, format_args!("    Text:   {}\n", command.line));
    }
    text
}

fn register_text(register: &RegisterEntry) -> String {
    let mut text = String::new();
    let RegisterEntry { number, name, bytes, min, max, help, .. } = register;
    let access = if register.writable { "read and write" } else { "read only" };
    let default = register.default.map_or_else(String::new, |default| format!(", factory {default}"));
    let step = match register.unit {
        "" => String::new(),
        unit if register.scale == 1.0 => format!(", {unit}"),
        unit => format!(", {} {unit} a step", register.scale),
    };
    push(
        &mut text,
        format_args!(
            "  {number:>2}  {name:<16} {bytes} bytes, {access}, {min} to {max}{default}{step}\n      {help}\n"
        ),
    );
    text
}

fn push(text: &mut String, line: std::fmt::Arguments<'_>) {
    // Writing into a string cannot fail.
    let _ = text.write_fmt(line);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_every_command_register_and_bit() {
        let text = reference_page();
        for name in COMMANDS.iter().map(|row| row.name).chain(REGISTERS.iter().map(|row| row.name)) {
            assert!(text.contains(name), "{name}");
        }
        for bit in FUNCTION_BITS.iter().chain(FUNCTION2_BITS).chain(STATUS_BITS) {
            assert!(text.contains(bit.name) && text.contains(bit.set_means), "{}", bit.name);
        }
        for (index, row) in CONTRADICTIONS.iter().enumerate() {
            assert_eq!(usize::from(row.number), index + 1);
            assert!(text.contains(row.says) && text.contains(row.counts), "{}", row.number);
        }
        assert_eq!(CONTRADICTIONS.len(), 23);
        assert!(text.contains("18 address register value sum") && text.contains("W01 nn <value>"));
    }

    #[test]
    fn an_entry_is_found_by_name_number_or_register() {
        assert!(reference_entry("write-store").unwrap().contains("19 address"));
        assert!(reference_entry("0x1A").unwrap().contains("READ"));
        assert!(reference_entry("status").unwrap().contains("TEMPFAULT"));
        assert_eq!(reference_entry("nothing"), None);
    }
}
