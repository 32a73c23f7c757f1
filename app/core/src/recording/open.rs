//! Opens a recording of either form, told apart by how it begins.

use brushwork_link::{Message, files};
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::{Head, Record, RecordingError, compact, csv};

/// Reads a whole file: `begin` gets its head once, then `take` its records, until it gives `false`. The answer is a
/// sentence about damage that did not keep the rest from being read.
///
/// # Errors
/// The file cannot be read, is no recording, or a line of it is not as it should be.
pub fn read(
    path: &Path,
    begin: impl FnMut(&Head),
    take: impl FnMut(Record) -> bool,
) -> Result<Option<Message>, RecordingError> {
    let name = path.display().to_string();
    let file = files::open(path).map_err(|source| RecordingError::Io { path: name.clone(), source })?;
    read_from(file, &name, begin, take)
}

/// The same of what was opened already.
pub(super) fn read_from(
    mut file: impl Read + Seek,
    name: &str,
    begin: impl FnMut(&Head),
    take: impl FnMut(Record) -> bool,
) -> Result<Option<Message>, RecordingError> {
    let io = |source| RecordingError::Io { path: name.to_owned(), source };
    let mut first = Vec::new();
    file.by_ref().take(5).read_to_end(&mut first).map_err(io)?;
    file.seek(SeekFrom::Start(0)).map_err(io)?;
    if first == b"BWREC" {
        return compact::read(std::io::BufReader::new(file), name, begin, take);
    }
    csv::read(file, name, begin, take)
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, SystemTime};

    use proptest::prelude::*;

    use super::super::csv::{CsvWriter, Times};
    use super::super::{Column, Reading, compact::CompactWriter};
    use super::*;

    fn head() -> Head {
        let columns = vec![
            Column::new("M1 PWM", "%"),
            Column::new("Main Battery", "V"),
            Column::new("M1 Setpoint", ""),
        ];
        Head {
            columns,
            began: SystemTime::UNIX_EPOCH + Duration::from_secs(1_800_000_000),
            device: String::new(),
        }
    }

    fn read_file(path: &Path) -> (Head, Vec<Record>) {
        let (mut head, mut records) = (None, Vec::new());
        let take = |record| {
            records.push(record);
            true
        };
        assert_eq!(read(path, |found| head = Some(found.clone()), take).unwrap(), None);
        (head.unwrap(), records)
    }

    fn sweeps(steps: &[(u64, f64, f64)]) -> Vec<Record> {
        let mut now_us = 0;
        let mut records = Vec::new();
        for (step, first, second) in steps {
            now_us += step;
            let reading = |column, value, requested_us| Reading {
                column,
                value,
                requested_us,
                replied_us: requested_us + 700,
            };
            records.push(Record::Sample(vec![reading(0, *first, now_us), reading(1, *second, now_us + 900)]));
            now_us += 1600;
            records.push(Record::Mark {
                at_us: now_us,
                kind: "drive".to_owned(),
                text: "M1 \"50\", %".to_owned(),
            });
            records.push(Record::Gap { at_us: now_us });
        }
        records
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED), failure_persistence: None, ..ProptestConfig::with_cases(32) })]
        #[test]
        fn both_forms_give_back_every_value_and_both_times_of_each_reading(
            steps in prop::collection::vec((1u64..100_000, -1e9..1e9f64, -1e-9..1e-9f64), 1..40),
        ) {
            let folder = tempfile::tempdir().unwrap();
            let records = sweeps(&steps);
            let path = folder.path().join("run.csv");
            let mut writer = CsvWriter::new(std::fs::File::create(&path).unwrap(), &head(), Times::Exchange).unwrap();
            records.iter().for_each(|record| writer.write(record).unwrap());
            writer.flush().unwrap();
            let from_csv = read_file(&path);
            let path = folder.path().join("run.bwr");
            let mut writer = CompactWriter::new(std::fs::File::create(&path).unwrap(), &head()).unwrap();
            records.iter().for_each(|record| writer.write(record).unwrap());
            writer.flush().unwrap();
            let from_compact = read_file(&path);
            prop_assert_eq!(&from_csv.1, &records);
            prop_assert_eq!(&from_compact.1, &records);
            prop_assert_eq!(from_csv.0, head());
            prop_assert_eq!(from_compact.0, head());
        }
    }

    #[test]
    fn a_file_that_is_not_there_is_told_by_its_path() {
        let reported = read(Path::new("/nowhere/run.csv"), |_| (), |_| true).unwrap_err().to_string();
        assert!(reported.starts_with("Could not open the recording /nowhere/run.csv: "), "{reported}");
    }
}
