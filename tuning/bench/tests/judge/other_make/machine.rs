//! A motor on a supply that sags, with Stribeck friction, cogging, a winding, and an encoder whose four edges are not evenly spaced.

use std::f64::consts::TAU;

/// Longest step of the motor's equations, s.
const STEP_S: f64 = 5e-5;

/// Draws, the same for the same seed (splitmix64, Steele and others 2014).
pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64, number: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ number.wrapping_mul(0xD1B5_4A32_D192_ED03))
    }

    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.uniform())
    }

    pub fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[((self.uniform() * all.len() as f64) as usize).min(all.len() - 1)]
    }

    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// Name, battery, counts/s at full duty, time constant in ms, counts per turn, stall current.
type Kind = (&'static str, f64, (f64, f64), (f64, f64), f64, f64);

const KINDS: [Kind; 6] = [
    ("gearmotor", 12.0, (7e3, 14e3), (25.0, 80.0), 64.0, 5.0),
    ("wheel", 12.0, (2e3, 8e3), (60.0, 220.0), 1_440.0, 10.0),
    ("base", 24.0, (20e3, 70e3), (100.0, 500.0), 4_000.0, 35.0),
    ("coreless", 12.0, (80e3, 250e3), (7.0, 22.0), 2_048.0, 4.0),
    ("actuator", 12.0, (500.0, 1_600.0), (15.0, 50.0), 48.0, 7.0),
    ("drum", 24.0, (10e3, 50e3), (600.0, 2_000.0), 2_000.0, 28.0),
];

/// The motor's figures.
#[derive(Clone, Copy, Debug)]
pub struct Motor {
    pub kind: &'static str,
    pub volts: f64,
    pub ohms: f64,
    pub henries: f64,
    /// V s/rad and N m/A.
    pub constant: f64,
    pub inertia: f64,
    pub viscous: f64,
    pub coulomb: f64,
    /// Friction at rest beyond that, and the speed over which it goes, rad/s.
    pub stiction: f64,
    pub stribeck: f64,
    /// Cogging torque, and how often in a turn.
    pub cogging: f64,
    pub cogs: f64,
    pub supply_ohms: f64,
    pub counts_per_turn: f64,
    /// By how much of a count the edges are off.
    pub uneven: f64,
    pub limit_amps: f64,
}

impl Motor {
    pub fn drawn(draw: &mut Draw, number: usize) -> Self {
        let (kind, volts, speeds, taus, counts_per_turn, amps) = KINDS[number % KINDS.len()];
        let free = draw.log(speeds.0, speeds.1) / counts_per_turn * TAU;
        let tau_s = 1e-3 * draw.log(taus.0, taus.1);
        let stall_amps = amps * draw.log(0.7, 1.5);
        let (ohms, constant) = (volts / stall_amps, volts / free);
        let stall_torque = constant * stall_amps;
        let coulomb = draw.log(0.02, 0.10) * stall_torque;
        Self {
            kind,
            volts,
            ohms,
            henries: ohms * draw.log(2e-4, 2.5e-3).min(0.2 * tau_s),
            constant,
            inertia: tau_s * constant * constant / ohms,
            viscous: draw.log(0.005, 0.05) * stall_torque / free,
            coulomb,
            stiction: coulomb * draw.between(0.0, 0.5),
            stribeck: draw.log(0.005, 0.03) * free,
            cogging: draw.between(0.0, 0.01) * stall_torque,
            cogs: draw.one_of(&[5.0, 7.0, 12.0]),
            supply_ohms: draw.log(0.02, 0.10) * ohms,
            counts_per_turn,
            uneven: draw.between(0.0, 0.15),
            limit_amps: stall_amps * draw.one_of(&[0.5, 0.8, 1.3]),
        }
    }

    /// What back-EMF and viscous friction brake with, (V s/rad)^2.
    fn damping(&self) -> f64 {
        self.constant.powi(2) + self.ohms * self.viscous
    }

    /// Speed per duty, friction aside, counts/s, on a supply that does not sag.
    pub fn gain(&self) -> f64 {
        self.volts * self.constant / self.damping() * self.counts_per_radian()
    }

    /// Time constant of the speed on such a supply, s.
    pub fn tau_s(&self) -> f64 {
        self.inertia * self.ohms / self.damping()
    }

    fn counts_per_radian(&self) -> f64 {
        self.counts_per_turn / TAU
    }

    /// Counts over duty at a complex frequency: winding and shaft, the supply taken at a duty of 0.4.
    pub fn response(&self, s: Complex) -> Complex {
        let ohms = self.ohms + 0.16 * self.supply_ohms;
        let winding = s.times(self.henries).plus(ohms);
        let shaft = s.times(self.inertia).plus(self.viscous);
        let both = winding.mul(shaft).plus(self.constant * self.constant);
        Complex(self.volts * self.constant * self.counts_per_radian(), 0.0).over(s.mul(both))
    }
}

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex(pub f64, pub f64);

impl Complex {
    pub fn turn(angle: f64) -> Self {
        Self(angle.cos(), angle.sin())
    }

    pub fn plus(self, real: f64) -> Self {
        Self(self.0 + real, self.1)
    }

    pub fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }

    pub fn times(self, real: f64) -> Self {
        Self(self.0 * real, self.1 * real)
    }

    pub fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }

    pub fn over(self, other: Self) -> Self {
        let square = other.0 * other.0 + other.1 * other.1;
        self.mul(Self(other.0, -other.1)).times(1.0 / square)
    }

    pub fn angle(self) -> f64 {
        self.1.atan2(self.0)
    }

    pub fn size(self) -> f64 {
        self.0.hypot(self.1)
    }
}

/// The motor as it turns.
pub struct Machine {
    pub motor: Motor,
    pub amps: f64,
    pub speed: f64,
    pub angle: f64,
    pub volts: f64,
    /// It is held fast; one of its leads is off.
    pub is_locked: bool,
    pub is_open: bool,
    /// Steps since the current limit last held the duty back.
    since_limited: u32,
}

impl Machine {
    pub fn new(motor: Motor) -> Self {
        Self {
            motor,
            amps: 0.0,
            speed: 0.0,
            angle: 0.31 / motor.counts_per_radian(),
            volts: motor.volts,
            is_locked: false,
            is_open: false,
            since_limited: u32::MAX,
        }
    }

    /// Moves on at a duty.
    pub fn advance(&mut self, duty: f64, seconds: f64) {
        let steps = (seconds / STEP_S).ceil().max(1.0);
        for _ in 0..steps as usize {
            self.step(duty, seconds / steps);
        }
    }

    fn step(&mut self, duty: f64, dt: f64) {
        let m = &self.motor;
        self.volts = m.volts - m.supply_ohms * self.amps * duty;
        let (emf, most) = (m.constant * self.speed, m.ohms * m.limit_amps);
        let given = (duty * self.volts).clamp(emf - most, emf + most);
        self.since_limited =
            if given == duty * self.volts { self.since_limited.saturating_add(1) } else { 0 };
        let goal = if self.is_open { 0.0 } else { (given - emf) / m.ohms };
        self.amps = goal + (self.amps - goal) * (-dt * m.ohms / m.henries).exp();
        let cogging = m.cogging * (m.cogs * self.angle).sin();
        let torque = m.constant * self.amps - m.viscous * self.speed - cogging;
        let held = m.coulomb + m.stiction * (-(self.speed / m.stribeck).powi(2)).exp();
        let free = self.speed + dt * torque / m.inertia;
        let slowed = free.abs() - dt * held / m.inertia;
        self.speed = if slowed <= 0.0 || self.is_locked { 0.0 } else { slowed * free.signum() };
        self.angle += dt * self.speed;
    }

    /// Whether the current limit holds it back, or did a moment ago.
    pub fn is_limited(&self) -> bool {
        f64::from(self.since_limited) * STEP_S < 0.02
    }

    /// The encoder's count.
    pub fn count(&self) -> f64 {
        let exact = self.angle * self.motor.counts_per_radian();
        // Edges of both channels: each second one comes early or late.
        let off = self.motor.uneven * if exact.floor().rem_euclid(2.0) == 0.0 { 1.0 } else { 0.0 };
        (exact - off).floor()
    }
}
