//! Keeps the names of families where they belong: in their own folders and in the program's one list.

use brushwork_tests::rust_source::{code_lines, without_tests};
use brushwork_tests::workspace;

/// What names a family in code.
const NAMES: [&str; 15] = [
    "mcp",
    "Mcp",
    "MCP",
    "motion_mind",
    "MotionMind",
    "MOTION_MIND",
    "suprmotr",
    "SuprMotr",
    "SUPRMOTR",
    "motorvator",
    "Motorvator",
    "MOTORVATOR",
    "RoboClaw",
    "packet_serial",
    "PacketSerial",
];
/// The folders that are a family's own, wherever they are, and a file where one is enough.
const FOLDERS: [&str; 8] = [
    "/mcp/",
    "/motion_mind/",
    "/suprmotr/",
    "/motorvator/",
    "/mecc/",
    "/mcp.rs",
    "/motion_mind.rs",
    "/suprmotr.rs",
];
/// The program's list of families.
const LIST: &str = "app/src/lib.rs";
/// Lines of code that may name one besides, of all families together, benches included.
const MOST: usize = 10;

fn names_one(line: &str) -> bool {
    NAMES.iter().any(|name| line.contains(name))
}

/// Comments are for those who read the source, and may cite a manual; the help pages are not made of them where they would name one.
fn names_one_in_text(line: &str) -> bool {
    let line = line.split("//").next().unwrap_or_default().replace("MCP manual", "");
    names_one(&line) || IN_TEXTS.iter().any(|name| line.contains(name))
}

fn is_of_a_family(path: &str) -> bool {
    path == LIST || path.starts_with("tests/") || FOLDERS.iter().any(|folder| path.contains(folder))
}

/// The same with what texts name besides: models, and families as people call them.
const IN_TEXTS: [&str; 4] = ["sim:mcp", "mcp266", "motion-mind", "Motion Mind"];
/// Folders and files whose texts are about a family: the language of its scripts, and what is measured.
const ABOUT: [&str; 3] = ["device/script/", "tuning/bench/", "app/src/bench/"];
/// Lines of text that may name one.
const MOST_TEXTS: usize = 16;

#[test]
fn families_are_named_in_their_own_folders_and_in_one_list() {
    let mut found = Vec::new();
    let mut texts = Vec::new();
    let sources = workspace::rust_files().into_iter().filter(|path| path.contains("/src/"));
    for path in sources.filter(|path| !is_of_a_family(path) && !path.ends_with("/tests.rs")) {
        let source = workspace::read(&path);
        let source = without_tests(&source);
        let is_about = ABOUT.iter().any(|folder| path.starts_with(folder));
        // A text of several lines goes on behind a backslash.
        let goes_on = std::iter::once(false).chain(source.lines().map(|line| line.ends_with('\\')));
        for (index, ((code, line), is_text)) in
            code_lines(source).iter().zip(source.lines()).zip(goes_on).enumerate()
        {
            let place = || format!("{path}:{}: {}", index + 1, line.trim());
            if names_one(code) && !is_text {
                found.push(place());
            } else if !is_about && names_one_in_text(line) {
                texts.push(place());
            }
        }
    }
    println!("{} lines of code, {} of text", found.len(), texts.len());
    assert!(found.len() <= MOST, "{} lines name a family:\n{}", found.len(), found.join("\n"));
    assert!(texts.len() <= MOST_TEXTS, "{} lines of text name a family:\n{}", texts.len(), texts.join("\n"));
}
