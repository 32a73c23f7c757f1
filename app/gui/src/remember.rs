//! What the window remembers from one time to the next: a small JSON file in the user's configuration folder.
//!
//! The file is replaced as a whole. One that cannot be read is a sentence and the defaults; it is put aside, not
//! overwritten. Values that make no sense count as not given.

use crate::messages::{WindowActMessage, WindowRemedyMessage};
use brushwork_link::Message;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use brushwork_link::Failure;
use brushwork_link::files::{Disk, Files, replace};
use brushwork_link::work::Worker;
use crossbeam_channel::{Receiver, TrySendError, bounded};
use egui::{Context, Rect, ThemePreference, ViewportInfo};
use serde::{Deserialize, Serialize};

use super::language::Language;
use super::model::Model;
use super::model::screen::Screen;
use super::model::unit_view::UnitView;
use brushwork_core::keep::folder;

/// How long a change waits, so that a window being dragged does not write a file for each step, seconds.
const SETTLE_S: f64 = 1.0;
/// Units whose view is kept.
const MOST_UNITS: usize = 12;
/// Nobody has a desk further out than that, points.
const FARTHEST: f32 = 30_000.0;

/// All that is remembered. What a file does not have is as it is at first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Remembered {
    /// 1.
    pub version: u32,
    pub window: Option<Placed>,
    pub theme: ThemeWord,
    pub plain: bool,
    pub language: Language,
    pub scale_percent: u16,
    /// The screen's title.
    pub screen: String,
    /// Connections, newest first.
    pub recent: Vec<String>,
    /// Files that were opened, newest first.
    pub recent_files: Vec<String>,
    pub left_width: f32,
    pub world_width: f32,
    /// What the graph has of the height of each screen whose bar was moved, by the screen's title.
    pub graph_parts: BTreeMap<String, f32>,
    /// How units were looked at, the one that was looked at last first.
    pub units: Vec<UnitView>,
}

/// Where the window was, in points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placed {
    /// Left and top. None where the desktop does not tell.
    pub at: Option<[f32; 2]>,
    pub size: [f32; 2],
    pub maximized: bool,
}

/// The theme as the file has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ThemeWord {
    #[default]
    System,
    Light,
    Dark,
}

impl Default for Remembered {
    fn default() -> Self {
        let mut remembered = Self {
            version: 1,
            window: None,
            theme: ThemeWord::System,
            plain: false,
            language: Language::English,
            scale_percent: 0,
            screen: String::new(),
            recent: Vec::new(),
            recent_files: Vec::new(),
            left_width: 0.0,
            world_width: 0.0,
            graph_parts: BTreeMap::new(),
            units: Vec::new(),
        };
        remembered.look_at(&Model::default());
        remembered
    }
}

impl Remembered {
    /// Takes over what the window is like now.
    fn look_at(&mut self, model: &Model) {
        self.theme = match model.appearance.theme {
            ThemePreference::System => ThemeWord::System,
            ThemePreference::Light => ThemeWord::Light,
            ThemePreference::Dark => ThemeWord::Dark,
        };
        self.plain = model.appearance.plain;
        self.language = model.appearance.language;
        self.scale_percent = model.appearance.scale_percent;
        model.screen.title().clone_into(&mut self.screen);
        self.recent = model.devices.recent.to_vec();
        self.recent_files = model.files.recent.clone();
        self.left_width = model.layout.left_width.round();
        self.world_width = model.layout.world_width.round();
        let part = |screen: &Screen| Some((screen.title().to_owned(), model.layout.graph_part(*screen)?));
        self.graph_parts = Screen::ALL.iter().filter_map(part).collect();
        if let Some(view) = model.front.unit_view(model.screen) {
            self.units.retain(|known| known.unit != view.unit);
            self.units.insert(0, view);
            self.units.truncate(MOST_UNITS);
        }
    }

    /// How a unit was looked at.
    pub fn view_of(&self, unit: &str) -> Option<&UnitView> {
        self.units.iter().find(|view| view.unit == unit)
    }

    /// Makes the window like it was.
    pub fn recall(&self, model: &mut Model) {
        model.appearance.theme = match self.theme {
            ThemeWord::System => ThemePreference::System,
            ThemeWord::Light => ThemePreference::Light,
            ThemeWord::Dark => ThemePreference::Dark,
        };
        model.appearance.plain = self.plain;
        model.appearance.language = self.language;
        model.appearance.set_scale(self.scale_percent);
        let screen = Screen::ALL.into_iter().find(|screen| screen.title() == self.screen);
        if let Some(screen) = screen {
            model.turn_to(screen);
        }
        model.devices.set_recent(self.recent.clone());
        model.files.set_recent(self.recent_files.clone());
        model.layout.set(self.left_width, self.world_width);
        for screen in Screen::ALL {
            model.layout.set_graph_part(screen, self.graph_parts.get(screen.title()).copied());
        }
    }
}

/// The file, and when it is written.
pub struct Memory {
    saved: Remembered,
    pub current: Remembered,
    changed_at_s: Option<f64>,
    writer: Writer,
}

impl Memory {
    /// Reads the file in the user's configuration folder; beside it what is to be said about it.
    pub fn open() -> (Self, Option<Failure>) {
        Self::at(folder::config().map(|folder| folder.join("window.json")))
    }

    /// Reads the file at `path`; without one nothing is kept.
    pub fn at(path: Option<PathBuf>) -> (Self, Option<Failure>) {
        Self::on(Arc::new(Disk), path)
    }

    /// The same on a disk of choice.
    fn on(files: Arc<dyn Files>, path: Option<PathBuf>) -> (Self, Option<Failure>) {
        let (remembered, failure) = match path.as_deref().map(|path| read(&*files, path)) {
            None => (Remembered::default(), None),
            Some(Ok(remembered)) => (remembered, None),
            Some(Err(failure)) => (Remembered::default(), Some(failure)),
        };
        let memory = Self {
            saved: remembered.clone(),
            current: remembered,
            changed_at_s: None,
            writer: Writer::start(files, path),
        };
        (memory, failure)
    }

    /// Looks at the window in each frame, and keeps what has changed once it has settled. A failure is given once.
    pub fn look(&mut self, ctx: &Context, model: &Model) -> Option<Failure> {
        let before = self.current.clone();
        self.current.look_at(model);
        let zoom = ctx.zoom_factor();
        let placed = ctx.input(|input| placed(input.viewport(), zoom, before.window));
        self.current.window = placed.or(before.window);
        let now_s = ctx.input(|input| input.time);
        if self.current != before {
            self.changed_at_s = Some(now_s);
        }
        let settled = self.changed_at_s.is_none_or(|changed| now_s - changed >= SETTLE_S);
        if settled && self.current != self.saved && self.writer.write(&self.current) {
            self.saved = self.current.clone();
            self.changed_at_s = None;
        }
        self.writer.failure()
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if self.current != self.saved {
            self.writer.finish(&self.current);
        }
    }
}

/// Where the window is, as far as the desktop tells: in the points of a desktop, whatever the window's own scale.
fn placed(viewport: &ViewportInfo, zoom: f32, before: Option<Placed>) -> Option<Placed> {
    let is = |flag: Option<bool>| flag.unwrap_or(false);
    if is(viewport.minimized) {
        return before;
    }
    let inner = viewport.inner_rect.filter(Rect::is_positive)?;
    let now = Placed {
        at: viewport.outer_rect.map(|outer| [outer.left() * zoom, outer.top() * zoom].map(f32::round)),
        size: [inner.width() * zoom, inner.height() * zoom].map(f32::round),
        maximized: is(viewport.maximized) || is(viewport.fullscreen),
    };
    // A maximised window keeps the place it will go back to.
    Some(if now.maximized { Placed { maximized: true, ..before.unwrap_or(now) } } else { now })
}

/// What is remembered in a file; one that cannot be read is put aside.
///
/// # Errors
/// What is wrong with it and where it is now.
pub fn read(files: &dyn Files, path: &Path) -> Result<Remembered, Failure> {
    let text = match files.read(path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Remembered::default()),
        Err(error) => return Err(unread(path, Message::error(error), WindowRemedyMessage::StartsAsAtFirst)),
    };
    match serde_json::from_str::<Remembered>(&text) {
        Ok(remembered) => Ok(sane(remembered)),
        Err(error) => {
            let aside = path.with_extension("json.broken");
            // If it cannot be put aside, it is overwritten: nothing in it is worth more than starting.
            let _ = files.rename(path, &aside);
            let remedy = WindowRemedyMessage::OldFileIsAside { path: aside.display().to_string() };
            Err(unread(path, Message::error(error), remedy))
        }
    }
}

fn unread(path: &Path, error: Message, remedy: WindowRemedyMessage) -> Failure {
    Failure::new(WindowActMessage::ReadState, path.display().to_string(), error, remedy)
}

/// A window that is nowhere or has no size is as good as none.
fn sane(mut remembered: Remembered) -> Remembered {
    let near = |value: f32| value.is_finite() && value.abs() <= FARTHEST;
    if let Some(window) = &mut remembered.window {
        window.at = window.at.filter(|at| at.iter().all(|value| near(*value)));
    }
    remembered.window =
        remembered.window.filter(|window| window.size.iter().all(|size| near(*size) && *size >= 100.0));
    remembered
}

/// Writes on a thread of its own, so that a slow disk does not hold up the window.
struct Writer {
    files: Arc<dyn Files>,
    path: Option<PathBuf>,
    worker: Worker<Remembered>,
    failures: Receiver<Failure>,
}

impl Writer {
    fn start(files: Arc<dyn Files>, path: Option<PathBuf>) -> Self {
        let (tell, failures) = bounded(1);
        let (own, disk) = (path.clone(), files.clone());
        let keep = move |remembered| {
            let written = own.as_ref().map_or(Ok(()), |path| write(&*disk, path, &remembered));
            if let Err(failure) = written {
                // One sentence is enough; the next one has to wait until it was read.
                let _ = tell.try_send(failure);
            }
        };
        Self { files, path, worker: Worker::start("window state", 1, keep), failures }
    }

    /// False if the one before is still being written.
    fn write(&self, remembered: &Remembered) -> bool {
        if self.path.is_none() || !self.worker.is_there() {
            return true;
        }
        !matches!(self.worker.give(remembered.clone()), Err(TrySendError::Full(_)))
    }

    fn failure(&self) -> Option<Failure> {
        self.failures.try_recv().ok()
    }

    /// The window closes: what is still to be written is written, last of all `remembered`.
    fn finish(&mut self, remembered: &Remembered) {
        self.worker.finish();
        if let Some(path) = &self.path {
            // There is no window left to say it in.
            let _ = write(&*self.files, path, remembered);
        }
    }
}

fn write(files: &dyn Files, path: &Path, remembered: &Remembered) -> Result<(), Failure> {
    let failed = |error: Message| {
        let remedy = WindowRemedyMessage::CheckFolder;
        Failure::new(WindowActMessage::KeepState, path.display().to_string(), error, remedy)
    };
    let text = serde_json::to_string_pretty(remembered).map_err(|error| failed(Message::error(error)))?;
    if let Some(folder) = path.parent() {
        files.make_folder(folder).map_err(|error| failed(Message::error(error)))?;
    }
    replace(files, path, text.as_bytes()).map_err(|error| failed(Message::error(error)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::files::{DiskFault, Remains, SimulatedDisk};
    use std::fs;

    fn file() -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("config").join("window.json");
        (folder, path)
    }

    #[test]
    fn what_the_window_was_like_comes_back() {
        let (_folder, path) = file();
        let mut model = Model::default();
        model.appearance.theme = ThemePreference::Dark;
        model.appearance.language = Language::German;
        model.appearance.set_scale(130);
        model.turn_to(Screen::Velocity);
        model.devices.remember("/dev/ttyACM0");
        model.files.remember(Path::new("/home/me/axis.json"));
        model.layout.set(250.0, 300.0);
        model.layout.set_graph_part(Screen::Velocity, Some(0.75));
        let (mut memory, failure) = Memory::at(Some(path.clone()));
        assert!(failure.is_none());
        memory.current.look_at(&model);
        drop(memory);
        let (memory, failure) = Memory::at(Some(path));
        assert!(failure.is_none());
        let mut again = Model::default();
        memory.current.recall(&mut again);
        assert_eq!(again.appearance, model.appearance);
        assert_eq!(again.screen, Screen::Velocity);
        assert_eq!(again.devices.recent, ["/dev/ttyACM0"]);
        assert_eq!(again.files.recent, ["/home/me/axis.json"]);
        assert_eq!(again.layout, model.layout);
    }

    #[test]
    fn a_broken_file_is_a_sentence_and_the_defaults_and_is_put_aside() {
        let (_folder, path) = file();
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, "{ \"theme\": \"purple\" ").unwrap();
        let (memory, failure) = Memory::at(Some(path.clone()));
        assert_eq!(memory.current, Remembered::default());
        let reported = failure.unwrap().to_string();
        assert!(reported.contains("window.json") && reported.contains("broken"), "{reported}");
        assert!(path.with_extension("json.broken").exists() && !path.exists());
    }

    #[test]
    fn values_that_make_no_sense_count_as_not_given() {
        let (_folder, path) = file();
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let text = r#"{ "scale_percent": 9999, "left_width": -1e30, "screen": "Kitchen", "new": 1,
            "graph_parts": { "Velocity Settings": 7e9, "Kitchen": 0.5 },
            "window": { "at": [1e20, 0], "size": [0, 0], "maximized": false } }"#;
        fs::write(&path, text).unwrap();
        let (memory, failure) = Memory::at(Some(path));
        assert!(failure.is_none());
        assert_eq!(memory.current.window, None);
        let mut model = Model::default();
        memory.current.recall(&mut model);
        assert_eq!(model.appearance.scale_percent, 250);
        assert_eq!(model.screen, Screen::DeviceStatus);
        assert!(model.layout.left_width >= 200.0);
        assert_eq!(model.layout.graph_part(Screen::Velocity), None);
    }

    #[test]
    fn a_folder_that_cannot_be_written_to_is_a_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let in_the_way = folder.path().join("config");
        fs::write(&in_the_way, "a file where a folder should be").unwrap();
        let reported =
            write(&Disk, &in_the_way.join("window.json"), &Remembered::default()).unwrap_err().to_string();
        assert!(reported.contains("window.json"), "{reported}");
    }

    #[test]
    fn whatever_fails_in_keeping_them_the_preferences_are_the_old_or_the_new_ones_and_it_is_said() {
        let path = Path::new("/config/window.json");
        let [old, new] =
            [100, 130].map(|scale_percent| Remembered { scale_percent, ..Remembered::default() });
        let mut tried = 0;
        for fault in DiskFault::ALL {
            for call in 1.. {
                let disk = SimulatedDisk::default();
                write(&disk, path, &old).unwrap();
                disk.fail_at(call, fault);
                let kept = write(&disk, path, &new);
                if disk.calls() < call {
                    break;
                }
                if let Err(failure) = &kept {
                    assert!(failure.to_string().contains("window.json"), "{failure}");
                }
                for remains in Remains::ALL {
                    let found = read(&disk.after_crash(remains), path).unwrap();
                    assert!(found == new || kept.is_err() && found == old, "{fault:?} at {call}: {found:?}");
                    tried += 1;
                }
            }
        }
        assert!(tried > 100, "{tried}");
    }
}
