//! The open programs, and how all of them are shown.

use brushwork_link::Message;
use brushwork_script::language::Language;
use std::path::PathBuf;

use super::find::Find;
use super::journal::Left;
use super::panel::Panel;
use super::printer::{Printing, Spooler};
use super::threads::Services;
use super::{Completion, DocId, Document, Sheet};
use crate::mcl::messages::PanelMessage;
use crate::model::message::Gravity;

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

/// Where the window is on its way to being closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Exit {
    #[default]
    No,
    /// It waits until unsaved text is saved or given up.
    Asked,
    Now,
}

/// The editor: always at least one program.
#[derive(Debug)]
pub struct Editor {
    pub(super) documents: Vec<Document>,
    pub(super) front: usize,
    next: u64,
    pub options: Options,
    pub panel: Panel,
    pub find: Find,
    /// Words that could be typed, while the list is open.
    pub completion: Option<Completion>,
    /// What is being asked.
    pub sheet: Option<Sheet>,
    /// The keyboard goes to the sheet in the next frame.
    pub sheet_is_new: bool,
    /// The keyboard goes to the text in the next frame.
    pub wants_focus: bool,
    /// What earlier windows left unsaved.
    pub left: Vec<Left>,
    /// The system's print command, looked for as the program starts.
    pub spooler: Option<Spooler>,
    pub(super) printing: Printing,
    /// The maker's image file that is to be downloaded.
    pub image: Option<PathBuf>,
    /// Programs that are closed as soon as they are saved.
    pub(super) closing: Vec<DocId>,
    pub(super) exit: Exit,
    pub(super) services: Option<Services>,
    pub(super) said: Vec<(Gravity, Message)>,
}

impl Default for Editor {
    fn default() -> Self {
        let mut editor = Self {
            documents: Vec::new(),
            front: 0,
            next: 1,
            options: Options::default(),
            panel: Panel::default(),
            find: Find::default(),
            completion: None,
            sheet: None,
            sheet_is_new: false,
            wants_focus: true,
            left: Vec::new(),
            spooler: Spooler::find(),
            printing: Printing::default(),
            image: None,
            closing: Vec::new(),
            exit: Exit::No,
            services: None,
            said: Vec::new(),
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
        let names = (1..).map(|number| PanelMessage::Untitled { number }.to_string());
        let mut free = names.filter(|name| !self.documents.iter().any(|document| document.untitled == *name));
        let name = free.next().unwrap_or_default();
        self.documents.push(Document::new(id, name, text));
        self.front = self.documents.len() - 1;
        self.turned();
        id
    }

    /// Opens an empty program in the language of the one in front.
    pub fn open_new_like_front(&mut self) {
        let language = self.front().language();
        self.open_new("");
        if language != Language::Mcl {
            let front = self.front_mut();
            front.untitled = format!("{}.{}", front.untitled, language.ending());
        }
    }

    /// Opens a text that is in no file and has a name, such as an example.
    pub fn open_named(&mut self, name: &str, text: &str) -> DocId {
        let blank = self.front();
        let is_blank = blank.path.is_none() && blank.text.is_empty() && !blank.text.can_undo();
        let blank = is_blank.then(|| blank.id());
        let id = self.open_new(text);
        name.clone_into(&mut self.front_mut().untitled);
        if let Some(blank) = blank {
            self.close_now(blank);
        }
        id
    }

    pub fn bring_to_front(&mut self, id: DocId) {
        if let Some(index) = self.documents.iter().position(|document| document.id() == id) {
            self.front = index;
            self.turned();
        }
    }

    /// The program to the right or left of the one in front, round at the ends.
    pub fn neighbour(&self, right: bool) -> DocId {
        let count = self.documents.len();
        let step = if right { 1 } else { count - 1 };
        self.documents[(self.front + step) % count].id()
    }

    /// Takes a program away, saved or not. Without any other an empty one comes in its place.
    pub fn close_now(&mut self, id: DocId) {
        let Some(index) = self.documents.iter().position(|document| document.id() == id) else { return };
        self.ask(super::files::Task::Forget(id));
        self.documents.remove(index);
        if self.documents.is_empty() {
            self.open_new("");
        }
        let last = self.documents.len() - 1;
        self.front = if index < self.front { self.front - 1 } else { self.front.min(last) };
        self.turned();
    }

    /// Another program is in front.
    fn turned(&mut self) {
        self.wants_focus = true;
        self.completion = None;
    }
}
