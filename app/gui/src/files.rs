//! Asks for a file by the desktop's own dialog, on a thread of its own, so that the window goes on.
//!
//! Where there is no dialog (no portal, no desktop) the answer is none, as if it had been cancelled: screens that
//! ask for a file also have a field for its path.

use std::path::PathBuf;

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
    /// The name that is offered.
    Save {
        name: String,
    },
}

/// A dialog that is open, or was.
#[derive(Debug)]
pub struct FileDialog {
    answer: Receiver<Option<PathBuf>>,
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
        Self::answered_by(move || desktop::choose(action, &kind))
    }

    /// Asks for a folder.
    #[cfg(not(target_family = "wasm"))]
    pub fn ask_folder() -> Self {
        Self::answered_by(desktop::choose_folder)
    }

    /// Opens the browser's dialog; a file that is saved is downloaded under the name that is offered.
    #[cfg(target_family = "wasm")]
    pub fn ask(action: FileAction, kind: FileKind) -> Self {
        let (sender, answer) = bounded(1);
        match action {
            FileAction::Open => crate::page::browser::choose(&kind.extension, sender),
            FileAction::Save { name } => {
                let _ = sender.send(Some(PathBuf::from(brushwork_core::keep::folder::DOWNLOADS).join(name)));
            }
        }
        Self { answer }
    }

    /// A web page has no folders but the one that is downloaded.
    #[cfg(target_family = "wasm")]
    pub fn ask_folder() -> Self {
        Self::answered_by(|| Some(PathBuf::from(brushwork_core::keep::folder::DOWNLOADS)))
    }

    fn answered_by(choose: impl FnOnce() -> Option<PathBuf> + Send + 'static) -> Self {
        let (sender, answer) = bounded(1);
        let ask = move || {
            // The window may have gone on without the answer.
            let _ = sender.send(choose());
        };
        // Without a thread the sender is dropped, which reads as cancelled.
        let _ = work::spawn("file dialog", ask);
        Self { answer }
    }

    /// Looks for the answer; never waits.
    pub fn answer(&self) -> FileAnswer {
        match self.answer.try_recv() {
            Ok(Some(path)) => FileAnswer::Chosen(path),
            Ok(None) | Err(TryRecvError::Disconnected) => FileAnswer::None,
            Err(TryRecvError::Empty) => FileAnswer::Waiting,
        }
    }
}

#[cfg(not(target_family = "wasm"))]
mod desktop {
    use super::{FileAction, FileKind, PathBuf};

    pub(super) fn choose(action: FileAction, kind: &FileKind) -> Option<PathBuf> {
        let extensions: Vec<&str> = kind.extension.split(',').collect();
        let dialog = rfd::FileDialog::new().add_filter(&kind.title, &extensions);
        match action {
            FileAction::Open => dialog.pick_file(),
            FileAction::Save { name } => dialog.set_file_name(name).save_file(),
        }
    }

    pub(super) fn choose_folder() -> Option<PathBuf> {
        rfd::FileDialog::new().pick_folder()
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
        let dialog = FileDialog::answered_by(move || {
            chosen.recv().ok()?;
            Some(PathBuf::from("motor.json"))
        });
        assert_eq!(dialog.answer(), FileAnswer::Waiting);
        choose.send(()).unwrap();
        assert_eq!(settled(&dialog), FileAnswer::Chosen(PathBuf::from("motor.json")));
    }

    #[test]
    fn a_desktop_without_a_dialog_reads_as_cancelled() {
        assert_eq!(settled(&FileDialog::answered_by(|| None)), FileAnswer::None);
        assert_eq!(settled(&FileDialog::answered_by(|| panic!("no dialog here"))), FileAnswer::None);
    }
}
