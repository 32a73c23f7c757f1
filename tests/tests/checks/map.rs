//! Compares `ARCHITECTURE.md` with the tree: its map with the crates, its walks with the files. What a module is for stands in the module's own
//! first line, and that is looked at too. The tests named in `SAFETY.md` are compared with those that there are.
//!
//! In the map a crate is a line `- \`folder\`: …`; in a walk a file is a line `1. \`path\`: …`.

use std::collections::BTreeSet;

use brushwork_tests::workspace::{self, Metadata};

/// Through more files nobody follows.
const LONGEST_WALK: usize = 12;

/// A page with more is not read.
const MOST_WORDS: usize = 2_000;

/// A head with fewer words names its module a second time.
const FEWEST_WORDS: usize = 4;

/// The lines of `ARCHITECTURE.md` under each of its headings that start with `title`.
fn sections(title: &str) -> Vec<(String, Vec<String>)> {
    let text = workspace::read("ARCHITECTURE.md");
    let sections = text.split("\n## ").skip(1).filter(|section| section.starts_with(title));
    sections
        .filter_map(|section| {
            let (heading, body) = section.split_once('\n')?;
            Some((heading.to_owned(), body.lines().map(str::to_owned).collect()))
        })
        .collect()
}

fn quoted(rest: &str) -> Option<String> {
    rest.split_once('`').map(|(name, _)| name.to_owned())
}

/// The path of a line `12. \`path\`: …`.
fn step(line: &str) -> Option<String> {
    let (number, rest) = line.split_once(". `")?;
    number.parse::<usize>().ok()?;
    quoted(rest)
}

#[test]
fn every_crate_has_a_line_in_the_map_and_every_line_a_crate() {
    let lines = sections("Map").into_iter().flat_map(|(_, lines)| lines);
    let in_map: Vec<String> = lines.filter_map(|line| line.strip_prefix("- `").and_then(quoted)).collect();
    let in_tree: BTreeSet<String> =
        Metadata::load().members.into_iter().map(|member| member.folder).collect();
    assert_eq!(in_map.iter().cloned().collect::<BTreeSet<_>>(), in_tree);
    assert_eq!(in_map.len(), in_tree.len(), "a crate stands there twice: {in_map:?}");
}

#[test]
fn every_first_level_module_opens_by_saying_what_it_is_for() {
    let mut faults = Vec::new();
    for member in Metadata::load().members {
        let mut heads = BTreeSet::new();
        for module in workspace::first_level_modules(&member.folder) {
            let source = ["", "/mod"]
                .map(|end| format!("{}/src/{module}{end}.rs", member.folder))
                .into_iter()
                .find(|path| workspace::root().join(path).is_file());
            let Some(path) = source else { continue };
            let text = workspace::read(&path);
            let head = text.lines().next().and_then(|line| line.strip_prefix("//! ")).unwrap_or_default();
            if head.split_whitespace().count() < FEWEST_WORDS || head.starts_with("See ") {
                faults.push(format!("{path} says only \"{head}\""));
            }
            if !heads.insert(head.to_owned()) {
                faults.push(format!("{path} says what another module says: \"{head}\""));
            }
        }
    }
    assert!(faults.is_empty(), "the first line of a module is its line in the map:\n{}", faults.join("\n"));
}

#[test]
fn each_walk_leads_through_a_dozen_files_at_most_and_all_are_there() {
    let walks = sections("Walk");
    assert_eq!(walks.len(), 2, "{walks:?}");
    for (title, lines) in walks {
        let files: Vec<String> = lines.iter().filter_map(|line| step(line)).collect();
        assert!((2..=LONGEST_WALK).contains(&files.len()), "{title}: {} files", files.len());
        for file in files {
            assert!(workspace::root().join(&file).is_file(), "{title}: {file} is gone");
        }
    }
}

#[test]
fn the_page_is_short_enough_to_be_read() {
    let words = workspace::read("ARCHITECTURE.md").split_whitespace().count();
    assert!(words <= MOST_WORDS, "ARCHITECTURE.md has {words} words");
}

#[test]
fn the_three_files_to_open_first_are_there() {
    let text = workspace::read("ARCHITECTURE.md");
    let named: Vec<String> = (1..=3)
        .filter_map(|number| {
            let start = format!("\n{number}. `");
            text.split(&start).nth(1).and_then(quoted)
        })
        .collect();
    assert_eq!(named.len(), 3, "{named:?}");
    for file in named {
        assert!(workspace::root().join(&file).is_file(), "{file} is gone");
    }
}

#[test]
fn every_test_named_for_a_safety_rule_exists() {
    let text = workspace::read("SAFETY.md");
    let rows = text.lines().filter(|line| line.starts_with("| "));
    let named: BTreeSet<&str> = rows.flat_map(|row| row.split('`').skip(1).step_by(2)).collect();
    assert!(named.len() > 60, "only {} tests are named", named.len());
    let unindented = |path: &String| workspace::read(path).replace("\n    ", "\n");
    let sources: Vec<String> = workspace::rust_files().iter().map(unindented).collect();
    let exists = |name: &&str| {
        let test = format!("#[test]\nfn {name}()");
        sources.iter().any(|source| source.contains(&test))
    };
    let gone: Vec<_> = named.into_iter().filter(|name| !exists(name)).collect();
    assert!(gone.is_empty(), "SAFETY.md names tests that are not there: {gone:#?}");
}
