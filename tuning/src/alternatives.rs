//! The textbook rules beside this tuner's own design, on what one run has found: each as gains and registers, and with what it promises on the
//! same model.
//!
//! A rule sees what its experiment gives: gain, time constant and dead time of a step, or the response at the frequency of a relay. The dead time is
//! never taken as shorter than the lag of the controller's own loop, which the run has measured: an experiment that this program does from
//! outside does not have that in it, and rules without it are useless (SIMC: good on 40 % of 42 foreign controllers with it, on 11 %
//! without).

use crate::design::{Design, Task, deadzone, direct_gains};
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::margin::MARGIN;
use crate::model::{Gains, Pid};
use crate::proposal::design_for;
use crate::report::Report;
use crate::request::{Identification, Method};
use crate::rules::Classic;
use crate::thresholds::thresholds;
use crate::ticks::{position_test_and_end, velocity_test};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

thresholds! {
    /// How far the gains of a rule are lowered until they may be tried: to the sensitivity that gains may have without a warning.
    ALTERNATIVES: Thresholds {
        /// Factor by which all gains are lowered at a time.
        lowered: f64 = 0.85,
        /// How often they are lowered at the most: to a hundredth.
        most_lowered: usize = 28,
    }
}

/// Where gains come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// This tuner's search on the model.
    Search,
    /// Skogestad 2003, the closed time constant as long as the dead time.
    Simc,
    /// Astrom and Hagglund 2004, of a step.
    Amigo,
    /// A closed time constant of half the open one.
    Lambda,
    /// Tyreus and Luyben 1992, of the ultimate point.
    TyreusLuyben,
    /// Ziegler and Nichols 1942: of a step, or of the ultimate point where the run was a relay.
    ZieglerNichols,
    /// Cohen and Coon 1953, of a step.
    CohenCoon,
}

impl Rule {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Search,
        Self::Simc,
        Self::Amigo,
        Self::Lambda,
        Self::TyreusLuyben,
        Self::ZieglerNichols,
        Self::CohenCoon,
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Search => "Brushwork",
            Self::Simc => "SIMC",
            Self::Amigo => "AMIGO",
            Self::Lambda => "Lambda",
            Self::TyreusLuyben => "Tyreus-Luyben",
            Self::ZieglerNichols => "Ziegler-Nichols",
            Self::CohenCoon => "Cohen-Coon",
        }
    }

    /// The rule whose gains an identification proposes for a method.
    #[must_use]
    pub fn of(identification: Identification, method: Method) -> Self {
        match (identification, method) {
            (Identification::Fit, _) => Self::Search,
            (Identification::Step, _) => Self::Simc,
            // Tyreus and Luyben have no rule without an integral.
            (Identification::Relay | Identification::Controller, Method::Pd) => Self::ZieglerNichols,
            (Identification::Relay | Identification::Controller, _) => Self::TyreusLuyben,
        }
    }

    /// The PI gains that it gives: P over QPPS and the integral time, s. The search has no formula.
    fn pi(self, seen: &Classic, by_relay: bool) -> Option<(f64, f64)> {
        let (k, t, d) = (seen.gain_counts_per_s, seen.tau_s, seen.dead_time_s);
        let (ku, tu) = (seen.ultimate_gain, seen.ultimate_period_s);
        let r = d / t;
        Some(match self {
            Self::Search => return None,
            Self::Simc => (t / (k * 2.0 * d), t.min(8.0 * d)),
            Self::Amigo => (
                0.15 / k + (0.35 - d * t / (d + t).powi(2)) * t / (k * d),
                0.35 * d + 13.0 * d * t * t / (t * t + 12.0 * d * t + 7.0 * d * d),
            ),
            Self::Lambda => (t / (k * (0.5 * t + d)), t),
            Self::TyreusLuyben => (ku / 3.2, 2.2 * tu),
            Self::ZieglerNichols if by_relay => (0.45 * ku, tu / 1.2),
            Self::ZieglerNichols => (0.9 * t / (k * d), d / 0.3),
            Self::CohenCoon => (t / (k * d) * (0.9 + r / 12.0), d * (30.0 + 3.0 * r) / (9.0 + 20.0 * r)),
        })
    }

    /// P over QPPS, the integral time and the derivative time, s, of a position loop that acts on the duty directly: `K / (s (tau s + 1))` with the dead
    /// time. `None` where the rule has no formula for such a process.
    fn pid(self, seen: &Classic, (ku, tu): (f64, f64), has_integral: bool) -> Option<(f64, f64, f64)> {
        let (k, t, d) = (seen.gain_counts_per_s, seen.tau_s, seen.dead_time_s);
        let half = 0.5 * t;
        Some(match (self, has_integral) {
            // Skogestad 2003, table 1: the derivative cancels the time constant.
            (Self::Simc, false) => (1.0 / (k * 2.0 * d), f64::INFINITY, t),
            (Self::Simc, true) => of_series(1.0 / (k * 2.0 * d), 8.0 * d, t),
            // Chien and Fruehauf 1990, the closed time constant half the open one.
            (Self::Lambda, false) => (1.0 / (k * (half + d)), f64::INFINITY, t),
            (Self::Lambda, true) => of_series((t + d) / (k * (half + d).powi(2)), t + d, t),
            // For an integrating process with the dead time and the time constant together.
            (Self::Amigo, true) => (0.45 / (k * (d + t)), 8.0 * (d + t), 0.5 * (d + t)),
            (Self::TyreusLuyben, true) => (ku / 2.2, 2.2 * tu, tu / 6.3),
            (Self::ZieglerNichols, true) => (0.6 * ku, 0.5 * tu, tu / 8.0),
            (Self::ZieglerNichols, false) => (0.8 * ku, f64::INFINITY, tu / 8.0),
            (Self::Amigo | Self::TyreusLuyben, false) | (Self::Search | Self::CohenCoon, _) => return None,
        })
    }

    /// P of a position loop over the velocity loop of this rule, 1/s: Skogestad's for an integrator behind the closed loop.
    fn outer(self, seen: &Classic) -> f64 {
        let behind_s = match self {
            Self::Lambda => 0.5 * seen.tau_s + seen.dead_time_s,
            Self::TyreusLuyben | Self::ZieglerNichols => seen.ultimate_period_s,
            Self::Search | Self::Simc | Self::Amigo | Self::CohenCoon => seen.dead_time_s,
        };
        1.0 / (4.0 * behind_s)
    }
}

/// A series of P, integral time and derivative time as a sum of them.
fn of_series(p: f64, integral_s: f64, derivative_s: f64) -> (f64, f64, f64) {
    let both_s = integral_s + derivative_s;
    (p * both_s / integral_s, both_s, integral_s * derivative_s / both_s)
}

/// What a rule comes to on a run's model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alternative<L: Law> {
    /// The rule.
    pub rule: Rule,
    /// What it promises; its gains are as the registers hold them.
    pub design: Design,
    /// Whether the loop is stable on the model, with the longest lag that is likely too.
    pub is_stable: bool,
    /// Its registers.
    pub registers: L::Registers,
}

/// The gain, time constant and dead time, and the ultimate point, that the rules are given on a run.
#[must_use]
pub fn seen<L: Law>(report: &Report<L>, task: &Task<L>) -> Classic {
    let lag_s = task.lag.total_s(task.law.tick_s()) + 1.5 * task.law.tick_s();
    let (gain, tau_s, dead_s) = match (report.step, report.relay) {
        (Some(step), _) => {
            let dead_s = report.fit.map_or(0.0, |fit| fit.offset_s);
            (step.gain_counts_per_s.0, 0.5 * (step.taus_s.0 + step.taus_s.1), dead_s)
        }
        (None, Some(relay)) => {
            let omega = TAU / relay.period_s.0;
            let ratio = relay.static_gain.0 / relay.response.0;
            let tau_s = (ratio * ratio - 1.0).max(0.0).sqrt() / omega;
            let dead_s = (relay.lag_deg.0.to_radians() - (omega * tau_s).atan()) / omega;
            (relay.static_gain.0, tau_s.max(task.law.tick_s()), dead_s)
        }
        (None, None) => {
            let (gain, tau_s) = (task.plant.gain_counts_per_s, task.plant.tau_s);
            let by_relay = report.position_relay.map(|relay| {
                let omega = TAU / relay.period_s.0;
                ((relay.lag_deg.0 - 90.0).to_radians() - (omega * tau_s).atan()) / omega
            });
            let by_step = report.window.filter(|window| window.step_duties.is_some()).and(report.fit);
            (gain, tau_s, by_relay.or(by_step.map(|fit| fit.offset_s)).unwrap_or(0.0))
        }
    };
    let seen = Classic::of_model(gain, tau_s, dead_s.max(lag_s));
    // The controller's own test has found the ultimate point itself.
    report.own_test.map_or(seen, |test| Classic {
        ultimate_gain: test.ultimate_gain(),
        ultimate_period_s: test.period_s,
        ..seen
    })
}

/// All rules on a run; none on those without a model, and on those of an axis that takes no duty.
#[must_use]
pub fn alternatives<L: Law>(report: &Report<L>) -> Vec<Alternative<L>> {
    let (Some(task), Some(before)) = (report.task, report.before) else { return Vec::new() };
    if !task.law.facts().has_duty {
        return Vec::new();
    }
    let seen = seen(report, &task);
    let method = report.request.method;
    let travel = report.free_limits.or(report.request.guard.travel).filter(|_| method != Method::Velocity);
    let of = |rule: Rule| {
        let design = if rule == Rule::Search {
            design_for(method, &task)?
        } else {
            promised(&task, gains_of(rule, report, &task, &seen)?)
        };
        Some(Alternative {
            rule,
            design,
            is_stable: is_stable(&task, &design.gains),
            registers: task.law.registers(&before.held, &design.gains, task.qpps, travel),
        })
    };
    Rule::ALL.into_iter().filter_map(of).collect()
}

/// What the rule of a method proposes, lowered where it would leave too little margin or make too much noise, and whether it was.
pub(crate) fn proposed<L: Law>(report: &Report<L>, task: &Task<L>) -> Option<(Design, bool)> {
    let rule = Rule::of(report.request.identification, report.request.method);
    let mut gains = gains_of(rule, report, task, &seen(report, task))?;
    for lowered in 0..ALTERNATIVES.most_lowered {
        let design = promised(task, gains);
        let is_fit = design.ms <= MARGIN.most_ms && design.noise_duty <= task.goal.noise_duty;
        if is_fit && is_stable(task, &gains) {
            return Some((design, lowered > 0));
        }
        let softer = |pid: Pid| Pid {
            p: ALTERNATIVES.lowered * pid.p,
            i: ALTERNATIVES.lowered * pid.i,
            d: ALTERNATIVES.lowered * pid.d,
        };
        let position = gains.position.map(softer);
        // A bound of the sum is one of what the integral gives.
        let max_integral =
            if position.is_some() { gains.max_integral / ALTERNATIVES.lowered } else { gains.max_integral };
        gains = Gains { velocity: softer(gains.velocity), position, max_integral, ..gains };
    }
    None
}

fn gains_of<L: Law>(rule: Rule, report: &Report<L>, task: &Task<L>, seen: &Classic) -> Option<Gains> {
    let by_relay = report.relay.is_some() || report.position_relay.is_some() || report.own_test.is_some();
    let inner = || {
        let (gain, time_s) = rule.pi(seen, by_relay)?;
        let p = gain * task.qpps;
        Some(Gains { velocity: Pid { p, i: p / time_s, d: 0.0 }, ..Gains::default() })
    };
    let has_integral = match report.request.method {
        Method::Velocity => return inner(),
        Method::Piv => {
            let position = Some(Pid { p: rule.outer(seen), i: 0.0, d: 0.0 });
            return Some(Gains { position, deadzone_counts: deadzone(task), ..inner()? });
        }
        Method::Pd => false,
        Method::Pid => true,
    };
    let ultimate = report
        .own_position_test
        .map_or_else(|| seen.position_ultimate(0.0), |test| (test.ultimate_gain(), test.period_s));
    let (gain, integral_s, derivative_s) = rule.pid(seen, ultimate, has_integral)?;
    let p = gain * task.qpps;
    Some(direct_gains(task, Pid { p, i: p / integral_s, d: p * derivative_s }))
}

fn promised<L: Law>(task: &Task<L>, gains: Gains) -> Design {
    let gains = task.law.rounded(&gains, task.qpps);
    let margins = on_model(task, task.lag).margins(&gains, task.qpps);
    Design {
        gains,
        score: match gains.position {
            None => velocity_test(&task.plant, &task.law, task.lag, &gains, task.qpps),
            Some(_) => position_test_and_end(&task.plant, &task.law, task.lag, &gains, task.qpps).0,
        },
        ms: margins.ms,
        noise_duty: margins.noise_duty * task.noise_factor,
    }
}

fn is_stable<L: Law>(task: &Task<L>, gains: &Gains) -> bool {
    [task.lag, task.worst_lag].iter().all(|lag| on_model(task, *lag).spectral_radius(gains, task.qpps) < 1.0)
}

fn on_model<L: Law>(task: &Task<L>, lag: crate::model::Lag) -> LoopPlant {
    LoopPlant::new(DiscretePlant::of(&task.plant, task.law.tick_s()), &task.law, lag)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_gives_what_its_paper_says_for_a_known_motor() {
        // Gain 10,000 counts/s, 100 ms, dead time 10 ms.
        let seen = Classic::of_model(10_000.0, 0.1, 0.01);
        let close = |rule: Rule, by_relay: bool, gain: f64, time_s: f64| {
            let (p, ti) = rule.pi(&seen, by_relay).expect("it has a formula");
            assert!((p * 10_000.0 / gain - 1.0).abs() < 1e-3, "{rule:?}: P {}", p * 10_000.0);
            assert!((ti / time_s - 1.0).abs() < 1e-3, "{rule:?}: {ti} s");
        };
        close(Rule::Simc, false, 5.0, 0.08);
        close(Rule::Lambda, false, 10.0 / 6.0, 0.1);
        close(Rule::ZieglerNichols, false, 9.0, 0.01 / 0.3);
        close(Rule::CohenCoon, false, 10.0 * (0.9 + 0.1 / 12.0), 0.01 * 30.3 / 11.0);
        close(Rule::Amigo, false, 0.15 + (0.35 - 0.001 / 0.0121) * 10.0, 0.0035 + 0.0013 / 0.0227);
        // The phase of -180 degrees is at atan(w 0.1) + w 0.01 = pi: w = 163.1 rad/s, gain 16.34 / 10,000.
        close(Rule::TyreusLuyben, true, 16.34 / 3.2, 2.2 * TAU / 163.1);
        close(Rule::ZieglerNichols, true, 0.45 * 16.34, TAU / 163.1 / 1.2);
        assert_eq!(Rule::Search.pi(&seen, false), None);
    }

    #[test]
    fn each_rule_for_positions_gives_what_its_paper_says_for_a_known_motor() {
        let seen = Classic::of_model(10_000.0, 0.1, 0.01);
        let close = |rule: Rule, has_integral: bool, wanted: (f64, f64, f64)| {
            let found = rule.pid(&seen, seen.position_ultimate(0.0), has_integral).expect("it has a formula");
            let pairs = [(found.0 * 10_000.0, wanted.0), (found.1, wanted.1), (found.2, wanted.2)];
            for (found, wanted) in pairs {
                let is_close = found == wanted || (found / wanted - 1.0).abs() < 1e-3;
                assert!(is_close, "{rule:?}: {found} is not {wanted}");
            }
        };
        close(Rule::Simc, false, (50.0, f64::INFINITY, 0.1));
        // In series 50, 80 ms and 100 ms.
        close(Rule::Simc, true, (112.5, 0.18, 0.008 / 0.18));
        close(Rule::Lambda, false, (1.0 / 0.06, f64::INFINITY, 0.1));
        close(Rule::Amigo, true, (0.45 / 0.11, 0.88, 0.055));
        // The phase of -180 degrees is at atan(w 0.1) + w 0.01 = pi / 2: w = 31.1 rad/s, where the gain is 1 / 101.7.
        close(Rule::ZieglerNichols, false, (0.8 * 101.7, f64::INFINITY, TAU / 31.11 / 8.0));
        close(Rule::TyreusLuyben, true, (101.7 / 2.2, 2.2 * TAU / 31.11, TAU / 31.11 / 6.3));
        for (rule, has_integral) in
            [(Rule::CohenCoon, true), (Rule::TyreusLuyben, false), (Rule::Amigo, false)]
        {
            assert_eq!(rule.pid(&seen, seen.position_ultimate(0.0), has_integral), None, "{rule:?}");
        }
    }
}
