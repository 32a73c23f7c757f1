//! The words of a line, each with its place.

use brushwork_script::text::Span;

/// What a piece of a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Letters, figures and underscores, beginning with a letter or an underscore.
    Word,
    /// Figures, with a sign or without.
    Number,
    /// `,`.
    Comma,
    /// `=`.
    Equals,
    /// From `#` to the end of the line.
    Comment,
    /// A character that means nothing.
    Bad,
}

/// A piece of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    pub kind: Kind,
    pub text: &'a str,
    pub span: Span,
}

/// The pieces of a line that begins at byte `start` of the text.
pub fn tokens(line: &str, start: usize) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    let mut rest = line;
    loop {
        rest = rest.trim_start();
        let Some(first) = rest.chars().next() else { return found };
        let (kind, length) = match first {
            '#' => (Kind::Comment, rest.trim_end().len()),
            ',' => (Kind::Comma, 1),
            '=' => (Kind::Equals, 1),
            '+' | '-' | '0'..='9' => number(rest),
            _ if is_letter(first) => (Kind::Word, word_length(rest)),
            other => (Kind::Bad, other.len_utf8()),
        };
        let at = start + line.len() - rest.len();
        let (text, after) = rest.split_at(length);
        found.push(Token { kind, text, span: Span::new(at, at + length) });
        rest = after;
    }
}

/// Whether a text is one word, as a name has to be.
pub fn is_word(text: &str) -> bool {
    text.chars().next().is_some_and(is_letter) && word_length(text) == text.len()
}

fn is_letter(letter: char) -> bool {
    letter.is_ascii_alphabetic() || letter == '_'
}

fn word_length(text: &str) -> usize {
    text.find(|letter| !is_letter(letter) && !letter.is_ascii_digit()).unwrap_or(text.len())
}

fn number(text: &str) -> (Kind, usize) {
    let sign = usize::from(text.starts_with(['+', '-']));
    let figures = text[sign..].bytes().take_while(u8::is_ascii_digit).count();
    if figures == 0 { (Kind::Bad, sign) } else { (Kind::Number, sign + figures) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(line: &str) -> Vec<(Kind, &str)> {
        tokens(line, 0).into_iter().map(|token| (token.kind, token.text)).collect()
    }

    #[test]
    fn a_line_comes_apart_into_its_words() {
        assert_eq!(
            kinds("  MR-500,ws 100 # there, and back "),
            [
                (Kind::Word, "MR"),
                (Kind::Number, "-500"),
                (Kind::Comma, ","),
                (Kind::Word, "ws"),
                (Kind::Number, "100"),
                (Kind::Comment, "# there, and back"),
            ]
        );
        assert_eq!(kinds("MA5000"), [(Kind::Word, "MA5000")]);
        assert_eq!(
            kinds("macro go2=3"),
            [(Kind::Word, "macro"), (Kind::Word, "go2"), (Kind::Equals, "="), (Kind::Number, "3")]
        );
        assert_eq!(kinds("- ö"), [(Kind::Bad, "-"), (Kind::Bad, "ö")]);
    }

    #[test]
    fn places_are_those_of_the_whole_text() {
        let found = tokens("ö MA", 10);
        assert_eq!(found[1].span, Span::new(13, 15));
    }

    #[test]
    fn a_name_is_one_word() {
        assert!(is_word("shuttle") && is_word("_a") && is_word("go2"));
        assert!(!is_word("2a") && !is_word("") && !is_word("a b"));
    }
}
