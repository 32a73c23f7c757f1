//! An examination for people: what an owner reads before he sends it.

use super::report::{Answer, Examination, RawWrite, State};
use std::fmt::Write as _;

/// Letters of a line, and how far what belongs to something is indented.
const WIDTH: usize = 100;
const INDENT: &str = "    ";

impl Examination {
    /// As plain text.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("Examination of a motor controller by {}\n\n", self.program);
        let unit = &self.unit;
        let mut row =
            |name: &str, value: &str| push(&mut text, &format!("{name:<14}{value}"), "              ");
        row("Calls itself", &unit.version_text);
        row("Model", unit.model.as_deref().unwrap_or("not known to this program"));
        row("Firmware", &format!("{} (generation {})", unit.firmware, unit.generation));
        row("Protocol", &unit.protocol);
        row("Line", &self.line_text());
        for note in &unit.oddities {
            row("Note", note);
        }
        for (title, state) in [
            ("Answered", State::Answered),
            ("Asked without a clear answer", State::Unclear),
            ("Not asked", State::NotAsked),
        ] {
            let answers: Vec<_> = self.answers.iter().filter(|answer| answer.state == state).collect();
            if !answers.is_empty() {
                heading(&mut text, title);
                answers.into_iter().for_each(|answer| push_answer(&mut text, answer));
            }
        }
        if !self.not_askable.is_empty() {
            heading(&mut text, "Assumed, and not asked over the wire");
            for row in &self.not_askable {
                push(&mut text, &format!("- {} {}", row.what, row.why), "  ");
            }
        }
        if !self.raw_writes.is_empty() {
            heading(&mut text, "Written raw, at the owner's word");
            let number = |raw: Option<i64>| raw.map_or_else(|| "unknown".to_owned(), |raw| raw.to_string());
            for write in &self.raw_writes {
                let RawWrite { date, key, command, field, wanted, .. } = write;
                let of = write.index.map_or_else(String::new, |index| format!(" of number {index}"));
                let (before, found) = (number(write.before), number(write.found));
                let end = if write.is_open { "cut off before it was read back" } else { "read back" };
                let found = if write.is_open { String::new() } else { format!(" {found}") };
                let line = format!(
                    "- {date} {key}: {wanted} in place of {before} by command {command}, {field}{of}; {end}{found}"
                );
                push(&mut text, &line, "  ");
            }
        }
        if !self.commands.is_empty() {
            heading(&mut text, "Commands");
            text += "NUMBER  ANSWER   BYTES  AS GENERATION  WHAT IT DOES\n";
            for found in &self.commands {
                let bytes = found.reply_bytes.map_or_else(|| "-".to_owned(), |bytes| bytes.to_string());
                let generations: Vec<_> = found.generations.iter().map(u8::to_string).collect();
                let generations =
                    if generations.is_empty() { "-".to_owned() } else { generations.join(", ") };
                // Writing into a string cannot fail.
                let _ = writeln!(
                    text,
                    "{:>6}  {:<8} {bytes:>5}  {generations:<13}  {}",
                    found.command,
                    found.presence.label(),
                    found.title,
                );
            }
        }
        text
    }

    fn line_text(&self) -> String {
        let Some(late) = self.line.lateness else { return "nothing was learned of it".to_owned() };
        let mut text = format!(
            "replies take {:.2} ms beyond their bytes (deviation {:.2}, quickest {:.2}, longest {:.2} ms)",
            late.mean_ms, late.deviation_ms, late.shortest_ms, late.longest_ms
        );
        if let Some(rate) = self.line.requests_per_s {
            text += &format!("; {rate:.0} requests a second");
        }
        if let Some(rate) = self.line.sweeps_per_s {
            text += &format!(", or {rate:.0} times everything that changes quickly");
        }
        text
    }
}

fn heading(text: &mut String, title: &str) {
    let _ = write!(text, "\n{title}\n{}\n", "-".repeat(title.len()));
}

fn push_answer(text: &mut String, answer: &Answer) {
    push(text, &answer.question, INDENT);
    push(text, &format!("{INDENT}{}", answer.worded), INDENT);
    if answer.state != State::NotAsked {
        push(text, &format!("{INDENT}Asked so: {}", answer.how), INDENT);
    }
}

/// Adds a paragraph; lines that follow are indented.
fn push(text: &mut String, paragraph: &str, indent: &str) {
    let mut line = String::new();
    let begins = &paragraph[..paragraph.len() - paragraph.trim_start().len()];
    line.push_str(begins);
    let mut is_empty = true;
    for word in paragraph.split(' ').skip_while(|word| word.is_empty()) {
        if !is_empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            text.push_str(line.trim_end());
            text.push('\n');
            line = indent.to_owned();
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    text.push_str(line.trim_end());
    text.push('\n');
}
