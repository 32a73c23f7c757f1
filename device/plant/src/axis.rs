//! One axis: the bridge's output in, motion, current and encoder counts out.
//!
//! PWM is averaged: a duty is a mean voltage of that share of the link voltage. Locked antiphase and sign magnitude are the same
//! in that mean, also at duty 0, where both short the winding in the mean, so the motor brakes. Of the ripple only its losses are
//! modelled, and only where a PWM mode is set.

use super::encoder::{Encoder, EncoderFaults, EncoderReading};
use super::noise::Noise;
use super::params::{AxisParams, ParamsError, ShaftSide};
use super::rigid::{Push, Rigid, Winding, effective_henries};
use super::step::substeps;
use super::two_mass::TwoMass;
use crate::bridge::{BridgeOutput, PwmMode};
use serde::Serialize;

/// Assumed: drop of one body diode of the bridge. Two carry the current of a coasting motor.
const DIODE_VOLTS: f64 = 0.8;

/// Most pieces that a step is cut into for the sake of a stiff coupling.
const MOST_PIECES: f64 = 40.0;

/// What an axis exchanged with the link over a stretch of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisPower {
    /// Mean current drawn from the link; negative while the motor feeds it.
    pub bus_amps: f64,
}

/// The axis as it really is, whatever its sensors say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct AxisTruth {
    /// Angle of the motor shaft from the start.
    pub motor_radians: f64,
    /// Speed of the motor shaft.
    pub motor_radians_per_second: f64,
    /// Angle of the output (load) shaft from the start.
    pub load_radians: f64,
    /// Speed of the output (load) shaft.
    pub load_radians_per_second: f64,
    /// Current through the bridge, positive from M+ to M-.
    pub amps: f64,
    /// Torque that pulls the output shaft towards lower positions.
    pub load_newton_metres: f64,
    /// Whether something holds the motor shaft.
    pub shaft_locked: bool,
    /// Whether a motor lead is off.
    pub lead_open: bool,
    /// Whether the motor leads are swapped.
    pub leads_reversed: bool,
    /// Whether the encoder counts the wrong way.
    pub encoder_reversed: bool,
    /// Whether the encoder gives nothing.
    pub encoder_lost: bool,
    /// Standard deviation of the noise put on the encoder.
    pub encoder_noise_counts: f64,
}

/// A simulated axis.
#[derive(Clone, Debug)]
pub struct Axis {
    params: AxisParams,
    mechanics: Mechanics,
    fastest_radians_per_second: f64,
    encoder: Encoder,
    current_noise: Noise,
    load_newton_metres: f64,
    shaft_locked: bool,
    lead_open: bool,
    leads_reversed: bool,
    pwm: Option<PwmMode>,
    meter: Meter,
}

#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "an axis lives as long as its world; two of them are no waste")]
enum Mechanics {
    Rigid(Rigid),
    TwoMass(TwoMass),
}

/// Sums from which the mean current is taken.
#[derive(Clone, Copy, Debug, Default)]
struct Meter {
    /// Since the last reading of the current.
    coulombs: f64,
    seconds: f64,
    last_amps: f64,
    /// Since the board last asked for its heat.
    heat_amps_squared_seconds: f64,
}

impl Axis {
    /// An axis at rest at its start position. Seed 0 makes one without noise.
    pub fn new(params: &AxisParams, seed: u64) -> Result<Self, ParamsError> {
        params.validate()?;
        let mechanics = if params.is_two_mass() {
            Mechanics::TwoMass(TwoMass::new(params))
        } else {
            Mechanics::Rigid(Rigid::new(params))
        };
        Ok(Self {
            params: params.clone(),
            fastest_radians_per_second: mechanics.fastest_radians_per_second(),
            mechanics,
            encoder: Encoder::new(params.encoder, seed, 1),
            current_noise: Noise::new(seed, 2),
            load_newton_metres: params.load.torque_newton_metres,
            shaft_locked: false,
            lead_open: false,
            leads_reversed: false,
            pwm: None,
            meter: Meter::default(),
        })
    }

    /// What it was built from.
    pub fn params(&self) -> &AxisParams {
        &self.params
    }

    /// Advances by `dt_s` at a constant link voltage.
    pub fn advance(&mut self, output: BridgeOutput, bus_volts: f64, dt_s: f64) -> AxisPower {
        let (steps, step_s) = substeps(dt_s);
        let coulombs: f64 = (0..steps).map(|_| self.step(output, bus_volts, step_s)).sum();
        AxisPower { bus_amps: if steps == 0 { 0.0 } else { coulombs / dt_s } }
    }

    /// Reads the encoder, with its noise and its faults.
    pub fn encoder(&mut self) -> EncoderReading {
        let turns = self.encoder_turns();
        self.encoder.read(turns)
    }

    /// What the encoder would read without noise, leaving the course of later readings as it is.
    pub fn quiet_encoder(&self) -> EncoderReading {
        let mut encoder = self.encoder.clone();
        encoder.read_quietly(self.encoder_turns())
    }

    /// Mean bridge current since the last reading, with the sensor's noise; positive from M+ to M-. Asked twice at the same
    /// time it gives the same answer.
    pub fn measured_amps(&mut self) -> f64 {
        if self.meter.seconds > 0.0 {
            let mean = self.meter.coulombs / self.meter.seconds;
            let sensor = &self.params.current_sensor;
            let noise =
                if sensor.noise_amps > 0.0 { self.current_noise.normal() * sensor.noise_amps } else { 0.0 };
            self.meter.last_amps = mean + sensor.offset_amps + noise;
            self.meter.coulombs = 0.0;
            self.meter.seconds = 0.0;
        }
        self.meter.last_amps
    }

    /// The axis as it really is.
    pub fn state(&self) -> AxisTruth {
        let faults = self.encoder.faults;
        let (motor_radians, motor_radians_per_second) = self.mechanics.motor();
        let (load_radians, load_radians_per_second) = self.mechanics.load();
        AxisTruth {
            motor_radians,
            motor_radians_per_second,
            load_radians,
            load_radians_per_second,
            amps: self.bridge_amps(),
            load_newton_metres: self.load_newton_metres,
            shaft_locked: self.shaft_locked,
            lead_open: self.lead_open,
            leads_reversed: self.leads_reversed,
            encoder_reversed: faults.reversed,
            encoder_lost: faults.lost,
            encoder_noise_counts: faults.noise_counts,
        }
    }

    /// Sets the constant torque that pulls the output shaft towards lower positions.
    pub fn set_load_torque(&mut self, newton_metres: f64) {
        self.load_newton_metres = newton_metres;
    }

    /// Makes the encoder count the wrong way from here on.
    pub fn reverse_encoder(&mut self, reversed: bool) {
        self.change_encoder(|faults| faults.reversed = reversed);
    }

    /// Takes the encoder's signal away, or brings it back.
    pub fn lose_encoder(&mut self, lost: bool) {
        self.change_encoder(|faults| faults.lost = lost);
    }

    /// Puts noise of this standard deviation on each encoder reading.
    pub fn set_encoder_noise(&mut self, counts: f64) {
        self.change_encoder(|faults| faults.noise_counts = counts);
    }

    /// Holds the motor shaft, or lets it go.
    pub fn lock_shaft(&mut self, locked: bool) {
        self.shaft_locked = locked;
    }

    /// Takes a motor lead off, or puts it back.
    pub fn open_lead(&mut self, open: bool) {
        self.lead_open = open;
    }

    /// Swaps the motor leads, so that the motor turns the other way.
    pub fn reverse_leads(&mut self, reversed: bool) {
        self.leads_reversed = reversed;
    }

    /// Sets how the bridge makes its mean voltage. Without a mode its current has no ripple.
    pub fn set_pwm_mode(&mut self, mode: PwmMode) {
        self.pwm = Some(mode);
    }

    /// Current through the bridge at this moment, without noise.
    pub(crate) fn bridge_amps(&self) -> f64 {
        self.polarity() * self.mechanics.amps()
    }

    /// What the axis would draw from the link over the next step: (amperes at no volts, more per volt).
    pub(crate) fn foretell(&mut self, output: BridgeOutput, step_s: f64) -> (f64, f64) {
        let duty = match output {
            BridgeOutput::Duty(duty) if !self.lead_open => self.winding_duty(duty),
            BridgeOutput::Duty(_) | BridgeOutput::Brake | BridgeOutput::Coast => return (0.0, 0.0),
        };
        let piece_s = step_s / self.pieces(step_s);
        let (at_none, per_volt) = self.mechanics.charge_line(piece_s);
        (duty * at_none / piece_s, duty * duty * per_volt / piece_s)
    }

    /// Takes one step and returns the charge drawn from the link.
    pub(crate) fn step(&mut self, output: BridgeOutput, bus_volts: f64, step_s: f64) -> f64 {
        let pieces = self.pieces(step_s);
        let piece_s = step_s / pieces;
        (0..pieces as usize).map(|_| self.piece(output, bus_volts, piece_s)).sum()
    }

    /// Into how many pieces a step must be cut so that no swing turns by more than a radian of its phase in one. What a torque does
    /// within a piece then has the sign one expects of it.
    fn pieces(&self, step_s: f64) -> f64 {
        (self.fastest_radians_per_second * step_s).ceil().clamp(1.0, MOST_PIECES)
    }

    fn piece(&mut self, output: BridgeOutput, bus_volts: f64, step_s: f64) -> f64 {
        let (motor_coulombs, bus_coulombs) = match output {
            _ if self.lead_open => {
                self.mechanics.set_amps(0.0);
                self.mechanics.step(self.push(Winding::Open, 0.0), step_s);
                (0.0, 0.0)
            }
            BridgeOutput::Duty(duty) => {
                let duty = self.winding_duty(duty);
                let volts = duty * bus_volts;
                let coulombs = self.mechanics.step(self.push(Winding::Driven { volts }, 0.0), step_s);
                (coulombs, duty * coulombs + self.ripple(duty, bus_volts, step_s))
            }
            BridgeOutput::Brake => {
                let coulombs = self.mechanics.step(self.push(Winding::Driven { volts: 0.0 }, 0.0), step_s);
                (coulombs, 0.0)
            }
            BridgeOutput::Coast => {
                let coulombs = self.coast(bus_volts, step_s);
                // The diodes lead every coasting current back into the link.
                (coulombs, -coulombs.abs())
            }
        };
        self.meter.coulombs += self.polarity() * motor_coulombs;
        self.meter.seconds += step_s;
        self.meter.heat_amps_squared_seconds += motor_coulombs * motor_coulombs / step_s;
        bus_coulombs
    }

    /// What the ripple of the PWM takes from the link over a step, in coulombs; its heat goes to the board.
    fn ripple(&mut self, duty: f64, bus_volts: f64, step_s: f64) -> f64 {
        let Some(pwm) = self.pwm.filter(|_| bus_volts > 0.0) else { return 0.0 };
        let ohms = self.params.motor.armature_ohms;
        let squared = pwm.ripple_amps_squared(duty, bus_volts, ohms, effective_henries(&self.params));
        self.meter.heat_amps_squared_seconds += squared * step_s;
        squared * ohms / bus_volts * step_s
    }

    /// The integral of the squared current since the last call, in ampere squared seconds.
    pub(crate) fn take_heat(&mut self) -> f64 {
        std::mem::take(&mut self.meter.heat_amps_squared_seconds)
    }

    /// One step with the bridge open. The winding sees the link voltage against its current, so the current dies away quickly;
    /// a motor turned so fast that it gives more than the link charges the link through the diodes.
    fn coast(&mut self, bus_volts: f64, step_s: f64) -> f64 {
        let motor = &self.params.motor;
        let speed = self.mechanics.motor().1;
        let emf_volts = motor.back_emf_volts_per_radian_per_second * speed;
        let diode_volts = bus_volts + 2.0 * DIODE_VOLTS;
        let amps = self.mechanics.amps();
        let feeds = emf_volts.abs() > diode_volts && amps * emf_volts <= 0.0;
        if feeds {
            let volts = diode_volts.copysign(emf_volts);
            let coulombs = self.mechanics.step(self.push(Winding::Driven { volts }, 0.0), step_s);
            if self.mechanics.amps() * emf_volts > 0.0 {
                self.mechanics.set_amps(0.0);
            }
            return coulombs;
        }
        let decay = DyingCurrent {
            amps,
            settled_amps: (-diode_volts.copysign(amps) - emf_volts) / motor.armature_ohms,
            time_constant_s: effective_henries(&self.params) / motor.armature_ohms,
        };
        let (end_amps, coulombs) = if amps == 0.0 { (0.0, 0.0) } else { decay.after(step_s) };
        let torque = motor.torque_constant_newton_metres_per_amp * coulombs / step_s;
        self.mechanics.set_amps(0.0);
        self.mechanics.step(self.push(Winding::Open, torque), step_s);
        self.mechanics.set_amps(end_amps);
        coulombs
    }

    fn push(&self, winding: Winding, motor_newton_metres: f64) -> Push {
        Push {
            winding,
            motor_newton_metres,
            load_newton_metres: -self.load_newton_metres,
            locked: self.shaft_locked,
        }
    }

    /// The duty as the winding sees it; one that is no number counts as none.
    fn winding_duty(&self, duty: f64) -> f64 {
        if duty.is_nan() { 0.0 } else { self.polarity() * duty.clamp(-1.0, 1.0) }
    }

    fn polarity(&self) -> f64 {
        if self.leads_reversed { -1.0 } else { 1.0 }
    }

    fn encoder_turns(&self) -> f64 {
        let radians = match self.params.encoder.side {
            ShaftSide::Motor => self.mechanics.motor().0,
            ShaftSide::Load => self.mechanics.load().0,
        };
        radians / std::f64::consts::TAU
    }

    fn change_encoder(&mut self, change: impl FnOnce(&mut EncoderFaults)) {
        let mut faults = self.encoder.faults;
        change(&mut faults);
        let turns = self.encoder_turns();
        self.encoder.set_faults(faults, turns);
    }
}

/// A winding's current driven towards zero by the diodes.
struct DyingCurrent {
    amps: f64,
    /// Where the current would settle, on the other side of zero, if the diodes let it.
    settled_amps: f64,
    time_constant_s: f64,
}

impl DyingCurrent {
    /// (current, charge passed) after `dt_s`.
    fn after(&self, dt_s: f64) -> (f64, f64) {
        let swing = self.amps - self.settled_amps;
        let zero_s = self.time_constant_s * (swing / -self.settled_amps).ln();
        let lasts_s = if zero_s.is_nan() { dt_s } else { zero_s.min(dt_s) };
        let left = (-lasts_s / self.time_constant_s).exp();
        let coulombs = self.settled_amps * lasts_s + swing * self.time_constant_s * (1.0 - left);
        let end = if lasts_s < dt_s { 0.0 } else { self.settled_amps + swing * left };
        (end, coulombs)
    }
}

impl Mechanics {
    fn fastest_radians_per_second(&self) -> f64 {
        match self {
            Self::Rigid(rigid) => rigid.fastest_radians_per_second(),
            Self::TwoMass(two) => two.fastest_radians_per_second(),
        }
    }

    fn charge_line(&mut self, step_s: f64) -> (f64, f64) {
        match self {
            Self::Rigid(rigid) => rigid.charge_line(step_s),
            Self::TwoMass(two) => two.charge_line(step_s),
        }
    }

    fn step(&mut self, push: Push, step_s: f64) -> f64 {
        match self {
            Self::Rigid(rigid) => rigid.step(push, step_s),
            Self::TwoMass(two) => two.step(push, step_s),
        }
    }

    fn amps(&self) -> f64 {
        match self {
            Self::Rigid(rigid) => rigid.amps,
            Self::TwoMass(two) => two.amps(),
        }
    }

    fn set_amps(&mut self, amps: f64) {
        match self {
            Self::Rigid(rigid) => rigid.amps = amps,
            Self::TwoMass(two) => two.set_amps(amps),
        }
    }

    /// (radians, radians per second) of the motor shaft.
    fn motor(&self) -> (f64, f64) {
        match self {
            Self::Rigid(rigid) => (rigid.motor_radians, rigid.motor_radians_per_second),
            Self::TwoMass(two) => (two.motor_radians(), two.motor_radians_per_second()),
        }
    }

    /// (radians, radians per second) of the output shaft.
    fn load(&self) -> (f64, f64) {
        match self {
            Self::Rigid(rigid) => (rigid.load_radians(), rigid.load_radians_per_second()),
            Self::TwoMass(two) => (two.load_radians(), two.load_radians_per_second()),
        }
    }
}
