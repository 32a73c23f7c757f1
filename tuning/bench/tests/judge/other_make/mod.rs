//! The tuner on a controller and motors that share no code with the simulators of this program: what it says of its gains is checked by
//! figures worked out here.

mod controller;
mod machine;

use brushwork_mcp_axis::McpLaw;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::law::Windup;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::{Method, Request, tune};
use controller::{Controller, Fault, LawOptions, NOISE_AMPS, sensitivity};
use machine::{Draw, Motor};
use std::time::Duration;

/// A motor and a law of a seed, how often it is polled, and the noise of its currents.
struct Drawn {
    motor: Motor,
    law: LawOptions,
    poll_s: f64,
    noise_amps: f64,
    draw: Draw,
}

fn drawn(seed: u64, number: usize) -> Drawn {
    let mut draw = Draw::new(seed, number as u64);
    let motor = Motor::drawn(&mut draw, number);
    let mut position = Draw::new(seed ^ 0x5555, number as u64);
    let law = LawOptions {
        rate_hz: draw.one_of(&[200.0, 300.0, 500.0, 625.0, 1_000.0]),
        per_tick: draw.uniform() < 0.5,
        feed_forward: draw.one_of(&[1.0, 1.0, 0.5, 0.0]),
        proportional: draw.one_of(&[1.0, 1.0, 4.0]),
        filter_s: draw.one_of(&[0.0, 0.0, 0.004, 0.010]),
        late_ticks: draw.one_of(&[0, 1]),
        position_scale: position.one_of(&[1_024.0, 1_024.0, 2_048.0, 700.0]),
        filters_derivative: position.uniform() < 0.5,
    };
    let poll_s = draw.log(0.010, 0.020);
    Drawn { motor, law, poll_s, noise_amps: NOISE_AMPS, draw }
}

/// A run, and what its gains really are.
struct Run {
    law: LawOptions,
    /// Filter, late ticks and winding together, s.
    lag_s: f64,
    report: Report<McpLaw>,
    /// The sensitivity of the loop as it is; `None` where it is unstable, or there are no gains.
    ms: Option<f64>,
    line: String,
}

impl Run {
    fn of(seed: u64, number: usize, change: impl Fn(&mut Drawn)) -> Self {
        Self::with(seed, number, Method::Velocity, change)
    }

    fn with(seed: u64, number: usize, method: Method, change: impl Fn(&mut Drawn)) -> Self {
        let mut all = drawn(seed, number);
        change(&mut all);
        let Drawn { motor, law, poll_s, noise_amps, draw } = all;
        let mut unit = Controller::new(motor, law, draw);
        unit.noise_amps = noise_amps;
        let guard = GuardOptions { poll_s, ..GuardOptions::default() };
        let report = tune(&mut unit, &Request::<McpLaw> { guard, method, ..Request::default() });
        let ms = report
            .proposed
            .velocity
            .and_then(|registers| sensitivity(&motor, &law, &registers, report.proposed.position.as_ref()));
        let tick_s = 1.0 / f64::from(report.request.law.rate_hz);
        let lag_ms = report.lag.map(|lag| 1e3 * lag.lag.total_s(tick_s));
        let lag_s = law.lag_s() + motor.henries / motor.ohms;
        let line = format!(
            "{method:?} {number} {} {law:?}: {:?} {:?}, Ms {ms:.2?} (said {:.2?}), lag {lag_ms:.1?} of {:.1} ms, {:?}",
            motor.kind,
            report.verdict,
            report.causes,
            report.design.map(|design| design.ms),
            1e3 * lag_s,
            report.request.law,
        );
        Self { law, lag_s, report, ms, line }
    }
}

fn near(found: f64, known: f64) -> bool {
    (found / known - 1.0).abs() < 0.04
}

/// Seed 77 was not looked at while the tuner was changed; 41 to 43 were.
#[test]
fn the_law_of_another_make_is_measured_whatever_it_is_and_its_loop_is_stable() {
    let (mut refused, mut unknown) = (0, 0);
    for number in 0..24 {
        let run = Run::of(77, number, |_| {});
        println!("{}", run.line);
        if run.report.verdict == Verdict::Refused {
            refused += 1;
            continue;
        }
        let (law, known, case) = (run.report.request.law, run.law, &run.line);
        let of_motor = |rate: f64| if run.law.per_tick { rate } else { 1.0 };
        let is_unknown = run.report.causes.contains(&Cause::RateUnknown);
        unknown += usize::from(is_unknown);
        assert!(is_unknown || near(f64::from(law.rate_hz), known.rate_hz), "{case}");
        assert!((law.feed_forward - known.feed_forward).abs() < 0.04, "{case}");
        assert!(near(65_536.0 / law.velocity_scale, known.proportional), "{case}");
        let sums = if law.per_tick { f64::from(law.rate_hz) } else { 1.0 };
        assert!(near(sums * 65_536.0 / law.integral_scale, of_motor(known.rate_hz)), "{case}");
        assert!(run.ms.is_some(), "stable: {case}");
    }
    assert!(refused <= 2 && unknown <= 2, "{refused} of 24 refused, {unknown} of unknown rate");
}

/// Seed 78 was not looked at before this test. Every second loop or so of seed 41 that was called tuned in spite of a true Ms above 1.8 is
/// here, too: 222 has one of 3.9, and raising its gain passed since the rounding of the encoder was taken to be louder than any oscillation.
#[test]
fn what_is_tuned_without_a_warning_has_the_margin_that_it_should() {
    let usual = |all: &mut Drawn| {
        let law = &mut all.law;
        *law = LawOptions { rate_hz: 300.0, per_tick: true, feed_forward: 1.0, proportional: 1.0, ..*law };
    };
    let runs = (0..24).map(|number| Run::of(78, number, |_| {}));
    let known = [2, 6, 86, 104, 168, 222].map(|number| Run::of(41, number, usual));
    let (mut tuned, mut above) = (0, 0);
    for run in runs.chain(known) {
        println!("{}", run.line);
        above += usize::from(run.ms.is_some_and(|ms| ms > 1.8));
        if run.report.verdict == Verdict::Tuned {
            tuned += 1;
            assert!(run.ms.is_some_and(|ms| ms <= 1.8), "{}", run.line);
        }
    }
    println!("{tuned} tuned without a warning, {above} above 1.8 with one");
    assert!(tuned >= 8, "a warning on every run says nothing: {tuned} without one");
}

/// Ten times the noise of the currents; three times the stiction, the cogs, the uneven edges; both. Before the current of a motor was held against the voltage that
/// its speed makes, 2 of 100 motors without any of it were called open or stalled, and 7 of 100 with a noisy sensor. Seed 606 was not looked at before.
#[test]
fn no_healthy_motor_is_blamed_whatever_its_sensor_its_cogs_and_its_edges_are_like() {
    for (noise, roughness) in [(10.0, 1.0), (1.0, 3.0), (5.0, 3.0)] {
        for number in 0..12 {
            let run = Run::of(606, number, |all| {
                all.noise_amps *= noise;
                all.motor.stiction *= roughness;
                all.motor.cogging *= roughness;
                all.motor.uneven = (all.motor.uneven * roughness).min(0.45);
                all.motor.supply_ohms *= roughness.sqrt();
                all.poll_s *= roughness.sqrt();
            });
            println!("{noise} {roughness} {}", run.line);
            assert_ne!(run.report.verdict, Verdict::Refused, "{noise} {roughness} {}", run.line);
            let promised = run.report.verdict != Verdict::Tuned || run.ms.is_some_and(|ms| ms <= 1.8);
            assert!(promised, "{noise} {roughness} {}", run.line);
        }
    }
}

/// Wherever the run is, but for the probe at its beginning. Seed 79.
#[test]
fn a_reset_in_mid_run_is_named_and_nothing_is_called_tuned() {
    let (mut named, mut runs) = (0, 0);
    for number in 0..12 {
        for at_s in [2.7, 3.9, 5.3] {
            let Drawn { motor, law, poll_s, draw, .. } = drawn(79, number);
            let mut unit = Controller::new(motor, law, draw);
            unit.reset_at = Some(Duration::from_secs_f64(at_s));
            let guard = GuardOptions { poll_s, ..GuardOptions::default() };
            let report = tune(&mut unit, &Request::<McpLaw> { guard, ..Request::default() });
            if report.seconds.1 < at_s - 0.7 {
                continue;
            }
            let case =
                format!("{number} {} at {at_s} s: {:?} {:?}", motor.kind, report.verdict, report.causes);
            println!("{case}");
            runs += 1;
            named += usize::from(report.causes.first() == Some(&Cause::WasReset));
            assert_eq!(report.verdict, Verdict::Refused, "{case}");
        }
    }
    println!("{named} of {runs} named");
    assert!(10 * named >= 9 * runs, "{named} of {runs} named");
}

/// How often an interval holds the truth, and how wide it is.
#[derive(Default)]
struct Interval {
    name: &'static str,
    inside: usize,
    widths: Vec<f64>,
}

impl Interval {
    fn new(name: &'static str) -> Self {
        Self { name, ..Self::default() }
    }

    fn see(&mut self, (low, high): (f64, f64), truth: f64) {
        self.inside += usize::from(low <= truth && truth <= high);
        self.widths.push(high - low);
    }

    /// Share of the runs that hold the truth, and the median width.
    fn figures(&mut self) -> (f64, f64) {
        self.widths.sort_by(f64::total_cmp);
        let n = self.widths.len();
        (self.inside as f64 / n as f64, self.widths[n / 2])
    }
}

/// Intervals of two standard deviations of gain and time constant, and the interval of the lag: filter, late ticks and winding. Seeds 601 and 602 showed
/// that the interval of the time constant was too narrow; 603 was not looked at before.
#[test]
fn intervals_of_another_make_hold_the_truth_and_are_not_absurdly_wide() {
    let mut all = ["gain, ln", "time constant, ln", "lag, ms"].map(Interval::new);
    for (seed, number) in [602, 603].into_iter().flat_map(|seed| (0..30).map(move |number| (seed, number))) {
        let Drawn { motor, law, .. } = drawn(seed, number);
        let run = Run::of(seed, number, |_| {});
        let (Some(fit), Some(lag)) = (run.report.fit, run.report.lag) else { continue };
        let about = |middle: f64, sd: f64| (middle.ln() - 2.0 * sd, middle.ln() + 2.0 * sd);
        all[0].see(about(fit.model.gain_counts_per_s, fit.sd_ln_gain), motor.gain().ln());
        let tau = fit.time_constant();
        all[1].see(about(tau.seconds, tau.sd_ln), motor.tau_s().ln());
        let lag_ms = 1e3 * (law.lag_s() + motor.henries / motor.ohms);
        all[2].see((1e3 * lag.interval_s.0, 1e3 * lag.interval_s.1), lag_ms);
    }
    for (interval, widest) in all.iter_mut().zip([0.05, 0.15, 7.0]) {
        let (share, width) = interval.figures();
        println!("{}: {:.1} % hold the truth, {width:.3} wide", interval.name, 100.0 * share);
        assert!(interval.widths.len() >= 50, "{}: {} runs", interval.name, interval.widths.len());
        assert!(share >= 0.9, "{}: {share}", interval.name);
        assert!(width <= widest, "{}: {width}", interval.name);
    }
}

/// The seed of the position loops and how many motors of it are tuned, with others by `OTHER_MAKE_LOOPS="1004 120"`. Of 1001 to 1003 motors were looked at while the tuner was
/// changed, and those of which much was wrong are here by name; of 1006 nothing but its faults was.
fn loops() -> (u64, usize) {
    let words = std::env::var("OTHER_MAKE_LOOPS").unwrap_or_else(|_| "1006 18".to_owned());
    let (seed, motors) = words.split_once(' ').expect("a seed and a number of motors");
    (seed.parse().expect("a seed"), motors.parse().expect("a number of motors"))
}

/// A derivative that sees a filtered speed was taken to see whole counts where the cogs of a quick motor made its duty rough (true Ms up to 3.7), and gains on the speed were too
/// high where the loop takes its sum before the present error is added to it (up to 2.05).
#[test]
fn position_loops_of_another_make_keep_the_margin_that_they_promise() {
    let (seed, motors) = loops();
    let drawn = [Method::Pd, Method::Pid, Method::Piv]
        .into_iter()
        .flat_map(|method| (0..motors).map(move |number| (seed, number, method)));
    let known = [
        (1_001, 9, Method::Pd),
        (1_002, 93, Method::Pd),
        (1_003, 69, Method::Pid),
        (1_002, 105, Method::Piv),
        (1_002, 75, Method::Piv),
        // D of a coarse encoder makes a few short pulses, of which polls saw none: Ms 3.4.
        (1_017, 82, Method::Pid),
        // Called jammed: a pulse of D at the end of a move, and a law that was not read since two replies were lost.
        (1_005, 34, Method::Pid),
        (1_007, 21, Method::Pd),
    ];
    let looked_at = known.len();
    let (mut runs, mut tuned, mut silent) = (0, 0, 0);
    for (n, (seed, number, method)) in known.into_iter().chain(drawn).enumerate() {
        let run = Run::with(seed, number, method, |_| {});
        println!("{}", run.line);
        if run.report.verdict == Verdict::Refused {
            // Without a share of the setpoint a position alone gives no duty.
            let is_without =
                run.report.causes.first() == Some(&Cause::NoDirectLoop) && run.law.feed_forward == 0.0;
            assert!(is_without && method != Method::Piv, "{}", run.line);
            continue;
        }
        runs += 1;
        assert!(run.ms.is_some(), "stable: {}", run.line);
        if run.report.verdict == Verdict::Tuned {
            tuned += 1;
            let ms = run.ms.unwrap_or(f64::INFINITY);
            assert!(ms <= if n < looked_at { 1.8 } else { 2.0 }, "{}", run.line);
            if ms > 1.8 {
                silent += 1;
                println!("above 1.8");
            }
        }
    }
    println!("{tuned} of {runs} tuned without a warning, {silent} of them above a true Ms of 1.8");
    assert!(2 * tuned >= runs, "a warning on every run says nothing: {tuned} of {runs} without one");
    // Of seed 1006 it is a gearmotor, as PD and as PID, whose lag as a whole is right.
    assert!(20 * silent <= tuned, "of seed {seed}: {silent} of {tuned}");
}

/// Each of these was called jammed: friction that falls with the speed holds a motor below a duty at which a model of one friction says that it turns, counts that a loop of 200 Hz
/// samples are up to 5 ms old, and a loop that pulsed its derivative leaves the motor with a duty that no poll saw. The last three were called flipped or open: polls in step
/// with the pulses that a coarse encoder makes of a loop's duty see the lower half of it, and of its current.
#[test]
fn a_motor_that_nothing_stops_is_not_called_jammed() {
    let known = [
        (1_009, 105, Method::Pd),
        (1_004, 63, Method::Pd),
        (1_009, 12, Method::Piv),
        (1_009, 108, Method::Piv),
        (1_003, 47, Method::Piv),
        (1_002, 29, Method::Piv),
        (1_005, 83, Method::Pid),
        (1_005, 34, Method::Pd),
        (1_024, 10, Method::Velocity),
        (1_026, 46, Method::Piv),
        (1_028, 13, Method::Velocity),
    ];
    for (seed, number, method) in known {
        let run = Run::with(seed, number, method, |_| {});
        println!("{}", run.line);
        assert_ne!(run.report.verdict, Verdict::Refused, "{}", run.line);
    }
}

/// Taken to be the other one, the lag of these was off by 1.2 to 2.4 ms, outside its interval.
#[test]
fn whether_the_sum_is_taken_before_the_error_is_added_is_found_out() {
    for number in [15, 75, 96, 105, 117] {
        let run = Run::of(1_002, number, |_| {});
        println!("{}", run.line);
        assert!(run.report.request.law.forward_sum, "{}", run.line);
        let interval = run.report.lag.map(|lag| lag.interval_s);
        assert!(
            interval.is_some_and(|(low, high)| (low..=high).contains(&run.lag_s)),
            "{interval:?}: {}",
            run.line
        );
    }
}

/// Quick motors whose duty comes a tick late behind a filter of 4 ms, at 300 Hz. Asked about a sum that is taken otherwise, all of the lag was taken for a filter on the speed, which a loop
/// on the position does not have, and cascades were called tuned at a true Ms of 1.81 here and of up to 1.98 on a foreign controller.
#[test]
fn a_late_duty_is_not_taken_for_a_filter_where_the_sum_is_taken_otherwise() {
    let mut split = 0;
    let quick: Vec<Run> = (0..40)
        .filter(|number| drawn(1_002, *number).motor.tau_s() < 0.02)
        .map(|number| {
            Run::with(1_002, number, Method::Piv, |all| {
                all.law = LawOptions {
                    rate_hz: 300.0,
                    per_tick: false,
                    feed_forward: 1.0,
                    proportional: 1.0,
                    filter_s: 0.004,
                    late_ticks: 1,
                    ..all.law
                };
            })
        })
        .collect();
    for run in &quick {
        println!("{} {:?}", run.line, run.report.lag);
        assert!(run.report.verdict != Verdict::Tuned || run.ms.is_some_and(|ms| ms <= 1.8), "{}", run.line);
        split += usize::from(run.report.lag.is_some_and(|lag| lag.lag.delay_ticks > 0.5));
    }
    println!("{split} of {}", quick.len());
    assert!(quick.len() >= 4 && 5 * split >= 4 * quick.len(), "{split} of {}", quick.len());
}

/// Its sum stands still while more than full duty is asked for, and does not know of the current limit. Taken to follow what is left of the duty, as that of the simulated controllers
/// does, gains were slow or went up to 29 % past the setpoint.
#[test]
fn what_the_sum_does_while_the_duty_is_cut_is_found_out_or_left_open() {
    let found: Vec<Windup> =
        (0..24).map(|number| Run::of(1_006, number, |_| {}).report.request.law.windup).collect();
    println!("{found:?}");
    assert!(!found.contains(&Windup::Tracked), "{found:?}");
    assert!(found.iter().filter(|windup| **windup == Windup::Held).count() >= 9, "{found:?}");
}

/// In identification and in trials, of velocity and PIV. A sensor with noise called open motors unclear, since the current of the open motor is no more than the noise;
/// a duty that ramps half as fast as it was asked to made an encoder of a locked shaft "lost".
#[test]
fn faults_of_another_make_are_named_and_the_motor_is_off_in_time() {
    const FAULTS: [(Fault, Cause, f64); 6] = [
        (Fault::Locked, Cause::Stalled, 0.3),
        (Fault::MotorOpened, Cause::MotorOpened, 0.5),
        (Fault::EncoderLost, Cause::EncoderLost, 0.3),
        (Fault::EncoderFlipped, Cause::EncoderFlipped, 0.3),
        (Fault::LinkLost, Cause::LinkLost, 0.25),
        (Fault::RepliesLost, Cause::LinkLost, 0.25),
    ];
    let (mut runs, mut named, mut in_time) = (0, 0, 0);
    for number in 0..12 {
        let method = if number < 6 { Method::Velocity } else { Method::Piv };
        let run = |fault: Option<(Fault, Duration)>| {
            let Drawn { motor, law, poll_s, draw, .. } = drawn(1_007, number);
            let mut unit = Controller::new(motor, law, draw);
            unit.fault = fault;
            let guard = GuardOptions { poll_s, ..GuardOptions::default() };
            let report = tune(&mut unit, &Request::<McpLaw> { guard, method, ..Request::default() });
            (report, unit.driven.longest_s)
        };
        let (identified_s, whole_s) = run(None).0.seconds;
        for (n, (fault, cause, deadline_s)) in FAULTS.into_iter().enumerate() {
            let mut draw = Draw::new(1_007, (10 * number + n) as u64);
            for (from_s, to_s) in [(1.0, identified_s), (identified_s, whole_s)] {
                // The controller's time is 0.7 s at the start.
                let at_s = 0.7 + draw.between(from_s, to_s);
                let (report, off_s) = run(Some((fault, Duration::from_secs_f64(at_s))));
                if report.verdict != Verdict::Refused {
                    continue;
                }
                runs += 1;
                let is_named = report.causes.first() == Some(&cause);
                // A duty that comes a tick late ramps half as fast, for 0.05 s more.
                let is_off = off_s <= deadline_s + 0.06;
                (named, in_time) = (named + usize::from(is_named), in_time + usize::from(is_off));
                if !is_named || !is_off {
                    println!(
                        "{method:?} {number} {fault:?} at {at_s:.2} s: {:?}, off after {off_s:.3} s",
                        report.causes
                    );
                }
            }
        }
    }
    println!("{named} of {runs} named, {in_time} off in time");
    assert!(runs > 120, "{runs}");
    assert!(100 * named >= 95 * runs, "{named} of {runs} named");
    assert!(100 * in_time >= 90 * runs, "{in_time} of {runs} off in time");
}
