//! Which WHILE begins a loop and which ends a DO (MCP manual 3.4.1: "the compiler will get the WHILE statements confused").
//!
//! A WHILE in the innermost DO ends it, unless a WEND further down would then have no WHILE: the latest such WHILE begins a
//! loop after all.

use crate::mcl::lexer::{Token, TokenKind};
use std::collections::BTreeSet;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Open {
    Do,
    While,
    Other,
}

/// The tokens, by index, of the WHILEs that begin a loop.
pub fn heads(text: &str, tokens: &[Token]) -> BTreeSet<usize> {
    let mut heads = BTreeSet::new();
    let mut open: Vec<Open> = Vec::new();
    // WHILEs that were taken for the end of a DO, and how many blocks were open after that: never fewer than at the one before.
    let mut closers: Vec<(usize, usize)> = Vec::new();
    for (index, token) in tokens.iter().enumerate().filter(|(_, token)| token.kind == TokenKind::Word) {
        match token.span.of(text).to_ascii_lowercase().as_str() {
            "do" => open.push(Open::Do),
            "repeat" | "for" => open.push(Open::Other),
            "until" | "next" => close(&mut open, Open::Other),
            "while" if open.last() == Some(&Open::Do) => {
                open.pop();
                close_inner(&mut closers, open.len());
                closers.push((index, open.len()));
            }
            "while" => {
                heads.insert(index);
                open.push(Open::While);
            }
            "wend" if open.last() == Some(&Open::While) => close(&mut open, Open::While),
            "wend" => reopen(&mut heads, &mut open, &mut closers),
            _ => {}
        }
        close_inner(&mut closers, open.len());
    }
    heads
}

/// Forgets those in blocks that are closed.
fn close_inner(closers: &mut Vec<(usize, usize)>, depth: usize) {
    while closers.pop_if(|(_, inner)| *inner > depth).is_some() {}
}

fn close(open: &mut Vec<Open>, kind: Open) {
    if open.last() == Some(&kind) {
        open.pop();
    }
}

/// A WEND without a WHILE: the last WHILE that ended a DO at this depth was the beginning of a loop in that DO.
fn reopen(heads: &mut BTreeSet<usize>, open: &mut Vec<Open>, closers: &mut Vec<(usize, usize)>) {
    if let Some((index, _)) = closers.pop_if(|(_, depth)| *depth == open.len()) {
        heads.insert(index);
        open.push(Open::Do);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mcl::lexer::tokens;

    /// For each WHILE in order: whether it begins a loop.
    fn begins(text: &str) -> Vec<bool> {
        let (tokens, _) = tokens(text);
        let heads = heads(text, &tokens);
        let is_while = |token: &Token| token.span.of(text).eq_ignore_ascii_case("while");
        let whiles = tokens.iter().enumerate().filter(|(_, token)| is_while(token));
        whiles.map(|(index, _)| heads.contains(&index)).collect()
    }

    #[test]
    fn a_while_after_do_ends_it() {
        assert_eq!(begins("do\nx\nwhile a"), [false]);
        assert_eq!(begins("do\ndo\nwhile a\nwhile b"), [false, false]);
    }

    #[test]
    fn a_while_with_its_own_wend_is_a_loop_also_inside_do() {
        assert_eq!(begins("while a\nwend"), [true]);
        assert_eq!(begins("do\nwhile a\nwend\nwhile b"), [true, false]);
        assert_eq!(begins("while a\ndo\nwhile b\nwend"), [true, false]);
        assert_eq!(begins("do\nwhile a\nwend\ndo\nwhile b\nwhile c"), [true, false, false]);
        // Either WHILE could begin the loop here; the nearest to the WEND does.
        assert_eq!(begins("do\nwhile a\ndo\nwhile b\nwend\nwhile c"), [false, true, false]);
    }
}
