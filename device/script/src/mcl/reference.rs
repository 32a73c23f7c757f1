//! The language reference, drawn from the tables that compiler and machine read: as rows to serialise and as a page of text.

use super::codes;
use super::contradictions::{CONTRADICTIONS, Contradiction};
use super::operators::{OPERATORS, Takes};
use super::registers::{MISSPELT, REGISTERS, RegisterId, values};
use super::types::{self, TABLES, VarType};
use super::words::{CAN, COMMANDS, FORMATS, OTHER_PRODUCT, Word};
use crate::image::{OPCODES, Opcode};
use crate::program::{ROOMS, Room, limits};
use serde::Serialize;
use std::fmt::Write as _;

/// The whole reference.
#[derive(Clone, Debug, Serialize)]
pub struct Reference {
    /// Statements, definitions and compile-time directives.
    pub commands: Vec<Word>,
    /// Operators, the tightest first.
    pub operators: Vec<OperatorEntry>,
    /// Output and input modifiers.
    pub formats: Vec<Word>,
    /// Types of variables, with their modifiers.
    pub types: Vec<TypeEntry>,
    /// Types of tables.
    pub tables: Vec<TableEntry>,
    /// System registers.
    pub registers: Vec<RegisterEntry>,
    /// Words that are kept and cannot be used.
    pub reserved: Vec<&'static str>,
    /// Errors and warnings.
    pub codes: Vec<CodeEntry>,
    /// Where the manual contradicts itself.
    pub contradictions: Vec<Contradiction>,
    /// What models hold; assumed.
    pub rooms: Vec<Room>,
    /// The byte code.
    pub opcodes: Vec<Opcode>,
}

/// An operator.
#[derive(Clone, Debug, Serialize)]
pub struct OperatorEntry {
    /// Its word or sign.
    pub name: &'static str,
    /// 1 is worked out first, 9 last.
    pub order: u8,
    /// How it is written.
    pub syntax: &'static str,
    /// What it gives.
    pub help: &'static str,
    /// Which numbers it takes.
    pub takes: Takes,
}

/// A type of variables.
#[derive(Clone, Debug, Serialize)]
pub struct TypeEntry {
    /// Its name.
    pub name: &'static str,
    /// Bits that it takes.
    pub bits: u32,
    /// Smallest and largest whole number; none for floats.
    pub range: Option<(i64, i64)>,
    /// The modifiers that a variable of it takes.
    pub modifiers: Vec<String>,
}

/// A type of tables.
#[derive(Clone, Debug, Serialize)]
pub struct TableEntry {
    /// Its name.
    pub name: &'static str,
    /// Type of each entry.
    pub entry: &'static str,
}

/// A system register.
#[derive(Clone, Debug, Serialize)]
pub struct RegisterEntry {
    /// Its name.
    pub name: &'static str,
    /// Type of each element.
    pub kind: &'static str,
    /// How many elements it has.
    pub length: u8,
    /// Whether a program may set it.
    pub writable: bool,
    /// What one step of its value is; empty for plain numbers.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Named values or bits.
    pub values: Vec<(u32, &'static str)>,
    /// Spellings of the manual's table that are taken too.
    pub also: Vec<&'static str>,
}

/// An error or a warning.
#[derive(Clone, Debug, Serialize)]
pub struct CodeEntry {
    /// "E..." or "W...".
    pub code: &'static str,
    /// What it says.
    pub meaning: &'static str,
}

/// All of it.
#[must_use]
pub fn reference() -> Reference {
    Reference {
        commands: COMMANDS.to_vec(),
        operators: OPERATORS
            .iter()
            .map(|row| OperatorEntry {
                name: row.name,
                order: row.order(),
                syntax: row.syntax,
                help: row.help,
                takes: row.takes(),
            })
            .collect(),
        formats: FORMATS.to_vec(),
        types: VarType::ALL.map(type_entry).to_vec(),
        tables: TABLES.map(|(name, kind)| TableEntry { name, entry: kind.name() }).to_vec(),
        registers: registers(),
        reserved: CAN.into_iter().chain(OTHER_PRODUCT).collect(),
        codes: codes::ALL.iter().map(|(code, meaning)| CodeEntry { code, meaning }).collect(),
        contradictions: CONTRADICTIONS.to_vec(),
        rooms: ROOMS.to_vec(),
        opcodes: OPCODES.to_vec(),
    }
}

fn type_entry(kind: VarType) -> TypeEntry {
    TypeEntry { name: kind.name(), bits: kind.bits(), range: kind.range(), modifiers: types::parts(kind) }
}

fn registers() -> Vec<RegisterEntry> {
    let entry = |(id, row): (u8, &super::registers::Register)| RegisterEntry {
        name: row.name,
        kind: row.kind.name(),
        length: row.length,
        writable: row.writable,
        unit: row.unit,
        meaning: row.meaning,
        values: values(RegisterId(id)).to_vec(),
        also: MISSPELT.iter().filter(|(_, right)| *right == row.name).map(|(wrong, _)| *wrong).collect(),
    };
    (0..).zip(&REGISTERS).map(entry).collect()
}

/// A heading of the page with what stands under it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// Its heading.
    pub title: &'static str,
    /// Its entries: a head and lines of text.
    pub entries: Vec<(String, Vec<String>)>,
}

/// The page in its sections, for a window.
#[must_use]
pub fn sections() -> Vec<Section> {
    let section = |title, entries| Section { title, entries };
    vec![
        section("Commands", words(&COMMANDS)),
        section("Operators by precedence", operators()),
        section("Output and input modifiers", words(&FORMATS)),
        section("Types and their modifiers", type_lines()),
        section("System registers", register_lines()),
        section("Errors and warnings", code_lines()),
        section("Where the manual contradicts itself", contradiction_lines()),
        section("Limits", limit_lines()),
        section("Byte code", opcode_lines()),
    ]
}

/// The page as text.
#[must_use]
pub fn page() -> String {
    let mut page = String::from("MCL language reference\n");
    for section in sections() {
        let _ = write!(page, "\n{}\n{}\n", section.title, "=".repeat(section.title.chars().count()));
        for (head, lines) in section.entries {
            let _ = writeln!(page, "{head}");
            for line in lines {
                let _ = writeln!(page, "    {line}");
            }
        }
    }
    page
}

type Entries = Vec<(String, Vec<String>)>;

fn words(rows: &[Word]) -> Entries {
    rows.iter().map(|row| (row.name.to_owned(), vec![row.syntax.to_owned(), row.help.to_owned()])).collect()
}

fn operators() -> Entries {
    let entry = |row: &super::operators::Operator| {
        let takes = match row.takes() {
            Takes::Integers => "whole numbers",
            Takes::Floats => "floating point numbers",
            Takes::Both => "whole and floating point numbers",
        };
        (format!("{}  {}", row.order(), row.syntax), vec![format!("{} Takes {takes}.", row.help)])
    };
    OPERATORS.iter().map(entry).collect()
}

fn type_lines() -> Entries {
    let mut entries: Entries = VarType::ALL
        .iter()
        .map(|kind| {
            let range = match kind.range() {
                Some((least, most)) => format!("{} bits, {least} to {most}", kind.bits()),
                None => format!("{} bits, floating point", kind.bits()),
            };
            (kind.name().to_owned(), vec![range, types::parts(*kind).join(" ")])
        })
        .collect();
    let table = |(name, kind): &(&str, VarType)| {
        ((*name).to_owned(), vec![format!("entries of type {}", kind.name())])
    };
    entries.extend(TABLES.iter().map(table));
    entries.iter_mut().for_each(|(_, lines)| lines.retain(|line| !line.is_empty()));
    entries
}

fn register_lines() -> Entries {
    let entry = |row: RegisterEntry| {
        let length = if row.length > 1 { format!("({})", row.length) } else { String::new() };
        let access = if row.writable { "read and write" } else { "read only" };
        let unit = if row.unit.is_empty() { String::new() } else { format!(", unit {}", row.unit) };
        let mut lines = vec![format!("{}, {access}{unit}", row.kind), row.meaning.to_owned()];
        lines.extend(row.values.iter().map(|(value, meaning)| format!("0x{value:04X} {meaning}")));
        lines.extend(row.also.iter().map(|wrong| format!("also taken: {wrong}")));
        (format!("{}{length}", row.name), lines)
    };
    registers().into_iter().map(entry).collect()
}

fn code_lines() -> Entries {
    codes::ALL.iter().map(|(code, meaning)| ((*code).to_owned(), vec![(*meaning).to_owned()])).collect()
}

fn contradiction_lines() -> Entries {
    let entry = |row: &Contradiction| {
        let mut lines = vec![
            format!("one place: {}", row.one),
            format!("another: {}", row.other),
            format!("here: {}", row.here),
        ];
        lines.extend(row.warning.map(|code| format!("warning {code}")));
        (row.about.to_owned(), lines)
    };
    CONTRADICTIONS.iter().map(entry).collect()
}

fn limit_lines() -> Entries {
    let whole = vec![
        format!("{} bytes of variables", limits::RAM_BYTES),
        format!("{} instructions, {} bytes of tables and texts", limits::INSTRUCTIONS, limits::DATA_BYTES),
        format!("{} cells of the stack, {} calls within calls", limits::STACK_CELLS, limits::CALLS),
        "Assumed: what the controllers hold is not public.".to_owned(),
    ];
    let room = |room: &Room| {
        let line =
            format!("{} bytes of variables, image of {} bytes (assumed)", room.ram_bytes, room.image_bytes);
        (room.model.to_owned(), vec![line])
    };
    [("every model".to_owned(), whole)].into_iter().chain(ROOMS.iter().map(room)).collect()
}

fn opcode_lines() -> Entries {
    let entry = |row: &Opcode| (format!("0x{:02X} {}", row.code, row.name), vec![row.operands.to_owned()]);
    OPCODES
        .iter()
        .map(entry)
        .map(|(head, lines)| (head, lines.into_iter().filter(|line| !line.is_empty()).collect()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_holds_every_row_of_every_table() {
        let page = page();
        for row in &COMMANDS {
            assert!(page.contains(row.syntax), "{}", row.name);
        }
        for row in &OPERATORS {
            assert!(page.contains(&format!("{}  {}", row.order(), row.syntax)), "{}", row.name);
        }
        for row in &REGISTERS {
            assert!(page.contains(row.meaning), "{}", row.name);
        }
        for (code, meaning) in codes::ALL {
            assert!(page.contains(code) && page.contains(meaning), "{code}");
        }
        for row in &CONTRADICTIONS {
            assert!(page.contains(row.here), "{}", row.about);
        }
    }
}
