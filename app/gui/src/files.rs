//! Asks for a file by the desktop's own dialog, on a thread of its own, so that the window goes on.
//!
//! Where there is no dialog (no portal, no desktop) the answer is none, as if it had been cancelled: screens that
//! ask for a file also have a field for its path, and [`take_missing`] has that said.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use brushwork_link::clock::Instant;
use brushwork_link::work;
use crossbeam_channel::{Receiver, TryRecvError, bounded};

/// What kind of file is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileKind {
    /// For people: "Profile".
    pub title: String,
    /// Without the dot: `json`; several with commas between them.
    pub extension: String,
}

/// Whether a file is read or written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileAction {
    Open,
    /// One file or more, at once.
    OpenSeveral,
    /// The name that is offered.
    Save {
        name: String,
    },
}

/// A dialog that is open, or was.
#[derive(Debug)]
pub struct FileDialog {
    /// Nothing chosen is an empty list.
    answer: Receiver<Vec<PathBuf>>,
}

/// Nobody has seen a dialog and cancelled it sooner: there was none.
const SOONEST_CANCEL: Duration = Duration::from_millis(300);

/// A dialog was asked for that this desktop does not have.
static IS_MISSING: AtomicBool = AtomicBool::new(false);

/// Whether a dialog was asked for, since the last call, that this desktop does not have.
pub fn take_missing() -> bool {
    IS_MISSING.swap(false, Ordering::Relaxed)
}

/// What has become of a dialog.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileAnswer {
    /// The user has not chosen yet.
    Waiting,
    /// Cancelled, or there is no dialog on this desktop.
    None,
    Chosen(PathBuf),
}

impl FileDialog {
    /// Opens the dialog.
    #[cfg(not(target_family = "wasm"))]
    pub fn ask(action: FileAction, kind: FileKind) -> Self {
        Self::answered_by((&IS_MISSING, desktop::soonest_cancel()), move || desktop::choose(action, &kind))
    }

    /// Asks for a folder.
    #[cfg(not(target_family = "wasm"))]
    pub fn ask_folder() -> Self {
        Self::answered_by((&IS_MISSING, desktop::soonest_cancel()), desktop::choose_folder)
    }

    /// Opens the browser's dialog; a file that is saved is downloaded under the name that is offered.
    #[cfg(target_family = "wasm")]
    pub fn ask(action: FileAction, kind: FileKind) -> Self {
        let (sender, answer) = bounded(1);
        match action {
            FileAction::Open => crate::page::browser::choose(&kind.extension, false, sender),
            FileAction::OpenSeveral => crate::page::browser::choose(&kind.extension, true, sender),
            FileAction::Save { name } => {
                let _ = sender.send(vec![PathBuf::from(brushwork_core::keep::folder::DOWNLOADS).join(name)]);
            }
        }
        Self { answer }
    }

    /// A web page has no folders but the one that is downloaded.
    #[cfg(target_family = "wasm")]
    pub fn ask_folder() -> Self {
        Self::answered_by((&IS_MISSING, SOONEST_CANCEL), || {
            vec![PathBuf::from(brushwork_core::keep::folder::DOWNLOADS)]
        })
    }

    fn answered_by(
        (is_missing, soonest_cancel): (&'static AtomicBool, Duration),
        choose: impl FnOnce() -> Vec<PathBuf> + Send + 'static,
    ) -> Self {
        let (sender, answer) = bounded(1);
        let ask = move || {
            let asked_at = Instant::now();
            let chosen = choose();
            if chosen.is_empty() && asked_at.elapsed() < soonest_cancel {
                is_missing.store(true, Ordering::Relaxed);
            }
            // The window may have gone on without the answer.
            let _ = sender.send(chosen);
        };
        // Without a thread the sender is dropped, which reads as cancelled.
        let _ = work::spawn("file dialog", ask);
        Self { answer }
    }

    /// Looks for the answer; never waits.
    pub fn answer(&self) -> FileAnswer {
        match self.chosen().map(|chosen| chosen.into_iter().next()) {
            Some(Some(path)) => FileAnswer::Chosen(path),
            Some(None) => FileAnswer::None,
            None => FileAnswer::Waiting,
        }
    }

    /// All that was chosen, none of it where the dialog was cancelled; `None` until then. Never waits.
    pub fn chosen(&self) -> Option<Vec<PathBuf>> {
        match self.answer.try_recv() {
            Ok(chosen) => Some(chosen),
            Err(TryRecvError::Disconnected) => Some(Vec::new()),
            Err(TryRecvError::Empty) => None,
        }
    }
}

#[cfg(not(target_family = "wasm"))]
mod desktop {
    use std::env;
    use std::path::Path;
    use std::time::Duration;

    use super::{FileAction, FileKind, PathBuf, SOONEST_CANCEL};

    /// How soon somebody may have cancelled a dialog: never where nothing could have shown one.
    pub(super) fn soonest_cancel() -> Duration {
        let on_path = |program: &str| {
            let paths = env::var_os("PATH").unwrap_or_default();
            env::split_paths(&paths).any(|folder| folder.join(program).is_file())
        };
        let has_bus = || {
            let folder = env::var_os("XDG_RUNTIME_DIR");
            env::var_os("DBUS_SESSION_BUS_ADDRESS").is_some()
                || folder.is_some_and(|folder| Path::new(&folder).join("bus").exists())
        };
        // Elsewhere the system itself has the dialog.
        let asks_others = cfg!(all(unix, not(target_os = "macos")));
        if asks_others && !has_bus() && !on_path("zenity") { Duration::MAX } else { SOONEST_CANCEL }
    }

    pub(super) fn choose(action: FileAction, kind: &FileKind) -> Vec<PathBuf> {
        let extensions: Vec<&str> = kind.extension.split(',').collect();
        let dialog = rfd::FileDialog::new().add_filter(&kind.title, &extensions);
        match action {
            FileAction::Open => dialog.pick_file().into_iter().collect(),
            FileAction::OpenSeveral => dialog.pick_files().unwrap_or_default(),
            FileAction::Save { name } => dialog.set_file_name(name).save_file().into_iter().collect(),
        }
    }

    pub(super) fn choose_folder() -> Vec<PathBuf> {
        rfd::FileDialog::new().pick_folder().into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wait::until_some;

    fn settled(dialog: &FileDialog) -> FileAnswer {
        let answer = || Some(dialog.answer()).filter(|answer| *answer != FileAnswer::Waiting);
        until_some("an answer", answer, || "none yet".to_owned())
    }

    #[test]
    fn the_window_does_not_wait_for_the_user() {
        let (choose, chosen) = bounded::<()>(1);
        static IS_MISSING: AtomicBool = AtomicBool::new(false);
        let dialog = FileDialog::answered_by((&IS_MISSING, SOONEST_CANCEL), move || {
            chosen.recv().unwrap();
            vec![PathBuf::from("motor.json")]
        });
        assert_eq!(dialog.answer(), FileAnswer::Waiting);
        choose.send(()).unwrap();
        assert_eq!(settled(&dialog), FileAnswer::Chosen(PathBuf::from("motor.json")));
        assert!(!IS_MISSING.load(Ordering::Relaxed));
    }

    #[test]
    fn a_desktop_without_a_dialog_reads_as_cancelled() {
        static IS_MISSING: AtomicBool = AtomicBool::new(false);
        let failing = FileDialog::answered_by((&IS_MISSING, SOONEST_CANCEL), || panic!("no dialog here"));
        assert_eq!(settled(&failing), FileAnswer::None);
        assert_eq!(
            settled(&FileDialog::answered_by((&IS_MISSING, SOONEST_CANCEL), Vec::new)),
            FileAnswer::None
        );
        assert!(IS_MISSING.load(Ordering::Relaxed), "an answer that no person can have given");
    }

    #[test]
    fn a_dialog_that_was_looked_at_and_cancelled_is_not_missing() {
        static IS_MISSING: AtomicBool = AtomicBool::new(false);
        let looked_at = FileDialog::answered_by((&IS_MISSING, SOONEST_CANCEL), || {
            std::thread::sleep(SOONEST_CANCEL);
            Vec::new()
        });
        assert_eq!(settled(&looked_at), FileAnswer::None);
        assert!(!IS_MISSING.load(Ordering::Relaxed));
    }

    #[test]
    fn several_files_are_chosen_at_once() {
        static IS_MISSING: AtomicBool = AtomicBool::new(false);
        let files = ["one.csv", "two.csv"].map(PathBuf::from);
        let chosen = files.to_vec();
        let dialog = FileDialog::answered_by((&IS_MISSING, SOONEST_CANCEL), move || chosen);
        let found = until_some("an answer", || dialog.chosen(), || "none yet".to_owned());
        assert_eq!(found, files);
    }
}
