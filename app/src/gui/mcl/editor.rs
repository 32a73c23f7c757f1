//! The open programs, and how all of them are shown.

use super::document::{DocId, Document};
use super::panel::Panel;

/// What is shown of a program besides its text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    pub hidden: bool,
    pub current_line: bool,
    pub folding: bool,
    /// Size of the text, percent.
    pub zoom_percent: u16,
}

impl Default for Options {
    fn default() -> Self {
        Self { hidden: false, current_line: true, folding: true, zoom_percent: 100 }
    }
}

impl Options {
    pub const ZOOMS_PERCENT: std::ops::RangeInclusive<u16> = 50..=300;

    pub fn set_zoom(&mut self, percent: u16) {
        self.zoom_percent = percent.clamp(*Self::ZOOMS_PERCENT.start(), *Self::ZOOMS_PERCENT.end());
    }
}

/// The editor: always at least one program.
#[derive(Debug)]
pub struct Editor {
    documents: Vec<Document>,
    front: usize,
    next: u64,
    pub options: Options,
    pub panel: Panel,
    /// The keyboard goes to the text in the next frame.
    pub wants_focus: bool,
}

impl Default for Editor {
    fn default() -> Self {
        let mut editor = Self {
            documents: Vec::new(),
            front: 0,
            next: 1,
            options: Options::default(),
            panel: Panel::default(),
            wants_focus: true,
        };
        editor.open_new("");
        editor
    }
}

impl Editor {
    pub fn documents(&self) -> &[Document] {
        &self.documents
    }

    pub fn documents_mut(&mut self) -> &mut [Document] {
        &mut self.documents
    }

    /// The program in front.
    pub fn front(&self) -> &Document {
        &self.documents[self.front]
    }

    pub fn front_mut(&mut self) -> &mut Document {
        &mut self.documents[self.front]
    }

    pub fn document(&self, id: DocId) -> Option<&Document> {
        self.documents.iter().find(|document| document.id() == id)
    }

    pub fn document_mut(&mut self, id: DocId) -> Option<&mut Document> {
        self.documents.iter_mut().find(|document| document.id() == id)
    }

    /// Begins a program without a file, in front.
    pub fn open_new(&mut self, text: &str) -> DocId {
        let id = DocId(self.next);
        self.next += 1;
        self.documents.push(Document::new(id, format!("Untitled {}", id.0), text));
        self.front = self.documents.len() - 1;
        self.wants_focus = true;
        id
    }

    pub fn bring_to_front(&mut self, id: DocId) {
        if let Some(index) = self.documents.iter().position(|document| document.id() == id) {
            self.front = index;
            self.wants_focus = true;
        }
    }

    /// Takes a program away, saved or not. Without any other an empty one comes in its place.
    pub fn close(&mut self, id: DocId) {
        let Some(index) = self.documents.iter().position(|document| document.id() == id) else { return };
        self.documents.remove(index);
        if self.documents.is_empty() {
            self.open_new("");
        }
        let last = self.documents.len() - 1;
        self.front = if index < self.front { self.front - 1 } else { self.front.min(last) };
        self.wants_focus = true;
    }
}
