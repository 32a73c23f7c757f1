//! The Python package of `app/python` against the built program: its own tests, which pytest runs.
#![cfg(unix)]

use std::process::Command;
use std::time::Duration;

use brushwork_child::Child;
use brushwork_tests::{foreign, workspace};

/// What is tested: the simulator's side, the controller's side, the examples. Fewer means that pytest did not find them.
const FEWEST: usize = 17;

/// Each of them starts the program some times; on a busy machine that takes a while.
const LIMIT: Duration = Duration::from_secs(10 * 60);

#[test]
fn the_python_package_simulates_drives_and_sets_up_controllers() {
    if foreign::is_left_out("python") {
        return;
    }
    let package = workspace::root().join("app/python");
    let mut pytest = Command::new(foreign::python());
    pytest
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "brushwork.pytest_plugin"])
        .arg(package.join("tests"))
        .env("PYTHONPATH", package.join("src"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("BRUSHWORK_PROGRAM", env!("CARGO_BIN_EXE_brushwork-for-tests"));
    let output = Child::output(&pytest, b"", LIMIT);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let passed = said.lines().rev().find_map(|line| line.split(" passed").next()?.parse::<usize>().ok());
    assert!(passed.is_some_and(|passed| passed >= FEWEST), "{said}");
    assert!(!said.contains("skipped"), "{said}");
}
