//! What a tuning run is asked for.

use crate::experiment_guard::GuardOptions;
use crate::law::Law;
use serde::{Deserialize, Serialize};

/// What to tune.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Velocity PI.
    Velocity,
    /// Position PD.
    Pd,
    /// Position PID.
    Pid,
    /// Position P over velocity PI.
    Piv,
}

/// How the motor is identified, and whose gains are proposed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Identification {
    /// A model is fitted to several motions up to full duty; gains are searched for on it.
    #[default]
    Fit,
    /// One step about a set duty; SIMC.
    Step,
    /// A relay about a set speed; Tyreus-Luyben.
    Relay,
    /// The controller's own relay test about a set speed, beside a fitted model; Tyreus-Luyben.
    Controller,
}

/// Duty about which a step or a relay works, where none is asked for.
pub const MIDDLE_DUTY: f64 = 0.5;

fn middle_duty() -> f64 {
    MIDDLE_DUTY
}

/// How the axis may be moved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Excitation {
    /// It turns freely.
    Free,
    /// Within so many counts around where it stands.
    Window(f64),
}

impl Excitation {
    /// Within a travel, from its lower to its upper count, where there is one.
    #[must_use]
    pub fn within(travel: Option<(i64, i64)>) -> Self {
        travel.map_or(Self::Free, |(low, high)| Self::Window((high - low) as f64))
    }
}

/// What is asked of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Request<L: Law> {
    /// The loop.
    pub method: Method,
    /// Whether PID is meant where that is [`Method::Piv`] and the controller has no velocity loop under its position loop.
    #[serde(default)]
    pub or_pid: bool,
    /// How the motor is identified.
    #[serde(default)]
    pub identification: Identification,
    /// Duty about which a step or a relay works, 0 to 1.
    #[serde(default = "middle_duty")]
    pub about_duty: f64,
    /// 0 (soft) to 100 (stiff).
    pub level: f64,
    /// How the axis may be moved.
    pub excitation: Excitation,
    /// The guard.
    pub guard: GuardOptions,
    /// The controller's law, as far as it is not found out.
    pub law: L,
    /// Whether it is found out. The report's request then has what was found.
    #[serde(default)]
    pub probe_law: bool,
    /// Whether the candidate is tried on the machine.
    pub verify: bool,
    /// Whether the new gains stay in force (RAM) at the end.
    pub keep: bool,
}

impl<L: Law> Default for Request<L> {
    fn default() -> Self {
        Self {
            method: Method::Velocity,
            or_pid: false,
            identification: Identification::Fit,
            about_duty: MIDDLE_DUTY,
            level: 50.0,
            excitation: Excitation::Free,
            guard: GuardOptions::default(),
            law: L::default(),
            probe_law: true,
            verify: true,
            keep: false,
        }
    }
}
