//! `brushwork drive`: motion for a stated time, ended by a stop on every way out.
//!
//! The device thread's dead-man is renewed by this loop alone, so that a hung terminal stops the motors too.

use crate::messages::CliLinkMessage;
use brushwork_core::messages::CoreStatusMessage;
use brushwork_link::messages::ActMessage;
use std::time::{Duration, Instant};

use brushwork_link::device::DisarmReason;
use brushwork_link::{ArmScope, Drive, DriveCommand, Event, Identity, PollRate, Request};
use serde_json::json;

use super::args::DriveArgs;
use super::client::{arm, ask};
use super::response::Response;
use super::status::line_of;
use super::{Client, Exit, Interrupt, Output, OutputError, Readings, family, say, stop};
use brushwork_core::motion::check::MotionCheck;

/// Time between two sweeps of the signals.
const SWEEP_INTERVAL: Duration = Duration::from_millis(20);
/// Time between two printed lines.
const PRINT_INTERVAL: Duration = Duration::from_millis(100);

/// Connects, arms, drives, stops.
pub fn run(args: &DriveArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let client = Client::connect(&args.connect, PollRate::Every(SWEEP_INTERVAL), interrupt)?;
    let command = command(args, &client, interrupt)?;
    let drive = match args.motor.motors() {
        [motor] => Drive::one(*motor, command),
        _ => Drive::both(command),
    };
    if let Some(clause) = client.identity.objection(&drive) {
        return Err(Exit::Refused.saying(CliLinkMessage::NotMoved {
            unit: client.identity.place(),
            port: client.identity.port.clone(),
            clause: clause.to_string(),
        }));
    }
    arm(client.device(), ArmScope::CommandLine, interrupt)?;
    let driven = keep_driving(args, drive, &client, out, interrupt);
    let ended = finish(driven, &client);
    if ended == Err(Exit::Interrupted) && args.connect.address.is_none() && client.simulation().is_none() {
        // Whoever presses Ctrl-C and has named no unit wants the line to stand, whoever set it in motion.
        let own = client.identity.clone();
        drop(client);
        stop::stop_the_rest(&args.connect.line(), &own);
    }
    ended
}

/// Stops whatever the driving came to, then gives its exit code.
fn finish(driven: Result<(), Exit>, client: &Client) -> Result<Exit, Exit> {
    // What ended the driving counts for more than what the stop came to.
    let stopped = match driven {
        Err(Exit::NoLink) => Ok(()),
        Ok(()) | Err(_) => stop::stop_driven(client.device(), &client.identity),
    };
    driven.and(stopped).map(|()| Exit::Done)
}

fn command(args: &DriveArgs, client: &Client, interrupt: &Interrupt) -> Result<DriveCommand, Exit> {
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
        None => {
            let family = family::of(client.identity.family);
            family.full_speed(args.motor.motors(), client.device(), interrupt)?
        }
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

fn keep_driving(
    args: &DriveArgs,
    drive: Drive,
    client: &Client,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<(), Exit> {
    let mut responses = Response::of(&drive);
    let commanded_at = client.device().now();
    ask(client.device(), Request::Drive(drive))?;
    let start = Instant::now();
    let mut next_print = start;
    let mut readings = Readings::default();
    let mut check = MotionCheck::default();
    while start.elapsed() < args.duration {
        client.device().renew();
        match client.next_event(interrupt)? {
            Some(Event::Disarmed(reason)) => return Err(disarmed(&reason)),
            // The command never went out, on a line that was busy with faults for instance: nothing will move.
            Some(Event::Failure(failure)) if matches!(failure.tried.get(), Some(ActMessage::Move)) => {
                return Err(Exit::Refused.saying(failure));
            }
            Some(event) => {
                if let Some(finding) = check.take(&event) {
                    let is_fault = finding.is_fault();
                    say(finding.sentence);
                    if is_fault {
                        return Err(Exit::Refused);
                    }
                }
                if let Event::Sample(sample) = &event {
                    responses.iter_mut().for_each(|response| response.take(sample, commanded_at));
                }
                readings.take(event);
            }
            None => {}
        }
        if Instant::now() >= next_print {
            next_print += PRINT_INTERVAL;
            print(args, start.elapsed(), &readings, &client.identity, out)?;
        }
    }
    responses.iter().filter_map(Response::sentence).for_each(say);
    Ok(())
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn disarmed(reason: &DisarmReason) -> Exit {
    // That of another program is said once it has come to its end.
    if *reason != DisarmReason::StopFromOutside {
        say(CoreStatusMessage::Stopping { reason: reason.clone() });
    }
    match reason {
        DisarmReason::LinkLost => Exit::NoLink,
        _ => Exit::Refused,
    }
}

fn print(
    args: &DriveArgs,
    at: Duration,
    readings: &Readings,
    identity: &Identity,
    out: &mut Output,
) -> Result<(), OutputError> {
    let seconds = at.as_secs_f64();
    if args.json {
        return out.json_line(&json!({ "time_s": seconds, "readings": readings.to_json(identity) }));
    }
    out.line(format!("{seconds:6.1} s  {}", line_of(readings, identity)))
}
