//! The law of an MCP or RoboClaw for the tuner: a velocity PID with QPPS, alone or under a position PID, each with its own registers.

use crate::probe::{LawFindings, probe_law};
use crate::registers::{
    McpHeld, McpLaw, McpNote, McpRegisters, McpWrite, gains_of, position_registers, velocity_gains,
    velocity_registers,
};
use crate::table;
use brushwork_tuning::axis::AxisError;
use brushwork_tuning::cascade::{CASCADE, Cascade, Manner};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::ExperimentGuard;
use brushwork_tuning::joined::LeadingLaw;
use brushwork_tuning::law::{Ending, Facts, Law, Seen, Windup};
use brushwork_tuning::law_probe::LawProbe;
use brushwork_tuning::model::{DerivativeFilter, Gains, Pid};
use brushwork_tuning::setpoint::Setpoint;
use brushwork_tuning::tune::Method;

/// None of the firmware's law is public, so that a run finds it out.
static FACTS: Facts = Facts { can_be_probed: true, ..CASCADE };

impl Law for McpLaw {
    type Held = McpHeld;
    type Registers = McpRegisters;
    type Write = McpWrite;
    type Note = McpNote;
    type Findings = LawFindings;
    type Loop = Cascade;

    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn rate_hz(&self) -> u32 {
        self.rate_hz
    }

    fn derivative_filter(&self) -> Option<DerivativeFilter> {
        self.derivative_filter
    }

    fn feed_forward(&self) -> f64 {
        self.feed_forward
    }

    fn with_other_sum(&self, gains: &Gains) -> Option<(Self, Gains)> {
        let other = Self { forward_sum: !self.forward_sum, ..*self };
        let Pid { p, i, .. } = gains.velocity;
        let velocity = Pid { p: p + i * (self.sum_late_s() - other.sum_late_s()), ..gains.velocity };
        Some((other, Gains { velocity, ..*gains }))
    }

    fn windup(&self) -> Windup {
        self.windup
    }

    fn with_windup(&self, windup: Windup) -> Option<Self> {
        Some(Self { windup, ..*self })
    }

    fn tick(&self, state: &mut Cascade, gains: (&Gains, f64), setpoint: Setpoint, seen: &Seen<'_>) -> f64 {
        state.tick(gains, Manner::of(self), setpoint, seen)
    }

    fn steady(&self, gains: (&Gains, f64), speed: f64, duty: f64) -> Cascade {
        Cascade::steady(gains, self.feed_forward, speed, duty)
    }

    fn registers(
        &self,
        held: &McpHeld,
        gains: &Gains,
        qpps: f64,
        travel: Option<(i64, i64)>,
    ) -> McpRegisters {
        let before = (held.position.min, held.position.max);
        // The casts are of counts within 32 bits.
        let clamp = |counts: i64| counts.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32;
        let travel = match travel {
            Some((low, high)) => (clamp(low), clamp(high)),
            None => before,
        };
        McpRegisters {
            velocity: Some(velocity_registers(&gains.velocity, qpps, self)),
            position: gains.position.map(|_| position_registers(gains, self, travel)),
        }
    }

    fn gains(&self, registers: &McpRegisters, _: f64, _: bool) -> Gains {
        let velocity = registers.velocity.unwrap_or_default();
        match &registers.position {
            Some(position) => gains_of(&velocity, position, self),
            None => Gains { velocity: velocity_gains(&velocity, self), ..Gains::default() },
        }
    }

    fn rows(&self, held: &McpHeld, proposed: &McpRegisters) -> Vec<[String; 4]> {
        table::rows(held, proposed, self.position_scale)
    }

    fn writes(registers: &McpRegisters, is_position: bool) -> Vec<McpWrite> {
        let position = registers.position.filter(|_| is_position).map(McpWrite::PositionLoop);
        registers.velocity.map(McpWrite::Velocity).into_iter().chain(position).collect()
    }

    fn before(held: &McpHeld) -> McpRegisters {
        McpRegisters { velocity: Some(held.velocity), position: None }
    }

    fn take(registers: &mut McpRegisters, write: &McpWrite) {
        match *write {
            McpWrite::Velocity(velocity) => registers.velocity = Some(velocity),
            McpWrite::PositionLoop(position) => registers.position = Some(position),
        }
    }

    fn step_duty(&self, registers: &McpRegisters) -> f64 {
        let velocity = registers.velocity.unwrap_or_default();
        let Gains { velocity: Pid { p, .. }, position, .. } = self.gains(registers, 0.0, true);
        // A position loop over a velocity loop without gains gives the duty itself.
        let gain = if p > 0.0 { p } else { position.map_or(0.0, |position| position.d) };
        gain * f64::from(self.rate_hz) / f64::from(velocity.qpps.max(1))
    }

    fn note(write: McpWrite, answer: Result<(), AxisError>) -> McpNote {
        match write {
            McpWrite::Velocity(registers) => McpNote::Velocity(registers, answer),
            McpWrite::PositionLoop(registers) => McpNote::PositionLoop(registers, answer),
        }
    }

    fn noted(note: &McpNote) -> (McpWrite, Result<(), AxisError>) {
        match note {
            McpNote::Velocity(registers, answer) => (McpWrite::Velocity(*registers), answer.clone()),
            McpNote::PositionLoop(registers, answer) => (McpWrite::PositionLoop(*registers), answer.clone()),
        }
    }

    fn found(&self, findings: &LawFindings, is_position: bool) -> Option<Self> {
        findings.law(self, is_position)
    }

    fn why_not_found(findings: &LawFindings) -> Cause {
        let is_without = findings.known_feed_forward() == Some(false) && findings.position_scale.is_none();
        if is_without { Cause::NoDirectLoop } else { Cause::UnknownLaw }
    }

    fn is_rate_known(findings: &LawFindings) -> bool {
        findings.is_rate_known()
    }

    fn is_derivative_known(findings: &LawFindings) -> bool {
        findings.derivative_s.is_some()
    }

    fn derivative_noise(findings: &LawFindings) -> Option<f64> {
        findings.derivative_noise()
    }

    fn keeping(registers: &McpRegisters) -> Vec<McpWrite> {
        Self::writes(registers, true)
    }

    fn position_limits(held: &McpHeld) -> Option<(i64, i64)> {
        Some((held.position.min.into(), held.position.max.into()))
    }

    fn ending(held: &McpHeld, ending: Ending<'_, Self>) -> Vec<McpWrite> {
        if ending.is_touched && ending.kept.is_none() {
            vec![McpWrite::Velocity(held.velocity), McpWrite::PositionLoop(held.position)]
        } else {
            Vec::new()
        }
    }
}

impl LawProbe for McpLaw {
    fn probe<J: Law>(
        guard: &mut ExperimentGuard<'_, J>,
        held: &McpHeld,
        write: &dyn Fn(McpWrite) -> J::Write,
        start_duty: f64,
        method: Method,
    ) -> Result<Option<LawFindings>, Cause> {
        probe_law(guard, write, start_duty, (held.position.min, held.position.max), method)
    }
}

impl LeadingLaw for McpLaw {
    fn standing_in(rate_hz: u32) -> Self {
        Self { rate_hz, position_scale: 1.0, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_tuning::linear::{DiscretePlant, LoopPlant};
    use brushwork_tuning::model::{Lag, PlantModel};
    use brushwork_tuning::ticks::TickLoop;

    const QPPS: f64 = 10_000.0;
    const LAG: Lag = Lag { filter_s: 0.010, delay_ticks: 1.0 };
    const MOTOR: PlantModel = PlantModel {
        gain_counts_per_s: QPPS,
        tau_s: 0.08,
        coulomb_duty: 0.0,
        load_duty: 0.0,
        drive_limit: None,
        brake_limit: None,
        sag: 0.0,
    };

    fn pd(p: f64) -> Gains {
        Gains { position: Some(Pid { p, i: 0.0, d: 0.03 * p }), ..Gains::default() }
    }

    /// How far the last quarter of a step swings over the first; it is too small to saturate.
    fn growth(law: McpLaw, p: f64) -> f64 {
        let mut twin = TickLoop::new(MOTOR, law, LAG, pd(p), QPPS).smooth();
        let errors: Vec<f64> = (0..1200)
            .map(|_| {
                twin.tick(Setpoint::Position(1e-6, QPPS), 0.0);
                (1e-6 - twin.motion.position).abs()
            })
            .collect();
        let most = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        most(&errors[900..]) / most(&errors[..300])
    }

    /// Poles, responses and ticks are three computations of one loop.
    #[test]
    fn a_derivative_of_the_filtered_speed_is_in_poles_margins_and_ticks_alike() {
        let plain = McpLaw { rate_hz: 625, ..McpLaw::default() };
        let filtered =
            McpLaw { derivative_filter: Some(DerivativeFilter { likely_s: 0.004, least_s: 0.003 }), ..plain };
        let edge_of = |law: McpLaw| {
            let plant = LoopPlant::new(DiscretePlant::of(&MOTOR, law.tick_s()), &law, LAG);
            let (mut low, mut high) = (1.0, 1e4);
            for _ in 0..50 {
                let middle = f64::sqrt(low * high);
                if plant.spectral_radius(&pd(middle), QPPS) < 1.0 { low = middle } else { high = middle }
            }
            let ms = plant.margins(&pd(low), QPPS).ms;
            assert!(ms > 15.0, "{law:?}: at {low} the sensitivity is {ms}");
            let (below, above) = (growth(law, 0.9 * low), growth(law, 1.1 * low));
            assert!(below < 0.5 && above > 1.0, "{law:?}: {low} {below} {above}");
            low
        };
        let edges = (edge_of(plain), edge_of(filtered));
        assert!((edges.0 / edges.1).ln().abs() > 0.2, "{edges:?}");
        let noise = |law: McpLaw| {
            let plant = LoopPlant::new(DiscretePlant::of(&MOTOR, law.tick_s()), &law, LAG);
            plant.margins(&pd(0.3 * edges.1), QPPS).noise_duty
        };
        let quieter = noise(filtered) / noise(plain);
        assert!((0.02..0.4).contains(&quieter), "{quieter}");
    }

    #[test]
    fn one_count_more_in_a_tick_makes_the_duty_that_p_of_the_speed_makes_or_d_of_a_position_alone() {
        let law = McpLaw::default();
        let held = McpHeld::default();
        let velocity = Gains { velocity: Pid { p: 2.0, i: 1.0, d: 0.0 }, ..Gains::default() };
        let near = |found: f64, known: f64| assert!((found / known - 1.0).abs() < 1e-3, "{found} {known}");
        near(law.step_duty(&law.registers(&held, &velocity, QPPS, None)), 2.0 * 300.0 / QPPS);
        let direct = law.registers(&held, &pd(40.0), QPPS, None);
        near(law.step_duty(&direct), 0.03 * 40.0 * 300.0 / QPPS);
        let both = McpRegisters { velocity: law.registers(&held, &velocity, QPPS, None).velocity, ..direct };
        near(law.step_duty(&both), 2.0 * 300.0 / QPPS);
    }
}
