//! A host that stands still for 0.1 to 0.9 s in mid-run, or reads nearly every reply late: whatever it sees then is no fault of the machine, and no refusal says so.

use brushwork_mcp_axis::{Carrier, McpLaw, PacketAxis, Timed};
use brushwork_mcp_sim::controller::Controller;
use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_mcp_wire::packet_serial::{Generation, Given, Typed, commands};
use brushwork_plant::world::WorldAction;
use brushwork_tuning::axis::{Axis as _, AxisError, EncoderClass};
use brushwork_tuning::cause::{Cause, Whose};
use brushwork_tuning::law::Law;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::{Method, Request, tune};
use brushwork_tuning_bench::line::{Bench as _, Event, SimulatedLine};
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::motion_mind::population::specimen as mind_specimen;
use brushwork_tuning_bench::run::request_of;
use brushwork_tuning_bench::unit::{UnderTest, Unit};
use brushwork_values::Motor;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::time::Duration;

/// How long the host stands still, ms.
const STALL_MS: (u64, u64) = (100, 900);
/// Runs of each family.
const RUNS: u64 = 36;
/// Plants of a seed that are taken in turn.
const PLANTS: usize = 12;
/// How often it stands still in a run, at the most, and until when in it, ms.
const MOST_STALLS: u64 = 4;
const LAST_MS: u64 = 9_000;

/// Stalls at moments of a run, the latest first.
fn stalls(draw: &mut ChaCha8Rng, from: Duration) -> Vec<(Duration, Duration)> {
    let mut between = |low: u64, high: u64| low + draw.next_u64() % (high - low);
    let count = 1 + between(0, MOST_STALLS);
    let mut stalls: Vec<(Duration, Duration)> = (0..count)
        .map(|_| {
            let at = from + Duration::from_millis(between(50, LAST_MS));
            (at, Duration::from_millis(between(STALL_MS.0, STALL_MS.1)))
        })
        .collect();
    stalls.sort_by_key(|stall| std::cmp::Reverse(stall.0));
    stalls
}

/// The first cause of a refusal, which may say that the computer was late, or that somebody set a limit, and nothing else.
#[track_caller]
fn assert_blames_no_machine<L: Law>(report: &Report<L>, case: &str) -> bool {
    if report.verdict != Verdict::Refused {
        return false;
    }
    let cause = report.causes.first().copied();
    let Some(cause @ Cause::AnsweredLate { longest_gap_ms, .. }) = cause else {
        panic!("{case}: {:?}", report.causes);
    };
    let sentence = cause.sentence();
    let is_named =
        sentence.contains("This computer answered late") && sentence.contains(&longest_gap_ms.to_string());
    assert!(is_named, "{case}: {sentence}");
    true
}

/// Without another try, which would hide what the first one concludes.
fn once<L: Law>(mut request: Request<L>) -> Request<L> {
    request.guard.late_tries = 0;
    request
}

/// Runs that did a stretch again end with gains but for a few, and none of them names the machine.
fn assert_done_again<L: Law>(reports: impl Iterator<Item = (Report<L>, String)>) {
    let refused = reports.filter(|(report, case)| assert_blames_no_machine(report, case)).count();
    assert!(20 * refused <= RUNS as usize, "{refused} of {RUNS}");
}

#[test]
fn a_stretch_that_came_late_is_done_again_by_itself_and_gives_gains() {
    assert_done_again((0..RUNS).map(|seed| {
        let plant = specimen(31, seed as usize % PLANTS);
        let method = [Method::Velocity, Method::Pd, Method::Piv][seed as usize % 3];
        let mut axis = Unit::axis(&plant);
        axis.carrier.stalls = stalls(&mut ChaCha8Rng::seed_from_u64(seed), Duration::from_millis(500));
        let report = tune(&mut axis, &request_of(&plant, method));
        assert!(report.replay().as_ref() == Some(&report), "seed {seed}: the replay differs");
        (report, format!("seed {seed}, {method:?}"))
    }));
    assert_done_again((0..RUNS).map(|seed| {
        let plant = mind_specimen(7, seed as usize % PLANTS);
        let method = [Method::Velocity, Method::Pd, Method::Pid][seed as usize % 3];
        let mut axis = Unit::axis(&plant);
        axis.carrier.line.stalls = stalls(&mut ChaCha8Rng::seed_from_u64(seed), Duration::from_millis(500));
        (tune(&mut axis, &request_of(&plant, method)), format!("Motion Mind, seed {seed}, {method:?}"))
    }));
}

#[test]
fn no_refusal_of_a_late_host_names_the_machine() {
    let mut refused = 0;
    for seed in 0..RUNS {
        let plant = specimen(31, seed as usize % PLANTS);
        let method = [Method::Velocity, Method::Pd, Method::Piv][seed as usize % 3];
        let mut axis = Unit::axis(&plant);
        let mut draw = ChaCha8Rng::seed_from_u64(seed);
        axis.carrier.stalls = stalls(&mut draw, Duration::from_millis(500));
        let case = format!("seed {seed}, {method:?}, stalls {:?}", axis.carrier.stalls);
        let report = tune(&mut axis, &once(request_of(&plant, method)));
        refused += usize::from(assert_blames_no_machine(&report, &case));
        assert!(report.replay().as_ref() == Some(&report), "{case}: the replay differs");
    }
    println!("{refused} of {RUNS} were refused");
    assert!(refused > 0, "a run in which nothing was late enough tests nothing");
}

/// Share of replies that are read late, and by how much at the most, s: three busy programs to each processor, which take turns of 4 ms.
const CROWDED: (f64, f64) = (0.9, 0.030);

#[test]
fn no_refusal_of_a_crowded_host_names_the_machine() {
    let mut refused = 0;
    for seed in 0..RUNS {
        let plant = specimen(31, seed as usize % PLANTS);
        let method = [Method::Velocity, Method::Pd, Method::Piv][seed as usize % 3];
        let mut axis = Unit::axis(&plant);
        axis.carrier.late_reads = Some(CROWDED);
        let case = format!("seed {seed}, {method:?}");
        let report = tune(&mut axis, &once(request_of(&plant, method)));
        refused += usize::from(assert_blames_no_machine(&report, &case));
    }
    println!("{refused} of {RUNS} were refused");
    assert!(refused > 0, "a run in which nothing was late enough tests nothing");
}

#[test]
fn no_refusal_of_a_late_host_names_the_machine_of_a_motion_mind() {
    let mut refused = 0;
    for seed in 0..RUNS {
        let plant = mind_specimen(7, seed as usize % PLANTS);
        let method = [Method::Velocity, Method::Pd, Method::Pid][seed as usize % 3];
        let mut axis = Unit::axis(&plant);
        let mut draw = ChaCha8Rng::seed_from_u64(seed);
        axis.carrier.line.stalls = stalls(&mut draw, Duration::from_millis(500));
        let case = format!("seed {seed}, {method:?}, stalls {:?}", axis.carrier.line.stalls);
        let report = tune(&mut axis, &once(request_of(&plant, method)));
        refused += usize::from(assert_blames_no_machine(&report, &case));
        assert!(report.replay().as_ref() == Some(&report), "{case}: the replay differs");
    }
    println!("{refused} of {RUNS} were refused");
    assert!(refused > 0, "a run in which nothing was late enough tests nothing");
}

/// A host that stands still while the line is timed, before the motor is driven: the line is not the slow one.
#[test]
fn a_host_that_stood_still_at_the_beginning_does_not_make_the_line_too_slow() {
    let plant = specimen(31, PLANT_OF_MOMENT[0]);
    let mut done = 0;
    for (at_ms, long_ms) in (500..640).step_by(5).zip((120..4_000).step_by(140)) {
        let mut axis = Unit::axis(&plant);
        axis.carrier.stalls = vec![(Duration::from_millis(at_ms), Duration::from_millis(long_ms))];
        axis.carrier.late_reads = Some((0.5, 0.02));
        let report = tune(&mut axis, &request_of(&plant, Method::Velocity));
        done += usize::from(!assert_blames_no_machine(&report, &format!("{long_ms} ms at {at_ms} ms")));
    }
    println!("{done} of 28 with gains");
    assert!(done >= 24, "{done} of 28 with gains");
}

/// Each reading of the line takes too long by itself, or the computer takes too long for each.
#[test]
fn a_slow_line_is_told_from_a_computer_that_is_late_for_each_reading() {
    let mut plant = specimen(31, PLANT_OF_MOMENT[0]);
    let mut late = Unit::axis(&plant);
    late.carrier.stalls =
        (0..400).rev().map(|n| (Duration::from_millis(500 + 130 * n), Duration::from_millis(125))).collect();
    let cause = tune(&mut late, &request_of(&plant, Method::Velocity)).causes.first().copied();
    assert!(matches!(cause, Some(Cause::AnsweredLate { whose: Whose::Computer, .. })), "{cause:?}");
    plant.link.latency_s = 0.025;
    let cause = tune(&mut Unit::axis(&plant), &request_of(&plant, Method::Velocity)).causes.first().copied();
    assert!(matches!(cause, Some(Cause::LineTooSlow { reading_ms: 101..250 })), "{cause:?}");
}

/// Moments at which the cable is pulled, or the line or the host stands still, ms after the unit was switched on.
const MOMENTS_MS: [u64; 6] = [1_200, 1_700, 2_300, 3_100, 4_400, 6_900];
/// The plants of these runs.
const PLANT_OF_MOMENT: [usize; 6] = [0, 1, 2, 4, 5, 7];
/// A stall that a radio or a computer with a full disk makes.
const STALL: Duration = Duration::from_millis(300);
/// A radio: the share of bytes that are on their way for longer, and by how much at the most, s. Some replies come after their time.
const JITTER: (f64, f64) = (0.9, 0.007);
/// How long after a pulled cable the motor may be driven (SAFETY.md), with the bench's own looks.
const OFF: Duration = Duration::from_millis(260);

/// What came of a run to which something happened at a moment.
struct Struck {
    report: Report<McpLaw>,
    at_ms: u64,
    case: String,
}

/// The run of each moment, without another try, on a line that `change` has changed.
fn at_moments(mut change: impl FnMut(&mut SimulatedLine<Controller>, Duration)) -> Vec<Struck> {
    let runs = MOMENTS_MS.into_iter().zip(PLANT_OF_MOMENT);
    let runs = runs.map(|(at_ms, number)| {
        let plant = specimen(31, number);
        let mut axis = Unit::axis(&plant);
        change(&mut axis.carrier, Duration::from_millis(at_ms));
        let report = tune(&mut axis, &once(request_of(&plant, Method::Velocity)));
        let case = format!("plant {number} at {at_ms} ms");
        assert!(report.replay().as_ref() == Some(&report), "{case}: the replay differs");
        if let Some(at) = axis.carrier.dead_at {
            assert!(axis.carrier.truth.last_driven <= at + OFF, "{case}: it is still driven");
        }
        Struck { report, at_ms, case }
    });
    runs.collect()
}

/// A run that came to the moment at which the cable was pulled says so; another ended before, since its answers were late.
fn assert_lost(runs: &[Struck]) {
    let mut lost = 0;
    for Struck { report, at_ms, case } in runs {
        let is_before = report.seconds.1 < 1e-3 * (*at_ms as f64) - 0.5;
        let cause = report.causes.first().copied();
        let is_late = is_before && matches!(cause, Some(Cause::AnsweredLate { .. }));
        assert_eq!(report.verdict, Verdict::Refused, "{case}");
        assert!(is_late || cause == Some(Cause::LinkLost), "{case}: {:?}", report.causes);
        lost += usize::from(cause == Some(Cause::LinkLost));
    }
    assert!(2 * lost >= runs.len(), "{lost} of {} runs were still going on", runs.len());
}

#[test]
fn a_cable_pulled_on_a_crowded_host_is_a_lost_link() {
    assert_lost(&at_moments(|line, at| (line.late_reads, line.dead_at) = (Some(CROWDED), Some(at))));
}

#[test]
fn a_cable_pulled_on_a_line_with_jitter_is_a_lost_link() {
    assert_lost(&at_moments(|line, at| (line.line_jitter, line.dead_at) = (Some(JITTER), Some(at))));
}

/// How many of the runs were refused; each of these for answers that came late by the fault of `whose`.
fn refused_for_late(runs: &[Struck], whose: Whose) -> usize {
    let refused = runs.iter().filter(|run| run.report.verdict == Verdict::Refused);
    refused
        .inspect(|run| {
            let cause = run.report.causes.first();
            let is_so = matches!(cause, Some(Cause::AnsweredLate { whose: said, .. }) if *said == whose);
            assert!(is_so, "{}: {:?}", run.case, run.report.causes);
        })
        .count()
}

#[test]
fn a_host_that_stood_still_is_told_from_a_line_that_did() {
    let by_host = at_moments(|line, at| line.stalls = vec![(at, STALL)]);
    let by_line = at_moments(|line, at| line.held_back = Some((at, STALL)));
    let refused = (refused_for_late(&by_host, Whose::Computer), refused_for_late(&by_line, Whose::Line));
    println!("{refused:?} of {} were refused", MOMENTS_MS.len());
    assert!(
        refused.0 > 0 && refused.1 > 0,
        "runs in which nothing was late enough test nothing: {refused:?}"
    );
}

#[test]
fn what_a_computer_took_before_a_run_is_not_held_against_it() {
    let plant = specimen(31, PLANT_OF_MOMENT[0]);
    let mut late = 0;
    for at_ms in (0..400).step_by(10) {
        let mut axis = Unit::axis(&plant);
        axis.carrier.stolen = Duration::from_secs(10);
        let from = axis.now() + Duration::from_millis(at_ms);
        axis.carrier.held_back = Some((from, STALL));
        let report = tune(&mut axis, &once(request_of(&plant, Method::Velocity)));
        for cause in &report.causes {
            if let Cause::AnsweredLate { whose, .. } | Cause::TakenLate { whose, .. } = *cause {
                assert_eq!(whose, Whose::Line, "at {at_ms} ms: {:?}", report.causes);
                late += 1;
            }
        }
    }
    println!("{late} runs were late");
    assert!(late > 0, "runs in which nothing was late enough test nothing");
}

#[test]
fn a_stretch_over_a_line_that_stood_still_is_done_again_and_gives_gains() {
    for (at_ms, number) in MOMENTS_MS.into_iter().zip(PLANT_OF_MOMENT) {
        let plant = specimen(31, number);
        let mut axis = Unit::axis(&plant);
        axis.carrier.held_back = Some((Duration::from_millis(at_ms), STALL));
        let report = tune(&mut axis, &request_of(&plant, Method::Velocity));
        assert_ne!(report.verdict, Verdict::Refused, "plant {number} at {at_ms} ms: {:?}", report.causes);
    }
}

/// A run that has no time left for another try keeps what it has, with a mark; so does one whose other try the limit cuts short.
#[test]
fn what_was_found_stays_where_the_time_limit_leaves_no_other_try() {
    let plant = specimen(31, 0);
    // The computer stands still shortly before the end of a try.
    let run = |limit_s: f64, tries_end_s: &[f64]| {
        let mut request = request_of(&plant, Method::Velocity);
        request.guard.time_limit_s = limit_s;
        let mut axis = <ControlLaw as Unit>::axis(&plant);
        let start = axis.now();
        let stall = |end_s: &f64| (start + Duration::from_secs_f64(end_s - 0.3), Duration::from_millis(150));
        axis.carrier.stalls = tries_end_s.iter().map(stall).collect();
        let report = tune(&mut axis, &request);
        println!("{limit_s:.2} s: {:?} {:?} {:?}", report.verdict, report.causes, report.seconds);
        assert!(report.replay().as_ref() == Some(&report), "{limit_s:.2} s: the replay differs");
        report
    };
    let is_marked = |report: &Report<McpLaw>| {
        let is_late = |cause: &Cause| matches!(cause, Cause::TakenLate { .. });
        report.verdict == Verdict::TunedWithWarnings && report.causes.iter().any(is_late)
    };
    let (identified_s, quiet_s) = run(180.0, &[]).seconds;
    let late = run(1.2 * quiet_s, &[quiet_s]);
    assert!(is_marked(&late), "{:?}", late.causes);
    // Another try of the same length is begun within the limit or not, and ends within it or not, by a few milliseconds.
    let as_long_s = 2.0 * late.seconds.1 - identified_s;
    let limits_s = (0..20).map(|n| as_long_s + 0.005 * f64::from(n));
    let mut runs = limits_s.map(|limit_s| (limit_s, run(limit_s, &[limit_s, quiet_s])));
    let cut = runs.find(|(limit_s, report)| report.seconds.1 > *limit_s);
    let (_, cut) = cut.expect("another try that is begun and cut short");
    assert!(is_marked(&cut), "{:?}", cut.causes);
    assert_eq!(cut.proposed, late.proposed, "what the first try found");
}

/// A fault that comes after a late gap is seen in a stretch that is done again for the gap's sake. What the second try tells, in time, is the machine's.
#[test]
fn a_fault_that_a_timely_second_try_shows_again_is_named() {
    let faults = [
        (WorldAction::ReverseEncoder { motor: Motor::M1, on: true }, Cause::EncoderFlipped),
        (WorldAction::LoseEncoder { motor: Motor::M1, on: true }, Cause::EncoderLost),
        (WorldAction::LockShaft { motor: Motor::M1, on: true }, Cause::Stalled),
        (WorldAction::OpenLead { motor: Motor::M1, on: true }, Cause::MotorOpened),
    ];
    let (mut named, mut runs) = (0, 0);
    for number in 0..PLANTS {
        let plant = specimen(31, number);
        let whole = tune(&mut Unit::axis(&plant), &request_of(&plant, Method::Velocity));
        let (before_s, whole_s) = whole.seconds;
        for (action, cause) in &faults {
            let mut axis = Unit::axis(&plant);
            let start = axis.carrier.unit().time();
            let after = |seconds: f64| start + Duration::from_secs_f64(seconds);
            let trial_s = whole_s - before_s;
            axis.carrier.stalls = vec![(after(before_s + 0.2 * trial_s), Duration::from_millis(120))];
            axis.carrier
                .schedule(vec![Event { at: after(before_s + 0.6 * trial_s), action: action.clone() }]);
            let report = tune(&mut axis, &request_of(&plant, Method::Velocity));
            assert!(
                report.replay().as_ref() == Some(&report),
                "plant {number}, {cause:?}: the replay differs"
            );
            assert_eq!(report.verdict, Verdict::Refused, "plant {number}, {cause:?}");
            named += usize::from(report.causes.first() == Some(cause));
            runs += 1;
        }
    }
    println!("{named} of {runs} named");
    assert!(5 * named >= 4 * runs, "{named} of {runs}");
}

/// A line to a controller, of a run that computes for so long each time that it has stopped a motor which followed a speed: a fit of many records on a small computer.
struct Computing {
    line: SimulatedLine<Controller>,
    computes: Duration,
    has_speed: bool,
    has_stopped: bool,
}

impl Carrier for Computing {
    fn transact<const L: u8>(&mut self, command: Typed<L>, given: &[Given<L>]) -> Timed<L> {
        let is_stop = command.number() == commands::DUTY_ACCEL_M1.number();
        self.has_stopped = is_stop && std::mem::take(&mut self.has_speed);
        self.has_speed |= command.number() == commands::SPEED_M1.number();
        self.line.transact(command, given)
    }

    fn now(&mut self) -> Duration {
        if std::mem::take(&mut self.has_stopped) {
            self.line.idle(self.computes);
        }
        self.line.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.line.wait_until(time)
    }

    fn generation(&self) -> Generation {
        self.line.generation()
    }

    fn stream(&self) -> Option<usize> {
        self.line.stream()
    }

    fn is_simulated(&self) -> bool {
        self.line.is_simulated()
    }
}

#[test]
fn what_a_run_computes_while_the_motor_is_off_is_not_called_late() {
    for number in 0..PLANTS {
        let plant = specimen(31, number);
        let line = <ControlLaw as Unit>::axis(&plant).carrier;
        let carrier =
            Computing { line, computes: Duration::from_millis(300), has_speed: false, has_stopped: false };
        let mut axis = PacketAxis::new(carrier, Motor::M1, EncoderClass::Quadrature);
        let report = tune(&mut axis, &request_of(&plant, Method::Velocity));
        let late = report
            .causes
            .iter()
            .find(|cause| matches!(cause, Cause::AnsweredLate { .. } | Cause::TakenLate { .. }));
        assert_eq!(late, None, "plant {number}");
    }
}

/// Plants behind a slow line.
const SLOW_PLANTS: usize = 16;

/// On such a line the check of the wiring sees the first motion late: the identification begins when the motor stands again.
#[test]
fn friction_and_gain_of_a_slow_line_lie_in_their_intervals() {
    let (mut frictions, mut gains) = (0, 0);
    for number in 0..SLOW_PLANTS {
        let mut plant = specimen(31, number);
        plant.link.latency_s = 0.007;
        let truth = UnderTest::new(plant.clone()).truth;
        let report = tune(&mut Unit::axis(&plant), &request_of(&plant, Method::Velocity));
        let Some(fit) = report.fit else { continue };
        let friction = fit.model.coulomb_duty - truth.coulomb_duty;
        let gain = (fit.model.gain_counts_per_s / truth.gain_counts_per_s).ln();
        println!(
            "plant {number} {:?}: friction {friction:.4} and gain {gain:.4} off, deviations {:.4} and {:.4}",
            plant.kind, fit.sd_coulomb, fit.sd_ln_gain
        );
        frictions += usize::from(friction.abs() <= 2.0 * fit.sd_coulomb);
        gains += usize::from(gain.abs() <= 2.0 * fit.sd_ln_gain);
    }
    // Begun while the motor still turned it is 13 and 13.
    assert!(frictions >= 15 && gains >= 15, "friction of {frictions} and gain of {gains} of {SLOW_PLANTS}");
}
