//! The closed loop: the PID of the manual on counts, every 5 ms or every 500 us (Motion Mind manual 3.11 to 3.14, 6.3).

use super::assumed::INTEGRAL_LIMIT;
use super::store::Store;
use brushwork_motion_mind_wire::register_number as number;
use brushwork_motion_mind_wire::{function, function2};

/// Full drive.
pub const FULL_DUTY: i64 = 1023;

/// What the loop is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Goal {
    /// Be at a position.
    Position(i64),
    /// Turn at a velocity, counts per loop.
    Velocity(i64),
    /// Nothing: no drive.
    #[default]
    Idle,
}

/// The state of the loop.
#[derive(Clone, Debug, Default)]
pub struct Loop {
    goal: Goal,
    /// Where the motor should be now: it runs ahead of the motor on the way to a goal.
    setpoint: i64,
    sum: i64,
    last_error: i64,
    /// Drive of the last loop, which NEWVELMODE adds to.
    output: i64,
    is_saturated: bool,
}

/// The end of a way from `now` to `target`: a virtual limit that lies before it stops it there (Motion Mind manual, registers 23 and 24: "if
/// the VPLIMIT is set for +10000, and the controller is directed to move to +20000, it will be forced to stop at +10000"). Assumed: what
/// stands beyond a limit already may come back and goes no further out, and a move at a velocity, which has no end, loses its drive at the
/// limit.
fn within_virtual_limits(store: &Store, target: i64, now: i64) -> i64 {
    if !store.has(function::VIRTLIMIT) {
        return target;
    }
    let (lowest, highest) = (store.get(number::VNLIMIT).min(now), store.get(number::VPLIMIT).max(now));
    target.max(lowest).min(highest)
}

/// What one turn of the loop gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Turn {
    /// Drive, -1023 to 1023, before PWMLIMIT.
    pub duty: i64,
    /// Whether the motor is where it should be.
    pub in_position: bool,
}

impl Loop {
    /// What it is to do from now on, from a motor that is at `position`. The integral starts anew.
    pub fn aim(&mut self, goal: Goal, position: i64) {
        let was_velocity = matches!(self.goal, Goal::Velocity(_));
        let is_velocity = matches!(goal, Goal::Velocity(_));
        if !(was_velocity && is_velocity) {
            *self = Self { setpoint: position, ..Self::default() };
        }
        self.goal = goal;
    }

    /// Lets the goal follow an input, without a new start of the integral.
    pub fn follow(&mut self, target: i64, position: i64) {
        match self.goal {
            Goal::Position(_) => self.goal = Goal::Position(target),
            Goal::Velocity(_) | Goal::Idle => self.aim(Goal::Position(target), position),
        }
    }

    /// What it is to do.
    pub fn goal(&self) -> Goal {
        self.goal
    }

    /// DESIREDPOSITION.
    pub fn desired(&self, store: &Store) -> i64 {
        match self.goal {
            Goal::Position(position) => position,
            Goal::Velocity(velocity) if store.has2(function2::NEWVELMODE) => velocity,
            Goal::Velocity(_) | Goal::Idle => self.setpoint,
        }
    }

    /// What the limits leave of the last drive is told back, so that SATPROT can stop the sum.
    pub fn note_limit(&mut self, duty: i64, pwm_limit: i64) {
        self.is_saturated = self.output.abs() >= pwm_limit;
        self.output = duty;
    }

    /// One turn of the loop.
    pub fn turn(&mut self, store: &Store, position: i64, velocity: i64) -> Turn {
        let (wanted_velocity, is_incremental) = self.advance_setpoint(store);
        let turn = match self.goal {
            Goal::Idle => {
                self.setpoint = position;
                Turn::default()
            }
            _ if is_incremental => {
                let step = self.pid(store, wanted_velocity - velocity);
                Turn { duty: self.output + step, in_position: wanted_velocity == velocity }
            }
            Goal::Position(_) | Goal::Velocity(_) => {
                let error = self.setpoint - position;
                let feed_forward = wanted_velocity * store.get(number::VELOCITYFF) / 255;
                let duty = self.pid(store, error) + feed_forward;
                self.with_dead_band(store, position, duty)
            }
        };
        let duty = if store.has(function::DISABLEPID) { 0 } else { turn.duty.clamp(-FULL_DUTY, FULL_DUTY) };
        self.output = duty;
        Turn { duty, ..turn }
    }

    /// Moves the setpoint towards the goal. Gives the velocity it moves at, and whether the loop works on velocity alone.
    fn advance_setpoint(&mut self, store: &Store) -> (i64, bool) {
        match self.goal {
            Goal::Idle => (0, false),
            Goal::Velocity(velocity) if store.has2(function2::NEWVELMODE) => (velocity, true),
            Goal::Velocity(velocity) => {
                self.setpoint += velocity;
                (velocity, false)
            }
            Goal::Position(target) => {
                let end = within_virtual_limits(store, target, self.setpoint);
                if !store.has(function::VELLIMIT) {
                    self.setpoint = end;
                    return (0, false);
                }
                let limit = store.get(number::VELOCITYLIMIT).max(0);
                let step = (end - self.setpoint).clamp(-limit, limit);
                self.setpoint += step;
                (step, false)
            }
        }
    }

    fn with_dead_band(&self, store: &Store, position: i64, duty: i64) -> Turn {
        let Goal::Position(target) = self.goal else { return Turn { duty, in_position: false } };
        let away = (target - position).abs();
        if store.has(function::ENABLEDB) && away <= store.get(number::DEADBAND) {
            return Turn { duty: 0, in_position: true };
        }
        Turn { duty, in_position: away == 0 }
    }

    /// (P e + I sum(e) + D de) / 2^PIDSCALAR.
    fn pid(&mut self, store: &Store, error: i64) -> i64 {
        let is_protected = store.has(function::SATPROT);
        if !(is_protected && self.is_saturated) {
            let limit = INTEGRAL_LIMIT[usize::from(!is_protected)];
            self.sum = (self.sum + error).clamp(-limit, limit);
        }
        let change = error - std::mem::replace(&mut self.last_error, error);
        let out = store.get(number::PTERM) * error
            + store.get(number::ITERM) * self.sum
            + store.get(number::DTERM) * change;
        let divisor = 1_i64 << store.get(number::PIDSCALAR).clamp(0, 32);
        out / divisor
    }
}
