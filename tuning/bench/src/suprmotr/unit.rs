//! A SuprMotr on the bench: its axis over lines, its registers.

use super::line::BoardLine;
use super::population::{BoardSetup, BoardSpecimen, specimen};
use super::trial::Machine;
use crate::line::SimulatedLine;
use crate::optimum::{Optima, Optimum};
use crate::trial::Outcome;
use crate::truth::{Truth, truth_under};
use crate::unit::{UnderTest, Unit};
use brushwork_suprmotr_axis::SuprMotrAxis;
use brushwork_suprmotr_axis::law::{SuprMotrLaw, SuprMotrProposal, SuprMotrRegisters};
use brushwork_suprmotr_sim::SuprMotr;
use brushwork_suprmotr_sim::assumed::TICK;
use brushwork_tuning::law::Law;
use brushwork_tuning::model::{Gains, Lag};
use brushwork_tuning::tune::Method;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The gains of a board from the factory (SuprMotr manual, "Factory Settings").
const FACTORY: SuprMotrRegisters = SuprMotrRegisters { p: 75, i: 0, d: 0, integral_limit: 100 };

/// The optima of one plant: PD, PID. There is no other loop in this family.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoardOptima([Option<Optimum>; 2]);

impl Optima for BoardOptima {
    fn worked_out(of: impl Fn(Method) -> Option<Optimum>) -> Self {
        Self([Method::Pd, Method::Pid].map(of))
    }

    fn of(&self, method: Method) -> Option<Optimum> {
        match method {
            Method::Pd => self.0[0],
            Method::Pid => self.0[1],
            Method::Velocity | Method::Piv => None,
        }
    }
}

impl Unit for BoardSetup {
    type Law = SuprMotrLaw;
    type Axis = SuprMotrAxis<BoardLine>;
    type Machine = SuprMotr;
    type Fresh = SuprMotr;
    type Optima = BoardOptima;
    const TASKS: &'static [(&'static str, Method)] = &[("pd", Method::Pd), ("pid", Method::Pid)];
    const WHOLE: [Method; 2] = [Method::Pd, Method::Pid];
    const REPORTS_VOLTS: bool = false;
    /// The board has no time-out: a move ends at its target, at a limit switch, or by SM.
    const LINK_DEADLINE_S: f64 = f64::INFINITY;

    fn specimen(seed: u64, number: usize) -> BoardSpecimen {
        specimen(seed, number)
    }

    fn known(_: u64) -> &'static str {
        ""
    }

    fn truth(specimen: &BoardSpecimen) -> Truth<SuprMotrLaw> {
        let turns_per_s = (1.0 / TICK.as_secs_f64()).round() as u32;
        truth_under(specimen, SuprMotrLaw::default().at_rate(turns_per_s), Lag::default())
    }

    fn axis(specimen: &BoardSpecimen) -> Self::Axis {
        SuprMotrAxis::new(BoardLine::new(specimen))
    }

    fn line(axis: &mut Self::Axis) -> &mut SimulatedLine<SuprMotr> {
        &mut axis.carrier.line
    }

    fn fresh(specimen: &BoardSpecimen) -> SuprMotr {
        let mut fresh = specimen.controller();
        fresh.advance(fresh.now() + Duration::from_millis(500));
        fresh
    }

    fn registers(law: &SuprMotrLaw, gains: &Gains, qpps: f64) -> SuprMotrProposal {
        SuprMotrProposal { suprmotr: Some(SuprMotrRegisters::of(gains, qpps, law.tick_s())) }
    }

    fn factory(_: &Truth<SuprMotrLaw>, _: Method) -> Option<SuprMotrProposal> {
        Some(SuprMotrProposal { suprmotr: Some(FACTORY) })
    }

    fn trial(under_test: &UnderTest<Self>, _: Method, registers: &SuprMotrProposal) -> Outcome {
        Machine::new(under_test, &registers.suprmotr.unwrap_or(FACTORY)).position()
    }
}
