//! A stop of a line that another process of this program holds, by that process: its device thread stops the motors as it does for its own key.
//!
//! A process that holds a line leaves a note ([`hold`]); `brushwork stop` asks whoever has left one ([`ask`]).

use std::io::{self, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use brushwork_link::ConnectTarget;
use brushwork_link::device::{Addresses, Stopper};

use super::door::{Answer, Door, QUESTION_LIMIT, Question, Word};
use super::note::{self, Note};
use super::{LineStop, STOP_LIMIT};
use crate::keep::folder;

/// How long a connection on this computer may take.
const CONNECT_LIMIT: Duration = Duration::from_millis(250);
/// How long a program may take to hear. One that stands still while it moves motors is ended by its guardian before.
const HEARD_LIMIT: Duration = Duration::from_secs(2);
/// How much longer the answer may take than the stop.
const MARGIN: Duration = Duration::from_secs(1);
/// How long one is asked again who sends away without a word: whoever says nothing keeps a place among the few that are heard for a second at most.
const AGAIN_LIMIT: Duration = QUESTION_LIMIT.saturating_add(Duration::from_millis(500));
/// How long one look at a connection waits.
const SLICE: Duration = Duration::from_millis(20);
/// No answer is longer: 127 nodes with all that can be said of each.
const LONGEST_ANSWER: usize = 1 << 20;

/// A line that others can have stopped through this program, until it is dropped.
pub struct Hold {
    door: Arc<Door>,
    question: String,
    path: PathBuf,
}

/// Who holds a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Holder {
    /// What runs: "brushwork drive".
    pub program: String,
    /// Its process number.
    pub process: u32,
}

/// What came of asking.
#[derive(Clone, Debug, PartialEq)]
pub enum Asked {
    /// No program of this user has left a note of the line.
    Nobody,
    /// The holder has stopped it.
    Stopped(Holder, LineStop),
    /// The holder has begun to stop it, and nobody knows what came of it.
    NotServed(Holder),
    /// The holder lets go of the line, or is dead.
    Gone(Holder),
    /// The holder is there and does not answer.
    Silent(Holder),
    /// It was not waited for.
    Interrupted,
}

/// Makes it known that this program has opened `target`. Without a folder to keep files in, or where the system allows no listening, it is not: then
/// `brushwork stop` says who holds the port.
#[must_use]
pub fn hold(target: &ConnectTarget, stopper: Stopper) -> Option<Hold> {
    let lines = note::lines_of(target);
    if lines.is_empty() {
        return None;
    }
    hold_in(&folder()?, Door::of_program()?, lines, stopper)
}

/// Has whoever holds `target` stop it, its units and those at `addresses`. Several may hold what is behind a TCP server: all are asked.
#[must_use]
pub fn ask(target: &ConnectTarget, addresses: Addresses, goes_on: &dyn Fn() -> bool) -> Asked {
    let lines = note::lines_of(target);
    let notes = folder().map(|folder| Note::of(&folder, &lines)).unwrap_or_default();
    let others = notes.into_iter().filter(|(_, note)| note.process != std::process::id());
    ask_each(others.collect(), addresses, goes_on)
}

fn folder() -> Option<PathBuf> {
    Some(folder::data()?.join(note::FOLDER))
}

fn hold_in(folder: &Path, door: Arc<Door>, lines: Vec<String>, stopper: Stopper) -> Option<Hold> {
    let note = Note {
        program: program(),
        process: std::process::id(),
        lines,
        at: door.at,
        question: note::secret(),
        answer: note::secret(),
    };
    door.add(note.question.clone(), note.answer.clone(), stopper);
    let question = note.question.clone();
    match note.leave(folder) {
        Ok(path) => Some(Hold { door, question, path }),
        Err(_) => {
            door.remove(&question);
            None
        }
    }
}

/// What runs, as a person would name it.
fn program() -> String {
    match std::env::args().nth(1).filter(|word| !word.starts_with('-')) {
        Some(command) => format!("brushwork {command}"),
        None => "the window of brushwork".to_owned(),
    }
}

impl Drop for Hold {
    fn drop(&mut self) {
        self.door.remove(&self.question);
        // What is left is found out by whoever asks.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Asks all at once, then hears each.
fn ask_each(notes: Vec<(PathBuf, Note)>, addresses: Addresses, goes_on: &dyn Fn() -> bool) -> Asked {
    let again_until = Instant::now() + AGAIN_LIMIT;
    let asked: Vec<_> = notes.into_iter().map(|(path, note)| (knock(&note, addresses), path, note)).collect();
    let mut came = Asked::Nobody;
    for (mut knocked, path, note) in asked {
        let holder = Holder { program: note.program.clone(), process: note.process };
        let answer = loop {
            let heard = match knocked {
                Ok(stream) => hear(stream, &note, &holder, goes_on),
                // Nobody listens there any more: it died without clearing up.
                Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => Heard::Stranger,
                Err(_) => Heard::Holder(Asked::Silent(holder.clone())),
            };
            match heard {
                Heard::Holder(answer) => break answer,
                // Whoever lets go of a line takes its note away; where it stands still, others may only have been there first.
                Heard::SentAway if path.exists() && Instant::now() < again_until && goes_on() => {
                    std::thread::sleep(SLICE);
                    knocked = knock(&note, addresses);
                }
                Heard::SentAway => break Asked::Gone(holder),
                Heard::Stranger => {
                    let _ = std::fs::remove_file(&path);
                    break Asked::Gone(holder);
                }
            }
        };
        if answer.weight() > came.weight() {
            came = answer;
        }
    }
    came
}

/// Who was met behind a note.
enum Heard {
    /// Its holder, and this came of it.
    Holder(Asked),
    /// Somebody who hung up before a word.
    SentAway,
    /// Somebody else, or nobody.
    Stranger,
}

fn knock(note: &Note, addresses: Addresses) -> io::Result<TcpStream> {
    let mut stream = TcpStream::connect_timeout(&note.at, CONNECT_LIMIT)?;
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(CONNECT_LIMIT))?;
    stream.set_read_timeout(Some(SLICE))?;
    let addresses = match addresses {
        Addresses::These(set) => Some(set.iter().collect()),
        Addresses::Only(address) => Some(vec![address]),
        Addresses::Scan | Addresses::Factory => None,
    };
    let mut line = serde_json::to_vec(&Question { secret: note.question.clone(), addresses })?;
    line.push(b'\n');
    stream.write_all(&line)?;
    Ok(stream)
}

/// Hears a holder out.
fn hear(mut stream: TcpStream, note: &Note, holder: &Holder, goes_on: &dyn Fn() -> bool) -> Heard {
    let asked_at = Instant::now();
    let (mut bytes, mut part) = (Vec::new(), [0; 4096]);
    let mut is_heard = false;
    let came = loop {
        while let Some(end) = bytes.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = bytes.drain(..=end).collect();
            let answer =
                serde_json::from_slice(&line).ok().filter(|answer: &Answer| answer.secret == note.answer);
            let Some(answer) = answer else { return Heard::Stranger };
            match answer.word {
                Word::Heard => is_heard = true,
                Word::Stopped(stop) => return Heard::Holder(Asked::Stopped(holder.clone(), stop)),
                Word::NotServed => return Heard::Holder(Asked::NotServed(holder.clone())),
                Word::Ended => return Heard::Holder(Asked::Gone(holder.clone())),
            }
        }
        let limit = if is_heard { STOP_LIMIT + MARGIN } else { HEARD_LIMIT };
        match stream.read(&mut part) {
            Ok(count @ 1..) if bytes.len() < LONGEST_ANSWER => bytes.extend(&part[..count]),
            Ok(1..) => return Heard::Stranger,
            Err(error) if is_nothing_yet(&error) => {}
            Ok(0) | Err(_) if is_heard => break Asked::Gone(holder.clone()),
            Ok(0) | Err(_) => return Heard::SentAway,
        }
        if !goes_on() {
            break Asked::Interrupted;
        }
        if asked_at.elapsed() > limit {
            break if is_heard { Asked::NotServed(holder.clone()) } else { Asked::Silent(holder.clone()) };
        }
    };
    Heard::Holder(came)
}

fn is_nothing_yet(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted)
}

impl Asked {
    /// Of several holders the one counts of whom there is most to say.
    fn weight(&self) -> u8 {
        match self {
            Self::Nobody => 0,
            Self::Gone(_) => 1,
            Self::Stopped(..) => 2,
            Self::Silent(_) => 3,
            Self::NotServed(_) => 4,
            Self::Interrupted => 5,
        }
    }
}

impl Holder {
    /// Its name with its process number.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{} (process {})", self.program, self.process)
    }

    /// Whether the system says that it is halted; `None` where that cannot be known.
    #[must_use]
    pub fn is_halted(&self) -> Option<bool> {
        let state = std::fs::read_to_string(format!("/proc/{}/stat", self.process)).ok()?;
        // What stands in brackets is the program's own name, which may hold anything.
        let state = state.rsplit_once(") ")?.1;
        Some(state.starts_with(['T', 't']))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::{self, Session, SessionOptions};
    use crate::wait::{PATIENCE, until_some};
    use brushwork_link::device::DisarmReason;
    use brushwork_link::{ArmScope, Drive, DriveCommand, Event, Request, SystemClock};
    use std::net::{SocketAddr, TcpListener};
    use tempfile::TempDir;

    const LINE: &str = "/dev/ttyACM9";

    /// A link to a simulated controller, held under the name of a port.
    struct Held {
        session: Session,
        folder: TempDir,
        hold: Option<Hold>,
    }

    impl Held {
        fn new() -> Self {
            brushwork_link::install(&[&brushwork_mcp_client::McpDriver]);
            brushwork_family::simulator::install(&[&brushwork_mcp::McpSimulator]);
            let target = "sim:mcp266".parse().unwrap();
            let session =
                session::open(&target, SessionOptions::default(), SystemClock::shared(), None).unwrap();
            let folder = tempfile::tempdir().unwrap();
            // A door of its own: whoever knocks at it in one test keeps nobody out in another.
            let hold = hold_in(
                folder.path(),
                Door::open().unwrap(),
                vec![LINE.to_owned()],
                session.device.stopper(),
            );
            let held = Self { session, folder, hold };
            held.wait_for(|event| matches!(event, Event::Selected { .. }));
            held
        }

        fn wait_for(&self, is_it: impl Fn(&Event) -> bool) -> Event {
            let next = || {
                self.session.device.renew();
                self.session.device.events().try_iter().find(&is_it)
            };
            until_some("an event", next, || "it did not come".to_owned())
        }

        fn notes(&self) -> Vec<(PathBuf, Note)> {
            Note::of(self.folder.path(), &[LINE.to_owned()])
        }

        /// The only note, with a change.
        fn note(&self, change: impl Fn(&mut Note)) -> Vec<(PathBuf, Note)> {
            let mut notes = self.notes();
            assert_eq!(notes.len(), 1);
            change(&mut notes[0].1);
            notes
        }

        fn ask(&self) -> Asked {
            ask_each(self.notes(), Addresses::Scan, &|| true)
        }

        fn was_stopped(&self) -> bool {
            self.session.device.events().try_iter().any(|event| matches!(event, Event::Stopped(_)))
        }
    }

    fn door_of(at: SocketAddr) -> TcpStream {
        let stream = TcpStream::connect(at).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    #[test]
    fn a_driven_motor_is_stopped_by_its_own_link_which_says_who_asked_and_tells_what_came_of_it() {
        let held = Held::new();
        let device = &held.session.device;
        device.request(Request::Arm(ArmScope::CommandLine)).unwrap();
        held.wait_for(|event| matches!(event, Event::Armed { .. }));
        let duty = DriveCommand::Duty { duty: 0.3, accel_duty_per_s: None };
        device.request(Request::Drive(Drive::both(duty))).unwrap();
        held.wait_for(|event| matches!(event, Event::Driven { .. }));
        let Asked::Stopped(holder, stop) = held.ask() else { panic!("it was not stopped") };
        assert_eq!(holder.process, std::process::id());
        assert!(stop.is_confirmed() && stop.units.len() == 1, "{stop:?}");
        assert_eq!((stop.units[0].address, stop.units[0].buffers_empty), (0x80, Some(true)));
        let Event::Disarmed(reason) = held.wait_for(|event| matches!(event, Event::Disarmed(_))) else {
            panic!("it was looked for")
        };
        assert_eq!(reason, DisarmReason::StopFromOutside);
        let Event::Stopped(report) = held.wait_for(|event| matches!(event, Event::Stopped(_))) else {
            panic!("it was looked for")
        };
        assert!(report.from_outside);
        // A stop of its own is its own again.
        device.stop_all();
        let Event::Stopped(report) = held.wait_for(|event| matches!(event, Event::Stopped(_))) else {
            panic!("it was looked for")
        };
        assert!(!report.from_outside);
    }

    #[test]
    fn a_wrong_secret_stops_nothing_and_gets_no_word() {
        let held = Held::new();
        let (path, note) = held.notes().remove(0);
        let wrong = ["".to_owned(), "0".to_owned(), note::secret()]
            .map(|question| (path.clone(), Note { question, ..note.clone() }));
        assert!(matches!(ask_each(wrong.to_vec(), Addresses::Scan, &|| true), Asked::Gone(_)));
        assert!(!held.was_stopped());
        assert!(matches!(held.ask(), Asked::Stopped(..)), "the right one does");
    }

    #[test]
    fn bytes_without_end_or_sense_are_given_up_and_the_next_one_is_heard() {
        let held = Held::new();
        let at = held.notes()[0].1.at;
        for bytes in
            [vec![b'x'; 100_000], b"{}\n".to_vec(), vec![0xff; 64], b"\n\n\n".to_vec(), vec![b'['; 2047]]
        {
            let mut stream = door_of(at);
            // It may be closed before all of it is written.
            let _ = stream.write_all(&bytes);
            let mut answer = Vec::new();
            let _ = stream.read_to_end(&mut answer);
            assert_eq!(answer, [0; 0]);
        }
        assert!(!held.was_stopped());
        assert!(matches!(held.ask(), Asked::Stopped(..)));
    }

    #[test]
    fn those_who_say_nothing_keep_the_others_out_for_a_second_at_most() {
        let held = Held::new();
        let at = held.notes()[0].1.at;
        let silent: Vec<_> = (0..20).map(|_| door_of(at)).collect();
        let asked = held.ask();
        assert!(matches!(asked, Asked::Stopped(..)), "asked once, it waits for its turn: {asked:?}");
        drop(silent);
    }

    #[test]
    fn a_note_of_a_dead_program_is_removed_and_says_that_it_is_gone() {
        let held = Held::new();
        let nobody = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        assert!(matches!(
            ask_each(held.note(|note| note.at = nobody), Addresses::Scan, &|| true),
            Asked::Gone(_)
        ));
        assert!(held.notes().is_empty());
    }

    #[test]
    fn who_has_the_port_of_a_dead_program_is_not_taken_for_it() {
        let held = Held::new();
        let stop = LineStop { units: Vec::new(), matters: Vec::new(), latency: Duration::ZERO };
        let lie = Answer { secret: note::secret(), word: Word::Stopped(stop) };
        let other = TcpListener::bind("127.0.0.1:0").unwrap();
        let at = other.local_addr().unwrap();
        let lies = std::thread::Builder::new().spawn(move || {
            let (mut guest, _) = other.accept().unwrap();
            guest.write_all(&serde_json::to_vec(&lie).unwrap()).unwrap();
            guest.write_all(b"\n").unwrap();
            let _ = guest.read_to_end(&mut Vec::new());
        });
        let asked = ask_each(held.note(|note| note.at = at), Addresses::Scan, &|| true);
        assert!(matches!(asked, Asked::Gone(_)), "{asked:?}");
        lies.unwrap().join().unwrap();
        assert!(held.notes().is_empty());
    }

    #[test]
    fn a_link_that_has_ended_is_told_as_gone_and_a_closed_one_leaves_no_note() {
        let mut held = Held::new();
        held.session.device.request(Request::Disconnect).unwrap();
        held.wait_for(|event| matches!(event, Event::Closed));
        assert!(matches!(held.ask(), Asked::Gone(_)));
        held.hold = None;
        assert_eq!(held.ask(), Asked::Nobody);
        assert!(std::fs::read_dir(held.folder.path()).unwrap().next().is_none());
    }
}
