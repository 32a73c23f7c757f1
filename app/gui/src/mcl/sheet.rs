//! What the editor asks before it does something: a path, a line, a name, whether to save.

use std::path::{Path, PathBuf};

use super::doc_id::DocId;
use super::printer::Spooler;
use crate::files::{FileAction, FileAnswer, FileDialog, FileKind};

/// A question, in the small window above the text.
#[derive(Debug)]
pub enum Sheet {
    Open(PathField),
    SaveAs {
        id: DocId,
        field: PathField,
    },
    Print {
        id: DocId,
        field: PathField,
        /// The printer's name; empty for the system's own choice.
        printer: String,
        /// How to reach a printer; without it there is only the file.
        spooler: Option<Spooler>,
    },
    /// The maker's image file, to be downloaded.
    Image(PathField),
    GoToLine(String),
    Rename(String),
    /// Programs with unsaved text are to be closed.
    Close {
        ids: Vec<DocId>,
    },
}

impl Sheet {
    pub fn field_mut(&mut self) -> Option<&mut PathField> {
        match self {
            Self::Open(field)
            | Self::SaveAs { field, .. }
            | Self::Print { field, .. }
            | Self::Image(field) => Some(field),
            Self::GoToLine(_) | Self::Rename(_) | Self::Close { .. } => None,
        }
    }
}

/// A path that is typed or chosen in the desktop's own dialog.
#[derive(Debug, Default)]
pub struct PathField {
    pub text: String,
    dialog: Option<FileDialog>,
}

impl PathField {
    pub fn of(path: &Path) -> Self {
        Self { text: path.display().to_string(), dialog: None }
    }

    /// Opens the desktop's dialog.
    pub fn browse(&mut self, saves: bool, kind: FileKind) {
        let name = Path::new(&self.text).file_name().map(|name| name.to_string_lossy().into_owned());
        let action = match saves {
            true => FileAction::Save { name: name.unwrap_or_else(|| format!("program.{}", kind.extension)) },
            false => FileAction::Open,
        };
        self.dialog = Some(FileDialog::ask(action, kind));
    }

    pub fn is_waiting(&self) -> bool {
        self.dialog.is_some()
    }

    /// What was chosen in the dialog since the last call.
    pub fn chosen(&mut self) -> Option<PathBuf> {
        match self.dialog.as_ref()?.answer() {
            FileAnswer::Waiting => None,
            FileAnswer::None => {
                self.dialog = None;
                None
            }
            FileAnswer::Chosen(path) => {
                self.dialog = None;
                self.text = path.display().to_string();
                Some(path)
            }
        }
    }

    /// The path as it stands; `~` is the user's home, and without an ending it gets `ending`.
    pub fn path(&self, ending: Option<&str>) -> Option<PathBuf> {
        let text = self.text.trim();
        if text.is_empty() {
            return None;
        }
        let home = || directories::UserDirs::new().map(|dirs| dirs.home_dir().to_owned());
        let path = match text.strip_prefix("~/").and_then(|rest| Some(home()?.join(rest))) {
            Some(path) => path,
            None => PathBuf::from(text),
        };
        Some(match ending {
            Some(ending) if path.extension().is_none() => path.with_extension(ending),
            _ => path,
        })
    }
}
