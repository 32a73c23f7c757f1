//! A panic is a bug of this program. The motors are stopped where it happens; what is known of it is kept here, so that its
//! owner can report it.

use std::backtrace::Backtrace;
use std::panic::{self, PanicHookInfo};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::SystemTime;
use std::{fs, io, thread};

use crate::keep::folder;

/// Folder of the reports, in that of everything else that is kept.
const FOLDER: &str = "errors";
/// A panic that comes over and over must not fill the disk: the first ones of a run tell all.
const MOST_IN_A_RUN: u32 = 10;
/// Reports of earlier runs that stay.
const MOST_KEPT: usize = 50;

static KEPT: AtomicU32 = AtomicU32::new(0);

/// Keeps a report of each panic from now on, and says on standard error where it is.
pub fn install() {
    let before = panic::take_hook();
    panic::set_hook(Box::new(move |panicked| {
        before(panicked);
        let Some(folder) = folder::data().map(|data| data.join(FOLDER)) else { return };
        if KEPT.fetch_add(1, Ordering::Relaxed) < MOST_IN_A_RUN
            && let Ok(path) = keep(&folder, SystemTime::now(), &text(panicked))
        {
            tell(&path);
        }
    }));
}

#[expect(clippy::print_stderr, reason = "nothing else of the program can be trusted to say it")]
fn tell(path: &Path) {
    eprintln!("This is a bug of Brushwork. What is known of it is in {}; please report it.", path.display());
}

/// What happened where, for whoever looks for it.
fn text(panicked: &PanicHookInfo<'_>) -> String {
    let thread = thread::current().name().unwrap_or("without a name").to_owned();
    format!(
        "Brushwork {} on {} {}, thread {thread}\n{panicked}\n\n{}\n",
        env!("CARGO_PKG_VERSION"),
        std::env::consts::OS,
        std::env::consts::ARCH,
        Backtrace::force_capture()
    )
}

/// Keeps a report, and the newest of the others.
fn keep(folder: &Path, now: SystemTime, text: &str) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    let name = crate::recording::dated_name(now);
    let path = crate::recording::free_path(folder, &name, "txt", |path| !path.exists());
    fs::write(&path, text)?;
    let mut reports: Vec<PathBuf> = fs::read_dir(folder)?.flatten().map(|entry| entry.path()).collect();
    // Their names are their dates; a second one of a second has a number behind it.
    reports.sort_by(|one, other| one.file_stem().cmp(&other.file_stem()));
    let surplus = reports.len().saturating_sub(MOST_KEPT);
    for old in reports.into_iter().filter(|report| *report != path).take(surplus) {
        fs::remove_file(old)?;
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_report_is_kept_under_its_date_and_the_oldest_go() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path().join("errors");
        let day = |day: u64| SystemTime::UNIX_EPOCH + Duration::from_secs(1_800_000_000 + 86_400 * day);
        let first = keep(&folder, day(0), "first").expect("it is kept");
        let again = keep(&folder, day(0), "again").expect("it is kept");
        assert_ne!(first, again, "two in a second");
        for later in 1..50 {
            keep(&folder, day(later), "later").expect("it is kept");
        }
        let left = fs::read_dir(&folder).expect("it is there").count();
        assert_eq!((left, first.exists(), again.exists()), (50, false, true));
        // A clock that is behind does not make the newest report the first to go.
        let behind = keep(&folder, SystemTime::UNIX_EPOCH, "behind").expect("it is kept");
        assert_eq!(fs::read_to_string(behind).expect("it is there"), "behind");
    }

    #[test]
    fn a_panic_in_a_thread_leaves_a_report_with_its_words_and_its_place() {
        let seen = std::sync::Arc::new(std::sync::Mutex::new(String::new()));
        let into = std::sync::Arc::clone(&seen);
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |panicked| {
            if thread::current().name() == Some("one that fails") {
                *into.lock().expect("nobody fails with it") = text(panicked);
            }
        }));
        let failing = thread::Builder::new().name("one that fails".to_owned()).spawn(|| panic!("of no use"));
        assert!(failing.expect("a thread").join().is_err());
        panic::set_hook(before);
        let text = seen.lock().expect("nobody fails with it").clone();
        for part in ["thread one that fails", "of no use", "panics.rs", "Brushwork 0."] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
