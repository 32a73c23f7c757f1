//! Gains tried on the machine by themselves: the same moves as at the end of a run, under the same guard.

use crate::axis::{Axis, PositionRegisters, VelocityRegisters};
use crate::cause::Cause;
use crate::design::{Design, Task};
use crate::experiment::Probe;
use crate::experiment_guard::ExperimentGuard;
use crate::model::Gains;
use crate::motion_mind::MotionMindRegisters;
use crate::record::{Entry, Recorder};
use crate::registers::{gains_of, velocity_gains};
use crate::report::Measured;
use crate::request::{Excitation, Method, Request};
use crate::verify::{is_rougher, try_position, try_velocity, try_velocity_inside};
use crate::whatif::forecast;
use serde::{Deserialize, Serialize};

/// What is to be tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialRequest {
    /// As the run was asked for: guard, excitation, law.
    pub request: Request,
    /// The model of that run.
    pub task: Task,
    /// Its probe, for the guard.
    pub probe: Probe,
    /// The velocity loop.
    pub velocity: VelocityRegisters,
    /// The position loop, of the methods that have one.
    pub position: Option<PositionRegisters>,
    /// The registers of a Motion Mind, which has neither of the two above.
    pub motion_mind: Option<MotionMindRegisters>,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Why it ended early, or [`Cause::NotVerified`] where the machine was rougher than predicted.
    pub cause: Option<Cause>,
    /// What was measured.
    pub measured: Option<Measured>,
    /// How long it took, s.
    pub seconds: f64,
    /// The raw record.
    pub record: Vec<Entry>,
}

impl TrialRequest {
    /// The gains as the registers hold them.
    #[must_use]
    pub fn gains(&self) -> Gains {
        self.on_model().1
    }

    /// The model with what the registers change of it, and the gains as the registers hold them.
    #[must_use]
    pub fn on_model(&self) -> (Task, Gains) {
        match self.motion_mind {
            Some(registers) => registers.on_model(&self.task, self.request.method != Method::Velocity),
            None => (self.task, registers_gains(&self.velocity, self.position.as_ref(), &self.request)),
        }
    }
}

/// The gains that registers stand for under a request's law.
#[must_use]
pub fn registers_gains(
    velocity: &VelocityRegisters,
    position: Option<&PositionRegisters>,
    request: &Request,
) -> Gains {
    match position {
        Some(position) => gains_of(velocity, position, &request.law),
        None => Gains { velocity: velocity_gains(velocity, &request.law), ..Gains::default() },
    }
}

/// Runs it. The motor stands and the gains from before are in force when it returns.
pub fn run_trial(axis: &mut dyn Axis, wanted: &TrialRequest) -> Trial {
    let mut recorder = Recorder::new(axis);
    let mut trial = Trial { cause: None, measured: None, seconds: 0.0, record: Vec::new() };
    match ExperimentGuard::new(&mut recorder, wanted.request.guard) {
        Err(cause) => trial.cause = Some(cause),
        Ok(mut guard) => {
            guard.progress("Trying the gains on the machine");
            match moves(&mut guard, wanted) {
                Ok((measured, rougher)) => {
                    trial.measured = Some(measured);
                    trial.cause = rougher.then(|| guard.concluded(Cause::NotVerified));
                }
                Err(cause) => {
                    let cause = guard.concluded(cause);
                    guard.leave_off(cause);
                    trial.cause = Some(cause);
                }
            }
            trial.seconds = guard.now_s();
            guard.finish(false);
        }
    }
    trial.record = recorder.into_entries();
    trial
}

fn moves(guard: &mut ExperimentGuard<'_>, wanted: &TrialRequest) -> Result<(Measured, bool), Cause> {
    let (task, gains) = wanted.on_model();
    let shown = forecast(&task, &gains);
    let design = Design { gains, score: shown.score, ms: shown.ms, noise_duty: shown.noise_duty };
    guard.monitor.start_duty = wanted.probe.start_duty;
    guard.monitor.stall_amps = wanted.probe.stall_amps;
    guard.monitor.full_speed = wanted.task.qpps;
    guard.monitor.stopping_s = wanted.task.plant.tau_s;
    guard.monitor.drive_limit = guard.drive_limit(wanted.probe.stall_amps);
    guard.monitor.know(&wanted.task.plant);
    write_loops(guard, wanted)?;
    let measured = if gains.position.is_some() {
        try_position(guard, &wanted.request, &task, &design)?
    } else {
        match wanted.request.excitation {
            Excitation::Free => try_velocity(guard, &task, &gains)?,
            Excitation::Window(width) => try_velocity_inside(guard, &task, &gains, width)?,
        }
    };
    Ok((measured, is_rougher(&design, &measured)))
}

fn write_loops(guard: &mut ExperimentGuard<'_>, wanted: &TrialRequest) -> Result<(), Cause> {
    match wanted.motion_mind {
        Some(registers) if !registers.is_usual_loop() => return Err(Cause::OtherLoop),
        Some(registers) => return guard.write_motion_mind(registers),
        None => {}
    }
    guard.write_velocity(wanted.velocity)?;
    match wanted.position.filter(|_| wanted.request.method != Method::Velocity) {
        Some(position) => guard.write_position(position),
        None => Ok(()),
    }
}
