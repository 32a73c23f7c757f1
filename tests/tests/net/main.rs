//! A net under changes that are to change nothing: what the program said and wrote before them, kept as data in `tests/net`.
//!
//! `BRUSHWORK_RECORD=1 cargo test -p brushwork-tests --test net` records anew. Whoever does so says in `tests/net/CHANGES.md` what
//! has changed and why.

mod files;
mod json;
mod names;
mod wire;

use std::fs;
use std::path::{Path, PathBuf};

/// The kept data.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("net")
}

/// Whether what is found is written down instead of compared.
fn is_recording() -> bool {
    std::env::var_os("BRUSHWORK_RECORD").is_some()
}

/// Holds a text against the one that was kept.
#[track_caller]
fn assert_kept(name: &str, found: &str) {
    let path = folder().join(name);
    if is_recording() {
        fs::write(&path, found).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        return;
    }
    let kept = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut section = "the beginning";
    for (number, line) in kept.lines().enumerate() {
        if line.starts_with('#') {
            section = line;
        }
        let now = found.lines().nth(number);
        assert_eq!(now, Some(line), "{name}, line {}, in {section}", number + 1);
    }
    assert_eq!(found.lines().count(), kept.lines().count(), "{name}: more than was kept");
}
