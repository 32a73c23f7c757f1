//! Source text in one style: indentation by blocks, one space where one helps. Nothing else changes: no token, no comment, no line.
//!
//! Labels and directives stand at the margin, what follows a label one step in, and each block one step further. Lines with a character
//! that means nothing keep their spacing.

use super::index::{Block, BlockKind, blocks};
use super::lexer::{Token, TokenKind, tokens};
use super::lower::too_long;
use super::types::{TABLES, VarType};
use super::words::{self, Known};
use crate::text::Lines;
use std::collections::HashSet;

const STEP: usize = 4;
/// Between code and a comment behind it.
const BEFORE_COMMENT: &str = "  ";

/// The text in our style. Formatting it again changes nothing, and it compiles to the same program. One that is too long for a program comes
/// back as it is.
#[must_use]
pub fn format(text: &str) -> String {
    if too_long(text).is_some() {
        return text.to_owned();
    }
    let (tokens, wrong) = tokens(text);
    let lines = Lines::of(text);
    let broken: HashSet<u32> = wrong.iter().map(|wrong| lines.line_of(wrong.span.start)).collect();
    drop(wrong);
    let depths = depths(text, &tokens, &lines);
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut pieces: Vec<(Kind, String)> = Vec::new();
    let mut rest = &tokens[..];
    for line in 1..=lines.count() {
        let split =
            rest.iter().position(|token| lines.line_of(token.span.start) > line).unwrap_or(rest.len());
        let (here, after) = rest.split_at(split);
        rest = after;
        let shown = lines.text_of(text, line);
        let from = lines.start_of(line) as usize;
        let here: Vec<&Token> =
            here.iter().filter(|token| !matches!(token.kind, TokenKind::Newline | TokenKind::End)).collect();
        let body =
            if broken.contains(&line) { shown.trim().to_owned() } else { spaced(text, from, shown, &here) };
        pieces.push((kind(text, &here, &body), body));
    }
    // A line end behind the last line, and no empty lines there.
    while pieces.last().is_some_and(|(_, body)| body.is_empty()) {
        pieces.pop();
    }
    indented(&pieces, &depths, end)
}

/// Steps of indentation beyond which a line would begin outside of a window of 80 columns, and a text of short lines would be many times as long.
const DEEPEST: usize = 20;

/// What a line is, for its indentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Empty,
    Comment,
    Label,
    Directive,
    Definition,
    Statement,
}

fn kind(text: &str, tokens: &[&Token], body: &str) -> Kind {
    let Some(first) = tokens.first() else {
        return if body.is_empty() { Kind::Empty } else { Kind::Comment };
    };
    if matches!(first.kind, TokenKind::Directive(_)) {
        return Kind::Directive;
    }
    let word = first.span.of(text);
    if first.kind != TokenKind::Word || words::is_reserved(word) {
        return Kind::Statement;
    }
    match tokens.get(1).map(|token| (&token.kind, token.span.of(text))) {
        None | Some((TokenKind::Sign("[" | ":"), _)) => Kind::Label,
        Some((TokenKind::Word, second)) if defines(second) => Kind::Definition,
        _ => Kind::Statement,
    }
}

fn defines(word: &str) -> bool {
    ["var", "con", "fcon"].iter().any(|define| define.eq_ignore_ascii_case(word))
        || TABLES.iter().any(|(table, _)| table.eq_ignore_ascii_case(word))
}

/// How many blocks each line is in, by line from 0; the words of a block are outside it.
fn depths(text: &str, tokens: &[Token], lines: &Lines) -> Vec<usize> {
    let count = lines.count() as usize;
    let mut changes = vec![0i32; count + 2];
    let inside = |block: &Block, changes: &mut Vec<i32>| {
        let of = |at: usize| block.words.get(at).map(|word| lines.line_of(word.start) as usize);
        for index in 1..block.words.len() {
            if let (Some(from), Some(to)) = (of(index - 1), of(index))
                && from + 1 < to
            {
                changes[from] += 1;
                changes[to - 1] -= 1;
            }
        }
    };
    let blocks = blocks(text, tokens);
    blocks
        .iter()
        .filter(|block| block.is_closed && block.kind != BlockKind::Directive)
        .for_each(|block| inside(block, &mut changes));
    let mut depth = 0;
    let mut add = |change: &i32| {
        depth += change;
        usize::try_from(depth).unwrap_or(0)
    };
    changes[..count].iter().map(&mut add).collect()
}

/// The lines with their indentation; a comment stands like the line after it.
fn indented(pieces: &[(Kind, String)], depths: &[usize], end: &str) -> String {
    let mut steps = Vec::with_capacity(pieces.len());
    let mut under_label = false;
    for ((kind, _), depth) in pieces.iter().zip(depths) {
        under_label |= *kind == Kind::Label && *depth == 0;
        steps.push(match kind {
            Kind::Label | Kind::Directive | Kind::Empty => 0,
            Kind::Definition if *depth == 0 => 0,
            Kind::Comment | Kind::Definition | Kind::Statement => {
                (depth + usize::from(under_label)).min(DEEPEST)
            }
        });
    }
    let mut after = 0;
    for ((kind, _), steps) in pieces.iter().zip(&mut steps).rev() {
        match kind {
            Kind::Comment => *steps = after,
            Kind::Empty => {}
            Kind::Label | Kind::Directive | Kind::Definition | Kind::Statement => after = *steps,
        }
    }
    let mut page = String::new();
    for ((_, body), steps) in pieces.iter().zip(steps) {
        if !body.is_empty() {
            page += &" ".repeat(steps * STEP);
            page += body;
        }
        page += end;
    }
    page
}

/// A line's tokens with our spacing, and its comment.
fn spaced(text: &str, from: usize, shown: &str, tokens: &[&Token]) -> String {
    let mut line = String::new();
    for (index, token) in tokens.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| tokens[before]);
        if before.is_some_and(|before| is_space(text, tokens, index, before)) {
            line.push(' ');
        }
        line += token.span.of(text);
    }
    let code_end = tokens.last().map_or(0, |last| last.span.end as usize);
    let comment = text.get(code_end.max(from)..from + shown.len()).unwrap_or("").trim();
    if !comment.is_empty() {
        if !line.is_empty() {
            line += BEFORE_COMMENT;
        }
        line += comment;
    }
    line
}

/// Whether a space stands before token `index`.
fn is_space(text: &str, tokens: &[&Token], index: usize, before: &Token) -> bool {
    let token = tokens[index];
    let touched = before.span.end == token.span.start;
    match (&before.kind, &token.kind) {
        (_, TokenKind::Sign("," | ")" | "]" | "." | "\\")) => false,
        (TokenKind::Sign("(" | "[" | "." | "\\" | "~" | "!"), _) => false,
        (TokenKind::Sign("-"), _) if is_before_operand(text, tokens, index - 1) => false,
        (TokenKind::Sign(","), _) => true,
        (_, TokenKind::Sign(":")) => index > 1,
        (TokenKind::Word, TokenKind::Sign("(" | "[")) => {
            let word = before.span.of(text);
            match words::known(word) {
                Some(Known::Command(_)) => true,
                Some(Known::Operator(row)) => row.order() > 1 || !touched,
                Some(Known::Format(_)) => !touched,
                _ => false,
            }
        }
        (TokenKind::Sign(")"), TokenKind::Sign("[")) => false,
        _ => true,
    }
}

/// Whether the minus at `index` belongs to what follows it.
fn is_before_operand(text: &str, tokens: &[&Token], index: usize) -> bool {
    let Some(before) = index.checked_sub(1).map(|before| tokens[before]) else { return true };
    match &before.kind {
        TokenKind::Sign(")" | "]") | TokenKind::Integer(_) | TokenKind::Float(_) | TokenKind::Text(_) => {
            false
        }
        TokenKind::Word => {
            let word = before.span.of(text);
            let is_value = !words::is_reserved(word)
                || matches!(words::known(word), Some(Known::Register(_) | Known::Misspelt(_)));
            !is_value || VarType::lookup(word).is_some() || super::ast::Format::of_word(word).is_some()
        }
        TokenKind::Directive(_) | TokenKind::Sign(_) | TokenKind::Newline | TokenKind::End => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_indented_and_tokens_spaced() {
        let text = "\
; counts
value   VAR byte;a byte
main
if value=-3+(value*2)-1 then ;;odd
    ; inside
puts 0 ,[ dec2 value\\2,\"a , b\",rep \"-\" \\ 3 , - 1 ]
else
gosub add[ 1,abs (-2) ] ,value
endif
#IF 1
while(value<3)
value.byte0=value-1
wend
#ENDIF
goto main

add[value]
return value

";
        let expected = "\
; counts
value VAR byte  ;a byte
main
    if value = -3 + (value * 2) - 1 then  ;;odd
        ; inside
        puts 0, [dec2 value\\2, \"a , b\", rep \"-\"\\3, -1]
    else
        gosub add[1, abs (-2)], value
    endif
#IF 1
    while (value < 3)
        value.byte0 = value - 1
    wend
#ENDIF
    goto main

add[value]
    return value
";
        assert_eq!(format(text), expected);
        assert_eq!(format(expected), expected);
    }

    #[test]
    fn what_is_wrong_stays_as_it_is() {
        assert_eq!(format("a  =  1 ?  2"), "a  =  1 ?  2\n");
        assert_eq!(format("if a then\nfor b"), "if a then\nfor b\n");
        assert_eq!(format(""), "");
        assert_eq!(format("a = 1\r\n b = 2"), "a = 1\r\nb = 2\r\n");
    }
}
