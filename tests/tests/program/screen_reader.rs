//! The guided path by a screen reader's interface alone, in a real X session: AT-SPI over D-Bus (`tests/foreign/screen_reader.py`).
#![cfg(target_os = "linux")]

use std::process::Command;
use std::time::Duration;

use brushwork_child::Child;
use brushwork_tests::foreign::is_left_out;
use brushwork_tests::program::Program;
use brushwork_tests::screen::{self, Screen};
use brushwork_tests::wait::LIMIT;
use brushwork_tests::workspace;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");
/// The system's own, which has the modules of Debian's packages python3-dbus and python3-gi.
const PYTHON: &str = "/usr/bin/python3";
/// One tuning run in real time, and a walk over some hundred objects for each act.
const READING: Duration = Duration::from_secs(10 * 60);

/// What the reader reports, a line each.
const STEPS: [&str; 6] =
    ["start page", "connected", "armed", "the direction seen, and stopped", "tuned", "saved"];

#[test]
fn by_a_screen_reader_alone_from_an_empty_start_to_a_tuned_and_saved_axis() {
    if is_left_out("xvfb") || is_left_out("at_spi") {
        return;
    }
    let screen = Screen::start();
    let mut of_bus = Command::new("dbus-daemon");
    of_bus.args(["--session", "--nofork", "--print-address=1"]).env("DISPLAY", screen.display());
    let mut bus = Program::spawn(of_bus);
    let Some(address) = bus.next_line(LIMIT) else { panic!("no bus: {:?}", bus.finish(LIMIT)) };
    let on_bus = |mut command: Command| {
        command.env("DBUS_SESSION_BUS_ADDRESS", &address).env("DISPLAY", screen.display());
        command
    };
    let mut window = Program::spawn(on_bus(screen::on_display(BRUSHWORK, screen.display())));
    let mut reader = on_bus(Command::new(PYTHON));
    reader.arg(workspace::root().join("tests/foreign/screen_reader.py")).env("PYTHONDONTWRITEBYTECODE", "1");
    let output = Child::output(&reader, b"", READING);
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    assert!(output.status.success(), "{said}\n{}", String::from_utf8_lossy(&output.stderr));
    for step in STEPS {
        assert!(said.lines().any(|line| line.starts_with(&format!("{step}: "))), "{step} is not reached");
    }
    assert!(window.is_running(), "the window stays open");
}
