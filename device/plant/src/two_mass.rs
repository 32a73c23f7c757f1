//! An axis whose load is a second mass behind teeth with play, a springy shaft, or both.
//!
//! While the teeth touch, motor and load are joined by spring and damper; in the gap they move alone. Both are linear, so each
//! has its exact step, also with one or both shafts held at rest. A step in which the teeth would meet or part, or the load would
//! hit a stop, is taken again in eighths, so that the spring neither wins nor loses noticeable energy at the change. The damper acts as long as the teeth touch, so it can pull for an instant before
//! they part.

use super::friction::{DryFriction, slide_one, slide_two};
use super::linear::{dot, exponential};
use super::params::{AxisParams, CouplingParams};
use super::rigid::{Push, Winding, effective_henries};
use super::step::{MAX_STEP_S, same_step};
use super::travel::Travel;

/// Assumed: the resonance of motor and load through the teeth where a gear has backlash and no coupling is given.
const TEETH_RESONANCE_HERTZ: f64 = 150.0;
/// Assumed: damping of that resonance over critical damping.
const TEETH_DAMPING_RATIO: f64 = 0.2;
/// A coupling that would let motor and load swing faster than this is taken as one that lets them swing as fast as this.
const FASTEST_RADIANS_PER_SECOND: f64 = 1e5;
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
    last_held: Held,
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

/// The steps of one length, by [`Maps::index`].
#[derive(Clone, Debug)]
struct Maps {
    dt_s: f64,
    all: Vec<StepMap>,
}

/// Which shafts do not move over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Held {
    motor: bool,
    load: bool,
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
            coupling: no_stiffer_than(
                FASTEST_RADIANS_PER_SECOND,
                params,
                params.load.coupling.unwrap_or_else(teeth),
            ),
        };
        Self {
            state: State::AT_REST,
            ratio: params.gear.ratio,
            half_backlash: params.gear.backlash_radians / 2.0,
            motor_friction: DryFriction::new(&params.motor.friction),
            load_friction: DryFriction::new(&params.load.friction),
            travel: Travel::new(params.load.travel),
            model,
            whole: model.maps(MAX_STEP_S),
            part: model.maps(MAX_STEP_S / f64::from(EVENT_PARTS)),
        }
    }

    /// How fast its quickest swing turns in its phase.
    pub fn fastest_radians_per_second(&self) -> f64 {
        let m = &self.model;
        let motor = m.motor_inertia * m.ratio * m.ratio;
        let swing = m.coupling.stiffness_newton_metres_per_radian * (motor + m.load_inertia)
            / (motor * m.load_inertia);
        let electric = m.torque_constant * m.back_emf / (m.henries * m.motor_inertia);
        swing.max(electric).sqrt()
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
        let row = &self.whole.of(true, touching, s.last_held).coulombs;
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
        if push.locked {
            self.state.motor_speed = 0.0;
        }
        let (next, coulombs) = self.moved(&self.state, push, &self.whole);
        let hits = next.load_speed != 0.0 && self.travel.beyond_hard_stop(next.load_radians).is_some();
        if !hits && !self.teeth_changed(self.state.twist, next.twist) {
            self.state = next;
            return coulombs;
        }
        let mut sum = 0.0;
        for _ in 0..EVENT_PARTS {
            let (next, coulombs) = self.moved(&self.state, push, &self.part);
            self.state = self.stopped_at_end(next);
            sum += coulombs;
        }
        sum
    }

    /// The state after one step, holding at rest what friction, a lock or a stop can hold throughout.
    fn moved(&self, s: &State, push: Push, maps: &Maps) -> (State, f64) {
        let can = |held: Held, s: &State| {
            let [motor, load] = self.can_hold(s, push);
            Held { motor: held.motor && motor, load: held.load && load }
        };
        let at_rest = Held { motor: s.motor_speed == 0.0, load: s.load_speed == 0.0 };
        let mut held = can(at_rest, s);
        loop {
            let (next, coulombs) = self.moved_with(s, push, maps, held);
            // Each round lets go of a shaft, so there are three at most.
            let still = can(held, &next);
            if still == held {
                return (next, coulombs);
            }
            held = still;
        }
    }

    fn moved_with(&self, s: &State, push: Push, maps: &Maps, held: Held) -> (State, f64) {
        let (touching, offset) = self.teeth(s.twist);
        let map = maps.of(matches!(push.winding, Winding::Driven { .. }), touching, held);
        let mut x = [
            s.amps,
            s.motor_speed,
            s.load_speed,
            s.twist - offset,
            push.winding.volts(),
            push.motor_newton_metres,
            push.load_newton_metres,
        ];
        if !held.load {
            let free = dot(&map.load_speed, &x);
            x[6] += self.travel.spring_torque(s.load_radians, free, map.load_speed[6], maps.dt_s);
        }
        let (friction, rests) = self.slide(map, &x, held);
        x[5] += friction[0];
        x[6] += friction[1];
        let turned = dot(&map.motor_radians, &x);
        let twist = dot(&map.twist, &x) + offset;
        let next = State {
            amps: dot(&map.amps, &x),
            motor_speed: if rests[0] { 0.0 } else { dot(&map.motor_speed, &x) },
            load_speed: if rests[1] { 0.0 } else { dot(&map.load_speed, &x) },
            motor_radians: if held.motor { s.motor_radians } else { s.motor_radians + turned },
            load_radians: if held.load {
                s.load_radians
            } else {
                s.load_radians + turned / self.ratio - (twist - s.twist)
            },
            twist: if held.motor && held.load { s.twist } else { twist },
            last_motor_newton_metres: x[5],
            last_load_newton_metres: x[6],
            last_held: held,
        };
        (next, dot(&map.coulombs, &x))
    }

    /// Whether each shaft, at rest in this state, would stay so: the torque it would need is within bounds.
    fn can_hold(&self, s: &State, push: Push) -> [bool; 2] {
        let (touching, offset) = self.teeth(s.twist);
        let coupling = &self.model.coupling;
        let through_teeth = if touching {
            coupling.stiffness_newton_metres_per_radian * (s.twist - offset)
                + coupling.damping_newton_metre_seconds_per_radian
                    * (s.motor_speed / self.ratio - s.load_speed)
        } else {
            0.0
        };
        let (lower, upper) = self.travel.on_hard_stop(s.load_radians);
        let on_motor =
            self.model.torque_constant * s.amps + push.motor_newton_metres - through_teeth / self.ratio;
        let on_load = through_teeth + push.load_newton_metres + self.travel.resting_torque(s.load_radians);
        [
            push.locked || self.motor_friction.at_rest().contains(-on_motor),
            self.load_friction.at_rest().with_stops(lower, upper).contains(-on_load),
        ]
    }

    /// Coulomb friction on the shafts that are not held, and which shafts end the step at rest.
    fn slide(&self, map: &StepMap, x: &[f64; 7], held: Held) -> ([f64; 2], [bool; 2]) {
        let free = || [dot(&map.motor_speed, x), dot(&map.load_speed, x)];
        let (motor, load) = (self.motor_friction.sliding(), self.load_friction.sliding());
        match (held.motor, held.load) {
            (true, true) => ([0.0, 0.0], [true, true]),
            (false, true) => {
                let (torque, rests) = slide_one(free()[0], map.motor_speed[5], motor);
                ([torque, 0.0], [rests, true])
            }
            (true, false) => {
                let (torque, rests) = slide_one(free()[1], map.load_speed[6], load);
                ([0.0, torque], [true, rests])
            }
            (false, false) => {
                let gain = [[map.motor_speed[5], map.motor_speed[6]], [map.load_speed[5], map.load_speed[6]]];
                slide_two(free(), &gain, [motor, load])
            }
        }
    }

    /// Puts a load that is beyond a hard stop back onto it, at rest. The motor goes back with it, so that the spring between them
    /// does not gain by it.
    fn stopped_at_end(&self, mut s: State) -> State {
        if let Some(inside) = self.travel.beyond_hard_stop(s.load_radians) {
            s.motor_radians -= (s.load_radians - inside) * self.ratio;
            s.load_radians = inside;
            s.load_speed = 0.0;
        }
        s
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
        last_held: Held { motor: true, load: true },
    };
}

impl Maps {
    fn of(&self, driven: bool, touching: bool, held: Held) -> &StepMap {
        &self.all[Self::index(driven, touching, held)]
    }

    fn index(driven: bool, touching: bool, held: Held) -> usize {
        usize::from(driven)
            | usize::from(touching) << 1
            | usize::from(held.motor) << 2
            | usize::from(held.load) << 3
    }
}

impl Model {
    fn maps(&self, dt_s: f64) -> Maps {
        let bit = |index: usize, n: u32| index >> n & 1 == 1;
        let all = (0..16)
            .map(|n| self.map(bit(n, 0), bit(n, 1), Held { motor: bit(n, 2), load: bit(n, 3) }, dt_s))
            .collect();
        Maps { dt_s, all }
    }

    fn map(&self, driven: bool, touching: bool, held: Held, dt_s: f64) -> StepMap {
        let mut equations = self.equations(driven, touching);
        if held.motor {
            equations[1] = [0.0; 9];
        }
        if held.load {
            equations[2] = [0.0; 9];
        }
        let e = exponential(&equations.map(|row| row.map(|x| x * dt_s)));
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

fn no_stiffer_than(radians_per_second: f64, params: &AxisParams, coupling: CouplingParams) -> CouplingParams {
    let limit = CouplingParams::with_resonance(params, radians_per_second / std::f64::consts::TAU, 0.0);
    let excess = coupling.stiffness_newton_metres_per_radian / limit.stiffness_newton_metres_per_radian;
    if excess <= 1.0 {
        return coupling;
    }
    CouplingParams {
        stiffness_newton_metres_per_radian: limit.stiffness_newton_metres_per_radian,
        // The same share of critical damping.
        damping_newton_metre_seconds_per_radian: coupling.damping_newton_metre_seconds_per_radian
            / excess.sqrt(),
    }
}
