//! The names of the program in front, made on a thread of their own: compiling twenty thousand lines takes longer than a frame.

use std::sync::Arc;

use brushwork_link::work;
use brushwork_script::debug::code_id;
use brushwork_script::language::Language;
use brushwork_script::names::Names;
use crossbeam_channel::{Receiver, TryRecvError, bounded};

/// A text as it was at one moment: which program, and its revision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextId {
    pub program: u64,
    pub revision: u64,
}

/// A compiled text.
#[derive(Clone, Debug)]
pub struct Compiled {
    pub text: TextId,
    /// What [`code_id`] gives for its program.
    pub code: u64,
    pub names: Names,
}

/// Compiles the text in front, the newest one that was asked for.
#[derive(Debug, Default)]
pub struct Compiler {
    asked: Option<TextId>,
    running: Option<Receiver<Option<Compiled>>>,
}

impl Compiler {
    /// Has a text compiled unless it was before; takes in what has been compiled meanwhile.
    pub fn follow(
        &mut self,
        id: TextId,
        language: Language,
        text: impl FnOnce() -> String,
    ) -> Option<Compiled> {
        let done = match self.running.as_ref().map(Receiver::try_recv) {
            Some(Err(TryRecvError::Empty)) => return None,
            Some(done) => {
                self.running = None;
                done.ok().flatten()
            }
            None => None,
        };
        if self.asked != Some(id) {
            self.asked = Some(id);
            let text = text();
            let (sender, receiver) = bounded(1);
            let work = move || {
                let compiled = Names::of(language, &text).map(|names| Compiled {
                    text: id,
                    code: code_id(names.program()),
                    names,
                });
                // The window may be gone.
                let _ = sender.send(compiled);
            };
            // Without a thread there are no names, which the panel tells.
            if work::spawn("program names", work).is_ok() {
                self.running = Some(receiver);
            }
        }
        done
    }

    /// Whether a text is being compiled.
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }
}

/// A program whose code is in the controller, with its names.
#[derive(Clone, Debug, Default)]
pub struct Loaded(Option<Arc<Compiled>>);

impl Loaded {
    /// The names, if they are those of this code.
    pub fn of(&self, code: u64) -> Option<&Arc<Compiled>> {
        self.0.as_ref().filter(|compiled| compiled.code == code && code != 0)
    }

    pub fn set(&mut self, compiled: Arc<Compiled>) {
        self.0 = Some(compiled);
    }
}
