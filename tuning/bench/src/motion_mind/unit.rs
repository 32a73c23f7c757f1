//! A Motion Mind on the bench: its axis over frames or lines, its registers, and what faults do not apply to it.

use super::line::MindLine;
use super::population::{MindSetup, MindSpecimen, specimen};
use super::trial::{Machine, TICK};
use crate::line::SimulatedLine;
use crate::optimum::{Optima, Optimum};
use crate::trial::Outcome;
use crate::truth::{Truth, full_speed, truth_under};
use crate::unit::{UnderTest, Unit};
use brushwork_motion_mind_axis::MindAxis;
use brushwork_motion_mind_axis::law::{MotionMindLaw, MotionMindProposal, MotionMindRegisters};
use brushwork_motion_mind_sim::MotionMind;
use brushwork_tuning::model::{Gains, Lag};
use brushwork_tuning::tune::Method;
use serde::{Deserialize, Serialize};

/// Registers of a fresh unit that the gains do not touch.
const FACTORY: MotionMindRegisters = MotionMindRegisters {
    pterm: 6000,
    iterm: 35,
    dterm: 0,
    pidscalar: 14,
    velocity_ff: 128,
    deadband: 15,
    function: 0,
    function2: 0,
    virtual_limits: (-100_000, 100_000),
};

/// The optima of one plant: velocity, PD, PID. There is no cascade in this family.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MindOptima([Option<Optimum>; 3]);

impl Optima for MindOptima {
    fn worked_out(of: impl Fn(Method) -> Option<Optimum>) -> Self {
        Self([Method::Velocity, Method::Pd, Method::Pid].map(of))
    }

    fn of(&self, method: Method) -> Option<Optimum> {
        match method {
            Method::Velocity => self.0[0],
            Method::Pd => self.0[1],
            Method::Pid => self.0[2],
            Method::Piv => None,
        }
    }
}

impl Unit for MindSetup {
    type Law = MotionMindLaw;
    type Axis = MindAxis<MindLine>;
    type Machine = MotionMind;
    type Fresh = MotionMind;
    type Optima = MindOptima;
    const TASKS: &'static [(&'static str, Method)] =
        &[("velocity", Method::Velocity), ("pd", Method::Pd), ("pid", Method::Pid)];
    const WHOLE: [Method; 2] = [Method::Velocity, Method::Pd];
    const REPORTS_VOLTS: bool = false;
    /// The unit has no time-out: the motor runs up to the fence, half a second of it at its speed.
    const LINK_DEADLINE_S: f64 = 1.0;

    fn specimen(seed: u64, number: usize) -> MindSpecimen {
        specimen(seed, number)
    }

    fn known(seed: u64) -> &'static str {
        match seed {
            7 => include_str!("../../oracle/motion-mind-7.json"),
            11 => include_str!("../../oracle/motion-mind-11.json"),
            _ => "",
        }
    }

    fn truth(specimen: &MindSpecimen) -> Truth<MotionMindLaw> {
        truth_under(specimen, MotionMindLaw::of_qpps(full_speed(specimen)), Lag::default())
    }

    fn axis(specimen: &MindSpecimen) -> Self::Axis {
        MindAxis::new(MindLine::new(specimen))
    }

    fn line(axis: &mut Self::Axis) -> &mut SimulatedLine<MotionMind> {
        &mut axis.carrier.line
    }

    fn fresh(specimen: &MindSpecimen) -> MotionMind {
        let mut fresh = specimen.controller();
        // To the beginning of a loop, so that every trial counts the same ones.
        fresh.advance(fresh.now() + TICK);
        fresh
    }

    fn registers(_: &MotionMindLaw, gains: &Gains, qpps: f64) -> MotionMindProposal {
        MotionMindProposal { motion_mind: Some(FACTORY.with(gains, qpps, MotionMindLaw::of_qpps(qpps))) }
    }

    fn factory(truth: &Truth<MotionMindLaw>, method: Method) -> Option<MotionMindProposal> {
        let gains = FACTORY.gains(truth.qpps, method != Method::Velocity);
        let law = MotionMindLaw { velocity_ff: FACTORY.velocity_ff, amps_limit: 0 };
        Some(MotionMindProposal { motion_mind: Some(FACTORY.with(&gains, truth.qpps, law)) })
    }

    fn trial(under_test: &UnderTest<Self>, method: Method, registers: &MotionMindProposal) -> Outcome {
        let machine = Machine::new(under_test, &registers.motion_mind.unwrap_or(FACTORY));
        if method == Method::Velocity { machine.velocity() } else { machine.position() }
    }
}
