//! The command table, put together from one file per theme.

mod autotune;
mod can;
mod config;
mod encoders;
mod io;
mod legacy;
mod limits;
mod motion;
mod pid;
mod script;
mod status;

use super::command::{Command, Direction, Effect, Form, Reply};
use super::identity::Generation;
use brushwork_values::Field;

/// Every command of the manual and every further one that public clients use, in number order.
pub static COMMANDS: &[Command] = &SORTED;

/// The row of a command byte; `None` if no source knows the number.
pub const fn lookup(number: u8) -> Option<&'static Command> {
    match INDEX[number as usize] {
        Some(index) => Some(&SORTED[index as usize]),
        None => None,
    }
}

/// The row with this key.
pub fn lookup_key(key: &str) -> Option<&'static Command> {
    COMMANDS.iter().find(|command| command.key == key)
}

const THEMES: [&[Command]; 11] = [
    legacy::ROWS,
    status::ROWS,
    encoders::ROWS,
    motion::ROWS,
    pid::ROWS,
    limits::ROWS,
    io::ROWS,
    config::ROWS,
    autotune::ROWS,
    can::ROWS,
    script::ROWS,
];

const COUNT: usize = {
    let mut count = 0;
    let mut theme = 0;
    while theme < THEMES.len() {
        count += THEMES[theme].len();
        theme += 1;
    }
    count
};

static SORTED: [Command; COUNT] = {
    let mut rows = [THEMES[0][0]; COUNT];
    let mut filled = 0;
    let mut number = 0;
    while number < 256 {
        let mut theme = 0;
        while theme < THEMES.len() {
            let mut row = 0;
            while row < THEMES[theme].len() {
                if THEMES[theme][row].number as usize == number {
                    rows[filled] = THEMES[theme][row];
                    filled += 1;
                }
                row += 1;
            }
            theme += 1;
        }
        number += 1;
    }
    rows
};

static INDEX: [Option<u8>; 256] = {
    let mut index = [None; 256];
    let mut row = 0;
    while row < COUNT {
        index[SORTED[row].number as usize] = Some(row as u8);
        row += 1;
    }
    index
};

// The words that rows are written with.

const G1: Generation = Generation::Gen1;
const G2: Generation = Generation::Gen2;
const G3: Generation = Generation::Gen3;
const G4: Generation = Generation::Gen4;

const MANUAL_LEGACY: &str = "MCP manual 2.2.12, 2.2.13";
const MANUAL_ADVANCED: &str = "MCP manual 2.3.1";
const MANUAL_ENCODERS: &str = "MCP manual 2.4.8";
const MANUAL_MOTION: &str = "MCP manual 2.4.9";
const CLIENTS: &str = "public clients, 2015-2025";

/// A constant list of fields.
macro_rules! fields {
    ($($field:expr),* $(,)?) => {{
        const FIELDS: &[brushwork_values::Field] = &[$($field),*];
        FIELDS
    }};
}

/// A constant list of forms.
macro_rules! forms {
    ($($form:expr),* $(,)?) => {{
        const FORMS: &[$crate::packet_serial::command::Form] = &[$($form),*];
        FORMS
    }};
}

/// The one form of a read without arguments that every generation has.
macro_rules! reads {
    ($($field:expr),* $(,)?) => {
        forms![$crate::packet_serial::table::always_read(fields![$($field),*])]
    };
}

/// The one form of a setting that every generation has.
macro_rules! sets {
    ($($field:expr),* $(,)?) => {
        forms![$crate::packet_serial::table::always_set(fields![$($field),*])]
    };
}

/// The rows of a theme: where a command is described, its number, title and forms, and what else there is to say.
macro_rules! rows {
    ($($source:ident $number:ident $title:literal $forms:expr $(, $part:ident $value:expr)*;)*) => {
        &[$(
            Command::new($crate::packet_serial::number::$number, $title, $source, $forms)$(.$part($value))*
        ),*]
    };
}

use {fields, forms, reads, rows, sets};

/// A read without arguments that every generation has.
const fn always_read(reply: &'static [Field]) -> Form {
    read(G1, G4, reply)
}

/// A setting that every generation has.
const fn always_set(request: &'static [Field]) -> Form {
    write(G1, G4, Effect::Setting, request)
}

/// A read without arguments.
const fn read(first: Generation, last: Generation, reply: &'static [Field]) -> Form {
    read_at(first, last, &[], reply)
}

/// A read with arguments.
const fn read_at(
    first: Generation,
    last: Generation,
    request: &'static [Field],
    reply: &'static [Field],
) -> Form {
    let (direction, effect) = (Direction::Read, Effect::Query);
    Form { first, last, direction, effect, request, reply: Reply::Data(reply), title: None, assumed: None }
}

/// A write that is answered with 0xFF.
const fn write(first: Generation, last: Generation, effect: Effect, request: &'static [Field]) -> Form {
    write_for(first, last, effect, request, Reply::Ack)
}

/// A write that is answered with more than 0xFF.
const fn write_for(
    first: Generation,
    last: Generation,
    effect: Effect,
    request: &'static [Field],
    reply: Reply,
) -> Form {
    Form { first, last, direction: Direction::Write, effect, request, reply, title: None, assumed: None }
}

#[cfg(test)]
mod tests;
