//! `brushwork tune`: tunes a motor on the machine, or plays a report back.

mod args;
mod replay;
mod words;

use brushwork_core::messages::TuneMessage;
use std::time::{Duration, Instant};

use brushwork_link::{ArmScope, Event, Job, JobEnding, SettingsTable};
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Excitation, Method};
use brushwork_values::Motor;

use super::client::{arm, start};
use super::interrupt::exit_of_interruption;
use super::settings::controller::Controller;
use super::settings::memory::save_to_eeprom;
use super::{Client, Exit, Interrupt, NewFile, Output, say};
use args::{EncoderArg, MethodArg, RunArgs};
pub use args::{TuneArgs, TuneCommand};
use brushwork_core::keep::TrialKeeper;
use brushwork_core::tune::law::{Report, Request as TuneRequest};
use brushwork_core::tune::live::Live;
use brushwork_core::tune::{
    Restored, Slot, Target, file, leaves_off, prepare, restore, run as tuning_job, take,
};

/// How long arming and the short jobs may take.
const ANSWER_LIMIT: Duration = Duration::from_secs(30);

/// Tunes or replays.
pub fn run(args: &TuneArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    match &args.command {
        TuneCommand::Velocity(args) => tune(args, Method::Velocity, out, interrupt),
        TuneCommand::Position(args) => {
            let method = match args.method {
                MethodArg::Pd => Method::Pd,
                MethodArg::Pid => Method::Pid,
                MethodArg::Piv => Method::Piv,
            };
            tune(args, method, out, interrupt)
        }
        TuneCommand::Replay { report, json } => replay::run(report, *json, out),
    }
}

fn tune(args: &RunArgs, method: Method, out: &mut Output, interrupt: &Interrupt) -> Exit {
    let mut file = args.report.as_deref().map(|path| NewFile::new(path, args.replace));
    if let Some(Err(error)) = file.as_ref().map(NewFile::check) {
        return error.into();
    }
    let controller = match Controller::connect(&args.connect, interrupt) {
        Ok(controller) => controller,
        Err(exit) => return exit,
    };
    let mut report = None;
    let ended = session(args, method, &controller, &mut report, interrupt);
    // What an interrupted run has seen is kept too.
    if let (Some(file), Some(report)) = (&mut file, &report)
        && let Err(exit) = keep(report, file)
    {
        return ended.err().unwrap_or(exit);
    }
    match (ended, report) {
        (Ok(restored), Some(report)) => conclude(args, &report, restored, &controller, out),
        (Ok(_), None) => Exit::Failed,
        (Err(exit), _) => exit,
    }
}

fn keep(report: &Report, file: &mut NewFile<'_>) -> Result<(), Exit> {
    let text = file::text_of(report).map_err(|why| {
        say(format!("Could not write the report: {why}."));
        Exit::Failed
    })?;
    Ok(file.write(text.as_bytes())?)
}

/// The three jobs. The last one runs whatever became of the others, once anything may have been changed.
fn session(
    args: &RunArgs,
    method: Method,
    controller: &Controller<'_>,
    found_report: &mut Option<Report>,
    interrupt: &Interrupt,
) -> Result<Restored, Exit> {
    let client = &controller.client;
    let encoder = args.encoder.map(|encoder| match encoder {
        EncoderArg::Quadrature => EncoderClass::Quadrature,
        EncoderArg::Absolute => EncoderClass::Absolute,
        EncoderArg::AbsoluteWrapping => EncoderClass::AbsoluteWrapping,
    });
    let target = Target { motor: motor(args), encoder, stream: client.stream };
    let setup = Slot::default();
    let keeper = TrialKeeper::new(controller.keeper());
    let prepared = job(client, prepare(target, controller.subject, &setup, &keeper), interrupt);
    let Some(before) = take(&setup) else { return Err(prepared.err().unwrap_or(Exit::NoLink)) };
    let target = Target { encoder: Some(before.encoder), ..target };
    let found: Slot<Report> = Slot::default();
    let ran = prepared.and_then(|()| arm(client.device(), ArmScope::CommandLine, interrupt)).and_then(|()| {
        job(client, tuning_job(target, request(args, method), &found, &Live::default()), interrupt)
    });
    *found_report = take(&found);
    // A raised interrupt has ended the run; it must not keep the old gains from being put back.
    let kept = found_report.as_ref().filter(|_| ran.is_ok());
    let restoring = restore(target, before, kept, leaves_off(found_report.as_ref(), None), &keeper);
    let restored = job(client, restoring, &Interrupt::default());
    if restored.is_ok() && ran.is_err() {
        say("The old gains and settings are in force again, as reading them back has shown.");
    }
    if restored.is_ok_and(|restored| restored.loop_left_off) {
        say(TuneMessage::LeftOff);
    }
    ran.and(restored)
}

fn motor(args: &RunArgs) -> Motor {
    if args.motor == 2 { Motor::M2 } else { Motor::M1 }
}

fn request(args: &RunArgs, method: Method) -> TuneRequest {
    let excitation = match args.travel {
        Some(range) => Excitation::Window((range.high - range.low) as f64),
        None => Excitation::Free,
    };
    TuneRequest {
        method,
        level: f64::from(args.level),
        excitation,
        guard: GuardOptions {
            motor: motor(args).index(),
            max_duty: f64::from(args.max_duty) / 100.0,
            travel: args.travel.map(|range| (range.low, range.high)),
            max_amps: args.max_current,
            clear_winding: args.clear_lr,
            ..GuardOptions::default()
        },
        keep: args.apply || args.save,
        ..TuneRequest::default()
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn conclude(
    args: &RunArgs,
    report: &Report,
    restored: Restored,
    controller: &Controller<'_>,
    out: &mut Output,
) -> Exit {
    let printed = if args.json { out.json(&words::summary(report)) } else { words::print(report, out) };
    if let Err(error) = printed {
        return error.into();
    }
    if args.save && report.verdict != Verdict::Refused {
        match save_to_eeprom(controller, &SettingsTable::new(controller.subject)) {
            Ok((saved, exit)) => {
                say(saved.sentence());
                if exit != Exit::Done {
                    return exit;
                }
            }
            Err(exit) => return exit,
        }
    }
    match words::exit_of(report) {
        Exit::Done if restored.loop_left_off => Exit::TunedWithWarnings,
        exit => exit,
    }
}

/// Runs a job to its end, renewing the dead-man. Ctrl-C stops all motors, which ends the job.
fn job<T: Send + 'static>(client: &Client, job: Job<T>, interrupt: &Interrupt) -> Result<T, Exit> {
    let deaf = Interrupt::default();
    let limit = job.time_limit() + ANSWER_LIMIT;
    let ticket = start(client.device(), job)?;
    let deadline = Instant::now() + limit;
    let mut stopped = false;
    while Instant::now() < deadline {
        if interrupt.is_raised() && !stopped {
            stopped = true;
            client.device().stop_all();
        }
        client.device().renew();
        match client.next_event(&deaf)? {
            Some(Event::JobProgress { id, text, .. }) if id == ticket.id() => say(text),
            Some(Event::Failure(failure)) => say(failure.to_string()),
            Some(Event::JobEnded(report)) if report.id == ticket.id() => {
                return match ticket.ending(report.ending) {
                    JobEnding::Done(output) => Ok(output),
                    JobEnding::Interrupted(cause) => {
                        say(format!("The run was ended: {cause}. The motors were stopped."));
                        Err(exit_of_interruption(cause, stopped))
                    }
                    JobEnding::Failed(failure) => {
                        say(failure.to_string());
                        Err(Exit::Refused)
                    }
                    JobEnding::Panicked(word) => {
                        say(format!("Internal error while tuning: {word}. The motors were stopped."));
                        Err(Exit::Failed)
                    }
                };
            }
            _ => {}
        }
    }
    say("The run did not end in its time.");
    Err(Exit::NoLink)
}
