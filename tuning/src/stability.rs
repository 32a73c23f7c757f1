//! The margins that a control engineer asks for, read off an open loop over frequency.
//!
//! Definitions as in control texts (Astrom and Murray, "Feedback Systems", 2nd edition, sections 10.3 and 12.2): the gain margin is what the loop's
//! gain may be raised by, the phase margin what its phase may be lowered by at the gain crossover, the delay margin the delay that does that, the
//! bandwidth where the closed loop has fallen by 3 dB.

use crate::whatif::LoopPoint;
use serde::Serialize;

/// The margins of a loop; `None` where the open loop never gets there below half the rate of the controller's loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StabilityMargins {
    /// What the gain may be raised by before the loop oscillates, as a factor.
    pub gain: Option<f64>,
    /// Phase margin, degrees.
    pub phase_deg: Option<f64>,
    /// Delay margin, s.
    pub delay_s: Option<f64>,
    /// Where the open loop has gain 1, Hz.
    pub crossover_hz: Option<f64>,
    /// Where the closed loop has fallen to 0.707, Hz.
    pub bandwidth_hz: Option<f64>,
    /// Maximum sensitivity.
    pub ms: f64,
}

impl StabilityMargins {
    /// Reads them off points in the order of their frequency; the smallest margin counts where there are several crossings.
    #[must_use]
    pub fn of(points: &[LoopPoint]) -> Self {
        let phases = unwrapped(points);
        let gain_at = |point: &LoopPoint| point.open.0.hypot(point.open.1);
        let closed_at = |point: &LoopPoint| gain_at(point) * point.sensitivity();
        let mut found =
            Self { ms: points.iter().map(LoopPoint::sensitivity).fold(0.0, f64::max), ..Self::default() };
        for (pair, phase) in points.windows(2).zip(phases.windows(2)) {
            let (a, b) = (&pair[0], &pair[1]);
            // Between two points in the logarithm of the frequency.
            let hz_at = |share: f64| a.hz * (b.hz / a.hz).powf(share);
            let (gain_a, gain_b) = (gain_at(a).ln(), gain_at(b).ln());
            if gain_a > 0.0 && gain_b <= 0.0 {
                let share = gain_a / (gain_a - gain_b);
                let phase_deg = 180.0 + phase[0] + share * (phase[1] - phase[0]);
                if found.phase_deg.is_none_or(|known| phase_deg < known) {
                    let hz = hz_at(share);
                    (found.phase_deg, found.crossover_hz) = (Some(phase_deg), Some(hz));
                    found.delay_s = Some(phase_deg / 360.0 / hz);
                }
            }
            if phase[0] > -180.0 && phase[1] <= -180.0 {
                let share = (phase[0] + 180.0) / (phase[0] - phase[1]);
                let gain = (-(gain_a + share * (gain_b - gain_a))).exp();
                if found.gain.is_none_or(|known| gain < known) {
                    found.gain = Some(gain);
                }
            }
            let (closed_a, closed_b) = (closed_at(a), closed_at(b));
            let fallen = std::f64::consts::FRAC_1_SQRT_2;
            if found.bandwidth_hz.is_none() && closed_a > fallen && closed_b <= fallen {
                found.bandwidth_hz = Some(hz_at((closed_a - fallen) / (closed_a - closed_b)));
            }
        }
        found
    }

    /// Name, value with its unit, and what it means, a row each.
    #[must_use]
    pub fn rows(&self) -> [(&'static str, String, &'static str); 6] {
        let of =
            |value: Option<f64>, text: &dyn Fn(f64) -> String| value.map_or_else(|| "none".to_owned(), text);
        [
            (
                "gain margin",
                of(self.gain, &|gain| format!("{:.1} dB", 20.0 * gain.log10())),
                "what the loop's gain may grow by before it oscillates",
            ),
            (
                "phase margin",
                of(self.phase_deg, &|deg| format!("{deg:.0} deg")),
                "what the phase may fall by at the gain crossover",
            ),
            (
                "delay margin",
                of(self.delay_s, &|s| format!("{:.1} ms", 1e3 * s)),
                "the delay that would use it up",
            ),
            (
                "gain crossover",
                of(self.crossover_hz, &|hz| format!("{hz:.1} Hz")),
                "where the open loop has gain 1",
            ),
            (
                "bandwidth",
                of(self.bandwidth_hz, &|hz| format!("{hz:.1} Hz")),
                "where the closed loop has fallen by 3 dB, without feed-forward",
            ),
            (
                "sensitivity Ms",
                format!("{:.2}", self.ms),
                "1.2 is tame, 1.6 firm, above 2 close to oscillating",
            ),
        ]
    }
}

/// Phases without jumps, degrees. A loop has one to three integrals at its lowest frequencies, so that what looks like a lead of more than a quarter turn
/// there is a lag.
fn unwrapped(points: &[LoopPoint]) -> Vec<f64> {
    let mut turns = if points.first().is_some_and(|point| point.phase_deg() > 90.0) { -360.0 } else { 0.0 };
    let mut before: Option<f64> = None;
    points
        .iter()
        .map(|point| {
            let phase = point.phase_deg();
            if let Some(before) = before {
                turns += if phase - before > 180.0 {
                    -360.0
                } else if phase - before < -180.0 {
                    360.0
                } else {
                    0.0
                };
            }
            before = Some(phase);
            phase + turns
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// `gain / s` with a delay.
    fn integrator(gain: f64, delay_s: f64) -> Vec<LoopPoint> {
        (0..400)
            .map(|n| 0.05 * 1.02_f64.powi(n))
            .map(|hz| {
                let (w, phase) = (TAU * hz, -std::f64::consts::FRAC_PI_2 - TAU * hz * delay_s);
                LoopPoint { hz, open: (gain / w * phase.cos(), gain / w * phase.sin()) }
            })
            .collect()
    }

    #[test]
    fn an_integrator_with_a_delay_has_the_margins_of_the_textbook() {
        // Crossover at 10 rad/s; 90 degrees less 10 rad/s times 20 ms; the phase is -180 at 78.5 rad/s.
        let found = StabilityMargins::of(&integrator(10.0, 0.02));
        let close = |found: Option<f64>, wanted: f64| {
            let found = found.expect("it has one");
            assert!((found / wanted - 1.0).abs() < 0.01, "{found} is not {wanted}");
        };
        close(found.crossover_hz, 10.0 / TAU);
        close(found.phase_deg, 90.0 - 0.2_f64.to_degrees());
        close(found.delay_s, (std::f64::consts::FRAC_PI_2 - 0.2) / 10.0);
        close(found.gain, std::f64::consts::FRAC_PI_2 / 0.02 / 10.0);
        assert!(found.bandwidth_hz.is_some_and(|hz| hz > 10.0 / TAU && hz < 30.0 / TAU), "{found:?}");
        assert!(found.ms > 1.0 && found.ms < 1.6, "{found:?}");
    }

    #[test]
    fn a_loop_that_begins_beyond_half_a_turn_has_the_phase_margin_of_its_crossover() {
        // g (1 + s / 10)^2 / s^3 begins at -270 degrees; with g = 1e6 / 101 it has gain 1 at 100 rad/s.
        let points: Vec<LoopPoint> = (0..500)
            .map(|n| 0.05 * 1.02_f64.powi(n))
            .map(|hz| {
                let w = TAU * hz;
                let gain = 1e6 / 101.0 * (1.0 + (w / 10.0).powi(2)) / w.powi(3);
                let phase = -1.5 * std::f64::consts::PI + 2.0 * (w / 10.0).atan();
                LoopPoint { hz, open: (gain * phase.cos(), gain * phase.sin()) }
            })
            .collect();
        let wanted = -90.0 + 2.0 * 10.0_f64.atan().to_degrees();
        let found = StabilityMargins::of(&points).phase_deg.expect("it has one");
        assert!((found - wanted).abs() < 0.5, "{found} is not {wanted}");
    }

    #[test]
    fn a_loop_without_a_delay_has_no_gain_margin_and_says_so() {
        let found = StabilityMargins::of(&integrator(10.0, 0.0));
        assert_eq!(found.gain, None);
        assert_eq!(found.rows()[0].1, "none");
        assert_eq!(StabilityMargins::of(&[]).phase_deg, None);
    }
}
