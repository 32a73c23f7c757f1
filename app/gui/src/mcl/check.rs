//! Checks programs while they are typed, on a thread of its own: the window never waits for the compiler.

use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use brushwork_link::clock::Instant;
use brushwork_link::work::HAS_THREADS;
use brushwork_script::language::Language;
use brushwork_script::mcl::index::Index;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use ropey::Rope;

use super::doc_id::DocId;

/// Typing that goes on within this time is waited for.
const PAUSE: Duration = Duration::from_millis(10);
/// But no longer than this: a list of errors that never comes is of no use.
const PATIENCE: Duration = Duration::from_millis(40);

/// What the compiler says about a text.
#[derive(Debug)]
pub struct Checked {
    pub id: DocId,
    /// Of the text that was checked.
    pub revision: u64,
    pub text: String,
    pub index: Index,
}

/// A text to be checked.
struct Job {
    id: DocId,
    revision: u64,
    text: Rope,
    language: Language,
}

/// The thread that checks. Only the newest text counts.
pub struct Checker {
    next: Arc<Mutex<Option<Job>>>,
    wake: Sender<()>,
    answers: Receiver<Checked>,
    /// Where there are no threads, whoever asks checks at once.
    here: Option<Here>,
}

struct Here {
    sender: Sender<Checked>,
    tell: Box<dyn Fn() + Send>,
}

impl std::fmt::Debug for Checker {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Checker")
    }
}

impl Checker {
    /// Starts the thread; `tell` is called when there is news. Without a thread nothing is ever checked.
    pub fn start(tell: impl Fn() + Send + 'static) -> Self {
        let next = Arc::new(Mutex::new(None));
        let (wake, woken) = bounded(1);
        let (sender, answers) = bounded(1);
        if !HAS_THREADS {
            let here = Some(Here { sender, tell: Box::new(tell) });
            return Self { next, wake, answers, here };
        }
        let slot = next.clone();
        // A system that gives no thread leaves the list of problems empty; F7 still checks.
        let _ = thread::Builder::new()
            .name("mcl check".to_owned())
            .spawn(move || work(&slot, &woken, &sender, &tell));
        Self { next, wake, answers, here: None }
    }

    /// Has a text checked in place of what still waits.
    pub fn ask(&self, id: DocId, revision: u64, text: Rope, language: Language) {
        if let Some(here) = &self.here {
            // Only the newest counts.
            let _ = self.answers.try_recv();
            let _ = here.sender.try_send(check(id, revision, text.to_string(), language));
            return (here.tell)();
        }
        *self.next.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(Job { id, revision, text, language });
        // A thread that is awake already looks for the newest text by itself.
        let _ = self.wake.try_send(());
    }

    /// What was found since the last call.
    pub fn answer(&self) -> Option<Checked> {
        self.answers.try_recv().ok()
    }
}

/// Ends when the editor is gone.
fn work(slot: &Mutex<Option<Job>>, woken: &Receiver<()>, sender: &Sender<Checked>, tell: &impl Fn()) {
    while woken.recv().is_ok() {
        let began = Instant::now();
        while began.elapsed() < PATIENCE {
            match woken.recv_timeout(PAUSE) {
                Ok(()) => {}
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
        let job = slot.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(job) = job else { continue };
        let checked = check(job.id, job.revision, job.text.to_string(), job.language);
        if sender.send(checked).is_err() {
            return;
        }
        tell();
    }
}

/// Checks at once.
pub fn check(id: DocId, revision: u64, text: String, language: Language) -> Checked {
    let index = language.index(&text);
    Checked { id, revision, text, index }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_deep_long_or_wrong_throughout_ends_neither_the_thread_nor_the_program() {
        let (reported, news) = bounded(8);
        let checker = Checker::start(move || {
            let _ = reported.try_send(());
        });
        let sum = format!("x var long\nx = x{}\n", "+x".repeat(40_000));
        for (revision, text) in (1..).zip([sum, "(".repeat(100_000), "\0".repeat(50_000)]) {
            checker.ask(DocId(1), revision, Rope::from_str(&text), Language::Mcl);
            news.recv_timeout(crate::wait::PATIENCE).unwrap();
            let checked = checker.answer().unwrap();
            assert_eq!(checked.revision, revision);
            assert!((1..=202).contains(&checked.index.diagnostics.len()));
        }
    }

    #[test]
    fn the_newest_text_is_checked_within_a_tenth_of_a_second_after_the_last_key() {
        let (reported, news) = bounded(8);
        let checker = Checker::start(move || {
            let _ = reported.try_send(());
        });
        for revision in 1..=5 {
            checker.ask(DocId(1), revision, Rope::from_str("goto nowhere\n"), Language::Mcl);
        }
        news.recv_timeout(crate::wait::PATIENCE).unwrap();
        let checked = checker.answer().unwrap();
        assert_eq!((checked.id, checked.revision), (DocId(1), 5));
        assert!(checked.index.diagnostics[0].code.starts_with('E'));
        // What is waited for by design; the machine of a test may be slow beyond it.
        assert!(PAUSE + PATIENCE < Duration::from_millis(100));
    }
}
