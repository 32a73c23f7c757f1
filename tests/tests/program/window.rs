//! The real window on an X server without a screen, drawn by Mesa's software renderer; and what is said where there is none.
#![cfg(target_os = "linux")]
#![expect(clippy::print_stdout, reason = "figures belong into the record of a test run")]

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use brushwork_mcp_wire::packet_serial::{Address, Generation, Request};
use brushwork_tests::foreign::is_left_out;
use brushwork_tests::hands::{Hands, Key};
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::screen::{self, Picture, Screen};
use brushwork_tests::simulated::{OnPort, OnPty, OnTcp, is_driven};
use brushwork_tests::wait::{self, LIMIT};

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// More than any blank or broken picture has: text alone, being smoothed, has more.
const COLOURS_OF_A_WINDOW: usize = 200;

/// A few indicators of some ten pixels across; an unconnected window has none.
const GREEN_OF_INDICATORS: usize = 400;

fn window_on(display: &str) -> Command {
    screen::on_display(BRUSHWORK, display)
}

/// A window that was opened on a controller, and what it looks like once its indicators are green.
pub fn connected_window<const IS_PTY: bool>(
    screen: &Screen,
    controller: &OnPort<IS_PTY>,
) -> (Program, Picture) {
    let mut command = window_on(screen.display());
    command.arg("--open").arg(controller.target());
    let window = Program::spawn(command);
    match screen.wait_for(|picture| picture.green() >= GREEN_OF_INDICATORS) {
        Some(picture) => (window, picture),
        None => panic!("no indicator is green: {:?}", window.finish(Duration::ZERO)),
    }
}

/// One sentence on standard error that names the command line; no panic, no trace, nothing else.
fn assert_says_why(ending: &Ending, reason: &str) {
    assert_eq!(ending.status.code(), Some(1), "{ending:?}");
    assert_eq!((ending.stdout.len(), ending.stderr.len()), (0, 1), "{ending:?}");
    let sentence = &ending.stderr[0];
    assert!(sentence.contains(reason) && sentence.contains("brushwork --help"), "{sentence}");
    println!("{sentence}");
}

#[test]
fn the_window_opens_and_shows_something() {
    if is_left_out("xvfb") {
        return;
    }
    let screen = Screen::start();
    let mut window = Program::spawn(window_on(screen.display()));
    let picture = screen.wait_for(|picture| picture.colours() >= COLOURS_OF_A_WINDOW);
    let Some(picture) = picture else { panic!("nothing is drawn: {:?}", window.finish(Duration::ZERO)) };
    println!("{} colours on {} x {} pixels", picture.colours(), picture.width, picture.height);
    assert!(window.is_running(), "the window stays open");
}

#[test]
fn a_window_opened_on_a_controller_lights_its_indicators_and_moves_nothing() {
    if is_left_out("xvfb") {
        return;
    }
    let controller = OnPty::start(Generation::Gen4);
    let screen = Screen::start();
    let (mut window, picture) = connected_window(&screen, &controller);
    println!("{} green pixels", picture.green());
    assert!(window.is_running(), "the window stays open");
    assert!(controller.look(|unit| unit.view().axes.iter().all(|axis| axis.encoder_counts == 0)));
    assert!(!controller.look(is_driven));
}

/// A window that is ended by a signal stops the motors of its controller, whoever set them in motion, and ends cleanly.
fn signal_stops_and_closes(name: &str) {
    if is_left_out("xvfb") {
        return;
    }
    let controller = OnTcp::patient(Generation::Gen1);
    let screen = Screen::start();
    let (mut window, _) = connected_window(&screen, &controller);
    let duty = Request::new(Address::ALL[0], 34, &[16_384, -16_384]);
    controller.receive(duty.encode(Generation::Gen1).expect("command 34 has two arguments"));
    controller.wait_until("driven motors", is_driven);
    controller.let_pass(Duration::from_millis(1500));
    assert!(controller.look(is_driven) && window.is_running(), "they go on while the window is open");
    window.signal(name);
    controller.wait_until_off().assert_by_command();
    let ending = window.finish(LIMIT);
    assert!(ending.status.success() && ending.stderr.is_empty(), "{ending:?}");
}

#[test]
fn sigterm_stops_both_motors_and_closes_the_window() {
    signal_stops_and_closes("TERM");
}

#[test]
fn ctrl_c_stops_both_motors_and_closes_the_window() {
    signal_stops_and_closes("INT");
}

#[test]
fn a_closed_terminal_stops_both_motors_and_closes_the_window() {
    signal_stops_and_closes("HUP");
}

#[test]
fn a_broken_memory_of_the_window_does_not_keep_it_from_opening_and_is_made_anew() {
    if is_left_out("xvfb") {
        return;
    }
    let screen = Screen::start();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let state = folder.path().join("window.json");
    fs::write(&state, "{ this is no JSON").expect("the folder can be written to");
    let mut command = window_on(screen.display());
    command.env("BRUSHWORK_DATA_DIR", folder.path());
    let window = Program::spawn(command);
    let picture = screen.wait_for(|picture| picture.colours() >= COLOURS_OF_A_WINDOW);
    assert!(picture.is_some(), "nothing is drawn");
    window.signal("TERM");
    let ending = window.finish(LIMIT);
    assert!(ending.status.success(), "{ending:?}");
    assert!(folder.path().join("window.json.broken").exists());
    let kept: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&state).expect("it is kept")).expect("JSON");
    assert_eq!(kept["screen"], "Device Status");
    assert!(kept["window"]["size"][0].as_f64().is_some_and(|width| width >= 1000.0), "{kept}");
}

/// From an empty window to a turning motor and back, with the hands: what a first user does. The picture is kept beside the test's
/// record.
#[test]
fn hands_on_keyboard_and_mouse_arm_drive_and_stop_a_motor() {
    if is_left_out("xvfb") {
        return;
    }
    let controller = OnTcp::patient(Generation::Gen1);
    let screen = Screen::start();
    let (mut window, _) = connected_window(&screen, &controller);
    let hands = Hands::at(screen.display());
    hands.click(640, 700);
    hands.focus();
    hands.press(&[Key::Control, Key::Char('3')]);
    wait::until(
        "a slider that moves its motor",
        || drives_by_hand(&hands, &controller),
        || format!("{:?}", controller.look(|unit| unit.view().axes.map(|axis| axis.output))),
    );
    let picture = screen.picture();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    if let Some(picture) = &picture {
        picture.keep(&folder.join("window-driving.png"));
        println!("the window while it drove: {}", folder.join("window-driving.png").display());
    }
    hands.press(&[Key::Space]);
    controller.wait_until_off().assert_by_command();
    assert!(window.is_running());
}

/// Arms, and finds the slider. A machine
/// that is too busy to paint the window in time disarms it, so this may have to be done again.
fn drives_by_hand(hands: &Hands, controller: &OnTcp) -> bool {
    hands.press(&[Key::Escape]);
    hands.arm();
    controller.let_pass(Duration::from_millis(1500));
    assert!(!controller.look(is_driven), "arming alone moves nothing");
    hands.slide(|| controller.look(is_driven))
}

#[test]
fn without_a_display_the_command_line_is_named() {
    let mut command = Command::new(BRUSHWORK);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    assert_says_why(&Program::spawn(command).finish(LIMIT), "no display");
}

#[test]
fn a_display_that_does_not_answer_is_told_in_a_sentence() {
    assert_says_why(&Program::spawn(window_on(":4095")).finish(LIMIT), "X server");
}

#[test]
fn a_missing_library_is_told_with_the_package_that_brings_it() {
    if is_left_out("xvfb") {
        return;
    }
    let screen = Screen::start();
    let folder = tempfile::tempdir().expect("a temporary folder");
    // The loader looks here first, and a file that is no library is as good as none.
    for name in ["libXcursor.so.1", "libXcursor.so"] {
        fs::write(folder.path().join(name), "not a library").expect("the folder can be written to");
    }
    let mut command = window_on(screen.display());
    command.env("LD_LIBRARY_PATH", folder.path());
    assert_says_why(&Program::spawn(command).finish(LIMIT), "libxcursor1");
}
