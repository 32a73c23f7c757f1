//! Text into tokens (MCP manual 3.1, 3.2.2). Nothing is refused twice: a bad character is noted once and skipped.

use super::codes;
use crate::diagnostic::{Diagnostic, excerpt};
use crate::text::Span;

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
#[derive(Clone, Debug, PartialEq)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Where it is.
    pub span: Span,
}

/// Something wrong with a piece of the text. A text of nothing else holds one at each of its bytes, so it stays small: what there is to say is
/// worked out for those that are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// Which error, or warning.
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
            ';' => self.at += rest.find('\n').unwrap_or(rest.len()),
            '"' => self.text_token(),
            '#' => self.directive(),
            '%' if rest[1..].starts_with(['0', '1']) => self.based(1, 2),
            '0' if rest[1..].starts_with(['x', 'X']) => self.based(2, 16),
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

    /// How many bytes from here on are letters, digits or underscores.
    fn name_length(&self, from: usize) -> usize {
        let rest = &self.text[from..];
        rest.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(rest.len())
    }

    fn word(&mut self) {
        let start = self.at;
        self.at += self.name_length(start);
        if self.at - start > LONGEST_NAME {
            self.report(codes::NAME_TOO_LONG, start);
        }
        self.push(TokenKind::Word, start);
    }

    /// `0x1F` and `%1010`, whose digits begin `prefix` bytes on.
    fn based(&mut self, prefix: usize, radix: u32) {
        let start = self.at;
        self.at += prefix + self.name_length(start + prefix);
        let digits = self.text[start + prefix..self.at].replace('_', "x");
        let value = u64::from_str_radix(&digits, radix);
        let kind = match value.map(u32::try_from) {
            Ok(Ok(value)) => value,
            Ok(Err(_)) => self.too_large(start),
            Err(error) if *error.kind() == std::num::IntErrorKind::PosOverflow => self.too_large(start),
            Err(_) => {
                self.report(codes::BAD_NUMBER, start);
                0
            }
        };
        self.push(TokenKind::Integer(kind), start);
    }

    fn too_large(&mut self, start: usize) -> u32 {
        self.report(codes::NUMBER_TOO_LARGE, start);
        0
    }

    fn digits(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len());
    }

    fn number(&mut self) {
        let start = self.at;
        self.digits();
        let rest = &self.text[self.at..];
        if rest.starts_with('.') && rest[1..].starts_with(|letter: char| letter.is_ascii_digit()) {
            self.at += 1;
            self.digits();
            self.exponent();
            let value = self.text[start..self.at].parse().unwrap_or(0.0);
            return self.push(TokenKind::Float(value), start);
        }
        let tail = self.name_length(self.at);
        if tail > 0 {
            self.at += tail;
            self.report(codes::BAD_NUMBER, start);
            return self.push(TokenKind::Integer(0), start);
        }
        let value = self.text[start..self.at].parse().unwrap_or_else(|_| self.too_large(start));
        self.push(TokenKind::Integer(value), start);
    }

    fn exponent(&mut self) {
        let rest = &self.text[self.at..];
        let Some(tail) = rest.strip_prefix(['e', 'E']) else { return };
        let digits = tail.strip_prefix(['+', '-']).unwrap_or(tail);
        if digits.starts_with(|letter: char| letter.is_ascii_digit()) {
            self.at += rest.len() - digits.len();
            self.digits();
        }
    }

    fn text_token(&mut self) {
        let start = self.at;
        let rest = &self.text[start + 1..];
        let length = rest.find(['"', '\n']).unwrap_or(rest.len());
        let mut inside = &rest[..length];
        if rest[length..].starts_with('"') {
            self.at = start + length + 2;
        } else {
            inside = inside.trim_end_matches('\r');
            self.at = start + 1 + inside.len();
            self.report(codes::OPEN_TEXT, start);
        }
        let bytes: Vec<u8> = inside.chars().map(|letter| u8::try_from(letter).unwrap_or(b'?')).collect();
        if inside.chars().any(|letter| u8::try_from(letter).is_err()) {
            self.report(codes::WIDE_CHARACTER, start);
        }
        self.push(TokenKind::Text(bytes), start);
    }

    fn directive(&mut self) {
        let start = self.at;
        self.at += 1 + self.name_length(start + 1);
        let mut name = self.text[start + 1..self.at].to_ascii_lowercase();
        if name == "elsif" {
            self.report(codes::MISSPELT, start);
            name = "elseif".to_owned();
        }
        self.push(TokenKind::Directive(name), start);
    }

    /// `$1F`, as other languages write it.
    fn dollar(&mut self, start: usize) {
        self.at += self.name_length(self.at);
        self.report(codes::BAD_CHARACTER, start);
        self.push(TokenKind::Integer(0), start);
    }

    fn sign(&mut self, letter: char) {
        let start = self.at;
        if let Some(sign) = SIGNS.into_iter().find(|sign| self.text[start..].starts_with(sign)) {
            self.at += sign.len();
            return self.push(TokenKind::Sign(sign), start);
        }
        self.at += letter.len_utf8();
        if letter == '$' {
            return self.dollar(start);
        }
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
