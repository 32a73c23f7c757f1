//! What trials of gains on the true plant show.

use brushwork_plant::{AxisParams, AxisTruth, ShaftSide};
use brushwork_tuning::score::Score;

/// What a trial showed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// The response.
    pub score: Score,
    /// Duty on the settled plateau, root mean square about its mean.
    pub duty_rms: f64,
    /// Whether it goes on oscillating, in a limit cycle, when it should be settled.
    pub hunting: bool,
    /// Deviation of the settled speed over the step (velocity), or peak to peak of the oscillation over the step (position).
    pub ripple: f64,
    /// How often it oscillates, Hz.
    pub ripple_hz: f64,
}

/// True speed and position of the shaft that the encoder sits on, in counts.
pub(crate) fn motion_of(axis: &AxisParams, truth: &AxisTruth) -> (f64, f64) {
    match axis.encoder.side {
        ShaftSide::Load => {
            let per_radian = axis.encoder.counts_per_turn / std::f64::consts::TAU;
            (truth.load_radians_per_second * per_radian, truth.load_radians * per_radian)
        }
        ShaftSide::Motor => {
            let per_radian = axis.counts_per_motor_radian();
            (truth.motor_radians_per_second * per_radian, truth.motor_radians * per_radian)
        }
    }
}

/// What the errors of a velocity test after its step and after its load, and the duties of the first, are worth.
pub(crate) fn velocity_outcome(
    (after_step, after_load): (&[f64], &[f64]),
    duties: &[f64],
    tick_s: f64,
    step: f64,
) -> Outcome {
    let score = Score::of(after_step, after_load, tick_s, step, 0.05);
    let late = after_step.len() * 7 / 10;
    // Ripple beyond what a tick's rounding makes visible at all.
    let ripple = deviation(&after_step[late..]) / step;
    Outcome {
        score,
        duty_rms: deviation(&duties[late..]),
        hunting: ripple > 0.05,
        ripple,
        ripple_hz: crossings(&after_step[late..]) / (2.0 * (after_step.len() - late).max(1) as f64 * tick_s),
    }
}

/// The same of a position test.
pub(crate) fn position_outcome(
    (after_step, after_load): (&[f64], &[f64]),
    duties: &[f64],
    tick_s: f64,
    step: f64,
) -> Outcome {
    let score = Score::of(after_step, after_load, tick_s, step, 0.02_f64.max(3.0 / step));
    let late = after_step.len() * 7 / 10;
    let peak_to_peak = |errors: &[f64]| {
        let (l, h) =
            errors.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(*e), h.max(*e)));
        let turns = errors.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count();
        (h - l, turns)
    };
    let hunts = |errors: &[f64]| {
        let (height, turns) = peak_to_peak(&errors[late..]);
        height > (0.02 * step).max(4.0) && turns >= 2
    };
    let hunting = hunts(after_step) || hunts(after_load);
    let ripple = peak_to_peak(&after_step[late..]).0.max(peak_to_peak(&after_load[late..]).0) / step;
    let ripple_hz = crossings(&after_step[late..]) / (2.0 * (after_step.len() - late).max(1) as f64 * tick_s);
    Outcome { score, duty_rms: deviation(&duties[late..]), hunting, ripple, ripple_hz }
}

fn deviation(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// How often the values pass their mean.
fn crossings(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.windows(2).filter(|pair| (pair[0] - mean) * (pair[1] - mean) < 0.0).count() as f64
}
