//! Text into tokens (MCP manual 3.1, 3.2.2). Nothing is refused twice: a bad character is noted once and skipped.

use super::codes;
use crate::diagnostic::{Diagnostic, excerpt};
use crate::lexing::{self, Cursor, Wrong, bytes_of};

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub enum TokenKind {
    /// A name or a word of the language; upper and lower case are the same.
    Word,
    /// A whole number: decimal, `0x` or `%`.
    Integer(u32),
    /// A number with a decimal point.
    Float(f32),
    /// Characters between quotes, a byte each.
    Text(Vec<u8>),
    /// `#IF` and its kin, without the `#`.
    Directive(String),
    /// An operator or punctuation, as it is written.
    Sign(&'static str),
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
        codes::NAME_TOO_LONG => {
            (format!("This name is {} characters long; {LONGEST_NAME} are allowed.", piece.len()), None)
        }
        codes::NUMBER_TOO_LARGE => {
            (format!("`{shown}` does not fit in 32 bits."), Some("The largest number is 4294967295."))
        }
        codes::BAD_NUMBER if piece.starts_with('%') => (format!("`{shown}` is no binary number."), None),
        codes::BAD_NUMBER if piece.starts_with("0x") || piece.starts_with("0X") => {
            (format!("`{shown}` is no hexadecimal number."), None)
        }
        codes::BAD_NUMBER => {
            (format!("`{shown}` is neither a number nor a name."), Some("A name begins with a letter."))
        }
        codes::OPEN_TEXT => {
            ("This text has no end.".to_owned(), Some("Close it with a quote on the same line."))
        }
        codes::WIDE_CHARACTER => {
            let wide = piece.chars().find(|letter| u8::try_from(*letter).is_err()).unwrap_or('?');
            (format!("`{wide}` is more than a byte; a character of a text is one."), None)
        }
        codes::MISSPELT => {
            ("The directive is #ELSEIF; only a heading of the manual has #ELSIF.".to_owned(), None)
        }
        _ => of_character(piece.chars().next().unwrap_or('?')),
    };
    Diagnostic { code, span, message, hint: hint.map(str::to_owned) }
}

/// The sentence and hint for a character that means nothing.
fn of_character(letter: char) -> (String, Option<&'static str>) {
    let hint = match letter {
        '“' | '”' | '„' | '‘' | '’' | '\'' => Some("Texts stand between straight double quotes."),
        '{' | '}' => Some("Braces in the manual mark what may be left out; they are not written."),
        '%' => Some("A binary number is % and its digits, as in %1010."),
        '$' => Some("Hexadecimal numbers are written 0x1F."),
        _ => None,
    };
    if letter.is_control() {
        return (format!("The control character U+{:04X} means nothing here.", u32::from(letter)), hint);
    }
    (format!("`{letter}` means nothing here."), hint)
}

/// Longest first, so that `*/` is not `*` and `/`.
const SIGNS: [&str; 31] = [
    "<<", ">>", "<>", "<=", ">=", "**", "*/", "//", "&/", "|/", "^/", "+", "-", "*", "/", "&", "|", "^", "=",
    "<", ">", "~", "!", "(", ")", "[", "]", ",", ".", "\\", ":",
];

/// Longest name that the language takes (MCP manual 3.1.5).
pub const LONGEST_NAME: usize = 1024;

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
        let rest = self.0.rest();
        let Some(letter) = rest.chars().next() else { return };
        match letter {
            '\n' => {
                self.0.at += 1;
                self.0.push(TokenKind::Newline, start);
            }
            letter if letter.is_whitespace() => self.0.at += letter.len_utf8(),
            ';' => self.0.skip_line(),
            '"' => {
                let inside = self.0.quoted(&['"'], codes::OPEN_TEXT, codes::WIDE_CHARACTER);
                self.0.push(TokenKind::Text(bytes_of(inside)), start);
            }
            '#' => self.directive(),
            '%' if rest[1..].starts_with(['0', '1']) => self.based(1, 2),
            '0' if rest[1..].starts_with(['x', 'X']) => self.based(2, 16),
            '0'..='9' => self.number(),
            letter if letter.is_ascii_alphabetic() || letter == '_' => self.word(),
            _ => self.sign(letter),
        }
    }

    fn word(&mut self) {
        let start = self.0.at;
        if self.0.skip_name() > LONGEST_NAME {
            self.0.report(codes::NAME_TOO_LONG, start);
        }
        self.0.push(TokenKind::Word, start);
    }

    /// `0x1F` and `%1010`, whose digits begin `prefix` bytes on.
    fn based(&mut self, prefix: usize, radix: u32) {
        let start = self.0.at;
        self.0.at += prefix;
        self.0.skip_name();
        let digits = self.0.since(start + prefix).replace('_', "x");
        let value = u64::from_str_radix(&digits, radix);
        let kind = match value.map(u32::try_from) {
            Ok(Ok(value)) => value,
            Ok(Err(_)) => self.too_large(start),
            Err(error) if *error.kind() == std::num::IntErrorKind::PosOverflow => self.too_large(start),
            Err(_) => {
                self.0.report(codes::BAD_NUMBER, start);
                0
            }
        };
        self.0.push(TokenKind::Integer(kind), start);
    }

    fn too_large(&mut self, start: usize) -> u32 {
        self.0.report(codes::NUMBER_TOO_LARGE, start);
        0
    }

    fn number(&mut self) {
        let start = self.0.at;
        self.0.skip_digits();
        let rest = self.0.rest();
        if rest.starts_with('.') && rest[1..].starts_with(|letter: char| letter.is_ascii_digit()) {
            self.0.at += 1;
            self.0.skip_digits();
            self.exponent();
            let value = self.0.since(start).parse().unwrap_or(0.0);
            return self.0.push(TokenKind::Float(value), start);
        }
        if self.0.skip_name() > 0 {
            self.0.report(codes::BAD_NUMBER, start);
            return self.0.push(TokenKind::Integer(0), start);
        }
        let value = self.0.since(start).parse().unwrap_or_else(|_| self.too_large(start));
        self.0.push(TokenKind::Integer(value), start);
    }

    fn exponent(&mut self) {
        let rest = self.0.rest();
        let Some(tail) = rest.strip_prefix(['e', 'E']) else { return };
        let digits = tail.strip_prefix(['+', '-']).unwrap_or(tail);
        if digits.starts_with(|letter: char| letter.is_ascii_digit()) {
            self.0.at += rest.len() - digits.len();
            self.0.skip_digits();
        }
    }

    fn directive(&mut self) {
        let start = self.0.at;
        self.0.at += 1;
        self.0.skip_name();
        let mut name = self.0.since(start + 1).to_ascii_lowercase();
        if name == "elsif" {
            self.0.report(codes::MISSPELT, start);
            name = "elseif".to_owned();
        }
        self.0.push(TokenKind::Directive(name), start);
    }

    fn sign(&mut self, letter: char) {
        let start = self.0.at;
        if let Some(sign) = self.0.sign(&SIGNS) {
            return self.0.push(TokenKind::Sign(sign), start);
        }
        self.0.at += letter.len_utf8();
        if letter == '$' {
            // `$1F`, as other languages write it.
            self.0.skip_name();
            self.0.report(codes::BAD_CHARACTER, start);
            return self.0.push(TokenKind::Integer(0), start);
        }
        self.0.report(codes::BAD_CHARACTER, start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<TokenKind> {
        tokens(text).0.into_iter().map(|token| token.kind).collect()
    }

    #[test]
    fn the_three_bases_write_the_same_number() {
        // MCP manual 3.2.2: 2349, 0x092D, %100100101101.
        let expected = TokenKind::Integer(2349);
        for text in ["2349", "0x092D", "%100100101101"] {
            assert_eq!(kinds(text)[0], expected, "{text}");
        }
    }

    #[test]
    fn the_longest_sign_wins() {
        let signs = |text: &str| -> Vec<TokenKind> {
            kinds(text).into_iter().filter(|kind| matches!(kind, TokenKind::Sign(_))).collect()
        };
        assert_eq!(signs("a */ b"), [TokenKind::Sign("*/")]);
        assert_eq!(signs("a &/ b"), [TokenKind::Sign("&/")]);
        assert_eq!(signs("a<>b"), [TokenKind::Sign("<>")]);
        assert_eq!(signs("a< -b"), [TokenKind::Sign("<"), TokenKind::Sign("-")]);
    }

    #[test]
    fn a_comment_ends_with_its_line_but_not_inside_a_text() {
        assert_eq!(kinds("a ;b\nc").len(), 5);
        assert_eq!(kinds("\"a;b\"")[0], TokenKind::Text(b"a;b".to_vec()));
    }

    #[test]
    fn bad_input_is_named_and_skipped() {
        for (text, code) in [
            ("a = 99999999999", codes::NUMBER_TOO_LARGE),
            ("a = 0xfffffffff", codes::NUMBER_TOO_LARGE),
            ("a = 0xzz", codes::BAD_NUMBER),
            ("a = 12ab", codes::BAD_NUMBER),
            ("a = \"abc", codes::OPEN_TEXT),
            ("a = “b”", codes::BAD_CHARACTER),
            ("a = \"€\"", codes::WIDE_CHARACTER),
        ] {
            let (tokens, wrong) = tokens(text);
            assert_eq!(wrong[0].code, code, "{text}");
            assert_eq!(tokens.last().unwrap().kind, TokenKind::End);
        }
    }

    #[test]
    fn numbers_with_a_point_are_floats_and_a_point_after_a_name_is_a_modifier() {
        assert_eq!(kinds("6.50")[0], TokenKind::Float(6.5));
        assert_eq!(kinds("1.5e-2")[0], TokenKind::Float(0.015));
        assert_eq!(kinds("x.byte1")[1], TokenKind::Sign("."));
    }
}
