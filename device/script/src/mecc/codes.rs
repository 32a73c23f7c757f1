//! The codes of errors and warnings, one line of meaning each; the reference prints this table. What they have in common with MCL has the
//! same code.

use crate::listed::coded;

coded! {
    BAD_CHARACTER = "E101", "A character that means nothing in a program.";
    BAD_NUMBER = "E102", "Something that begins like a number and is none.";
    NUMBER_TOO_LARGE = "E103", "A number that needs more than 16 bits.";
    OPEN_TEXT = "E104", "A text without its closing quote.";
    WIDE_CHARACTER = "E105", "A character in a text that is more than one byte.";
    NAME_TOO_LONG = "E106", "A name of more than 1024 characters.";
    UNEXPECTED = "E201", "Something else was expected here.";
    NO_BLOCK_END = "E202", "A block without its end, such as Loop without End Loop.";
    NO_BLOCK_START = "E203", "The end of a block that was not begun.";
    ARGUMENT_COUNT = "E205", "A command or a function with too few or too many arguments.";
    FORM_UNKNOWN = "E206", "A word that exists, but whose form the maker's pages do not give.";
    RESERVED_WORD = "E208", "A word of the language used as a name.";
    TOO_DEEP = "E209", "Blocks or parentheses nested deeper than the compiler goes.";
    UNKNOWN_COMMAND = "E210", "A statement that begins with no command or variable.";
    MISPLACED = "E211", "Something that cannot stand where it stands.";
    NO_PROGRAM = "E212", "No Begin Program, or more than one.";
    UNKNOWN_EVENT = "E301", "An event that the board does not have.";
    UNKNOWN_NAME = "E302", "A name that is not declared.";
    DECLARED_TWICE = "E303", "A name that is declared already.";
    USED_BEFORE = "E304", "A variable of a function that is declared only further down.";
    NOT_A_VARIABLE = "E305", "Something that cannot be set.";
    NOT_A_POINTER = "E306", "A DataPointer is wanted here.";
    NOT_A_TABLE = "E307", "A DataTable is wanted here.";
    NOT_A_FUNCTION = "E308", "A function is wanted here.";
    NOT_A_HANDLER = "E309", "An event handler is wanted here.";
    NO_VALUE = "E310", "A function that returns no value, where one is wanted.";
    NOT_CONSTANT = "E311", "A value that has to be known when the program is compiled.";
    OUT_OF_RANGE = "E312", "A constant outside the range of what it is given to.";
    EMPTY_TABLE = "E313", "A table without a byte.";
    LONG_TEXT = "E315", "A text where one character or a number is wanted.";
    TOO_LARGE = "E317", "A program that does not fit: too long, or too much memory or code.";
    DIVISION_BY_ZERO = "E318", "A division by a constant zero.";
    MORE_ERRORS = "E319", "More errors than are listed.";
    UNUSED_VARIABLE = "W401", "A variable that is never read.";
    UNUSED_ROUTINE = "W402", "A function that nothing calls, or a handler that no event has.";
    DOES_NOT_FIT = "W403", "A constant that loses bits where it is stored.";
    LONG_WAIT = "W404", "A wait of a second or more in a program with events: none is served in it.";
    TRANSMIT_PENDING = "W405", "A Transmit while the one before it may still be under way.";
    SHORT_BUFFER = "W406", "A table of less than 8 bytes that is sent or received into: what follows it is too.";
    OLD_CLOCK = "W407", "A constant made for the older clock of 111 Hz.";
    EVENTS_OFF = "W408", "Handlers are set, but no Enable Events lets events in.";
    NO_HANDLER = "W409", "A timer is set whose event has no handler.";
    ASSUMED_FORM = "W410", "A form that the maker's pages name without showing it.";
    SAME_CASE = "W411", "A Case that an earlier one has already.";
    UNREACHABLE = "W412", "Statements that nothing leads to.";
    NO_RETURN = "W413", "A function with a value that never sets one: it gives 0.";
    MOTOR_OF_STEPPER = "W414", "A motor that is a coil of a stepper which the program moves.";
    MORE_WARNINGS = "W423", "More warnings than are listed.";
}

#[cfg(test)]
mod tests {
    #[test]
    fn codes_are_in_order_and_each_is_used_once() {
        assert!(super::ALL.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn the_codes_that_count_are_those_of_every_language() {
        use crate::mcl::codes;
        assert_eq!(super::MORE_ERRORS, codes::MORE_ERRORS);
        assert_eq!(super::MORE_WARNINGS, codes::MORE_WARNINGS);
    }
}
