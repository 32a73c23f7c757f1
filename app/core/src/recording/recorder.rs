//! Writes a recording as data comes in, on a thread of its own: hours fit, and the window never waits for the disk.

use brushwork_link::Message;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use brushwork_link::files::{Disk, Files, flush_name};
use brushwork_link::work::HAS_THREADS;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, TrySendError, bounded};

use super::compact::CompactWriter;
use super::csv::{CsvWriter, Times};
use super::{Form, Head, Record};
use crate::messages::RecordingMessage;

/// Records that may wait for the disk: more than four seconds at a thousand a second.
const QUEUE: usize = 4096;

/// No more than this is lost when the computer's power goes.
const FLUSH_INTERVAL: Duration = Duration::from_secs(1);

/// How far a recording is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Samples written.
    pub samples: u64,
    /// Bytes written.
    pub bytes: u64,
    /// Records that the disk was too slow for.
    pub dropped: u64,
    /// Set once the file is closed: whether it is whole, or why it is not, in a sentence.
    pub ended: Option<Result<(), Message>>,
}

/// A recording under way.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    sender: Option<Sender<Record>>,
    progress: Arc<Mutex<Progress>>,
    thread: Option<JoinHandle<()>>,
    /// Where there are no threads.
    held: Option<Mutex<Held>>,
}

/// A recording in memory, written whole at its end.
struct Held {
    writer: Writer<Counted<Memory>>,
    memory: Memory,
}

impl std::fmt::Debug for Held {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Held")
    }
}

/// Bytes that are held. Clones are the same.
#[derive(Clone, Default)]
struct Memory(Arc<Mutex<Vec<u8>>>);

impl Write for Memory {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Recorder {
    /// Begins a new file, making its folder if need be.
    ///
    /// # Errors
    /// There is no thread for it. What goes wrong with the file is told by [`Recorder::progress`].
    pub fn start(path: &Path, form: Form, head: Head) -> std::io::Result<Self> {
        if HAS_THREADS { Self::on(Arc::new(Disk), path, form, head) } else { Self::held(path, form, &head) }
    }

    /// Begins one that is held in memory until it ends.
    fn held(path: &Path, form: Form, head: &Head) -> std::io::Result<Self> {
        let (progress, memory) = (Arc::new(Mutex::new(Progress::default())), Memory::default());
        let counted = Counted { inner: memory.clone(), progress: progress.clone() };
        let held = Held { writer: Writer::new(counted, form, head)?, memory };
        Ok(Self { path: path.to_owned(), sender: None, progress, thread: None, held: Some(Mutex::new(held)) })
    }

    fn on(files: Arc<dyn Files>, path: &Path, form: Form, head: Head) -> std::io::Result<Self> {
        let (sender, receiver) = bounded(QUEUE);
        let progress = Arc::new(Mutex::new(Progress::default()));
        let (reported, file) = (progress.clone(), path.to_owned());
        let work = move || {
            let result = write_all(&*files, &file, form, &head, &receiver, &reported, FLUSH_INTERVAL);
            // Dropping the receiver tells the window that nothing more is taken.
            drop(receiver);
            let result = result.map_err(|error| sentence(&file.display().to_string(), &error));
            lock(&reported).ended = Some(result);
        };
        let thread = thread::Builder::new().name("recorder".to_owned()).spawn(work)?;
        Ok(Self { path: path.to_owned(), sender: Some(sender), progress, thread: Some(thread), held: None })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Hands a record over; never waits.
    pub fn record(&self, record: Record) {
        if let Some(held) = &self.held {
            let written = held.lock().unwrap_or_else(PoisonError::into_inner).writer.write(&record);
            let mut progress = lock(&self.progress);
            match written {
                Ok(()) => progress.samples += u64::from(matches!(record, Record::Sample(_))),
                Err(_) => progress.dropped += 1,
            }
            return;
        }
        let Some(sender) = &self.sender else { return };
        if let Err(TrySendError::Full(_)) = sender.try_send(record) {
            lock(&self.progress).dropped += 1;
        }
    }

    /// Ends the recording; the file is closed soon after.
    pub fn stop(&mut self) {
        self.sender = None;
        if let Some(held) = self.held.take() {
            let Held { mut writer, memory } = held.into_inner().unwrap_or_else(PoisonError::into_inner);
            let result = writer.flush().and_then(|()| {
                let bytes = memory.0.lock().unwrap_or_else(PoisonError::into_inner);
                Disk.write(&self.path, &bytes)
            });
            let name = self.path.display().to_string();
            lock(&self.progress).ended = Some(result.map_err(|error| sentence(&name, &error)));
        }
    }

    /// How far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        lock(&self.progress).clone()
    }
}

impl Drop for Recorder {
    /// What was handed over is on the disk when this returns.
    fn drop(&mut self) {
        self.stop();
        if let Some(thread) = self.thread.take() {
            // A panic there has been reported by the runtime.
            let _ = thread.join();
        }
    }
}

/// Counts what goes through it.
struct Counted<W> {
    inner: W,
    progress: Arc<Mutex<Progress>>,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.inner.write(bytes)?;
        lock(&self.progress).bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.inner.flush()
    }
}

enum Writer<W: Write> {
    Csv(Box<CsvWriter<W>>),
    Compact(CompactWriter<W>),
}

impl<W: Write> Writer<W> {
    fn new(out: W, form: Form, head: &Head) -> std::io::Result<Self> {
        Ok(match form {
            Form::Csv => Self::Csv(Box::new(CsvWriter::new(out, head, Times::Exchange)?)),
            Form::Compact => Self::Compact(CompactWriter::new(out, head)?),
        })
    }

    fn write(&mut self, record: &Record) -> std::io::Result<()> {
        match self {
            Self::Csv(writer) => writer.write(record),
            Self::Compact(writer) => writer.write(record),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Self::Csv(writer) => writer.flush(),
            Self::Compact(writer) => writer.flush(),
        }
    }
}

/// Writes to a new file until nobody hands over any more. What was handed over outlasts a power loss an interval later.
fn write_all(
    files: &dyn Files,
    path: &Path,
    form: Form,
    head: &Head,
    records: &Receiver<Record>,
    progress: &Arc<Mutex<Progress>>,
    flush_interval: Duration,
) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        files.make_folder(folder)?;
    }
    let file = Counted { inner: files.create(path)?, progress: progress.clone() };
    let mut writer = Writer::new(BufWriter::new(file), form, head)?;
    writer.flush()?;
    files.flush(path)?;
    flush_name(files, path)?;
    let (mut flushed_at, mut has_more) = (Instant::now(), false);
    loop {
        let next = records.recv_timeout(flush_interval);
        if let Ok(record) = &next {
            writer.write(record)?;
            lock(progress).samples += u64::from(matches!(record, Record::Sample(_)));
            has_more = true;
        }
        let is_last = matches!(next, Err(RecvTimeoutError::Disconnected));
        if has_more && (is_last || flushed_at.elapsed() >= flush_interval) {
            writer.flush()?;
            files.flush(path)?;
            (flushed_at, has_more) = (Instant::now(), false);
        }
        if is_last {
            return Ok(());
        }
    }
}

fn lock(progress: &Mutex<Progress>) -> MutexGuard<'_, Progress> {
    progress.lock().unwrap_or_else(PoisonError::into_inner)
}

#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
fn sentence(path: &str, error: &std::io::Error) -> Message {
    let remedy = match error.kind() {
        std::io::ErrorKind::StorageFull | std::io::ErrorKind::QuotaExceeded => RecordingMessage::MakeRoom,
        std::io::ErrorKind::PermissionDenied => RecordingMessage::NotPermitted,
        _ => RecordingMessage::Elsewhere,
    };
    let (path, error) = (path.to_owned(), error.to_string());
    RecordingMessage::NotRecorded { path, error, remedy: remedy.into() }.into()
}

#[cfg(test)]
mod tests {
    use std::time::SystemTime;

    use brushwork_link::files::{DiskFault, Remains, SimulatedDisk};

    use super::super::{Column, Reading, open};
    use super::*;
    use crate::wait::until_some;

    fn head() -> Head {
        Head {
            columns: vec![Column::new("M1 PWM", "%")],
            began: SystemTime::UNIX_EPOCH,
            device: String::new(),
        }
    }

    fn sample(at_us: u64) -> Record {
        Record::Sample(vec![Reading {
            column: 0,
            value: at_us as f64,
            requested_us: at_us,
            replied_us: at_us + 5,
        }])
    }

    fn settled(recorder: &Recorder) -> Result<(), Message> {
        until_some("the end", || recorder.progress().ended, || format!("{:?}", recorder.progress()))
    }

    #[test]
    fn what_was_handed_over_is_in_the_file_when_it_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        for form in [Form::Csv, Form::Compact] {
            let path = folder.path().join("deeper").join(format!("run.{}", form.extension()));
            let mut recorder = Recorder::start(&path, form, head()).unwrap();
            (0..1000).for_each(|at| recorder.record(sample(at * 1000)));
            recorder.stop();
            assert_eq!(settled(&recorder), Ok(()));
            let progress = recorder.progress();
            assert_eq!((progress.samples, progress.dropped), (1000, 0));
            assert_eq!(std::fs::metadata(&path).unwrap().len(), progress.bytes);
        }
    }

    #[test]
    fn without_threads_the_file_is_written_at_the_end_and_reads_the_same() {
        let folder = tempfile::tempdir().unwrap();
        for form in [Form::Csv, Form::Compact] {
            let path = |name: &str| folder.path().join(format!("{name}.{}", form.extension()));
            let (held, threaded) = (path("held"), path("threaded"));
            let recorders = [Recorder::held(&held, form, &head()), Recorder::start(&threaded, form, head())];
            for recorder in recorders {
                let mut recorder = recorder.unwrap();
                (0..1000).for_each(|at| recorder.record(sample(at * 1000)));
                recorder.stop();
                assert_eq!(settled(&recorder), Ok(()));
                assert_eq!(recorder.progress().samples, 1000);
            }
            assert_eq!(std::fs::read(&held).unwrap(), std::fs::read(&threaded).unwrap());
        }
    }

    #[test]
    fn a_file_that_exists_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        std::fs::write(&path, "precious").unwrap();
        let recorder = Recorder::start(&path, Form::Csv, head()).unwrap();
        assert!(settled(&recorder).unwrap_err().to_string().contains("Choose another folder"));
        drop(recorder);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "precious");
    }

    const PATH: &str = "/recordings/run";

    #[test]
    fn a_full_disk_ends_the_recording_with_a_sentence() {
        let disk = SimulatedDisk::default();
        disk.fail_at(1, DiskFault::Full);
        let recorder = Recorder::on(Arc::new(disk), Path::new(PATH), Form::Compact, head()).unwrap();
        recorder.record(sample(1));
        let reported = settled(&recorder).unwrap_err().to_string();
        assert!(reported.starts_with("Could not record to /recordings/run: "), "{reported}");
        assert!(reported.ends_with("Make room on the disk, or choose another folder."), "{reported}");
        recorder.record(sample(2));
    }

    /// How a recording of these ends on a disk, each record flushed by itself.
    fn recorded(disk: &SimulatedDisk, form: Form, records: &[Record]) -> std::io::Result<()> {
        let (sender, receiver) = bounded(QUEUE);
        records.iter().for_each(|record| sender.send(record.clone()).unwrap());
        drop(sender);
        let progress = Arc::default();
        write_all(disk, Path::new(PATH), form, &head(), &receiver, &progress, Duration::ZERO)
    }

    /// What is read of what a disk has.
    fn read_back(disk: &SimulatedDisk) -> Option<Vec<Record>> {
        let mut records = Vec::new();
        let take = |record| {
            records.push(record);
            true
        };
        let file = std::io::Cursor::new(disk.bytes(Path::new(PATH))?);
        open::read_from(file, PATH, |_| (), take).is_ok().then_some(records)
    }

    #[test]
    fn whatever_fails_and_wherever_it_is_cut_what_was_flushed_is_read_back_and_nothing_else() {
        /// Folder, name, head, and a flush of each of the last two.
        const TO_BEGIN: usize = 5;
        /// A record, and its flush.
        const PER_RECORD: usize = 2;
        let records: Vec<Record> = (0..4).map(|at| sample(at * 1000)).collect();
        let mut cuts = 0;
        for form in [Form::Csv, Form::Compact] {
            let disk = SimulatedDisk::default();
            disk.fail_at(usize::MAX, DiskFault::Failed);
            recorded(&disk, form, &records).unwrap();
            assert_eq!(disk.calls(), TO_BEGIN + PER_RECORD * records.len());
            for fault in DiskFault::ALL {
                for call in 1..=disk.calls() {
                    let disk = SimulatedDisk::default();
                    disk.fail_at(call, fault);
                    let told = recorded(&disk, form, &records);
                    let done = match call.checked_sub(TO_BEGIN + 1) {
                        _ if told.is_ok() => Some(records.len()),
                        later => later.map(|later| later / PER_RECORD),
                    };
                    for remains in Remains::ALL {
                        let found = read_back(&disk.after_crash(remains));
                        let at = format!("{form:?}, {fault:?} at call {call}, {remains:?}: {found:?}");
                        let found = found.unwrap_or_default();
                        assert_eq!(found, records[..found.len()], "{at}");
                        assert!(done.is_none_or(|done| found.len() >= done), "{at}");
                        cuts += 1;
                    }
                }
            }
        }
        assert!(cuts > 900, "{cuts}");
    }
}
