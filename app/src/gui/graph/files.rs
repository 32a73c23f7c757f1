//! Files of the graph: recordings under way and opened ones, exported data and pictures.
//!
//! Whatever takes time does so on a thread of its own; what becomes of it is said by [`LiveGraph::poll_files`].

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use brushwork_link::device::{Channel, Sample};
use brushwork_link::settings::replace_file;
use crossbeam_channel::{Receiver, TryRecvError, bounded};
use egui::{Rect, vec2};

use super::live::{LiveGraph, Opened};
use super::marks::Mark;
use super::picture::draw::Scene;
use super::picture::{legend, png, svg};
use super::runs::Run;
use crate::gui::files::{FileAnswer, FileDialog, FileKind, FileWish};
use crate::gui::model::message::Gravity;
use crate::gui::theme::Palette;
use crate::recording::recorder::Recorder;
use crate::recording::{Form, Head, Reading, Record, dated_name, free_path};

use super::load;

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
type Said = (Gravity, String);

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
    loading: Option<Loading>,
    working: Vec<Receiver<Said>>,
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
    stopping: Option<&'static str>,
}

#[derive(Debug)]
struct Loading {
    name: String,
    open_as: OpenAs,
    rows: Arc<AtomicU64>,
    given_up: Arc<AtomicBool>,
    answer: Receiver<Result<load::Loaded, String>>,
}

impl Default for GraphFiles {
    fn default() -> Self {
        let home = std::env::home_dir().unwrap_or_else(std::env::temp_dir);
        Self {
            folder: home.join("Brushwork").display().to_string(),
            open_path: String::new(),
            open_as: OpenAs::default(),
            device: String::new(),
            recording: None,
            loading: None,
            working: Vec::new(),
            dialog: None,
            begun: HashSet::new(),
            clocks: None,
            dark: true,
        }
    }
}

impl GraphFiles {
    pub fn is_recording(&self) -> bool {
        self.recording.as_ref().is_some_and(|recording| recording.stopping.is_none())
    }

    /// Something is going on that will have to be told.
    pub fn is_busy(&self) -> bool {
        self.recording.is_some()
            || self.loading.is_some()
            || self.dialog.is_some()
            || !self.working.is_empty()
    }

    /// What is being recorded, in a few words.
    pub fn recording_text(&self) -> Option<String> {
        let recording = self.recording.as_ref()?;
        let progress = recording.recorder.progress();
        let name = file_name(recording.recorder.path());
        let mut text = format!("{name}: {} samples, {}", progress.samples, size_text(progress.bytes));
        if progress.dropped > 0 {
            text += &format!(", {} lost: the disk is too slow", progress.dropped);
        }
        Some(text)
    }

    /// What is being read, in a few words.
    pub fn loading_text(&self) -> Option<String> {
        let loading = self.loading.as_ref()?;
        Some(format!("Reading {}: {} rows", loading.name, loading.rows.load(Ordering::Relaxed)))
    }

    pub fn give_up_loading(&mut self) {
        if let Some(loading) = self.loading.take() {
            loading.given_up.store(true, Ordering::Relaxed);
        }
    }

    pub fn choose_folder(&mut self) {
        self.dialog = Some((Asked::Folder, FileDialog::ask_folder()));
    }

    pub fn choose_recording(&mut self) {
        let kind = FileKind { title: "Recording".to_owned(), extension: "bwr,csv,txt".to_owned() };
        self.dialog = Some((Asked::Open, FileDialog::ask(FileWish::Open, kind)));
    }

    /// Reads the file that was typed.
    pub fn open_typed(&mut self) {
        let path = PathBuf::from(self.open_path.trim());
        self.open(&path);
    }

    /// Begins to read a file.
    pub fn open(&mut self, path: &Path) {
        self.give_up_loading();
        let (sender, answer) = bounded(1);
        let (rows, given_up) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicBool::new(false)));
        let (path, counted, stop) = (path.to_owned(), rows.clone(), given_up.clone());
        let name = file_name(&path);
        let read = move || {
            // Nobody waits any more if it was given up.
            let _ = sender.send(load::load(&path, &counted, &stop));
        };
        // Without a thread the channel is closed, which is told as a failure.
        let _ = std::thread::Builder::new().name("read recording".to_owned()).spawn(read);
        self.loading = Some(Loading { name, open_as: self.open_as, rows, given_up, answer });
    }

    fn free_path(&mut self, extension: &str) -> PathBuf {
        let is_free = |path: &Path| !self.begun.contains(path) && !path.exists();
        let name = dated_name(SystemTime::now());
        let path = free_path(Path::new(self.folder.trim()), &name, extension, is_free);
        self.begun.insert(path.clone());
        path
    }

    /// The wall's time at a time of the link.
    fn wall(&self, at: Duration) -> SystemTime {
        let (wall, link) = self.clocks.unwrap_or((SystemTime::now(), at));
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

impl LiveGraph {
    /// Looks after files: once per frame. `now` is the link's time, while there is a link.
    pub fn poll_files(&mut self, now: Option<Duration>, dark: bool) -> Vec<Said> {
        self.files.dark = dark;
        self.files.clocks = now.map(|now| (SystemTime::now(), now)).or(self.files.clocks);
        let mut said = Vec::new();
        self.poll_recording(&mut said);
        self.poll_loading(&mut said);
        self.files.working.retain(|working| match working.try_recv() {
            Ok(text) => {
                said.push(text);
                false
            }
            Err(error) => error == TryRecvError::Empty,
        });
        self.poll_dialog();
        said
    }

    fn poll_recording(&mut self, said: &mut Vec<Said>) {
        let Some(recording) = &self.files.recording else { return };
        let progress = recording.recorder.progress();
        let Some(ended) = progress.ended else { return };
        let path = recording.recorder.path().display();
        said.push(match ended {
            Err(sentence) => (Gravity::Error, sentence),
            Ok(()) if progress.dropped > 0 => (
                Gravity::Warning,
                format!(
                    "Recorded {} samples to {path}, but {} were lost: the disk was too slow.",
                    progress.samples, progress.dropped
                ),
            ),
            Ok(()) => {
                let why = recording.stopping.unwrap_or_default();
                (
                    Gravity::Note,
                    format!(
                        "{why}Recorded {} samples to {path} ({}).",
                        progress.samples,
                        size_text(progress.bytes)
                    ),
                )
            }
        });
        self.files.recording = None;
    }

    fn poll_loading(&mut self, said: &mut Vec<Said>) {
        let Some(loading) = &self.files.loading else { return };
        let answer = match loading.answer.try_recv() {
            Err(TryRecvError::Empty) => return,
            Err(TryRecvError::Disconnected) => {
                Err("Could not open the recording: the system gave no thread.".to_owned())
            }
            Ok(answer) => answer,
        };
        let (name, open_as) = (loading.name.clone(), loading.open_as);
        self.files.loading = None;
        match answer {
            Err(sentence) => said.push((Gravity::Error, sentence)),
            Ok(loaded) => {
                if let Some(note) = &loaded.note {
                    said.push((Gravity::Warning, note.clone()));
                }
                match open_as {
                    OpenAs::Run => self.runs.push(Run::new(name, loaded.track)),
                    OpenAs::Recording => self.show_recording(name, loaded),
                }
            }
        }
    }

    fn show_recording(&mut self, name: String, loaded: load::Loaded) {
        let load::Loaded { track, began, note, left_out } = loaded;
        let mut sheet = super::sheet::Sheet::new(track);
        let shown_live = |key: &str| self.live.channels.iter().any(|live| live.shown && live.info.key == key);
        let has_data =
            |index: usize| !sheet.track.history.summary(index, f64::NEG_INFINITY, f64::INFINITY).0.is_empty();
        let with_data: Vec<usize> = (0..sheet.channels.len()).filter(|index| has_data(*index)).collect();
        let same: Vec<usize> =
            with_data.iter().copied().filter(|index| shown_live(&sheet.channels[*index].info.key)).collect();
        let shown = if same.is_empty() { with_data.into_iter().take(4).collect() } else { same };
        for (index, channel) in sheet.channels.iter_mut().enumerate() {
            channel.shown = shown.contains(&index);
        }
        sheet.selected = shown.first().copied().unwrap_or(0);
        sheet.look_at_all();
        sheet.fit_shown();
        self.opened = Some(Opened { name, sheet, began, note, left_out });
    }

    fn poll_dialog(&mut self) {
        let Some((asked, dialog)) = &self.files.dialog else { return };
        let asked = *asked;
        match dialog.answer() {
            FileAnswer::Waiting => return,
            FileAnswer::None => {}
            FileAnswer::Chosen(path) if asked == Asked::Folder => {
                self.files.folder = path.display().to_string();
            }
            FileAnswer::Chosen(path) => {
                self.files.open_path = path.display().to_string();
                self.files.open(&path);
            }
        }
        self.files.dialog = None;
    }

    /// The recording that is looked at goes; the live graph was sampled all the time.
    pub fn close_recording(&mut self) {
        self.opened = None;
    }

    /// Begins to record what comes in from now on.
    pub fn record(&mut self, form: Form) {
        if self.files.recording.is_some() {
            return;
        }
        let base = self
            .files
            .clocks
            .map_or(Duration::from_secs_f64(self.live.newest_s().max(0.0)), |(_, link)| link);
        let columns = self.live.track.channels.iter().map(load::column_of).collect();
        let head = Head { columns, began: self.files.wall(base), device: self.files.device.clone() };
        let path = self.files.free_path(form.extension());
        match Recorder::start(&path, form, head) {
            Ok(recorder) => self.files.recording = Some(Recording { recorder, base, stopping: None }),
            Err(error) => self.files.say(
                Gravity::Error,
                format!("Could not record: {error}. Close other programs and try again."),
            ),
        }
    }

    pub fn stop_recording(&mut self) {
        self.end_recording("");
    }

    /// The link is gone: so is what could be recorded.
    pub fn link_ended(&mut self) {
        self.push_gap();
        self.end_recording("The recording ended with the link. ");
    }

    fn end_recording(&mut self, why: &'static str) {
        if let Some(recording) =
            self.files.recording.as_mut().filter(|recording| recording.stopping.is_none())
        {
            recording.stopping = Some(why);
            recording.recorder.stop();
        }
    }

    pub(super) fn record_sample(&self, sample: &Sample) {
        self.files.record_record(|base| {
            let since = |at: Duration| u64::try_from(at.saturating_sub(base).as_micros()).unwrap_or(u64::MAX);
            let reading = |(column, channel): (usize, Channel)| {
                let (requested_at, replied_at) = sample.span(channel)?;
                let (requested_us, replied_us) = (since(requested_at), since(replied_at));
                Some(Reading { column, value: sample.get(channel)?, requested_us, replied_us })
            };
            let readings: Vec<_> = Channel::ALL.into_iter().enumerate().filter_map(reading).collect();
            (!readings.is_empty()).then_some(Record::Sample(readings))
        });
    }

    pub(super) fn record_mark(&self, mark: &Mark) {
        self.files.record_record(|base| {
            let since_s = (mark.at_s - base.as_secs_f64()).max(0.0);
            let at_us = (since_s * 1e6).round() as u64;
            Some(Record::Mark { at_us, kind: mark.kind.word().to_owned(), text: mark.text.clone() })
        });
    }

    pub(super) fn record_gap(&self, at_s: f64) {
        self.files.record_record(|base| {
            let since_s = (at_s - base.as_secs_f64()).max(0.0);
            Some(Record::Gap { at_us: (since_s * 1e6).round() as u64 })
        });
    }

    /// Writes what is in view to a new file.
    pub fn export(&mut self, what: Export) {
        let extension = match what {
            Export::Csv => "csv",
            Export::Png => "png",
            Export::Svg => "svg",
        };
        let path = self.files.free_path(extension);
        let make: Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send> = match what {
            Export::Csv => {
                let sheet = self.sheet();
                let (start_s, end_s) = sheet.window();
                let shown: Vec<String> =
                    sheet.channels.iter().filter(|c| c.shown).map(|c| c.info.key.clone()).collect();
                let track = sheet.track.cut(start_s, end_s);
                let zero_s = sheet.track.began_s.unwrap_or(0.0);
                let began = match &self.opened {
                    Some(opened) => opened.began.unwrap_or(SystemTime::UNIX_EPOCH),
                    None => self.files.wall(Duration::from_secs_f64(zero_s.max(0.0))),
                };
                Box::new(move || {
                    load::csv_of(&track, &shown, zero_s, began).map_err(|error| error.to_string())
                })
            }
            Export::Png | Export::Svg => self.picture(what),
        };
        self.files.write(path, make);
    }

    /// The picture with a head and a legend, ready to be drawn elsewhere.
    fn picture(&self, what: Export) -> Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send> {
        let palette: &'static Palette =
            Palette::of_theme(if self.files.dark { egui::Theme::Dark } else { egui::Theme::Light });
        let sheet = self.sheet();
        let size = self.last_plot_size.max(LEAST_PICTURE);
        let head = legend::Legend::of(
            self,
            palette,
            self.files.wall(Duration::from_secs_f64(sheet.newest_s().max(0.0))),
        );
        let height = legend::height(&head, size.x);
        let plot = Rect::from_min_size(egui::pos2(0.0, height), size);
        let frame = super::picture::frame::Frame::new(plot, sheet.window());
        let is_recording = self.opened.is_some();
        let scene = Scene {
            sheet,
            runs: &self.runs,
            align: self.align,
            palette,
            frame,
            pixels_per_point: 2.0,
            is_recording,
        };
        let mut picture = scene.picture();
        let whole = Rect::from_min_max(egui::Pos2::ZERO, plot.max);
        picture.push(legend::layer(&head, palette, whole));
        let title = head.title.clone();
        Box::new(move || match what {
            Export::Png => png::png(&picture, whole, palette.panel).map_err(|error| error.to_string()),
            _ => Ok(svg::svg(&picture, whole, palette.panel, &title).into_bytes()),
        })
    }
}

impl GraphFiles {
    fn say(&mut self, gravity: Gravity, text: String) {
        let (sender, receiver) = bounded(1);
        // The channel has room for one.
        let _ = sender.send((gravity, text));
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
                Ok(()) => (Gravity::Note, format!("Wrote {shown}.")),
                Err(error) => {
                    (Gravity::Error, format!("Could not write {shown}: {error}. Choose another folder."))
                }
            };
            // The window may be gone.
            let _ = sender.send(said);
        };
        // Without a thread the channel is closed and nothing was written.
        match std::thread::Builder::new().name("export".to_owned()).spawn(work) {
            Ok(_) => self.working.push(receiver),
            Err(error) => self.say(
                Gravity::Error,
                format!("Could not export: {error}. Close other programs and try again."),
            ),
        }
    }
}

/// The file appears whole or not at all.
fn write_new(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
    replace_file(path, bytes)
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

fn size_text(bytes: u64) -> String {
    match bytes as f64 {
        b if b < 1e3 => format!("{b:.0} bytes"),
        b if b < 1e6 => format!("{:.1} kB", b / 1e3),
        b => format!("{:.1} MB", b / 1e6),
    }
}
