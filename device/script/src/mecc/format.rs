//! Source text in one style: indentation by blocks, one space where one helps. Nothing else changes: no token, no comment, no line. Lines with
//! a character that means nothing keep their spacing.

use super::lexer::{Token, TokenKind, tokens};
use super::words;
use crate::text::Lines;
use std::collections::HashSet;

const STEP: usize = 4;
/// Between code and a comment behind it.
const BEFORE_COMMENT: &str = "  ";
/// Steps of indentation beyond which a text of short lines would be many times as long.
const DEEPEST: usize = 20;

/// A block that is open at a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Open {
    Block,
    Select,
    Case,
}

/// The text in our style. Formatting it again changes nothing, and it compiles to the same program. One that is too long for a program comes
/// back as it is.
#[must_use]
pub fn format(text: &str) -> String {
    if crate::mcl::too_long(text).is_some() {
        return text.to_owned();
    }
    let (tokens, wrong) = tokens(text);
    let lines = Lines::of(text);
    let broken: HashSet<u32> = wrong.iter().map(|wrong| lines.line_of(wrong.span.start)).collect();
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut open: Vec<Open> = Vec::new();
    let mut page = String::with_capacity(text.len());
    let mut empty = 0;
    let mut rest = &tokens[..];
    for line in 1..=lines.count() {
        let split =
            rest.iter().position(|token| lines.line_of(token.span.start) > line).unwrap_or(rest.len());
        let (here, after) = rest.split_at(split);
        rest = after;
        let here: Vec<Token> = here
            .iter()
            .copied()
            .filter(|token| !matches!(token.kind, TokenKind::Newline | TokenKind::End))
            .collect();
        let depth = depth(text, &here, &mut open);
        let body = match broken.contains(&line) {
            true => lines.text_of(text, line).trim().to_owned(),
            false => spaced(text, &here),
        };
        if body.is_empty() {
            empty += 1;
            continue;
        }
        // Empty lines stay, but for those at the end.
        page.extend(std::iter::repeat_n(end, empty));
        empty = 0;
        page.extend(std::iter::repeat_n(' ', depth.min(DEEPEST) * STEP));
        page += &body;
        page += end;
    }
    page
}

/// How deep a line stands, by the blocks that are open before it and those that it ends; those that it begins are open afterwards.
fn depth(text: &str, line: &[Token], open: &mut Vec<Open>) -> usize {
    let small = |at: usize| {
        let word = line.get(at).filter(|token| token.kind == TokenKind::Word);
        word.map(|token| token.span.of(text)).filter(|word| word.len() <= 64).map(str::to_ascii_lowercase)
    };
    let first = small(0).unwrap_or_default();
    let second = small(1).unwrap_or_default();
    let code = line.iter().rev().find(|token| token.kind != TokenKind::Comment);
    let ends_with_then = code.is_some_and(|last| last.span.of(text).eq_ignore_ascii_case("then"));
    match (first.as_str(), second.as_str()) {
        ("end", "select") => {
            if open.last() == Some(&Open::Case) {
                open.pop();
            }
            open.pop();
        }
        ("end", "loop" | "while" | "if" | "program" | "function" | "eventhandler" | "datatable")
        | ("until", _) => {
            open.pop();
        }
        ("else", _) => return open.len().saturating_sub(1),
        ("case", _) => {
            if open.last() == Some(&Open::Case) {
                open.pop();
            }
            let depth = open.len();
            if open.last() == Some(&Open::Select) {
                open.push(Open::Case);
            }
            return depth;
        }
        _ => {}
    }
    let depth = open.len();
    match (first.as_str(), second.as_str()) {
        ("select", _) => open.push(Open::Select),
        ("begin", "program")
        | ("declare", "function" | "eventhandler" | "datatable")
        | ("loop" | "do" | "while", _) => {
            open.push(Open::Block);
        }
        ("if", _) if ends_with_then => open.push(Open::Block),
        _ => {}
    }
    depth
}

/// The tokens of a line with one space where one helps.
fn spaced(text: &str, line: &[Token]) -> String {
    let mut body = String::new();
    for (at, token) in line.iter().enumerate() {
        let piece = token.span.of(text).trim_end();
        if at > 0 {
            match token.kind {
                TokenKind::Comment => body += BEFORE_COMMENT,
                TokenKind::Word
                | TokenKind::Number(_)
                | TokenKind::Text
                | TokenKind::Sign(_)
                | TokenKind::Newline
                | TokenKind::End => {
                    if has_space(text, &line[..at], *token) {
                        body.push(' ');
                    }
                }
            }
        }
        body += piece;
    }
    body
}

/// Whether a space stands between what is before and a token.
fn has_space(text: &str, before: &[Token], token: Token) -> bool {
    let Some(last) = before.last() else { return false };
    let is_keyword = |token: &Token| {
        let word = token.span.of(text);
        token.kind == TokenKind::Word
            && word.len() <= 64
            && words::is_reserved(&word.to_ascii_lowercase())
            && !words::FUNCTIONS.iter().any(|row| row.name.eq_ignore_ascii_case(word))
    };
    match (last.kind, token.kind) {
        (_, TokenKind::Sign("," | ")")) | (TokenKind::Sign("("), _) => false,
        (TokenKind::Word, TokenKind::Sign("(")) => is_keyword(last),
        (TokenKind::Sign("-"), _) => {
            // A minus before a value stands by it.
            match before.len().checked_sub(2).map(|at| &before[at]) {
                None => false,
                Some(earlier) => match earlier.kind {
                    TokenKind::Sign(sign) => sign == ")",
                    TokenKind::Word => !is_keyword(earlier),
                    TokenKind::Number(_) | TokenKind::Text => true,
                    TokenKind::Comment | TokenKind::Newline | TokenKind::End => true,
                },
            }
        }
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_is_indented_by_its_blocks_and_stays_so() {
        let text = "begin program   ;main\nselect case a\ncase 1 call f( 1,-2 )\ncase else\nif (a>1) then\nb=a-1\nelse\nb = -1\nend if\nend select\n\n\nend program\n\n\n";
        let expected = "\
begin program  ;main
    select case a
        case 1 call f(1, -2)
        case else
            if (a > 1) then
                b = a - 1
            else
                b = -1
            end if
    end select


end program
";
        assert_eq!(format(text), expected);
        assert_eq!(format(expected), expected);
        assert_eq!(format("a = ?\r\n"), "a = ?\r\n");
    }
}
