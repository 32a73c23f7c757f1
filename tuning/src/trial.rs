//! Gains tried on the machine by themselves: the same moves as at the end of a run, under the same guard.

use crate::cause::Cause;
use crate::design::{Design, Task};
use crate::experiment::Probe;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::model::Gains;
use crate::record::{Entry, Recorder};
use crate::report::Measured;
use crate::request::{Excitation, Method, Request};
use crate::setup::LoopAxis;
use crate::verify::{is_rougher, try_position, try_velocity, try_velocity_inside};
use crate::whatif::forecast;
use serde::{Deserialize, Serialize};

/// What is to be tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialRequest<L: Law> {
    /// As the run was asked for: guard, excitation, law.
    pub request: Request<L>,
    /// The model of that run.
    pub task: Task<L>,
    /// Its probe, for the guard.
    pub probe: Probe,
    /// The registers.
    pub registers: L::Registers,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Trial<L: Law> {
    /// Why it ended early, or [`Cause::NotVerified`] where the machine was rougher than predicted.
    pub cause: Option<Cause>,
    /// What was measured.
    pub measured: Option<Measured>,
    /// How long it took, s.
    pub seconds: f64,
    /// The raw record.
    pub record: Vec<Entry<L>>,
}

impl<L: Law> TrialRequest<L> {
    /// The gains as the registers hold them.
    #[must_use]
    pub fn gains(&self) -> Gains {
        self.on_model().1
    }

    /// The model with what the registers change of it, and the gains as the registers hold them.
    #[must_use]
    pub fn on_model(&self) -> (Task<L>, Gains) {
        on_model(&self.task, &self.registers, self.request.method)
    }
}

/// A run's model with what registers change of it, and the gains that they stand for.
#[must_use]
pub fn on_model<L: Law>(task: &Task<L>, registers: &L::Registers, method: Method) -> (Task<L>, Gains) {
    let law = task.law.with_registers(registers);
    (Task { law, ..*task }, law.gains(registers, task.qpps, method != Method::Velocity))
}

/// Runs it. The motor stands and the gains from before are in force when it returns.
pub fn run_trial<L: Law>(
    axis: &mut dyn LoopAxis<L>,
    wanted: &TrialRequest<L>,
    look: &mut dyn FnMut(&Entry<L>),
) -> Trial<L> {
    let mut recorder = Recorder::new(axis, look);
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

fn moves<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    wanted: &TrialRequest<L>,
) -> Result<(Measured, bool), Cause> {
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

fn write_loops<L: Law>(guard: &mut ExperimentGuard<'_, L>, wanted: &TrialRequest<L>) -> Result<(), Cause> {
    L::refuse(&wanted.registers)?;
    guard.write_all(&wanted.registers, wanted.request.method != Method::Velocity)
}
