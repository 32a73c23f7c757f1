//! The words of the language (MCP manual chapter 3): commands with their syntax line, operators, output modifiers, and words that
//! are kept from being names. Compiler, completion, hover help and the reference read these tables.

use super::operators::{OPERATORS, Operator};
use super::registers::{MISSPELT, REGISTERS, RegisterId};
use super::types::{TABLES, VarType};
use serde::Serialize;
use std::collections::HashMap;
use std::sync::LazyLock;

/// A command or a word of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    /// How the statement is written; braces stand round what may be left out.
    pub syntax: &'static str,
    /// What it does.
    pub help: &'static str,
}

/// Rows of words: the word, how the statement is written and what it does.
macro_rules! words {
    ($($name:literal $syntax:literal $help:literal;)*) => {
        [$(Word { name: $name, syntax: $syntax, help: $help }),*]
    };
}

/// Statements (MCP manual 3.4.1).
pub const COMMANDS: [Word; 44] = words! {
    "BRANCH" "branch index, [label0, label1, ...]"
        "Jumps to the label that index names, counted from 0; goes on with the next line if there is none.";
    "CLEAR" "clear" "Sets all variables to zero.";
    "DIST" "dist motor, speed, accel, distance, buffer"
        "Moves a motor a distance at a speed (counts/s). Buffer 0 waits for its turn, 1 begins at once.";
    "DIST2" "dist2 speed1, accel1, distance1, speed2, accel2, distance2, buffer"
        "Moves both motors a distance each.";
    "DO" "do ... while condition" "Repeats as long as the condition holds; runs at least once.";
    "ELSE" "if condition then ... else ... endif" "What to do when no condition of the IF held.";
    "ELSEIF" "if condition then ... elseif condition ... endif"
        "Another condition, tried when those before did not hold.";
    "END" "end" "Ends the program until the next start.";
    "ENDIF" "if condition then ... endif" "Closes an IF.";
    "FOR" "for variable = start to finish {step increment} ... next"
        "Counts a variable from start to finish.";
    "GETS" "gets stream, [variable, ...]" "Waits for bytes of a stream and stores them.";
    "GOSUB" "gosub label{[argument, ...]}{, result}" "Calls a subroutine, which ends with RETURN.";
    "GOTO" "goto label" "Goes on at a label.";
    "I2CIN" "i2cin {label, timeout}, [variable, ...]"
        "Reads bytes of an I2C device; jumps to the label if one takes longer than timeout (ms).";
    "I2COUT" "i2cout {label, timeout}, [byte, ...]" "Sends bytes to an I2C device, then a stop.";
    "I2COUTNS" "i2coutns {label, timeout}, [byte, ...]"
        "Sends bytes to an I2C device without a stop, so that a repeated start can follow.";
    "IF" "if condition then label   or   if condition then ... endif"
        "Does something only when a condition holds.";
    "LET" "{let} variable = expression" "Stores a value; arrays take several, and texts.";
    "MOVE" "move motor, speed, accel, deccel, position, buffer" "Moves a motor to a position (counts).";
    "MOVE2" "move2 speed1, accel1, deccel1, position1, speed2, accel2, deccel2, position2, buffer"
        "Moves both motors to a position each.";
    "NEXT" "for ... next" "Closes a FOR.";
    "PAUSE" "pause time" "Waits for time in milliseconds.";
    "POWER" "power motor, duty, accel" "Runs a motor at a duty (full is 32767) without a loop.";
    "POWER2" "power2 duty1, accel1, duty2, accel2" "Runs both motors at a duty each.";
    "PUTS" "puts stream, [data, ...]" "Sends data to a stream: 0 USB, 1 CAN, 2 TTL, 3 RS-232.";
    "READ" "read address, variable" "Reads a byte of the user EEPROM.";
    "REPEAT" "repeat ... until condition" "Repeats until the condition holds; runs at least once.";
    "RETURN" "return {expression}" "Ends a subroutine, with a value if one is given.";
    "SPEED" "speed motor, speed, accel" "Runs a motor at a speed (counts/s).";
    "SPEED2" "speed2 speed1, accel1, speed2, accel2" "Runs both motors at a speed each.";
    "STEP" "for variable = start to finish step increment" "By how much FOR counts.";
    "STOP" "stop" "The same as END.";
    "THEN" "if condition then ..." "What to do when the condition holds.";
    "TO" "for variable = start to finish" "Where FOR ends.";
    "UNTIL" "repeat ... until condition" "Closes a REPEAT.";
    "WEND" "while condition ... wend" "Closes a WHILE.";
    "WHILE" "while condition ... wend   or   do ... while condition"
        "Repeats as long as the condition holds.";
    "WRITE" "write address, value" "Writes a byte of the user EEPROM.";
    "VAR" "name VAR type{(size)}   or   name VAR variable{.modifier}"
        "Defines a variable, an array or another name for one.";
    "CON" "name CON value" "Defines a constant.";
    "FCON" "name FCON value" "Defines a floating point constant.";
    "BYTETABLE" "name ByteTable value, ..."
        "Defines a table of constants: ByteTable, SByteTable, WordTable, SWordTable, LongTable, SLongTable, FloatTable.";
    "#IF" "#IF expression ... #ELSEIF expression ... #ELSE ... #ENDIF"
        "Compiles a part only when an expression of constants holds.";
    "#IFDEF" "#IFDEF name ... #ENDIF   (also #IFNDEF, #ELSEIFDEF, #ELSEIFNDEF)"
        "Compiles a part only when a name is defined above.";
};

/// Output and input modifiers (MCP manual 3.3).
pub const FORMATS: [Word; 7] = words! {
    "DEC" "DEC{max} x{\\min}" "Decimal digits: at most max, with zeros to at least min.";
    "SDEC" "SDEC{max} x{\\min}" "Decimal digits with a minus sign.";
    "HEX" "HEX{max} x{\\min}" "Hexadecimal digits.";
    "IHEX" "IHEX{max} x{\\min}" "Hexadecimal digits after a $.";
    "REP" "REP character\\count" "A character several times.";
    "REAL" "REAL{max} x{\\decimals}"
        "A number with a decimal point: at most max digits before and decimals after it.";
    "STR" "STR array\\length{\\end}" "Characters of an array: at most length, up to the character end.";
};

/// CAN words that controllers have and whose syntax is not public (public clients and forums, 2015-2025).
pub const CAN: [&str; 7] = ["CANIN", "CANOUT", "CANCOBID", "CANRTR", "CANLEN", "CANDATA", "CANESR"];

/// Words that the manual carried over from another product.
pub const OTHER_PRODUCT: [&str; 3] = ["SEROUT", "SERIN", "BIN"];

/// What a word of the language is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// A statement's word; a row of [`COMMANDS`].
    Command(&'static Word),
    /// An operator's word.
    Operator(&'static Operator),
    /// An output modifier; a row of [`FORMATS`].
    Format(&'static Word),
    /// The type of a variable.
    Type(VarType),
    /// The type of a table, by its entries.
    Table(VarType),
    /// A system register.
    Register(RegisterId),
    /// A system register in a spelling of the manual's table alone.
    Misspelt(RegisterId),
    /// A word for the CAN bus.
    Can,
    /// A word of another product.
    OtherProduct,
}

/// No word of the language is longer.
const LONGEST_WORD: usize = 20;

/// What a word of the language is, in any case; `None` for names.
#[must_use]
pub fn known(word: &str) -> Option<Known> {
    static TABLE: LazyLock<HashMap<String, Known>> = LazyLock::new(every_word);
    let mut small = [0u8; LONGEST_WORD];
    let small = small.get_mut(..word.len())?;
    small.copy_from_slice(word.as_bytes());
    small.make_ascii_lowercase();
    TABLE.get(std::str::from_utf8(small).ok()?).copied()
}

/// The register of this name, in any case; the second part is true for a spelling of [`MISSPELT`].
#[must_use]
pub fn register(name: &str) -> Option<(RegisterId, bool)> {
    match known(name) {
        Some(Known::Register(id)) => Some((id, false)),
        Some(Known::Misspelt(id)) => Some((id, true)),
        Some(_) | None => None,
    }
}

fn every_word() -> HashMap<String, Known> {
    let ids = || (0u8..).zip(&REGISTERS).map(|(index, row)| (row.name, RegisterId(index)));
    let misspelt = MISSPELT.iter().filter_map(|(wrong, right)| {
        ids().find(|(name, _)| name == right).map(|(_, id)| (*wrong, Known::Misspelt(id)))
    });
    let rows = |rows: &'static [Word], what: fn(&'static Word) -> Known| {
        rows.iter().map(move |row| (row.name, what(row)))
    };
    let words = rows(&COMMANDS, Known::Command)
        .filter(|(name, _)| !name.starts_with('#'))
        .chain(OPERATORS.iter().filter(|row| row.is_word()).map(|row| (row.name, Known::Operator(row))))
        .chain(rows(&FORMATS, Known::Format))
        .chain(VarType::ALL.map(|kind| (kind.name(), Known::Type(kind))))
        .chain(TABLES.map(|(name, kind)| (name, Known::Table(kind))))
        .chain(ids().map(|(name, id)| (name, Known::Register(id))))
        .chain(misspelt)
        .chain(CAN.map(|name| (name, Known::Can)))
        .chain(OTHER_PRODUCT.map(|name| (name, Known::OtherProduct)));
    words.map(|(name, what)| (name.to_ascii_lowercase(), what)).collect()
}

/// Whether a word can be no name: it is a command, an operator, a type, a modifier or a register.
#[must_use]
pub fn is_reserved(name: &str) -> bool {
    known(name).is_some()
}

/// The word nearest to what was typed, if one is near.
#[must_use]
pub fn nearest<'a>(typed: &str, words: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if typed.len() > LONGEST_GUESS {
        return None;
    }
    let typed = typed.to_ascii_lowercase();
    let length = typed.chars().count();
    let limit = (length / 3).clamp(1, 3);
    let letters = letters(&typed);
    let is_far = |word: &str| {
        let others = self::letters(word);
        (letters & !others).count_ones().max((others & !letters).count_ones()) as usize > limit
    };
    words
        .into_iter()
        // A distance is at least the difference of the lengths, and the number of letters that one of them alone has.
        .filter(|word| word.len() <= 4 * LONGEST_GUESS && word.chars().count().abs_diff(length) <= limit)
        .filter(|word| !is_far(word))
        .map(|word| (strsim::damerau_levenshtein(&typed, &word.to_ascii_lowercase()), word))
        .filter(|(distance, _)| (1..=limit).contains(distance))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, word)| word)
}

/// Longer words are compared with none: the time for that goes with the square of the length, and nobody types them by hand.
const LONGEST_GUESS: usize = 64;

/// Which bytes a word has, small and capital letters alike, as bits; some share one.
fn letters(word: &str) -> u64 {
    word.bytes().fold(0, |bits, byte| bits | 1 << (byte.to_ascii_lowercase() % 64))
}

/// "Did you mean ...?" for the nearest of these words.
#[must_use]
pub fn did_you_mean<'a>(typed: &str, words: impl IntoIterator<Item = &'a str>) -> Option<String> {
    nearest(typed, words).map(|word| format!("Did you mean {word}?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_register_is_found_by_its_name_in_any_case() {
        for (index, row) in REGISTERS.iter().enumerate() {
            let (id, misspelt) = register(&row.name.to_lowercase()).unwrap();
            assert_eq!((usize::from(id.0), misspelt), (index, false), "{}", row.name);
        }
        assert_eq!(register("SINGALTIMEOUT").unwrap().0.row().name, "SIGNALTIMEOUT");
        assert!(register("SINGALTIMEOUT").unwrap().1);
        assert_eq!(register("SYSNOTHING"), None);
    }

    #[test]
    fn words_of_the_language_are_reserved_in_any_case_and_labels_of_the_manual_are_not() {
        for word in ["goto", "Puts", "sysTICK", "float", "bytetable", "canin", "dig", "ihex", "Serout"] {
            assert!(is_reserved(word), "{word}");
        }
        for name in ["reset", "error", "main", "temp", "value", "loop", "mod"] {
            assert!(!is_reserved(name), "{name}");
        }
    }

    #[test]
    fn a_slip_of_the_finger_finds_the_word() {
        let names = || COMMANDS.iter().map(|word| word.name);
        assert_eq!(nearest("gotto", names()), Some("GOTO"));
        assert_eq!(nearest("pust", names()), Some("PUTS"));
        assert_eq!(nearest("xyzzy", names()), None);
    }
}
