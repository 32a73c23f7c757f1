//! The codes of errors and warnings of macro files, one line of meaning each.

macro_rules! codes {
    ($($name:ident = $code:literal, $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $name: &str = $code;)*
        /// Every code with its meaning, in order.
        pub const ALL: &[(&str, &str)] = &[$(($code, $meaning)),*];
    };
}

codes! {
    BAD_CHARACTER = "E101", "A character that means nothing in a macro file.";
    BAD_NUMBER = "E102", "A number that needs more than 32 bits.";
    UNEXPECTED = "E103", "Something else was expected here.";
    TEXT_TOO_LONG = "E104", "A file longer than any needs to be.";
    UNKNOWN_COMMAND = "E201", "A command that the controller does not have.";
    NO_NUMBER = "E202", "A command without the number that it needs.";
    NEEDLESS_NUMBER = "E203", "A number behind a command that takes none.";
    OUT_OF_RANGE = "E204", "A number that the command does not take.";
    UNKNOWN_NAME = "E205", "A name that is not defined.";
    OUTSIDE = "E206", "A command outside of a macro.";
    DEFINITION = "E207", "MD within a macro: the controller refuses it.";
    DEFINED_TWICE = "E301", "A name that is defined already.";
    NUMBER_TWICE = "E302", "A number that another macro has.";
    BAD_MACRO_NUMBER = "E303", "A number that no macro can have.";
    TOO_MANY_MACROS = "E304", "More macros than the controller has room for.";
    EMPTY = "E305", "A macro without commands.";
    TOO_MANY_COMMANDS = "E306", "More than 15 commands in a macro.";
    LINE_TOO_LONG = "E307", "A macro whose line the controller has no room for.";
    MORE_ERRORS = "E308", "More errors than are listed.";
    RUNS_AT_POWER_UP = "W401", "Macro 0 may move the motor as soon as the controller has power.";
    NOT_HERE = "W402", "A call of a macro that the file does not have: the controller does nothing if it has none either.";
    CALLS_ITSELF = "W403", "A macro that comes back to itself in its midst: the calls nest until the controller refuses.";
    WEARS_OUT = "W404", "A command in a loop that writes to EEPROM each time.";
    NO_WAIT = "W405", "A loop that moves and never waits: each move takes the place of the last before it ends.";
    UNUSED = "W406", "A named number that nothing uses.";
    UNREACHABLE = "W407", "Commands that nothing leads to.";
}
