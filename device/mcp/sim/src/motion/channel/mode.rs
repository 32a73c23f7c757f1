//! What a channel can be doing, with the state that belongs to it.

use super::super::profile::{Profile, ProfileLimits};
use super::super::ramp::{Rates, stopping_speed};
use super::super::relay::RelayTest;
use super::super::{
    ControlLaw, DistanceMove, MAX_DUTY_ACCELERATION, MotionSettings, PositionMove, PositionTarget,
    ZeroDutyAcceleration,
};
use super::state::ChannelState;

/// The highest duty ramp (MCP manual, command 52).
pub(super) const FASTEST: Rates =
    Rates { rising: Some(MAX_DUTY_ACCELERATION), falling: Some(MAX_DUTY_ACCELERATION) };

#[derive(Clone, Copy, Debug)]
pub(super) enum Mode {
    Coast,
    /// Duty to 0 at the highest rate, and the motor braked there, in torque mode too.
    Stop,
    Duty {
        goal_raw: i32,
        rates: Rates,
    },
    Speed {
        goal: i32,
        acceleration: Option<u32>,
    },
    Distance(DistanceRun),
    Position(PositionRun),
    Relay(RelayTest),
    Home {
        goal_raw: i32,
        rates: Rates,
        ticks_left: u64,
    },
}

impl Mode {
    /// Whether the velocity loop runs.
    pub fn is_closed(&self) -> bool {
        matches!(self, Mode::Speed { .. } | Mode::Distance(_) | Mode::Position(_))
    }

    /// Whether the command has an acceleration, and a deceleration where it can.
    pub fn is_ramped(&self) -> bool {
        match self {
            Mode::Speed { acceleration, .. } => acceleration.is_some(),
            Mode::Distance(run) => run.acceleration.is_some(),
            Mode::Position(run) => run.is_ramped(),
            Mode::Coast | Mode::Stop | Mode::Duty { .. } | Mode::Relay(_) | Mode::Home { .. } => false,
        }
    }

    pub fn describe(&self, raw_counts: i64, state: &mut ChannelState) {
        match self {
            Mode::Coast | Mode::Stop | Mode::Relay(_) => {}
            Mode::Duty { goal_raw, rates } | Mode::Home { goal_raw, rates, .. } => {
                state.target_duty_raw = *goal_raw;
                state.acceleration = rates.rising.unwrap_or(0);
                state.deceleration = rates.falling.unwrap_or(0);
            }
            Mode::Speed { goal, acceleration } => {
                state.target_speed_counts_per_s = *goal;
                state.acceleration = acceleration.unwrap_or(0);
                state.deceleration = state.acceleration;
            }
            Mode::Distance(run) => {
                state.target_speed_counts_per_s = run.speed;
                state.acceleration = run.acceleration.unwrap_or(0);
                state.deceleration = state.acceleration;
                state.distance_active = true;
                state.distance_left_counts = u32::try_from(run.left(raw_counts).max(0)).unwrap_or(u32::MAX);
            }
            Mode::Position(run) => {
                state.position_loop = true;
                state.target_position_counts = run.target;
                state.target_speed_counts_per_s = run.limits.speed as i32;
                state.acceleration = run.rates.rising.unwrap_or(0);
                state.deceleration = run.rates.falling.unwrap_or(0);
            }
        }
    }
}

/// A distance move under way. Assumed: the distance is measured in encoder counts, so that a motor that lags still
/// covers it.
#[derive(Clone, Copy, Debug)]
pub(super) struct DistanceRun {
    /// Signed, counts/s.
    pub speed: i32,
    pub acceleration: Option<u32>,
    distance: i64,
    start: i64,
}

impl DistanceRun {
    pub fn new(distance: &DistanceMove, start: i64) -> Self {
        DistanceRun {
            speed: distance.speed_counts_per_s,
            acceleration: ramp_rate(distance.acceleration),
            distance: i64::from(distance.distance_counts),
            start,
        }
    }

    /// 1 forward, -1 backward, 0 for a move of speed 0.
    pub fn direction(&self) -> i64 {
        i64::from(self.speed.signum())
    }

    /// Counts left; negative when overrun.
    pub fn left(&self, raw_counts: i64) -> i64 {
        self.distance - self.direction() * (raw_counts - self.start)
    }

    /// Raw count at which the move ends.
    pub fn end(&self) -> i64 {
        self.start + self.direction() * self.distance
    }

    /// Highest speed that still stops at the end, counts/s.
    pub fn stopping_speed(&self, raw_counts: i64, tick_s: f64) -> f64 {
        stopping_speed(self.left(raw_counts) as f64, self.acceleration.map(f64::from), tick_s)
    }
}

/// A position move under way, or the position it holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct PositionRun {
    pub profile: Profile,
    pub limits: ProfileLimits,
    pub rates: Rates,
    pub target: i32,
}

impl PositionRun {
    pub fn new(position: &PositionMove, settings: &MotionSettings, position_counts: f64, speed: f64) -> Self {
        let target = settings.clamp_position(match position.target {
            PositionTarget::Counts(counts) => counts,
            PositionTarget::Percent(percent_raw) => settings.percent_position(percent_raw),
        });
        let rates = Rates {
            rising: ramp_rate(Some(position.acceleration.unwrap_or_else(|| settings.default_acceleration()))),
            falling: ramp_rate(Some(
                position.deceleration.unwrap_or_else(|| settings.default_deceleration()),
            )),
        };
        let limits = ProfileLimits {
            speed: f64::from(position.speed_counts_per_s.unwrap_or_else(|| settings.default_speed())),
            acceleration: rates.rising.map(f64::from),
            deceleration: rates.falling.map(f64::from),
        };
        PositionRun {
            profile: Profile::new(limits, f64::from(target), position_counts, speed),
            limits,
            rates,
            target,
        }
    }

    pub fn is_ramped(&self) -> bool {
        self.rates.rising.is_some() && self.rates.falling.is_some()
    }
}

/// An acceleration of 0 is none (MCP manual, `move` example).
pub(super) fn ramp_rate(acceleration: Option<u32>) -> Option<u32> {
    acceleration.filter(|&rate| rate != 0)
}

/// Ramp of a duty command with its own acceleration or the default ones.
pub(super) fn duty_rates(
    acceleration_raw: Option<u32>,
    settings: &MotionSettings,
    law: &ControlLaw,
) -> Rates {
    let rate = |raw: u32| match (raw, law.zero_duty_acceleration) {
        (0, ZeroDutyAcceleration::Fastest) => Some(MAX_DUTY_ACCELERATION),
        (0, ZeroDutyAcceleration::NoRamp) => None,
        (0, ZeroDutyAcceleration::Frozen) => Some(0),
        (raw, _) => Some(raw.min(MAX_DUTY_ACCELERATION)),
    };
    match acceleration_raw {
        Some(raw) => Rates::both(rate(raw)),
        None => Rates { rising: rate(settings.default_accel_raw), falling: rate(settings.default_decel_raw) },
    }
}
