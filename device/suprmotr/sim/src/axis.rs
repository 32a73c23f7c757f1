//! The axis: target, trajectory and loop, limit switches, the search for an edge, the following error (SuprMotr manual, commands MA to GH).
//!
//! Assumed, where the manual is silent: a limit stops at once and counts as a move error; an error greater than SM switches the motor off, as MF does; a
//! move while the motor is off sets the target alone; DH moves target and trajectory along with the position, so that nothing jumps.

use super::assumed::{DRIVE_STEPS, TICK, TICKS_IN_VELOCITY};
use super::channels::{Channels, Line};
use super::servo::{Bridge, Gains, Servo};
use super::store::Parameters;
use super::trajectory::{Pace, Trajectory};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::world::BridgeSense;
use brushwork_suprmotr_wire::FURTHEST_COUNTS;
use std::collections::VecDeque;

/// Which edge is looked for (SuprMotr manual, command FE).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// FE0: forward until the positive limit is on.
    PositiveOn,
    /// FE1: back until the negative limit is on.
    NegativeOn,
    /// FE4: forward until the negative limit is off.
    NegativeOff,
}

/// A search for an edge.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    edge: Edge,
    /// What the input was when the search began.
    pub was_on: bool,
}

/// The axis of one board.
#[derive(Clone, Debug)]
pub struct Axis {
    is_on: bool,
    servo: Servo,
    bridge: Bridge,
    trajectory: Trajectory,
    target: i64,
    position: i64,
    /// What the encoder read last.
    counted: Option<i64>,
    /// Changes of the position, the newest first.
    changes: VecDeque<i64>,
    search: Option<Search>,
    flags: Flags,
}

/// What the status tells of moves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Flags {
    /// The last move went forward.
    pub is_forward: bool,
    /// It went forward when it began to slow down.
    pub slowed_forward: bool,
    /// A limit or an error cut it short.
    pub move_error: bool,
    /// The position lagged further behind than SM allows.
    pub excessive_error: bool,
}

impl Edge {
    /// The edge of that number.
    pub const fn from_number(number: i64) -> Option<Self> {
        match number {
            0 => Some(Self::PositiveOn),
            1 => Some(Self::NegativeOn),
            4 => Some(Self::NegativeOff),
            _ => None,
        }
    }

    const fn line(self) -> Line {
        match self {
            Self::PositiveOn => Line::Positive,
            Self::NegativeOn | Self::NegativeOff => Line::Negative,
        }
    }

    const fn is_forward(self) -> bool {
        matches!(self, Self::PositiveOn | Self::NegativeOff)
    }

    const fn is_looked_for_on(self) -> bool {
        matches!(self, Self::PositiveOn | Self::NegativeOn)
    }
}

impl Default for Axis {
    /// As after a start: on, at 0, which is where it is.
    fn default() -> Self {
        Self {
            is_on: true,
            servo: Servo::default(),
            bridge: Bridge::default(),
            trajectory: Trajectory::at(0.0),
            target: 0,
            position: 0,
            counted: None,
            changes: VecDeque::new(),
            search: None,
            flags: Flags::default(),
        }
    }
}

impl Axis {
    /// Takes what the encoder reads; the first reading is position 0.
    pub fn sense(&mut self, counts: i64, is_phase_reversed: bool) {
        let last = self.counted.replace(counts).unwrap_or(counts);
        let moved = if is_phase_reversed { last - counts } else { counts - last };
        self.position += moved;
        self.changes.truncate(TICKS_IN_VELOCITY - 1);
        self.changes.push_front(moved);
    }

    /// One tick.
    pub fn tick(&mut self, parameters: &Parameters, channels: &Channels) {
        if !self.is_on {
            return;
        }
        let is_limit_on = |line| channels.is_active(line, parameters.is_active_high);
        if let Some(search) = self.search
            && is_limit_on(search.edge.line()) == search.edge.is_looked_for_on()
        {
            self.stop();
        } else if parameters.has_limits && !self.trajectory.is_complete() {
            let limit = if self.heads_forward() { Line::Positive } else { Line::Negative };
            if is_limit_on(limit) {
                self.stop();
                self.flags.move_error = true;
            }
        }
        let was_slowing = self.trajectory.is_slowing();
        self.trajectory.advance(TICK);
        if self.trajectory.is_slowing() && !was_slowing {
            self.flags.slowed_forward = self.heads_forward();
        }
        let error = self.following_error();
        if error.abs() > i64::from(parameters.most_error) {
            self.switch_off();
            self.flags.excessive_error = true;
            self.flags.move_error = true;
        } else {
            self.servo.turn(&gains(parameters), error);
        }
    }

    /// What the bridge does in the next step of the plant.
    pub fn output(&mut self, sense: BridgeSense) -> BridgeOutput {
        if self.is_on {
            let wanted = self.servo.drive() as f64 / DRIVE_STEPS as f64;
            BridgeOutput::Duty(self.bridge.duty(wanted, sense))
        } else {
            BridgeOutput::Coast
        }
    }

    /// Moves to a place.
    pub fn move_to(&mut self, target: i64, parameters: &Parameters) {
        self.search = None;
        self.head_for(target, parameters);
    }

    /// Looks for an edge; with the motor off there is nothing to look with.
    pub fn find(&mut self, edge: Edge, parameters: &Parameters, channels: &Channels) {
        if !self.is_on {
            return;
        }
        let furthest = i64::from(FURTHEST_COUNTS);
        self.head_for(if edge.is_forward() { furthest } else { -furthest }, parameters);
        let was_on = channels.is_active(edge.line(), parameters.is_active_high);
        self.search = Some(Search { edge, was_on });
    }

    fn head_for(&mut self, target: i64, parameters: &Parameters) {
        self.target = target;
        if !self.is_on {
            self.trajectory = Trajectory::at(target as f64);
            return;
        }
        let from = self.trajectory.point();
        self.trajectory = Trajectory::to(from, target as f64, pace(parameters));
        self.flags.is_forward = target as f64 >= from.counts;
        self.flags.move_error = false;
    }

    /// Stops at once: the target is where the motor is.
    pub fn stop(&mut self) {
        self.search = None;
        self.target = self.position;
        self.trajectory = Trajectory::at(self.position as f64);
    }

    /// Stops with DA: the target is where that ends.
    pub fn slow_to_stop(&mut self, parameters: &Parameters) {
        if !self.is_on || self.trajectory.point().counts_per_s == 0.0 {
            self.stop();
            return;
        }
        self.search = None;
        self.trajectory = Trajectory::to_rest(self.trajectory.point(), pace(parameters).counts_per_s_squared);
        // Whole since it was rounded.
        self.target = self.trajectory.end_counts() as i64;
    }

    /// Lets the motor go; the target stays, but for a search, which has none.
    pub fn switch_off(&mut self) {
        if self.search.take().is_some() {
            self.target = self.position;
        }
        self.is_on = false;
        self.servo.release();
        self.trajectory = Trajectory::at(self.target as f64);
    }

    /// Holds the motor at the target that it had when it was let go.
    pub fn switch_on(&mut self) {
        if !self.is_on {
            self.is_on = true;
            self.flags.excessive_error = false;
        }
    }

    /// The position here is 0.
    pub fn define_home(&mut self) {
        let moved = -self.position;
        self.position = 0;
        self.target += moved;
        self.trajectory.shift(moved as f64);
    }

    /// Whether the loop is on.
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    /// Whether no move is in process.
    pub fn is_complete(&self) -> bool {
        !self.is_on || self.trajectory.is_complete()
    }

    /// What the status tells.
    pub fn flags(&self) -> Flags {
        self.flags
    }

    /// The search, while there is one.
    pub fn search(&self) -> Option<Search> {
        self.search
    }

    /// In counts.
    pub fn position(&self) -> i64 {
        self.position
    }

    /// In counts.
    pub fn target(&self) -> i64 {
        self.target
    }

    /// Where the trajectory is, in counts.
    pub fn dynamic_target(&self) -> i64 {
        self.trajectory.point().counts.round() as i64
    }

    /// How far the position lags behind the trajectory, in counts.
    pub fn following_error(&self) -> i64 {
        self.dynamic_target() - self.position
    }

    /// In counts per second, as a mean of some ticks.
    pub fn velocity(&self) -> i64 {
        let per_tick_s = TICK.as_secs_f64() * (self.changes.len() as f64).max(1.0);
        (self.changes.iter().sum::<i64>() as f64 / per_tick_s).round() as i64
    }

    /// What the loop gives, in steps of the bridge.
    pub fn drive(&self) -> i64 {
        self.servo.drive()
    }

    fn heads_forward(&self) -> bool {
        let point = self.trajectory.point();
        let way = if point.counts_per_s == 0.0 {
            self.trajectory.end_counts() - point.counts
        } else {
            point.counts_per_s
        };
        way > 0.0
    }
}

fn pace(parameters: &Parameters) -> Pace {
    Pace { counts_per_s: parameters.velocity.into(), counts_per_s_squared: parameters.acceleration.into() }
}

fn gains(parameters: &Parameters) -> Gains {
    Gains {
        proportional: parameters.proportional.into(),
        integral: parameters.integral.into(),
        derivative: parameters.derivative.into(),
        integral_limit: parameters.integral_limit.into(),
        most_drive: parameters.torque.into(),
    }
}
