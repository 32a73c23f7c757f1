//! Stop at the motor: from the first stop byte on the wire to the bridge at duty 0, by the simulator's own truth and in its own time.
//! How long the key takes to the wire is measured apart.

use std::time::{Duration, Instant};

use brushwork_link::device::{ArmScope, DeviceHandle, Drive, Event, Request};
use brushwork_plant::pacing::byte_time;

use super::Effort;
use super::figure::{Figure, Target};
use super::rig::{Far, Rig};
use super::spread::{percentile, scattered};
use brushwork_cli::interrupt::Interrupt;

/// 99 of 100 motors must be off in less, at [`REQUIRED_AT_BPS`] and more.
const REQUIRED_P99_MS: f64 = 10.0;
const REQUIRED_AT_BPS: u32 = 115_200;
/// Stops are scattered over this stretch of polling.
const POLL_PHASE: Duration = Duration::from_millis(20);
/// How long anything may take.
const LIMIT: Duration = Duration::from_secs(10);

/// A controller whose motor is stopped again and again.
pub struct Case {
    /// What it is.
    pub name: String,
    /// Makes it.
    pub far: Far,
    /// What drives its motor, and from which duty on it counts as driven.
    pub drive: (Drive, f64),
}

/// p50 and p99 of one controller.
pub fn measure(case: Case, effort: Effort, interrupt: &Interrupt) -> Result<[Figure; 2], String> {
    let rig = Rig::start(case.far)?;
    let device = rig.connect(interrupt)?;
    let bench = Bench { rig, device, interrupt };
    let mut latencies_ms = Vec::new();
    // Each takes a few tenths of a second, since the unit is armed and driven anew.
    for part in scattered().take(effort.stops / 5) {
        latencies_ms.push(bench.stop(&case.drive.0, case.drive.1, part)?);
    }
    let rate_bps = bench.rig.rate_bps();
    let figure = |part: f64, title: &str| {
        let name = format!("{title} at the motor, {} at {rate_bps} bit/s", case.name);
        Figure::new("stop", name, percentile(&latencies_ms, part), "ms", 2)
    };
    let p99 = figure(0.99, "p99").note(format!("worst {:.2} ms", percentile(&latencies_ms, 1.0)));
    let p99 = if rate_bps >= REQUIRED_AT_BPS { p99.target(Target::Below(REQUIRED_P99_MS)) } else { p99 };
    let note = format!("{} stops from {:.0} % duty", latencies_ms.len(), case.drive.1 * 100.0);
    Ok([figure(0.5, "p50").note(note), p99])
}

struct Bench<'a> {
    rig: Rig,
    device: DeviceHandle,
    interrupt: &'a Interrupt,
}

impl Bench<'_> {
    /// Arms, drives, stops, and says how many milliseconds after the first stop byte had begun the motor was off.
    fn stop(&self, drive: &Drive, duty: f64, part: f64) -> Result<f64, String> {
        self.ask(Request::Arm(ArmScope::CommandLine))?;
        self.wait("arming was refused", |event| matches!(event, Some(Event::Armed { .. })))?;
        self.ask(Request::Drive(*drive))?;
        // A loop of the controller works at its own duty: the motor runs as soon as it is not off.
        self.wait("the motor did not run", |_| self.rig.bridge.duty() >= duty * 0.99)?;
        self.rest(POLL_PHASE.mul_f64(part));
        self.rig.bridge.take_off_at();
        let asked_at = Instant::now();
        self.device.stop_all();
        let mut off_at = None;
        self.wait("the motor was not off", |_| {
            off_at = off_at.or_else(|| self.rig.bridge.take_off_at());
            off_at.is_some()
        })?;
        let off_at = off_at.ok_or("the motor was not off")?;
        self.wait("the stop was not confirmed", |event| matches!(event, Some(Event::Stopped(_))))?;
        let log = self.rig.log.all();
        let stop = log.iter().position(|noted| noted.begun_at >= asked_at).ok_or("no stop bytes followed")?;
        let before: usize = log[..stop].iter().map(|noted| noted.request.len()).sum();
        let heard_at = self.rig.bridge.heard_at(before).ok_or("the stop bytes did not come")?;
        let begun_at = heard_at.saturating_sub(byte_time(self.rig.rate_bps()));
        Ok(off_at.saturating_sub(begun_at).as_secs_f64() * 1e3)
    }

    fn ask(&self, request: Request) -> Result<(), String> {
        self.device.request(request).map_err(|error| error.to_string())
    }

    fn rest(&self, time: Duration) {
        std::thread::sleep(time);
        self.device.renew();
    }

    fn wait(&self, failed: &str, mut is_done: impl FnMut(Option<&Event>) -> bool) -> Result<(), String> {
        let deadline = Instant::now() + LIMIT;
        loop {
            self.device.renew();
            let event = self.device.events().recv_timeout(Duration::from_micros(300)).ok();
            if is_done(event.as_ref()) {
                return Ok(());
            }
            match event {
                Some(Event::ArmRefused { reasons, .. }) => {
                    return Err(reasons.first().map_or(failed.to_owned(), ToString::to_string));
                }
                Some(Event::Lost(failure)) => return Err(failure.to_string()),
                _ if Instant::now() > deadline || self.interrupt.is_raised() => return Err(failed.to_owned()),
                _ => {}
            }
        }
    }
}
