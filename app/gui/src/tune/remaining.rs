//! How far a run is and how long it will take, from what its steps usually take and how slow this motor has shown itself.

use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::tune::{Excitation, Method};

use brushwork_core::tune::sequence::{Sequence, Work};

/// How far it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remaining {
    /// 0 to 1.
    pub fraction: f32,
    /// None before and after the run itself.
    pub seconds: Option<f64>,
}

/// What the steps take on a motor of 0.1 s, s: probe, experiment, law, lag, trial.
const FREE_S: [f64; 5] = [1.0, 4.0, 1.0, 3.5, 3.5];
/// The same within a travel, where the lag is not measured.
const WINDOW_S: [f64; 5] = [1.0, 6.0, 1.0, 0.1, 5.0];
/// The same over the range of an absolute encoder, which is wide for its motor.
const ABSOLUTE_S: [f64; 5] = [1.0, 16.0, 1.0, 0.1, 5.0];
/// Play is looked for before an integral is designed.
const PLAY_S: f64 = 4.0;
/// Gains tried by themselves.
const TRIAL_S: [f64; 1] = [5.0];

/// How far a run is.
pub fn remaining(sequence: &Sequence) -> Remaining {
    if sequence.is_restoring() {
        return Remaining { fraction: 1.0, seconds: None };
    }
    let is_absolute = sequence.target.encoder.is_some_and(|encoder| encoder != EncoderClass::Quadrature);
    let mut usual: Vec<f64> = match &sequence.work {
        Work::Tune(_) if is_absolute => ABSOLUTE_S.to_vec(),
        Work::Tune(request) if request.excitation == Excitation::Free => FREE_S.to_vec(),
        Work::Tune(_) => WINDOW_S.to_vec(),
        Work::Try(_) | Work::PutBack => TRIAL_S.to_vec(),
    };
    if matches!(&sequence.work, Work::Tune(request) if request.method == Method::Pid) {
        usual.insert(usual.len() - 1, PLAY_S);
    }
    match sequence.step() {
        Some((step, since_s)) => estimate(&usual, step, since_s, &sequence.durations()),
        None => Remaining { fraction: 0.0, seconds: None },
    }
}

/// A step that took longer than usual makes those after it longer too.
fn estimate(usual: &[f64], step: usize, since_s: f64, past: &[f64]) -> Remaining {
    let slow = past.iter().zip(usual).map(|(took, usual)| took / usual).fold(1.0, f64::max).min(8.0);
    let of = |index: usize| usual.get(index).copied().unwrap_or(1.0) * if index == 0 { 1.0 } else { slow };
    let now = of(step).max(since_s + 0.3);
    let after: f64 = (step + 1..usual.len()).map(of).sum();
    let done: f64 = past.iter().sum::<f64>() + since_s;
    let left = now - since_s + after;
    Remaining { fraction: (done / (done + left)).clamp(0.0, 1.0) as f32, seconds: Some(left) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_goes_down_and_a_slow_motor_is_told_as_one() {
        let begin = estimate(&FREE_S, 0, 0.0, &[]);
        let later = estimate(&FREE_S, 3, 1.0, &[1.0, 4.0, 1.0]);
        assert!((begin.seconds.unwrap() - 13.0).abs() < 1e-9 && (later.seconds.unwrap() - 6.0).abs() < 1e-9);
        assert!(begin.fraction == 0.0 && later.fraction > 0.5 && later.fraction < 0.6);
        let slow = estimate(&FREE_S, 3, 0.0, &[1.0, 16.0, 1.0]);
        assert!((slow.seconds.unwrap() - 28.0).abs() < 1e-9);
    }
}
