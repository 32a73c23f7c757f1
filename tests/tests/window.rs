//! The real window on an X server without a screen, drawn by Mesa's software renderer; and what is said where there is none.
#![cfg(target_os = "linux")]
#![expect(clippy::print_stdout, reason = "figures belong into the record of a test run")]

use std::fs;
use std::process::Command;
use std::time::Duration;

use brushwork_protocol::packet_serial::Generation;
use brushwork_tests::foreign::is_left_out;
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::screen::{Picture, Screen};
use brushwork_tests::simulated::{OnPty, is_driven};

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

const LIMIT: Duration = Duration::from_secs(30);

/// More than any blank or broken picture has: text alone, being smoothed, has more.
const COLOURS_OF_A_WINDOW: usize = 200;

/// A few lamps of some ten pixels across; an unconnected window has none.
const GREEN_OF_LAMPS: usize = 400;

fn window_on(display: &str) -> Command {
    let mut command = Command::new(BRUSHWORK);
    command.env("DISPLAY", display).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command.env("LIBGL_ALWAYS_SOFTWARE", "1");
    command
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
    let picture = screen.wait_for(LIMIT, |picture| picture.colours() >= COLOURS_OF_A_WINDOW);
    let Some(picture) = picture else { panic!("nothing is drawn: {:?}", window.finish(Duration::ZERO)) };
    println!("{} colours on {} x {} pixels", picture.colours(), picture.width, picture.height);
    assert!(window.is_running(), "the window stays open");
}

#[test]
fn a_window_opened_on_a_controller_lights_its_lamps_and_moves_nothing() {
    if is_left_out("xvfb") {
        return;
    }
    let controller = OnPty::start(Generation::Gen4);
    let screen = Screen::start();
    let mut command = window_on(screen.display());
    command.arg("--open").arg(controller.port());
    let mut window = Program::spawn(command);
    let Some(picture) = screen.wait_for(LIMIT, |picture| green_pixels(picture) >= GREEN_OF_LAMPS) else {
        panic!("no lamp is green: {:?}", window.finish(Duration::ZERO))
    };
    println!("{} green pixels", green_pixels(&picture));
    assert!(window.is_running(), "the window stays open");
    assert!(controller.look(|unit| unit.view().axes.iter().all(|axis| axis.encoder_counts == 0)));
    assert!(!controller.look(is_driven));
}

/// Pixels of a lamp that says OK, whatever the theme's exact green.
fn green_pixels(picture: &Picture) -> usize {
    let is_green =
        |pixel: &&[u8]| pixel[1] > pixel[0].saturating_add(60) && pixel[1] > pixel[2].saturating_add(40);
    picture.rgb.chunks_exact(3).filter(is_green).count()
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
