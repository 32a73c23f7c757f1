//! `brushwork drive`: motion for a stated time, ended by a stop on every way out.
//!
//! The device thread's dead-man is renewed by this loop alone, so that a hung terminal stops the motors too.

use crate::messages::{CliLinkMessage, CliUnitsMessage};
use brushwork_core::messages::CoreStatusMessage;
use brushwork_link::messages::ActMessage;
use std::fmt::Display;
use std::time::{Duration, Instant};

use brushwork_link::device::DisarmReason;
use brushwork_link::{ArmScope, Drive, DriveCommand, Event, Identity, PollRate, Request};
use serde_json::json;

use super::addresses::Line;
use super::args::DriveArgs;
use super::client::{arm_all, ask, event_of};
use super::joined::{self, JoinedLine};
use super::response::Response;
use super::status::line_of;
use super::{Exit, Interrupt, Output, OutputError, Readings, family, say, stop};
use brushwork_core::motion::check::MotionCheck;

/// Time between two sweeps of the signals.
const SWEEP_INTERVAL: Duration = Duration::from_millis(20);
/// Time between two printed lines.
const PRINT_INTERVAL: Duration = Duration::from_millis(100);

/// Connects, arms, drives, stops. Several controllers, also on several lines, are driven together: all of them or none.
pub fn run(args: &DriveArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let lines = joined::open(&args.connect, PollRate::Every(SWEEP_INTERVAL), interrupt)?;
    for line in &lines {
        if let Some(addresses) = line.silent() {
            let place = line.place.clone();
            return Err(Exit::NoLink.saying(CliUnitsMessage::NotAllThere { addresses, place }));
        }
    }
    let command = command(args, &lines, interrupt)?;
    let drive = match args.motor.motors() {
        [motor] => Drive::one(*motor, command),
        _ => Drive::both(command),
    };
    for unit in lines.iter().flat_map(|line| &line.units) {
        if let Some(clause) = unit.objection(&drive) {
            return Err(Exit::Refused.saying(CliLinkMessage::NotMoved {
                unit: unit.place(),
                port: unit.port.clone(),
                clause: clause.to_string(),
            }));
        }
    }
    lines.iter().try_for_each(JoinedLine::join)?;
    let devices: Vec<_> = lines.iter().map(|line| line.client.device()).collect();
    arm_all(&devices, ArmScope::CommandLine, interrupt)?;
    let mut run = Run::new(args, drive, &lines);
    let driven = run.keep_driving(out, interrupt);
    let is_lost = std::mem::take(&mut run.is_lost);
    let ended = finish(driven, &lines, &is_lost);
    if ended == Err(Exit::Interrupted) && args.connect.address.is_none() {
        for line in lines {
            // Whoever presses Ctrl-C and has named no unit wants the line to stand, whoever set it in motion.
            if line.client.simulation().is_none() {
                let own = line.client.identity.clone();
                drop(line.client);
                stop::stop_the_rest(&Line { connect: &line.place, ..args.connect.line() }, &own);
            }
        }
    }
    ended
}

/// Stops whatever the driving came to, then gives its exit code. A line that is lost hears nothing any more.
fn finish(driven: Result<(), Exit>, lines: &[JoinedLine], is_lost: &[bool]) -> Result<Exit, Exit> {
    let left = lines.iter().zip(is_lost).filter(|(_, lost)| !**lost);
    let links: Vec<_> = left.map(|(line, _)| (line.client.device(), line.units.as_slice())).collect();
    // What ended the driving counts for more than what the stop came to.
    let stopped = stop::stop_all_driven(&links);
    driven.and(stopped).map(|()| Exit::Done)
}

fn command(args: &DriveArgs, lines: &[JoinedLine], interrupt: &Interrupt) -> Result<DriveCommand, Exit> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a rate above zero; `as` saturates"
    )]
    let rate = |value: f64| value.round() as u32;
    if let Some(percent) = args.duty {
        let accel_duty_per_s = args.accel.map(|percent_per_s| percent_per_s / 100.0);
        return Ok(DriveCommand::Duty { duty: percent / 100.0, accel_duty_per_s });
    }
    if let Some(speed_counts_per_s) = args.speed {
        return Ok(DriveCommand::Speed { speed_counts_per_s, accel_counts_per_s2: args.accel.map(rate) });
    }
    let speed_counts_per_s = match args.speed_limit {
        Some(limit) => limit,
        None => full_speed(args, lines, interrupt)?,
    };
    if let Some(distance) = args.by {
        let speed = i32::try_from(speed_counts_per_s).unwrap_or(i32::MAX);
        return Ok(DriveCommand::Distance {
            speed_counts_per_s: if distance < 0 { -speed.max(1) } else { speed },
            accel_counts_per_s2: args.accel.map(rate),
            distance_counts: distance.unsigned_abs(),
            queued: false,
        });
    }
    // Without a figure the move takes a quarter of a second to its full speed.
    let accel = args.accel.map_or(speed_counts_per_s.saturating_mul(4), rate);
    Ok(DriveCommand::Position {
        position_counts: args.position.unwrap_or_default(),
        speed_counts_per_s,
        accel_counts_per_s2: accel,
        decel_counts_per_s2: args.decel.map_or(accel, rate),
        queued: false,
    })
}

/// The speed that each of the motors reaches.
fn full_speed(args: &DriveArgs, lines: &[JoinedLine], interrupt: &Interrupt) -> Result<u32, Exit> {
    let mut slowest = u32::MAX;
    for line in lines {
        let device = line.client.device();
        for unit in &line.units {
            if line.units.len() > 1 {
                ask(device, Request::Select(unit.address))?;
            }
            let of_unit = family::of(unit.family).full_speed(args.motor.motors(), device, interrupt)?;
            slowest = slowest.min(of_unit);
        }
    }
    Ok(slowest)
}

/// What is known of one of the controllers while it is driven.
struct Driven<'a> {
    line: usize,
    identity: &'a Identity,
    /// Its name, where there are several.
    name: Option<String>,
    readings: Readings,
    check: MotionCheck,
    responses: Vec<Response>,
}

struct Run<'a> {
    args: &'a DriveArgs,
    drive: Drive,
    lines: &'a [JoinedLine],
    units: Vec<Driven<'a>>,
    /// Of each line, whether its link is lost.
    is_lost: Vec<bool>,
}

impl<'a> Run<'a> {
    fn new(args: &'a DriveArgs, drive: Drive, lines: &'a [JoinedLine]) -> Self {
        let all = lines.iter().enumerate().flat_map(|(index, line)| {
            let several = args.connect.is_several();
            line.units.iter().map(move |identity| Driven {
                line: index,
                identity,
                name: several.then(|| line.name_of(identity)),
                readings: Readings::default(),
                check: MotionCheck::default(),
                responses: Response::of(&drive),
            })
        });
        Self { args, drive, lines, units: all.collect(), is_lost: vec![false; lines.len()] }
    }

    fn keep_driving(&mut self, out: &mut Output, interrupt: &Interrupt) -> Result<(), Exit> {
        let mut commanded_at = Vec::new();
        for line in self.lines {
            commanded_at.push(line.client.device().now());
            ask(line.client.device(), Request::Drive(self.drive))?;
        }
        let start = Instant::now();
        let mut next_print = start;
        while start.elapsed() < self.args.duration {
            for (index, line) in self.lines.iter().enumerate() {
                self.lines.iter().for_each(|line| line.client.device().renew());
                let event = event_of(line.client.device(), self.lines.len(), interrupt)
                    .inspect_err(|exit| self.is_lost[index] |= *exit == Exit::NoLink)?;
                if let Some(event) = event {
                    self.take(index, &event, commanded_at[index])?;
                }
            }
            if Instant::now() >= next_print {
                next_print += PRINT_INTERVAL;
                self.print(start.elapsed(), out)?;
            }
        }
        for unit in &self.units {
            unit.responses.iter().filter_map(Response::sentence).for_each(|sentence| unit.say(sentence));
        }
        Ok(())
    }

    fn take(&mut self, line: usize, event: &Event, commanded_at: Duration) -> Result<(), Exit> {
        if let Event::Disarmed(reason) = event {
            return Err(self.disarmed(line, reason));
        }
        if let Event::Failure(failure) = event {
            // The command never went out, on a line that was busy with faults for instance: nothing will move.
            if matches!(failure.tried.get(), Some(ActMessage::Move)) {
                return Err(Exit::Refused.saying(failure));
            }
            say(failure.to_string());
        }
        let address = event.address();
        for unit in self.units.iter_mut().filter(|unit| unit.line == line) {
            if address.is_some_and(|address| address != unit.identity.address) {
                continue;
            }
            if let Some(finding) = unit.check.take(event) {
                let is_fault = finding.is_fault();
                unit.say(finding.sentence);
                if is_fault {
                    return Err(Exit::Refused);
                }
            }
            if let Event::Sample(sample) = event {
                unit.responses.iter_mut().for_each(|response| response.take(sample, commanded_at));
            }
            unit.readings.take(event);
        }
        Ok(())
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn disarmed(&self, line: usize, reason: &DisarmReason) -> Exit {
        let is_faulty = |unit: &&Driven<'_>| {
            let status = unit.readings.status.as_ref();
            unit.line == line && status.is_some_and(|status| status.faults().next().is_some())
        };
        let said = CoreStatusMessage::Stopping { reason: reason.clone() };
        match (reason, self.units.iter().find(is_faulty)) {
            // That of another program is said once it has come to its end.
            (DisarmReason::StopFromOutside, _) => {}
            (DisarmReason::Fault(_), Some(unit)) => unit.say(said),
            _ => say(said),
        }
        match reason {
            DisarmReason::LinkLost => Exit::NoLink,
            _ => Exit::Refused,
        }
    }

    fn print(&self, at: Duration, out: &mut Output) -> Result<(), OutputError> {
        let seconds = at.as_secs_f64();
        for unit in &self.units {
            let Driven { identity, readings, name, .. } = unit;
            if self.args.json {
                let mut object = json!({ "time_s": seconds, "readings": readings.to_json(identity) });
                if name.is_some() {
                    object["connect"] = json!(self.lines[unit.line].place);
                    object["address"] = json!(identity.address);
                }
                out.json_line(&object)?;
                continue;
            }
            let name = name.iter().map(|name| format!("{name}  ")).collect::<String>();
            out.line(format!("{seconds:6.1} s  {name}{}", line_of(readings, identity)))?;
        }
        Ok(())
    }
}

impl Driven<'_> {
    /// Says a sentence of it, by name where there are several.
    fn say(&self, sentence: impl Display) {
        match &self.name {
            Some(unit) => say(CliUnitsMessage::Of { unit: unit.clone(), sentence: sentence.to_string() }),
            None => say(sentence),
        }
    }
}
