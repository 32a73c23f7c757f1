//! Tests that need a process to themselves: for its memory, or for what it installs once.

use std::process::Command;
use std::time::Duration;

use brushwork_child::Child;

/// Set for a copy of this process, to the test that it is there for.
const ALONE: &str = "BRUSHWORK_TEST_ALONE";
/// More than a busy machine needs to start one.
pub const LIMIT: Duration = Duration::from_secs(900);

/// Does something in a copy of this process that runs this test and no other, and tells what the copy printed.
pub fn alone(test: &str, limit: Duration, act: impl FnOnce()) -> String {
    if std::env::var_os(ALONE).is_some_and(|name| name == test) {
        act();
        return String::new();
    }
    let mut copy = Command::new(std::env::current_exe().expect("a process has a program"));
    copy.args(["--exact", test, "--nocapture"]).env(ALONE, test);
    let ended = Child::output(&copy, b"", limit);
    let said = [ended.stdout, ended.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(ended.status.success() && said[0].contains("1 passed"), "{}", said.join("\n"));
    let [printed, _] = said;
    printed
}
