//! Keeps circles of imports out of every crate, and views out of the window's state.

use std::collections::BTreeSet;

use brushwork_tests::imports::{Import, circles, imports, reached};
use brushwork_tests::rust_source::{code_lines, without_tests};
use brushwork_tests::workspace::{self, Metadata};

/// What code that draws names.
const DRAWING: [&str; 2] = ["Ui", "Painter"];

/// A crate's files below `src`, with what they say.
fn sources(folder: &str) -> Vec<(String, String)> {
    let start = format!("{folder}/src/");
    let below = |path: String| {
        let file = path.strip_prefix(&start)?.to_owned();
        Some((file, workspace::read(&path)))
    };
    workspace::rust_files().into_iter().filter_map(below).collect()
}

fn imports_of(sources: &[(String, String)]) -> Vec<Import> {
    let files: Vec<(&str, &str)> =
        sources.iter().map(|(file, text)| (file.as_str(), text.as_str())).collect();
    imports(&files)
}

fn draws(source: &str) -> bool {
    code_lines(without_tests(source)).iter().any(|line| {
        line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| DRAWING.contains(&word))
    })
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut faults = Vec::new();
    for member in Metadata::load().members {
        let imports = imports_of(&sources(&member.folder));
        let found = circles(&imports);
        let sizes: Vec<usize> = found.iter().map(BTreeSet::len).collect();
        println!("{}: {} circles of {sizes:?} files", member.folder, found.len());
        for (number, circle) in found.iter().enumerate() {
            let name = number + 1;
            faults.push(format!("{}: circle {name} of {} files:", member.folder, circle.len()));
            let inside = |import: &&Import| {
                circle.contains(import.from.as_str()) && circle.contains(import.to.as_str())
            };
            let edges = imports.iter().filter(inside);
            faults.extend(edges.map(|edge| format!("    {}:{} -> {}", edge.from, edge.line, edge.to)));
        }
    }
    assert!(faults.is_empty(), "files that import each other:\n{}", faults.join("\n"));
}

#[test]
fn the_windows_state_reaches_nothing_that_draws() {
    let sources = sources("app/gui");
    let imports = imports_of(&sources);
    // That of the shared screens, and each family's own.
    let is_state =
        |file: &&str| file.split('/').take(2).any(|folder| folder == "model") && file.contains('/');
    let state: Vec<&str> = sources.iter().map(|(file, _)| file.as_str()).filter(is_state).collect();
    let mut seen = reached(&imports, &state);
    seen.extend(&state);
    let views: BTreeSet<&str> = sources
        .iter()
        .filter(|(file, text)| seen.contains(file.as_str()) && draws(text))
        .map(|(file, _)| file.as_str())
        .collect();
    let ways: Vec<String> = imports
        .iter()
        .filter(|import| {
            let from = import.from.as_str();
            let is_state = seen.contains(from) && !views.contains(from);
            is_state && views.contains(import.to.as_str())
        })
        .map(|import| format!("{}:{} -> {}", import.from, import.line, import.to))
        .collect();
    let names: Vec<&str> = views.iter().copied().collect();
    assert!(
        views.is_empty(),
        "the window's state reaches what draws: {}\nby way of\n{}",
        names.join(" "),
        ways.join("\n")
    );
}
