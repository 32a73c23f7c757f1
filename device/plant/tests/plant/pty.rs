//! The real-time server on a pseudo-terminal, with plain file handles as clients.
#![cfg(unix)]

use crate::support::{PATIENCE, Parrot, eventually, let_turn};
use brushwork_plant::server::{Endpoint, Server, ServerError, ServerOptions, SimHandle};
use brushwork_plant::world::WorldAction;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::fs::{File, OpenOptions, read_link, symlink_metadata};
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::fs::{OpenOptionsExt, symlink};
use std::path::{Path, PathBuf};
use std::time::Instant;
use tempfile::TempDir;

struct Bench {
    _folder: TempDir,
    link: PathBuf,
}

impl Bench {
    fn new() -> Self {
        let folder = TempDir::new().expect("a temporary folder can be made");
        let link = folder.path().join("mcp");
        Self { _folder: folder, link }
    }

    fn serve(&self) -> Result<SimHandle<Parrot>, ServerError> {
        let endpoint = Endpoint::Pty { link: self.link.clone() };
        Server::spawn(Parrot::new(), ServerOptions::default(), &endpoint)
    }
}

fn open(link: &Path) -> io::Result<File> {
    const NO_CONTROLLING_TERMINAL: i32 = rustix::fs::OFlags::NOCTTY.bits() as i32;
    OpenOptions::new().read(true).write(true).custom_flags(NO_CONTROLLING_TERMINAL).open(link)
}

/// Reads `count` bytes, or fails after a while.
fn read(client: &mut File, count: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let begin = Instant::now();
    while bytes.len() < count {
        let mut waited = [PollFd::new(&*client, PollFlags::IN)];
        let tenth = Timespec { tv_sec: 0, tv_nsec: 100_000_000 };
        if poll(&mut waited, Some(&tenth))? > 0 {
            let mut chunk = [0; 64];
            match client.read(&mut chunk)? {
                0 => return Err(ErrorKind::UnexpectedEof.into()),
                got => bytes.extend_from_slice(&chunk[..got]),
            }
        } else if begin.elapsed() > PATIENCE {
            return Err(ErrorKind::TimedOut.into());
        }
    }
    Ok(bytes)
}

fn exchange(client: &mut File, byte: u8) -> io::Result<Vec<u8>> {
    client.write_all(&[0x80, byte])?;
    read(client, 4)
}

#[test]
fn clients_open_close_and_reopen_the_link_and_every_byte_passes_unchanged() {
    let bench = Bench::new();
    let handle = bench.serve().expect("there are pseudo-terminals");
    assert_eq!(handle.address(), bench.link.display().to_string());
    for round in 0..3 {
        let mut client = open(&bench.link).expect("the link leads to it");
        // Bytes that a terminal would change, echo or act on: end of file, interrupt, new line, carriage return, XON, XOFF.
        for byte in [0x00, 0x03, 0x04, b'\n', b'\r', 0x11, 0x13, 0x1A, 0x7F, 0xFF] {
            assert_eq!(exchange(&mut client, byte).expect("it answers"), vec![byte; 4], "round {round}");
        }
    }
}

#[test]
fn what_a_client_left_unread_is_not_found_by_the_next_one() {
    let bench = Bench::new();
    let handle = bench.serve().expect("there are pseudo-terminals");
    let mut first = open(&bench.link).expect("the link leads to it");
    first.write_all(&[0x80, 1]).expect("it takes bytes");
    assert!(eventually(|| handle.inspect(|parrot| parrot.heard.len()).is_ok_and(|heard| heard == 2)));
    drop(first);
    // The server sees that nobody is there.
    let_turn(&handle);
    let mut second = open(&bench.link).expect("the link leads to it");
    assert_eq!(exchange(&mut second, 2).expect("it answers"), vec![2; 4]);
}

#[test]
fn the_link_is_removed_at_the_end() {
    let bench = Bench::new();
    let handle = bench.serve().expect("there are pseudo-terminals");
    let target = read_link(&bench.link).expect("there is a link");
    assert!(target.exists(), "{}", target.display());
    handle.stop();
    assert!(symlink_metadata(&bench.link).is_err());
}

#[test]
fn a_link_that_somebody_else_made_meanwhile_is_left_alone() {
    let bench = Bench::new();
    let handle = bench.serve().expect("there are pseudo-terminals");
    std::fs::remove_file(&bench.link).expect("it is there");
    symlink("/dev/null", &bench.link).expect("the place is free");
    handle.stop();
    assert_eq!(read_link(&bench.link).expect("it is there"), Path::new("/dev/null"));
}

#[test]
fn a_path_that_is_taken_is_refused_but_a_dead_link_is_replaced() {
    let bench = Bench::new();
    symlink("/dev/nowhere/at/all", &bench.link).expect("the place is free");
    let handle = bench.serve().expect("a link to a device that is gone is no hindrance");
    let refusal = bench.serve().map(drop).expect_err("another one serves there").to_string();
    assert!(refusal.contains("is already there (a link to /dev/"), "{refusal}");
    handle.stop();
    std::fs::write(&bench.link, "my notes").expect("the place is free");
    let refusal = bench.serve().map(drop).expect_err("a file is there").to_string();
    assert!(refusal.contains("(it is no link): remove it, or choose another path"), "{refusal}");
    assert_eq!(std::fs::read_to_string(&bench.link).expect("it is there"), "my notes");
    std::fs::remove_file(&bench.link).expect("it is there");
    symlink("/nowhere/at/all", &bench.link).expect("the place is free");
    let refusal = bench.serve().map(drop).expect_err("somebody means to put a file there").to_string();
    assert!(refusal.contains("(a link to a file that is not there)"), "{refusal}");
    std::fs::remove_file(&bench.link).expect("it was left");
    std::fs::write(&bench.link, "my notes").expect("the place is free");
    let nowhere = Endpoint::Pty { link: bench.link.join("deeper") };
    assert!(Server::spawn(Parrot::new(), ServerOptions::default(), &nowhere).is_err());
}

#[test]
fn unplugging_takes_the_device_away_and_plugging_in_brings_it_back() {
    let bench = Bench::new();
    let handle = bench.serve().expect("there are pseudo-terminals");
    let mut client = open(&bench.link).expect("the link leads to it");
    assert_eq!(exchange(&mut client, 1).expect("it answers"), vec![1; 4]);
    handle.apply(0, WorldAction::Unplug { unplugged: true }).expect("it runs");
    assert!(eventually(|| symlink_metadata(&bench.link).is_err()));
    let gone = exchange(&mut client, 2).expect_err("the device is gone");
    assert!(gone.kind() != ErrorKind::TimedOut, "{gone}");
    handle.apply(0, WorldAction::Unplug { unplugged: false }).expect("it runs");
    assert!(eventually(|| open(&bench.link)
        .and_then(|mut client| exchange(&mut client, 3))
        .is_ok_and(|reply| reply == [3; 4])));
}

#[test]
fn a_client_that_never_reads_does_not_stop_the_server() {
    let bench = Bench::new();
    let handle = bench.serve().expect("there are pseudo-terminals");
    let mut client = open(&bench.link).expect("the link leads to it");
    for _ in 0..200 {
        client.write_all(&[0x80; 64]).expect("it takes bytes");
    }
    assert!(eventually(|| handle.inspect(|parrot| parrot.heard.len()).is_ok_and(|heard| heard == 12_800)));
    drop(client);
    let_turn(&handle);
    let mut next = open(&bench.link).expect("the link leads to it");
    assert_eq!(exchange(&mut next, 2).expect("it answers"), vec![2; 4]);
}
