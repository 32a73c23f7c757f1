//! The reference page of the serial line: what the command line takes, and the frames of the host library.

use serde::Serialize;
use std::fmt::Write as _;

/// Where a line is known from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// The manual shows it.
    Manual,
    /// The maker's other pages name it.
    Pages,
    /// The host library that comes with this program; no other program knows it.
    HostLibrary,
}

impl Source {
    fn text(self) -> &'static str {
        match self {
            Self::Manual => "MotorVator manual",
            Self::Pages => "maker's other pages",
            Self::HostLibrary => "host library (assets/mecc/host.mecc)",
        }
    }
}

/// A line of one of the two directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Row {
    /// What it is looked up by.
    pub name: &'static str,
    /// How it is written; `<CR>` is the carriage return.
    pub form: &'static str,
    /// What it does.
    pub help: &'static str,
    /// Where it is known from.
    pub source: Source,
}

macro_rules! rows {
    ($($source:ident $name:literal $form:literal $help:literal;)*) => {
        /// All of them.
        pub const ROWS: &[Row] =
            &[$(Row { name: $name, form: $form, help: $help, source: Source::$source }),*];
    };
}

rows! {
    Manual "G" "G<CR>" "Starts the program in the board's memory, from its beginning.";
    Pages "H" "H<CR>" "The version of the operating system, and help. In which words is not written down.";
    Manual "I" "I, 1 to 8 triplets, <CR>" "Data for the program, which raises ReceiveEvent; bytes that are missing are 0. I001002003 gives 1 2 3 0 0 0 0 0.";
    Manual "073" "073, 8 triplets, <CR>" "From the board: what Transmit sends. 073 is the letter I, so that another board's command line ignores it.";
    HostLibrary "P" "order 80 (P)" "Ping: answered with the version of the library.";
    HostLibrary "S" "order 83 (S)" "State: answered with the speed of motors A to D in percent, 128 more for backward.";
    HostLibrary "M" "order 77 (M), motor 1 to 4, direction, percent" "Turns a motor; the direction is 70 (F) or 66 (B). Answered as S.";
    HostLibrary "T" "order 84 (T), stepper, direction, steps (low byte, high byte)" "Moves a stepper. Answered as S; flag 1 or 2 is set while it moves.";
    HostLibrary "V" "order 86 (V), servo, direction, angle" "Turns a servo. Answered as S.";
    HostLibrary "C" "order 67 (C), stepper, MinWait, MaxWait, HoldCurrent" "Configures a stepper. Answered with the same values.";
    HostLibrary "Q" "order 81 (Q), stepper" "Tells how a stepper is configured. Answered as C.";
    HostLibrary "D" "order 68 (D), left, right" "Shows two characters; with 0 nothing new. Answered with both, and with the on/off inputs that have changed an odd number of times.";
    HostLibrary "A" "order 65 (A), input" "Tells that analog input and the three behind it.";
    HostLibrary "X" "order 88 (X)" "Stops all motors and steppers. Answered as S.";
    HostLibrary "R" "from the board: 82 (R), order, number, 4 values, flags" "The answer to the order of that number. Flags: 1 and 2 while stepper 1 or 2 moves, 64 for an order that is not known, 128 when the dead-man has stopped the motors.";
    HostLibrary "B" "from the board: 82 (R), 66 (B), 0, version" "Comes every half second while no order does: the library runs.";
}

/// The line of this name, whatever its case.
#[must_use]
pub fn row(name: &str) -> Option<&'static Row> {
    ROWS.iter().find(|row| row.name.eq_ignore_ascii_case(name))
}

/// Lines in full.
#[must_use]
pub fn text_of(rows: &[&Row]) -> String {
    let each = rows.iter().map(|row| {
        let Row { name, form, help, source } = row;
        format!("{name}\n  {form}\n  {help}\n  Source: {}.\n", source.text())
    });
    each.collect::<Vec<_>>().join("\n")
}

/// The whole page.
#[must_use]
pub fn page() -> String {
    let mut page = String::from(
        "The serial line of a MotorVator V3\n\n\
         Bytes travel as triplets, three decimal digits each: 048 is the digit 0. The rate of the line is not written down; 9600 baud is\n\
         assumed. The board answers nothing by itself but H. Orders are frames of the host library, a program that has to run on the board:\n\
         I, order, a number that comes back, up to six values. It stops the motors 250 ms after the last order.\n\n",
    );
    for (title, is_of_library) in [("Command line and programs", false), ("Host library", true)] {
        let rows: Vec<&Row> =
            ROWS.iter().filter(|row| (row.source == Source::HostLibrary) == is_of_library).collect();
        let _ = write!(page, "{title}\n\n{}\n", text_of(&rows));
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::host::HostOrder;

    #[test]
    fn every_order_of_the_library_has_its_line() {
        for letter in 0..=u8::MAX {
            let frame = [letter, 0, 1, b'F', 1, 0, 0, 0];
            if HostOrder::parse(&frame).is_some() {
                let name = char::from(letter).to_string();
                let row = row(&name).unwrap_or_else(|| panic!("{name}"));
                assert!(row.form.contains(&format!("order {letter} ({name})")), "{name}");
            }
        }
        let page = page();
        assert!(ROWS.iter().all(|row| page.contains(row.form) && page.contains(row.help)));
    }
}
