//! A second process of this program for each line that is armed. It does nothing until the first one dies, however that may be, and then
//! writes the stop.
//!
//! Its standard output is the end of a pipe to read from, which the system closes when the first process dies. Its standard input is the port,
//! opened a second time; where the system opens a port to one process at a time, as Windows does, it opens the port when the first process is
//! gone. A first process that lives and stands still while motors may move is ended before anything is written, so that two never speak at once.

use brushwork_link::work::receive_within;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use brushwork_link::device::StopBytes;
use brushwork_link::guardian::{Guardian, LineGuard};
use brushwork_link::transport::{ConnectTarget, SecondWay, Transport};
use crossbeam_channel::{RecvTimeoutError, bounded};
use serde::{Deserialize, Serialize};

/// First argument of the second process.
pub const COMMAND: &str = "guardian";

/// How often a program that lives says so at the most.
const LIFE_INTERVAL: Duration = Duration::from_millis(40);
/// A program that says nothing for so long while motors may move stands still: the dead-man inside of it, 250 ms, and 100 ms more.
const STANDS_STILL: Duration = Duration::from_millis(350);
/// How often it is looked at whether the program dies. Its pipe closes only when the last of its threads is gone, which takes seconds on a busy
/// computer; so soon after the kill it shows in what the system says of it.
const LOOK_INTERVAL: Duration = Duration::from_millis(20);
/// A wait that took so much longer than it should was this process's own standing still.
const OWN_LATENESS: Duration = Duration::from_millis(100);
/// How long a killed program is waited for. From the kill on it runs no code of its own, though on a busy computer its threads may take
/// seconds to be gone; a write that was under way ends sooner.
const GONE_LIMIT: Duration = Duration::from_millis(50);
/// When the stop is written, counted from the death. The first may end up behind the torn packet of a program that died while it wrote, which a
/// controller drops after 10 ms (MCP manual 2.2) or 5 ms (Motion Mind manual 5.1.1).
const STOP_AT: [Duration; 4] =
    [Duration::ZERO, Duration::from_millis(20), Duration::from_millis(60), Duration::from_millis(200)];
/// Orders that wait to be looked at.
const WAITING_ORDERS: usize = 64;
/// How long a port that the first process had is tried until it opens, and how long after each other.
const FREE_LIMIT: Duration = Duration::from_secs(5);
const TRY_AGAIN: Duration = Duration::from_millis(5);
/// How long a port may take no bytes.
const WRITE_LIMIT: Duration = Duration::from_millis(200);

/// What the second process is told, a line of JSON each.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Order {
    /// What to write when the program dies, with so much silence between two.
    Hold { writes: Vec<Vec<u8>>, gap_ms: u64 },
    /// There is nothing to stop.
    Release,
    /// Whether a motion command may be in effect.
    Moving(bool),
    /// The program lives.
    Lives,
}

static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// Makes known which program is this one, so that it can be started a second time.
pub fn install(program: PathBuf) {
    // Twice the same in tests.
    let _ = PROGRAM.set(program);
}

/// Who watches over lines of this program, where it was installed.
#[must_use]
pub fn of_program() -> Option<Arc<dyn Guardian>> {
    PROGRAM.get().map(|program| Arc::new(Second(program.clone())) as Arc<dyn Guardian>)
}

#[derive(Debug)]
struct Second(PathBuf);

impl Guardian for Second {
    fn start(&self, port: &str, line: SecondWay) -> io::Result<Box<dyn LineGuard>> {
        let (orders, tell) = io::pipe()?;
        let tell = Tell::through(tell)?;
        let (line, later) = match line {
            SecondWay::Open(line) => (line, None),
            SecondWay::Later(target) => (Stdio::null(), Some(target)),
        };
        let opens_later = later.is_some();
        let mut command = Command::new(&self.0);
        command.args([COMMAND, &std::process::id().to_string(), port]).args(later);
        command.stdin(line).stdout(orders).stderr(Stdio::null());
        // A folder that is to be unmounted would be held, and Ctrl-C of the terminal would end it with the program.
        command.current_dir("/");
        apart(&mut command);
        #[expect(clippy::disallowed_methods, reason = "`Process` owns it, and it ends with its pipe")]
        let child = command.spawn()?;
        Ok(Box::new(Process {
            child: Mutex::new(child),
            tell: Mutex::new(Some(tell)),
            opens_later,
            begun_at: Instant::now(),
            told_ms: AtomicU64::new(0),
        }))
    }
}

/// The pipe to the second process. It is full when that stands still, and nobody waits for it.
#[cfg(unix)]
#[derive(Debug)]
struct Tell(io::PipeWriter);

#[cfg(unix)]
impl Tell {
    fn through(pipe: io::PipeWriter) -> io::Result<Self> {
        rustix::io::ioctl_fionbio(&pipe, true)?;
        Ok(Self(pipe))
    }

    /// A pipe takes so little at one go or not at all.
    fn tell(&mut self, line: &[u8]) {
        let _ = self.0.write_all(line);
    }
}

/// The same where a pipe always waits: a thread does that.
#[cfg(not(unix))]
#[derive(Debug)]
struct Tell(brushwork_link::work::Worker<Vec<u8>>);

#[cfg(not(unix))]
impl Tell {
    fn through(mut pipe: io::PipeWriter) -> io::Result<Self> {
        let write = move |line: Vec<u8>| drop(pipe.write_all(&line));
        Ok(Self(brushwork_link::work::Worker::start("guardian", WAITING_ORDERS, write)))
    }

    fn tell(&mut self, line: &[u8]) {
        let _ = self.0.give(line.to_vec());
    }
}

#[cfg(unix)]
fn apart(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

#[cfg(windows)]
fn apart(command: &mut Command) {
    use std::os::windows::process::CommandExt as _;
    /// `CREATE_NEW_PROCESS_GROUP` and `CREATE_NO_WINDOW`: neither Ctrl-C of the first one's console nor its closing reaches it.
    const APART: u32 = 0x0000_0200 | 0x0800_0000;
    command.creation_flags(APART);
}

#[cfg(not(any(unix, windows)))]
fn apart(_command: &mut Command) {}

/// The second process of one line.
#[derive(Debug)]
struct Process {
    child: Mutex<Child>,
    tell: Mutex<Option<Tell>>,
    /// It can do nothing while this process has the port.
    opens_later: bool,
    begun_at: Instant,
    /// When it was last told that the program lives, ms after its begin.
    told_ms: AtomicU64,
}

impl Process {
    fn tell(&self, order: &Order) {
        let Ok(mut line) = serde_json::to_vec(order) else { return };
        line.push(b'\n');
        if let Some(tell) = self.tell.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
            tell.tell(&line);
        }
    }
}

impl LineGuard for Process {
    fn hold(&self, stop: &StopBytes) {
        let gap_ms = u64::try_from(stop.gap.as_millis()).unwrap_or_default();
        self.tell(&Order::Hold { writes: stop.writes(), gap_ms });
    }

    fn release(&self) {
        self.tell(&Order::Release);
    }

    fn moving(&self, moving: bool) {
        self.tell(&Order::Moving(moving));
    }

    fn is_there(&self) -> bool {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        child.try_wait().is_ok_and(|ended| ended.is_none())
    }

    fn lives(&self) {
        let now_ms = u64::try_from(self.begun_at.elapsed().as_millis()).unwrap_or(u64::MAX);
        let told_ms = self.told_ms.load(Ordering::Relaxed);
        if now_ms.saturating_sub(told_ms) >= LIFE_INTERVAL.as_millis() as u64 {
            self.told_ms.store(now_ms, Ordering::Relaxed);
            self.tell(&Order::Lives);
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // Nor could it write a last stop, and it would wait for the port that is about to be closed.
        if self.opens_later {
            self.release();
        }
        // The closed pipe is the end of it. It has the port, which can be opened again only when it is gone.
        drop(self.tell.lock().unwrap_or_else(PoisonError::into_inner).take());
        let _ = self.child.lock().unwrap_or_else(PoisonError::into_inner).wait();
    }
}

/// A port that the first process has to itself as long as it lives, as the second one opens it then.
pub struct Later(Box<dyn Transport>);

impl Later {
    /// Opens it as soon as it is free.
    #[must_use]
    pub fn open(target: &ConnectTarget) -> Option<Self> {
        let until = Instant::now() + FREE_LIMIT;
        loop {
            match target.open() {
                Ok(port) => return Some(Self(port)),
                Err(_) if Instant::now() < until => std::thread::sleep(TRY_AGAIN),
                // There is nobody to tell.
                Err(_) => return None,
            }
        }
    }
}

impl Write for Later {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes).map(|()| bytes.len()).map_err(io::Error::other)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// What the second process does for all its life. `line` is asked for when the stop is to be written. `is_dying` tells whether the first one runs no
/// code of its own any more, where the system says so before its pipe closes; `end_first` ends it, if it is there still.
pub fn stand_guard<L: Write>(
    orders: impl Read + Send + 'static,
    line: impl FnOnce() -> Option<L>,
    is_dying: impl Fn() -> bool,
    end_first: impl FnOnce(),
) {
    let (sender, inbox) = bounded(WAITING_ORDERS);
    let read = move || {
        let lines = BufReader::new(orders).lines().map_while(Result::ok);
        for order in lines.map_while(|line| serde_json::from_str::<Order>(&line).ok()) {
            if sender.send(order).is_err() {
                return;
            }
        }
    };
    // Without the thread nothing is heard, and the channel is closed as if the program had died.
    let _reader = std::thread::Builder::new().name("orders".to_owned()).spawn(read);
    let (mut held, mut is_moving) = (None, false);
    // How long nothing has come, of this process's own time.
    let mut silent = Duration::ZERO;
    loop {
        let waits_from = Instant::now();
        let order = match held.is_some() && is_moving {
            true => receive_within(&inbox, LOOK_INTERVAL),
            false => inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
        };
        if order.is_ok() {
            silent = Duration::ZERO;
        }
        match order {
            Ok(Order::Hold { writes, gap_ms }) => held = Some((writes, Duration::from_millis(gap_ms))),
            Ok(Order::Release) => held = None,
            Ok(Order::Moving(moving)) => is_moving = moving,
            Ok(Order::Lives) => {}
            Err(RecvTimeoutError::Timeout) => {
                if is_dying() {
                    break;
                }
                let waited = waits_from.elapsed();
                silent += if waited > LOOK_INTERVAL + OWN_LATENESS { LOOK_INTERVAL } else { waited };
                if silent < STANDS_STILL {
                    continue;
                }
                end_first();
                // Its pipe closes when it is gone.
                let gone_by = Instant::now() + GONE_LIMIT;
                while inbox.recv_deadline(gone_by).is_ok() {}
                break;
            }
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    let Some((writes, gap)) = held else { return };
    let Some(mut line) = line() else { return };
    let died_at = Instant::now();
    for at in STOP_AT {
        std::thread::sleep((died_at + at).saturating_duration_since(Instant::now()));
        for (turn, bytes) in writes.iter().enumerate() {
            if turn > 0 {
                std::thread::sleep(gap);
            }
            write_patiently(&mut line, bytes);
        }
    }
}

/// A port that does not wait says when it is full.
fn write_patiently(line: &mut impl Write, mut bytes: &[u8]) {
    let until = Instant::now() + WRITE_LIMIT;
    while !bytes.is_empty() && Instant::now() < until {
        match line.write(bytes) {
            Ok(count) => bytes = &bytes[count..],
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                std::thread::sleep(Duration::from_millis(1));
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            // The port is gone, and there is nobody to tell.
            Err(_) => return,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(orders: &[Order]) -> Vec<u8> {
        orders
            .iter()
            .flat_map(|order| serde_json::to_string(order).unwrap().into_bytes().into_iter().chain(*b"\n"))
            .collect()
    }

    fn written(orders: &[Order]) -> Vec<u8> {
        let mut line = Vec::new();
        stand_guard(
            io::Cursor::new(lines(orders)),
            || Some(&mut line),
            || false,
            || panic!("it is dead already"),
        );
        line
    }

    fn hold(byte: u8) -> Order {
        Order::Hold { writes: vec![vec![byte, byte], vec![0xff]], gap_ms: 0 }
    }

    #[test]
    fn the_last_stop_that_was_told_is_written_again_and_again_when_the_pipe_closes() {
        assert_eq!(written(&[hold(1), Order::Moving(true), hold(7)]), [7, 7, 0xff].repeat(STOP_AT.len()));
    }

    #[test]
    fn nothing_is_written_where_nothing_can_move() {
        assert!(written(&[]).is_empty());
        assert!(written(&[hold(1), Order::Moving(true), Order::Release]).is_empty());
    }

    #[test]
    fn a_program_that_stands_still_while_it_moves_motors_is_ended_before_the_stop_is_written() {
        let (orders, mut tell) = io::pipe().unwrap();
        tell.write_all(&lines(&[hold(1), Order::Moving(true), Order::Lives])).unwrap();
        let mut line = Vec::new();
        stand_guard(orders, || Some(&mut line), || false, || drop(tell));
        assert_eq!(line, [1, 1, 0xff].repeat(STOP_AT.len()));
    }

    #[test]
    fn a_program_that_is_seen_to_die_is_stopped_for_before_its_pipe_closes() {
        let (orders, mut tell) = io::pipe().unwrap();
        tell.write_all(&lines(&[hold(1), Order::Moving(true)])).unwrap();
        let mut line = Vec::new();
        stand_guard(orders, || Some(&mut line), || true, || panic!("whoever dies needs no end"));
        assert_eq!(line, [1, 1, 0xff].repeat(STOP_AT.len()));
        drop(tell);
    }
}
