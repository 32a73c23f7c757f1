//! No test goes without a successor: the names of all tests, kept, against those that are there.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use brushwork_tests::workspace;

use crate::{folder, is_recording};

/// How often each name of a test stands in the sources.
fn present() -> BTreeMap<String, usize> {
    let mut names = BTreeMap::new();
    for path in workspace::rust_files() {
        let text = workspace::read(&path);
        let mut is_test = false;
        for line in text.lines().map(str::trim_start) {
            if line.starts_with("#[test]") {
                is_test = true;
            }
            if let Some(rest) = line.split_once("fn ").filter(|_| is_test).map(|(_, rest)| rest) {
                let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
                *names.entry(rest[..end].to_owned()).or_default() += 1;
                is_test = false;
            }
        }
    }
    names
}

/// The lines of a file of the net but for comments and empty ones.
fn lines(name: &str) -> Vec<String> {
    let path = folder().join(name);
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')).map(str::to_owned).collect()
}

#[test]
fn every_test_that_there_was_is_there_or_has_successors() {
    let present = present();
    assert!(present.len() > 1_000, "{} names are not all", present.len());
    if is_recording() {
        let mut text = String::new();
        for (name, count) in &present {
            writeln!(text, "{count} {name}").expect("a string takes everything");
        }
        fs::write(folder().join("test_names.txt"), text).expect("the folder is in the repository");
        return;
    }
    // "old -> new, other: why". What was dropped for a reason has the successor "none".
    let mut successors: BTreeMap<String, usize> = BTreeMap::new();
    for line in lines("test_successors.txt") {
        let (names, why) = line.split_once(": ").unwrap_or_else(|| panic!("`{line}` gives no reason"));
        let (old, new) = names.split_once(" -> ").unwrap_or_else(|| panic!("`{line}` names no successor"));
        assert!(!why.trim().is_empty(), "`{line}` gives no reason");
        for name in new.split(", ").filter(|name| *name != "none") {
            assert!(present.contains_key(name), "`{line}`: there is no test {name}");
        }
        *successors.entry(old.to_owned()).or_default() += 1;
    }
    let mut missing = Vec::new();
    for line in lines("test_names.txt") {
        let (count, name) = line.split_once(' ').expect("a count and a name");
        let count: usize = count.parse().expect("a count");
        let found = present.get(name).copied().unwrap_or(0) + successors.get(name).copied().unwrap_or(0);
        if found < count {
            missing.push(format!("{name}: {found} of {count}"));
        }
    }
    assert!(missing.is_empty(), "gone without a successor in tests/net/test_successors.txt: {missing:#?}");
}
