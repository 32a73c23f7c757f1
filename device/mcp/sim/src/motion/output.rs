//! The output stage of a channel: current limit, torque loop and what they make of the loops' demand.
//!
//! It may run several times within a tick, since motor currents change faster than any documented loop rate.

use super::{BridgeOverride, ControlLaw, MotionSettings};
use brushwork_plant::bridge::BridgeOutput;
use std::f64::consts::TAU;

/// Shorter steps are rounding errors of whoever divides a tick.
const SHORTEST_STEP_S: f64 = 1e-9;

/// What the loops ask of the output stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Demand {
    /// Open bridge.
    Coast,
    /// Duty, -1 to 1.
    Duty(f64),
    /// Current setpoint, A, positive for forward torque (torque mode).
    Current(f64),
}

/// Limits and motor data the stage works with, refreshed at each tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StageSettings {
    limits: Option<CurrentLimits>,
    motor: Option<MotorModel>,
    bandwidth_rad_per_s: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct CurrentLimits {
    driving_amps: f64,
    braking_amps: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct MotorModel {
    ohms: f64,
    henries: f64,
}

impl StageSettings {
    pub fn new(settings: &MotionSettings, share: f64, law: &ControlLaw) -> Self {
        let share = share.clamp(0.0, 1.0);
        let limits = settings.max_current_amps().map(|driving| CurrentLimits {
            driving_amps: driving * share,
            braking_amps: settings.braking_current_amps().unwrap_or(driving) * share,
        });
        let motor = settings
            .torque_mode()
            .then(|| MotorModel { ohms: settings.resistance_ohms(), henries: settings.inductance_henries() });
        StageSettings { limits, motor, bandwidth_rad_per_s: TAU * law.current_bandwidth_hz }
    }
}

/// The stage of one channel.
#[derive(Clone, Debug)]
pub(crate) struct OutputStage {
    demand: Demand,
    bridge: BridgeOverride,
    settings: StageSettings,
    limiter: CurrentLimiter,
    torque: TorqueLoop,
    output: BridgeOutput,
}

impl OutputStage {
    pub fn new(settings: StageSettings) -> Self {
        OutputStage {
            demand: Demand::Duty(0.0),
            bridge: BridgeOverride::None,
            settings,
            limiter: CurrentLimiter::new(),
            torque: TorqueLoop::default(),
            output: BridgeOutput::Duty(0.0),
        }
    }

    pub fn set(&mut self, demand: Demand, bridge: BridgeOverride, settings: StageSettings) {
        if !matches!((self.demand, demand), (Demand::Current(_), Demand::Current(_))) {
            self.torque.start_from(self.output.duty());
        }
        self.demand = demand;
        self.bridge = bridge;
        self.settings = settings;
    }

    /// The output as last given.
    pub fn output(&self) -> BridgeOutput {
        self.output
    }

    /// Lowest and highest duty the current limit leaves, for the loops' anti-windup.
    pub fn bounds(&self) -> (f64, f64) {
        (self.limiter.lowest, self.limiter.highest)
    }

    /// Whether the demand is a current.
    pub fn drives_current(&self) -> bool {
        matches!(self.demand, Demand::Current(_))
    }

    /// Whether the current limit holds the output back.
    pub fn is_limiting(&self) -> bool {
        self.limiter.limiting
    }

    /// Goes on by `dt_s` with the current measured at its end. A step of no length takes over a new demand, while limit and
    /// torque loop wait.
    pub fn step(&mut self, amps: f64, bus_volts: f64, dt_s: f64) -> BridgeOutput {
        let dt_s = if dt_s < SHORTEST_STEP_S { 0.0 } else { dt_s };
        self.output = match (self.bridge, self.demand) {
            (BridgeOverride::Brake, _) => BridgeOutput::Brake,
            (BridgeOverride::Freewheel, _) | (_, Demand::Coast) => BridgeOutput::Coast,
            (BridgeOverride::None, Demand::Duty(duty)) => {
                return self.step_duty(duty, amps, dt_s);
            }
            (BridgeOverride::None, Demand::Current(setpoint)) => {
                BridgeOutput::Duty(self.step_current(setpoint, amps, bus_volts, dt_s))
            }
        };
        self.limiter.release();
        if !matches!(self.output, BridgeOutput::Duty(_)) {
            self.torque.start_from(0.0);
        }
        self.output
    }

    fn step_duty(&mut self, duty: f64, amps: f64, dt_s: f64) -> BridgeOutput {
        let limited = match self.settings.limits {
            Some(limits) => self.limiter.step(duty, self.output.duty(), amps, &limits, dt_s),
            None => {
                self.limiter.release();
                duty
            }
        };
        self.output = BridgeOutput::Duty(limited);
        self.output
    }

    fn step_current(&mut self, setpoint: f64, amps: f64, bus_volts: f64, dt_s: f64) -> f64 {
        let Some(motor) = self.settings.motor else { return 0.0 };
        let setpoint = match self.settings.limits {
            Some(limits) => setpoint.clamp(-limits.driving_amps, limits.driving_amps),
            None => setpoint,
        };
        self.torque.step(setpoint - amps, &motor, self.settings.bandwidth_rad_per_s, bus_volts, dt_s)
    }
}

/// Keeps the motor current within its limits by closing in on the duty from above and below.
///
/// Assumed: an integrating limiter. It learns how steeply the current follows the duty from the largest ratio it has
/// seen, which a start from standstill shows.
#[derive(Clone, Copy, Debug)]
struct CurrentLimiter {
    lowest: f64,
    highest: f64,
    amps_per_duty: f64,
    limiting: bool,
}

/// How fast the limiter corrects, rad/s.
const LIMITER_BANDWIDTH: f64 = 600.0;
/// Stall current at full duty in units of the limit that the limiter takes for granted before it has seen more.
const ASSUMED_STALL_RATIO: f64 = 5.0;
/// Duty below which the ratio of current to duty says nothing.
const LEARNING_DUTY: f64 = 0.1;

impl CurrentLimiter {
    fn new() -> Self {
        CurrentLimiter { lowest: -1.0, highest: 1.0, amps_per_duty: 0.0, limiting: false }
    }

    fn release(&mut self) {
        self.lowest = -1.0;
        self.highest = 1.0;
        self.limiting = false;
    }

    fn step(&mut self, demand: f64, applied: f64, amps: f64, limits: &CurrentLimits, dt_s: f64) -> f64 {
        if applied.abs() > LEARNING_DUTY && amps * applied > 0.0 {
            self.amps_per_duty = self.amps_per_duty.max(amps / applied);
        }
        let slope = self.amps_per_duty.max(ASSUMED_STALL_RATIO * limits.driving_amps).max(f64::MIN_POSITIVE);
        let per_amp = (1.0 - (-LIMITER_BANDWIDTH * dt_s).exp()) / slope;
        let (forward, backward) = if applied < 0.0 {
            (limits.braking_amps, limits.driving_amps)
        } else {
            (limits.driving_amps, limits.braking_amps)
        };
        self.highest = close_in(self.highest, applied, (forward - amps) * per_amp);
        self.lowest = -close_in(-self.lowest, -applied, (backward + amps) * per_amp);
        self.lowest = self.lowest.min(self.highest);
        let limited = demand.clamp(self.lowest, self.highest);
        self.limiting = limited != demand;
        limited
    }
}

/// The upper bound after a correction: one downwards starts at what is applied.
fn close_in(bound: f64, applied: f64, correction: f64) -> f64 {
    let start = if correction < 0.0 { bound.min(applied) } else { bound };
    (start + correction).clamp(-1.0, 1.0)
}

/// PI current loop placed from L and R: it cancels the winding's pole and leaves a first-order response at the law's
/// bandwidth, exactly so at any step length. Saturation cannot wind it up, since it counts on from the voltage it gave.
#[derive(Clone, Copy, Debug, Default)]
struct TorqueLoop {
    duty: f64,
    last_error: f64,
    gains: Option<TorqueGains>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct TorqueGains {
    motor: MotorModel,
    bandwidth: f64,
    dt_s: f64,
    volts_per_amp: f64,
    winding_pole: f64,
}

impl TorqueGains {
    fn new(motor: MotorModel, bandwidth: f64, dt_s: f64) -> Self {
        let winding_pole = (-motor.ohms * dt_s / motor.henries).exp();
        let closed_pole = (-bandwidth * dt_s).exp();
        let volts_per_amp = motor.ohms * (1.0 - closed_pole) / (1.0 - winding_pole).max(1e-12);
        TorqueGains { motor, bandwidth, dt_s, volts_per_amp, winding_pole }
    }
}

impl TorqueLoop {
    fn start_from(&mut self, duty: f64) {
        self.duty = duty;
        self.last_error = 0.0;
    }

    fn step(&mut self, error: f64, motor: &MotorModel, bandwidth: f64, bus_volts: f64, dt_s: f64) -> f64 {
        if bus_volts <= 0.0 || dt_s <= 0.0 {
            return self.duty;
        }
        let gains = match self.gains {
            Some(gains) if gains.motor == *motor && gains.bandwidth == bandwidth && gains.dt_s == dt_s => {
                gains
            }
            _ => *self.gains.insert(TorqueGains::new(*motor, bandwidth, dt_s)),
        };
        let volts = gains.volts_per_amp * (error - gains.winding_pole * self.last_error);
        self.last_error = error;
        self.duty = (self.duty + volts / bus_volts).clamp(-1.0, 1.0);
        self.duty
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUS_VOLTS: f64 = 24.0;
    const DT_S: f64 = 1.0 / 3000.0;

    /// A winding with a back-EMF, stepped exactly.
    struct Winding {
        ohms: f64,
        henries: f64,
        emf_volts: f64,
        amps: f64,
    }

    impl Winding {
        fn advance(&mut self, output: BridgeOutput, dt_s: f64) {
            let steady = (output.duty() * BUS_VOLTS - self.emf_volts) / self.ohms;
            self.amps = steady + (self.amps - steady) * (-self.ohms * dt_s / self.henries).exp();
        }
    }

    fn stage(settings: &MotionSettings, demand: Demand) -> OutputStage {
        let settings = StageSettings::new(settings, 1.0, &ControlLaw::default());
        let mut stage = OutputStage::new(settings);
        stage.set(demand, BridgeOverride::None, settings);
        stage
    }

    fn run(stage: &mut OutputStage, winding: &mut Winding, steps: usize) -> Vec<f64> {
        (0..steps)
            .map(|_| {
                let output = stage.step(winding.amps, BUS_VOLTS, DT_S);
                winding.advance(output, DT_S);
                winding.amps
            })
            .collect()
    }

    fn limited(max_amps: u32) -> MotionSettings {
        MotionSettings { max_current_raw: max_amps * 100, ..MotionSettings::default() }
    }

    #[test]
    fn a_stalled_motor_settles_at_its_limit_within_20_ms() {
        for ohms in [0.1, 0.5, 2.0] {
            let mut stage = stage(&limited(10), Demand::Duty(1.0));
            let mut winding = Winding { ohms, henries: ohms * 0.5e-3, emf_volts: 0.0, amps: 0.0 };
            let amps = run(&mut stage, &mut winding, 600);
            assert!(stage.is_limiting());
            for (step, amps) in amps.iter().enumerate().skip(60) {
                assert!((amps - 10.0).abs() < 0.5, "{ohms} ohm: {amps} A at step {step}");
            }
        }
    }

    #[test]
    fn braking_from_speed_is_held_to_the_braking_limit() {
        let settings = MotionSettings { min_current_raw: 300, ..limited(10) };
        let mut stage = stage(&settings, Demand::Duty(0.9));
        let mut winding = Winding { ohms: 0.5, henries: 0.25e-3, emf_volts: 20.0, amps: 0.0 };
        run(&mut stage, &mut winding, 300);
        stage.set(Demand::Duty(0.0), BridgeOverride::None, stage.settings);
        let amps = run(&mut stage, &mut winding, 600);
        let settled = &amps[150..];
        assert!(settled.iter().all(|amps| (amps + 3.0).abs() < 0.2), "{:?}", &amps[150..160]);
        assert!(stage.is_limiting());
    }

    #[test]
    fn the_limiter_lets_go_once_the_motor_turns() {
        let mut stage = stage(&limited(5), Demand::Duty(1.0));
        let mut winding = Winding { ohms: 1.0, henries: 0.5e-3, emf_volts: 0.0, amps: 0.0 };
        run(&mut stage, &mut winding, 300);
        winding.emf_volts = 23.0;
        run(&mut stage, &mut winding, 300);
        assert!(!stage.is_limiting());
        assert_eq!(stage.output(), BridgeOutput::Duty(1.0));
    }

    #[test]
    fn temperature_scales_the_limit() {
        let settings = StageSettings::new(&limited(10), 0.25, &ControlLaw::default());
        let mut stage = OutputStage::new(settings);
        stage.set(Demand::Duty(1.0), BridgeOverride::None, settings);
        let mut winding = Winding { ohms: 0.5, henries: 0.25e-3, emf_volts: 0.0, amps: 0.0 };
        let amps = run(&mut stage, &mut winding, 600);
        assert!((amps[599] - 2.5).abs() < 0.1, "{}", amps[599]);
    }

    fn torque_settings(ohms: f64, henries: f64) -> MotionSettings {
        MotionSettings {
            resistance_raw: (ohms * 16_777_216.0) as u32,
            inductance_raw: (henries * 16_777_216.0) as u32,
            ..limited(20)
        }
    }

    #[test]
    fn the_torque_loop_answers_a_step_at_its_bandwidth_whatever_the_back_emf() {
        for emf_volts in [0.0, 8.0, -8.0] {
            let mut stage = stage(&torque_settings(0.5, 0.5e-3), Demand::Current(5.0));
            let mut winding = Winding { ohms: 0.5, henries: 0.5e-3, emf_volts, amps: -emf_volts / 0.5 };
            let amps = run(&mut stage, &mut winding, 600);
            assert!((amps[599] - 5.0).abs() < 0.01, "emf {emf_volts}: {}", amps[599]);
        }
        let mut stage = stage(&torque_settings(0.5, 0.5e-3), Demand::Current(5.0));
        let mut winding = Winding { ohms: 0.5, henries: 0.5e-3, emf_volts: 0.0, amps: 0.0 };
        let amps = run(&mut stage, &mut winding, 60);
        let pole = (-TAU * 200.0 * DT_S).exp();
        for (step, amps) in amps.iter().enumerate() {
            let expected = 5.0 * (1.0 - pole.powi(i32::try_from(step).unwrap() + 1));
            assert!((amps - expected).abs() < 0.02, "step {step}: {amps} A, expected {expected}");
        }
    }

    #[test]
    fn the_torque_loop_comes_out_of_saturation_at_once() {
        let mut stage = stage(&torque_settings(0.5, 0.5e-3), Demand::Current(15.0));
        let mut winding = Winding { ohms: 0.5, henries: 0.5e-3, emf_volts: 22.0, amps: 0.0 };
        let amps = run(&mut stage, &mut winding, 3_000);
        assert!((amps[2_999] - 4.0).abs() < 0.01, "all the battery can give");
        stage.set(Demand::Current(1.0), BridgeOverride::None, stage.settings);
        let amps = run(&mut stage, &mut winding, 30);
        assert!((amps[29] - 1.0).abs() < 0.1, "{}", amps[29]);
    }

    #[test]
    fn overrides_win_over_any_demand() {
        let mut stage = stage(&limited(10), Demand::Duty(1.0));
        stage.set(Demand::Duty(1.0), BridgeOverride::Brake, stage.settings);
        assert_eq!(stage.step(0.0, BUS_VOLTS, DT_S), BridgeOutput::Brake);
        stage.set(Demand::Duty(1.0), BridgeOverride::Freewheel, stage.settings);
        assert_eq!(stage.step(0.0, BUS_VOLTS, DT_S), BridgeOutput::Coast);
        stage.set(Demand::Coast, BridgeOverride::None, stage.settings);
        assert_eq!(stage.step(0.0, BUS_VOLTS, DT_S), BridgeOutput::Coast);
    }
}
