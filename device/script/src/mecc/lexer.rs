//! Text into tokens. Nothing is refused twice: a bad character is noted once and skipped.

use super::codes;
use crate::diagnostic::{Diagnostic, excerpt};
use crate::lexing::{self, Cursor, Wrong, bytes_of};

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A name or a word of the language; upper and lower case are the same.
    Word,
    /// A whole number: decimal, or hexadecimal with an H behind it or 0x before it.
    Number(u16),
    /// Characters between quotes, a byte each, see [`text_bytes`].
    Text,
    /// An operator or punctuation, as it is written.
    Sign(&'static str),
    /// From a semicolon to the end of the line.
    Comment,
    /// End of a line.
    Newline,
    /// End of the program.
    End,
}

/// A token and where it stands.
pub type Token = lexing::Token<TokenKind>;

/// What there is to say of something wrong; `text` is the whole text.
#[must_use]
pub fn reported(wrong: Wrong, text: &str) -> Diagnostic {
    let Wrong { code, span } = wrong;
    let piece = span.of(text);
    let shown = excerpt(piece);
    let (message, hint) = match code {
        codes::NAME_TOO_LONG => (
            format!("This name is {} characters long; {LONGEST_NAME} are allowed.", piece.len()),
            "Give it a shorter name.",
        ),
        codes::NUMBER_TOO_LARGE => {
            (format!("`{shown}` does not fit in a Word."), "The largest number is 65535.")
        }
        codes::BAD_NUMBER => (
            format!("`{shown}` is neither a number nor a name."),
            "A hexadecimal number is written 1FH or 0x1F.",
        ),
        codes::OPEN_TEXT => ("This text has no end.".to_owned(), "Close it with a quote on the same line."),
        codes::WIDE_CHARACTER => {
            let wide = piece.chars().find(|letter| u8::try_from(*letter).is_err()).unwrap_or('?');
            (format!("`{wide}` is more than a byte."), "A character of a text is one byte: use another.")
        }
        _ => of_character(piece.chars().next().unwrap_or('?')),
    };
    Diagnostic { code, span, message, hint: Some(hint.to_owned()) }
}

/// The sentence and hint for a character that means nothing.
fn of_character(letter: char) -> (String, &'static str) {
    let hint = match letter {
        '\'' | '‘' | '’' => "Texts stand between double quotes; a comment begins with a semicolon.",
        '{' | '}' | '[' | ']' => "Arguments stand behind the command, those of a function in parentheses.",
        '?' => "The manual writes ?Name? where a value is to be put.",
        '/' | '#' => "A comment begins with a semicolon.",
        '!' => "Not equal is <>; Not turns a condition round.",
        '&' => "Conditions are joined with And; a hexadecimal number is written 1FH or 0x1F.",
        '|' => "Conditions are joined with And, Or and Not.",
        '%' => "The remainder of a division is written Mod.",
        '.' => "Numbers are whole.",
        ':' => "One statement stands in a line.",
        _ => "Take it out.",
    };
    if letter.is_control() {
        return (format!("The control character U+{:04X} means nothing here.", u32::from(letter)), hint);
    }
    (format!("`{letter}` means nothing here."), hint)
}

/// Longest first, so that `<=` is not `<` and `=`.
const SIGNS: [&str; 13] = ["<>", "<=", ">=", "+", "-", "*", "/", "=", "<", ">", "(", ")", ","];

/// Longest name; that of MCL, since nothing is said of it.
pub const LONGEST_NAME: usize = crate::mcl::lexer::LONGEST_NAME;

/// Quotes, the straight one and those that the manual prints.
const QUOTES: [char; 3] = ['"', '“', '”'];

/// The bytes of a text token, whose piece of the program this is.
#[must_use]
pub fn text_bytes(piece: &str) -> Vec<u8> {
    let inside = piece.trim_start_matches(QUOTES).trim_end_matches(QUOTES);
    bytes_of(inside)
}

/// All tokens of a text, and what is wrong with it. The last one is [`TokenKind::End`].
#[must_use]
pub fn tokens(text: &str) -> (Vec<Token>, Vec<Wrong>) {
    let mut lexer = Lexer(Cursor::new(text));
    while lexer.0.at < text.len() {
        lexer.next();
    }
    lexer.0.push(TokenKind::Newline, text.len());
    lexer.0.push(TokenKind::End, text.len());
    (lexer.0.tokens, lexer.0.wrong)
}

struct Lexer<'a>(Cursor<'a, TokenKind>);

impl Lexer<'_> {
    fn next(&mut self) {
        let start = self.0.at;
        let Some(letter) = self.0.rest().chars().next() else { return };
        match letter {
            '\n' => {
                self.0.at += 1;
                self.0.push(TokenKind::Newline, start);
            }
            letter if letter.is_whitespace() => self.0.at += letter.len_utf8(),
            ';' => {
                self.0.skip_line();
                self.0.push(TokenKind::Comment, start);
            }
            letter if QUOTES.contains(&letter) => {
                self.0.quoted(&QUOTES, codes::OPEN_TEXT, codes::WIDE_CHARACTER);
                self.0.push(TokenKind::Text, start);
            }
            '0'..='9' => self.number(),
            letter if letter.is_ascii_alphabetic() || letter == '_' => {
                if self.0.skip_name() > LONGEST_NAME {
                    self.0.report(codes::NAME_TOO_LONG, start);
                }
                self.0.push(TokenKind::Word, start);
            }
            _ => match self.0.sign(&SIGNS) {
                Some(sign) => self.0.push(TokenKind::Sign(sign), start),
                None => {
                    self.0.at += letter.len_utf8();
                    self.0.report(codes::BAD_CHARACTER, start);
                }
            },
        }
    }

    fn number(&mut self) {
        let start = self.0.at;
        self.0.skip_name();
        let piece = self.0.since(start).to_ascii_lowercase();
        let (digits, radix) = match (piece.strip_prefix("0x"), piece.strip_suffix('h')) {
            (Some(digits), _) | (None, Some(digits)) => (digits, 16),
            (None, None) => (piece.as_str(), 10),
        };
        let is_number = !digits.is_empty() && digits.chars().all(|digit| digit.is_digit(radix));
        let value = u16::from_str_radix(digits, radix);
        if !is_number {
            self.0.report(codes::BAD_NUMBER, start);
        } else if value.is_err() {
            self.0.report(codes::NUMBER_TOO_LARGE, start);
        }
        self.0.push(TokenKind::Number(value.unwrap_or(0)), start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<TokenKind> {
        tokens(text).0.into_iter().map(|token| token.kind).collect()
    }

    #[test]
    fn numbers_are_decimal_or_hexadecimal() {
        for text in ["48", "30H", "030h", "0x30"] {
            assert_eq!(kinds(text)[0], TokenKind::Number(48), "{text}");
        }
    }

    #[test]
    fn texts_stand_between_the_quotes_of_the_keyboard_or_of_the_manual() {
        for text in ["\"TX1\"", "“TX1”"] {
            let (tokens, wrong) = tokens(text);
            assert!(wrong.is_empty());
            assert_eq!(
                (tokens[0].kind, text_bytes(tokens[0].span.of(text))),
                (TokenKind::Text, b"TX1".to_vec())
            );
        }
        assert_eq!(text_bytes("\"O"), b"O");
    }

    #[test]
    fn bad_input_is_named_and_skipped() {
        for (text, code) in [
            ("a = 70000", codes::NUMBER_TOO_LARGE),
            ("a = 12ab", codes::BAD_NUMBER),
            ("a = \"b", codes::OPEN_TEXT),
            ("a = ?b?", codes::BAD_CHARACTER),
            ("a = \"€\"", codes::WIDE_CHARACTER),
        ] {
            let (tokens, wrong) = tokens(text);
            assert_eq!(wrong[0].code, code, "{text}");
            assert!(!reported(wrong[0], text).message.is_empty());
            assert_eq!(tokens.last().unwrap().kind, TokenKind::End);
        }
    }
}
