//! The statements of a macro file, line by line.

use super::codes;
use super::lexer::{Kind, Token, tokens};
use brushwork_script::diagnostic::Diagnostic;
use brushwork_script::text::Span;

/// A number as it is written, or the name of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand<'a> {
    Number(i32),
    Name(&'a str),
}

/// A command as it is written.
#[derive(Clone, Copy, Debug)]
pub struct WrittenCommand<'a> {
    pub letters: &'a str,
    pub span: Span,
    pub operand: Option<(Operand<'a>, Span)>,
}

/// What a line says.
#[derive(Clone, Debug)]
pub enum Statement<'a> {
    /// `macro NAME = NUMBER`.
    Macro { name: &'a str, span: Span, number: Option<(i32, Span)> },
    /// `const NAME = NUMBER`.
    Const { name: &'a str, span: Span, number: i32 },
    /// Commands with commas between.
    Commands(Vec<WrittenCommand<'a>>),
}

/// Reads a file. What is not understood is said, and the rest of its line passed by.
pub fn statements<'a>(text: &'a str, said: &mut Vec<Diagnostic>) -> Vec<Statement<'a>> {
    let mut found = Vec::new();
    for (start, line) in lines(text) {
        let pieces: Vec<Token<'a>> =
            tokens(line, start).into_iter().filter(|token| token.kind != Kind::Comment).collect();
        let end = Span::new(start + line.trim_end().len(), start + line.trim_end().len());
        let mut parser = Parser { pieces: &pieces, at: 0, end };
        if pieces.is_empty() {
            continue;
        }
        match parser.statement() {
            Ok(statement) => found.push(statement),
            Err(diagnostic) => said.push(diagnostic),
        }
    }
    found
}

/// The lines of a text, each with the byte it begins at.
pub fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut start = 0;
    text.split('\n').map(move |line| {
        let begun = start;
        start += line.len() + 1;
        (begun, line.trim_end_matches('\r'))
    })
}

/// The two letters of a command and the number that stands close to them.
fn apart(word: &str) -> (&str, Option<&str>) {
    match word.split_at_checked(2) {
        Some((letters, number)) if !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()) => {
            (letters, Some(number))
        }
        Some(_) | None => (word, None),
    }
}

fn too_wide(number: &str, span: Span) -> Diagnostic {
    let message = format!("{number} needs more than 32 bits.");
    Diagnostic { code: codes::BAD_NUMBER, span, message, hint: None }
}

struct Parser<'a, 't> {
    pieces: &'t [Token<'a>],
    at: usize,
    end: Span,
}

impl<'a> Parser<'a, '_> {
    fn statement(&mut self) -> Result<Statement<'a>, Diagnostic> {
        let first = self.pieces.first().map_or("", |token| token.text);
        let statement = if first.eq_ignore_ascii_case("macro") {
            self.at += 1;
            let (name, span) = self.name("the macro's name")?;
            let number =
                if self.takes(Kind::Equals) { Some(self.number("the macro's number")?) } else { None };
            Statement::Macro { name, span, number }
        } else if first.eq_ignore_ascii_case("const") {
            self.at += 1;
            let (name, span) = self.name("the name of the number")?;
            if !self.takes(Kind::Equals) {
                return Err(self.expected("= and the number"));
            }
            let (number, _) = self.number("a number")?;
            Statement::Const { name, span, number }
        } else {
            return self.commands().map(Statement::Commands);
        };
        match self.peek() {
            None => Ok(statement),
            Some(_) => Err(self.expected("the end of the line")),
        }
    }

    fn commands(&mut self) -> Result<Vec<WrittenCommand<'a>>, Diagnostic> {
        let mut commands = Vec::new();
        loop {
            let (word, span) = self.name("a command")?;
            let (letters, close) = apart(word);
            let close = close.map(|number| {
                let number = number.parse().map_err(|_| too_wide(number, span))?;
                Ok((Operand::Number(number), span))
            });
            let operand = match self.peek().map(|token| token.kind) {
                _ if close.is_some() => close.transpose()?,
                Some(Kind::Number) => {
                    let (number, span) = self.number("a number")?;
                    Some((Operand::Number(number), span))
                }
                Some(Kind::Word) => {
                    let (name, span) = self.name("a name")?;
                    Some((Operand::Name(name), span))
                }
                Some(Kind::Comma | Kind::Equals | Kind::Comment | Kind::Bad) | None => None,
            };
            commands.push(WrittenCommand { letters, span, operand });
            match self.peek() {
                None => return Ok(commands),
                Some(_) if self.takes(Kind::Comma) => {
                    // A line may end with its comma, and go on in the next.
                    if self.peek().is_none() {
                        return Ok(commands);
                    }
                }
                Some(_) => return Err(self.expected("a comma or the end of the line")),
            }
        }
    }

    fn peek(&self) -> Option<Token<'a>> {
        self.pieces.get(self.at).copied()
    }

    fn takes(&mut self, kind: Kind) -> bool {
        let is_there = self.peek().is_some_and(|token| token.kind == kind);
        self.at += usize::from(is_there);
        is_there
    }

    fn name(&mut self, what: &str) -> Result<(&'a str, Span), Diagnostic> {
        match self.peek() {
            Some(Token { kind: Kind::Word, text, span }) => {
                self.at += 1;
                Ok((text, span))
            }
            Some(_) | None => Err(self.expected(what)),
        }
    }

    fn number(&mut self, what: &str) -> Result<(i32, Span), Diagnostic> {
        match self.peek() {
            Some(Token { kind: Kind::Number, text, span }) => {
                self.at += 1;
                match text.parse() {
                    Ok(number) => Ok((number, span)),
                    Err(_) => Err(too_wide(text, span)),
                }
            }
            Some(_) | None => Err(self.expected(what)),
        }
    }

    fn expected(&self, what: &str) -> Diagnostic {
        let (code, span, found) = match self.peek() {
            None => (codes::UNEXPECTED, self.end, "the end of the line".to_owned()),
            Some(token) if token.kind == Kind::Bad => {
                (codes::BAD_CHARACTER, token.span, format!("\"{}\"", token.text))
            }
            Some(token) => (codes::UNEXPECTED, token.span, format!("\"{}\"", token.text)),
        };
        let message = format!("Expected {what}, and found {found}.");
        Diagnostic { code, span, message, hint: None }
    }
}
