//! What keeps backup and journal of settings that are changed for a while: it goes from the job that changes them to the one
//! that puts them back.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use brushwork_link::settings::Keeper;

/// A keeper that several jobs use, one after the other. Clones are the same.
#[derive(Clone)]
pub struct TrialKeeper(Arc<Mutex<Box<dyn Keeper>>>);

impl TrialKeeper {
    /// For one trial.
    pub fn new(keeper: Box<dyn Keeper>) -> Self {
        Self(Arc::new(Mutex::new(keeper)))
    }

    /// The keeper. A job that panicked with it has left it whole: it only hands things on.
    pub fn lock(&self) -> MutexGuard<'_, Box<dyn Keeper>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for TrialKeeper {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("TrialKeeper")
    }
}
