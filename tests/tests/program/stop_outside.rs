//! `brushwork stop` while another brushwork holds the line: that program stops it, and both say so. What is off is seen in the simulator.
#![cfg(unix)]

use std::os::unix::fs::symlink;
use std::time::Duration;

use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::machine::Machine;
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::served::{Served, mcp, motion_mind};
use brushwork_tests::simulated::{LATE_PTY, OnPty, OnTcp, is_driven};
use brushwork_tests::wait::{self, LIMIT};

use crate::guardian::{TRIES, driving as driving_on, started_driving};

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");
const DONE: i32 = 0;
const NO_LINK: i32 = 3;
const REFUSED: i32 = 4;
const TOO_LATE: i32 = 11;
/// What a program says that was stopped.
const STOPPED: &str = "Stopped by `brushwork stop`, from another program.";

fn stop(target: &str, more: &[&str]) -> Ending {
    Program::start(BRUSHWORK, &[&["stop", "-c", target][..], more].concat()).finish(LIMIT)
}

/// The motor is off when that is told, but for the ramp to rest. The controller's own time-out is a minute, or none.
fn assert_off<M: Machine>(served: &Served<M>) {
    const RAMP: Duration = Duration::from_millis(100);
    let (_, told_at) = served.look();
    let off = || Some(served.look()).filter(|(is_driven, _)| !is_driven);
    let (_, off_at) = wait::until_some("a motor that is off", off, || "it is driven".to_owned());
    assert!(off_at < told_at + RAMP, "{:?}", off_at.saturating_sub(told_at));
}

/// The holder says who stopped it, and ends as something does that a safety rule ended.
fn assert_was_told(holder: Program) {
    assert_says_who_stopped(&holder.finish(LIMIT));
}

/// Whether this machine was too crowded for a program or for its controller.
fn was_late(ending: &Ending) -> bool {
    ending.was_starved() || ending.found_silence()
}

fn assert_says_who_stopped(ending: &Ending) {
    assert_eq!(ending.status.code(), Some(REFUSED), "{ending:?}");
    assert_eq!(ending.stderr.iter().filter(|line| *line == STOPPED).count(), 1, "{ending:?}");
}

/// Whoever stopped says what stands now, and by whom.
fn assert_tells(ending: &Ending, unit: &str, holder: u32, command: &str) {
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    assert!(ending.stdout[0].starts_with(unit), "{ending:?}");
    let by =
        format!("The line is held by brushwork {command} (process {holder}), which was asked to stop it.");
    assert_eq!(ending.stderr.first(), Some(&by), "{ending:?}");
}

/// A drive on a new controller is stopped from outside at `place_of` where it is served. Again where its controller was not heard in time, as
/// on a crowded machine, where a pseudo-terminal is late; or where the drive had ended before for such a reason.
fn assert_drive_is_stopped<M: Machine + 'static>(
    serve: impl Fn() -> Served<M>,
    place_of: impl Fn(&str) -> String,
    more: &[&str],
    stopped: &str,
) {
    let stopped_one = || {
        let served = serve();
        let drive = driving_on(&served);
        let holder = drive.id();
        let ending = stop(&place_of(&served.target), more);
        assert_off(&served);
        (holder, ending, drive.finish(LIMIT))
    };
    let is_heard = |(_, ending, drive): &(u32, Ending, Ending)| !(ending.found_silence() || was_late(drive));
    let heard = (0..TRIES).map(|_| stopped_one()).find(is_heard);
    let (holder, ending, drive) = heard.expect("a machine with some room");
    // What the drive says comes first: one that had ended for another reason has nobody tell that it was stopped.
    assert_says_who_stopped(&drive);
    assert_tells(&ending, stopped, holder, "drive");
}

#[test]
fn a_drive_is_stopped_from_outside_on_either_family_over_serial_and_tcp() {
    let stopped = "0x80: both motors stopped";
    assert_drive_is_stopped(|| Served::on_pty(mcp(), ",stream=usb"), str::to_owned, &[], stopped);
    // Another name of the same place.
    let localhost = |target: &str| target.replace("127.0.0.1", "localhost");
    let address = ["--address", "0x80"];
    assert_drive_is_stopped(|| Served::on_tcp(mcp(), ",stream=usb"), localhost, &address, stopped);
    let mind = || Served::on_pty(motion_mind(), ",family=motion-mind");
    assert_drive_is_stopped(mind, str::to_owned, &[], "unit 1: motor stopped");
}

#[test]
fn a_link_to_the_port_is_the_port_and_json_says_by_whom() {
    let controller = OnPty::patient(Generation::Gen1);
    let drive = driving(&controller);
    let link = controller.port().with_file_name("usb-Basicmicro-if00");
    symlink(controller.port(), &link).expect("the folder can be written to");
    let ending = stop(&format!("{}{LATE_PTY}", link.display()), &["--json"]);
    controller.wait_until_off().assert_by_command();
    let told: serde_json::Value = serde_json::from_str(&ending.stdout.join("\n")).expect("JSON");
    assert_eq!((&told["confirmed"], &told["by"]["process"]), (&true.into(), &drive.id().into()), "{told}");
    assert_eq!(told["units"][0]["address"], 0x80);
    assert_was_told(drive);
}

fn driving(controller: &OnPty) -> Program {
    let target = controller.target();
    let words = ["drive", "-c", &target, "--motor", "1", "--duty", "40", "--for", "600"];
    started_driving(|| Program::start(BRUSHWORK, &words), || controller.look(is_driven))
}

/// A drive knows one unit of a line; whoever stops the line means all of them.
#[test]
fn units_that_the_other_program_has_not_looked_for_are_stopped_too() {
    let controller = OnTcp::line(&[0x80, 0x83]);
    let target = format!("{},stream=ttl1", controller.port().display());
    let words = ["drive", "-c", &target, "--address", "0x80", "--motor", "1", "--duty", "40", "--for", "600"];
    let stopped = || {
        controller.set_all_going();
        let mut drive = Program::start(BRUSHWORK, &words);
        drive.next_line(LIMIT);
        let ending = stop(&target, &[]);
        wait::until(
            "motors off",
            || controller.driven() == [false, false],
            || format!("{:?}", controller.driven()),
        );
        (ending, drive.finish(LIMIT))
    };
    // A drive that has ended before, since this machine is too crowded for it or for the controller, has nothing to say.
    let has_driven = |(_, drive): &(Ending, Ending)| !was_late(drive);
    let (ending, drive) = (0..TRIES).map(|_| stopped()).find(has_driven).expect("a machine with some room");
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    let others =
        "The stop was written to 0x81 to 0x87 too, where that program may not have looked for units.";
    assert!(ending.stderr.iter().any(|line| line == others), "{ending:?}");
    assert_says_who_stopped(&drive);
}

#[test]
fn a_tuning_run_is_stopped_from_outside_and_puts_back_what_it_changed() {
    let controller = OnTcp::start(Generation::Gen2);
    let before = controller.look(|unit| unit.settings().motors[0].motion);
    let target = format!("{},stream=usb", controller.port().display());
    // A busy computer may be too late for a run before it drives, which the run says.
    let driving = (0..TRIES).find_map(|_| {
        let mut tune = Program::start(BRUSHWORK, &["tune", "velocity", "-c", &target, "--dry-run"]);
        let has_come = || controller.look(is_driven) || !tune.is_running();
        wait::until("a driven motor", has_come, || "it stands".to_owned());
        if tune.is_running() {
            return Some(tune);
        }
        let ending = tune.finish(LIMIT);
        assert_eq!(ending.status.code(), Some(TOO_LATE), "{ending:?}");
        None
    });
    let tune = driving.expect("a run drives");
    let ending = stop(&target, &[]);
    assert_tells(&ending, "0x80: both motors stopped", tune.id(), "tune");
    let ending = tune.finish(LIMIT);
    assert_eq!(ending.status.code(), Some(REFUSED), "{ending:?}");
    assert!(ending.stderr.iter().any(|line| line == STOPPED), "{ending:?}");
    assert!(!controller.look(is_driven));
    assert_eq!(controller.look(|unit| unit.settings().motors[0].motion), before, "{ending:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_window_is_stopped_from_outside_and_stays_open() {
    use brushwork_mcp_wire::packet_serial::{Address, Request};
    use brushwork_tests::foreign::is_left_out;
    use brushwork_tests::screen::Screen;
    if is_left_out("xvfb") {
        return;
    }
    let controller = OnTcp::patient(Generation::Gen1);
    let screen = Screen::start();
    let (mut window, _) = crate::window::connected_window(&screen, &controller);
    let duty = Request::new(Address::ALL[0], 34, &[16_384, -16_384]);
    controller.receive(duty.encode(Generation::Gen1).expect("command 34 has two arguments"));
    controller.wait_until("driven motors", is_driven);
    let ending = stop(&controller.target(), &[]);
    controller.wait_until_off().assert_by_command();
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    let by = format!(
        "The line is held by the window of brushwork (process {}), which was asked to stop it.",
        window.id()
    );
    assert_eq!(ending.stderr[0], by);
    assert!(window.is_running());
}

/// One that moves nothing is not ended by its guardian: there is none.
#[test]
fn a_program_that_was_halted_at_rest_is_told_as_that() {
    let controller = OnPty::start(Generation::Gen1);
    let target = controller.target();
    let mut status = Program::start(BRUSHWORK, &["status", "-c", &target, "--watch"]);
    status.next_line(LIMIT);
    status.signal("STOP");
    let ending = stop(&target, &[]);
    status.signal("CONT");
    assert_eq!(ending.status.code(), Some(NO_LINK), "{ending:?}");
    let halted = format!("(process {}), which was halted by a signal and does not answer.", status.id());
    assert!(ending.stderr[0].contains(&halted), "{ending:?}");
}

/// One that drives is ended by its guardian, and the line is stopped and asked by whoever wanted it stopped.
#[test]
fn a_program_that_was_halted_or_killed_while_it_drove_hands_the_line_over() {
    // Whoever stops waits for units that are late, for seconds: both at once.
    std::thread::scope(|scope| {
        for signal in ["STOP", "KILL"] {
            scope.spawn(move || hands_the_line_over_after(signal));
        }
    });
}

fn hands_the_line_over_after(signal: &str) {
    let served = Served::on_pty(motion_mind(), ",family=motion-mind");
    // On a crowded machine the terminal may be too late for whoever stops, who has had the line then all the same.
    let is_heard = |ending: &Ending| {
        let was_silent = |line: &String| line.starts_with("Could not find a controller on");
        ending.status.code() != Some(NO_LINK) || !ending.stderr.iter().any(was_silent)
    };
    let is_stopped = |ending: &Ending| {
        assert_eq!(ending.status.code(), Some(DONE), "{signal}: {ending:?}");
        assert!(ending.stdout[0].starts_with("unit 1: motor stopped"), "{signal}: {ending:?}");
        assert!(ending.stderr.iter().all(|line| !line.contains("held by")), "{signal}: {ending:?}");
    };
    let handed_over = || {
        let mut drive = driving_on(&served);
        drive.signal(signal);
        let ending = stop(&served.target, &[]);
        assert_off(&served);
        wait::until("its end", || !drive.is_running(), || "it is there".to_owned());
        ending
    };
    let heard = (0..TRIES).map(|_| handed_over()).find(is_heard);
    is_stopped(&heard.expect("a machine with some room"));
    // Nothing is left of it.
    let again = (0..TRIES).map(|_| stop(&served.target, &[])).find(is_heard);
    is_stopped(&again.expect("a machine with some room"));
}
