//! The second process that watches over the first one. Nobody calls it by hand: its standard input is a port, its standard output the end of a
//! pipe that is read.

use crate::Exit;
use crate::messages::CliLinkMessage;
use std::ffi::OsString;
use std::process::ExitCode;

/// Stands guard until the first process is gone.
#[cfg(unix)]
pub fn run(mut words: impl Iterator<Item = OsString>) -> ExitCode {
    use std::fs::File;
    use std::os::fd::AsFd as _;

    use rustix::process::{Pid, Signal, getppid, kill_process};

    // What ends the program by a terminal, a logout or a service manager may reach this process first.
    let _deaf = super::Interrupt::install();
    let first = words.next().and_then(|pid| Pid::from_raw(pid.to_str()?.parse().ok()?));
    let line = std::io::stdin().as_fd().try_clone_to_owned().map(File::from);
    let orders = std::io::stdout().as_fd().try_clone_to_owned().map(File::from);
    let (Some(first), Ok(line), Ok(orders)) = (first, line, orders) else {
        return Exit::Usage.saying(CliLinkMessage::GuardianByHand).into();
    };
    let is_dying = || getppid() != Some(first) || is_dying(first.as_raw_pid());
    brushwork_core::guardian::stand_guard(orders, line, is_dying, || {
        // Another process may have its number once it is gone.
        if getppid() == Some(first) {
            let _ = kill_process(first, Signal::KILL);
        }
    });
    ExitCode::SUCCESS
}

/// Whether a process is killed and merely not gone yet. Its first thread has the signal before it, or is dead and waits for the others
/// (proc_pid_status(5)). Where there is no such file, the pipe alone tells it.
#[cfg(unix)]
fn is_dying(process: i32) -> bool {
    /// The bit of SIGKILL in a mask of signals, whose first bit is that of signal 1.
    const KILL: u64 = 1 << 8;
    let Ok(status) = std::fs::read_to_string(format!("/proc/{process}/status")) else { return false };
    status.lines().filter_map(|line| line.split_once(':')).any(|(name, value)| match name {
        "State" => value.trim_start().starts_with(['Z', 'X']),
        "SigPnd" | "ShdPnd" => u64::from_str_radix(value.trim(), 16).is_ok_and(|signals| signals & KILL != 0),
        _ => false,
    })
}

/// There is none.
#[cfg(not(unix))]
pub fn run(_words: impl Iterator<Item = OsString>) -> ExitCode {
    Exit::Usage.saying(CliLinkMessage::GuardianByHand).into()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_killed_process_is_seen_to_die_before_its_parent_has_taken_note() {
        #[expect(clippy::disallowed_methods, reason = "it is waited for below")]
        let mut child = std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let pid = i32::try_from(child.id()).unwrap();
        assert!(!is_dying(pid));
        child.kill().unwrap();
        // Nobody waits for it yet, so that its state stays what it is from here on.
        while !is_dying(pid) {
            std::thread::yield_now();
        }
        child.wait().unwrap();
    }
}
