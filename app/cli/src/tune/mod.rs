//! `brushwork tune`: tunes a motor on the machine, or plays a report back.

mod args;
mod replay;
mod words;

use crate::messages::CliTuneMessage;
use brushwork_core::messages::{EndedMessage, TuneMessage};
use std::path::Path;
use std::time::{Duration, Instant};

use brushwork_link::exchange::Interruption;
use brushwork_link::{ArmScope, Event, Request, SettingsTable};
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Identification, MIDDLE_DUTY, Method};
use brushwork_values::Motor;

use super::client::ask;
use super::interrupt::exit_of_interruption;
use super::settings::controller::Controller;
use super::settings::memory::save_to_eeprom;
use super::{Exit, Interrupt, NewFile, Output, say};
use args::{EncoderArg, IdentificationArg, MethodArg, PositionIdentificationArg, RunArgs};
pub use args::{TuneArgs, TuneCommand};
use brushwork_core::keep::TrialKeeper;
use brushwork_core::tune::law::{self, Report, Request as TuneRequest};
use brushwork_core::tune::sequence::{Armed, Ended, Next, Origin, Sequence, Why, Work};
use brushwork_core::tune::{Restored, Target, file};

/// More than the three jobs may take, each of which the device thread ends in its time.
const LONGEST: Duration = Duration::from_secs(1_800);

/// Tunes or replays.
pub fn run(args: &TuneArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    match &args.command {
        TuneCommand::Velocity(args) => {
            let wanted = Wanted {
                identification: match args.method {
                    IdentificationArg::Fit => Identification::Fit,
                    IdentificationArg::Step => Identification::Step,
                    IdentificationArg::Relay => Identification::Relay,
                    IdentificationArg::Controller => Identification::Controller,
                },
                about_duty: f64::from(args.about) / 100.0,
                ..Wanted::of(Method::Velocity)
            };
            tune(&args.run, wanted, out, interrupt)
        }
        TuneCommand::Position(args) => {
            let method = match args.method {
                MethodArg::Pd => Method::Pd,
                MethodArg::Pid => Method::Pid,
                MethodArg::Piv | MethodArg::Fit | MethodArg::Step | MethodArg::Relay => Method::Piv,
                MethodArg::Controller => return Exit::Usage.saying(CliTuneMessage::NotForPiv),
            };
            let identification = match (args.method, args.identify) {
                (MethodArg::Piv | MethodArg::Fit, PositionIdentificationArg::Controller) => {
                    return Exit::Usage.saying(CliTuneMessage::NotForPiv);
                }
                (
                    MethodArg::Step,
                    PositionIdentificationArg::Relay | PositionIdentificationArg::Controller,
                )
                | (
                    MethodArg::Relay,
                    PositionIdentificationArg::Step | PositionIdentificationArg::Controller,
                ) => {
                    return Exit::Usage.saying(CliTuneMessage::TwoIdentifications);
                }
                (MethodArg::Step, _) | (_, PositionIdentificationArg::Step) => Identification::Step,
                (MethodArg::Relay, _) | (_, PositionIdentificationArg::Relay) => Identification::Relay,
                (_, PositionIdentificationArg::Controller) => Identification::Controller,
                _ => Identification::Fit,
            };
            let has_range = args.run.encoder.is_some_and(|encoder| encoder != EncoderArg::Quadrature);
            if args.run.travel.is_none() && !args.turns_freely && !has_range {
                return Exit::Usage.saying(CliTuneMessage::NoTravel);
            }
            let or_pid = matches!(args.method, MethodArg::Fit | MethodArg::Step | MethodArg::Relay);
            let about_duty = f64::from(args.about) / 100.0;
            let wanted = Wanted { or_pid, identification, about_duty, ..Wanted::of(method) };
            tune(&args.run, wanted, out, interrupt)
        }
        TuneCommand::Replay { report, json } => replay::run(report, *json, out),
    }
}

/// What is tuned, and how.
#[derive(Clone, Copy)]
struct Wanted {
    method: Method,
    /// Whether PID will do where there is no such loop.
    or_pid: bool,
    identification: Identification,
    about_duty: f64,
}

impl Wanted {
    fn of(method: Method) -> Self {
        Self { method, or_pid: false, identification: Identification::Fit, about_duty: MIDDLE_DUTY }
    }
}

fn tune(args: &RunArgs, wanted: Wanted, out: &mut Output, interrupt: &Interrupt) -> Exit {
    let mut file = args.report.as_deref().map(|path| NewFile::new(path, args.replace));
    if let Some(Err(error)) = file.as_ref().map(NewFile::check) {
        return error.into();
    }
    let controller = match Controller::connect(&args.connect, interrupt) {
        Ok(controller) => controller,
        Err(exit) => return exit,
    };
    controller.announce();
    let mut report = None;
    let ended = session(args, wanted, &controller, &mut report, interrupt);
    // What an interrupted run has seen is kept too.
    if let (Some(file), Some(report), Some(path)) = (&mut file, &report, &args.report)
        && let Err(exit) = keep(report, file, path)
    {
        return ended.err().unwrap_or(exit);
    }
    match (ended, report) {
        (Ok(restored), Some(report)) => conclude(args, &report, restored, &controller, out),
        (Ok(_), None) => Exit::Failed,
        (Err(exit), _) => exit,
    }
}

fn keep(report: &Report, file: &mut NewFile<'_>, path: &Path) -> Result<(), Exit> {
    let text = file::text_for(report, path).map_err(|why| {
        say(CliTuneMessage::ReportNotWritten { why: why.to_string() });
        Exit::Failed
    })?;
    Ok(file.write(text.as_bytes())?)
}

/// Carries out a run. What it changed is put back on every way out on which there is still a link.
fn session(
    args: &RunArgs,
    wanted: Wanted,
    controller: &Controller<'_>,
    found_report: &mut Option<Report>,
    interrupt: &Interrupt,
) -> Result<Restored, Exit> {
    let encoder = args.encoder.map(|encoder| match encoder {
        EncoderArg::Quadrature => EncoderClass::Quadrature,
        EncoderArg::Absolute => EncoderClass::Absolute,
        EncoderArg::AbsoluteWrapping => EncoderClass::AbsoluteWrapping,
    });
    let target = Target { motor: motor(args), encoder, stream: controller.client.stream };
    let sequence = Sequence::new(Work::Tune(Box::new(request(args, wanted))), target, ArmScope::CommandLine);
    let mut sequence = sequence.begun_again_when_late();
    let (ended, stopped) = match carry_out(&mut sequence, controller, interrupt) {
        Ok(ended) => ended,
        Err(exit) => {
            *found_report = sequence.link_ended().report;
            return Err(exit);
        }
    };
    *found_report = ended.report;
    let exit = match ended.interrupted.map(Why::Interrupted).or(ended.why) {
        None => None,
        Some(Why::Interrupted(cause)) => {
            say(CliTuneMessage::Ended { cause: cause.to_string() });
            Some(match cause {
                Interruption::DeadMan => Exit::TooLate,
                Interruption::Stop
                | Interruption::Disarm
                | Interruption::Closing
                | Interruption::Cancelled
                | Interruption::TimeLimit => exit_of_interruption(cause, stopped),
            })
        }
        Some(Why::Failed(failure)) => Some(Exit::Refused.saying(failure)),
        Some(Why::Panicked(word)) => {
            Some(Exit::Failed.saying(CliTuneMessage::Internal { word: word.to_string() }))
        }
        Some(Why::Ended(_)) if stopped => Some(Exit::Interrupted),
        Some(Why::Ended(why)) => {
            Some(Exit::Refused.saying(CliTuneMessage::NotTuned { why: why.to_string() }))
        }
    };
    if ended.owed.is_some() {
        say(CliTuneMessage::NotPutBack);
    }
    let Some(restored) = ended.restored else { return Err(exit.unwrap_or(Exit::Refused)) };
    if exit.is_some() {
        say(CliTuneMessage::PutBack);
    }
    if restored.loop_left_off {
        say(TuneMessage::LeftOff);
    }
    exit.map_or(Ok(restored), Err)
}

/// Has the run's jobs done one after the other, renewing the dead-man. Ctrl-C stops all motors, which ends the run, and does not keep
/// the old gains from being put back; says whether it came.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn carry_out(
    sequence: &mut Sequence,
    controller: &Controller<'_>,
    interrupt: &Interrupt,
) -> Result<(Ended, bool), Exit> {
    let device = controller.device();
    let origin = Origin { subject: controller.subject, keeper: TrialKeeper::new(controller.keeper()) };
    let (mut armed, mut stopped) = (Armed::Open, false);
    let deadline = Instant::now() + LONGEST;
    while Instant::now() < deadline {
        if interrupt.is_raised() && !stopped {
            stopped = true;
            device.stop_all();
            sequence.abort(EndedMessage::Stopped);
        }
        device.renew();
        match sequence.next(armed, || Some(origin.clone())) {
            Some(Next::Arm(scope)) => {
                armed = Armed::Open;
                ask(device, Request::Arm(scope))?;
            }
            Some(Next::Job(job)) => ask(device, Request::Job(job))?,
            None => {}
        }
        match controller.client.next_event(&Interrupt::default())? {
            Some(Event::Armed { warnings, .. }) => {
                warnings.iter().for_each(say);
                armed = Armed::Yes;
            }
            Some(Event::ArmRefused { reasons, .. }) => {
                reasons.iter().for_each(|reason| say(reason.to_string()));
                armed = Armed::Refused;
            }
            Some(Event::Failure(failure)) => say(failure.to_string()),
            Some(Event::Stopped(report)) if report.from_outside => sequence.abort(EndedMessage::Stopped),
            Some(event) => {
                if let Event::JobProgress { text, .. } = &event {
                    say(text);
                }
                let before = sequence.begun_again();
                if let Some(ended) = sequence.take(event) {
                    return Ok((ended, stopped));
                }
                if sequence.begun_again() > before {
                    say(CliTuneMessage::BegunAgain);
                }
            }
            None => {}
        }
    }
    Err(Exit::NoLink.saying(CliTuneMessage::NotInTime))
}

fn motor(args: &RunArgs) -> Motor {
    if args.motor == 2 { Motor::M2 } else { Motor::M1 }
}

fn request(args: &RunArgs, wanted: Wanted) -> TuneRequest {
    let travel = args.travel.map(|range| (range.low, range.high));
    let (level, max_duty) = (args.level.into(), args.max_duty.into());
    let mut request = law::request(wanted.method, level, motor(args), travel, max_duty, args.max_current);
    (request.identification, request.about_duty) = (wanted.identification, wanted.about_duty);
    request.or_pid = wanted.or_pid;
    request.guard.clear_winding = args.clear_lr;
    request.keep = args.apply || args.save;
    request
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
