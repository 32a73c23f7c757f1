//! The endpoint on a pseudo-terminal, with a symbolic link that stands for the device's name.
//!
//! Only the controller's side is held open, so that the system tells when the last client has closed: what that client left
//! unread is thrown away then, as a real port does. Clients may come and go.

use super::error::ServerError;
use super::line::{Heard, Line};
use super::wait::{Ready, pause, wait_for};
use rustix::fd::{AsFd, OwnedFd};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Bytes taken at a time.
const CHUNK: usize = 4096;
/// How often to look for a client while there is none; the system cannot be asked to wait for one.
const LOOK_FOR_CLIENT: Duration = Duration::from_millis(2);

/// A pseudo-terminal and its link; neither while unplugged.
#[derive(Debug)]
pub struct PtyLine {
    link: PathBuf,
    pty: Option<Pty>,
}

#[derive(Debug)]
struct Pty {
    controller: OwnedFd,
    /// The clients' side.
    path: PathBuf,
    client: bool,
}

impl PtyLine {
    /// Opens a pseudo-terminal and makes the link.
    pub fn open(link: &Path) -> Result<Self, ServerError> {
        let mut line = Self { link: link.to_owned(), pty: None };
        line.plug_in()?;
        Ok(line)
    }
}

impl Line for PtyLine {
    fn receive(&mut self, bytes: &mut Vec<u8>, timeout: Duration) -> Heard {
        match &mut self.pty {
            Some(pty) => pty.receive(bytes, timeout),
            None => {
                pause(timeout, timeout);
                Heard::Line
            }
        }
    }

    fn send(&mut self, reply: &[u8]) {
        if let Some(pty) = self.pty.as_ref().filter(|pty| pty.client) {
            // Whatever the client's full buffer does not take is lost; a client that is gone is noticed at the next wait.
            let _ = rustix::io::write(&pty.controller, reply);
        }
    }

    fn unplug(&mut self) {
        if let Some(pty) = self.pty.take() {
            remove_link(&self.link, &pty.path);
        }
    }

    fn plug_in(&mut self) -> Result<(), ServerError> {
        if self.pty.is_none() {
            make_room(&self.link)?;
            let pty = Pty::open()?;
            symlink(&pty.path, &self.link)
                .map_err(|source| ServerError::Link { link: self.link.clone(), source })?;
            self.pty = Some(pty);
        }
        Ok(())
    }
}

impl Drop for PtyLine {
    fn drop(&mut self) {
        self.unplug();
    }
}

impl Pty {
    fn open() -> Result<Self, ServerError> {
        let step = |step| move |errno: Errno| ServerError::PseudoTerminal { step, source: errno.into() };
        let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).map_err(step("opening it"))?;
        rustix::io::fcntl_setfd(&controller, rustix::io::FdFlags::CLOEXEC).map_err(step("guarding it"))?;
        rustix::fs::fcntl_setfl(&controller, OFlags::NONBLOCK).map_err(step("setting it up"))?;
        grantpt(&controller).map_err(step("granting it"))?;
        unlockpt(&controller).map_err(step("unlocking it"))?;
        let name = ptsname(&controller, Vec::new()).map_err(step("asking its name"))?;
        let path = PathBuf::from(OsStr::from_bytes(name.as_bytes()));
        // Bytes pass unchanged and without echo, also for a client that sets nothing up.
        let client = open_client_side(&path).map_err(step("opening the clients' side"))?;
        let mut settings = tcgetattr(&client).map_err(step("reading its settings"))?;
        settings.make_raw();
        tcsetattr(&client, OptionalActions::Now, &settings).map_err(step("making it raw"))?;
        Ok(Self { controller, path, client: false })
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, timeout: Duration) -> Heard {
        let [Ready { readable, hung_up }] = wait_for([self.controller.as_fd()], timeout);
        if readable && self.read(bytes) {
            self.client = true;
            return Heard::Line;
        }
        if !hung_up {
            self.client = true;
            return Heard::Line;
        }
        if self.client {
            self.client = false;
            self.discard_unread();
            return Heard::ClientLeft;
        }
        pause(timeout, LOOK_FOR_CLIENT);
        Heard::Line
    }

    fn read(&self, bytes: &mut Vec<u8>) -> bool {
        let mut chunk = [0; CHUNK];
        match rustix::io::read(&self.controller, &mut chunk) {
            Ok(count) => {
                bytes.extend_from_slice(&chunk[..count]);
                count > 0
            }
            Err(_) => false,
        }
    }

    /// Throws away what the last client did not read, so that the next one does not find it.
    fn discard_unread(&self) {
        if let Ok(client) = open_client_side(&self.path) {
            let _ = tcflush(client, QueueSelector::IFlush);
        }
    }
}

fn open_client_side(path: &Path) -> Result<OwnedFd, Errno> {
    rustix::fs::open(path, OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK, Mode::empty())
}

/// Makes sure that nothing is where the link goes. A link to a device that is gone is left over from a program that was killed.
fn make_room(link: &Path) -> Result<(), ServerError> {
    let taken = |what: String| ServerError::LinkTaken { link: link.to_owned(), what };
    match fs::symlink_metadata(link) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(source) => Err(ServerError::Link { link: link.to_owned(), source }),
        Ok(found) if !found.file_type().is_symlink() => Err(taken("it is no link".to_owned())),
        Ok(_) if link.exists() => {
            let target = fs::read_link(link).unwrap_or_default();
            Err(taken(format!("a link to {}, where another simulated controller may be", target.display())))
        }
        Ok(_) if !fs::read_link(link).is_ok_and(|target| target.starts_with("/dev")) => {
            Err(taken("a link to a file that is not there".to_owned()))
        }
        Ok(_) => fs::remove_file(link).map_err(|source| ServerError::Link { link: link.to_owned(), source }),
    }
}

/// Removes the link if it is still ours.
fn remove_link(link: &Path, target: &Path) {
    if fs::read_link(link).is_ok_and(|found| found == target) {
        // Nothing is lost if somebody else was quicker.
        let _ = fs::remove_file(link);
    }
}
