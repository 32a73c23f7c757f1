//! Every threshold of the tuner, and how one of them is changed: what a sensitivity run of the bench asks for.
//!
//! What moves with which is in MEASURED.md, "Sensitivity". The program itself never changes one.

use crate::thresholds::{SCALED, Threshold};

macro_rules! listed {
    ($($stage:path),+ $(,)?) => {
        [$(<$stage>::listed()),+].concat()
    };
}

/// All of them, stage by stage.
#[must_use]
pub fn thresholds() -> Vec<Threshold> {
    use crate::{
        alternatives, closed_loop_monitor, closed_loop_record, current_silence, design, diagnosis,
        experiment, experiment_guard, fit, lag, law_probe, load_change, margin, model, motor_monitor, moves,
        open_loop_record, oscillation, pace, promise, response, rules, settle, step, trajectory, tune,
        verify, winding, windup,
    };
    listed![
        alternatives::Thresholds,
        closed_loop_monitor::Thresholds,
        closed_loop_record::Thresholds,
        current_silence::Thresholds,
        design::binding::Thresholds,
        design::position::Thresholds,
        design::search::Thresholds,
        design::task::Thresholds,
        design::velocity::Thresholds,
        diagnosis::Thresholds,
        experiment::backlash::Thresholds,
        experiment::free::Thresholds,
        experiment::limit_cycle::Thresholds,
        experiment::own_test::Thresholds,
        experiment::position_relay::Thresholds,
        experiment::probe::Thresholds,
        experiment::relay::Thresholds,
        experiment::step::Thresholds,
        experiment::window::Thresholds,
        experiment_guard::Thresholds,
        experiment_guard::evidence::Thresholds,
        experiment_guard::polling::Thresholds,
        experiment_guard::silence::Thresholds,
        experiment_guard::travel::Thresholds,
        experiment_guard::ways_out::Thresholds,
        fit::Thresholds,
        lag::FlankThresholds,
        lag::LagPriors,
        lag::LagWidths,
        lag::Thresholds,
        law_probe::Thresholds,
        load_change::Thresholds,
        margin::Thresholds,
        model::Thresholds,
        motor_monitor::Thresholds,
        moves::Thresholds,
        moves::experiment::Thresholds,
        moves::fit::Thresholds,
        open_loop_record::Thresholds,
        oscillation::Thresholds,
        pace::Thresholds,
        promise::Thresholds,
        promise::Widths,
        response::Thresholds,
        rules::Thresholds,
        settle::Thresholds,
        step::Thresholds,
        trajectory::Thresholds,
        tune::Thresholds,
        verify::Thresholds,
        winding::Thresholds,
        windup::Thresholds,
    ]
}

/// Multiplies one threshold by `by` for the rest of this process; a whole number moves by one at least. To be called before anything is tuned, since what a stage
/// has read it keeps.
///
/// # Errors
/// A sentence when there is no such threshold, or when one was changed before.
pub fn scale(stage: &str, name: &str, by: f64) -> Result<(), String> {
    SCALED
        .set((stage.to_owned(), name.to_owned(), by))
        .map_err(|_| format!("{stage}.{name} was not changed: only one threshold can be changed in a run"))?;
    let is_known = thresholds().iter().any(|each| each.stage == stage && each.name == name);
    is_known.then_some(()).ok_or_else(|| format!("There is no threshold {stage}.{name}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_two_thresholds_have_one_name() {
        let all = thresholds();
        let names: BTreeSet<(&str, &str)> = all.iter().map(|each| (each.stage, each.name)).collect();
        assert_eq!(names.len(), all.len());
    }
}
