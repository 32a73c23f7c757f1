//! Where a program that holds lines is asked to stop them: a thread that listens on this computer alone, one for all its lines.
//!
//! Anybody here can knock. Who does not know the secret of a line within a second and a few hundred bytes is sent away without a word, and no
//! more than a few are heard at a time.

use brushwork_link::work::receive_within;
use std::io::{self, Read as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use brushwork_link::device::{Addresses, Stopper};
use crossbeam_channel::RecvTimeoutError;
use serde::{Deserialize, Serialize};

use super::{LineStop, STOP_LIMIT};

/// Those who are heard at the same time.
const GUESTS: usize = 8;
/// How long a question may take to come.
pub(super) const QUESTION_LIMIT: Duration = Duration::from_secs(1);
/// No question is longer: all the addresses that there are, and the secret.
const LONGEST_QUESTION: usize = 2048;
/// How long an answer may take to be taken.
const ANSWER_LIMIT: Duration = Duration::from_secs(1);

/// What is asked, a line of JSON.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Question {
    pub secret: String,
    /// Units that are meant beside those of the link; all that the line has when none is named.
    pub addresses: Option<Vec<u8>>,
}

/// What is answered, a line of JSON each.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Answer {
    pub secret: String,
    pub word: Word,
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Word {
    /// The stop was asked of the device thread.
    Heard,
    /// It was served.
    Stopped(LineStop),
    /// It was not served in its time.
    NotServed,
    /// The link ended before.
    Ended,
}

/// A line behind the door.
struct Held {
    question: String,
    answer: String,
    stopper: Stopper,
}

/// The door of this program.
pub(super) struct Door {
    pub at: SocketAddr,
    lines: Mutex<Vec<Held>>,
    guests: AtomicUsize,
}

impl Door {
    /// The one of this program, opened the first time that it is asked for. None where the system refuses.
    pub(super) fn of_program() -> Option<Arc<Self>> {
        static DOOR: OnceLock<Option<Arc<Door>>> = OnceLock::new();
        DOOR.get_or_init(|| Self::open().ok()).clone()
    }

    /// Another one.
    pub(super) fn open() -> io::Result<Arc<Self>> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let at = listener.local_addr()?;
        let door = Arc::new(Self { at, lines: Mutex::default(), guests: AtomicUsize::new(0) });
        let inside = door.clone();
        std::thread::Builder::new().name("stop from outside".to_owned()).spawn(move || {
            for guest in listener.incoming() {
                match guest {
                    Ok(guest) => inside.let_in(guest),
                    // Out of files, for instance: a moment later there may be some.
                    Err(_) => std::thread::sleep(Duration::from_millis(10)),
                }
            }
        })?;
        Ok(door)
    }

    /// Puts a line behind it.
    pub(super) fn add(&self, question: String, answer: String, stopper: Stopper) {
        self.lines().push(Held { question, answer, stopper });
    }

    /// Takes a line away.
    pub(super) fn remove(&self, question: &str) {
        self.lines().retain(|held| held.question != question);
    }

    fn lines(&self) -> std::sync::MutexGuard<'_, Vec<Held>> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn let_in(self: &Arc<Self>, guest: TcpStream) {
        if self.guests.fetch_add(1, Ordering::SeqCst) >= GUESTS {
            self.guests.fetch_sub(1, Ordering::SeqCst);
            return;
        }
        let inside = self.clone();
        let hear = move || {
            // Whoever leaves in the middle of it does not want to know.
            let _ = inside.hear(guest);
            inside.guests.fetch_sub(1, Ordering::SeqCst);
        };
        if std::thread::Builder::new().name("asked to stop".to_owned()).spawn(hear).is_err() {
            self.guests.fetch_sub(1, Ordering::SeqCst);
        }
    }

    fn hear(&self, mut guest: TcpStream) -> io::Result<()> {
        let Some(question) = question(&mut guest)? else { return Ok(()) };
        let (stopper, answer) = {
            let lines = self.lines();
            let meant = lines.iter().find(|held| is_same(&held.question, &question.secret));
            let Some(held) = meant else { return Ok(()) };
            (held.stopper.clone(), held.answer.clone())
        };
        let addresses =
            question.addresses.map_or(Addresses::Scan, |these| Addresses::These(these.into_iter().collect()));
        let served = stopper.stop_from_outside(addresses);
        let mut tell = |word| {
            let mut line = serde_json::to_vec(&Answer { secret: answer.clone(), word })?;
            line.push(b'\n');
            guest.write_all(&line)
        };
        tell(Word::Heard)?;
        tell(match receive_within(&served, STOP_LIMIT) {
            Ok((units, report)) => Word::Stopped(LineStop::of(&units, &report)),
            Err(RecvTimeoutError::Timeout) => Word::NotServed,
            Err(RecvTimeoutError::Disconnected) => Word::Ended,
        })
    }
}

/// Reads one question, as long as it is short and comes soon.
fn question(guest: &mut TcpStream) -> io::Result<Option<Question>> {
    guest.set_nodelay(true)?;
    guest.set_write_timeout(Some(ANSWER_LIMIT))?;
    let until = Instant::now() + QUESTION_LIMIT;
    let (mut bytes, mut part) = (Vec::new(), [0; 512]);
    while bytes.len() < LONGEST_QUESTION {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(None);
        }
        guest.set_read_timeout(Some(left))?;
        let count = guest.read(&mut part)?;
        bytes.extend(&part[..count]);
        if let Some(end) = bytes.iter().position(|byte| *byte == b'\n') {
            return Ok(serde_json::from_slice(&bytes[..end]).ok());
        }
        if count == 0 {
            return Ok(None);
        }
    }
    Ok(None)
}

/// Compares in a time that does not tell how much of it is right.
fn is_same(secret: &str, said: &str) -> bool {
    let differing = secret.bytes().zip(said.bytes()).fold(0, |sum, (left, right)| sum | (left ^ right));
    secret.len() == said.len() && differing == 0
}
