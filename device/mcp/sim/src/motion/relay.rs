//! The relay test of commands 84 to 89.
//!
//! Assumed throughout, since only the commands are public: the relay adds or takes away its amplitude of duty from what the bridge
//! gave when the test began, switches on the sign of the deviation from the speed or position of that moment, and reports half the
//! mean amplitude and the mean period of the last cycles.

use super::{RelayCommand, RelayOn};

/// Cycles that are let pass before measuring.
const SETTLING_CYCLES: u32 = 3;
/// Cycles that are measured.
const MEASURED_CYCLES: u32 = 6;

/// A test in progress.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelayTest {
    pub on: RelayOn,
    bias_duty: f64,
    amplitude_duty: f64,
    reference: f64,
    hysteresis: f64,
    pushing_up: bool,
    lowest: f64,
    highest: f64,
    cycles: u32,
    ticks: u32,
    last_cycle_end: u32,
    measured_ticks: u32,
    measured_span: f64,
    time_limit_ticks: u32,
}

/// State of a test after a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RelayStep {
    /// The duty to give, -1 to 1.
    Running(f64),
    /// The oscillation is measured.
    Done(Oscillation),
    /// No steady oscillation within the time limit.
    TimedOut,
}

/// What a relay test measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// Half the peak-to-peak oscillation, counts/s or counts.
    pub amplitude: f64,
    /// Length of one cycle, s.
    pub period_s: f64,
}

impl RelayTest {
    /// A test around `reference` (counts/s or counts) and `bias_duty`.
    pub fn new(command: &RelayCommand, bias_duty: f64, reference: f64, time_limit_ticks: u32) -> Self {
        RelayTest {
            on: command.on,
            bias_duty,
            amplitude_duty: (f64::from(command.amplitude_raw) / f64::from(super::FULL_DUTY_RAW)).min(1.0),
            reference,
            hysteresis: f64::from(command.hysteresis),
            pushing_up: true,
            lowest: f64::INFINITY,
            highest: f64::NEG_INFINITY,
            cycles: 0,
            ticks: 0,
            last_cycle_end: 0,
            measured_ticks: 0,
            measured_span: 0.0,
            time_limit_ticks,
        }
    }

    /// Takes the measurement of this tick.
    pub fn step(&mut self, measured: f64, tick_s: f64) -> RelayStep {
        self.ticks += 1;
        self.lowest = self.lowest.min(measured);
        self.highest = self.highest.max(measured);
        let deviation = measured - self.reference;
        if self.pushing_up && deviation > self.hysteresis {
            self.pushing_up = false;
        } else if !self.pushing_up && deviation < -self.hysteresis {
            self.pushing_up = true;
            if let Some(oscillation) = self.end_cycle(tick_s) {
                return RelayStep::Done(oscillation);
            }
        }
        if self.ticks >= self.time_limit_ticks {
            return RelayStep::TimedOut;
        }
        let push = if self.pushing_up { self.amplitude_duty } else { -self.amplitude_duty };
        RelayStep::Running((self.bias_duty + push).clamp(-1.0, 1.0))
    }

    fn end_cycle(&mut self, tick_s: f64) -> Option<Oscillation> {
        self.cycles += 1;
        if self.cycles > SETTLING_CYCLES {
            self.measured_ticks += self.ticks - self.last_cycle_end;
            self.measured_span += self.highest - self.lowest;
        }
        self.last_cycle_end = self.ticks;
        (self.lowest, self.highest) = (f64::INFINITY, f64::NEG_INFINITY);
        let cycles = f64::from(MEASURED_CYCLES);
        (self.cycles == SETTLING_CYCLES + MEASURED_CYCLES).then(|| Oscillation {
            amplitude: self.measured_span / (2.0 * cycles),
            period_s: f64::from(self.measured_ticks) * tick_s / cycles,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const TICK_S: f64 = 1.0 / 300.0;

    /// First-order lag with a dead time of whole ticks, stepped exactly.
    struct LagWithDeadTime {
        gain: f64,
        tau_s: f64,
        pipe: Vec<f64>,
        value: f64,
    }

    impl LagWithDeadTime {
        fn new(gain: f64, tau_s: f64, dead_ticks: usize) -> Self {
            LagWithDeadTime { gain, tau_s, pipe: vec![0.0; dead_ticks], value: 0.0 }
        }

        fn advance(&mut self, input: f64) -> f64 {
            self.pipe.insert(0, input);
            let delayed = self.pipe.pop().unwrap_or(input);
            let steady = self.gain * delayed;
            self.value = steady + (self.value - steady) * (-TICK_S / self.tau_s).exp();
            self.value
        }
    }

    fn oscillation(mut plant: LagWithDeadTime, amplitude_raw: u32, hysteresis: u32) -> Oscillation {
        let command = RelayCommand { on: RelayOn::Speed, amplitude_raw, hysteresis };
        let mut relay = RelayTest::new(&command, 0.0, 0.0, 30_000);
        let mut measured = 0.0;
        loop {
            match relay.step(measured, TICK_S) {
                RelayStep::Running(duty) => measured = plant.advance(duty),
                RelayStep::Done(oscillation) => return oscillation,
                RelayStep::TimedOut => panic!("no oscillation"),
            }
        }
    }

    #[test]
    fn a_lag_with_dead_time_oscillates_as_the_theory_of_relays_says() {
        let (gain, tau_s, dead_ticks) = (10_000.0, 0.2, 30);
        let dead_s = 0.1;
        let duty = 0.3;
        let measured =
            oscillation(LagWithDeadTime::new(gain, tau_s, dead_ticks), (duty * 32_767.0) as u32, 0);
        // Exact limit cycle of a relay on a lag with dead time.
        let amplitude = gain * duty * (1.0 - f64::exp(-dead_s / tau_s));
        let period_s = 2.0 * tau_s * (2.0 * f64::exp(dead_s / tau_s) - 1.0).ln();
        assert!((measured.amplitude / amplitude - 1.0).abs() < 0.03, "{} of {amplitude}", measured.amplitude);
        assert!((measured.period_s / period_s - 1.0).abs() < 0.03, "{} of {period_s}", measured.period_s);
        // Describing function: phase -pi at the frequency of oscillation; 15 % is its usual error on this plant.
        let mut omega = PI / dead_s;
        for _ in 0..100 {
            omega = (PI - (omega * tau_s).atan()) / dead_s;
        }
        let swing = 4.0 * duty / PI * gain / (1.0 + (omega * tau_s).powi(2)).sqrt();
        assert!((measured.period_s * omega / (2.0 * PI) - 1.0).abs() < 0.15);
        assert!((measured.amplitude / swing - 1.0).abs() < 0.25, "{} of {swing}", measured.amplitude);
    }

    #[test]
    fn hysteresis_lengthens_the_cycle_by_its_own_analytic_amount() {
        let (gain, tau_s) = (10_000.0, 0.2);
        let (duty, band) = (0.3, 900.0);
        let measured = oscillation(LagWithDeadTime::new(gain, tau_s, 0), (duty * 32_767.0) as u32, 900);
        // A lag between -h and h under +-d: half a period is tau ln((K d + h) / (K d - h)); each switch comes up to two
        // ticks late, one for sampling and one for the hold.
        let period_s = 2.0 * tau_s * ((gain * duty + band) / (gain * duty - band)).ln();
        assert!(measured.period_s >= period_s && measured.period_s < period_s + 4.0 * TICK_S, "{measured:?}");
        assert!(
            measured.amplitude >= band
                && measured.amplitude < band + 2.0 * gain * duty * TICK_S / tau_s * 1.4
        );
    }

    #[test]
    fn a_motor_that_runs_the_wrong_way_ends_at_the_time_limit() {
        let command = RelayCommand { on: RelayOn::Speed, amplitude_raw: 10_000, hysteresis: 0 };
        let mut relay = RelayTest::new(&command, 0.0, 0.0, 3_000);
        let mut plant = LagWithDeadTime::new(-10_000.0, 0.05, 0);
        let mut measured = 0.0;
        for tick in 1..=3_000 {
            match relay.step(measured, TICK_S) {
                RelayStep::Running(duty) => measured = plant.advance(duty),
                RelayStep::TimedOut => {
                    assert_eq!(tick, 3_000);
                    return;
                }
                RelayStep::Done(_) => panic!("no oscillation is possible"),
            }
        }
        panic!("the test outlived its time limit");
    }
}
