//! The second process of the program: whatever becomes of the first, the motors that it drove are stopped. The controllers here have no
//! time-out of their own, or one of a minute.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::time::Duration;

use brushwork_mcp_sim::controller::{Bus, Controller};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use brushwork_tests::program::Program;
use brushwork_tests::simulated::patient;
use brushwork_tests::wait;
use rustix::process::{Pid, Signal, kill_process};
use tempfile::TempDir;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");
/// Far less than the controllers' own time-out.
const SOON: Duration = Duration::from_secs(5);

/// A controller that is served, and how it is reached.
pub struct Served<M: Machine> {
    handle: SimHandle<M>,
    pub target: String,
    _folder: TempDir,
}

impl<M: Machine + 'static> Served<M> {
    pub fn on_pty(machine: M, options: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let link = folder.path().join("port");
        let target = format!("{}{options}", link.display());
        Self::at(machine, &Endpoint::Pty { link }, folder, |_| target)
    }

    pub fn on_tcp(machine: M, options: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let endpoint = Endpoint::Tcp("127.0.0.1:0".parse().expect("it is an address"));
        Self::at(machine, &endpoint, folder, |address| {
            format!("tcp:{}{options}", address.trim_start_matches("tcp:"))
        })
    }

    fn at(machine: M, endpoint: &Endpoint, folder: TempDir, target: impl FnOnce(&str) -> String) -> Self {
        let handle = Server::spawn(machine, ServerOptions::default(), endpoint).expect("it can be served");
        let target = target(handle.address());
        Self { handle, target, _folder: folder }
    }

    /// Whether a bridge is driven, and the machine's time.
    pub fn look(&self) -> (bool, Duration) {
        let look = |machine: &mut M| {
            let view = machine.views().remove(0);
            let is_driven =
                |output: &BridgeOutput| matches!(output, BridgeOutput::Duty(duty) if *duty != 0.0);
            (view.axes.iter().any(|axis| is_driven(&axis.output)), view.now)
        };
        self.handle.inspect(look).expect("the server runs as long as this does")
    }

    fn drive(&self, seconds: &str) -> Program {
        let words = ["drive", "--connect", &self.target, "--motor", "1", "--duty", "40", "--for", seconds];
        Program::start(BRUSHWORK, &words.map(str::to_owned))
    }

    pub fn driving(&self) -> Program {
        let program = self.drive("600");
        wait::until("a driven motor", || self.look().0, || "it stands".to_owned());
        program
    }

    /// The motor is off soon after `signal`. Returns how long that took in the machine's time.
    fn is_stopped_after(&self, signal: &str) -> Duration {
        let program = self.driving();
        let (_, before) = self.look();
        program.signal(signal);
        let mut driven_until = before;
        let off = || {
            let (is_driven, now) = self.look();
            driven_until = if is_driven { now } else { driven_until };
            !is_driven
        };
        wait::until("a motor that is off", off, || "it is driven".to_owned());
        let took = driven_until.saturating_sub(before);
        println!("SIG{signal} on {}: off after {took:?}", self.target);
        assert!(took < SOON, "{took:?}");
        took
    }
}

pub fn motion_mind() -> MotionMindBus {
    let unit = MotionMind::new(MotionMindConfig::new(Mode::Serial)).expect("the default motor is sound");
    MotionMindBus::new(vec![unit])
}

pub fn mcp() -> Bus {
    let unit = Controller::new(patient(Generation::Gen1)).expect("the preset is valid");
    Bus::single(unit, StreamIndex::Usb)
}

#[test]
fn a_killed_program_leaves_no_motor_driven_on_either_family_over_serial_and_tcp() {
    Served::on_pty(motion_mind(), ",family=motion-mind").is_stopped_after("KILL");
    Served::on_tcp(motion_mind(), ",family=motion-mind").is_stopped_after("KILL");
    Served::on_pty(mcp(), ",stream=usb").is_stopped_after("KILL");
    // A line that may be late is the same line.
    Served::on_tcp(mcp(), ",stream=usb,latency=800").is_stopped_after("KILL");
}

#[test]
fn a_program_that_stands_still_while_it_drives_is_ended_and_its_motor_stopped() {
    let served = Served::on_pty(motion_mind(), ",family=motion-mind");
    let took = served.is_stopped_after("STOP");
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
    let mut program = served.driving();
    let first = program.id();
    assert_eq!(of(first).len(), 1, "it is named in the list of processes");
    program.signal("INT");
    wait::until("its end", || !program.is_running(), || "it runs".to_owned());
    assert_eq!(of(first), [0; 0], "it is gone before the program is");
    // The port is free again at once.
    let again = served.drive("0.2");
    assert!(again.finish(wait::LIMIT).status.success());
    // A killed one takes its guardian along, once the stop is written.
    let program = served.driving();
    let second = program.id();
    program.signal("KILL");
    wait::until("no guardian", || of(second).is_empty(), || "it is there".to_owned());
}
