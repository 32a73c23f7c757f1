//! What runs beside the editor: the thread that checks, the thread of files, the journal; and what their news do to the programs.

use crate::messages::{EditorMessage, WindowStatusMessage};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use brushwork_link::work::HAS_THREADS;
use brushwork_link::{Failure, Message};
use egui::Context;

use super::check::Checker;
use super::disk::{self, Loaded};
use super::document::OnDisk;
use super::files::{Done, Files, SaveError, Task};
use super::journal::Kept;
use super::threads::Services;
use super::{DocId, Document, Editor};
use crate::model::message::Gravity;
use brushwork_core::keep::today;

/// How long text stands still before it is kept, seconds.
const KEEP_AFTER_S: f64 = 1.0;
/// How often files are looked at, seconds.
const LOOK_EVERY_S: f64 = 2.0;

impl Editor {
    /// Starts the threads. Unsaved text is kept in the folder `data`, if there is one.
    pub fn start(&mut self, ctx: &Context, data: Option<&Path>) {
        let waker = || {
            let ctx = ctx.clone();
            move || ctx.request_repaint()
        };
        let services = Services {
            checker: Checker::start(waker()),
            // What is unsaved is kept against a crash on a disk with locks, which a web page has not.
            files: Files::start(data.filter(|_| HAS_THREADS), waker()),
            asked: None,
            looked_at_s: 0.0,
        };
        self.services = Some(services);
        self.ask(Task::FindLeft);
    }

    /// Gives a task to the thread of files; a refusal is told.
    pub(super) fn ask(&mut self, task: Task) {
        let Some(services) = &self.services else { return };
        if let Err(failure) = services.files.ask(task) {
            self.say(Gravity::Error, failure.message());
        }
    }

    /// Something for the message line.
    pub(super) fn say(&mut self, gravity: Gravity, text: impl Into<Message>) {
        self.said.push((gravity, text.into()));
    }

    /// Takes in what the threads found and asks for what comes next. `shown` is whether the screen is in view. Hands back what
    /// is to be told.
    pub fn update(&mut self, ctx: &Context, now_s: f64, shown: bool) -> Vec<(Gravity, Message)> {
        self.check(shown);
        while let Some(done) = self.services.as_ref().and_then(|services| services.files.news()) {
            self.take(done);
        }
        self.hear_of_printing();
        self.look_after_sheet();
        self.keep_unsaved(ctx, now_s);
        self.look_at_files(ctx, now_s, shown);
        std::mem::take(&mut self.said)
    }

    fn check(&mut self, shown: bool) {
        let Some(services) = &mut self.services else { return };
        if let Some(checked) = services.checker.answer()
            && let Some(document) = self.documents.iter_mut().find(|document| document.id() == checked.id)
        {
            document.take_checked(Arc::new(checked));
        }
        let front = &self.documents[self.front];
        let newest = (front.id(), front.text.revision());
        let known = front.findings.fresh(newest.1).is_some();
        if shown && !known && services.asked != Some(newest) {
            services.asked = Some(newest);
            services.checker.ask(newest.0, newest.1, front.text.snapshot(), front.language());
        }
    }

    fn take(&mut self, done: Done) {
        match done {
            Done::Opened(path, Ok(loaded)) => self.opened(path, &loaded),
            Done::Opened(_, Err(failure)) | Done::NotKept(failure) => {
                self.say(Gravity::Error, failure.message());
            }
            Done::Reloaded(id, result) => self.reloaded(id, result),
            Done::Saved { id, path, revision, result } => self.saved(id, path, revision, result),
            Done::Exported(path, what, Ok(())) => {
                self.say(
                    Gravity::Note,
                    WindowStatusMessage::FileIs { what, path: path.display().to_string() },
                );
            }
            Done::Exported(_, _, Err(failure)) => self.say(Gravity::Error, failure.message()),
            Done::Changed(changed) => self.changed_on_disk(changed),
            Done::Left(left) => self.left = left,
        }
    }

    fn opened(&mut self, path: PathBuf, loaded: &Loaded) {
        // An empty program that nobody has touched makes room.
        let blank = self.front();
        let blank =
            (blank.path.is_none() && blank.text.is_empty() && !blank.text.can_redo()).then(|| blank.id());
        let id = self.open_new(&loaded.text);
        if let Some(document) = self.document_mut(id) {
            document.path = Some(path);
            document.format = loaded.format;
            document.stamp = loaded.stamp;
        }
        if let Some(blank) = blank {
            self.close_now(blank);
        }
    }

    /// The file was written by another program and is read again. What stood here can be had back by Undo.
    fn reloaded(&mut self, id: DocId, result: Result<Loaded, Failure>) {
        match result {
            Ok(loaded) => {
                let Some(document) = self.document_mut(id) else { return };
                document.replace_all(&loaded.text);
                document.format = loaded.format;
                document.stamp = loaded.stamp;
                document.on_disk = OnDisk::Same;
                document.text.set_saved();
                let text = EditorMessage::LoadedAgain { title: document.title() };
                self.say(Gravity::Note, text);
            }
            Err(failure) => self.say(Gravity::Error, failure.message()),
        }
    }

    fn saved(
        &mut self,
        id: DocId,
        path: PathBuf,
        revision: u64,
        result: Result<Option<disk::Stamp>, SaveError>,
    ) {
        let Some(document) = self.document_mut(id) else { return };
        document.is_saving = false;
        match result {
            Ok(stamp) => {
                document.path = Some(path);
                document.stamp = stamp;
                document.on_disk = OnDisk::Same;
                if document.text.revision() == revision {
                    document.text.set_saved();
                    self.ask(Task::Forget(id));
                }
                self.close_saved(id);
            }
            Err(SaveError::Changed) => {
                document.on_disk = OnDisk::Changed;
                let text = EditorMessage::ChangedElsewhere { title: document.title() };
                self.closing.clear();
                self.say(Gravity::Warning, text);
            }
            Err(SaveError::Failed(failure)) => {
                self.closing.clear();
                self.say(Gravity::Error, failure.message());
            }
        }
    }

    fn changed_on_disk(&mut self, changed: Vec<(DocId, Option<disk::Stamp>)>) {
        let mut reload = Vec::new();
        for (id, stamp) in changed {
            let Some(document) = self.document_mut(id).filter(|document| !document.is_saving) else {
                continue;
            };
            match (stamp, &document.path) {
                (None, _) => document.on_disk = OnDisk::Gone,
                (Some(_), Some(path)) if !document.text.is_modified() => reload.push((id, path.clone())),
                _ => document.on_disk = OnDisk::Changed,
            }
        }
        for (id, path) in reload {
            self.ask(Task::Reload(id, path));
        }
    }

    /// Keeps what is not saved once it has stood still for a moment.
    fn keep_unsaved(&mut self, ctx: &Context, now_s: f64) {
        let mut tasks = Vec::new();
        for document in &mut self.documents {
            let revision = document.text.revision();
            if document.seen.0 != revision {
                document.seen = (revision, now_s);
            }
            if document.kept == revision || revision == 0 {
                continue;
            }
            if now_s - document.seen.1 < KEEP_AFTER_S {
                ctx.request_repaint_after(std::time::Duration::from_secs_f64(KEEP_AFTER_S));
                continue;
            }
            document.kept = revision;
            tasks.push(if document.text.is_modified() {
                Task::Keep(document.id(), Box::new(kept(document)))
            } else {
                Task::Forget(document.id())
            });
        }
        tasks.into_iter().for_each(|task| self.ask(task));
    }

    fn look_at_files(&mut self, ctx: &Context, now_s: f64, shown: bool) {
        let Some(services) = &mut self.services else { return };
        if !shown || now_s - services.looked_at_s < LOOK_EVERY_S {
            return;
        }
        services.looked_at_s = now_s;
        ctx.request_repaint_after(std::time::Duration::from_secs_f64(LOOK_EVERY_S));
        let files: Vec<_> = self
            .documents
            .iter()
            .filter(|document| document.on_disk == OnDisk::Same && !document.is_saving)
            .filter(|document| document.stamp.is_some())
            .filter_map(|document| Some((document.id(), document.path.clone()?, document.stamp)))
            .collect();
        if !files.is_empty() {
            self.ask(Task::Look(files));
        }
    }

    /// Keeps everything that is not saved at once: the program is being ended from outside.
    pub fn keep_all(&mut self) {
        let unsaved = self.documents.iter().filter(|document| document.text.is_modified());
        let tasks: Vec<Task> =
            unsaved.map(|document| Task::Keep(document.id(), Box::new(kept(document)))).collect();
        tasks.into_iter().for_each(|task| self.ask(task));
    }
}

fn kept(document: &Document) -> Kept {
    Kept {
        version: 1,
        title: document.title(),
        path: document.path.clone(),
        format: document.format,
        at: today(),
        text: document.text.text(),
    }
}
