//! From a recording's file to a track, and from a track to CSV.

use brushwork_link::Message;
use brushwork_values::Sentences;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::SystemTime;

use super::marks::{Mark, MarkKind};
use super::scale::Scale;
use super::series::NOT_READ;
use super::track::{ChannelInfo, Track};
use crate::family::all_channels;
use crate::messages::GraphMessage;
use crate::model::channels::graph_channels;
use brushwork_core::recording::csv::{CsvWriter, Times};
use brushwork_core::recording::{Column, Head, Reading, Record, open};

/// Rows that are kept of a file: seven hours at 100 Hz.
const MOST_ROWS: u64 = 2_500_000;

/// What was in a file.
#[derive(Debug)]
pub struct Loaded {
    pub track: Track,
    pub began: Option<SystemTime>,
    /// What was damaged or left out.
    pub note: Option<Message>,
    /// So many of its oldest rows are not in the track.
    pub left_out: u64,
}

/// Reads a file. `rows` counts along; `given_up` ends it.
///
/// # Errors
/// The file cannot be read; the text is a sentence.
pub fn load(path: &Path, rows: &AtomicU64, given_up: &AtomicBool) -> Result<Loaded, Message> {
    load_newest(path, rows, given_up, MOST_ROWS)
}

fn load_newest(
    path: &Path,
    rows: &AtomicU64,
    given_up: &AtomicBool,
    most_rows: u64,
) -> Result<Loaded, Message> {
    let mut head: Option<Head> = None;
    let mut builder: Option<Builder> = None;
    let begun = std::cell::RefCell::new((&mut head, &mut builder));
    let note = open::read(
        path,
        |found| {
            let mut begun = begun.borrow_mut();
            *begun.1 = Some(Builder::new(found, most_rows));
            *begun.0 = Some(found.clone());
        },
        |record| {
            rows.fetch_add(1, Ordering::Relaxed);
            if let Some(builder) = begun.borrow_mut().1.as_mut() {
                builder.take(record);
            }
            !given_up.load(Ordering::Relaxed)
        },
    )
    .map_err(Message::error)?;
    let shown = path.display().to_string();
    let nothing = || Message::from(GraphMessage::NoSample { path: shown.clone() });
    let builder = builder.filter(|builder| !builder.track.history.is_empty()).ok_or_else(nothing)?;
    let began = head.map(|head| head.began).filter(|began| *began > SystemTime::UNIX_EPOCH);
    let left_out =
        builder.pushed.saturating_sub(builder.track.history.rows().end - builder.track.history.rows().start);
    let cut = || GraphMessage::LeftOut { path: shown.clone(), rows: left_out }.into();
    let notes: Vec<Message> = note.into_iter().chain((left_out > 0).then(cut)).collect();
    let note = (!notes.is_empty()).then(|| GraphMessage::Notes { notes: Sentences(notes) }.into());
    Ok(Loaded { track: builder.track, began, note, left_out })
}

struct Builder {
    track: Track,
    values: Vec<f64>,
    times_s: Vec<f64>,
    pushed: u64,
}

impl Builder {
    fn new(head: &Head, most_rows: u64) -> Self {
        let known = graph_channels(&all_channels());
        let channels: Vec<_> = head.columns.iter().map(|column| info_of(column, &known)).collect();
        let count = channels.len();
        let track = Track::new(channels, most_rows);
        Self { track, values: vec![NOT_READ; count], times_s: vec![0.0; count], pushed: 0 }
    }

    fn take(&mut self, record: Record) {
        let end_s = record.ends_us() as f64 / 1e6;
        match record {
            Record::Sample(readings) if readings.is_empty() => {}
            Record::Sample(readings) => {
                self.values.fill(NOT_READ);
                for reading in readings {
                    if let Some(value) = self.values.get_mut(reading.column) {
                        *value = reading.value;
                        let middle_us = reading.requested_us
                            + reading.replied_us.saturating_sub(reading.requested_us) / 2;
                        self.times_s[reading.column] = middle_us as f64 / 1e6;
                    }
                }
                let times_s = &self.times_s;
                self.track.push(end_s, &self.values, |channel| times_s[channel]);
                self.pushed += 1;
            }
            Record::Gap { at_us } => {
                self.track.history.push_gap(at_us as f64 / 1e6);
                self.pushed += 1;
            }
            Record::Mark { at_us, kind, text } => {
                let kind = MarkKind::of_word(&kind).unwrap_or(MarkKind::Note);
                self.track.marks.push(Mark { at_s: at_us as f64 / 1e6, kind, text });
            }
        }
    }
}

/// A known channel is shown as always; of a foreign one only name and unit are known.
fn info_of(column: &Column, known: &[ChannelInfo]) -> ChannelInfo {
    let foreign = || ChannelInfo {
        key: column.key.clone(),
        label: column.label.clone(),
        unit: column.unit.clone(),
        decimals: 3,
        scale: Scale::around_zero(1.0),
        shown: false,
        is_pin: false,
    };
    known.iter().find(|info| info.key == column.key).cloned().unwrap_or_else(foreign)
}

pub fn column_of(info: &ChannelInfo) -> Column {
    Column { key: info.key.clone(), label: info.label.clone(), unit: info.unit.clone() }
}

/// The channels of these keys as CSV, each reading with its own time. Times are counted from `zero_s`, which was at
/// `began`.
///
/// # Errors
/// None in practice: it is written to memory.
pub fn csv_of(track: &Track, keys: &[String], zero_s: f64, began: SystemTime) -> std::io::Result<Vec<u8>> {
    let channels: Vec<usize> =
        (0..track.channels.len()).filter(|index| keys.contains(&track.channels[*index].key)).collect();
    let columns = channels.iter().map(|index| column_of(&track.channels[*index])).collect();
    let mut file = Vec::new();
    let mut writer = CsvWriter::new(&mut file, &Head { columns, began, device: String::new() }, Times::At)?;
    let us = |time_s: f64| ((time_s - zero_s).max(0.0) * 1e6).round() as u64;
    let mut marks = track.marks.iter().peekable();
    for row in track.history.rows() {
        let row_s = track.history.time_s(row);
        while let Some(mark) = marks.next_if(|mark| mark.at_s <= row_s) {
            let (kind, text) = (mark.kind.word().to_owned(), mark.text.clone());
            writer.write(&Record::Mark { at_us: us(mark.at_s), kind, text })?;
        }
        let reading = |(column, channel): (usize, &usize)| {
            let (time_s, value) = track.history.reading(*channel, row)?;
            Some(Reading { column, value, requested_us: us(time_s), replied_us: us(time_s) })
        };
        let readings: Vec<_> = channels.iter().enumerate().filter_map(reading).collect();
        let lost =
            channels.iter().any(|channel| super::series::is_gap(track.history.channel(*channel).value(row)));
        match (readings.is_empty(), lost) {
            (false, _) => writer.write(&Record::Sample(readings))?,
            (true, true) => writer.write(&Record::Gap { at_us: us(row_s) })?,
            (true, false) => {}
        }
    }
    // What happened after the last sample: that the link was lost, say.
    for mark in marks {
        let (kind, text) = (mark.kind.word().to_owned(), mark.text.clone());
        writer.write(&Record::Mark { at_us: us(mark.at_s), kind, text })?;
    }
    writer.flush()?;
    drop(writer);
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_file_that_is_too_long_the_newest_rows_are_kept_and_the_rest_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("long.csv");
        let rows: String = (0..9000).map(|row| format!("{row}.0,{row}\n")).collect();
        std::fs::write(&path, format!("time_s,a\n{rows}")).unwrap();
        let load = |most_rows| {
            load_newest(&path, &AtomicU64::new(0), &AtomicBool::new(false), most_rows).expect("it is sound")
        };
        let whole = load(MOST_ROWS);
        assert_eq!((whole.left_out, whole.note, whole.track.history.rows().end), (0, None, 9000));
        let cut = load(4096);
        assert_eq!((cut.left_out, cut.track.history.rows().end), (9000 - 4096, 9000));
        assert!(cut.note.is_some_and(|note| note.to_string().contains("the oldest 4904 rows are left out")));
    }
}
