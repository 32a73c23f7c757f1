//! The desktop's dialog for a report.

use crate::files::FileDialog;

/// The desktop's own dialog, and what its answer is for.
#[derive(Debug)]
pub struct Asked {
    pub dialog: FileDialog,
    pub saves: bool,
}
