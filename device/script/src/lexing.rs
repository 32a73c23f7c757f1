//! What the lexers of the two languages share: tokens with their places, and the pieces that both languages write alike.

use crate::text::Span;

/// A token and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<K> {
    /// What it is.
    pub kind: K,
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

/// A text that is being cut into tokens.
#[derive(Debug)]
pub struct Cursor<'a, K> {
    pub text: &'a str,
    /// What is before it has been read.
    pub at: usize,
    pub tokens: Vec<Token<K>>,
    pub wrong: Vec<Wrong>,
}

impl<'a, K> Cursor<'a, K> {
    pub const fn new(text: &'a str) -> Self {
        Self { text, at: 0, tokens: Vec::new(), wrong: Vec::new() }
    }

    /// What has not been read yet.
    pub fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// What was read since `start`.
    pub fn since(&self, start: usize) -> &'a str {
        &self.text[start..self.at]
    }

    /// A token from `start` to here.
    pub fn push(&mut self, kind: K, start: usize) {
        self.tokens.push(Token { kind, span: Span::new(start, self.at) });
    }

    /// Something wrong with the piece from `start` to here.
    pub fn report(&mut self, code: &'static str, start: usize) {
        self.wrong.push(Wrong { code, span: Span::new(start, self.at) });
    }

    /// Passes over letters, digits and underscores; how many bytes they are.
    pub fn skip_name(&mut self) -> usize {
        let rest = self.rest();
        let is_other = |letter: char| !letter.is_ascii_alphanumeric() && letter != '_';
        let length = rest.find(is_other).unwrap_or(rest.len());
        self.at += length;
        length
    }

    /// Passes over digits.
    pub fn skip_digits(&mut self) {
        let rest = self.rest();
        self.at += rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len());
    }

    /// Passes over the rest of the line.
    pub fn skip_line(&mut self) {
        let rest = self.rest();
        self.at += rest.find('\n').unwrap_or(rest.len());
    }

    /// Reads a text that ends at one of the quotes, or with its line, which is an error `open`; a character of it that is more than a byte is an
    /// error `wide`. What stands between the quotes.
    pub fn quoted(&mut self, quotes: &[char], open: &'static str, wide: &'static str) -> &'a str {
        let start = self.at;
        let rest = self.rest();
        let quote = rest.chars().next().map_or(0, char::len_utf8);
        let rest = &rest[quote..];
        let end = rest.find(|letter| quotes.contains(&letter) || letter == '\n').unwrap_or(rest.len());
        let mut inside = &rest[..end];
        match rest[end..].chars().next().filter(|letter| *letter != '\n') {
            Some(close) => self.at += quote + end + close.len_utf8(),
            None => {
                inside = inside.trim_end_matches('\r');
                self.at += quote + inside.len();
                self.report(open, start);
            }
        }
        if inside.chars().any(|letter| u8::try_from(letter).is_err()) {
            self.report(wide, start);
        }
        inside
    }

    /// Passes over the first of the signs that stands here; `signs` has the longer ones first.
    pub fn sign(&mut self, signs: &[&'static str]) -> Option<&'static str> {
        let rest = self.rest();
        let sign = signs.iter().copied().find(|sign| rest.starts_with(sign))?;
        self.at += sign.len();
        Some(sign)
    }
}

/// The characters of a text as a controller has them, a byte each.
pub fn bytes_of(inside: &str) -> Vec<u8> {
    inside.chars().map(|letter| u8::try_from(letter).unwrap_or(b'?')).collect()
}
