//! Keeps the house rules that neither rustfmt nor clippy can see.

use std::collections::BTreeSet;

use brushwork_tests::rust_source::{Function, functions, without_tests};
use brushwork_tests::workspace;

/// A longer file says why in a line that starts with this.
const REASON_FOR_LENGTH: &str = "//! Long because";

/// No file is longer without a written reason.
const MAX_FILE_LINES: usize = 1_200;

/// No function is longer.
const MAX_FUNCTION_LINES: usize = 120;

fn sources() -> impl Iterator<Item = (String, String)> {
    workspace::rust_files().into_iter().map(|path| {
        let source = workspace::read(&path);
        (path, source)
    })
}

fn assert_none(what: &str, faults: &[String]) {
    assert!(faults.is_empty(), "{what}:\n{}", faults.join("\n"));
}

#[test]
fn every_file_opens_by_saying_what_it_is_for() {
    let faults: Vec<String> =
        sources().filter(|(_, source)| !source.starts_with("//! ")).map(|(path, _)| path).collect();
    assert_none("no `//!` in the first line", &faults);
}

#[test]
fn no_file_is_long_without_a_reason() {
    let faults: Vec<String> = sources()
        .filter(|(_, source)| source.lines().count() > MAX_FILE_LINES && !source.contains(REASON_FOR_LENGTH))
        .map(|(path, source)| format!("{path}: {} lines", source.lines().count()))
        .collect();
    assert_none("longer than 1,200 lines", &faults);
}

#[test]
fn no_function_is_longer_than_a_screen_and_a_half() {
    let mut faults = Vec::new();
    for (path, source) in sources() {
        for function in functions(&source) {
            if function.length_lines > MAX_FUNCTION_LINES {
                faults.push(format!(
                    "{path}:{}: {} has {}",
                    function.line, function.name, function.length_lines
                ));
            }
        }
    }
    assert_none("functions of more than 120 lines", &faults);
}

#[test]
fn the_tree_as_a_whole_stays_readable() {
    let mut file_lines = Vec::new();
    let mut plain = Vec::new();
    let mut drawing = Vec::new();
    for (path, source) in sources().filter(|(path, _)| path.contains("/src/")) {
        file_lines.push(source.lines().count());
        let (ui, other): (Vec<Function>, Vec<Function>) =
            functions(without_tests(&source)).into_iter().partition(|f| draws(&path, f));
        plain.extend(other.iter().map(|function| function.length_lines));
        drawing.extend(ui.iter().map(|function| function.length_lines));
    }
    let figures = format!(
        "files: median {}, p90 {}; functions: median {}, p90 {}; `_ui` functions: p90 {}",
        percentile(&mut file_lines, 50),
        percentile(&mut file_lines, 90),
        percentile(&mut plain, 50),
        percentile(&mut plain, 90),
        percentile(&mut drawing, 90),
    );
    println!("{figures}");
    assert!(percentile(&mut file_lines, 50) <= 300 && percentile(&mut file_lines, 90) <= 700, "{figures}");
    assert!(percentile(&mut plain, 50) <= 12 && percentile(&mut plain, 90) <= 40, "{figures}");
    assert!(percentile(&mut drawing, 90) <= 60, "{figures}");
}

fn draws(path: &str, function: &Function) -> bool {
    path.starts_with("app/") && (function.name.ends_with("_ui") || function.name == "ui")
}

fn percentile(values: &mut [usize], percent: usize) -> usize {
    values.sort_unstable();
    let last = values.len().saturating_sub(1);
    values.get(last * percent / 100).copied().unwrap_or(0)
}

#[test]
fn every_promise_has_an_owner_and_no_test_is_switched_off() {
    let promises = ["TO", "FIX"].map(|start| format!("{start}{}", if start == "TO" { "DO" } else { "ME" }));
    let switched_off = format!("#[{}", "ignore");
    let mut faults = Vec::new();
    for (path, source) in sources() {
        for (index, line) in source.lines().enumerate() {
            let unowned = promises.iter().any(|word| {
                line.find(word.as_str()).is_some_and(|at| !line[at + word.len()..].starts_with('('))
            });
            if unowned || line.trim_start().starts_with(&switched_off) {
                faults.push(format!("{path}:{}: {}", index + 1, line.trim()));
            }
        }
    }
    assert_none("without an owner, or switched off", &faults);
}

#[test]
fn no_file_names_a_folder_of_somebodys_machine() {
    let folders = ["home", "root", "Users", "work"].map(|name| format!("/{name}/"));
    let mut faults = Vec::new();
    for path in workspace::text_files() {
        for (index, line) in workspace::read(&path).lines().enumerate() {
            let starts =
                |at: usize| !line[..at].ends_with(|c: char| c.is_alphanumeric() || "._-)}\"'".contains(c));
            if folders.iter().any(|folder| line.find(folder.as_str()).is_some_and(starts)) {
                faults.push(format!("{path}:{}: {}", index + 1, line.trim()));
            }
        }
    }
    assert_none("a path that exists on one machine only", &faults);
}

/// The programs that tests start by name, and what has them: packages that every Debian has, or that `tests/run` installs.
const PROGRAMS: [(&str, &str); 8] = [
    ("Xvfb", "tests/run"),
    ("bash", "bash"),
    ("chrt", "util-linux"),
    ("dbus-daemon", "tests/run"),
    ("env", "coreutils"),
    ("sh", "dash"),
    ("sleep", "coreutils"),
    ("true", "coreutils"),
];

#[test]
fn tests_start_only_programs_that_a_bare_debian_has_or_the_test_command_installs() {
    // It is there to start the program that it comes with.
    const PACKAGE: &str = "app/python/src/brushwork/";
    const OF_PYTHON: [&str; 4] = ["subprocess", "os.system", "os.popen", "os.exec"];
    let starts = ["Command::new", "Program::start"].map(|call| format!("{call}({}", '"'));
    let mut named = BTreeSet::new();
    let mut faults = Vec::new();
    for path in workspace::text_files() {
        let text = workspace::read(&path);
        if path.ends_with(".py") && !path.starts_with(PACKAGE) {
            faults.extend(
                OF_PYTHON.iter().filter(|word| text.contains(**word)).map(|word| format!("{path}: {word}")),
            );
        } else if path.ends_with(".rs") {
            for start in &starts {
                // The first part is before the first start.
                let names = text.split(start.as_str()).skip(1).filter_map(|rest| rest.split('"').next());
                named.extend(names.map(str::to_owned));
            }
        }
    }
    for name in &named {
        if !PROGRAMS.iter().any(|(program, _)| program == name) {
            faults.push(format!("`{name}` is started, and no package is named that has it"));
        }
    }
    let run = workspace::read("tests/run");
    for (program, package) in PROGRAMS {
        if !named.contains(program) {
            faults.push(format!("`{program}` is in the list and nothing starts it"));
        }
        if package == "tests/run" && !run.contains(&format!("command -v {program} ")) {
            faults.push(format!("tests/run does not look for `{program}`"));
        }
    }
    assert_none("programs that may not be there", &faults);
}
