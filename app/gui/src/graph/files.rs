//! Files of the graph: recordings under way and opened ones, exported data and pictures.
//!
//! Whatever takes time does so on a thread of its own; what becomes of it is said by `LiveGraph::poll_files`.

use crate::graph::messages::GraphBarMessage;
use crate::messages::{GraphMessage, WindowStatusMessage};
use brushwork_link::Message;
use std::collections::{HashSet, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use brushwork_link::files::{Disk, Files as _, replace_file};
use brushwork_link::{clock, work};
use crossbeam_channel::{Receiver, TryRecvError, bounded};
use egui::{ColorImage, vec2};

use crate::files::{FileAction, FileDialog, FileKind};
use crate::model::message::Gravity;
use brushwork_core::recording::recorder::Recorder;
use brushwork_core::recording::{Record, dated_name, free_path};

use super::load;

mod live;

/// Files that are opened at once.
pub const MOST_AT_ONCE: usize = 8;

/// Pictures are no smaller than this.
const LEAST_PICTURE: egui::Vec2 = vec2(900.0, 420.0);

/// What is written of the present picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Export {
    Csv,
    Png,
    Svg,
}

/// What an opened file becomes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OpenAs {
    /// Looked at by itself.
    #[default]
    Recording,
    /// Drawn beneath.
    Run,
}

/// Something to say.
type Said = (Gravity, Message);

/// The graph's files.
#[derive(Debug)]
pub struct GraphFiles {
    /// Where recordings and exports go.
    pub folder: String,
    /// What is to be opened, as typed.
    pub open_path: String,
    pub open_as: OpenAs,
    /// What is recorded from, in the recording's head.
    pub device: String,
    recording: Option<Recording>,
    /// Those before it that are still being closed.
    finishing: Vec<Recording>,
    loading: Option<Loading>,
    /// Those that are read after it.
    waiting: VecDeque<(PathBuf, OpenAs)>,
    working: Vec<Receiver<Said>>,
    /// A picture that is being drawn for the clipboard.
    copying: Option<Receiver<ColorImage>>,
    dialog: Option<(Asked, FileDialog)>,
    /// Files that threads make or have made. A name is taken before its file is there.
    begun: HashSet<PathBuf>,
    /// The wall's time and the link's at one moment.
    clocks: Option<(SystemTime, Duration)>,
    dark: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Folder,
    Open,
}

#[derive(Debug)]
struct Recording {
    recorder: Recorder,
    /// The link's time at the recording's beginning.
    base: Duration,
    /// It is being closed, because the link has ended or because that was asked for.
    stopping: Option<Stopping>,
}

/// Why a recording ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stopping {
    Asked,
    LinkEnded,
    /// The controller has other channels now.
    OtherChannels,
}

#[derive(Debug)]
struct Loading {
    name: String,
    open_as: OpenAs,
    rows: Arc<AtomicU64>,
    given_up: Arc<AtomicBool>,
    answer: Receiver<Result<load::Loaded, Message>>,
}

impl Default for GraphFiles {
    fn default() -> Self {
        Self {
            folder: own_folder().display().to_string(),
            open_path: String::new(),
            open_as: OpenAs::default(),
            device: String::new(),
            recording: None,
            finishing: Vec::new(),
            loading: None,
            waiting: VecDeque::new(),
            working: Vec::new(),
            copying: None,
            dialog: None,
            begun: HashSet::new(),
            clocks: None,
            dark: true,
        }
    }
}

/// Where recordings go unless another folder is chosen. A web page downloads what is written there.
fn own_folder() -> PathBuf {
    if cfg!(target_family = "wasm") {
        return PathBuf::from(brushwork_core::keep::folder::DOWNLOADS);
    }
    std::env::home_dir().unwrap_or_else(std::env::temp_dir).join("Brushwork")
}

impl GraphFiles {
    pub fn is_recording(&self) -> bool {
        self.recording.as_ref().is_some_and(|recording| recording.stopping.is_none())
    }

    /// Something is going on that will have to be told.
    pub fn is_busy(&self) -> bool {
        self.recording.is_some()
            || !self.finishing.is_empty()
            || self.loading.is_some()
            || self.dialog.is_some()
            || self.copying.is_some()
            || !self.working.is_empty()
    }

    /// What is being recorded, in a few words.
    pub fn recording_text(&self) -> Option<String> {
        let recording = self.recording.as_ref()?;
        let progress = recording.recorder.progress();
        let name = file_name(recording.recorder.path());
        let mut text =
            GraphBarMessage::Recording { name, samples: progress.samples, size: size_text(progress.bytes) }
                .to_string();
        if progress.dropped > 0 {
            text += &GraphBarMessage::Lost { lost: progress.dropped }.to_string();
        }
        Some(text)
    }

    /// What is being read, in a few words.
    pub fn loading_text(&self) -> Option<String> {
        let loading = self.loading.as_ref()?;
        Some(
            GraphBarMessage::Reading {
                name: loading.name.clone(),
                rows: loading.rows.load(Ordering::Relaxed),
            }
            .to_string(),
        )
    }

    pub fn give_up_loading(&mut self) {
        self.waiting.clear();
        if let Some(loading) = self.loading.take() {
            loading.given_up.store(true, Ordering::Relaxed);
        }
    }

    pub fn choose_folder(&mut self) {
        self.dialog = Some((Asked::Folder, FileDialog::ask_folder()));
    }

    pub fn choose_recording(&mut self) {
        let kind = FileKind { title: "Recording".to_owned(), extension: "bwr,csv,txt".to_owned() };
        self.dialog = Some((Asked::Open, FileDialog::ask(FileAction::OpenSeveral, kind)));
    }

    /// Reads the file that was typed.
    pub fn open_typed(&mut self) {
        let path = PathBuf::from(self.open_path.trim());
        self.open(&path);
    }

    /// Begins to read a file.
    pub fn open(&mut self, path: &Path) {
        self.give_up_loading();
        self.read(path, self.open_as);
    }

    /// Begins to read files that were chosen together: the first as what is to be opened, the others lie over it.
    pub fn open_together(&mut self, paths: &[PathBuf]) {
        if let Some((first, others)) = paths.split_first() {
            self.open_path = first.display().to_string();
            self.open(first);
            others.iter().take(MOST_AT_ONCE - 1).for_each(|path| self.lay_beneath(path));
        }
    }

    /// The picture that was drawn for the clipboard, once.
    pub fn take_copied(&mut self) -> Option<ColorImage> {
        match self.copying.as_ref()?.try_recv() {
            Ok(image) => {
                self.copying = None;
                Some(image)
            }
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                self.copying = None;
                None
            }
        }
    }

    /// Reads a file as a run beneath, after what is being read.
    pub fn lay_beneath(&mut self, path: &Path) {
        self.waiting.push_back((path.to_owned(), OpenAs::Run));
        if self.loading.is_none() {
            self.open_next();
        }
    }

    /// Begins to read what waits.
    fn open_next(&mut self) {
        if let Some((path, open_as)) = self.waiting.pop_front() {
            self.read(&path, open_as);
        }
    }

    fn read(&mut self, path: &Path, open_as: OpenAs) {
        let (sender, answer) = bounded(1);
        let (rows, given_up) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicBool::new(false)));
        let (path, counted, stop) = (path.to_owned(), rows.clone(), given_up.clone());
        let name = file_name(&path);
        let read = move || {
            // Nobody waits any more if it was given up.
            let _ = sender.send(load::load(&path, &counted, &stop));
        };
        // Without a thread the channel is closed, which is told as a failure.
        let _ = work::spawn("read recording", read);
        self.loading = Some(Loading { name, open_as, rows, given_up, answer });
    }

    fn free_path(&mut self, extension: &str) -> PathBuf {
        let is_free = |path: &Path| !self.begun.contains(path) && !path.exists();
        let name = dated_name(clock::today());
        let path = free_path(Path::new(self.folder.trim()), &name, extension, is_free);
        self.begun.insert(path.clone());
        path
    }

    /// The wall's time at a time of the link.
    fn wall(&self, at: Duration) -> SystemTime {
        let (wall, link) = self.clocks.unwrap_or((clock::today(), at));
        if at >= link { wall + (at - link) } else { wall.checked_sub(link - at).unwrap_or(wall) }
    }

    fn record_record(&self, make: impl FnOnce(Duration) -> Option<Record>) {
        if let Some(recording) = self.recording.as_ref().filter(|recording| recording.stopping.is_none())
            && let Some(record) = make(recording.base)
        {
            recording.recorder.record(record);
        }
    }
}

impl GraphFiles {
    fn say(&mut self, gravity: Gravity, text: impl Into<Message>) {
        let (sender, receiver) = bounded(1);
        // The channel has room for one.
        let _ = sender.send((gravity, text.into()));
        self.working.push(receiver);
    }

    /// Makes a file on a thread of its own.
    fn write(&mut self, path: PathBuf, make: impl FnOnce() -> Result<Vec<u8>, String> + Send + 'static) {
        let (sender, receiver) = bounded(1);
        let work = move || {
            let shown = path.display().to_string();
            let written =
                make().and_then(|bytes| write_new(&path, &bytes).map_err(|error| error.to_string()));
            let said = match written {
                Ok(()) => (Gravity::Note, GraphMessage::Wrote { path: shown }.into()),
                Err(error) => (Gravity::Error, GraphMessage::NotWritten { path: shown, error }.into()),
            };
            // The window may be gone.
            let _ = sender.send(said);
        };
        // Without a thread the channel is closed and nothing was written.
        match work::spawn("export", work) {
            Ok(()) => self.working.push(receiver),
            Err(error) => {
                self.say(Gravity::Error, WindowStatusMessage::NotExported { error: error.to_string() });
            }
        }
    }
}

/// The file appears whole or not at all.
fn write_new(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    Disk.make_folder(path.parent().unwrap_or(Path::new(".")))?;
    replace_file(path, bytes)
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

fn size_text(bytes: u64) -> String {
    match bytes as f64 {
        b if b < 1e3 => GraphBarMessage::Bytes { bytes }.to_string(),
        b if b < 1e6 => format!("{:.1} kB", b / 1e3),
        b => format!("{:.1} MB", b / 1e6),
    }
}
