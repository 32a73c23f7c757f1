//! Standing between another program and the controller: bytes are passed on both ways and decoded as they pass.
//!
//! One thread carries the bytes and decodes them, another prints, so that a slow terminal delays nobody. The line is half
//! duplex: while a reply is due that thread waits at the controller, else at the client, and looks at the other side at least
//! once a millisecond. When the tap ends while the client has motors running, it stops them: nobody else can any more.

use crate::messages::CliMonitorMessage;
use brushwork_link::work::receive_within;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use brushwork_link::transport::{Transport, TransportError};
use brushwork_plant::server::{self, Endpoint, Heard, Line};
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use super::args::MonitorArgs;
use super::chosen::follower;
use super::follower::Follower;
use super::record::{Record, print};
use crate::{Exit, Interrupt, Output, client, say};
use brushwork_core::session;

/// Records that may wait for a slow terminal; further ones are left out.
const QUEUE: usize = 4096;
/// Longest look at one side while the other may speak.
const LOOK: Duration = Duration::from_millis(1);
/// How often the printing thread looks at signals.
const WATCH: Duration = Duration::from_millis(20);
/// The pause after which what a client left half sent is over: twice what a controller needs.
const GAP: Duration = Duration::from_millis(20);
/// How long a stop at the end may take to be confirmed.
const STOP_LIMIT: Duration = Duration::from_millis(250);

/// What the carrying thread tells the printing one.
enum News {
    Record(Record),
    /// The queue was full.
    LeftOut(u64),
    ClientLeft,
}

/// Serves the tap until the time is over, the link is lost, or the program is interrupted.
pub fn run(args: &MonitorArgs, out: &mut Output, interrupt: &Interrupt) -> Result<(), Exit> {
    let endpoint = endpoint(args)?;
    let target = client::target(&args.connect)?;
    let (transport, simulation) =
        session::connect(&target, None).map_err(|error| Exit::NoLink.saying(error))?;
    interrupt.hold_line();
    let (line, place) = server::open(&endpoint).map_err(|error| failed(&error.to_string()))?;
    let (news, received) = bounded(QUEUE);
    let stop = Arc::new(AtomicBool::new(false));
    let name = transport.describe();
    let tap = Tap {
        line,
        transport,
        decoder: follower(args)?,
        news,
        left_out: 0,
        stop: stop.clone(),
        start: Instant::now(),
    };
    let carrier = thread::Builder::new()
        .name("tap".to_owned())
        .spawn(move || tap.run())
        .map_err(|error| failed(&format!("the system gave no thread for it: {error}")))?;
    say(CliMonitorMessage::Between { place: place.to_string(), name: name.to_string() });
    let printed = show(args, &received, out, interrupt);
    stop.store(true, Ordering::SeqCst);
    let carried = carrier.join();
    drop(simulation);
    match (printed, carried) {
        (_, Err(_)) => Err(failed("the thread that carries the bytes failed")),
        (Ok(()), Ok(Err(lost))) => Err(Exit::NoLink
            .saying(CliMonitorMessage::LinkLost { name: name.to_string(), lost: lost.to_string() })),
        (printed, Ok(_)) => printed,
    }
}

fn failed(what: &str) -> Exit {
    Exit::Failed.saying(CliMonitorMessage::NotBetween { what: what.to_string() })
}

fn endpoint(args: &MonitorArgs) -> Result<Endpoint, Exit> {
    match (&args.pty, &args.tcp) {
        (Some(link), _) => Ok(Endpoint::Pty { link: link.clone() }),
        (None, tcp) => {
            let address = tcp.as_deref().unwrap_or_default();
            address.parse::<SocketAddr>().map(Endpoint::Tcp).map_err(|_| {
                failed(&format!("\"{address}\" is no address to listen on; use for example 127.0.0.1:7001"))
            })
        }
    }
}

/// Prints until the time is over or the carrying thread ends.
fn show(
    args: &MonitorArgs,
    received: &Receiver<News>,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<(), Exit> {
    let start = Instant::now();
    while args.duration.is_none_or(|duration| start.elapsed() < duration) {
        if interrupt.is_raised() {
            return Err(Exit::Interrupted);
        }
        match receive_within(received, WATCH) {
            Ok(News::Record(record)) => print(args.json, &record, out)?,
            Ok(News::LeftOut(count)) => say(CliMonitorMessage::LeftOut { count }),
            Ok(News::ClientLeft) => say(CliMonitorMessage::ClientLeft),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    Ok(())
}

/// The thread between the two.
struct Tap {
    line: Box<dyn Line>,
    transport: Box<dyn Transport>,
    decoder: Box<dyn Follower>,
    news: Sender<News>,
    left_out: u64,
    stop: Arc<AtomicBool>,
    start: Instant,
}

impl Tap {
    fn run(mut self) -> Result<(), TransportError> {
        while !self.stop.load(Ordering::SeqCst) {
            self.turn()?;
        }
        stop_moved(self.transport.as_mut(), self.decoder.as_ref())
    }

    fn turn(&mut self) -> Result<(), TransportError> {
        let (at_client, at_controller) = match self.decoder.awaits_reply() {
            true => (Duration::ZERO, LOOK),
            false => (LOOK, Duration::ZERO),
        };
        self.carry_reply(at_controller)?;
        self.carry_request(at_client)?;
        let now = self.start.elapsed();
        let records = self.decoder.silence(now);
        self.tell(records);
        Ok(())
    }

    fn carry_reply(&mut self, timeout: Duration) -> Result<(), TransportError> {
        let mut chunk = [0; 1024];
        let count = self.transport.read(&mut chunk, timeout)?;
        if let Some(bytes) = chunk.get(..count).filter(|bytes| !bytes.is_empty()) {
            self.line.send(bytes);
            let records = self.decoder.controller_sent(bytes, self.start.elapsed());
            self.tell(records);
        }
        Ok(())
    }

    fn carry_request(&mut self, timeout: Duration) -> Result<(), TransportError> {
        let mut bytes = Vec::new();
        let heard = self.line.receive(&mut bytes, timeout);
        let now = self.start.elapsed();
        if !bytes.is_empty() {
            self.transport.write(&bytes)?;
            let records = self.decoder.client_sent(&bytes, now);
            self.tell(records);
        }
        if heard == Heard::ClientLeft {
            let records = self.decoder.client_left(now);
            self.tell(records);
            // Whoever prints may have ended.
            let _ = self.news.try_send(News::ClientLeft);
        }
        Ok(())
    }

    fn tell(&mut self, records: Vec<Record>) {
        for record in records {
            if self.left_out > 0 && self.news.try_send(News::LeftOut(self.left_out)).is_ok() {
                self.left_out = 0;
            }
            if self.news.try_send(News::Record(record)).is_err() {
                self.left_out += 1;
            }
        }
    }
}

/// Stops the units that the client had told to move.
fn stop_moved(transport: &mut dyn Transport, follower: &dyn Follower) -> Result<(), TransportError> {
    for stop in follower.stops() {
        let mut confirmed = false;
        for bytes in &stop.writes {
            // What the client left half sent must be over first: the controller drops it after a pause.
            thread::sleep(GAP);
            transport.discard_input()?;
            transport.write(bytes)?;
            confirmed |= answer_within(transport, STOP_LIMIT)?.starts_with(stop.acknowledge);
        }
        say(if confirmed {
            format!("Stopped {}: the other program had it running and can no longer reach it.", stop.who)
        } else {
            format!("Told {} to stop, but it did not confirm that. Cut the motor power.", stop.who)
        });
    }
    Ok(())
}

/// What comes within a time, up to the first pause.
fn answer_within(transport: &mut dyn Transport, limit: Duration) -> Result<Vec<u8>, TransportError> {
    let mut answer = [0; 32];
    let count = transport.read(&mut answer, limit)?;
    Ok(answer[..count].to_vec())
}
