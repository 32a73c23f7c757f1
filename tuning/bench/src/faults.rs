//! Faults put into the machine before or during a run: is the motor off in time, and is the fault named right?

use crate::line::{Bench as _, Event};
use crate::population::{Draw, Kind, Specimen};
use crate::quantile::quantile;
use crate::run::request_of;
use crate::truth::Truth;
use crate::unit::{Report, Request, Unit};
use brushwork_plant::world::WorldAction;
use brushwork_plant::{StopKind, TravelParams};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::law::Law;
use brushwork_tuning::report::{self, Verdict};
use brushwork_tuning::tune::{Excitation, Method, tune};
use brushwork_values::Motor;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Duration;

/// The row of runs without a fault.
const HEALTHY: &str = "healthy";
/// Healthy runs that must raise no alarm, for every two plants: 500 with 200.
const HEALTHY_RUNS: usize = 5;
/// How finely the bench looks at the bridge, with some rounding, s.
const LOOK_S: f64 = 0.01;
/// Where in the identification a fault strikes, as shares of its length.
const STRIKES: (f64, f64) = (0.05, 0.80);

/// One class of faults over all plants.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultRow {
    /// Its name.
    pub fault: &'static str,
    /// How many runs.
    pub plants: usize,
    /// Motor off within the deadline, %; in mid-run and in trials each drive by itself.
    pub off_in_time: f64,
    /// Named right, %.
    pub named: f64,
    /// From the fault, or from when the motor was next driven, to the motor off, median, s.
    pub off_median_s: f64,
    /// The longest, s.
    pub off_max_s: f64,
    /// The deadline, s.
    pub deadline_s: f64,
    /// Highest current over the stall current, %; the largest.
    pub peak_current_max: f64,
    /// What the runs ended with, and how many of them.
    pub causes: BTreeMap<String, usize>,
    /// The runs that were late or were named otherwise.
    pub misses: Vec<Miss>,
}

/// A run that was late or was named otherwise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Miss {
    /// The plant's number.
    pub plant: usize,
    /// The plant's kind.
    pub kind: Kind,
    /// When the fault struck, s from the start of the run.
    pub at_s: f64,
    /// From the fault, or from when the motor was next driven, to the motor off, s.
    pub off_s: f64,
    /// What the run ended with.
    pub cause: Option<Cause>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    Before(WorldChange),
    During(WorldChange),
    /// While a loop has the motor.
    InTrial(WorldChange),
    LinkDrop,
    EndStop,
    Window,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum WorldChange {
    ReverseEncoder,
    LoseEncoder,
    OpenLead,
    LockShaft,
    LowBattery,
}

impl WorldChange {
    fn action<U>(self, specimen: &Specimen<U>) -> WorldAction {
        let motor = Motor::M1;
        match self {
            Self::ReverseEncoder => WorldAction::ReverseEncoder { motor, on: true },
            Self::LoseEncoder => WorldAction::LoseEncoder { motor, on: true },
            Self::OpenLead => WorldAction::OpenLead { motor, on: true },
            Self::LockShaft => WorldAction::LockShaft { motor, on: true },
            Self::LowBattery => WorldAction::SetBatteryVolts { volts: 0.55 * specimen.volts() },
        }
    }
}

struct Class {
    name: &'static str,
    fault: Fault,
    causes: &'static [Cause],
    deadline_s: f64,
}

const CLASSES: [Class; 16] = [
    class("encoder_reversed", Fault::Before(WorldChange::ReverseEncoder), &[Cause::EncoderReversed], 1.0),
    class("encoder_dead", Fault::Before(WorldChange::LoseEncoder), &[Cause::EncoderDead], 1.5),
    class("motor_open", Fault::Before(WorldChange::OpenLead), &[Cause::MotorOpen], 1.5),
    class("shaft_locked", Fault::Before(WorldChange::LockShaft), &[Cause::ShaftLocked], 1.5),
    class("encoder_lost", Fault::During(WorldChange::LoseEncoder), &[Cause::EncoderLost], 0.3),
    class("stall", Fault::During(WorldChange::LockShaft), &[Cause::Stalled], 0.3),
    class("motor_opened", Fault::During(WorldChange::OpenLead), &[Cause::MotorOpened], 0.5),
    class("encoder_flipped", Fault::During(WorldChange::ReverseEncoder), &[Cause::EncoderFlipped], 0.3),
    class("battery_low", Fault::During(WorldChange::LowBattery), &[Cause::BatteryLow], 0.1),
    class("link_drop", Fault::LinkDrop, &[Cause::LinkLost], 0.25),
    class("end_stop", Fault::EndStop, &[Cause::Stalled], 0.3),
    class("encoder_lost_in_trial", Fault::InTrial(WorldChange::LoseEncoder), &[Cause::EncoderLost], 0.3),
    class("stall_in_trial", Fault::InTrial(WorldChange::LockShaft), &[Cause::Stalled], 0.3),
    class("motor_opened_in_trial", Fault::InTrial(WorldChange::OpenLead), &[Cause::MotorOpened], 0.5),
    class(
        "encoder_flipped_in_trial",
        Fault::InTrial(WorldChange::ReverseEncoder),
        &[Cause::EncoderFlipped],
        0.3,
    ),
    // Off before the window's end is crossed; the deadline does not apply.
    class("travel_window", Fault::Window, &[], 0.0),
];

const fn class(name: &'static str, fault: Fault, causes: &'static [Cause], deadline_s: f64) -> Class {
    Class { name, fault, causes, deadline_s }
}

struct Run {
    plant: (usize, Kind),
    at_s: f64,
    off_s: f64,
    in_time: bool,
    named: bool,
    peak: f64,
    cause: Option<Cause>,
}

/// A plant, what it is, and how long its identification takes.
struct Subject<U: Unit> {
    specimen: Specimen<U>,
    truth: Truth<U::Law>,
    /// Length of the identification, and of whole runs by method, s.
    span_s: f64,
    whole_s: [f64; 2],
}

impl<U: Unit> Subject<U> {
    fn new(specimen: &Specimen<U>) -> Self {
        let whole = |method| tune(&mut U::axis(specimen), &request_of(specimen, method)).seconds.1;
        Self {
            span_s: healthy(specimen, 0, None).0.seconds.0,
            whole_s: U::WHOLE.map(whole),
            truth: U::truth(specimen),
            specimen: specimen.clone(),
        }
    }
}

/// Every class on every plant, and the healthy runs as the last row, whose `named` is the share without alarm.
#[must_use]
pub fn fault_rows<U: Unit>(plants: &[Specimen<U>]) -> Vec<FaultRow> {
    rows_of(plants, &[])
}

/// The same of the classes named only; all of them where none is.
#[must_use]
pub fn rows_of<U: Unit>(plants: &[Specimen<U>], names: &[&str]) -> Vec<FaultRow> {
    let wanted = |name: &str| names.is_empty() || names.contains(&name);
    let can_be = |class: &&Class| U::REPORTS_VOLTS || class.fault != Fault::During(WorldChange::LowBattery);
    let subjects: Vec<Subject<U>> = plants.par_iter().map(Subject::new).collect();
    let classes = CLASSES.iter().filter(|class| wanted(class.name)).filter(can_be);
    let mut rows: Vec<FaultRow> = classes
        .map(|class| {
            let able = subjects.par_iter().filter(|subject| subject.span_s > 0.0);
            let deadline_s = class.deadline_s::<U>();
            let runs: Vec<Run> = able.map(|subject| run(class, subject)).collect();
            summary(class.name, deadline_s, &runs)
        })
        .collect();
    if wanted(HEALTHY) && !subjects.is_empty() {
        let quiet: Vec<Run> = (0..HEALTHY_RUNS * subjects.len().div_ceil(2))
            .into_par_iter()
            .map(|n| {
                let subject = &subjects[n % subjects.len()];
                let method = healthy_method::<U>(n / subjects.len() + n);
                let (report, mut axis) = healthy(&subject.specimen, n as u64, method);
                Run::quiet(subject, &mut axis, &report, true)
            })
            .collect();
        rows.push(summary(HEALTHY, 0.0, &quiet));
    }
    rows
}

/// Whether a report blames the machine.
#[must_use]
pub fn is_alarm<L: Law>(report: &report::Report<L>) -> bool {
    const ALARMS: [Cause; 11] = [
        Cause::EncoderReversed,
        Cause::EncoderDead,
        Cause::MotorOpen,
        Cause::ShaftLocked,
        Cause::EncoderLost,
        Cause::Stalled,
        Cause::MotorOpened,
        Cause::EncoderFlipped,
        Cause::BatteryLow,
        Cause::LinkLost,
        Cause::ControllerFault,
    ];
    report.verdict == Verdict::Refused && report.causes.first().is_some_and(|cause| ALARMS.contains(cause))
}

fn identification_only<U: Unit>(specimen: &Specimen<U>) -> Request<U> {
    Request::<U> { verify: false, ..request_of(specimen, Method::Velocity) }
}

/// Every third run is an identification alone.
fn healthy_method<U: Unit>(n: usize) -> Option<Method> {
    U::WHOLE.get(n % 3).copied()
}

fn healthy<U: Unit>(specimen: &Specimen<U>, round: u64, method: Option<Method>) -> (Report<U>, U::Axis) {
    let mut specimen = specimen.clone();
    let link = &mut specimen.link;
    link.seed = link.seed.wrapping_add(round.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let mut axis = U::axis(&specimen);
    let request =
        method.map_or_else(|| identification_only(&specimen), |method| request_of(&specimen, method));
    let report = tune(&mut axis, &request);
    (report, axis)
}

fn peak<U: Unit>(axis: &mut U::Axis, subject: &Subject<U>) -> f64 {
    let plant = &subject.specimen;
    100.0 * U::line(axis).truth.peak_amps / plant.axis.stall_amps(plant.volts())
}

fn run<U: Unit>(class: &Class, subject: &Subject<U>) -> Run {
    let (specimen, span_s) = (&subject.specimen, subject.span_s);
    let name_seed = class.name.bytes().map(u64::from).sum::<u64>();
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(specimen.link.seed ^ name_seed));
    // The probe takes most of the first second; faults of the run strike after it.
    let probe_s: f64 = 0.12 + 0.06 * 14.0;
    let nth = specimen.number % U::WHOLE.len();
    let (request, strike_s) = match class.fault {
        Fault::InTrial(_) => {
            let trial_s = (subject.whole_s[nth] - span_s).max(0.1);
            (request_of(specimen, U::WHOLE[nth]), span_s + draw.between(STRIKES) * trial_s)
        }
        Fault::Before(_) | Fault::During(_) | Fault::LinkDrop | Fault::EndStop | Fault::Window => {
            let strike_s = probe_s.min(0.5 * span_s) + draw.between(STRIKES) * (span_s - probe_s).max(0.3);
            (identification_only(specimen), strike_s)
        }
    };
    let mut axis = match class.fault {
        Fault::EndStop => U::axis(&with_end_stops(subject)),
        Fault::Before(_) | Fault::During(_) | Fault::InTrial(_) | Fault::LinkDrop | Fault::Window => {
            U::axis(&subject.specimen)
        }
    };
    let line = U::line(&mut axis);
    let start = line.unit().time();
    let strike = start + Duration::from_secs_f64(strike_s);
    let mut from = strike;
    match class.fault {
        Fault::Before(change) => {
            from = start;
            line.schedule(vec![Event { at: start, action: change.action(specimen) }]);
        }
        Fault::During(change) | Fault::InTrial(change) => {
            line.schedule(vec![Event { at: strike, action: change.action(specimen) }]);
        }
        Fault::LinkDrop => line.dead_at = Some(strike),
        Fault::EndStop => line.end_stop_radians = Some(end_stop_radians(subject)),
        Fault::Window => {}
    }
    if class.fault == Fault::Window {
        return run_in_window(subject, axis);
    }
    let report = tune(&mut axis, &request);
    let deadline_s = class.deadline_s::<U>();
    U::line(&mut axis).idle(Duration::from_millis(300).max(Duration::from_secs_f64(2.0 * deadline_s)));
    let seen = U::line(&mut axis).truth;
    if class.fault == Fault::EndStop {
        let Some(hit) = seen.stop_hit_at else {
            // It never came that far: nothing happened, nothing to name.
            return Run::quiet(subject, &mut axis, &report, true);
        };
        from = hit;
    }
    // A run that lost replies is begun anew, and sees the fault once more: each drive has the deadline for itself.
    let off_s = match class.fault {
        Fault::During(_) => seen.drive.longest,
        Fault::InTrial(_) => seen.clear_drive.longest,
        Fault::Before(_) | Fault::LinkDrop | Fault::EndStop | Fault::Window => {
            seen.last_driven.saturating_sub(from)
        }
    };
    let off_s = off_s.as_secs_f64();
    let named = report.causes.first().is_some_and(|cause| class.causes.contains(cause));
    Run {
        plant: (specimen.number, specimen.kind),
        at_s: from.saturating_sub(start).as_secs_f64(),
        off_s,
        in_time: off_s <= deadline_s + LOOK_S,
        named,
        peak: peak(&mut axis, subject),
        cause: first(&report),
    }
}

impl Class {
    fn deadline_s<U: Unit>(&self) -> f64 {
        if self.fault == Fault::LinkDrop { U::LINK_DEADLINE_S } else { self.deadline_s }
    }
}

impl Run {
    /// A run in which nothing happened: any alarm is a false one.
    fn quiet<U: Unit>(subject: &Subject<U>, axis: &mut U::Axis, report: &Report<U>, in_time: bool) -> Self {
        let plant = &subject.specimen;
        Self {
            plant: (plant.number, plant.kind),
            at_s: 0.0,
            off_s: 0.0,
            in_time,
            named: !is_alarm(report),
            peak: peak(axis, subject),
            cause: first(report),
        }
    }
}

/// A window half as wide as the identification is judged with: it is used, or refused, but never crossed.
fn run_in_window<U: Unit>(subject: &Subject<U>, mut axis: U::Axis) -> Run {
    let width = (0.1 * subject.truth.qpps).round().max(40.0);
    let half = (0.5 * width) as i64;
    let mut request =
        Request::<U> { excitation: Excitation::Window(width), ..identification_only(&subject.specimen) };
    request.method = Method::Pd;
    request.guard.travel = Some((-half, half));
    let report = tune(&mut axis, &request);
    let per_radian = subject.specimen.axis.counts_per_motor_radian();
    let reach = U::line(&mut axis).truth.farthest_radians * per_radian;
    // Half a count of rounding on either side.
    let kept = reach <= half as f64 + 1.0;
    Run::quiet(subject, &mut axis, &report, kept)
}

/// End stops a quarter of a second of full speed away.
fn end_stop_radians<U: Unit>(subject: &Subject<U>) -> f64 {
    let seconds = 0.25 + subject.truth.tau_s;
    let axis = &subject.specimen.axis;
    seconds * subject.truth.qpps / axis.counts_per_motor_radian() / axis.gear.ratio
}

fn with_end_stops<U: Unit>(subject: &Subject<U>) -> Specimen<U> {
    let mut specimen = subject.specimen.clone();
    let stop = end_stop_radians(subject);
    specimen.axis.load.travel =
        Some(TravelParams { lower_radians: -stop, upper_radians: stop, stop: StopKind::Hard });
    specimen
}

fn first<L: Law>(report: &report::Report<L>) -> Option<Cause> {
    (report.verdict == Verdict::Refused).then(|| report.causes.first().copied()).flatten()
}

fn summary(fault: &'static str, deadline_s: f64, runs: &[Run]) -> FaultRow {
    let percent = |of: fn(&Run) -> bool| {
        let share = runs.iter().filter(|run| of(run)).count() as f64 / runs.len().max(1) as f64;
        (1000.0 * share).round() / 10.0
    };
    let mut causes = BTreeMap::new();
    for run in runs {
        let name = run.cause.map_or_else(|| "none".to_owned(), |cause| format!("{cause:?}"));
        *causes.entry(name).or_insert(0) += 1;
    }
    let milli = |value: f64| (1000.0 * value).round() / 1000.0;
    let misses = runs.iter().filter(|run| !(run.in_time && run.named)).map(|run| Miss {
        plant: run.plant.0,
        kind: run.plant.1,
        at_s: milli(run.at_s),
        off_s: milli(run.off_s),
        cause: run.cause,
    });
    FaultRow {
        fault,
        plants: runs.len(),
        off_in_time: percent(|run| run.in_time),
        named: percent(|run| run.named),
        off_median_s: milli(quantile(runs.iter().map(|run| run.off_s), 0.5)),
        off_max_s: milli(runs.iter().map(|run| run.off_s).fold(0.0, f64::max)),
        deadline_s,
        peak_current_max: milli(runs.iter().map(|run| run.peak).fold(0.0, f64::max)),
        causes,
        misses: misses.collect(),
    }
}
