//! One style for macro files: what a line says stays, how it is written is always the same.

use super::lexer::{Kind, Token, tokens};
use super::parser::{Operand, Statement, lines, statements};
use brushwork_suprmotr_wire::Mnemonic;

const INDENT: &str = "    ";

/// The file in one style: capitals for commands, a space before a number, four spaces before commands, at most one empty line in sequence. A
/// line that is not understood stays as it is, but for blanks at its end.
pub fn format(text: &str) -> String {
    let mut page = String::with_capacity(text.len());
    let mut is_in_macro = false;
    let mut is_after_gap = true;
    for (_, line) in lines(text) {
        let line = line.trim_end();
        if line.is_empty() {
            is_after_gap = is_after_gap || page.is_empty() || page.ends_with("\n\n");
            if !is_after_gap {
                page.push('\n');
            }
            is_after_gap = true;
            continue;
        }
        is_after_gap = false;
        let (formatted, begins_macro) = one(line, is_in_macro);
        is_in_macro |= begins_macro;
        page += &formatted;
        page.push('\n');
    }
    let kept = page.trim_end_matches('\n').len();
    page.truncate(kept);
    if !page.is_empty() {
        page.push('\n');
    }
    page
}

/// A line in the one style, and whether it begins a macro.
fn one(line: &str, is_in_macro: bool) -> (String, bool) {
    let comment = tokens(line, 0).into_iter().rfind(|token| token.kind == Kind::Comment);
    let said = statement(line);
    let begins_macro = matches!(said, Some(Said::Header { is_macro: true, .. }));
    let body = match said {
        None if comment.is_some_and(|comment| line.trim_start() == comment.text) => String::new(),
        None => return (line.to_owned(), false),
        Some(Said::Header { text, .. }) => text,
        Some(Said::Commands(text)) => format!("{INDENT}{text}"),
    };
    let Some(comment) = comment.map(tidied) else { return (body, begins_macro) };
    if !body.is_empty() {
        return (format!("{body}  {comment}"), begins_macro);
    }
    // A comment of its own line stands as far in as it stood: with the commands, or with the macros.
    let indent = if is_in_macro && line.starts_with([' ', '\t']) { INDENT } else { "" };
    (format!("{indent}{comment}"), false)
}

enum Said {
    Header { text: String, is_macro: bool },
    Commands(String),
}

fn statement(line: &str) -> Option<Said> {
    let mut said = Vec::new();
    let found = statements(line, &mut said);
    if !said.is_empty() {
        return None;
    }
    Some(match found.first()? {
        Statement::Macro { name, number: None, .. } => {
            Said::Header { text: format!("macro {name}"), is_macro: true }
        }
        Statement::Macro { name, number: Some((number, _)), .. } => {
            Said::Header { text: format!("macro {name} = {number}"), is_macro: true }
        }
        Statement::Const { name, number, .. } => {
            Said::Header { text: format!("const {name} = {number}"), is_macro: false }
        }
        Statement::Commands(commands) => {
            let words = commands.iter().map(|command| {
                let letters = <[u8; 2]>::try_from(command.letters.as_bytes()).ok();
                let name =
                    letters.and_then(Mnemonic::from_letters).map_or(command.letters, |known| known.name());
                match command.operand {
                    None => name.to_owned(),
                    Some((Operand::Number(number), _)) => format!("{name} {number}"),
                    Some((Operand::Name(operand), _)) => format!("{name} {operand}"),
                }
            });
            Said::Commands(words.collect::<Vec<_>>().join(", "))
        }
    })
}

fn tidied(comment: Token<'_>) -> String {
    let said = comment.text.trim_start_matches('#');
    let marks = &comment.text[..comment.text.len() - said.len()];
    let said = said.trim();
    if said.is_empty() { marks.to_owned() } else { format!("{marks} {said}") }
}
