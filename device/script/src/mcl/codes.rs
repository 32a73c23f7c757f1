//! The codes of errors and warnings, one line of meaning each; the reference prints this table.

use crate::listed::coded;

coded! {
    BAD_CHARACTER = "E101", "A character that means nothing in a program.";
    BAD_NUMBER = "E102", "Something that begins like a number and is none.";
    NUMBER_TOO_LARGE = "E103", "A number that needs more than 32 bits.";
    OPEN_TEXT = "E104", "A text without its closing quote.";
    WIDE_CHARACTER = "E105", "A character in a text that is more than one byte.";
    NAME_TOO_LONG = "E106", "A name of more than 1024 characters.";
    UNEXPECTED = "E201", "Something else was expected here.";
    NO_BLOCK_END = "E202", "A block without its end, such as IF without ENDIF.";
    NO_BLOCK_START = "E203", "The end of a block that was not begun.";
    BAD_DIRECTIVE = "E204", "A compile-time directive that is unknown or out of place.";
    ARGUMENT_COUNT = "E205", "A command with too few or too many arguments.";
    NO_PUBLIC_SYNTAX = "E206", "A CAN word: it exists, but no syntax for it is public.";
    OTHER_PRODUCT = "E207", "A word of another product of the maker, which controllers of this family do not have.";
    RESERVED_WORD = "E208", "A word of the language used as a name.";
    TOO_DEEP = "E209", "Blocks or parentheses nested deeper than the compiler goes.";
    UNKNOWN_COMMAND = "E210", "A statement that begins with no command, name or label.";
    UNKNOWN_LABEL = "E301", "A jump to a label that is nowhere.";
    UNKNOWN_NAME = "E302", "A name that is not defined.";
    DEFINED_TWICE = "E303", "A name that is defined already.";
    USED_BEFORE = "E304", "A variable, constant or table that is defined only further down.";
    NOT_A_VARIABLE = "E305", "Something that cannot be set.";
    UNKNOWN_MODIFIER = "E307", "A modifier that does not exist.";
    NO_SUCH_PART = "E308", "A modifier for a part that the variable does not have.";
    NOT_AN_ARRAY = "E309", "An index on something that has none.";
    INDEX_OUTSIDE = "E310", "An index past the end of an array or table.";
    NOT_CONSTANT = "E311", "A value that has to be known when the program is compiled.";
    BAD_ARRAY_SIZE = "E313", "An array without elements or larger than memory.";
    NO_FLOATS = "E314", "A floating point number where only whole numbers work.";
    LONG_TEXT = "E315", "A text where one character or a number is wanted.";
    BAD_OUTPUT = "E316", "A modifier that does not fit here, or with the wrong arguments.";
    TOO_LARGE = "E317", "A program that does not fit the format: too long, or too much memory, code or tables.";
    DIVISION_BY_ZERO = "E318", "A division by a constant zero.";
    MORE_ERRORS = "E319", "More errors than are listed.";
    UNUSED_VARIABLE = "W401", "A variable that is never read.";
    UNUSED_LABEL = "W402", "A label that nothing jumps to.";
    DOES_NOT_FIT = "W403", "A constant that loses bits where it is stored.";
    COMPARISON_FIRST = "W404", "A comparison beside & | ^: the comparison is worked out first (MCP manual 3.2.5).";
    FLOAT_INTO_INTEGER = "W405", "A floating point number stored in an integer without TOINT.";
    UNREACHABLE = "W406", "Statements that nothing leads to.";
    MISSING_END = "W407", "The program runs out of its last line, or into a subroutine.";
    MISSPELT = "W408", "A register or directive in a spelling that only one place of the manual has.";
    REGISTER_PART = "W409", "A modifier on a system register: the manual forbids it and does it.";
    MIXED = "W410", "Whole and floating point numbers in one operation: the whole one is converted.";
    NOT_FIRST = "W411", "NOT before a comparison: NOT is worked out first (MCP manual 3.2.5), the manual's example means it last.";
    COUNTS_DOWN = "W412", "FOR from a larger to a smaller number without STEP: it counts down (MCP manual 3.4.1, second example of FOR).";
    EXTRA_BUFFER = "W413", "The buffer argument of SPEED and SPEED2: described, but not in their syntax.";
    NESTED_WHILE = "W414", "WHILE inside DO: the manual warns that it may be taken for the end of the DO.";
    NO_ACCELERATION = "W415", "Acceleration 0 in a motion command: the manual's example uses it without saying what it does; the default acceleration is taken.";
    STACK_GROWTH = "W416", "A subroutine that calls itself or leaves by GOTO: the stack grows.";
    WHOLE_ARRAY = "W417", "An array without an index: its first element is meant.";
    AMBIGUOUS_STREAM = "W418", "Stream 2 or 3: the manual's tables disagree; here 2 is TTL and 3 RS-232, as GETS and PUTS have it.";
    ADDRESS_UNIT = "W419", "READ or WRITE beyond address 255: commands 252 and 253 count other units.";
    READ_ONLY = "W420", "A system register that can only be read is set: nothing is stored.";
    GOSUB_ARGUMENTS = "W421", "GOSUB with another number of arguments than its subroutine takes: the stack overflows or underflows.";
    DISPUTED_VALUE = "W422", "A value of a system register about which pages of the manual disagree.";
    MORE_WARNINGS = "W423", "More warnings than are listed.";
}

/// Whether a code only counts further errors or warnings, so that what has it is none of them.
#[must_use]
pub fn is_count(code: &str) -> bool {
    [MORE_ERRORS, MORE_WARNINGS].contains(&code)
}

#[cfg(test)]
mod tests {
    #[test]
    fn codes_are_in_order_and_each_is_used_once() {
        assert!(super::ALL.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
