//! The second process of the program: whatever becomes of the first, the motors that it drove are stopped. The controllers here have no
//! time-out of their own, or one of a minute.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::time::Duration;

use brushwork_plant::machine::Machine;
use brushwork_tests::program::Program;
use brushwork_tests::served::{Served, mcp, motion_mind};
use brushwork_tests::wait;
use rustix::process::{Pid, Signal, kill_process};

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");
/// Far less than the controllers' own time-out.
const SOON: Duration = Duration::from_secs(5);
const TRIES: u32 = 20;

fn drive<M: Machine + 'static>(served: &Served<M>, seconds: &str) -> Program {
    let words = ["drive", "--connect", &served.target, "--motor", "1", "--duty", "40", "--for", seconds];
    Program::start(BRUSHWORK, &words.map(str::to_owned))
}

/// A program that drives its motor. Where this machine is too crowded for one of the two, it is tried again.
pub fn driving<M: Machine + 'static>(served: &Served<M>) -> Program {
    for _ in 0..TRIES {
        let mut program = drive(served, "600");
        let drives_or_ended = || served.look().0 || !program.is_running();
        wait::until("a driven motor, or the end", drives_or_ended, || "it stands".to_owned());
        if program.is_running() {
            return program;
        }
        let ending = program.finish(SOON);
        assert!(ending.was_starved() || ending.found_silence(), "{ending:?}");
    }
    panic!("the machine has no processor for a drive in {TRIES} tries");
}

/// The motor is off soon after `signal`. Returns how long that took in the machine's time.
fn is_stopped_after<M: Machine + 'static>(served: &Served<M>, signal: &str) -> Duration {
    let program = driving(served);
    let took = served.off_after(|| program.signal(signal), SOON);
    println!("SIG{signal} on {}: off after {took:?}", served.target);
    took.expect("the motor is off").driven_for
}

#[test]
fn a_killed_program_leaves_no_motor_driven_on_either_family_over_serial_and_tcp() {
    is_stopped_after(&Served::on_pty(motion_mind(), ",family=motion-mind"), "KILL");
    is_stopped_after(&Served::on_tcp(motion_mind(), ",family=motion-mind"), "KILL");
    is_stopped_after(&Served::on_pty(mcp(), ",stream=usb"), "KILL");
    // A line that may be late is the same line.
    is_stopped_after(&Served::on_tcp(mcp(), ",stream=usb,latency=800"), "KILL");
}

#[test]
fn a_program_that_stands_still_while_it_drives_is_ended_and_its_motor_stopped() {
    let served = Served::on_pty(motion_mind(), ",family=motion-mind");
    let took = is_stopped_after(&served, "STOP");
    assert!(took > Duration::from_millis(200), "the dead-man inside comes first: {took:?}");
}

/// The guardians of a process, as the list of processes names them.
pub fn of(program: u32) -> Vec<u32> {
    let words = format!("guardian\0{program}\0");
    let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let of_this = processes.filter(|process| {
        let line = std::fs::read(process.path().join("cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&line).contains(&words)
    });
    of_this.filter_map(|process| process.file_name().to_str()?.parse().ok()).collect()
}

/// Sends a signal to the guardians of a process.
pub fn signal(program: u32, signal: Signal) {
    for number in of(program).into_iter().filter_map(|number| Pid::from_raw(i32::try_from(number).ok()?)) {
        kill_process(number, signal).expect("it is there");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn it_is_there_while_something_is_armed_and_leaves_nothing_behind() {
    let served = Served::on_pty(mcp(), ",stream=usb");
    let mut program = driving(&served);
    let first = program.id();
    assert_eq!(of(first).len(), 1, "it is named in the list of processes");
    program.signal("INT");
    wait::until("its end", || !program.is_running(), || "it runs".to_owned());
    assert_eq!(of(first), [0; 0], "it is gone before the program is");
    // The port is free again at once.
    let again = drive(&served, "0.2");
    assert!(again.finish(wait::LIMIT).status.success());
    // A killed one takes its guardian along, once the stop is written.
    let program = driving(&served);
    let second = program.id();
    program.signal("KILL");
    wait::until("no guardian", || of(second).is_empty(), || "it is there".to_owned());
}
