//! Where the MCP manual contradicts itself about MCL, and what counts here: one table for the reference; where a program depends on a
//! row, its warning says so.

use super::codes;
use serde::Serialize;

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Contradiction {
    /// What it is about.
    pub about: &'static str,
    /// What one place of the manual says.
    pub one: &'static str,
    /// What another says.
    pub other: &'static str,
    /// What counts here, and why.
    pub here: &'static str,
    /// The code of the warning where a program depends on it; `None` where nothing could be told apart, with the reason in `here`.
    pub warning: Option<&'static str>,
}

/// The contradictions: the warning if there is one, what it is about, what one place says, what another, and what is done
/// here.
macro_rules! contradictions {
    ($([$($warning:ident)?] $about:literal $one:literal $other:literal $here:literal;)*) => {
        [$(Contradiction {
            about: $about,
            one: $one,
            other: $other,
            here: $here,
            warning: [$(Some(codes::$warning),)? None][0],
        }),*]
    };
}

/// Every contradiction that is known.
pub const CONTRADICTIONS: [Contradiction; 24] = contradictions! {
    [AMBIGUOUS_STREAM] "numbers of streams"
        "GETS, PUTS and the STREAM registers: 0 USB, 1 CAN, 2 TTL, 3 RS-232"
        "command 145: 0 USB, 1 RS-232 UART0, 2 TTL UART1"
        "GETS, PUTS and the STREAM registers count as their own pages do";
    [DISPUTED_VALUE] "signal modes 2 and 3"
        "SIGNALMODE: 2 mean speed, 3 speed"
        "SIGNALCOMMAND and command 143: 2 speed, 3 mean speed"
        "SIGNALMODE's page";
    [DISPUTED_VALUE] "targets of signals"
        "SIGNALTARGET: motor 1 is 0, motor 2 is 1"
        "command 143: 0 to 3"
        "SIGNALTARGET's page; a program that sets 2 or 3 is warned";
    [DISPUTED_VALUE] "SIGNALPERCENT"
        "3.1.15: a WORD"
        "its use: a signal goes both ways"
        "a signed word from -32767 to 32767";
    [DISPUTED_VALUE] "SIGNALMINACTION and SIGNALMAXACTION"
        "3.1.15: a BYTE"
        "their page: values up to 0x8000"
        "a word";
    [NOT_FIRST] "NOT"
        "3.2.5: worked out first"
        "its page: NOT hour < 5 is meant as NOT (hour < 5)"
        "3.2.5: the table is the rule";
    [EXTRA_BUFFER] "buffer of SPEED and SPEED2"
        "described among the arguments"
        "missing in the syntax line"
        "it may follow as one more argument";
    [NO_ACCELERATION] "acceleration 0 in MOVE and MOVE2"
        "the examples give 0 for both accelerations"
        "the description does not say what 0 does"
        "the motor's default acceleration";
    [] "HEX"
        "the text: the output would display 12ab"
        "the comment beside it: prints 0x12ab"
        "12ab: IHEX is the one with a mark. Every use of HEX would be warned of, so none is";
    [ADDRESS_UNIT] "addresses of the user EEPROM"
        "READ and WRITE: bytes at a byte-sized address"
        "commands 252 and 253: 16 bit words at an address"
        "READ and WRITE count bytes, 0 to 255";
    [DOES_NOT_FIT] "SWord"
        "3.1.1: 32 bits"
        "the same row: -32,768 to +32,767"
        "16 bits; a constant beyond them is warned of";
    [DISPUTED_VALUE] "bits of SYSSTATUS"
        "its page: temperature error 0x8000, temperature warning 0x4000, and so on"
        "command 90: other bits for the same conditions"
        "the page of SYSSTATUS";
    [NESTED_WHILE] "DO-WHILE with WHILE-WEND inside"
        "DO-WHILE: the two cannot be nested, the WHILEs are confused"
        "REPEAT-UNTIL: both can stand inside it"
        "a WHILE with its own WEND is a loop, also inside DO";
    [COUNTS_DOWN] "FOR without STEP from a larger to a smaller number"
        "when no step is defined the increment is 1"
        "the example for value = 9 to 0 counts down"
        "it counts towards the last value, one at a time";
    [MIXED] "whole and floating point numbers in one operation"
        "3.2: TOINT and TOFLOAT convert explicitly"
        "examples mix them: MOTORCURRENT(0)/100.0"
        "the whole number is converted";
    [REGISTER_PART] "modifiers on system registers"
        "3.1.14: they cannot be used"
        "VERSION's page: VERSION.byte1"
        "they can be read, not set";
    [MISSPELT] "names of registers"
        "3.1.15: SYSMINMBAY, SINGALTIMEOUT, SIGNALLOWPAS"
        "their pages: SYSMINMBAT, SIGNALTIMEOUT, SIGNALLOWPASS"
        "the pages' spelling; the table's is taken too";
    [MISSPELT] "#ELSEIF"
        "its heading: #ELSIF"
        "its text and example: #ELSEIF"
        "#ELSEIF; the heading's spelling is taken too";
    [COMPARISON_FIRST] "& and the comparison beside it"
        "3.2.5: the comparison is worked out first"
        "DIST's example: MOTORBUFFER(0) & 0x7F<>0 is meant the other way"
        "3.2.5: the table is the rule";
    [WHOLE_ARRAY] "arrays of registers without an index"
        "3.1.9: an element is named by its index"
        "examples: sdec MOTORENCPOS"
        "the first element is taken";
    [] "range of SIN and COS"
        "-127 to +128"
        "the value divided by 128 is the sine, which reaches -1"
        "-128 is kept to -127. It is a value like any other, so no program is warned";
    [DOES_NOT_FIT] "SLong"
        "3.1.1: -2,147,483,647 to +2,147,483,648"
        "32 bits in two's complement: -2147483648 to 2147483647"
        "two's complement; a constant beyond it is warned of";
    [] "NAND"
        "its sentence: 1 if neither bit is set or to a 1 for all other cases"
        "its table: 0 where both bits are 1"
        "the table: 0 where both bits are 1, else 1. The sentence gives no other meaning, so no program is warned";
    [] "scale of MOTORPOSKP"
        "its example: 4000.0*2048.0"
        "what position gains on the wire are scaled by in the makers' libraries: 1024"
        "the register holds what the wire holds; a program writes plain numbers, so none is warned";
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_warning_of_the_table_exists() {
        let known = |code: &str| codes::ALL.iter().any(|(known, _)| *known == code);
        assert!(CONTRADICTIONS.iter().filter_map(|row| row.warning).all(known));
    }
}
