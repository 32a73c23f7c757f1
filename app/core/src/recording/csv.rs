//! Recordings as comma separated values (RFC 4180), one line per sample.
//!
//! The first columns are `utc` (date and time of the last reply), `time_s` (the same since the beginning),
//! `requested_s` and `replied_s` of the sweep, `mark` (`gap`, or the kind of a mark) and `note`. Then comes one column for each
//! signal, `M1 PWM (%)`, empty where it was not read. Behind them stand the times of each reading: `M1 PWM requested (s)`
//! and `M1 PWM replied (s)`, or `M1 PWM at (s)` where only that is known.
//!
//! Read is any file whose first line names its columns and one of them the time.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::time::{Duration, SystemTime};

use super::{Column, Head, Reading, Record, RecordingError};
use crate::messages::{DamageMessage, RecordingMessage};
use brushwork_link::Message;
use brushwork_link::bounded::BoundedLines;

/// Names of the columns before the signals.
const FIRST: [&str; 6] = ["utc", "time_s", "requested_s", "replied_s", "mark", "note"];

/// Names that a column of times may have, in lower case, with what one of its units is in microseconds.
const TIME_NAMES: [(&str, f64); 12] = [
    ("time_s", 1e6),
    ("time (s)", 1e6),
    ("time[s]", 1e6),
    ("time [s]", 1e6),
    ("t_s", 1e6),
    ("seconds", 1e6),
    ("time", 1e6),
    ("t", 1e6),
    ("timestamp", 1e6),
    ("time_ms", 1e3),
    ("time (ms)", 1e3),
    ("time_us", 1.0),
];

/// What a line of marks says where data was lost.
const GAP: &str = "gap";

const REMEDY: &str = "Mend that line, or choose another file";
const REMEDY_HEAD: &str = "The first line has to name the columns, one of them time_s";

/// Which times of a reading are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Times {
    /// Of its request and of its reply.
    Exchange,
    /// When it was read.
    At,
}

/// Writes records as lines.
pub struct CsvWriter<W: Write> {
    out: csv::Writer<W>,
    began: SystemTime,
    columns: usize,
    times: Times,
    fields: Vec<String>,
}

impl<W: Write> CsvWriter<W> {
    /// Writes the first line.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn new(out: W, head: &Head, times: Times) -> std::io::Result<Self> {
        let mut out = csv::Writer::from_writer(out);
        let mut names: Vec<String> = FIRST.iter().map(|name| (*name).to_owned()).collect();
        names.extend(head.columns.iter().map(|column| match column.unit.as_str() {
            "" => column.label.clone(),
            unit => format!("{} ({unit})", column.label),
        }));
        for column in &head.columns {
            match times {
                Times::At => names.push(format!("{} at (s)", column.label)),
                Times::Exchange => {
                    names.push(format!("{} requested (s)", column.label));
                    names.push(format!("{} replied (s)", column.label));
                }
            }
        }
        out.write_record(&names)?;
        let fields = vec![String::new(); names.len()];
        Ok(Self { out, began: head.began, columns: head.columns.len(), times, fields })
    }

    /// Writes one line.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, record: &Record) -> std::io::Result<()> {
        self.fields.iter_mut().for_each(String::clear);
        let end_us = record.ends_us();
        self.fields[0] =
            humantime::format_rfc3339_micros(self.began + Duration::from_micros(end_us)).to_string();
        self.fields[1] = seconds(end_us);
        match record {
            Record::Sample(readings) => {
                self.fields[2] = seconds(record.begins_us());
                self.fields[3] = seconds(end_us);
                for reading in readings.iter().filter(|reading| reading.column < self.columns) {
                    put(&mut self.fields, self.columns, self.times, reading);
                }
            }
            Record::Gap { .. } => self.fields[4].push_str(GAP),
            Record::Mark { kind, text, .. } => {
                self.fields[4].clone_from(kind);
                self.fields[5].clone_from(text);
            }
        }
        self.out.write_record(&self.fields)?;
        Ok(())
    }

    /// Hands everything over to the system.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

/// Enters a reading into the fields of a line.
fn put(fields: &mut [String], columns: usize, times: Times, reading: &Reading) {
    let first = FIRST.len();
    fields[first + reading.column] = reading.value.to_string();
    let place = first + columns;
    match times {
        Times::At => {
            let at_us = reading.requested_us + reading.replied_us.saturating_sub(reading.requested_us) / 2;
            fields[place + reading.column] = seconds(at_us);
        }
        Times::Exchange => {
            fields[place + 2 * reading.column] = seconds(reading.requested_us);
            fields[place + 2 * reading.column + 1] = seconds(reading.replied_us);
        }
    }
}

fn seconds(us: u64) -> String {
    format!("{}.{:06}", us / 1_000_000, us % 1_000_000)
}

/// What a column of a file holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Role {
    Time { us: f64 },
    Utc,
    Mark,
    Note,
    Value(usize),
    Requested(usize),
    Replied(usize),
    Ignored,
}

/// No line is longer: a recording of every channel of this program has a line of some 2 KiB, and foreign ones have more columns.
const MOST_LINE_BYTES: u64 = 1 << 20;

/// Reads a whole file. `take` gets one record after the other, and stops the reading by giving `false`. The answer is a sentence about a
/// last line that was cut off, as a power loss leaves it: what stands before it was read.
///
/// # Errors
/// The file cannot be read, or a line is not as it should be.
pub fn read(
    input: impl Read,
    path: &str,
    mut begin: impl FnMut(&Head),
    mut take: impl FnMut(Record) -> bool,
) -> Result<Option<Message>, RecordingError> {
    let mut input = BufReader::with_capacity(1 << 16, input);
    let delimiter = delimiter_of(&mut input).map_err(|source| io(path, source))?;
    let lines = BoundedLines::new(input, MOST_LINE_BYTES);
    let mut reader = csv::ReaderBuilder::new().delimiter(delimiter).from_reader(lines);
    let names = reader.headers().map_err(|error| broken(path, &error))?.clone();
    let (columns, roles) = roles_of(path, &names)?;
    // Each line of such a file has an end, so that one without may lack the last digits of its last number.
    let is_own = names.iter().zip(FIRST).filter(|(name, first)| name == first).count() == FIRST.len();
    let mut line = csv::StringRecord::new();
    let (mut began, mut cut_off) = (None, None);
    let mut last_us = 0;
    loop {
        let read = reader.read_record(&mut line).map_err(|error| broken(path, &error));
        if matches!(read, Ok(false)) {
            break;
        }
        let number = line.position().map_or(0, csv::Position::line);
        let parse =
            |_| Line::parse(&line, &roles, &names, delimiter).map_err(|what| at_line(path, number, what));
        let parsed = read.and_then(parse);
        let has_no_end = reader.get_ref().ended_within_a_line();
        if has_no_end && (is_own || (parsed.is_err() && began.is_some())) {
            let seconds = last_us as f64 / 1e6;
            cut_off = Some(RecordingMessage::InPart { damage: DamageMessage::CutOffInLine, seconds }.into());
            break;
        }
        let parsed = parsed?;
        if began.is_none() {
            let utc = parsed.utc.unwrap_or(SystemTime::UNIX_EPOCH);
            let start = utc.checked_sub(Duration::from_micros(parsed.time_us)).unwrap_or(utc);
            begin(&Head { columns: columns.clone(), began: *began.insert(start), device: String::new() });
        }
        if parsed.mark.is_empty() {
            if parsed.time_us < last_us {
                let (this, above) = (seconds(parsed.time_us), seconds(last_us));
                let what = format!("its time, {this} s, is before that of the line above, {above} s");
                return Err(at_line(path, number, what));
            }
            last_us = parsed.time_us;
        }
        if !take(parsed.record()) {
            return Ok(None);
        }
    }
    if began.is_none() {
        Err(at_line(path, 2, "there is no line with values".to_owned()))
    } else {
        Ok(cut_off)
    }
}

/// The delimiter that the first line has most of.
fn delimiter_of(input: &mut impl BufRead) -> std::io::Result<u8> {
    let start = input.fill_buf()?;
    let first = start.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let count = |delimiter: u8| first.iter().filter(|byte| **byte == delimiter).count();
    Ok([b',', b';', b'\t']
        .into_iter()
        .max_by_key(|delimiter| (count(*delimiter), *delimiter == b','))
        .unwrap_or(b','))
}

/// What each column is, and what signals there are.
fn roles_of(path: &str, names: &csv::StringRecord) -> Result<(Vec<Column>, Vec<Role>), RecordingError> {
    let clean: Vec<String> =
        names.iter().map(|name| name.trim().trim_start_matches('\u{feff}').to_owned()).collect();
    let time = TIME_NAMES.iter().find_map(|(wanted, us)| {
        clean.iter().position(|name| name.to_lowercase() == *wanted).map(|index| (index, *us))
    });
    let Some((time, us)) = time else {
        let what = format!(
            "no column is called time_s, time, t, seconds or timestamp, there are only: {}",
            clean.join(", ")
        );
        return Err(RecordingError::Line {
            path: path.to_owned(),
            line: 1,
            what: shortened(&what),
            remedy: REMEDY_HEAD,
        });
    };
    let mut columns: Vec<Column> = Vec::new();
    let mut roles: Vec<Role> = Vec::new();
    let is_time_of =
        |name: &str, ending: &str| name.strip_suffix(ending).map(|label| label.trim().to_owned());
    let endings = [" requested (s)", " replied (s)", " at (s)"];
    for (index, name) in clean.iter().enumerate() {
        roles.push(match name.to_lowercase().as_str() {
            _ if index == time => Role::Time { us },
            "utc" => Role::Utc,
            "mark" => Role::Mark,
            "note" => Role::Note,
            "" | "requested_s" | "replied_s" => Role::Ignored,
            _ if endings.iter().any(|ending| name.ends_with(ending)) => Role::Ignored,
            _ => {
                columns.push(named(name));
                Role::Value(columns.len() - 1)
            }
        });
    }
    let by_label: HashMap<&str, usize> =
        columns.iter().enumerate().map(|(index, column)| (column.label.as_str(), index)).collect();
    for (role, name) in roles.iter_mut().zip(&clean) {
        for (ending, is_request) in [(endings[0], true), (endings[1], false), (endings[2], false)] {
            if let Some(index) =
                is_time_of(name, ending).and_then(|label| by_label.get(label.as_str()).copied())
            {
                *role = if is_request { Role::Requested(index) } else { Role::Replied(index) };
            }
        }
    }
    if columns.is_empty() {
        let what = "there is no column besides the time".to_owned();
        return Err(RecordingError::Line { path: path.to_owned(), line: 1, what, remedy: REMEDY_HEAD });
    }
    Ok((columns, roles))
}

/// `M1 PWM (%)` is M1 PWM in %.
fn named(name: &str) -> Column {
    let split = name.strip_suffix(')').and_then(|name| name.rsplit_once('('));
    match split {
        Some((label, unit)) if !label.trim().is_empty() => Column::new(label, unit),
        _ => Column::new(name, ""),
    }
}

/// What a line holds.
struct Line {
    time_us: u64,
    utc: Option<SystemTime>,
    mark: String,
    note: String,
    readings: Vec<Reading>,
}

impl Line {
    fn parse(
        line: &csv::StringRecord,
        roles: &[Role],
        names: &csv::StringRecord,
        delimiter: u8,
    ) -> Result<Self, String> {
        let mut parsed =
            Self { time_us: 0, utc: None, mark: String::new(), note: String::new(), readings: Vec::new() };
        let mut times: Vec<(Role, u64)> = Vec::new();
        for ((field, role), name) in line.iter().zip(roles).zip(names) {
            let field = field.trim();
            let number = || number_of(field, name, delimiter);
            match role {
                Role::Time { us } => parsed.time_us = microseconds(number()?, *us, name)?,
                Role::Utc => parsed.utc = humantime::parse_rfc3339_weak(field).ok(),
                Role::Mark => field.clone_into(&mut parsed.mark),
                Role::Note => field.clone_into(&mut parsed.note),
                Role::Ignored => {}
                _ if field.is_empty() => {}
                Role::Value(column) => {
                    let value = number()?;
                    if value.is_finite() {
                        parsed.readings.push(Reading {
                            column: *column,
                            value,
                            requested_us: 0,
                            replied_us: 0,
                        });
                    }
                }
                Role::Requested(_) | Role::Replied(_) => {
                    times.push((*role, microseconds(number()?, 1e6, name)?));
                }
            }
        }
        parsed.date(&times);
        Ok(parsed)
    }

    /// Gives each reading its times: its own, or the line's.
    fn date(&mut self, times: &[(Role, u64)]) {
        for reading in &mut self.readings {
            let of = |role: Role| times.iter().find(|(found, _)| *found == role).map(|(_, us)| *us);
            let (requested, replied) =
                (of(Role::Requested(reading.column)), of(Role::Replied(reading.column)));
            reading.replied_us = replied.unwrap_or(self.time_us);
            reading.requested_us = requested.unwrap_or(reading.replied_us).min(reading.replied_us);
        }
    }

    fn record(self) -> Record {
        let at_us = self.time_us;
        match self.mark.as_str() {
            "" => Record::Sample(self.readings),
            GAP => Record::Gap { at_us },
            _ => Record::Mark { at_us, kind: self.mark, text: self.note },
        }
    }
}

/// A number as this file writes it; with semicolons between fields, a comma may be its point.
fn number_of(field: &str, name: &str, delimiter: u8) -> Result<f64, String> {
    let plain = if delimiter == b';' { field.replace(',', ".") } else { field.to_owned() };
    plain
        .parse()
        .map_err(|_| format!("in the column {name}, \u{201c}{}\u{201d} is no number", shortened(field)))
}

fn microseconds(time: f64, us: f64, name: &str) -> Result<u64, String> {
    let time_us = (time * us).round();
    if !(0.0..1e18).contains(&time_us) {
        return Err(format!("in the column {name}, {time} is no time since a beginning"));
    }
    Ok(time_us as u64)
}

fn shortened(text: &str) -> String {
    const MOST: usize = 120;
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    text.chars().take(MOST).chain(['…']).collect()
}

fn at_line(path: &str, line: u64, what: String) -> RecordingError {
    RecordingError::Line { path: path.to_owned(), line, what, remedy: REMEDY }
}

fn io(path: &str, source: std::io::Error) -> RecordingError {
    RecordingError::Io { path: path.to_owned(), source }
}

/// What the reader of the format has found wrong.
#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
fn broken(path: &str, error: &csv::Error) -> RecordingError {
    let line = error.position().map_or(1, csv::Position::line);
    let what = match error.kind() {
        csv::ErrorKind::Utf8 { .. } => "it is not text in UTF-8".to_owned(),
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("it has {len} fields, and the first line {expected_len}")
        }
        _ => error.to_string(),
    };
    at_line(path, line, what)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<(Option<Head>, Vec<Record>), String> {
        let mut head = None;
        let mut records = Vec::new();
        let take = |record| {
            records.push(record);
            true
        };
        read(text.as_bytes(), "run.csv", |found| head = Some(found.clone()), take)
            .map_err(|error| error.to_string())?;
        Ok((head, records))
    }

    #[test]
    fn the_first_lines_are_as_the_head_of_this_file_says() {
        let head = Head {
            columns: vec![Column::new("M1 PWM", "%"), Column::new("M1 Setpoint", "")],
            began: SystemTime::UNIX_EPOCH + Duration::from_secs(1_800_000_000),
            device: String::new(),
        };
        let mut file = Vec::new();
        let mut writer = CsvWriter::new(&mut file, &head, Times::Exchange).unwrap();
        let reading = Reading { column: 0, value: 12.5, requested_us: 1_000_100, replied_us: 1_002_000 };
        writer.write(&Record::Sample(vec![reading])).unwrap();
        writer
            .write(&Record::Mark { at_us: 1_500_000, kind: "drive".to_owned(), text: "M1, 50 %".to_owned() })
            .unwrap();
        writer.flush().unwrap();
        drop(writer);
        let text = String::from_utf8(file).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[0],
            "utc,time_s,requested_s,replied_s,mark,note,M1 PWM (%),M1 Setpoint,M1 PWM requested (s),M1 PWM replied (s),\
             M1 Setpoint requested (s),M1 Setpoint replied (s)"
        );
        assert_eq!(
            lines[1],
            "2027-01-15T08:00:01.002000Z,1.002000,1.000100,1.002000,,,12.5,,1.000100,1.002000,,"
        );
        assert_eq!(lines[2], "2027-01-15T08:00:01.500000Z,1.500000,,,drive,\"M1, 50 %\",,,,,,");
        let (found, records) = read_text(&text).unwrap();
        assert_eq!(found.unwrap().columns, head.columns);
        assert_eq!(records[0], Record::Sample(vec![reading]));
    }

    #[test]
    fn foreign_files_with_other_names_and_delimiters_are_read() {
        let (head, records) = read_text("Time;speed (rpm)\r\n0,5;12,25\r\n1,0;\r\n").unwrap();
        let column = &head.unwrap().columns[0];
        assert_eq!((column.label.as_str(), column.unit.as_str()), ("speed", "rpm"));
        let reading = Reading { column: 0, value: 12.25, requested_us: 500_000, replied_us: 500_000 };
        assert_eq!(records, [Record::Sample(vec![reading]), Record::Sample(Vec::new())]);
        let (_, records) = read_text("time_ms,a\n250,1\n").unwrap();
        assert_eq!(records[0].ends_us(), 250_000);
    }

    #[test]
    fn a_last_line_that_was_cut_off_is_told_and_those_before_it_are_read() {
        let head = Head {
            columns: vec![Column::new("M1 PWM", "%")],
            began: SystemTime::UNIX_EPOCH + Duration::from_secs(1_800_000_000),
            device: String::new(),
        };
        let mut file = Vec::new();
        let mut writer = CsvWriter::new(&mut file, &head, Times::Exchange).unwrap();
        let sample = |at_us| {
            let reading = Reading { column: 0, value: 12.5, requested_us: at_us, replied_us: at_us + 1900 };
            Record::Sample(vec![reading])
        };
        let records: Vec<Record> = (0..3).map(|number| sample(1_000_000 + number * 10_000)).collect();
        records.iter().for_each(|record| writer.write(record).unwrap());
        writer.flush().unwrap();
        drop(writer);
        let ends: Vec<usize> = (0..file.len()).filter(|at| file[*at] == b'\n').map(|at| at + 1).collect();
        // Of the second line each number of its bytes, of which the last ones leave a shorter last number.
        for cut in ends[1]..ends[3] {
            let mut found = Vec::new();
            let take = |record| {
                found.push(record);
                true
            };
            let note = read(&file[..cut], "run.csv", |_| (), take).unwrap();
            let whole = ends.iter().filter(|end| **end <= cut).count() - 1;
            assert_eq!(found, records[..whole], "{cut}");
            let said = note.map(|note| note.to_string());
            let seconds = 1.0019 + 0.01 * (whole - 1) as f64;
            let wanted = format!(
                "The file ends in the middle of a line after {seconds:.3} s; what stands before that is shown."
            );
            assert_eq!(said, (!ends.contains(&cut)).then_some(wanted), "{cut}");
        }
        // Other programs may leave the last line without an end.
        assert_eq!(read_text("time_s,a\n0.1,5\n0.2,7").unwrap().1.len(), 2);
        assert_eq!(read_text("time_s,a\n0.1,5\n0.2").unwrap().1.len(), 1);
    }

    #[test]
    fn what_is_wrong_with_a_file_is_told_with_its_line() {
        let wrong = |text: &str| read_text(text).unwrap_err();
        assert_eq!(
            wrong("time_s,M1 PWM (%)\n0.1,5\n0.2,abc\n"),
            "Could not open the recording run.csv: line 3: in the column M1 PWM (%), \u{201c}abc\u{201d} is no number. \
             Mend that line, or choose another file."
        );
        assert!(wrong("time_s,a\n0.1,5\n0.2\n").contains("line 3: it has 1 fields, and the first line 2"));
        assert!(wrong("time_s,a\n0.5,5\n0.2,1\n").contains("line 3: its time, 0.200000 s, is before"));
        assert!(wrong("a,b\n1,2\n").contains("line 1: no column is called time_s"));
        assert!(wrong("time_s\n1\n").contains("line 1: there is no column besides the time"));
        assert!(wrong("").contains("line 1"));
        assert!(wrong("time_s,a\n").contains("there is no line with values"));
        assert!(wrong("time_s,a\n-3,1\n").contains("line 2: in the column time_s, -3 is no time"));
        let reported = |bytes: &[u8]| read(bytes, "x", |_| (), |_| true).unwrap_err().to_string();
        assert!(reported(b"time_s,a\n1,2\n2,\xff\xfe\n").contains("line 3: it is not text"));
    }
}
