//! Reports as files: one entry of the record in a line, so that an error can name the place; and what is wrong with a file that is none.

use brushwork_link::Message;
use std::fmt::Write as _;
use std::path::Path;

use brushwork_tuning::report::FORMAT;
use serde::Deserialize;
use serde_json::Value;
use serde_json::error::Category;

use super::law::Report;
use super::page;
use crate::messages::ReportFileMessage;
use brushwork_link::bounded;
use brushwork_link::files::{replace_file, write_new_file};

/// What of a file tells whose it is.
#[derive(Deserialize)]
struct Head {
    format: Option<u32>,
    request: Option<Value>,
    verdict: Option<Value>,
    record: Option<Vec<Value>>,
}

/// A report as the text of its file.
///
/// # Errors
/// Says why a value cannot be written.
pub fn text_of(report: &Report) -> Result<String, Message> {
    let reported = |error: serde_json::Error| Message::error(error);
    let mut fields =
        serde_json::to_value(Report { record: Vec::new(), ..report.clone() }).map_err(reported)?;
    let mut text = "{\n".to_owned();
    if let Some(fields) = fields.as_object_mut() {
        fields.remove("record");
        for (name, value) in fields.iter() {
            // Writing into a string cannot fail.
            let _ = writeln!(text, "\"{name}\":{value},");
        }
    }
    text.push_str("\"record\":[\n");
    for (number, entry) in report.record.iter().enumerate() {
        let separator = if number == 0 { "" } else { ",\n" };
        let _ = write!(text, "{separator}{}", serde_json::to_string(entry).map_err(reported)?);
    }
    text.push_str("\n]}\n");
    Ok(text)
}

/// A report as a file of this name has it: one page with plots where it ends in .html.
///
/// # Errors
/// As [`text_of`].
pub fn text_for(report: &Report, path: &Path) -> Result<String, Message> {
    let is_page = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("html"));
    if is_page { Ok(page::page(report)) } else { text_of(report) }
}

/// Writes a report; `replaces` an older file only where that was agreed to.
///
/// # Errors
/// Says what was tried, why it failed, which may be that the file is there already, and what to do.
pub fn write(report: &Report, path: &Path, replaces: bool) -> Result<(), Message> {
    let write = if replaces { replace_file } else { write_new_file };
    let written =
        text_for(report, path).and_then(|text| write(path, text.as_bytes()).map_err(Message::error));
    written.map_err(|error| ReportFileMessage::NotWritten { path: path.display().to_string(), error }.into())
}

/// Reads a report.
///
/// # Errors
/// Says what was tried, where the file is wrong, and what to do.
pub fn read(path: &Path) -> Result<Report, Message> {
    let reported = |why: ReportFileMessage| {
        ReportFileMessage::NotRead { path: path.display().to_string(), why: why.into() }.into()
    };
    let no_file = |error: std::io::Error| ReportFileMessage::NoFile { error: error.to_string() };
    let text = bounded::read_text(path).map_err(|error| reported(no_file(error)))?;
    parse(&text).map_err(reported)
}

fn parse(text: &str) -> Result<Report, ReportFileMessage> {
    let head: Head = serde_json::from_str(text).map_err(|error| no_json(text, &error))?;
    if let Some(format) = head.format.filter(|format| *format > FORMAT) {
        return Err(ReportFileMessage::Newer { format, known: FORMAT });
    }
    if head.request.is_none() || head.verdict.is_none() || head.record.is_none() {
        let missing = if head.record.is_none() { "record" } else { "request or verdict" };
        return Err(ReportFileMessage::Lacks { missing });
    }
    serde_json::from_str(text).map_err(|error| {
        let (line, column) = (error.line(), error.column());
        let what = bare(&error);
        match field_before(text, line, column) {
            Some(field) => ReportFileMessage::WrongField { line, column, field, what },
            None => ReportFileMessage::WrongValue { line, column, what },
        }
    })
}

fn no_json(text: &str, error: &serde_json::Error) -> ReportFileMessage {
    let (line, column, what) = (error.line(), error.column(), bare(error));
    match error.classify() {
        Category::Eof if text.trim().is_empty() => ReportFileMessage::Empty,
        Category::Eof => ReportFileMessage::CutShort { line, column },
        Category::Data => ReportFileMessage::NoReport { line, column, what },
        Category::Syntax | Category::Io => ReportFileMessage::NoJson { line, column, what },
    }
}

/// What is wrong, without the place that stands at the end of the error's own text.
fn bare(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split_once(" at line ").map_or(text.clone(), |(what, _)| what.to_owned())
}

/// The innermost field whose value was being read at a place: the last name before it in its line.
fn field_before(text: &str, line: usize, column: usize) -> Option<String> {
    let line = text.lines().nth(line.checked_sub(1)?)?;
    let before = line.get(..column.min(line.len())).unwrap_or(line);
    let end = before.rfind("\":")?;
    let start = before[..end].rfind('"')? + 1;
    Some(format!("\"{}\"", &before[start..end]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const REPORT: &str =
        "{\n\"request\":{\"method\":\"velocity\"},\n\"verdict\":\"tuned\",\n\"record\":[\n]}\n";

    fn refused(text: &str) -> String {
        parse(text).expect_err("it is no report").to_string()
    }

    #[test]
    fn each_kind_of_wrong_file_has_its_sentence() {
        for (text, said) in [
            ("", "it is empty"),
            ("profile: yes", "line 1, column 1 is no JSON"),
            (&REPORT[..40], "it is cut short: it ends at line 3, column 5"),
            ("{\"schema\": 1}", "it holds no record, so it is no tuning report"),
            ("{\"record\": []}", "it holds no request or verdict"),
            ("[1, 2]", "line 1"),
            ("{\"format\": 7, \"future\": true}", "form 7, written by a newer Brushwork"),
        ] {
            let sentence = refused(text);
            assert!(sentence.contains(said), "{text:?}: {sentence}");
            assert!(sentence.ends_with('.'), "{sentence}");
        }
    }

    #[test]
    fn a_wrong_value_is_named_by_line_column_and_field() {
        let text = REPORT.replace("\"velocity\"", "\"upwards\"");
        let sentence = refused(&text);
        assert!(sentence.starts_with("line 2, column "), "{sentence}");
        assert!(sentence.contains("field \"method\"") && sentence.contains("upwards"), "{sentence}");
    }
}
