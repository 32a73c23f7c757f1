//! The second process of the program: whatever becomes of the first, the motors that it drove are stopped. The controllers here have no
//! time-out of their own, or one of a minute.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::io::{self, Read as _, Write as _};
use std::net::TcpListener;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, number};
use brushwork_plant::machine::Machine;
#[cfg(target_os = "linux")]
use brushwork_tests::foreign::is_left_out;
#[cfg(target_os = "linux")]
use brushwork_tests::hands::OpenWindow;
use brushwork_tests::program::Program;
use brushwork_tests::served::{Served, guardians_of, mcp, motion_mind, simulated};
use brushwork_tests::simulated::{OnPty, is_driven};
use brushwork_tests::wait;
use rustix::process::{Pid, Signal, kill_process};

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");
/// Far less than the controllers' own time-out.
const SOON: Duration = Duration::from_secs(5);
/// How often a drive is begun for which this machine may be too crowded.
pub const TRIES: u32 = 20;

fn drive<M: Machine + 'static>(served: &Served<M>, seconds: &str) -> Program {
    let words = ["drive", "--connect", &served.target, "--motor", "1", "--duty", "40", "--for", seconds];
    Program::start(BRUSHWORK, &words.map(str::to_owned))
}

/// A program that drives its motor.
pub fn driving<M: Machine + 'static>(served: &Served<M>) -> Program {
    started_driving(|| drive(served, "600"), || served.look().0)
}

/// The same of whatever program. Where this machine is too crowded for it or for the controller, it is tried again.
pub fn started_driving(start: impl Fn() -> Program, drives: impl Fn() -> bool) -> Program {
    for _ in 0..TRIES {
        let mut program = start();
        let drives_or_ended = || drives() || !program.is_running();
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

/// A SuprMotr that got a move makes it to its end, 40 s later, and a MotorVator has a time-out of its own.
#[test]
fn a_killed_program_leaves_no_move_of_a_suprmotr_or_motorvator_going() {
    let served = Served::on_pty(simulated("suprmotr", "suprmotr-v9"), ",family=suprmotr");
    let on = |words: &[&str]| Program::start(BRUSHWORK, &[words, &["--connect", &served.target]].concat());
    let slow = on(&["settings", "write", "motion.velocity=500", "--yes"]).finish(wait::LIMIT);
    assert!(slow.status.success(), "{slow:?}");
    ends_a_move(&served, || on(&["drive", "--by", "20000", "--for", "600"]));
    let served = Served::on_tcp(simulated("motorvator", "motorvator-3"), ",family=motorvator");
    let words = ["drive", "--connect", &served.target, "--duty", "40", "--for", "600"];
    ends_a_move(&served, || Program::start(BRUSHWORK, &words));
}

fn ends_a_move<M: Machine + 'static>(served: &Served<M>, start: impl Fn() -> Program) {
    let before = served.counts().0;
    let program = started_driving(start, || served.counts().0 != before);
    let (_, killed_at) = served.counts();
    program.signal("KILL");
    let mut last = served.counts();
    let stood_at = loop {
        let (counts, now) = served.counts();
        if counts != last.0 {
            last = (counts, now);
        } else if now >= last.1 + Duration::from_millis(300) {
            break last.1;
        }
        assert!(now < killed_at + SOON, "it moves on");
    };
    println!("SIGKILL on {}: stands after {:?}", served.target, stood_at.saturating_sub(killed_at));
}

#[test]
fn a_program_that_stands_still_while_it_drives_is_ended_and_its_motor_stopped() {
    let served = Served::on_pty(motion_mind(), ",family=motion-mind");
    let took = is_stopped_after(&served, "STOP");
    assert!(took > Duration::from_millis(200), "the dead-man inside comes first: {took:?}");
}

/// Sends a signal to the guardians of a process.
pub fn signal(program: u32, signal: Signal) {
    for number in
        guardians_of(program).into_iter().filter_map(|number| Pid::from_raw(i32::try_from(number).ok()?))
    {
        kill_process(number, signal).expect("it is there");
    }
}

/// The second process as it is started where a port has one owner, as on Windows, with a stop that it is to write there.
struct Waiting {
    orders: io::PipeWriter,
    process: Child,
}

impl Waiting {
    fn at(target: &str, stop: &[u8]) -> Self {
        let (heard, mut orders) = io::pipe().expect("a pipe");
        let mut command = Command::new(BRUSHWORK);
        command.args(["guardian", &std::process::id().to_string(), "the port", target]);
        #[expect(clippy::disallowed_methods, reason = "it ends when its pipe is closed, and is waited for")]
        let process = command.stdin(Stdio::null()).stdout(heard).spawn().expect("the program starts");
        let hold = serde_json::json!({ "hold": { "writes": [stop], "gap_ms": 0 } });
        writeln!(orders, "{hold}").expect("it reads");
        Self { orders, process }
    }

    fn first_dies(self) -> Child {
        drop(self.orders);
        self.process
    }
}

#[test]
fn a_port_that_has_one_owner_is_opened_and_stopped_when_that_one_is_gone() {
    let stop =
        Request::new(Address::DEFAULT, number::DUTY_BOTH, &[0, 0]).encode(Generation::Gen4).expect("it fits");
    let controller = OnPty::patient(Generation::Gen4);
    controller.set_all_going();
    let waiting = Waiting::at(&format!("{},baud=115200", controller.port().display()), &stop);
    assert!(controller.look(is_driven), "the first process lives");
    let mut guardian = waiting.first_dies();
    controller.wait_until("a motor that is off", |unit| !is_driven(unit));
    assert!(guardian.wait().expect("it ends").success());

    // A serial server that takes the next connection only a while after the first one is gone.
    let place = TcpListener::bind("127.0.0.1:0").and_then(|free| free.local_addr()).expect("a free port");
    let mut guardian = Waiting::at(&format!("tcp:{place}"), &stop).first_dies();
    let (mut line, _) = TcpListener::bind(place).and_then(|server| server.accept()).expect("it comes");
    let mut heard = Vec::new();
    line.read_to_end(&mut heard).expect("it hangs up");
    assert_eq!(heard, stop.repeat(4));
    assert!(guardian.wait().expect("it ends").success());
}

#[cfg(target_os = "linux")]
#[test]
fn a_window_whose_x_server_is_killed_leaves_no_motor_driven() {
    if is_left_out("xvfb") {
        return;
    }
    loses_its_display(&Served::on_pty(motion_mind(), ",family=motion-mind"));
    loses_its_display(&Served::on_pty(mcp(), ",stream=usb"));
}

#[cfg(target_os = "linux")]
fn loses_its_display<M: Machine + 'static>(served: &Served<M>) {
    // A window that draws too seldom on a crowded machine stops its motor before anybody takes its display away.
    let window = OpenWindow::on(BRUSHWORK, served);
    let drives = (0..TRIES).any(|_| {
        window.drive(served);
        served.look().0
    });
    assert!(drives, "a machine with room for a window that drives");
    let took = served.off_after(|| window.screen.kill(), SOON);
    println!("the X server of a window on {} killed: off after {took:?}", served.target);
    assert!(took.is_some(), "the motor is off");
    assert!(
        !window.program.finish(wait::LIMIT).status.success(),
        "a window without a display ends, and says so"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn it_is_there_while_something_is_armed_and_leaves_nothing_behind() {
    let served = Served::on_pty(mcp(), ",stream=usb");
    let mut program = driving(&served);
    let first = program.id();
    assert_eq!(guardians_of(first).len(), 1, "it is named in the list of processes");
    program.signal("INT");
    wait::until("its end", || !program.is_running(), || "it runs".to_owned());
    assert_eq!(guardians_of(first), [0; 0], "it is gone before the program is");
    // The port is free again at once.
    let again = drive(&served, "0.2").finish(wait::LIMIT);
    assert!(again.status.success() || again.was_starved() || again.found_silence(), "{again:?}");
    // A killed one takes its guardian along, once the stop is written.
    let program = driving(&served);
    let second = program.id();
    program.signal("KILL");
    wait::until("no guardian", || guardians_of(second).is_empty(), || "it is there".to_owned());
}
