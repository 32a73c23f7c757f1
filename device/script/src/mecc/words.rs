//! The words of the language as tables: compiler, completion, hover help and the reference read them.

use crate::board::Board;
use serde::Serialize;

/// Where a form is known from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// The manual shows it.
    Manual,
    /// The maker's other pages show it.
    Pages,
    /// The maker's pages name it, or nothing else can be meant; how it is written is a guess.
    Assumed,
}

/// A statement, or a function of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Word {
    /// Its first word or words.
    pub name: &'static str,
    /// How it is written.
    pub syntax: &'static str,
    /// What it does.
    pub help: &'static str,
    /// Where that is known from.
    pub source: Source,
}

macro_rules! words {
    ($($source:ident $name:literal $syntax:literal $help:literal;)*) => {
        [$(Word { name: $name, syntax: $syntax, help: $help, source: Source::$source }),*]
    };
}

/// Statements, in the order of the alphabet.
pub const STATEMENTS: [Word; 34] = words! {
    Manual "Beep" "Beep pitch, length" "Sounds the beeper. Which units the two figures have, and which is which, is not said.";
    Manual "Begin Program" "Begin Program ... End Program" "What runs when the program is started.";
    Manual "Call" "Call function(value, ...)" "Calls a function.";
    Pages "Case" "Select value ... Case 1 ... Case Else ... End Select" "What to do when the value is this one, or one of these: Case 1, 2.";
    Manual "ConfigStepper" "ConfigStepper stepper, minwait, maxwait, holdcurrent"
        "Waits between steps at the highest and at the lowest speed, and the percentage of full power that holds a stepper at rest.";
    Manual "Debug" "Debug" "A debugger stops here; without one it does nothing.";
    Manual "Declare Byte" "Declare Byte name = value" "A variable from 0 to 255. Globals lie in memory one after another, as they are declared.";
    Manual "Declare DataPointer" "Declare DataPointer name" "A variable that points at a byte of memory.";
    Manual "Declare DataTable" "Declare DataTable name ... \"text\", 1, 2 or Reserve 8 ... End DataTable" "Bytes in memory.";
    Manual "Declare EventHandler" "Declare EventHandler name() ... End EventHandler" "What an event runs.";
    Manual "Declare Function" "Declare Function name(parameter as Word) Returns Word ... End Function"
        "A function; one that Returns gives what Return, or what its name was set to.";
    Manual "Declare Word" "Declare Word name = value" "A variable from 0 to 65535.";
    Manual "Disable Events" "Disable Events" "Events are kept until they are enabled again.";
    Manual "DisplayChars" "DisplayChars left, right" "Shows two characters.";
    Manual "DisplayHex" "DisplayHex value" "Shows a byte as two hexadecimal digits.";
    Manual "Do" "Do ... Until condition" "Repeats until the condition holds; runs at least once.";
    Manual "Enable Events" "Enable Events" "From now on an event runs its handler at once, but not during Wait.";
    Pages "If" "If condition Then ... Else ... End If" "Does something only when a condition holds.";
    Manual "Increment" "Increment variable" "Adds one.";
    Manual "Loop" "Loop ... End Loop" "Repeats for ever.";
    Manual "Receive" "Receive pointer" "Stores the 8 bytes that came last behind a pointer, and moves that on by 8.";
    Assumed "Return" "Return value" "Leaves a function, with its value.";
    Pages "Select" "Select value ... Case 1 ... End Select" "Does what stands behind the Case of the value.";
    Manual "SetEvent" "SetEvent event, handler" "Which handler an event runs.";
    Manual "SetMotor" "SetMotor motor, direction, speed" "Motor 1 to 4, \"F\" or \"B\", 0 to 100 %.";
    Pages "SetServo" "SetServo servo, direction, angle" "Servo 1 or 2, \"F\" or \"B\", angle from the middle in degrees.";
    Manual "SetStepper" "SetStepper stepper, direction, steps" "Stepper 1 or 2 makes so many steps and then raises its event; the program goes on.";
    Manual "SetTimer" "SetTimer timer, ticks" "Timer 1 to 8 raises its event once, after so many 128ths of a second.";
    Manual "StopMotor" "StopMotor motor" "Stops motor 1 to 4.";
    Manual "StopMotors" "StopMotors" "Stops all motors.";
    Manual "Transmit" "Transmit pointer" "Sends 8 bytes from a pointer on, and moves that on by 8; not while one is under way.";
    Manual "Until" "Do ... Until condition" "Ends a Do.";
    Manual "Wait" "Wait ticks" "Waits for so many 128ths of a second; nothing else runs, no handler either.";
    Assumed "While" "While condition ... End While" "Repeats as long as the condition holds.";
};

/// What gives a value.
pub const FUNCTIONS: [Word; 5] = words! {
    Manual "GetClock" "GetClock()" "The clock of 1024 Hz, a Word: it goes on from 65535 at 0, every 64 s.";
    Pages "GetProgramNumber" "GetProgramNumber" "The number by which the program was started, 90 to 99.";
    Pages "ReadAnalogue" "ReadAnalogue(input)" "Analog input 1 to 6, from 0 to 255.";
    Manual "ReadData" "ReadData(pointer)" "The byte at a pointer, which then moves on by 1.";
    Manual "SetPointer" "SetPointer(table)" "Where a table lies in memory.";
};

/// Operators, those that are worked out first at the head: what stands in one row has the same rank.
pub const OPERATORS: [(&str, &str, Source); 7] = [
    ("-", "a minus before a value", Source::Assumed),
    (
        "* / Mod",
        "multiply, divide, remainder; results are Words, and what goes beyond 65535 is lost",
        Source::Pages,
    ),
    ("+ -", "add, subtract; 3 - 5 is 65534, so that differences of clocks are right", Source::Manual),
    ("= <> < > <= >=", "compare: 1 where it holds, else 0", Source::Manual),
    ("Not", "1 for 0, else 0", Source::Assumed),
    ("And", "1 where both are not 0", Source::Assumed),
    ("Or", "1 where one is not 0", Source::Assumed),
];

/// Words that exist by the maker's pages, which do not show how they are used.
pub const FORM_UNKNOWN: [(&str, &str); 2] = [
    ("include", "Put the text of the other file here."),
    ("randomise", "Take GetClock() Mod a number for one that cannot be foreseen."),
];

/// Words of other languages, in small letters, and what stands for them here.
const FOREIGN: [(&str, &str); 17] = [
    ("break", "There is none: a Do ends where its Until holds, a function with Return."),
    ("const", "Declare a variable with its value: Declare Byte name = 5"),
    ("dim", "Variables are declared: Declare Byte name"),
    ("elseif", "Write Else, and the next If with its own End If in the lines below."),
    ("elsif", "Write Else, and the next If with its own End If in the lines below."),
    ("exit", "There is none: a Do ends where its Until holds, a function with Return."),
    ("for", "Count in a loop: Do, Increment variable, Until variable > 5"),
    ("gosub", "A function is called: Call function()"),
    ("goto", "There is none: use Loop, Do, While or a function."),
    ("int", "Variables are declared: Declare Word name"),
    ("let", "Leave it out: variable = value"),
    ("next", "Loops end with their own words: End Loop, Until, End While."),
    ("print", "DisplayChars shows two characters, Transmit sends eight bytes."),
    ("sleep", "It is Wait, in 128ths of a second."),
    ("sub", "Functions are declared: Declare Function name()"),
    ("var", "Variables are declared: Declare Byte name"),
    ("wend", "A While ends with End While."),
];

/// Two words of this language that people write as one.
const JOINED: [&str; 11] = [
    "Begin Program",
    "Disable Events",
    "Enable Events",
    "End DataTable",
    "End EventHandler",
    "End Function",
    "End If",
    "End Loop",
    "End Program",
    "End Select",
    "End While",
];

/// The two words that one stands for, and its byte at which the second begins.
#[must_use]
pub fn joined(word: &str) -> Option<(&'static str, usize)> {
    let is_it =
        |both: &&str| both.len() == word.len() + 1 && both.replace(' ', "").eq_ignore_ascii_case(word);
    let both = JOINED.into_iter().find(|both| is_it(both))?;
    Some((both, both.find(' ')?))
}

/// What stands for a word, in small letters, of another language.
#[must_use]
pub fn instead_of(word: &str) -> Option<&'static str> {
    FOREIGN.iter().find(|(foreign, _)| *foreign == word).map(|(_, hint)| *hint)
}

/// Words that cannot be names.
const RESERVED: [&str; 54] = [
    "and",
    "as",
    "beep",
    "begin",
    "byte",
    "call",
    "case",
    "configstepper",
    "datapointer",
    "datatable",
    "debug",
    "declare",
    "disable",
    "displaychars",
    "displayhex",
    "do",
    "else",
    "enable",
    "end",
    "eventhandler",
    "events",
    "function",
    "getclock",
    "getprogramnumber",
    "if",
    "include",
    "increment",
    "loop",
    "mod",
    "not",
    "or",
    "program",
    "randomise",
    "readanalogue",
    "readdata",
    "receive",
    "reserve",
    "return",
    "returns",
    "select",
    "setevent",
    "setmotor",
    "setpointer",
    "setservo",
    "setstepper",
    "settimer",
    "stopmotor",
    "stopmotors",
    "then",
    "transmit",
    "until",
    "wait",
    "while",
    "word",
];

/// Whether a word, in small letters, belongs to the language.
#[must_use]
pub fn is_reserved(word: &str) -> bool {
    RESERVED.binary_search(&word).is_ok()
}

/// The words of statements and functions as they are written, for guesses at what was meant.
pub fn all() -> impl Iterator<Item = &'static str> {
    STATEMENTS.iter().chain(&FUNCTIONS).flat_map(|row| row.name.split(' '))
}

/// The command of the board that a word, in small letters, names.
#[must_use]
pub fn command(word: &str) -> Option<Board> {
    Board::ALL.into_iter().find(|command| command.word().eq_ignore_ascii_case(word))
}

/// How a statement or a function is written.
#[must_use]
pub fn syntax(name: &str) -> &'static str {
    let mut rows = STATEMENTS.iter().chain(&FUNCTIONS);
    rows.find(|row| row.name.eq_ignore_ascii_case(name)).map_or("", |row| row.syntax)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_are_in_order_and_every_command_has_its_row() {
        assert!(RESERVED.is_sorted());
        assert!(FOREIGN.is_sorted() && FOREIGN.iter().all(|(word, _)| !is_reserved(word)));
        assert!(STATEMENTS.is_sorted_by_key(|row| row.name) && FUNCTIONS.is_sorted_by_key(|row| row.name));
        for command in Board::ALL {
            assert!(!syntax(command.word()).is_empty(), "{command:?}");
            let commas = syntax(command.word()).matches(',').count();
            assert_eq!(commas, command.arguments().saturating_sub(1), "{command:?}");
        }
        for row in STATEMENTS.iter().chain(&FUNCTIONS) {
            for word in row.name.split(' ') {
                assert!(is_reserved(&word.to_lowercase()), "{word}");
            }
        }
    }
}
