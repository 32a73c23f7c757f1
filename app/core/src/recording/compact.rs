//! Recordings in blocks of differences: about a tenth of the size of CSV, and readable up to a place of damage.
//!
//! The file is a magic number, the head, and blocks. Head and blocks are framed alike: length (4 bytes, little endian),
//! CRC-32 of what follows, and the bytes themselves. The head is JSON: version, columns, device and the beginning in
//! microseconds of Unix time. A block holds records and can be read without those before it: everything below starts
//! anew with each. Whole numbers are written seven bits to a byte, lowest first (LEB128); signed ones as zigzag.
//!
//! | Record | Bytes |
//! | --- | --- |
//! | Gap | 0, time |
//! | Mark | 1, time, length and UTF-8 of kind and of text |
//! | Layout | 2, count, then of each reading its column and the number of its exchange |
//! | Sample | 3 + number of its layout, then of each exchange the time of request and reply, then the values |
//!
//! A time is the signed difference to the time written before it, in microseconds. A value is a number times eight, plus
//! a code. Codes 0 to 4 say that the number is the signed difference to the column's number of that code before, and
//! that the value is that many times the code's step ([`STEPS`]); they are used only where that gives the very same
//! value. Code 7 is followed by the eight bytes of the value, little endian.

use brushwork_link::Message;
use std::collections::HashMap;
use std::io::{Read, Write};
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use super::{Column, Head, Reading, Record, RecordingError};
use crate::messages::{DamageMessage, RecordingMessage};

const MAGIC: [u8; 8] = *b"BWREC\x01\r\n";
const VERSION: u32 = 1;

/// What a value's number is multiplied with, by code: counts, tenths of a volt or degree, hundredths of an ampere,
/// thousandths, and duties of a 15 bit output in %.
pub const STEPS: [f64; 5] = [1.0, 0.1, 0.01, 0.001, 100.0 / 32_767.0];

/// The code of a value that is written whole.
const WHOLE: u64 = 7;

/// A block is closed when it is as long as this.
const BLOCK_BYTES: usize = 32 * 1024;

/// No block or head is longer.
const MOST_BYTES: u32 = 1 << 20;

/// Layouts of one block.
const MOST_LAYOUTS: usize = 256;

const GAP: u64 = 0;
const MARK: u64 = 1;
const LAYOUT: u64 = 2;
const SAMPLE: u64 = 3;

#[derive(Serialize, Deserialize)]
struct HeadForm {
    version: u32,
    began_unix_us: u64,
    device: String,
    columns: Vec<Column>,
}

/// What has been said so far in a block, by writer and reader alike.
#[derive(Default)]
struct State {
    time_us: i64,
    layouts: Vec<Vec<(usize, usize)>>,
    numbers: HashMap<(usize, usize), i64>,
}

/// Writes records as blocks.
pub struct CompactWriter<W: Write> {
    out: W,
    block: Vec<u8>,
    state: State,
}

impl<W: Write> CompactWriter<W> {
    /// Writes the head.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn new(mut out: W, head: &Head) -> std::io::Result<Self> {
        let since = head.began.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let form = HeadForm {
            version: VERSION,
            began_unix_us: u64::try_from(since.as_micros()).unwrap_or(u64::MAX),
            device: head.device.clone(),
            columns: head.columns.clone(),
        };
        out.write_all(&MAGIC)?;
        write_framed(&mut out, &serde_json::to_vec(&form)?)?;
        Ok(Self { out, block: Vec::new(), state: State::default() })
    }

    /// Adds a record to the block, and writes the block when it is full.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, record: &Record) -> std::io::Result<()> {
        match record {
            Record::Gap { at_us } => {
                self.number(GAP);
                self.time(*at_us);
            }
            Record::Mark { at_us, kind, text } => {
                self.number(MARK);
                self.time(*at_us);
                for words in [kind, text] {
                    self.number(words.len() as u64);
                    self.block.extend_from_slice(words.as_bytes());
                }
            }
            Record::Sample(readings) => self.sample(readings),
        }
        if self.block.len() >= BLOCK_BYTES { self.close_block() } else { Ok(()) }
    }

    /// Closes the block and hands everything over to the system.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> std::io::Result<()> {
        self.close_block()?;
        self.out.flush()
    }

    fn close_block(&mut self) -> std::io::Result<()> {
        if self.block.is_empty() {
            return Ok(());
        }
        write_framed(&mut self.out, &self.block)?;
        self.block.clear();
        self.state = State::default();
        Ok(())
    }

    fn sample(&mut self, readings: &[Reading]) {
        let mut exchanges: Vec<(u64, u64)> = Vec::new();
        let mut layout = Vec::with_capacity(readings.len());
        for reading in readings {
            let span = (reading.requested_us, reading.replied_us);
            let known = exchanges.iter().position(|exchange| *exchange == span);
            let exchange = known.unwrap_or_else(|| {
                exchanges.push(span);
                exchanges.len() - 1
            });
            layout.push((reading.column, exchange));
        }
        let number = self.layout(layout);
        self.number(SAMPLE + number as u64);
        for (requested_us, replied_us) in exchanges {
            self.time(requested_us);
            self.time(replied_us);
        }
        readings.iter().for_each(|reading| self.value(reading));
    }

    fn layout(&mut self, layout: Vec<(usize, usize)>) -> usize {
        if let Some(number) = self.state.layouts.iter().position(|known| *known == layout) {
            return number;
        }
        if self.state.layouts.len() >= MOST_LAYOUTS {
            self.state.layouts.clear();
        }
        self.number(LAYOUT);
        self.number(layout.len() as u64);
        for (column, exchange) in &layout {
            self.number(*column as u64);
            self.number(*exchange as u64);
        }
        self.state.layouts.push(layout);
        self.state.layouts.len() - 1
    }

    fn value(&mut self, reading: &Reading) {
        let Some((code, number)) = stepped(reading.value) else {
            self.number(WHOLE);
            return self.block.extend_from_slice(&reading.value.to_le_bytes());
        };
        let before = self.state.numbers.insert((reading.column, code), number).unwrap_or(0);
        self.number(zigzag(number - before) * 8 + code as u64);
    }

    fn time(&mut self, us: u64) {
        let us = us as i64;
        let by = us - std::mem::replace(&mut self.state.time_us, us);
        self.number(zigzag(by));
    }

    fn number(&mut self, mut number: u64) {
        while number >= 0x80 {
            self.block.push(number as u8 | 0x80);
            number >>= 7;
        }
        self.block.push(number as u8);
    }
}

/// The code and number that give exactly this value.
fn stepped(value: f64) -> Option<(usize, i64)> {
    /// Differences of these, times eight, are far from overflowing.
    const MOST: f64 = 1e15;
    STEPS.into_iter().enumerate().find_map(|(code, step)| {
        let number = (value / step).round();
        (number.abs() < MOST && (number as i64 as f64 * step).to_bits() == value.to_bits())
            .then_some((code, number as i64))
    })
}

fn zigzag(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)) as u64
}

fn unzigzag(number: u64) -> i64 {
    (number >> 1) as i64 ^ -((number & 1) as i64)
}

fn write_framed(out: &mut impl Write, bytes: &[u8]) -> std::io::Result<()> {
    let length = u32::try_from(bytes.len()).map_err(|_| std::io::Error::other("a block is too long"))?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&crc32fast::hash(bytes).to_le_bytes())?;
    out.write_all(bytes)
}

/// Reads a whole file. `take` gets one record after the other, and stops the reading by giving `false`. The answer is a
/// sentence about damage, if there was any: what stands before it was read.
///
/// # Errors
/// The file cannot be read, or has no sound head.
pub fn read(
    mut input: impl Read,
    path: &str,
    begin: impl FnOnce(&Head),
    mut take: impl FnMut(Record) -> bool,
) -> Result<Option<Message>, RecordingError> {
    let no_recording = |what: &str| RecordingError::Compact { path: path.to_owned(), what: what.to_owned() };
    let mut magic = [0; MAGIC.len()];
    match input.read_exact(&mut magic) {
        Ok(()) if magic == MAGIC => {}
        Ok(()) => return Err(no_recording("it does not begin like one")),
        Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            return Err(no_recording("it is shorter than the shortest recording"));
        }
        Err(source) => return Err(RecordingError::Io { path: path.to_owned(), source }),
    }
    let head = match read_framed(&mut input) {
        Framed::Sound(bytes) => {
            head_of(&bytes).ok_or_else(|| no_recording("its head is of another version"))?
        }
        Framed::End | Framed::CutOff | Framed::Damaged => return Err(no_recording("its head is damaged")),
    };
    begin(&head);
    let mut last_us = 0;
    loop {
        let damage = match read_framed(&mut input) {
            Framed::End => return Ok(None),
            Framed::Sound(block) => {
                let mut reader = BlockReader { bytes: &block, state: State::default() };
                loop {
                    match reader.record(head.columns.len()) {
                        Ok(Some(record)) => {
                            last_us = record.ends_us();
                            if !take(record) {
                                return Ok(None);
                            }
                        }
                        Ok(None) => break None,
                        Err(Damaged) => break Some(DamageMessage::Senseless),
                    }
                }
            }
            Framed::CutOff => Some(DamageMessage::CutOff),
            Framed::Damaged => Some(DamageMessage::Damaged),
        };
        if let Some(damage) = damage {
            let seconds = last_us as f64 / 1e6;
            return Ok(Some(RecordingMessage::InPart { damage, seconds }.into()));
        }
    }
}

enum Framed {
    Sound(Vec<u8>),
    End,
    CutOff,
    Damaged,
}

/// A failure to read in the middle of a file is told as its end: what came before is worth having.
fn read_framed(input: &mut impl Read) -> Framed {
    let mut frame = Vec::new();
    match input.by_ref().take(8).read_to_end(&mut frame) {
        Ok(0) => return Framed::End,
        Ok(8) => {}
        _ => return Framed::CutOff,
    }
    let word = |at: usize| u32::from_le_bytes([frame[at], frame[at + 1], frame[at + 2], frame[at + 3]]);
    let (length, crc) = (word(0), word(4));
    if length > MOST_BYTES {
        return Framed::Damaged;
    }
    let mut bytes = Vec::new();
    match input.by_ref().take(u64::from(length)).read_to_end(&mut bytes) {
        Ok(read) if read == length as usize => {}
        _ => return Framed::CutOff,
    }
    if crc32fast::hash(&bytes) == crc { Framed::Sound(bytes) } else { Framed::Damaged }
}

fn head_of(bytes: &[u8]) -> Option<Head> {
    let form: HeadForm =
        serde_json::from_slice(bytes).ok().filter(|form: &HeadForm| form.version == VERSION)?;
    let began = SystemTime::UNIX_EPOCH.checked_add(Duration::from_micros(form.began_unix_us))?;
    Some(Head { columns: form.columns, began, device: form.device })
}

/// The bytes of a block are no records, though their CRC is right.
struct Damaged;

struct BlockReader<'a> {
    bytes: &'a [u8],
    state: State,
}

impl BlockReader<'_> {
    /// The next record; none at the end of the block.
    fn record(&mut self, columns: usize) -> Result<Option<Record>, Damaged> {
        loop {
            if self.bytes.is_empty() {
                return Ok(None);
            }
            match self.number()? {
                GAP => return Ok(Some(Record::Gap { at_us: self.time()? })),
                MARK => {
                    let (at_us, kind, text) = (self.time()?, self.words()?, self.words()?);
                    return Ok(Some(Record::Mark { at_us, kind, text }));
                }
                LAYOUT => self.layout(columns)?,
                number => return self.sample((number - SAMPLE) as usize).map(Some),
            }
        }
    }

    fn layout(&mut self, columns: usize) -> Result<(), Damaged> {
        let count = self.number()? as usize;
        if count > columns {
            return Err(Damaged);
        }
        let mut layout = Vec::with_capacity(count);
        for _ in 0..count {
            let (column, exchange) = (self.number()? as usize, self.number()? as usize);
            if column >= columns || exchange >= count {
                return Err(Damaged);
            }
            layout.push((column, exchange));
        }
        if self.state.layouts.len() >= MOST_LAYOUTS {
            self.state.layouts.clear();
        }
        self.state.layouts.push(layout);
        Ok(())
    }

    fn sample(&mut self, number: usize) -> Result<Record, Damaged> {
        let layout = self.state.layouts.get(number).cloned().ok_or(Damaged)?;
        let exchanges = layout.iter().map(|(_, exchange)| exchange + 1).max().unwrap_or(0);
        let mut spans = Vec::with_capacity(exchanges);
        for _ in 0..exchanges {
            spans.push((self.time()?, self.time()?));
        }
        let mut readings = Vec::with_capacity(layout.len());
        for (column, exchange) in layout {
            let (requested_us, replied_us) = spans[exchange];
            readings.push(Reading { column, value: self.value(column)?, requested_us, replied_us });
        }
        Ok(Record::Sample(readings))
    }

    fn value(&mut self, column: usize) -> Result<f64, Damaged> {
        let number = self.number()?;
        let code = (number % 8) as usize;
        if number == WHOLE {
            let (bytes, rest) = self.bytes.split_first_chunk().ok_or(Damaged)?;
            self.bytes = rest;
            return Ok(f64::from_le_bytes(*bytes));
        }
        let step = STEPS.get(code).ok_or(Damaged)?;
        let before = self.state.numbers.entry((column, code)).or_insert(0);
        *before = before.wrapping_add(unzigzag(number / 8));
        Ok(*before as f64 * step)
    }

    fn time(&mut self) -> Result<u64, Damaged> {
        let by = unzigzag(self.number()?);
        self.state.time_us = self.state.time_us.wrapping_add(by);
        u64::try_from(self.state.time_us).map_err(|_| Damaged)
    }

    fn words(&mut self) -> Result<String, Damaged> {
        let length = self.number()? as usize;
        let (words, rest) = self.bytes.split_at_checked(length).ok_or(Damaged)?;
        self.bytes = rest;
        String::from_utf8(words.to_vec()).map_err(|_| Damaged)
    }

    fn number(&mut self) -> Result<u64, Damaged> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let (byte, rest) = self.bytes.split_first().ok_or(Damaged)?;
            self.bytes = rest;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(Damaged)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn head(columns: usize) -> Head {
        let columns = (0..columns).map(|number| Column::new(&format!("Signal {number}"), "V")).collect();
        let began = SystemTime::UNIX_EPOCH + Duration::from_micros(1_800_000_000_123_456);
        Head { columns, began, device: "MCP266".to_owned() }
    }

    fn written(head: &Head, records: &[Record]) -> Vec<u8> {
        let mut file = Vec::new();
        let mut writer = CompactWriter::new(&mut file, head).unwrap();
        records.iter().for_each(|record| writer.write(record).unwrap());
        writer.flush().unwrap();
        drop(writer);
        file
    }

    fn read_back(file: &[u8]) -> (Option<Head>, Vec<Record>, Option<String>) {
        let (mut head, mut records) = (None, Vec::new());
        let take = |record| {
            records.push(record);
            true
        };
        let damage = read(file, "run.bwr", |found| head = Some(found.clone()), take).unwrap();
        (head, records, damage.map(|damage| damage.to_string()))
    }

    fn value() -> impl Strategy<Value = f64> {
        prop_oneof![
            (-2_147_483_648i64..2_147_483_648).prop_map(|count| count as f64),
            (-2000i32..2000).prop_map(|tenths| f64::from(tenths) * 0.1),
            (-32_767i32..=32_767).prop_map(|raw| f64::from(raw) * STEPS[4]),
            any::<f64>().prop_filter("a number", |value| value.is_finite()),
        ]
    }

    fn record() -> impl Strategy<Value = Record> {
        let exchange = (0u64..1 << 40, 0u64..100_000);
        let reading = (0usize..18, value(), exchange).prop_map(|(column, value, (requested_us, took))| {
            Reading { column, value, requested_us, replied_us: requested_us + took }
        });
        prop_oneof![
            8 => prop::collection::vec(reading, 0..18).prop_map(Record::Sample),
            1 => (0u64..1 << 40).prop_map(|at_us| Record::Gap { at_us }),
            1 => (0u64..1 << 40, "[a-z]{1,5}", ".{0,20}").prop_map(|(at_us, kind, text)| Record::Mark { at_us, kind, text }),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED), failure_persistence: None, ..ProptestConfig::with_cases(64) })]
        #[test]
        fn everything_written_is_read_back_to_the_last_bit(records in prop::collection::vec(record(), 0..200)) {
            let head = head(18);
            let (found, read, damage) = read_back(&written(&head, &records));
            prop_assert_eq!(found.unwrap(), head);
            prop_assert_eq!(read, records);
            prop_assert_eq!(damage, None);
        }

        #[test]
        fn a_damaged_or_cut_file_never_panics_and_what_is_read_of_it_was_written(
            records in prop::collection::vec(record(), 1..60),
            at in 0.0..1.0f64,
            flip in prop::option::of(1u8..),
        ) {
            let mut file = written(&head(18), &records);
            let at = (at * file.len() as f64) as usize;
            match flip {
                Some(flip) => file[at] ^= flip,
                None => file.truncate(at),
            }
            let mut read_records = Vec::new();
            let take = |record| {
                read_records.push(record);
                true
            };
            if read(&file[..], "run.bwr", |_| (), take).is_ok() {
                prop_assert_eq!(&records[..read_records.len()], &read_records[..]);
            }
        }

        #[test]
        fn any_bytes_in_a_sound_block_are_read_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let mut file = written(&head(3), &[]);
            write_framed(&mut file, &bytes).unwrap();
            let _ = read(&file[..], "run.bwr", |_| (), |_| true);
        }
    }

    #[test]
    fn a_noisy_sweep_of_18_readings_takes_less_than_a_fifth_of_its_line_of_csv() {
        let head = head(18);
        let (mut file, mut lines) = (Vec::new(), Vec::new());
        let mut writer = CompactWriter::new(&mut file, &head).unwrap();
        let mut csv =
            super::super::csv::CsvWriter::new(&mut lines, &head, super::super::csv::Times::Exchange).unwrap();
        let mut noise = 1u32;
        for sweep in 0..3000u64 {
            let readings = (0..18usize)
                .map(|column| {
                    noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let requested_us = sweep * 10_000 + (column as u64 / 3) * 300 + u64::from(noise >> 28);
                    let raw = f64::from(noise >> 22) - 512.0;
                    Reading {
                        column,
                        value: raw * STEPS[column % 5],
                        requested_us: requested_us & !15,
                        replied_us: (requested_us & !15) + 250,
                    }
                })
                .collect();
            let record = Record::Sample(readings);
            writer.write(&record).unwrap();
            csv.write(&record).unwrap();
        }
        writer.flush().unwrap();
        csv.flush().unwrap();
        drop((writer, csv));
        assert!(file.len() * 5 < lines.len(), "{} and {} bytes", file.len(), lines.len());
    }

    #[test]
    fn the_steps_are_those_of_the_protocol() {
        use brushwork_mcp_wire::packet_serial::scale;
        let of_protocol = [scale::VOLTAGE_VOLTS, scale::CURRENT_AMPS, scale::DUTY_PERCENT];
        assert_eq!([STEPS[1], STEPS[2], STEPS[4]], of_protocol);
    }

    #[test]
    fn what_is_no_recording_is_told_in_a_sentence() {
        let reported = |bytes: &[u8]| read(bytes, "x.bwr", |_| (), |_| true).unwrap_err().to_string();
        assert!(reported(b"").contains("x.bwr: it is shorter than"));
        assert!(reported(b"time_s,a\n1,2\n").contains("it does not begin like one"));
        assert!(reported(&written(&head(1), &[])[..20]).contains("its head is damaged"));
        let file = written(&head(1), &[Record::Gap { at_us: 1 }, Record::Gap { at_us: 2_000_000 }]);
        let (_, records, damage) = read_back(&file[..file.len() - 1]);
        assert_eq!(records, []);
        assert_eq!(
            damage.unwrap(),
            "The file ends in the middle of a block after 0.000 s; what stands before that is shown."
        );
    }
}
