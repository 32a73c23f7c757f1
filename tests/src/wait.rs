//! Waiting for what really happens: threads, files, processes. However slow the machine is, a test only gives up when
//! there is no hope left, and then says what it waited for and what was there instead.

use std::path::Path;
use std::time::{Duration, Instant};

/// How long anything may take that a healthy machine has done in no time; also the start of Python or of an X server.
pub const LIMIT: Duration = Duration::from_secs(120);

/// Between two looks.
const INTERVAL: Duration = Duration::from_millis(3);

/// Looks until `look` finds something.
///
/// # Panics
/// When it never does; `there` tells what was there instead.
pub fn until_some<T>(what: &str, mut look: impl FnMut() -> Option<T>, there: impl FnOnce() -> String) -> T {
    let end = Instant::now() + LIMIT;
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(Instant::now() < end, "waited {LIMIT:?} for {what}, but: {}", there());
        std::thread::sleep(INTERVAL);
    }
}

/// Looks until something holds.
///
/// # Panics
/// When it never does; `there` tells what was there instead.
pub fn until(what: &str, mut holds: impl FnMut() -> bool, there: impl FnOnce() -> String) {
    until_some(what, || holds().then_some(()), there);
}

/// Waits for a file, or for a link that leads somewhere.
///
/// # Panics
/// When it never comes.
pub fn for_path(path: &Path) {
    until(&path.display().to_string(), || path.exists(), || "it is not there".to_owned());
}
