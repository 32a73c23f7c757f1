//! An axis whose load follows the motor without backlash: one inertia.

use super::friction::{DryFriction, slide_one};
use super::linear::{dot, exponential};
use super::params::AxisParams;
use super::step::{MAX_STEP_S, same_step};
use super::travel::Travel;

/// What acts on an axis over one step.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    /// The winding's circuit.
    pub winding: Winding,
    /// Further torque on the motor shaft.
    pub motor_newton_metres: f64,
    /// Torque on the output shaft, positive towards higher positions.
    pub load_newton_metres: f64,
    /// Whether something holds the motor shaft.
    pub locked: bool,
}

/// The winding's circuit over one step.
#[derive(Clone, Copy, Debug)]
pub enum Winding {
    /// Fed with a mean voltage; 0 is a short circuit.
    Driven { volts: f64 },
    /// No current flows.
    Open,
}

impl Winding {
    pub fn volts(self) -> f64 {
        match self {
            Self::Driven { volts } => volts,
            Self::Open => 0.0,
        }
    }
}

/// State and step of a one-inertia axis.
#[derive(Clone, Debug)]
pub struct Rigid {
    pub amps: f64,
    pub motor_radians_per_second: f64,
    pub motor_radians: f64,
    ratio: f64,
    friction: DryFriction,
    travel: Travel,
    /// Sum of the torques of the last step, from which the next step's charge is predicted.
    last_newton_metres: f64,
    model: Model,
    maps: Maps,
}

/// The figures the linear equations are made of.
#[derive(Clone, Copy, Debug)]
struct Model {
    ohms: f64,
    henries: f64,
    torque_constant: f64,
    back_emf: f64,
    inertia: f64,
    viscous: f64,
}

/// The exact step of length `dt_s`: what the state becomes, as rows over (amps, speed, volts, newton metres).
#[derive(Clone, Copy, Debug)]
struct StepMap {
    amps: [f64; 4],
    speed: [f64; 4],
    coulombs: [f64; 4],
    radians: [f64; 4],
}

#[derive(Clone, Copy, Debug)]
struct Maps {
    dt_s: f64,
    driven: StepMap,
    open: StepMap,
    /// Driven, with the shaft held at rest.
    held: StepMap,
}

impl Rigid {
    pub fn new(params: &AxisParams) -> Self {
        let friction = params.total_friction();
        let model = Model {
            ohms: params.motor.armature_ohms,
            henries: effective_henries(params),
            torque_constant: params.motor.torque_constant_newton_metres_per_amp,
            back_emf: params.motor.back_emf_volts_per_radian_per_second,
            inertia: params.total_inertia_kilogram_square_metres(),
            viscous: friction.viscous_newton_metre_seconds_per_radian,
        };
        Self {
            amps: 0.0,
            motor_radians_per_second: 0.0,
            motor_radians: 0.0,
            ratio: params.gear.ratio,
            friction: DryFriction::new(&friction),
            travel: Travel::new(params.load.travel),
            last_newton_metres: 0.0,
            model,
            maps: model.maps(MAX_STEP_S),
        }
    }

    /// How fast its quickest swing turns in its phase.
    pub fn fastest_radians_per_second(&self) -> f64 {
        let m = &self.model;
        (m.torque_constant * m.back_emf / (m.henries * m.inertia)).sqrt()
    }

    pub fn load_radians(&self) -> f64 {
        self.motor_radians / self.ratio
    }

    pub fn load_radians_per_second(&self) -> f64 {
        self.motor_radians_per_second / self.ratio
    }

    /// The charge that would flow through a driven winding over the next step: (at no volts, more per volt).
    pub fn charge_line(&mut self, dt_s: f64) -> (f64, f64) {
        self.learn(dt_s);
        let row = &self.maps.driven.coulombs;
        let at_rest = [self.amps, self.motor_radians_per_second, 0.0, self.last_newton_metres];
        (dot(row, &at_rest), row[2])
    }

    /// Advances by `dt_s` and returns the charge that flowed.
    pub fn step(&mut self, push: Push, dt_s: f64) -> f64 {
        self.learn(dt_s);
        let torque = push.motor_newton_metres + push.load_newton_metres / self.ratio;
        let may_stay = push.locked || self.motor_radians_per_second == 0.0;
        let stayed = if may_stay { self.stay(push, torque) } else { None };
        stayed.unwrap_or_else(|| self.turn(push, torque, dt_s))
    }

    /// A step at rest, unless the shaft breaks away in it.
    fn stay(&mut self, push: Push, torque: f64) -> Option<f64> {
        let start = [self.amps, 0.0, push.winding.volts(), 0.0];
        let (amps, coulombs) = match push.winding {
            Winding::Driven { .. } => {
                (dot(&self.maps.held.amps, &start), dot(&self.maps.held.coulombs, &start))
            }
            Winding::Open => (self.amps, 0.0),
        };
        let load_radians = self.load_radians();
        let (lower, upper) = self.travel.on_hard_stop(load_radians);
        let bounds = self.friction.at_rest().with_stops(lower, upper);
        let others = torque + self.travel.resting_torque(load_radians) / self.ratio;
        let holds = |amps: f64| bounds.contains(-(self.model.torque_constant * amps + others));
        let breaks_away = !(holds(self.amps) && holds(amps));
        if breaks_away && !push.locked {
            return None;
        }
        self.last_newton_metres = -self.model.torque_constant * amps;
        self.amps = amps;
        self.motor_radians_per_second = 0.0;
        Some(coulombs)
    }

    fn turn(&mut self, push: Push, mut torque: f64, dt_s: f64) -> f64 {
        let map = match push.winding {
            Winding::Driven { .. } => &self.maps.driven,
            Winding::Open => &self.maps.open,
        };
        let start = [self.amps, self.motor_radians_per_second, push.winding.volts(), torque];
        let gain = map.speed[3];
        let mut free = dot(&map.speed, &start);
        let spring = self.travel.spring_torque(
            self.load_radians(),
            free / self.ratio,
            gain / (self.ratio * self.ratio),
            dt_s,
        ) / self.ratio;
        torque += spring;
        free += gain * spring;
        let (friction, rests) = slide_one(free, gain, self.friction.sliding());
        torque += friction;
        let inputs = [start[0], start[1], start[2], torque];
        let coulombs = dot(&map.coulombs, &inputs);
        self.motor_radians += dot(&map.radians, &inputs);
        self.amps = dot(&map.amps, &inputs);
        self.motor_radians_per_second = if rests { 0.0 } else { dot(&map.speed, &inputs) };
        self.last_newton_metres = torque;
        self.stop_at_end();
        coulombs
    }

    fn stop_at_end(&mut self) {
        if let Some(load_radians) = self.travel.beyond_hard_stop(self.load_radians()) {
            self.motor_radians = load_radians * self.ratio;
            self.motor_radians_per_second = 0.0;
        }
    }

    fn learn(&mut self, dt_s: f64) {
        if !same_step(self.maps.dt_s, dt_s) {
            self.maps = self.model.maps(dt_s);
        }
    }
}

impl Model {
    fn maps(&self, dt_s: f64) -> Maps {
        Maps {
            dt_s,
            driven: self.map(true, true, dt_s),
            open: self.map(false, true, dt_s),
            held: self.map(true, false, dt_s),
        }
    }

    fn map(&self, driven: bool, turns: bool, dt_s: f64) -> StepMap {
        // Rows and columns: amps, speed, charge, angle; volts, newton metres (constant over the step).
        let mut a = [[0.0; 6]; 6];
        if driven {
            a[0] =
                [-self.ohms / self.henries, -self.back_emf / self.henries, 0.0, 0.0, 1.0 / self.henries, 0.0];
        }
        if turns {
            a[1][0] = self.torque_constant / self.inertia;
            a[1][1] = -self.viscous / self.inertia;
            a[1][5] = 1.0 / self.inertia;
        }
        a[2][0] = 1.0;
        a[3][1] = 1.0;
        let e = exponential(&a.map(|row| row.map(|x| x * dt_s)));
        let row = |n: usize| [e[n][0], e[n][1], e[n][4], e[n][5]];
        StepMap { amps: row(0), speed: row(1), coulombs: row(2), radians: row(3) }
    }
}

/// The inductance, or one so small that the current follows within a microsecond where there is none.
pub fn effective_henries(params: &AxisParams) -> f64 {
    params.motor.armature_henries.max(params.motor.armature_ohms * 1e-6)
}
