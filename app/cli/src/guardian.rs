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
    brushwork_core::guardian::stand_guard(orders, line, || {
        // Another process may have its number once it is gone.
        if getppid() == Some(first) {
            let _ = kill_process(first, Signal::KILL);
        }
    });
    ExitCode::SUCCESS
}

/// There is none.
#[cfg(not(unix))]
pub fn run(_words: impl Iterator<Item = OsString>) -> ExitCode {
    Exit::Usage.saying(CliLinkMessage::GuardianByHand).into()
}
