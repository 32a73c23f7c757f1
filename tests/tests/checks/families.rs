//! Keeps the names of families where they belong: in their own folders and in the program's one list.

use brushwork_tests::rust_source::{code_lines, without_tests};
use brushwork_tests::workspace;

/// What names a family in code.
const NAMES: [&str; 9] = [
    "mcp",
    "Mcp",
    "MCP",
    "motion_mind",
    "MotionMind",
    "MOTION_MIND",
    "RoboClaw",
    "packet_serial",
    "PacketSerial",
];
/// The folders that are a family's own, wherever they are.
const FOLDERS: [&str; 2] = ["/mcp/", "/motion_mind/"];
/// The program's list of families.
const LIST: &str = "app/src/lib.rs";
/// Lines of code that may name one besides, benches included.
const MOST: usize = 10;

fn names_one(line: &str) -> bool {
    NAMES.iter().any(|name| line.contains(name))
}

fn is_of_a_family(path: &str) -> bool {
    path == LIST || path.starts_with("tests/") || FOLDERS.iter().any(|folder| path.contains(folder))
}

#[test]
fn families_are_named_in_their_own_folders_and_in_one_list() {
    let mut found = Vec::new();
    let sources = workspace::rust_files().into_iter().filter(|path| path.contains("/src/"));
    for path in sources.filter(|path| !is_of_a_family(path) && !path.ends_with("/tests.rs")) {
        let source = workspace::read(&path);
        let code = code_lines(without_tests(&source));
        // A text of several lines goes on behind a backslash.
        let goes_on = std::iter::once(false).chain(source.lines().map(|line| line.ends_with('\\')));
        for (index, (line, is_text)) in code.iter().zip(goes_on).enumerate() {
            if names_one(line) && !is_text {
                found.push(format!("{path}:{}: {}", index + 1, line.trim()));
            }
        }
    }
    println!("{} lines", found.len());
    assert!(found.len() <= MOST, "{} lines name a family:\n{}", found.len(), found.join("\n"));
}
