//! Stop latency: from a Space key event at the window's key handling to the stop bytes on the wire.
//!
//! The window's own code runs headless: its key handling, its device thread, a real pseudo-terminal. What is left out is
//! the time in which the desktop brings the key to the program. Each stop is asked for at another moment of the polling.

use std::time::{Duration, Instant};

use brushwork_link::device::{Drive, DriveCommand};
use brushwork_link::{Addresses, ConnectTarget, DeviceHandle, Failure, PollRate, PortInfo, Request};
use brushwork_mcp_wire::packet_serial::{Generation, number};
use crossbeam_channel::{Receiver, bounded};
use egui::Key;

use super::far;
use crate::bench::Effort;
use crate::bench::at_motor::{self, Case};
use crate::bench::figure::{Figure, Target};
use crate::bench::headless::{Headless, key_event};
use crate::bench::rig::Rig;
use crate::bench::spread::{percentile, scattered};
use crate::bench::tap::Noted;
use brushwork_cli::interrupt::Interrupt;
use brushwork_core::keep::{Keeping, Store};
use brushwork_core::session::SessionError;
use brushwork_gui::App;
use brushwork_gui::parts::{OpenLink, Opener, Parts, PortSource};

const RATE_BPS: u32 = 115_200;
/// 99 of 100 stops must be on the wire in less.
const REQUIRED_P99_MS: f64 = 10.0;
/// Requests after a stop until polling counts as going on at full speed again.
const SETTLED_READS: usize = 10;
/// Stops are scattered over this stretch of polling.
const POLL_PHASE: Duration = Duration::from_millis(20);
/// How long anything may take.
const LIMIT: Duration = Duration::from_secs(5);

/// What is stopped at the motor. A RoboClaw discards all that follows a command that it does not know (MCP manual 2.2.4).
const AT_THE_MOTOR: [(&str, &[Generation]); 2] =
    [("mcp266", &Generation::ALL), ("roboclaw-2x7a", &[Generation::Gen1, Generation::Gen4])];
const MOTOR_RATES_BPS: [u32; 3] = [115_200, 38_400, 9_600];
/// Duty that a stop takes away, at 2000 %/s, the steepest that command 54 has: 5 ms of what is measured.
const MOTOR_DUTY: f64 = 0.1;

/// The situation in which Stop is pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Situation {
    Polling,
    /// A read of 144 (all input pins) is being answered.
    LongRead,
}

/// p50, p99 and worst in both situations.
pub fn measure(effort: Effort, interrupt: &Interrupt) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for situation in [Situation::Polling, Situation::LongRead] {
        let mut bench = StopBench::connect(interrupt)?;
        let latencies_ms = bench.latencies_ms(situation, effort.stops)?;
        figures.extend(figures_of(situation, &latencies_ms, bench.long_reply_bytes));
    }
    for (model, generations) in AT_THE_MOTOR {
        for (generation, rate_bps) in
            generations.iter().flat_map(|each| MOTOR_RATES_BPS.map(|rate| (*each, rate)))
        {
            let case = Case {
                name: format!("{model} {generation}"),
                far: far(model, generation, rate_bps)?,
                drive: (Drive::both(DriveCommand::duty(MOTOR_DUTY)), MOTOR_DUTY),
            };
            figures.extend(at_motor::measure(case, effort, interrupt)?);
        }
    }
    Ok(figures)
}

fn figures_of(situation: Situation, latencies_ms: &[f64], long_reply_bytes: usize) -> [Figure; 2] {
    let name = match situation {
        Situation::Polling => "polling at full speed",
        Situation::LongRead => "during a 144 read",
    };
    let note = match situation {
        Situation::Polling => format!("{} stops at {RATE_BPS} bit/s", latencies_ms.len()),
        Situation::LongRead => {
            format!("{} stops, each inside a reply of {long_reply_bytes} bytes", latencies_ms.len())
        }
    };
    let worst = percentile(latencies_ms, 1.0);
    let figure = |part: f64, title: &str| {
        Figure::new("stop", format!("{title}, {name}"), percentile(latencies_ms, part), "ms", 2)
    };
    [
        figure(0.5, "p50").note(note),
        figure(0.99, "p99").target(Target::Below(REQUIRED_P99_MS)).note(format!("worst {worst:.2} ms")),
    ]
}

/// A headless window on a paced wire.
struct StopBench<'a> {
    rig: Rig,
    app: App,
    headless: Headless,
    interrupt: &'a Interrupt,
    long_reply_bytes: usize,
}

impl<'a> StopBench<'a> {
    fn connect(interrupt: &'a Interrupt) -> Result<Self, String> {
        let rig = Rig::start(far("mcp266", Generation::Gen1, RATE_BPS)?)?;
        let headless = Headless::new();
        let parts = Parts {
            ports: Box::new(NoPorts),
            opener: Box::new(Given(Some(rig.open()?))),
            keeping: Keeping::new(Store::of_user()),
        };
        let mut app = App::new(&headless.ctx, parts);
        app.model.front.poll = PollRate::Fastest;
        app.open("the rig");
        let mut bench = Self { rig, app, headless, interrupt, long_reply_bytes: 0 };
        bench.wait("the controller was not found", |bench| {
            bench.draw();
            bench.app.model.is_connected()
        })?;
        bench.learn_long_reply()?;
        Ok(bench)
    }

    /// How many bytes a whole answer to 144 has.
    fn learn_long_reply(&mut self) -> Result<(), String> {
        let index = self.ask_for_signals()?;
        self.wait("144 was not answered", |bench| bench.rig.log.writes() > index + 1)?;
        let found = self.rig.log.find(index, |_| true);
        self.long_reply_bytes = found.map_or(0, |(_, noted)| noted.reply_bytes);
        Ok(())
    }

    fn latencies_ms(&mut self, situation: Situation, stops: usize) -> Result<Vec<f64>, String> {
        let mut latencies_ms = Vec::new();
        let mut tried = 0;
        for part in scattered() {
            if latencies_ms.len() == stops {
                break;
            }
            tried += 1;
            if tried > stops * 3 {
                return Err("too few stops fell into an answer".to_owned());
            }
            self.settle()?;
            latencies_ms.extend(match situation {
                Situation::Polling => Some(self.stop_while_polling(part)?),
                Situation::LongRead => self.stop_in_long_read(part)?,
            });
        }
        Ok(latencies_ms)
    }

    /// Waits until the last stop is over and polling goes on.
    fn settle(&mut self) -> Result<(), String> {
        self.rig.log.clear();
        self.wait("polling did not go on", |bench| {
            let log = bench.rig.log.all();
            log.iter().filter(|noted| commands(noted) == Some(number::READ_ENCODERS)).count() >= 2
                && log.len() >= SETTLED_READS
        })?;
        self.draw();
        Ok(())
    }

    fn stop_while_polling(&mut self, part: f64) -> Result<f64, String> {
        std::thread::sleep(POLL_PHASE.mul_f64(part));
        self.press_space().map(|(_, latency_ms)| latency_ms)
    }

    /// None when the answer was over before the stop bytes went out.
    fn stop_in_long_read(&mut self, part: f64) -> Result<Option<f64>, String> {
        let index = self.ask_for_signals()?;
        let reply_time = Duration::from_secs(10) * self.long_reply_bytes as u32 / RATE_BPS;
        std::thread::sleep(reply_time.mul_f64(0.9 * part));
        let (stop, latency_ms) = self.press_space()?;
        let asked = self.rig.log.find(index, |_| true).map(|(_, noted)| noted);
        let was_inside = stop == index + 1 && asked.is_some_and(|noted| noted.reply_bytes == 0);
        Ok(was_inside.then_some(latency_ms))
    }

    /// Asks for 144 and returns the place of the request in the log, as soon as it is on the wire.
    fn ask_for_signals(&mut self) -> Result<usize, String> {
        let from = self.rig.log.writes();
        let device = self.app.device().ok_or("the link was lost")?;
        let request = Request::Transact { id: 0, command: number::READ_SIGNALS, values: Vec::new() };
        device.request(request).map_err(|error| error.to_string())?;
        let mut found = None;
        self.wait("144 was not sent", |bench| {
            found = bench.rig.log.find(from, |noted| commands(noted) == Some(number::READ_SIGNALS));
            found.is_some()
        })?;
        Ok(found.map_or(from, |(index, _)| index))
    }

    /// Gives the window a Space and waits for the stop bytes: their place in the log, and the milliseconds since the key.
    fn press_space(&mut self) -> Result<(usize, f64), String> {
        let from = self.rig.log.writes();
        let pressed_at = Instant::now();
        self.headless.shapes(vec![key_event(Key::Space, true)], |ui| self.app.contents(ui));
        let mut found = None;
        self.wait("no stop bytes followed", |bench| {
            found = bench.rig.log.find(from, is_stop);
            found.is_some()
        })?;
        self.headless.shapes(vec![key_event(Key::Space, false)], |ui| self.app.contents(ui));
        let (index, stop) = found.ok_or("no stop bytes followed")?;
        Ok((index, stop.written_at.duration_since(pressed_at).as_secs_f64() * 1e3))
    }

    fn draw(&mut self) {
        self.headless.shapes(Vec::new(), |ui| self.app.contents(ui));
    }

    fn wait(&mut self, failed: &str, mut done: impl FnMut(&mut Self) -> bool) -> Result<(), String> {
        let deadline = Instant::now() + LIMIT;
        while !done(self) {
            if Instant::now() > deadline || self.interrupt.is_raised() {
                return Err(failed.to_owned());
            }
            std::thread::sleep(Duration::from_micros(300));
        }
        Ok(())
    }
}

/// The command byte of a lone request.
fn commands(noted: &Noted) -> Option<u8> {
    noted.request.get(1).copied()
}

/// Whether a write holds duty 0 for both motors, alone or behind the end of a script.
fn is_stop(noted: &Noted) -> bool {
    let start = [brushwork_mcp_wire::packet_serial::Address::DEFAULT.get(), number::DUTY_ACCEL_BOTH];
    noted.request.windows(start.len()).any(|bytes| bytes == start)
}

struct NoPorts;

impl PortSource for NoPorts {
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>> {
        None
    }
}

/// Opens the link that it was given, whatever is asked for.
struct Given(Option<DeviceHandle>);

impl Opener for Given {
    fn open(&mut self, _: ConnectTarget, _: Addresses) -> Receiver<Result<OpenLink, SessionError>> {
        let (sender, receiver) = bounded(1);
        if let Some(device) = self.0.take() {
            // The receiver is right here, and the channel has room.
            let _ = sender.send(Ok(OpenLink { device, bus: None, world: None }));
        }
        receiver
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stop_bytes_are_told_from_readings() {
        let at = Instant::now();
        let noted = |request: &[u8]| Noted {
            begun_at: at,
            written_at: at,
            request: request.to_vec(),
            reply_bytes: 0,
            replied_at: None,
        };
        assert!(is_stop(&noted(&[0x80, 54, 0, 0])));
        // 0x80, end of script (249) and its CRC, then duty 0 (54).
        assert!(is_stop(&noted(&[0x80, 249, 0x12, 0x34, 0x80, 54, 0, 0])));
        assert!(!is_stop(&noted(&[0x80, 78])));
        assert!(!is_stop(&noted(&[0x80, 144])));
    }
}
