//! Which lines of a text have code, and where each begins.

use crate::program::Program;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A number that is the same for two programs with the same code, line table and data, whatever their names are: an image without
/// names is known by it.
#[must_use]
pub fn code_id(program: &Program) -> u64 {
    let mut hasher = DefaultHasher::new();
    (&program.ops, &program.lines, &program.data, program.ram_bytes, program.loops).hash(&mut hasher);
    hasher.finish()
}

/// Where the lines of a program begin. A line begins at each instruction whose predecessor came from another line; what jumps back to a
/// line jumps there.
#[derive(Clone, Debug, Default)]
pub struct LineTable {
    /// Per instruction: the line that begins there, 0 for none.
    begins: Vec<u32>,
    /// Lines that have code, with their first instruction.
    first: BTreeMap<u32, u32>,
}

impl LineTable {
    /// The lines of a program.
    #[must_use]
    pub fn of(program: &Program) -> Self {
        let mut table = Self { begins: vec![0; program.ops.len()], first: BTreeMap::new() };
        let mut before = 0;
        for (at, line) in program.lines.iter().copied().enumerate().take(program.ops.len()) {
            if line != before {
                table.begins[at] = line;
                table.first.entry(line).or_insert(u32::try_from(at).unwrap_or(u32::MAX));
            }
            before = line;
        }
        table
    }

    /// The line that begins at an instruction.
    #[must_use]
    pub fn begins(&self, at: u32) -> Option<u32> {
        self.begins.get(at as usize).copied().filter(|line| *line > 0)
    }

    /// The first line with code from `line` on.
    #[must_use]
    pub fn next_with_code(&self, line: u32) -> Option<u32> {
        self.first.range(line..).next().map(|(line, _)| *line)
    }

    /// The last line with code; 0 for an empty program.
    #[must_use]
    pub fn last(&self) -> u32 {
        self.first.last_key_value().map_or(0, |(line, _)| *line)
    }
}
