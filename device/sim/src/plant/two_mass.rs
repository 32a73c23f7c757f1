//! An axis whose load is a second mass behind teeth with play, a springy shaft, or both.
//!
//! While the teeth touch, motor and load are joined by spring and damper; in the gap they move alone. Both are linear, so each
//! has its exact step. A step in which the teeth would meet or part is taken again in eighths, so that the spring neither wins
//! nor loses noticeable energy at the change. The damper acts as long as the teeth touch, so it can pull for an instant before
//! they part.

use super::friction::{Bounds, DryFriction, hold_two};
use super::linear::{dot, exponential};
use super::params::{AxisParams, CouplingParams};
use super::rigid::{Push, Winding, effective_henries};
use super::same_step;
use super::travel::Travel;

/// Assumed: the resonance of motor and load through the teeth where a gear has backlash and no coupling is given.
const TEETH_RESONANCE_HERTZ: f64 = 150.0;
/// Assumed: damping of that resonance over critical damping.
const TEETH_DAMPING_RATIO: f64 = 0.2;
/// Parts a step is cut into when the teeth meet or part in it.
const EVENT_PARTS: u8 = 8;

/// State and step of a two-inertia axis.
#[derive(Clone, Debug)]
pub struct TwoMass {
    state: State,
    ratio: f64,
    half_backlash: f64,
    motor_friction: DryFriction,
    load_friction: DryFriction,
    travel: Travel,
    model: Model,
    whole: Maps,
    part: Maps,
}

#[derive(Clone, Copy, Debug)]
struct State {
    amps: f64,
    motor_speed: f64,
    load_speed: f64,
    motor_radians: f64,
    load_radians: f64,
    /// Angle of the gear output ahead of the load.
    twist: f64,
    last_motor_newton_metres: f64,
    last_load_newton_metres: f64,
}

#[derive(Clone, Copy, Debug)]
struct Model {
    ohms: f64,
    henries: f64,
    torque_constant: f64,
    back_emf: f64,
    ratio: f64,
    motor_inertia: f64,
    motor_viscous: f64,
    load_inertia: f64,
    load_viscous: f64,
    coupling: CouplingParams,
}

/// What the state becomes, as rows over (amps, motor speed, load speed, twist, volts, motor torque, load torque).
#[derive(Clone, Copy, Debug)]
struct StepMap {
    amps: [f64; 7],
    motor_speed: [f64; 7],
    load_speed: [f64; 7],
    twist: [f64; 7],
    coulombs: [f64; 7],
    motor_radians: [f64; 7],
}

/// The steps of one length: by winding (driven, open) and teeth (touching, apart).
#[derive(Clone, Copy, Debug)]
struct Maps {
    dt_s: f64,
    driven: [StepMap; 2],
    open: [StepMap; 2],
}

impl TwoMass {
    pub fn new(params: &AxisParams) -> Self {
        let teeth = || CouplingParams::with_resonance(params, TEETH_RESONANCE_HERTZ, TEETH_DAMPING_RATIO);
        let model = Model {
            ohms: params.motor.armature_ohms,
            henries: effective_henries(params),
            torque_constant: params.motor.torque_constant_newton_metres_per_amp,
            back_emf: params.motor.back_emf_volts_per_radian_per_second,
            ratio: params.gear.ratio,
            motor_inertia: params.motor.rotor_inertia_kilogram_square_metres,
            motor_viscous: params.motor.friction.viscous_newton_metre_seconds_per_radian,
            load_inertia: params.load.inertia_kilogram_square_metres,
            load_viscous: params.load.friction.viscous_newton_metre_seconds_per_radian,
            coupling: params.load.coupling.unwrap_or_else(teeth),
        };
        Self {
            state: State::AT_REST,
            ratio: params.gear.ratio,
            half_backlash: params.gear.backlash_radians / 2.0,
            motor_friction: DryFriction::new(&params.motor.friction),
            load_friction: DryFriction::new(&params.load.friction),
            travel: Travel::new(params.load.travel),
            model,
            whole: model.maps(super::MAX_STEP_S),
            part: model.maps(super::MAX_STEP_S / f64::from(EVENT_PARTS)),
        }
    }

    pub fn amps(&self) -> f64 {
        self.state.amps
    }

    pub fn set_amps(&mut self, amps: f64) {
        self.state.amps = amps;
    }

    pub fn motor_radians(&self) -> f64 {
        self.state.motor_radians
    }

    pub fn motor_radians_per_second(&self) -> f64 {
        self.state.motor_speed
    }

    pub fn load_radians(&self) -> f64 {
        self.state.load_radians
    }

    pub fn load_radians_per_second(&self) -> f64 {
        self.state.load_speed
    }

    /// The charge that would flow through a driven winding over the next step: (at no volts, more per volt).
    pub fn charge_line(&mut self, dt_s: f64) -> (f64, f64) {
        self.learn(dt_s);
        let s = &self.state;
        let (touching, offset) = self.teeth(s.twist);
        let row = &self.whole.driven[usize::from(!touching)].coulombs;
        let inputs = [
            s.amps,
            s.motor_speed,
            s.load_speed,
            s.twist - offset,
            0.0,
            s.last_motor_newton_metres,
            s.last_load_newton_metres,
        ];
        (dot(row, &inputs), row[4])
    }

    /// Advances by `dt_s` and returns the charge that flowed.
    pub fn step(&mut self, push: Push, dt_s: f64) -> f64 {
        self.learn(dt_s);
        let (next, coulombs) = self.moved(self.state, push, &self.whole);
        if self.half_backlash == 0.0 || !self.teeth_changed(self.state.twist, next.twist) {
            self.state = next;
            return coulombs;
        }
        let mut sum = 0.0;
        for _ in 0..EVENT_PARTS {
            let (next, coulombs) = self.moved(self.state, push, &self.part);
            self.state = next;
            sum += coulombs;
        }
        sum
    }

    fn moved(&self, s: State, push: Push, maps: &Maps) -> (State, f64) {
        let (touching, offset) = self.teeth(s.twist);
        let by_teeth = match push.winding {
            Winding::Driven { .. } => &maps.driven,
            Winding::Open => &maps.open,
        };
        let map = &by_teeth[usize::from(!touching)];
        let mut x = [
            s.amps,
            s.motor_speed,
            s.load_speed,
            s.twist - offset,
            push.winding.volts(),
            push.motor_newton_metres,
            push.load_newton_metres,
        ];
        let free_load = dot(&map.load_speed, &x);
        x[6] += self.travel.spring_torque(s.load_radians, free_load, map.load_speed[6], maps.dt_s);
        let (held, rests) = self.hold(&s, map, &x, push.locked);
        x[5] += held[0];
        x[6] += held[1];
        let motor_stays = rests[0] && s.motor_speed == 0.0;
        let load_stays = rests[1] && s.load_speed == 0.0;
        let turned = if motor_stays { 0.0 } else { dot(&map.motor_radians, &x) };
        let twist = match (motor_stays, load_stays) {
            (true, true) => s.twist,
            (false, true) => s.twist + turned / self.ratio,
            _ => dot(&map.twist, &x) + offset,
        };
        let mut next = State {
            amps: dot(&map.amps, &x),
            motor_speed: if rests[0] { 0.0 } else { dot(&map.motor_speed, &x) },
            load_speed: if rests[1] { 0.0 } else { dot(&map.load_speed, &x) },
            motor_radians: s.motor_radians + turned,
            load_radians: if load_stays {
                s.load_radians
            } else {
                s.load_radians + turned / self.ratio - (twist - s.twist)
            },
            twist,
            last_motor_newton_metres: x[5],
            last_load_newton_metres: x[6],
        };
        if let Some(inside) = self.travel.beyond_hard_stop(next.load_radians) {
            next.load_radians = inside;
            next.twist = next.motor_radians / self.ratio - inside;
            next.load_speed = 0.0;
        }
        (next, dot(&map.coulombs, &x))
    }

    fn hold(&self, s: &State, map: &StepMap, x: &[f64; 7], locked: bool) -> ([f64; 2], [bool; 2]) {
        let free = [dot(&map.motor_speed, x), dot(&map.load_speed, x)];
        let gain = [[map.motor_speed[5], map.motor_speed[6]], [map.load_speed[5], map.load_speed[6]]];
        let (lower, upper) = self.travel.on_hard_stop(s.load_radians);
        let motor =
            if locked { (Bounds::LOCKED, Bounds::LOCKED) } else { self.motor_friction.bounds(s.motor_speed) };
        let load = self.load_friction.bounds(s.load_speed);
        hold_two(
            free,
            &gain,
            [motor.0, load.0.with_stops(lower, upper)],
            [motor.1, load.1.with_stops(lower, upper)],
        )
    }

    /// Whether the teeth touch, and the twist at which their spring is at rest.
    fn teeth(&self, twist: f64) -> (bool, f64) {
        if twist.abs() >= self.half_backlash {
            (true, self.half_backlash.copysign(twist))
        } else {
            (false, 0.0)
        }
    }

    fn teeth_changed(&self, before: f64, after: f64) -> bool {
        let side = |twist: f64| {
            if twist.abs() < self.half_backlash { 0.0 } else { twist.signum() }
        };
        side(before) != side(after)
    }

    fn learn(&mut self, dt_s: f64) {
        if !same_step(self.whole.dt_s, dt_s) {
            self.whole = self.model.maps(dt_s);
            self.part = self.model.maps(dt_s / f64::from(EVENT_PARTS));
        }
    }
}

impl State {
    const AT_REST: Self = Self {
        amps: 0.0,
        motor_speed: 0.0,
        load_speed: 0.0,
        motor_radians: 0.0,
        load_radians: 0.0,
        twist: 0.0,
        last_motor_newton_metres: 0.0,
        last_load_newton_metres: 0.0,
    };
}

impl Model {
    fn maps(&self, dt_s: f64) -> Maps {
        let by_teeth = |driven| [self.map(driven, true, dt_s), self.map(driven, false, dt_s)];
        Maps { dt_s, driven: by_teeth(true), open: by_teeth(false) }
    }

    fn map(&self, driven: bool, touching: bool, dt_s: f64) -> StepMap {
        let e = exponential(&self.equations(driven, touching).map(|row| row.map(|x| x * dt_s)));
        let row = |n: usize| [e[n][0], e[n][1], e[n][2], e[n][3], e[n][6], e[n][7], e[n][8]];
        StepMap {
            amps: row(0),
            motor_speed: row(1),
            load_speed: row(2),
            twist: row(3),
            coulombs: row(4),
            motor_radians: row(5),
        }
    }

    /// Rows and columns: amps, motor speed, load speed, twist, charge, motor angle; volts, motor torque, load torque
    /// (constant over the step).
    fn equations(&self, driven: bool, touching: bool) -> [[f64; 9]; 9] {
        let (stiffness, damping) = if touching {
            (
                self.coupling.stiffness_newton_metres_per_radian,
                self.coupling.damping_newton_metre_seconds_per_radian,
            )
        } else {
            (0.0, 0.0)
        };
        let (n, jm, jl) = (self.ratio, self.motor_inertia, self.load_inertia);
        let mut a = [[0.0; 9]; 9];
        if driven {
            a[0][0] = -self.ohms / self.henries;
            a[0][1] = -self.back_emf / self.henries;
            a[0][6] = 1.0 / self.henries;
        }
        a[1][0] = self.torque_constant / jm;
        a[1][1] = -(self.motor_viscous + damping / (n * n)) / jm;
        a[1][2] = damping / n / jm;
        a[1][3] = -stiffness / n / jm;
        a[1][7] = 1.0 / jm;
        a[2][1] = damping / n / jl;
        a[2][2] = -(self.load_viscous + damping) / jl;
        a[2][3] = stiffness / jl;
        a[2][8] = 1.0 / jl;
        a[3][1] = 1.0 / n;
        a[3][2] = -1.0;
        a[4][0] = 1.0;
        a[5][1] = 1.0;
        a
    }
}
