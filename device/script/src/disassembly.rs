//! A program as a person can read it: instructions under their labels and lines.

use crate::image;
use crate::mcl::types::VarType;
use crate::op::{Array, Cell, Op, TableRef};
use crate::program::Program;
use crate::text::Lines;
use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;

/// The listing of a program; with its text, each line of that stands above its instructions.
#[must_use]
pub fn disassemble(program: &Program, text: Option<&str>) -> String {
    let mut labels: HashMap<u32, Vec<&str>> = HashMap::new();
    for (label, at) in &program.labels {
        labels.entry(*at).or_default().push(label);
    }
    let source = text.map(|text| (text, Lines::of(text)));
    let listing = Listing { program, source, labels, owners: owners(program) };
    let mut page = listing.head();
    let mut line = 0;
    for (at, op) in program.ops.iter().enumerate() {
        for label in listing.labels_at(at as u32) {
            let _ = writeln!(page, "{label}:");
        }
        let here = program.lines.get(at).copied().unwrap_or(0);
        if here != line {
            line = here;
            page += &listing.line(line);
        }
        let operands = listing.operands(*op);
        let _ = writeln!(page, "{}", format!("  {at:>5}  {:<18} {operands}", image::name(*op)).trim_end());
    }
    page
}

struct Listing<'a> {
    program: &'a Program,
    source: Option<(&'a str, Lines)>,
    /// Labels by their instructions.
    labels: HashMap<u32, Vec<&'a str>>,
    /// For each bit of memory the first variable that lies there.
    owners: Vec<Option<u32>>,
}

/// For each bit of memory the first variable, in the order of the program, that lies there; aliases lie across others.
fn owners(program: &Program) -> Vec<Option<u32>> {
    let bits = program.ram_bytes as usize * 8;
    let mut begin: Vec<(u32, u32)> = Vec::with_capacity(program.variables.len());
    let mut end: Vec<(u32, u32)> = Vec::with_capacity(program.variables.len());
    for (index, variable) in (0u32..).zip(&program.variables) {
        let Array { first, stride, length } = variable.memory;
        let past = first.at + (length.max(1) - 1) * stride + first.kind.bits();
        begin.push((first.at, index));
        end.push((past, index));
    }
    begin.sort_unstable();
    end.sort_unstable();
    let (mut begin, mut end) = (begin.into_iter().peekable(), end.into_iter().peekable());
    let mut here = BTreeSet::new();
    let mut owner = |bit: u32| {
        while let Some((_, index)) = begin.next_if(|(at, _)| *at <= bit) {
            here.insert(index);
        }
        while let Some((_, index)) = end.next_if(|(at, _)| *at <= bit) {
            here.remove(&index);
        }
        here.first().copied()
    };
    (0..bits as u32).map(&mut owner).collect()
}

impl Listing<'_> {
    fn head(&self) -> String {
        let size = self.program.size();
        let mut page = format!(
            "; {} instructions in {} bytes, {} bytes of constants, {} bytes of variables, image of {} bytes\n",
            size.instructions, size.code_bytes, size.data_bytes, size.ram_bytes, size.image_bytes
        );
        for variable in &self.program.variables {
            let _ = writeln!(page, "; {} {}", variable.name, array(variable.memory));
        }
        page
    }

    fn line(&self, line: u32) -> String {
        match &self.source {
            Some((text, lines)) => format!("; {line}: {}\n", lines.text_of(text, line).trim()),
            None => format!("; line {line}\n"),
        }
    }

    /// A place with the variable that lies there.
    fn cell(&self, place: Cell) -> String {
        let owner = self.owners.get(place.at as usize).copied().flatten();
        let found = owner.and_then(|index| self.program.variables.get(index as usize));
        let name = found.map(|variable| format!(" ; {}", variable.name)).unwrap_or_default();
        format!("{}{name}", cell(place))
    }

    fn labels_at(&self, at: u32) -> &[&str] {
        self.labels.get(&at).map_or(&[], Vec::as_slice)
    }

    fn label(&self, to: u32) -> String {
        self.labels_at(to).first().map_or_else(|| to.to_string(), |name| format!("{to} ; {name}"))
    }

    fn text(&self, at: u32, count: u32) -> String {
        let range = at as usize..at as usize + count as usize;
        let bytes = self.program.data.get(range).unwrap_or_default();
        format!("{at}, {count} ; \"{}\"", bytes.escape_ascii())
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn operands(&self, op: Op) -> String {
        match op {
            Op::Push(value) if value > i32::MAX as u32 => format!("{value} ; {}", value as i32),
            Op::Push(value) => value.to_string(),
            Op::Load(place) | Op::Store(place) => self.cell(place),
            Op::LoadAt(list) | Op::StoreAt(list) | Op::OutArray(list) => array(list),
            Op::LoadRegister(id, element) | Op::StoreRegister(id, element) => {
                format!("{}({element})", id.row().name)
            }
            Op::LoadRegisterAt(id) | Op::StoreRegisterAt(id) => id.row().name.to_owned(),
            Op::LoadTable(constants) => table(constants),
            Op::Part(part) => format!("{} at bit {}", part.kind.name(), part.first_bit),
            Op::Unary(operator, kind) => format!("{operator:?} {kind:?}").to_lowercase(),
            Op::Binary(operator, kind) => format!("{operator:?} {kind:?}").to_lowercase(),
            Op::Convert(from, to) => format!("{from:?} to {to:?}").to_lowercase(),
            Op::Jump(to) | Op::JumpIfZero(to) | Op::JumpIfNotZero(to) => self.label(to),
            Op::Branch(count) => count.to_string(),
            Op::Gosub(to, count) => format!("{count}, {}", self.label(to)),
            Op::Return(Some(kind)) | Op::Result(kind) => format!("{kind:?}").to_lowercase(),
            Op::ForStart(place, number, has_step) => {
                let step = if has_step { " with step" } else { "" };
                format!("loop {number}{step}, {}", self.cell(place))
            }
            Op::ForNext(place, number, top) => format!("loop {number}, back to {top}, {}", self.cell(place)),
            other => self.operands_of_commands(other),
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn operands_of_commands(&self, op: Op) -> String {
        let end = |has_end: bool| if has_end { ", with end" } else { "" };
        match op {
            Op::OutText(at, count) => self.text(at, count),
            Op::OutNumber(format, digits) | Op::InNumber(format, digits) => {
                format!("{} {digits}", format.word())
            }
            Op::OutReal(digits) => digits.to_string(),
            Op::Handle(event, to) => format!("event {event}, {}", self.label(to)),
            Op::Events(on) => if on { "on" } else { "off" }.to_owned(),
            Op::Wait(parts) => format!("1/{parts} s"),
            Op::Board(command) => command.word().to_owned(),
            Op::Send(count) | Op::Receive(count) => count.to_string(),
            Op::Fill(to, from, count) => format!("{count} bytes to {to} from {from}"),
            Op::Keep(first, count) => format!("{count} bytes from {first}"),
            Op::OutString(list, has_end) | Op::InString(list, has_end) => {
                format!("{}{}", array(list), end(has_end))
            }
            Op::OutTable(constants, has_end) => format!("{}{}", table(constants), end(has_end)),
            Op::Motion(command, extra) => {
                format!("{}{}", command.word(), if extra { " with buffer" } else { "" })
            }
            Op::I2cOut(count, stop, otherwise) => {
                let stop = if stop { "stop" } else { "no stop" };
                let otherwise = otherwise.map(|to| format!(", else {}", self.label(to))).unwrap_or_default();
                format!("{count}, {stop}{otherwise}")
            }
            Op::I2cIn(count, otherwise) => {
                let otherwise = otherwise.map(|to| format!(", else {}", self.label(to))).unwrap_or_default();
                format!("{count}{otherwise}")
            }
            _ => String::new(),
        }
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn cell(place: Cell) -> String {
    match place.kind {
        VarType::Bit | VarType::Nib => format!("{} {}.{}", place.kind.name(), place.at / 8, place.at % 8),
        kind => format!("{} {}", kind.name(), place.at / 8),
    }
}

fn array(array: Array) -> String {
    match array.length {
        1 => cell(array.first),
        length => format!("{} x {length} every {} bits", cell(array.first), array.stride),
    }
}

fn table(table: TableRef) -> String {
    format!("{} x {} at {}", table.kind.name(), table.length, table.at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_listing_shows_labels_lines_names_and_texts() {
        let text = "v var word\nmain\nv = v + 300\nputs 0,[\"v=\",dec v]\ngoto main\n";
        let program = crate::mcl::compile(text).program.unwrap();
        let page = disassemble(&program, Some(text));
        let expected = "\
main:
; 3: v = v + 300
      0  load               Word 0 ; v
      1  push               300
      2  binary             add unsigned
      3  store              Word 0 ; v
; 4: puts 0,[\"v=\",dec v]
      4  push               0
      5  out-stream
      6  out-text           0, 2 ; \"v=\"
";
        assert!(page.contains(expected), "{page}");
        assert!(
            page.starts_with("; 13 instructions in 30 bytes, 2 bytes of constants, 2 bytes of variables"),
            "{page}"
        );
        assert!(disassemble(&program, None).contains("; line 3\n"));
    }
}
