//! The design of a method, and how it enters the report as registers.

use crate::design::{Design, Task, design_pd, design_pid, design_piv, design_velocity};
use crate::linear::{DiscretePlant, LoopPlant};
use crate::registers::{position_registers, velocity_registers};
use crate::report::Report;
use crate::request::{Method, Request};

/// The design of a method.
#[must_use]
pub fn design_for(method: Method, task: &Task) -> Option<Design> {
    match method {
        Method::Velocity => design_velocity(task),
        Method::Pd => design_pd(task),
        Method::Pid => design_pid(task),
        Method::Piv => design_piv(task),
    }
}

/// Puts a design into the report, as the registers will hold it.
pub fn propose(
    report: &mut Report,
    request: &Request,
    task: &Task,
    design: Design,
    travel: Option<(i64, i64)>,
) {
    let law = &request.law;
    if let (Some(unit), Some(mind)) = (report.before.and_then(|setup| setup.motion_mind), law.motion_mind) {
        report.motion_mind = Some(unit.registers.with(&design.gains, task.qpps, mind));
        report.design = Some(as_loop(task, design));
        return;
    }
    report.velocity = Some(velocity_registers(&design.gains.velocity, task.qpps, law));
    let before = report.before.map_or((0, 0), |setup| (setup.position.min, setup.position.max));
    let travel = match travel {
        Some((low, high)) => (clamp(low), clamp(high)),
        None if before == (0, 0) => (-2_000_000_000, 2_000_000_000),
        None => before,
    };
    report.position = design.gains.position.is_some().then(|| position_registers(&design.gains, law, travel));
    report.design = Some(as_loop(task, design));
}

/// A design with the sensitivity that its gains have as they are.
fn as_loop(task: &Task, design: Design) -> Design {
    let gains = task.law.rounded(&design.gains, task.qpps);
    let plant = LoopPlant::new(DiscretePlant::of(&task.plant, task.law.tick_s()), &task.law, task.lag);
    Design { gains, ms: plant.margins(&gains, task.qpps).ms, ..design }
}

fn clamp(counts: i64) -> i32 {
    counts.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}
