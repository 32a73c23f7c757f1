//! The tuner on a controller and motors that share no code with the simulators of this program: what it says of its gains is checked by
//! figures worked out here.

mod controller;
mod machine;

use brushwork_mcp_axis::McpLaw;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::{Request, tune};
use controller::{Controller, LawOptions, NOISE_AMPS, sensitivity};
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
    let law = LawOptions {
        rate_hz: draw.one_of(&[200.0, 300.0, 500.0, 625.0, 1_000.0]),
        per_tick: draw.uniform() < 0.5,
        feed_forward: draw.one_of(&[1.0, 1.0, 0.5, 0.0]),
        proportional: draw.one_of(&[1.0, 1.0, 4.0]),
        filter_s: draw.one_of(&[0.0, 0.0, 0.004, 0.010]),
        late_ticks: draw.one_of(&[0, 1]),
    };
    let poll_s = draw.log(0.010, 0.020);
    Drawn { motor, law, poll_s, noise_amps: NOISE_AMPS, draw }
}

/// A run, and what its gains really are.
struct Run {
    law: LawOptions,
    report: Report<McpLaw>,
    /// The sensitivity of the loop as it is; `None` where it is unstable, or there are no gains.
    ms: Option<f64>,
    line: String,
}

impl Run {
    fn of(seed: u64, number: usize, change: impl Fn(&mut Drawn)) -> Self {
        let mut all = drawn(seed, number);
        change(&mut all);
        let Drawn { motor, law, poll_s, noise_amps, draw } = all;
        let mut unit = Controller::new(motor, law, draw);
        unit.noise_amps = noise_amps;
        let guard = GuardOptions { poll_s, ..GuardOptions::default() };
        let report = tune(&mut unit, &Request::<McpLaw> { guard, ..Request::default() });
        let ms = report.proposed.velocity.and_then(|registers| sensitivity(&motor, &law, &registers));
        let tick_s = 1.0 / f64::from(report.request.law.rate_hz);
        let lag_ms = report.lag.map(|lag| 1e3 * lag.lag.total_s(tick_s));
        let line = format!(
            "{number} {} {law:?}: {:?} {:?}, Ms {ms:.2?} (said {:.2?}), lag {lag_ms:.1?} of {:.1} ms, {:?}",
            motor.kind,
            report.verdict,
            report.causes,
            report.design.map(|design| design.ms),
            1e3 * law.lag_s(),
            report.request.law,
        );
        Self { law, report, ms, line }
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
        all[1].see(about(fit.model.tau_s, fit.sd_ln_tau), motor.tau_s().ln());
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
