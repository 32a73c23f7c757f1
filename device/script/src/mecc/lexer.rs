//! Text into tokens. Nothing is refused twice: a bad character is noted once and skipped.

use super::codes;
use crate::diagnostic::{Diagnostic, excerpt};
use crate::text::Span;

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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Where it is.
    pub span: Span,
}

/// Something wrong with a piece of the text; what there is to say is worked out for those that are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// Which error.
    pub code: &'static str,
    /// Where.
    pub span: Span,
}

impl Wrong {
    /// What there is to say; `text` is the whole text.
    #[must_use]
    pub fn reported(self, text: &str) -> Diagnostic {
        let Self { code, span } = self;
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
            codes::OPEN_TEXT => {
                ("This text has no end.".to_owned(), "Close it with a quote on the same line.")
            }
            codes::WIDE_CHARACTER => {
                let wide = piece.chars().find(|letter| u8::try_from(*letter).is_err()).unwrap_or('?');
                (format!("`{wide}` is more than a byte."), "A character of a text is one byte: use another.")
            }
            _ => of_character(piece.chars().next().unwrap_or('?')),
        };
        Diagnostic { code, span, message, hint: Some(hint.to_owned()) }
    }
}

/// The sentence and hint for a character that means nothing.
fn of_character(letter: char) -> (String, &'static str) {
    let hint = match letter {
        '\'' | '‘' | '’' => "Texts stand between double quotes; a comment begins with a semicolon.",
        '{' | '}' | '[' | ']' => "Arguments stand behind the command, those of a function in parentheses.",
        '?' => "The manual writes ?Name? where a value is to be put.",
        '/' | '#' => "A comment begins with a semicolon.",
        '&' | '|' | '!' => "Conditions are joined with And, Or and Not.",
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
    inside.chars().map(|letter| u8::try_from(letter).unwrap_or(b'?')).collect()
}

/// All tokens of a text, and what is wrong with it. The last one is [`TokenKind::End`].
#[must_use]
pub fn tokens(text: &str) -> (Vec<Token>, Vec<Wrong>) {
    let mut lexer = Lexer { text, at: 0, tokens: Vec::new(), wrong: Vec::new() };
    while lexer.at < text.len() {
        lexer.next();
    }
    lexer.push(TokenKind::Newline, text.len());
    lexer.push(TokenKind::End, text.len());
    (lexer.tokens, lexer.wrong)
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    tokens: Vec<Token>,
    wrong: Vec<Wrong>,
}

impl Lexer<'_> {
    fn next(&mut self) {
        let start = self.at;
        let rest = &self.text[start..];
        let Some(letter) = rest.chars().next() else { return };
        match letter {
            '\n' => {
                self.at += 1;
                self.push(TokenKind::Newline, start);
            }
            letter if letter.is_whitespace() => self.at += letter.len_utf8(),
            ';' => {
                self.at += rest.find('\n').unwrap_or(rest.len());
                self.push(TokenKind::Comment, start);
            }
            letter if QUOTES.contains(&letter) => self.text_token(letter.len_utf8()),
            '0'..='9' => self.number(),
            letter if letter.is_ascii_alphabetic() || letter == '_' => self.word(),
            _ => self.sign(letter),
        }
    }

    fn push(&mut self, kind: TokenKind, start: usize) {
        self.tokens.push(Token { kind, span: Span::new(start, self.at) });
    }

    fn report(&mut self, code: &'static str, start: usize) {
        self.wrong.push(Wrong { code, span: Span::new(start, self.at) });
    }

    fn word(&mut self) {
        let start = self.at;
        self.skip_name();
        if self.at - start > LONGEST_NAME {
            self.report(codes::NAME_TOO_LONG, start);
        }
        self.push(TokenKind::Word, start);
    }

    fn skip_name(&mut self) {
        let rest = &self.text[self.at..];
        self.at +=
            rest.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(rest.len());
    }

    fn number(&mut self) {
        let start = self.at;
        self.skip_name();
        let piece = self.text[start..self.at].to_ascii_lowercase();
        let (digits, radix) = match (piece.strip_prefix("0x"), piece.strip_suffix('h')) {
            (Some(digits), _) | (None, Some(digits)) => (digits, 16),
            (None, None) => (piece.as_str(), 10),
        };
        let is_number = !digits.is_empty() && digits.chars().all(|digit| digit.is_digit(radix));
        let value = u16::from_str_radix(digits, radix);
        if !is_number {
            self.report(codes::BAD_NUMBER, start);
        } else if value.is_err() {
            self.report(codes::NUMBER_TOO_LARGE, start);
        }
        self.push(TokenKind::Number(value.unwrap_or(0)), start);
    }

    fn text_token(&mut self, quote: usize) {
        let start = self.at;
        let rest = &self.text[start + quote..];
        let length = rest.find(|letter| QUOTES.contains(&letter) || letter == '\n').unwrap_or(rest.len());
        let mut inside = &rest[..length];
        match rest[length..].chars().next().filter(|letter| *letter != '\n') {
            Some(close) => self.at = start + quote + length + close.len_utf8(),
            None => {
                inside = inside.trim_end_matches('\r');
                self.at = start + quote + inside.len();
                self.report(codes::OPEN_TEXT, start);
            }
        }
        if inside.chars().any(|letter| u8::try_from(letter).is_err()) {
            self.report(codes::WIDE_CHARACTER, start);
        }
        self.push(TokenKind::Text, start);
    }

    fn sign(&mut self, letter: char) {
        let start = self.at;
        if let Some(sign) = SIGNS.into_iter().find(|sign| self.text[start..].starts_with(sign)) {
            self.at += sign.len();
            return self.push(TokenKind::Sign(sign), start);
        }
        self.at += letter.len_utf8();
        self.report(codes::BAD_CHARACTER, start);
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
            assert!(!wrong[0].reported(text).message.is_empty());
            assert_eq!(tokens.last().unwrap().kind, TokenKind::End);
        }
    }
}
