//! Gains in the steps of the registers: the rounded gains are what the loop gets.

use super::position_law::{FULL_PWM, SPEED_STEP_COUNTS_PER_S, on_position, sum_bound_s};
use brushwork_tuning::model::{Gains, Pid};

/// Largest gain register and largest power of the divisor (Motion Mind manual 6.0).
const MOST_TERM: f64 = 65_535.0;
const MOST_SCALAR: u8 = 32;

/// Gains as the registers can hold them.
#[must_use]
pub(crate) fn rounded(gains: &Gains, qpps: f64) -> Gains {
    let ([pterm, iterm, dterm], pidscalar) = scaled(&on_position(gains), qpps);
    let pid = unscaled([pterm, iterm, dterm], pidscalar, qpps);
    if gains.position.is_none() {
        let Gains { velocity, velocity_sum, .. } = on_speed(pid);
        return Gains { velocity, velocity_sum, ..*gains };
    }
    Gains { position: Some(pid), max_integral: sum_bound_s(gains.max_integral), ..*gains }
}

/// Gains on the error of the position as those of a speed loop.
pub(super) fn on_speed(position: Pid) -> Gains {
    let velocity = Pid { p: position.d, i: position.p, d: 0.0 };
    Gains { velocity, velocity_sum: position.i, ..Gains::default() }
}

/// PTERM, ITERM, DTERM and PIDSCALAR of gains on the error of the position.
pub(super) fn scaled(pid: &Pid, qpps: f64) -> ([u16; 3], u8) {
    let tick = SPEED_STEP_COUNTS_PER_S;
    let plain = [pid.p, pid.i / tick, pid.d * tick].map(|gain| FULL_PWM * gain.max(0.0) / qpps.max(1.0));
    let power = |scalar: u8| 2.0_f64.powi(i32::from(scalar));
    let fits = |scalar: &u8| plain.iter().all(|gain| (gain * power(*scalar)).round() <= MOST_TERM);
    let pidscalar = (0..=MOST_SCALAR).rev().find(fits).unwrap_or(0);
    // The cast saturates.
    (plain.map(|gain| (gain * power(pidscalar)).round() as u16), pidscalar)
}

/// The gains that they stand for, on the error of the position.
pub(super) fn unscaled(terms: [u16; 3], pidscalar: u8, qpps: f64) -> Pid {
    let tick = SPEED_STEP_COUNTS_PER_S;
    let unit = qpps.max(1.0) / FULL_PWM / 2.0_f64.powi(i32::from(pidscalar));
    let [p, i, d] = terms.map(|term| f64::from(term) * unit);
    Pid { p, i: i * tick, d: d / tick }
}
