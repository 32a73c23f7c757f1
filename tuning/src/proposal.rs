//! The design of a method, and how it enters the report as registers.

use crate::design::{Design, Task, design_pd, design_pid, design_piv, design_velocity};
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::report::Report;
use crate::request::{Method, Request};

/// The design of a method.
#[must_use]
pub fn design_for<L: Law>(method: Method, task: &Task<L>) -> Option<Design> {
    match method {
        Method::Velocity => design_velocity(task),
        Method::Pd => design_pd(task),
        Method::Pid => design_pid(task),
        Method::Piv => design_piv(task),
    }
}

/// Puts a design into the report, as the registers will hold it.
pub fn propose<L: Law>(
    report: &mut Report<L>,
    request: &Request<L>,
    task: &Task<L>,
    design: Design,
    travel: Option<(i64, i64)>,
) {
    report.free_limits = travel.filter(|_| request.guard.travel.is_none());
    let held = report.before.map_or_else(L::Held::default, |setup| setup.held);
    report.proposed = request.law.registers(&held, &design.gains, task.qpps, travel);
    report.design = Some(as_loop(task, design));
}

/// A design with the sensitivity that its gains have as they are.
fn as_loop<L: Law>(task: &Task<L>, design: Design) -> Design {
    let gains = task.law.rounded(&design.gains, task.qpps);
    let plant = LoopPlant::new(DiscretePlant::of(&task.plant, task.law.tick_s()), &task.law, task.lag);
    Design { gains, ms: plant.margins(&gains, task.qpps).ms, ..design }
}
