//! The tuner under firmwares whose laws differ from the usual one: loop rate, what I sums over, feed-forward. Who reads TUNED must be able
//! to rely on it, whatever the law is.

use super::population::{PacketSpecimen, specimen};
use crate::bounds::MOST_MS;
use crate::optimum::Optimum;
use crate::population::{Draw, draw_of};
use crate::quantile::quantile;
use crate::run::{Judgement, judge_report, linear, request_of, tune_plant};
use crate::unit::{Report, UnderTest};
use brushwork_mcp_sim::motion::{ControlLaw, GainTiming, VelocityEstimate};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::model::Gains;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use rayon::prelude::*;
use serde::Serialize;

/// Loop rates, Hz.
const RATES_HZ: (f64, f64) = (90.0, 1_250.0);
/// The stream of the draws of laws.
const STREAM: u64 = 0x1A35;
/// The highest sensitivity of a loop that is called tuned without a warning.
pub const MOST_TUNED_MS: f64 = 1.8;

/// Plant `number` of a seed under a law of its own: every second one sums over seconds.
#[must_use]
pub fn specimen_under_law(seed: u64, number: usize) -> PacketSpecimen {
    let mut draw = draw_of(seed, number, STREAM);
    let plant = specimen(seed, number);
    let law = law_of(&mut draw, number, &plant.unit);
    PacketSpecimen { unit: law, ..plant }
}

fn law_of(draw: &mut Draw, number: usize, usual: &ControlLaw) -> ControlLaw {
    let rate_hz = draw.log(RATES_HZ).round() as u32;
    // Over all kinds of plants: these come in turns of eight.
    let is_per_second = (number + number / 8) % 2 == 1;
    let gain_timing = if is_per_second { GainTiming::PerSecond } else { GainTiming::PerTick };
    ControlLaw { rate_hz, gain_timing, ..*usual }
}

/// A run under a law, and what its gains are worth.
#[derive(Clone, Debug)]
pub struct LawRun {
    /// The plant.
    pub plant: PacketSpecimen,
    /// The run.
    pub report: Report<ControlLaw>,
    /// What its gains are worth; the cost is over that of no optimum.
    pub judged: Judgement,
    /// The sensitivity of the true loop and the one that was promised.
    pub ms: Option<(f64, f64)>,
}

impl LawRun {
    /// Runs the tuner on a loop of a plant.
    #[must_use]
    pub fn of(plant: PacketSpecimen, method: Method) -> Self {
        let (report, _) = tune_plant(&plant, &request_of(&plant, method));
        let under_test = UnderTest::new(plant.clone());
        let nothing = Optimum { cost: 1.0, duty_rms: 0.08, gains: Gains::default() };
        let judged = judge_report(&under_test, &nothing, &report);
        let is_given = report.verdict != Verdict::Refused;
        let ms = report.design.filter(|_| is_given).map(|design| {
            let truth = &under_test.truth.nominal;
            (linear(truth, &under_test, method, &report.proposed).0.ms, design.ms)
        });
        Self { plant, report, judged, ms }
    }

    /// Whether it says more than is so: tuned without a warning, but unstable or too sensitive.
    #[must_use]
    pub fn promises_too_much(&self) -> bool {
        self.report.verdict == Verdict::Tuned && !(self.judged.stable && self.judged.ms <= MOST_TUNED_MS)
    }

    /// One line: the law, the verdict, the sensitivity, the lag.
    #[must_use]
    pub fn line(&self) -> String {
        let law = &self.plant.unit;
        let winding_s = UnderTest::new(self.plant.clone()).truth.winding_s;
        let filter_s = match law.velocity_estimate {
            VelocityEstimate::LowPass { time_constant_s } => time_constant_s,
            VelocityEstimate::LastTick | VelocityEstimate::MovingAverage { .. } => 0.0,
        };
        let lag_ms =
            1e3 * (winding_s + filter_s + f64::from(law.output_delay_ticks) / f64::from(law.rate_hz));
        let found = self.report.lag.map_or_else(String::new, |lag| {
            let tick_s = 1.0 / f64::from(self.report.request.law.rate_hz);
            let (low, high) = lag.interval_s;
            format!(
                "lag {:.1} of {lag_ms:.1} ms ({:.1} to {:.1}), chi-square {:.2}",
                1e3 * lag.lag.total_s(tick_s),
                1e3 * low,
                1e3 * high,
                lag.chi_square
            )
        });
        format!(
            "{} {:?} {} Hz {:?}: {:?} {:?} as {} Hz, Ms {:.2} (said {:.2}), stable {}, {found}, headroom {:?}",
            self.plant.number,
            self.plant.kind,
            law.rate_hz,
            law.gain_timing,
            self.report.verdict,
            self.report.causes,
            self.report.request.law.rate_hz,
            self.judged.ms,
            self.ms.map_or(0.0, |ms| ms.1),
            self.judged.stable,
            self.report.measured.and_then(|measured| measured.headroom),
        )
    }
}

/// What came of the plants of a seed under laws.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LawRow {
    /// Plants.
    pub runs: usize,
    /// Tuned without a warning.
    pub tuned: usize,
    /// Tuned with a warning.
    pub warned: usize,
    /// Refused since the law could not be measured, and for other reasons.
    pub refused: (usize, usize),
    /// Tuned without a warning, but unstable or more sensitive than that may be.
    pub too_much_promised: usize,
    /// Gains of any verdict that are unstable, or more sensitive than is accepted.
    pub bad: usize,
    /// Accepted by all bounds of the bench.
    pub accepted: usize,
    /// The highest sensitivity of those without a warning.
    pub worst_tuned_ms: f64,
    /// How far the sensitivity was off, 95th percentile.
    pub ms_error_p95: f64,
}

/// Runs them.
#[must_use]
pub fn law_runs(seed: u64, plants: usize, method: Method) -> Vec<LawRun> {
    (0..plants).into_par_iter().map(|number| LawRun::of(specimen_under_law(seed, number), method)).collect()
}

/// Sums them up.
#[must_use]
pub fn law_row(runs: &[LawRun]) -> LawRow {
    let with = |verdict: Verdict| runs.iter().filter(move |run| run.report.verdict == verdict);
    let unknown =
        with(Verdict::Refused).filter(|run| run.report.causes.first() == Some(&Cause::UnknownLaw)).count();
    let is_bad =
        |run: &&LawRun| run.judged.refused.is_none() && !(run.judged.stable && run.judged.ms <= MOST_MS);
    let errors = runs.iter().filter_map(|run| run.ms.map(|(is, said)| (is - said).abs()));
    LawRow {
        runs: runs.len(),
        tuned: with(Verdict::Tuned).count(),
        warned: with(Verdict::TunedWithWarnings).count(),
        refused: (unknown, with(Verdict::Refused).count() - unknown),
        too_much_promised: runs.iter().filter(|run| run.promises_too_much()).count(),
        bad: runs.iter().filter(is_bad).count(),
        accepted: runs.iter().filter(|run| run.judged.accept).count(),
        worst_tuned_ms: with(Verdict::Tuned).map(|run| run.judged.ms).fold(0.0, f64::max),
        ms_error_p95: quantile(errors, 0.95),
    }
}
