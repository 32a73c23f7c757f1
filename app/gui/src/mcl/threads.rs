//! The threads beside the editor.

use super::check::Checker;
use super::doc_id::DocId;
use super::files::Files;

/// The threads of the editor, and what they were asked last.
#[derive(Debug)]
pub struct Services {
    pub checker: Checker,
    pub files: Files,
    pub asked: Option<(DocId, u64)>,
    pub looked_at_s: f64,
}
