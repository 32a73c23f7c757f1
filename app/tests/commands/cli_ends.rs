//! Ctrl-C and SIGTERM end every command within half a second, whatever it waits for.
#![cfg(unix)]

use std::fs;
use std::io::Write as _;
use std::net::TcpListener;
use std::os::unix::process::ExitStatusExt as _;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::cli::{LIMIT, name, program};
use brushwork_child::{Child, Program};
use rustix::fs::{CWD, FileType, Mode, OFlags, fcntl_setfl, mknodat};

/// How long a command may take to end.
const ENDS_WITHIN: Duration = Duration::from_millis(500);
/// A busy computer is given another try: a command that does not end at all fails in each.
const TRIES: usize = 3;
const INTERRUPTED: i32 = 130;

/// What tells that a command waits now.
#[derive(Clone, Copy)]
enum Waits {
    /// Words on standard error.
    Said(&'static str),
    /// It says nothing: so long after its start it does. Nothing hangs on the time, since one that is not there yet has to end too.
    Silent,
}

/// Every command that can wait for ever: for standard input, for a pipe that nobody writes to or reads from, for a peer that says nothing.
const COMMANDS: [(&[&str], Waits); 19] = [
    (&["terminal", "--connect", "sim:motion-mind-3"], Waits::Said("Motion Mind")),
    (&["mcl", "check", "-"], Waits::Silent),
    (&["mcl", "check", "FIFO"], Waits::Silent),
    (&["mcl", "build", "FIFO", "-o", "FOLDER/out"], Waits::Silent),
    (&["mcl", "fmt", "-"], Waits::Silent),
    (&["mcl", "run", "FIFO"], Waits::Silent),
    (&["mcl", "disasm", "FIFO"], Waits::Silent),
    (&["monitor", "--decode", "-"], Waits::Silent),
    (&["monitor", "--decode", "FIFO"], Waits::Silent),
    (&["settings", "import", "FIFO", "--yes"], Waits::Silent),
    (&["settings", "write", "--profile", "FIFO", "--yes"], Waits::Silent),
    (&["settings", "diff", "FIFO"], Waits::Silent),
    (&["settings", "compare", "ram", "FIFO"], Waits::Silent),
    (&["settings", "export", "FIFO"], Waits::Silent),
    (&["firmware", "update", "FIFO", "--accept-risk"], Waits::Silent),
    (&["firmware", "image", "FIFO"], Waits::Silent),
    (&["tune", "replay", "FIFO"], Waits::Silent),
    (&["status", "--connect", "tcp:PEER"], Waits::Silent),
    (&["stop", "--connect", "tcp:PEER"], Waits::Silent),
];

/// How long the command took to end, and what it ended with.
fn ended(
    arguments: &[&str],
    waits: Waits,
    signal: &str,
    folder: &Path,
    peer: &str,
) -> (Duration, Option<i32>) {
    let pipe = folder.join("pipe");
    let own = |argument: &&str| {
        argument.replace("FIFO", name(&pipe)).replace("FOLDER", name(folder)).replace("PEER", peer)
    };
    let mut command = program();
    command.args(arguments.iter().map(own));
    let mut running = Program::spawn(command);
    match waits {
        Waits::Said(words) => drop(running.wait_for_error(words, LIMIT)),
        Waits::Silent => std::thread::sleep(Duration::from_millis(150)),
    }
    assert!(running.is_running(), "{arguments:?} waits for nothing: {:#?}", running.finish(LIMIT));
    let asked_at = Instant::now();
    running.signal(signal);
    while running.is_running() && asked_at.elapsed() < 4 * ENDS_WITHIN {
        std::thread::sleep(Duration::from_millis(2));
    }
    let took = asked_at.elapsed();
    if running.is_running() {
        return (took, None);
    }
    let status = running.finish(LIMIT).status;
    (took, status.code().or(status.signal()))
}

#[test]
fn ctrl_c_and_sigterm_end_every_command_that_waits_within_half_a_second() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    mknodat(CWD, folder.path().join("pipe"), FileType::Fifo, Mode::RUSR | Mode::WUSR, 0)
        .expect("there are pipes");
    fs::create_dir_all(folder.path()).expect("it is there");
    let listener = TcpListener::bind("127.0.0.1:0").expect("there is a port");
    // A peer that takes connections and never says a word.
    let peer = listener.local_addr().expect("it has one").to_string();
    let mut late = Vec::new();
    for (arguments, waits) in COMMANDS {
        for signal in ["INT", "TERM"] {
            let mut tries = (0..TRIES).map(|_| ended(arguments, waits, signal, folder.path(), &peer));
            let good =
                |(took, code): &(Duration, Option<i32>)| *took <= ENDS_WITHIN && *code == Some(INTERRUPTED);
            let mut seen = Vec::new();
            if !tries.any(|tried| {
                seen.push(tried);
                good(&tried)
            }) {
                late.push(format!("{arguments:?} after SIG{signal}: {seen:?}"));
            }
        }
    }
    assert!(late.is_empty(), "{late:#?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_whose_output_nobody_takes_ends_all_the_same() {
    let ended = |arguments: &[&str]| {
        let (reader, mut writer) = std::io::pipe().expect("there are pipes");
        fcntl_setfl(&writer, OFlags::NONBLOCK).expect("it is ours");
        while writer.write(&[b' '; 1024]).is_ok() {}
        while writer.write(b" ").is_ok() {}
        fcntl_setfl(&writer, OFlags::empty()).expect("it is ours");
        let mut command = program();
        command.args(arguments);
        let mut running = Child::spawn(&command, [Stdio::null(), writer.into(), Stdio::null()]);
        let number = running.id();
        let waits = || {
            fs::read_to_string(format!("/proc/{number}/wchan"))
                .is_ok_and(|place| place.contains("pipe_write"))
        };
        let begun_at = Instant::now();
        while !waits() {
            assert!(begun_at.elapsed() < LIMIT, "{arguments:?} fills no pipe");
            std::thread::sleep(Duration::from_millis(5));
        }
        let asked_at = Instant::now();
        running.signal("TERM");
        while running.is_running() && asked_at.elapsed() < 4 * ENDS_WITHIN {
            std::thread::sleep(Duration::from_millis(2));
        }
        let took = asked_at.elapsed();
        let exit = if running.is_running() { None } else { running.finish(LIMIT).code() };
        drop(reader);
        (took, exit)
    };
    for arguments in [
        &["status", "--watch", "--interval", "0.02", "--json", "--connect", "sim:mcp266"][..],
        &["protocol", "--json"],
        &["drive", "--duty", "20", "--for", "600", "--json", "--connect", "sim:mcp266"],
    ] {
        let tries: Vec<_> = (0..TRIES).map(|_| ended(arguments)).collect();
        let best = tries.iter().filter(|(_, exit)| *exit == Some(INTERRUPTED)).map(|(took, _)| *took).min();
        assert!(best.is_some_and(|took| took <= ENDS_WITHIN), "{arguments:?}: {tries:?}");
    }
}
