//! The textbook rules, for comparison on the same records: what a host that knows them would set.
//!
//! All of them see one step (gain, time constant and dead time by the two-point method on differenced counts) or one relay
//! (ultimate gain and period), as the programs do that use them.

use crate::experiment::FreeRun;
use crate::law::Law;
use crate::model::{Gains, Pid};
use crate::poll::{Drive, Input, Point};
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// The classic rules.
    RULES: Thresholds {
        /// Shortest dead time that a step fit may give, in seconds: none at all has no gain.
        shortest_s: f64 = 0.0002,
    }
}

/// What the classic experiments see.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Classic {
    /// Speed per duty, counts/s.
    pub gain_counts_per_s: f64,
    /// Time constant of the step, s.
    pub tau_s: f64,
    /// Dead time of the step, s.
    pub dead_time_s: f64,
    /// Ultimate gain, duty per counts/s.
    pub ultimate_gain: f64,
    /// Ultimate period, s.
    pub ultimate_period_s: f64,
}

impl Classic {
    /// Reads step and relay off the record of a free run.
    #[must_use]
    pub fn of(points: &[Point], drives: &[Drive], run: &FreeRun) -> Option<Self> {
        let speeds: Vec<(f64, f64)> = points
            .windows(2)
            .filter(|w| w[1].t > w[0].t)
            .map(|w| (0.5 * (w[0].t + w[1].t), (w[1].counts - w[0].counts) / (w[1].t - w[0].t)))
            .collect();
        let (start, end) = (run.from_s, run.step.0);
        let begin =
            drives.iter().find(|d| d.t >= start - 0.05 && matches!(d.input, Input::Duty(u) if u > 0.0))?.t;
        let step: Vec<(f64, f64)> = speeds.iter().copied().filter(|s| s.0 >= begin && s.0 < end).collect();
        let last = run.full_speeds.0;
        let crossing = |share: f64| step.iter().find(|s| s.1 >= share * last).map(|s| s.0 - begin);
        let (t28, t63) = (crossing(0.283)?, crossing(0.632)?);
        let tau_s = (1.5 * (t63 - t28)).max(0.002);
        let relay: Vec<f64> =
            drives.iter().filter(|d| d.t >= end && d.t <= run.step.1).map(|d| d.t).collect();
        let switches = relay.get(2..).filter(|rest| rest.len() >= 2)?;
        let half_period = (switches.last()? - switches.first()?) / (switches.len() - 1) as f64;
        let inside = || speeds.iter().filter(|s| s.0 >= switches[0] && s.0 <= run.step.1).map(|s| s.1);
        let amplitude =
            0.5 * (inside().fold(f64::NEG_INFINITY, f64::max) - inside().fold(f64::INFINITY, f64::min));
        let height = 0.5 * (run.relay.1 - run.relay.0);
        Some(Self {
            gain_counts_per_s: last / run.full_duty,
            tau_s,
            dead_time_s: (t63 - tau_s).max(RULES.shortest_s),
            ultimate_gain: 4.0 * height / (std::f64::consts::PI * amplitude.max(1.0)),
            ultimate_period_s: 2.0 * half_period,
        })
    }

    /// What the experiments would see of a known motor: its ultimate point is where gain times dead time turn it by half a turn.
    #[must_use]
    pub fn of_model(gain_counts_per_s: f64, tau_s: f64, dead_time_s: f64) -> Self {
        let dead_time_s = dead_time_s.max(RULES.shortest_s);
        let (mut low, mut high) = (1e-3, 1e5);
        for _ in 0..80 {
            let w = f64::sqrt(low * high);
            if (w * tau_s).atan() + w * dead_time_s < std::f64::consts::PI { low = w } else { high = w }
        }
        Self {
            gain_counts_per_s,
            tau_s,
            dead_time_s,
            ultimate_gain: (1.0 + (low * tau_s).powi(2)).sqrt() / gain_counts_per_s,
            ultimate_period_s: std::f64::consts::TAU / low,
        }
    }

    /// The ultimate point of the position behind this step: `K / (s (tau s + 1))` with the dead time, at least `floor_s`.
    pub(crate) fn position_ultimate(&self, floor_s: f64) -> (f64, f64) {
        let dead = self.dead_time_s.max(floor_s);
        let (mut low, mut high) = (1e-3, 1e5);
        for _ in 0..80 {
            let w = f64::sqrt(low * high);
            if (w * self.tau_s).atan() + w * dead < std::f64::consts::FRAC_PI_2 { low = w } else { high = w }
        }
        let w = low;
        (w * (1.0 + (w * self.tau_s).powi(2)).sqrt() / self.gain_counts_per_s, std::f64::consts::TAU / w)
    }
}

/// A rule's name and its gains.
pub type RuleGains = (&'static str, Gains);

/// The velocity rules.
#[must_use]
pub fn velocity_rules<L: Law>(c: &Classic, law: &L, qpps: f64) -> Vec<RuleGains> {
    let (k, t, d) = (c.gain_counts_per_s, c.tau_s, c.dead_time_s);
    let floor = d.max(3.0 * law.tick_s());
    let pi = |gain: f64, time_s: f64| velocity(gain * qpps, time_s);
    let simc = |d: f64| pi(t / (k * 2.0 * d), t.min(8.0 * d));
    let r = d / t;
    let amigo = 0.15 / k + (0.35 - d * t / (d + t).powi(2)) * t / (k * d);
    let amigo_time = 0.35 * d + 13.0 * d * t * t / (t * t + 12.0 * d * t + 7.0 * d * d);
    let factory = Gains { velocity: Pid { p: 1.0, i: 0.5 / law.tick_s(), d: 0.0 }, ..Gains::default() };
    vec![
        ("factory", factory),
        ("ziegler_nichols_relay", pi(0.45 * c.ultimate_gain, c.ultimate_period_s / 1.2)),
        ("tyreus_luyben_relay", pi(c.ultimate_gain / 3.2, 2.2 * c.ultimate_period_s)),
        ("ziegler_nichols_step", pi(0.9 * t / (k * d), d / 0.3)),
        ("cohen_coon_step", pi(t / (k * d) * (0.9 + r / 12.0), d * (30.0 + 3.0 * r) / (9.0 + 20.0 * r))),
        ("amigo_step", pi(amigo, amigo_time)),
        ("simc_step", simc(d)),
        ("simc_step_floor", simc(floor)),
        ("lambda_step", pi(t / (k * 0.5 * t), t)),
    ]
}

/// The rules of a position loop that acts on the duty directly, PD.
#[must_use]
pub fn pd_rules<L: Law>(c: &Classic, law: &L, qpps: f64) -> Vec<RuleGains> {
    let floor = 3.0 * law.tick_s();
    let (k, t) = (c.gain_counts_per_s, c.tau_s);
    let (ku, tu) = c.position_ultimate(floor);
    let simc = |d: f64| position(qpps / (k * 2.0 * d), 0.0, t);
    vec![
        ("ziegler_nichols_pd", position(0.8 * ku * qpps, 0.0, tu / 8.0)),
        ("simc_pd_step", simc(c.dead_time_s)),
        ("simc_pd_step_floor", simc(c.dead_time_s.max(floor))),
        ("p_only", position(qpps / (k * 4.0 * t), 0.0, 0.0)),
    ]
}

/// The PID rules.
#[must_use]
pub fn pid_rules<L: Law>(c: &Classic, law: &L, qpps: f64) -> Vec<RuleGains> {
    let (ku, tu) = c.position_ultimate(3.0 * law.tick_s());
    let dead = c.dead_time_s.max(3.0 * law.tick_s()) + c.tau_s;
    let amigo = 0.45 / (c.gain_counts_per_s * dead);
    vec![
        ("ziegler_nichols_pid", position(0.6 * ku * qpps, 1.0 / (0.5 * tu), tu / 8.0)),
        ("tyreus_luyben_pid", position(ku / 2.2 * qpps, 1.0 / (2.2 * tu), tu / 6.3)),
        ("amigo_pid", position(amigo * qpps, 1.0 / (8.0 * dead), 0.5 * dead)),
    ]
}

/// The PIV rules.
#[must_use]
pub fn piv_rules<L: Law>(c: &Classic, law: &L, qpps: f64) -> Vec<RuleGains> {
    let dead = c.dead_time_s.max(3.0 * law.tick_s());
    let inner = velocity(c.tau_s / (c.gain_counts_per_s * 2.0 * dead) * qpps, c.tau_s.min(8.0 * dead));
    let relay = velocity(0.45 * c.ultimate_gain * qpps, c.ultimate_period_s / 1.2);
    let outer = |gains: Gains, p: f64| Gains { position: Some(Pid { p, i: 0.0, d: 0.0 }), ..gains };
    vec![
        ("simc_piv_floor", outer(inner, 1.0 / (4.0 * dead))),
        ("ziegler_nichols_piv", outer(relay, 1.0 / (4.0 * c.ultimate_period_s))),
    ]
}

fn velocity(p: f64, time_s: f64) -> Gains {
    Gains { velocity: Pid { p, i: p / time_s, d: 0.0 }, ..Gains::default() }
}

/// A series of P, an integral rate (1/s) and a derivative time. The integral may carry as much as full duty.
fn position(p: f64, integral_rate: f64, derivative_s: f64) -> Gains {
    let pid = Pid { p, i: p * integral_rate, d: p * derivative_s };
    Gains {
        position: Some(pid),
        max_integral: if pid.i > 0.0 { 1e6 / pid.i.max(1.0) } else { 0.0 },
        ..Gains::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plain_law::PlainLaw;

    const CLASSIC: Classic = Classic {
        gain_counts_per_s: 10_000.0,
        tau_s: 0.1,
        dead_time_s: 0.01,
        ultimate_gain: 0.002,
        ultimate_period_s: 0.04,
    };

    fn rule(rules: &[RuleGains], name: &str) -> Gains {
        rules.iter().find(|rule| rule.0 == name).unwrap().1
    }

    #[test]
    fn the_rules_are_those_of_the_textbook_for_a_known_step_and_relay() {
        let rules = velocity_rules(&CLASSIC, &PlainLaw::default(), 10_000.0);
        let close =
            |got: f64, wanted: f64| assert!((got / wanted - 1.0).abs() < 1e-9, "{got} is not {wanted}");
        // SIMC: tau / (K 2 theta) = 5 / K, integral time min(tau, 8 theta) = 0.08 s.
        close(rule(&rules, "simc_step").velocity.p, 5.0);
        close(rule(&rules, "simc_step").velocity.i, 5.0 / 0.08);
        // Ziegler-Nichols: 0.9 tau / (K theta) = 9 / K, 3.33 theta; by relay 0.45 Ku, Tu / 1.2.
        close(rule(&rules, "ziegler_nichols_step").velocity.p, 9.0);
        close(rule(&rules, "ziegler_nichols_step").velocity.i, 9.0 / (0.01 / 0.3));
        close(rule(&rules, "ziegler_nichols_relay").velocity.p, 9.0);
        close(rule(&rules, "tyreus_luyben_relay").velocity.i, 20.0 / 3.2 / 0.088);
        // Cohen-Coon, r = 0.1.
        close(rule(&rules, "cohen_coon_step").velocity.p, 10.0 * (0.9 + 0.1 / 12.0));
        close(rule(&rules, "lambda_step").velocity.p, 2.0);
        let pd = pd_rules(&CLASSIC, &PlainLaw::default(), 10_000.0);
        close(rule(&pd, "simc_pd_step").position.unwrap().p, 50.0);
        close(rule(&pd, "simc_pd_step").position.unwrap().d, 5.0);
    }

    #[test]
    fn at_the_ultimate_point_the_position_turns_by_half_a_turn_and_has_gain_one() {
        let (ku, tu) = CLASSIC.position_ultimate(0.0);
        let w = std::f64::consts::TAU / tu;
        assert!(((w * 0.1).atan() + w * 0.01 - std::f64::consts::FRAC_PI_2).abs() < 1e-6);
        let gain = ku * 10_000.0 / (w * (1.0 + (w * 0.1_f64).powi(2)).sqrt());
        assert!((gain - 1.0).abs() < 1e-6);
    }
}
