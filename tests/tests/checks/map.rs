//! Compares the map in `ARCHITECTURE.md` with the tree, both ways.
//!
//! In the map a crate is a heading `### \`folder\` …` and a module a line `- \`module\`: …` below it.

use std::collections::{BTreeMap, BTreeSet};

use brushwork_tests::workspace::{self, Metadata};

/// Crate folders of the map, each with the modules named under it.
fn map() -> BTreeMap<String, BTreeSet<String>> {
    let text = workspace::read("ARCHITECTURE.md");
    let mut crates: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut current: Option<String> = None;
    for line in text.lines() {
        if line.starts_with('#') {
            current = line.strip_prefix("### `").and_then(quoted);
            if let Some(folder) = &current {
                crates.entry(folder.clone()).or_default();
            }
        } else if let (Some(folder), Some(module)) = (&current, line.strip_prefix("- `").and_then(quoted)) {
            crates.entry(folder.clone()).or_default().insert(module);
        }
    }
    crates
}

fn quoted(rest: &str) -> Option<String> {
    rest.split_once('`').map(|(name, _)| name.to_owned())
}

#[test]
fn every_crate_has_a_heading_in_the_map_and_every_heading_a_crate() {
    let in_map: BTreeSet<String> = map().into_keys().collect();
    let in_tree: BTreeSet<String> =
        Metadata::load().members.into_iter().map(|member| member.folder).collect();
    assert_eq!(in_map, in_tree);
}

#[test]
fn every_module_has_a_line_in_the_map() {
    let map = map();
    let mut missing = Vec::new();
    for member in Metadata::load().members {
        let named = map.get(&member.folder).cloned().unwrap_or_default();
        for module in workspace::first_level_modules(&member.folder) {
            if !named.contains(&module) {
                missing.push(format!("{}/src/{module}", member.folder));
            }
        }
    }
    assert!(missing.is_empty(), "ARCHITECTURE.md has no line for {missing:#?}");
}

#[test]
fn every_line_of_the_map_names_something_that_exists() {
    let root = workspace::root();
    let mut gone = Vec::new();
    for (folder, modules) in map() {
        for module in modules {
            let below = ["src", "tests", "tests/checks", "tests/program", "benches", "fuzz", "."].iter().any(
                |part| {
                    let path = root.join(&folder).join(part).join(&module);
                    path.exists() || path.with_extension("rs").exists()
                },
            );
            if !below {
                gone.push(format!("{folder}: {module}"));
            }
        }
    }
    assert!(gone.is_empty(), "ARCHITECTURE.md names what is not there: {gone:#?}");
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
    let text = workspace::read("ARCHITECTURE.md");
    let (_, section) = text.split_once("## Safety rules and their tests").expect("the section is there");
    let rows =
        section.split("\n## ").next().unwrap_or_default().lines().filter(|line| line.starts_with("| "));
    let named: BTreeSet<&str> = rows.flat_map(|row| row.split('`').skip(1).step_by(2)).collect();
    assert!(named.len() > 60, "only {} tests are named", named.len());
    let sources: Vec<String> = workspace::rust_files().iter().map(|path| workspace::read(path)).collect();
    let exists = |name: &&str| {
        let test = format!("#[test]\nfn {name}()");
        sources.iter().any(|source| source.replace("\n    ", "\n").contains(&test))
    };
    let gone: Vec<_> = named.into_iter().filter(|name| !exists(name)).collect();
    assert!(gone.is_empty(), "ARCHITECTURE.md names tests that are not there: {gone:#?}");
}
