//! The reference page of the protocol, drawn from the tables of commands, characters, bits and errors.

use crate::contradictions::{CONTRADICTIONS, Contradiction};
use crate::single::Single;
use crate::status::{Bit, ErrorCode, INPUT_BITS, LIMIT_BITS, MOTION_BITS, OPERATION_BITS};
use crate::table::{Absent, COMMANDS, CommandRow, Effect, Parameter, Reports, Source};
use serde::Serialize;
use std::fmt::Write as _;

/// The whole page as data.
#[derive(Debug, Clone, Serialize)]
pub struct Reference {
    /// Every command.
    pub commands: Vec<CommandEntry>,
    /// The bits of the status, by byte.
    pub bits: Vec<BitEntry>,
    /// The errors.
    pub errors: Vec<ErrorEntry>,
    /// Where the manual contradicts itself.
    pub contradictions: &'static [Contradiction],
}

/// One command.
#[derive(Debug, Clone, Serialize)]
pub struct CommandEntry {
    /// Its two letters.
    pub name: &'static str,
    /// What they stand for.
    pub title: &'static str,
    /// The character that does the same at any time.
    pub character: Option<char>,
    /// What its number is; `None` if it takes none.
    pub number: Option<&'static str>,
    /// The least that it takes.
    pub min: Option<i32>,
    /// The most.
    pub max: Option<i32>,
    /// The unit of the number.
    pub unit: &'static str,
    /// What it means without a number, in words; empty where it takes none or needs one.
    pub without: String,
    /// What it reports, in words; empty for nothing.
    pub reports: String,
    /// What it does to the axis or the controller.
    pub effect: Effect,
    /// Where the manual has it.
    pub source: Source,
    /// What it does, in words.
    pub help: &'static str,
}

/// One bit of the status.
#[derive(Debug, Clone, Serialize)]
pub struct BitEntry {
    /// The byte.
    pub byte: &'static str,
    /// Its number.
    pub bit: u8,
    /// Its name.
    pub name: &'static str,
    /// What it says when it is set.
    pub set_means: &'static str,
}

/// One error.
#[derive(Debug, Clone, Serialize)]
pub struct ErrorEntry {
    /// Its number.
    pub number: u8,
    /// Its words.
    pub text: &'static str,
}

/// The bytes of the status that have bits, in their order.
const BYTES: [(&str, &[Bit]); 4] =
    [("operation", OPERATION_BITS), ("motion", MOTION_BITS), ("limits", LIMIT_BITS), ("inputs", INPUT_BITS)];

/// The page as data.
pub fn reference() -> Reference {
    let bits = BYTES.into_iter().flat_map(|(byte, bits)| bits.iter().map(move |bit| bit_entry(byte, bit)));
    let errors = ErrorCode::ALL.iter().map(|code| ErrorEntry { number: code.number(), text: code.text() });
    Reference {
        commands: COMMANDS.iter().map(command_entry).collect(),
        bits: bits.collect(),
        errors: errors.collect(),
        contradictions: CONTRADICTIONS,
    }
}

/// The page as text.
pub fn reference_page() -> String {
    let page = reference();
    let mut text = String::from(HEAD);
    text.push_str("\nCommands\n--------\n");
    page.commands.iter().for_each(|command| text.push_str(&command_text(command)));
    text.push_str("\nBits of the status (TS, %)\n--------------------------\n");
    page.bits.iter().for_each(|bit| text.push_str(&bit_text(bit)));
    text.push_str("\nErrors\n------\n");
    for ErrorEntry { number, text: words } in &page.errors {
        push(&mut text, format_args!("  {number:02X}  {words}\n"));
    }
    text.push_str("\nWhere the manual contradicts itself, and what counts here\n--------------------------------------------------------\n");
    for Contradiction { number, at, says, counts } in page.contradictions {
        push(&mut text, format_args!("  {number:>2}  {at}: {says}.\n      Here: {counts}.\n"));
    }
    text
}

/// The entries of that name: a command's letters, its character, or a byte of the status; `None` if there is none.
pub fn reference_entry(name: &str) -> Option<String> {
    let page = reference();
    let is_named = |command: &&CommandEntry| {
        let by_character = command.character.is_some_and(|character| name == character.to_string());
        command.name.eq_ignore_ascii_case(name) || by_character
    };
    let commands = page.commands.iter().filter(is_named).map(command_text);
    let bits = page.bits.iter().filter(|bit| bit.byte.eq_ignore_ascii_case(name)).map(bit_text);
    let found: String = commands.chain(bits).collect();
    (!found.is_empty()).then_some(found)
}

const HEAD: &str = "SuprMotr V9: its serial protocol (SuprMotr manual)\n\n\
Text. Ctrl-A and a character, 0 to 9 or A to F, select a controller; Ctrl-A V selects all. A line of up to 15 commands with commas between\n\
them is carried out at its carriage return; a carriage return alone repeats the last line. A line of its own ends a macro or a wait that is in\n\
process; the commands of one character (' ? \\ % # ! and backspace) do not, and ! stops every controller, selected or not. A report is address,\n\
letter, channel, colon and data, each line ended by CR LF and the last one by ETX as well.\n";

fn command_entry(row: &'static CommandRow) -> CommandEntry {
    let character = Single::ALL.into_iter().find(|single| single.mnemonic() == Some(row.mnemonic));
    CommandEntry {
        name: row.name,
        title: row.title,
        character: character.map(|single| char::from(single.character())),
        number: row.takes.map(|takes| takes.name),
        min: row.takes.map(|takes| takes.low),
        max: row.takes.map(|takes| takes.high),
        unit: row.takes.map_or("", |takes| takes.unit.symbol()),
        without: row.takes.map(without).unwrap_or_default(),
        reports: reports(row.reports),
        effect: row.effect,
        source: row.source,
        help: row.help,
    }
}

fn without(takes: Parameter) -> String {
    match takes.absent {
        Absent::Refused => String::new(),
        Absent::Means(number) => number.to_string(),
        Absent::All => "all".to_owned(),
    }
}

fn reports(reports: Reports) -> String {
    match reports {
        Reports::Nothing => String::new(),
        Reports::Number { id, also } => {
            let also = also.map(|also| format!(" or {}", char::from(also))).unwrap_or_default();
            format!("{}{also}: a number", char::from(id))
        }
        Reports::Plain => "O: a number without sign and zeros".to_owned(),
        Reports::Analog => "A: one number or two".to_owned(),
        Reports::Channels => "H: outputs and inputs, or one input".to_owned(),
        Reports::Status => "S: six bytes".to_owned(),
        Reports::Each(parts) => parts.iter().map(|part| part.name()).collect::<Vec<_>>().join(", "),
        Reports::Text => "text".to_owned(),
        Reports::Macros => "macros, a line each".to_owned(),
    }
}

fn bit_entry(byte: &'static str, bit: &'static Bit) -> BitEntry {
    BitEntry { byte, bit: bit.number, name: bit.name, set_means: bit.set_means }
}

fn command_text(command: &CommandEntry) -> String {
    let CommandEntry { name, title, character, number, min, max, unit, without, reports, help, .. } = command;
    let mut text = String::new();
    let character = character.map(|character| format!(" ({character})")).unwrap_or_default();
    push(&mut text, format_args!("\n{name}{character}  {title}\n    {help}\n"));
    if let (Some(number), Some(min), Some(max)) = (number, min, max) {
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let without =
            if without.is_empty() { String::new() } else { format!("; without a number {without}") };
        push(&mut text, format_args!("    Number:  {number}, {min} to {max}{unit}{without}\n"));
    }
    if !reports.is_empty() {
        push(&mut text, format_args!("    Reports: {reports}\n"));
    }
    text
}

fn bit_text(bit: &BitEntry) -> String {
    let BitEntry { byte, bit: number, name, set_means } = bit;
    format!("  {byte:<10} {number}  {name:<22} {set_means}\n")
}

fn push(text: &mut String, line: std::fmt::Arguments<'_>) {
    // Writing into a string cannot fail.
    let _ = text.write_fmt(line);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_every_command_bit_error_and_contradiction() {
        let text = reference_page();
        for row in COMMANDS {
            assert!(text.contains(&format!("\n{}", row.name)) && text.contains(row.help), "{}", row.name);
        }
        for bit in BYTES.into_iter().flat_map(|(_, bits)| bits) {
            assert!(text.contains(bit.name) && text.contains(bit.set_means), "{}", bit.name);
        }
        assert!(ErrorCode::ALL.iter().all(|code| text.contains(code.text())));
        assert!(CONTRADICTIONS.iter().all(|row| text.contains(row.says) && text.contains(row.counts)));
        assert!(text.contains("Number:  gain, 0 to 255\n") && text.contains("without a number 65535"));
    }

    #[test]
    fn an_entry_is_found_by_letters_by_character_or_by_the_byte_of_its_bits() {
        assert!(reference_entry("mr").unwrap().contains("Move Relative"));
        assert!(reference_entry("%").unwrap().contains("Tell Status"));
        assert!(reference_entry("limits").unwrap().contains("Active high"));
        assert_eq!(reference_entry("nothing"), None);
    }
}
