//! What a design is asked for and what it gives.

use crate::law::Law;
use crate::model::{Gains, Lag, PlantModel};
use crate::score::Score;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// What a level asks of a design.
    TASK: Thresholds {
        /// Noise of the duty that a design of the default level 50 may have, as a share of full duty.
        usual_noise: f64 = 0.08,
        /// Noise that level 100 may have, as a multiple of that of level 0: half the usual noise at 0, twice as much at 100.
        noise_ratio: f64 = 4.0,
        /// Maximum sensitivity (Ms) of level 0. With 2.0 at level 100 that is the range that Astrom and Murray call reasonable ("Feedback Systems", 2nd edition, section
        /// 10.3).
        softest_ms: f64 = 1.2,
        /// What each step of the level adds to the maximum sensitivity.
        ms_per_level: f64 = 0.008,
    }
}

/// How far a design may go.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// Highest maximum sensitivity.
    pub ms: f64,
    /// Highest duty noise from the rounding of counts, root mean square.
    pub noise_duty: f64,
}

impl Goal {
    /// The goal of a level from 0 (soft) to 100 (stiff); 50 is the default.
    #[must_use]
    pub fn of_level(level: f64) -> Self {
        let level = level.clamp(0.0, 100.0);
        Self {
            ms: TASK.softest_ms + TASK.ms_per_level * level,
            noise_duty: TASK.usual_noise * TASK.noise_ratio.powf((level - 50.0) / 100.0),
        }
    }

    /// How much stiffer than the default a level is in all that has no bound of its own: 0.7 to 1.4.
    pub(crate) fn pace(&self) -> f64 {
        (self.noise_duty / TASK.usual_noise).sqrt()
    }
}

/// What a design is made for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Task<L: Law> {
    /// The motor.
    pub plant: PlantModel,
    /// How well the friction of the motor is known, as a standard deviation of its duty; 0 where it is taken to be known.
    #[serde(default)]
    pub sd_coulomb_duty: f64,
    /// The controller.
    pub law: L,
    /// The lag beyond hold and count difference: the most likely one.
    pub lag: Lag,
    /// The largest lag that is still likely; the sensitivity is bounded with this one too.
    pub worst_lag: Lag,
    /// Speed at full duty, counts/s.
    pub qpps: f64,
    /// How far to go.
    pub goal: Goal,
    /// What the measured duty noise is to the predicted one.
    pub noise_factor: f64,
    /// Backlash of the mechanics, counts.
    #[serde(rename = "slack_counts")]
    pub backlash_counts: f64,
    /// Shortest integral time of the velocity loop, s: backlash turns a quick integral into a limit cycle.
    pub least_integral_s: f64,
    /// Overshoot of a speed step beyond which the cost jumps, over the step.
    pub most_overshoot: f64,
    /// Highest [`Gains::speed_gain`], where the machine has shown one: a springy shaft that oscillates far above what the loop controls is stirred by that gain alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub most_speed_gain: Option<f64>,
}

impl<L: Law> Task<L> {
    /// That of a motor without backlash and of a lag that is known, at the usual level.
    #[must_use]
    pub fn new(plant: PlantModel, law: L, lag: Lag, qpps: f64) -> Self {
        Self {
            plant,
            sd_coulomb_duty: 0.0,
            law,
            lag,
            worst_lag: lag,
            qpps,
            goal: Goal::of_level(50.0),
            noise_factor: 1.0,
            backlash_counts: 0.0,
            least_integral_s: 0.0,
            most_overshoot: USUAL_OVERSHOOT,
            most_speed_gain: None,
        }
    }
}

/// The overshoot of a speed step that a well-known motor may be designed for.
pub const USUAL_OVERSHOOT: f64 = 0.20;

/// Gains and what they promise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// The gains.
    pub gains: Gains,
    /// Predicted response.
    pub score: Score,
    /// Predicted maximum sensitivity.
    pub ms: f64,
    /// Predicted duty noise.
    pub noise_duty: f64,
}
