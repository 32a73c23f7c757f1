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
/// Lines of code of the product that may name one besides.
const MOST: usize = 10;
/// Lines of what measures and judges it, which is built for the families that there are. They are to come down.
const MOST_OF_BENCHES: usize = 45;

fn names_one(line: &str) -> bool {
    NAMES.iter().any(|name| line.contains(name))
}

fn is_of_a_family(path: &str) -> bool {
    path == LIST || path.starts_with("tests/") || FOLDERS.iter().any(|folder| path.contains(folder))
}

fn is_bench(path: &str) -> bool {
    path.starts_with("tuning/bench/") || path.starts_with("app/src/bench/")
}

#[test]
fn families_are_named_in_their_own_folders_and_in_one_list() {
    let (mut product, mut benches) = (Vec::new(), Vec::new());
    let sources = workspace::rust_files().into_iter().filter(|path| path.contains("/src/"));
    for path in sources.filter(|path| !is_of_a_family(path) && !path.ends_with("/tests.rs")) {
        let source = workspace::read(&path);
        let code = code_lines(without_tests(&source));
        // A text of several lines goes on behind a backslash.
        let goes_on = std::iter::once(false).chain(source.lines().map(|line| line.ends_with('\\')));
        for (index, (line, is_text)) in code.iter().zip(goes_on).enumerate() {
            if names_one(line) && !is_text {
                let found = format!("{path}:{}: {}", index + 1, line.trim());
                if is_bench(&path) { benches.push(found) } else { product.push(found) }
            }
        }
    }
    println!("{} lines of the product, {} of benches", product.len(), benches.len());
    assert!(product.len() <= MOST, "{} lines name a family:\n{}", product.len(), product.join("\n"));
    assert!(benches.len() <= MOST_OF_BENCHES, "{} lines:\n{}", benches.len(), benches.join("\n"));
}
