//! Opening, saving and closing, as far as questions have to be asked and answered.

use crate::messages::{EditorMessage, WindowStatusMessage};
use brushwork_link::Message;
use std::path::PathBuf;

use egui::Context;

use super::disk::encode;
use super::document::OnDisk;
use super::editor::Exit;
use super::files::Task;
use super::printer::Job;
use super::sheet::PathField;
use super::{DocId, Editor, Sheet, print};
use crate::files::FileKind;
use crate::model::message::Gravity;
use brushwork_core::known_file::KnownFile;

/// What programs are for the desktop's dialogs.
pub fn mcl_files() -> FileKind {
    FileKind { title: "Program".to_owned(), extension: KnownFile::Script.endings().join(",") }
}

pub fn pdf_files() -> FileKind {
    FileKind { title: "PDF".to_owned(), extension: "pdf".to_owned() }
}

/// A name as a file's, which has an ending.
fn with_ending(name: &str, ending: &str) -> PathBuf {
    let path = PathBuf::from(name);
    if path.extension().is_some() { path } else { path.with_extension(ending) }
}

impl Editor {
    /// Opens a file, or brings it to the front if it is open.
    pub fn open_path(&mut self, path: PathBuf) {
        let open = self.documents.iter().find(|document| document.path.as_ref() == Some(&path));
        match open.map(super::Document::id) {
            Some(id) => self.bring_to_front(id),
            None => self.ask(Task::Open(path)),
        }
    }

    /// Saves a program to its file; one without a file asks for it.
    pub fn save(&mut self, id: DocId) {
        match self.document(id).and_then(|document| document.path.clone()) {
            Some(path) => self.save_to(id, path, false),
            None => self.save_as(id),
        }
    }

    /// Asks where to save a program.
    pub fn save_as(&mut self, id: DocId) {
        let Some(document) = self.document(id) else { return };
        let path = document
            .path
            .clone()
            .unwrap_or_else(|| with_ending(&document.untitled, document.language().ending()));
        self.open_sheet(Sheet::SaveAs { id, field: PathField::of(&path) });
    }

    /// Asks where the pages are to go.
    pub fn print(&mut self, id: DocId) {
        let Some(document) = self.document(id) else { return };
        let path = document.path.clone().unwrap_or_else(|| PathBuf::from(&document.untitled));
        let field = PathField::of(&path.with_extension("pdf"));
        let spooler = self.spooler.clone();
        self.open_sheet(Sheet::Print { id, field, printer: String::new(), spooler });
    }

    /// Writes a program. `whatever` is done even if another program has changed the file.
    pub fn save_to(&mut self, id: DocId, path: PathBuf, whatever: bool) {
        let Some(document) = self.document_mut(id) else { return };
        let bytes = match encode(&document.text.text(), document.format) {
            Ok(bytes) => bytes,
            Err(error) => {
                let text =
                    EditorMessage::NotEncoded { title: document.title(), error: Message::error(error) };
                self.closing.clear();
                return self.say(Gravity::Error, text);
            }
        };
        document.is_saving = true;
        let same = document.path.as_ref() == Some(&path);
        let expected = document.stamp.filter(|_| same && !whatever);
        let revision = document.text.revision();
        self.ask(Task::Save { id, path, bytes, revision, expected });
    }

    /// Writes the pages of a program as PDF.
    pub fn print_to(&mut self, id: DocId, path: PathBuf) {
        let Some(document) = self.document(id) else { return };
        match print::pdf(&document.title(), &document.text.text()) {
            Ok(bytes) => self.ask(Task::Export { path, bytes, what: "Printed to" }),
            Err(why) => {
                self.say(Gravity::Error, WindowStatusMessage::NotPrinted { title: document.title(), why });
            }
        }
    }

    /// Hands the pages of the program that the sheet names to the printer.
    pub fn send_to_printer(&mut self, ctx: &Context) {
        let Some(Sheet::Print { id, printer, spooler: Some(spooler), .. }) = self.sheet.take() else {
            return;
        };
        self.wants_focus = true;
        let Some(document) = self.document(id) else { return };
        let title = document.title();
        match print::pdf(&title, &document.text.text()) {
            Ok(pages) => {
                let ctx = ctx.clone();
                let job = Job { title, printer: printer.trim().to_owned(), pages };
                self.printing.begin(spooler, job, move || ctx.request_repaint());
            }
            Err(why) => self.say(
                Gravity::Error,
                WindowStatusMessage::NotPrinted { title: title.to_string(), why: why.to_string() },
            ),
        }
    }

    /// Tells what became of print jobs.
    pub(super) fn hear_of_printing(&mut self) {
        while let Some(news) = self.printing.news() {
            match news {
                Ok(said) => self.say(Gravity::Note, said),
                Err(failure) => self.say(Gravity::Error, failure.message()),
            }
        }
    }

    pub(super) fn open_sheet(&mut self, sheet: Sheet) {
        self.sheet = Some(sheet);
        self.sheet_is_new = true;
    }

    /// Does what a sheet was filled in for.
    pub(super) fn look_after_sheet(&mut self) {
        let chosen = self.sheet.as_mut().and_then(Sheet::field_mut).and_then(PathField::chosen);
        if chosen.is_some() {
            self.accept_sheet();
        }
    }

    /// The sheet is filled in.
    pub fn accept_sheet(&mut self) {
        let Some(sheet) = self.sheet.take() else { return };
        self.wants_focus = true;
        match sheet {
            Sheet::Open(field) => field.path(None).into_iter().for_each(|path| self.open_path(path)),
            Sheet::SaveAs { id, field } => {
                let ending = self.document(id).map_or("mcl", |document| document.language().ending());
                field.path(Some(ending)).into_iter().for_each(|path| self.save_to(id, path, false));
            }
            Sheet::Print { id, field, .. } => {
                field.path(Some("pdf")).into_iter().for_each(|path| self.print_to(id, path));
            }
            Sheet::Image(field) => self.image = field.path(None),
            Sheet::GoToLine(text) => match text.trim().parse::<usize>() {
                Ok(line) => self.front_mut().go_to_line(line.saturating_sub(1)),
                Err(_) => self.say(
                    Gravity::Warning,
                    WindowStatusMessage::NoLineNumber { text: text.trim().to_owned() },
                ),
            },
            Sheet::Rename(new) => match self.front_mut().rename(new.trim()) {
                Ok(count) => self.say(Gravity::Note, WindowStatusMessage::Renamed { count }),
                Err(why) => self.say(Gravity::Warning, why),
            },
            Sheet::Close { ids } => {
                self.closing = ids;
                self.save_closing();
            }
        }
    }

    /// Saves what is to be closed; programs without a file are asked for one after the other.
    fn save_closing(&mut self) {
        for id in self.closing.clone() {
            let Some(document) = self.document(id).filter(|document| !document.is_saving) else { continue };
            if document.path.is_none() {
                self.bring_to_front(id);
                return self.save_as(id);
            }
            self.save(id);
        }
    }

    /// The sheet goes without anything being done.
    pub fn dismiss_sheet(&mut self) {
        self.sheet = None;
        self.closing.clear();
        self.exit = Exit::No;
        self.wants_focus = true;
    }

    /// Programs are closed without being saved.
    pub fn close_unsaved(&mut self) {
        if let Some(Sheet::Close { ids }) = self.sheet.take() {
            ids.into_iter().for_each(|id| self.close_now(id));
            self.exit_if_asked();
        }
    }

    /// Closes a program; one with unsaved text asks first.
    pub fn close(&mut self, id: DocId) {
        match self.document(id) {
            Some(document) if document.text.is_modified() => {
                self.bring_to_front(id);
                self.open_sheet(Sheet::Close { ids: vec![id] });
            }
            Some(_) => self.close_now(id),
            None => {}
        }
    }

    /// A program that was to be closed has been saved.
    pub(super) fn close_saved(&mut self, id: DocId) {
        if let Some(index) = self.closing.iter().position(|closing| *closing == id) {
            self.closing.remove(index);
            self.close_now(id);
            self.exit_if_asked();
            self.save_closing();
        }
    }

    /// The window is to close. False if there is unsaved text: then it asks, and [`Editor::may_exit`] tells when.
    pub fn ask_exit(&mut self) -> bool {
        let ids: Vec<DocId> = self
            .documents
            .iter()
            .filter(|document| document.text.is_modified())
            .map(super::Document::id)
            .collect();
        if ids.is_empty() {
            return true;
        }
        self.exit = Exit::Asked;
        self.open_sheet(Sheet::Close { ids });
        false
    }

    /// Whether everything is saved or given up since the window was to close.
    pub fn may_exit(&self) -> bool {
        self.exit == Exit::Now
    }

    fn exit_if_asked(&mut self) {
        let done = self.documents.iter().all(|document| !document.text.is_modified());
        if self.exit == Exit::Asked && done {
            self.exit = Exit::Now;
        }
    }

    /// Which of the two counts: the file, or what stands here.
    pub fn settle_change(&mut self, id: DocId, load: bool) {
        let Some(document) = self.document_mut(id) else { return };
        document.on_disk = OnDisk::Same;
        let Some(path) = document.path.clone() else { return };
        if load {
            self.ask(Task::Reload(id, path));
        } else {
            document.stamp = None;
            document.text.set_unsaved();
        }
    }

    /// Opens what earlier windows left unsaved, or throws it away.
    pub fn settle_left(&mut self, restore: bool) {
        let left = std::mem::take(&mut self.left);
        if restore {
            for kept in left.iter().flat_map(|left| &left.programs) {
                let id = self.open_new("");
                if let Some(document) = self.document_mut(id) {
                    document.path.clone_from(&kept.path);
                    document.format = kept.format;
                    document.replace_all(&kept.text);
                    document.text.set_unsaved();
                }
            }
            // They are kept anew before what was left goes.
            self.keep_all();
        }
        self.ask(Task::ForgetLeft(left));
    }

    /// Nothing is left to be kept.
    pub fn end(&mut self) {
        self.ask(Task::End);
    }
}
