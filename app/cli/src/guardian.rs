//! The second process that watches over the first one. Nobody calls it by hand: its standard output is the end of a pipe that is read, its standard
//! input a port, where the system opens one twice.

use crate::Exit;
use crate::messages::CliLinkMessage;
#[cfg(not(target_family = "wasm"))]
use brushwork_core::guardian::{Later, stand_guard};
#[cfg(not(target_family = "wasm"))]
use brushwork_link::transport::ConnectTarget;
use std::ffi::OsString;
#[cfg(not(target_family = "wasm"))]
use std::fs::File;
use std::process::ExitCode;

/// Stands guard until the first process is gone. The words are its number, the port as a person would name it and, where the port is to be opened
/// only then, the target that leads there.
#[cfg(not(target_family = "wasm"))]
pub fn run(words: impl Iterator<Item = OsString>) -> ExitCode {
    // What ends the program by a terminal, a logout or a service manager may reach this process first.
    let _deaf = super::Interrupt::install();
    let words: Option<Vec<String>> = words.map(|word| word.into_string().ok()).collect();
    let words: Vec<&str> = words.iter().flatten().map(String::as_str).collect();
    let by_hand = || Exit::Usage.saying(CliLinkMessage::GuardianByHand).into();
    let (first, later) = match words[..] {
        [first, _port] => (first, None),
        [first, _port, target] => (first, Some(target)),
        _ => return by_hand(),
    };
    let (Ok(first), Ok(orders), Ok(later)) =
        (first.parse(), taken(&std::io::stdout()), later.map(str::parse::<ConnectTarget>).transpose())
    else {
        return by_hand();
    };
    let (is_dying, end) = (|| is_dying(first), || end(first));
    match later {
        Some(target) => stand_guard(orders, || Later::open(&target), is_dying, end),
        None => stand_guard(orders, || taken(&std::io::stdin()).ok(), is_dying, end),
    }
    ExitCode::SUCCESS
}

/// A standard stream as the plain file or pipe that it is.
#[cfg(unix)]
fn taken(stream: &impl std::os::fd::AsFd) -> std::io::Result<File> {
    stream.as_fd().try_clone_to_owned().map(File::from)
}

#[cfg(windows)]
fn taken(stream: &impl std::os::windows::io::AsHandle) -> std::io::Result<File> {
    stream.as_handle().try_clone_to_owned().map(File::from)
}

/// Whether the first process runs no code of its own any more. Its pipe tells it too, some time later on a busy computer.
#[cfg(unix)]
fn is_dying(first: i32) -> bool {
    !is_ours(first) || is_killed(first)
}

/// The pipe tells it.
#[cfg(windows)]
fn is_dying(_first: u32) -> bool {
    false
}

/// Ends the first process, if it is there still.
#[cfg(unix)]
fn end(first: i32) {
    use rustix::process::{Pid, Signal, kill_process};

    // Another process may have its number once it is gone.
    if let Some(process) = Pid::from_raw(first).filter(|_| is_ours(first)) {
        let _ = kill_process(process, Signal::KILL);
    }
}

/// Its pipe is open, so that no other process can have its number.
#[cfg(windows)]
fn end(first: u32) {
    use std::os::windows::process::CommandExt as _;
    use std::process::{Command, Stdio};

    /// `CREATE_NO_WINDOW`.
    const UNSEEN: u32 = 0x0800_0000;
    let folder = std::env::var_os("SystemRoot").unwrap_or_else(|| r"C:\Windows".into());
    let mut kill = Command::new(std::path::Path::new(&folder).join(r"System32\taskkill.exe"));
    kill.args(["/F", "/PID", &first.to_string()]).creation_flags(UNSEEN);
    kill.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    #[expect(clippy::disallowed_methods, reason = "it ends by itself and is waited for")]
    let _ = kill.status();
}

/// Whether the first process is still what started this one.
#[cfg(unix)]
fn is_ours(first: i32) -> bool {
    rustix::process::getppid().is_some_and(|parent| parent.as_raw_pid() == first)
}

/// Whether a process is killed and merely not gone yet. Its first thread has the signal before it, or is dead and waits for the others
/// (proc_pid_status(5)). Where there is no such file, the pipe alone tells it.
#[cfg(unix)]
fn is_killed(process: i32) -> bool {
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
#[cfg(target_family = "wasm")]
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
        assert!(!is_killed(pid));
        child.kill().unwrap();
        // Nobody waits for it yet, so that its state stays what it is from here on.
        while !is_killed(pid) {
            std::thread::yield_now();
        }
        child.wait().unwrap();
    }
}
