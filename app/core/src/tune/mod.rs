//! Tuning over the device thread: the tuner's axis as a job on the thread that owns the link, and what brackets it.
//!
//! A run is three jobs. The first moves nothing: it keeps a backup and a journal on this computer, reads what the controller holds
//! and shortens the stream's time-out. The second
//! is the run, which needs arming. The third moves nothing either and puts back what must be put back, on every way out on which
//! there is still a link. What an interruption leaves of the run's own report is kept past the job.

pub mod file;
pub mod law;
pub mod live;
pub mod page;
pub mod sequence;
pub mod words;

use crate::messages::{CoreActMessage, CoreCauseMessage, CoreRemedyMessage};
use brushwork_family::messages::LoopActMessage;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use brushwork_family::tuned::{Tuned, failed, thrice};
use brushwork_link::device::JobContext;
use brushwork_link::settings::{Ending, begin_trial, end_act};
use brushwork_link::{Failure, Job, SettingValue, Subject};
use brushwork_tuning::axis::{AxisError, EncoderClass, Want};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::RUN_STREAM_TIMEOUT_MS;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::trial::run_trial;
use brushwork_tuning::tune::tune_watched;
use brushwork_values::Motor;

pub use brushwork_family::{Restored, Target};

use crate::keep::TrialKeeper;
use law::{Families, Report, Request, Setup, Trial, TrialRequest};
use live::Live;

/// The longest reading, all that a poll may ask for, with which a run can tell what a motor does: see `slow_lines` among the tests for what
/// becomes of runs at each rate and lateness.
const LONGEST_READING: Duration = Duration::from_millis(90);
/// Readings by which a line is judged, and what each asks for: the fewest, and so many where none was quick or some came late, since a
/// busy computer is no slow line. Twelve in a row that each wait for a processor were not seen beside six busy programs on two.
const READINGS: usize = 3;
const MOST_READINGS: usize = 12;
const READING: Want = Want { duty: true, current: true, volts: false };

/// What a trial of gains may take.
const TRIAL_LIMIT: Duration = Duration::from_secs(120);
/// How long the job before a run may take: it reads every setting for the backup.
const PREPARE_LIMIT: Duration = Duration::from_secs(130);
/// How long the job after a run may take.
const RESTORE_LIMIT: Duration = Duration::from_secs(60);
/// What a run may take beyond its own limit.
const GRACE: Duration = Duration::from_secs(10);

/// What a job leaves for whoever started it, whatever became of the job.
pub type Slot<T> = Arc<Mutex<Option<T>>>;

/// Takes what a job left.
pub fn take<T>(slot: &Slot<T>) -> Option<T> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).take()
}

pub(crate) fn put<T>(slot: &Slot<T>, value: T) {
    *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(value);
}

/// Whether a setting tells what kind of encoder a motor has.
#[must_use]
pub fn tells_encoder(key: &str) -> bool {
    Families::tells_encoder(key)
}

/// What kind of encoder a motor has, as the settings say.
#[must_use]
pub fn encoder(settings: &dyn Fn(&str) -> Option<SettingValue>, motor: Motor) -> Option<EncoderClass> {
    Families::encoder(settings, motor)
}

/// The rate of a line for a sentence: " at 9600 bit/s". Ten bits a byte, whose time is in whole ns.
fn rate_of(context: &JobContext<'_>) -> String {
    let rate = context.byte_time().map(|time| (0.1 / time.as_secs_f64()).round() * 100.0);
    rate.filter(|rate| rate.is_finite()).map_or_else(String::new, |rate| format!(" at {rate:.0} bit/s"))
}

/// Refuses a line over which a run would not see in time what the motor does, before anything is asked or changed. It is judged by the
/// quickest of a few readings at rest: a busy computer makes some of them longer, a slow line all.
fn check_line(context: &mut JobContext<'_>, target: Target, place: &str) -> Result<(), Failure> {
    context.set_polling(false);
    let mut axis = Families::axis(context, target, true);
    let mut quickest = Duration::MAX;
    let mut error = None;
    for reading in 0..MOST_READINGS {
        if reading >= READINGS && quickest <= LONGEST_READING {
            break;
        }
        let begun_at = axis.now();
        match axis.sample(READING) {
            Ok(_) => quickest = quickest.min(axis.now().saturating_sub(begun_at)),
            Err(late @ (AxisError::NoReply | AxisError::Late)) => error = Some(late),
            Err(other) => return Err(failed(LoopActMessage::Read, place, &other)),
        }
    }
    drop(axis);
    context.set_polling(true);
    if let Some(error) = error.filter(|_| quickest == Duration::MAX) {
        return Err(failed(LoopActMessage::Read, place, &error));
    }
    if quickest <= LONGEST_READING {
        return Ok(());
    }
    let cause = CoreCauseMessage::SlowReading {
        rate: rate_of(context),
        took_ms: quickest.as_millis(),
        longest_ms: LONGEST_READING.as_millis(),
    };
    Err(Failure::new(CoreActMessage::Tune, place, cause, CoreRemedyMessage::QuickerLine))
}

/// Refuses a line on which the time-out of a run would stop the motor at each reply that is lost.
fn check_timeout(context: &JobContext<'_>, place: &str) -> Result<(), Failure> {
    let timeout = Duration::from_millis(RUN_STREAM_TIMEOUT_MS.into());
    let Some(needed) = context.needed_timeout().filter(|needed| *needed > timeout) else { return Ok(()) };
    let cause = CoreCauseMessage::LateForRun {
        rate: rate_of(context),
        timeout_ms: timeout.as_millis(),
        needed_ms: needed.as_millis(),
    };
    Err(Failure::new(CoreActMessage::Tune, place, cause, CoreRemedyMessage::QuickerLine))
}

/// The job before: keeps backup and journal, reads what is put back afterwards, and shortens the time-out. It moves nothing.
pub fn prepare(target: Target, subject: Subject, found: &Slot<Setup>, keeper: &TrialKeeper) -> Job<()> {
    let (found, keeper) = (Arc::clone(found), keeper.clone());
    Job::new(CoreActMessage::GetReady, PREPARE_LIMIT, move |context| {
        let place = context.describe();
        check_line(context, target, &place)?;
        let is_tried = |key: &str| Families::is_tried(target.motor, key);
        let held = begin_trial(context, subject, &is_tried, &mut **keeper.lock())?;
        let encoder = target.encoder.or_else(|| encoder(&|key| held.image.get(key), target.motor));
        let target = Target { encoder, ..target };
        let mut axis = Families::axis(context, target, true);
        let setup =
            thrice(|| axis.read_setup()).map_err(|error| failed(LoopActMessage::Read, &place, &error))?;
        put(&found, setup);
        if setup.stream_timeout_ms.is_some() {
            thrice(|| axis.set_stream_timeout(RUN_STREAM_TIMEOUT_MS))
                .map_err(|error| failed(LoopActMessage::SetTimeout, &place, &error))?;
            drop(axis);
            // By now all settings were read, so that this line has shown how late it is.
            check_timeout(context, &place)?;
        }
        Ok(())
    })
}

/// The run, with a trace in `live` for whoever looks on. It moves the motor, so it must be armed. The report is in its slot also after an
/// interruption.
pub fn run(target: Target, request: Request, found: &Slot<Report>, live: &Live) -> Job<()> {
    let (found, live) = (Arc::clone(found), live.clone());
    let limit = Duration::from_secs_f64(request.guard.time_limit_s) + GRACE;
    Job::moving(CoreActMessage::Tune, limit, move |context| {
        context.set_polling(false);
        // The time-out was set before: changing it now would undermine the arming.
        let mut axis = Families::axis(context, target, false);
        let report = tune_watched(&mut *axis, &request, &mut |entry| live.take(entry));
        put(&found, report);
        Ok(())
    })
}

/// Gains tried by themselves. It moves the motor, so it must be armed; what it found is in its slot also after an interruption.
pub fn trial(target: Target, wanted: TrialRequest, found: &Slot<Trial>, live: &Live) -> Job<()> {
    let (found, live) = (Arc::clone(found), live.clone());
    Job::moving(CoreActMessage::TryGains, TRIAL_LIMIT, move |context| {
        context.set_polling(false);
        let mut axis = Families::axis(context, target, false);
        let trial = run_trial(&mut *axis, &wanted, &mut |entry| live.take(entry));
        put(&found, trial);
        Ok(())
    })
}

/// Whether a run has left the loop of a Motion Mind off, since it found the machine to be such that a loop could drive the motor away.
pub fn leaves_off(report: Option<&Report>, trial: Option<&Trial>) -> bool {
    report.is_some_and(|report| report.causes.contains(&Cause::LoopOff))
        || trial.and_then(|trial| trial.cause).is_some_and(Cause::is_of_machine)
}

/// The job after: the old gains, unless the run's own stay, and the old time-out, proven by reading them; the journal is closed. It
/// moves nothing, and leaves a loop off where the run has for a reason.
pub fn restore(
    target: Target,
    before: Setup,
    report: Option<&Report>,
    leaves_off: bool,
    keeper: &TrialKeeper,
) -> Job<Restored> {
    let keeper = keeper.clone();
    let keeps = report.filter(|report| report.request.keep && report.verdict != Verdict::Refused);
    let kept = keeps.map(|report| report.proposed).unwrap_or_default();
    Job::new(CoreActMessage::PutBack, RESTORE_LIMIT, move |context| {
        let restored = Families::restore(context, target, &before, &kept, leaves_off)?;
        end_act(context, &mut **keeper.lock(), Ending::Known);
        Ok(restored)
    })
}
