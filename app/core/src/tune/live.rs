//! Lets a window look at a run while it goes on: a trace of what passes between tuner and axis.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use brushwork_tuning::record::Entry;

use super::law::{AnyLaw, Trace};

/// The trace of a run, shared between the run and whoever looks on. Each holds it only for a moment.
#[derive(Clone, Debug, Default)]
pub struct Live(Arc<Mutex<Trace>>);

impl Live {
    /// An empty trace.
    pub fn new(trace: Trace) -> Self {
        Self(Arc::new(Mutex::new(trace)))
    }

    /// Starts anew, for whoever looks on too.
    pub fn begin(&self, trace: Trace) {
        *self.look() = trace;
    }

    /// The trace so far.
    pub fn look(&self) -> MutexGuard<'_, Trace> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds what passed.
    pub fn take(&self, entry: &Entry<AnyLaw>) {
        self.look().take(entry);
    }
}
