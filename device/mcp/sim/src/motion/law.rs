//! The control law: everything about the closed loops that no manual documents, as data.
//!
//! The equations, rates and filters of the real firmware are not public. Each field here is a guess that was
//! checked only for consistency with the documented facts named beside it. A tuner must not trust any one of these laws, so that
//! all of them can be chosen; [`ControlLaw::default`] is the one place that says which the simulator uses unless told otherwise.

use brushwork_mcp_wire::packet_serial::scale;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Form, rate and filters of the loops of one controller. Both channels share it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ControlLaw {
    /// Loop rate in Hz, 50 to 10 000. Assumed: 300, since raw speed is counted over 1/300 s (MCP manual, command 30) and
    /// homing time-outs are in 1/300 s. 625 is the documented update rate of MCP input signals (MCP manual 1.9.12).
    pub rate_hz: u32,
    /// Whether I and D gains count per tick or per second.
    pub gain_timing: GainTiming,
    /// The same of D where it counts otherwise than I. Assumed: it does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub derivative_timing: Option<GainTiming>,
    /// Wire value of a position gain of 1.0. Assumed: 1024 (all vendor libraries); the manual's MCL chapter has 2048.
    pub position_gain_scale: f64,
    /// Whether the speed setpoint over QPPS is added to the output. Assumed: yes (vendor forum, 2018: QPPS *is* the
    /// feed-forward).
    pub feed_forward: bool,
    /// The speed the velocity loop acts on.
    pub velocity_estimate: VelocityEstimate,
    /// What the D term differentiates.
    pub derivative_of: DerivativeOf,
    /// Time constant of a first-order low pass on the D term, s; 0 = none. Assumed: none.
    pub derivative_filter_s: f64,
    /// Ticks between computing an output and the bridge taking it, 0 to [`ControlLaw::MAX_DELAY_TICKS`]. Assumed: 0.
    pub output_delay_ticks: u8,
    /// What happens to the integral while the output saturates.
    pub anti_windup: AntiWindup,
    /// How a position move is followed.
    pub position_form: PositionForm,
    /// What a distance move does at its end when another command waits behind it.
    pub distance_end: DistanceEnd,
    /// What an acceleration of 0 means in a duty command.
    pub zero_duty_acceleration: ZeroDutyAcceleration,
    /// Window of the raw speed (commands 30, 31, 79), in ticks. Assumed: one tick at 300 Hz, which is the documented
    /// 1/300 s; two at 625 Hz.
    pub raw_speed_ticks: u16,
    /// Window of the filtered speed (commands 18, 19), in ticks. Assumed: a moving average over 0.1 s; the manual says only
    /// that 30 is "an unfiltered version of command 18", and 108 is the one-second average.
    pub filtered_speed_ticks: u16,
    /// Closed-loop bandwidth of the current loop of torque mode, Hz. Assumed: 200.
    pub current_bandwidth_hz: f64,
    /// Units per second in which command 88/89 returns the relay period. Assumed: microseconds.
    pub relay_period_units_per_s: u32,
    /// Longest relay test, s. Assumed: 10. (The real one is documented to hang on wrong wiring, MCP manual 2.4.5.)
    pub relay_time_limit_s: u16,
}

/// Whether I and D gains count per tick or per second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GainTiming {
    /// The integral is a sum over ticks and the derivative a difference of ticks. Assumed default: only so do the factory I 0.5
    /// and D 0.25 with P 1.0, the manual's steps of 0.1 in I, and "D 5 to 20 times P" (2.4.7) make sense.
    PerTick,
    /// The integral is over seconds and the derivative per second.
    PerSecond,
}

/// The speed the velocity loop acts on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VelocityEstimate {
    /// Counts of the last tick times the rate. Assumed default.
    LastTick,
    /// Mean over the last `ticks` ticks, 1 up to one second's worth.
    MovingAverage {
        /// Length of the window.
        ticks: u16,
    },
    /// First-order low pass of the counts of each tick.
    LowPass {
        /// Time constant, s.
        time_constant_s: f64,
    },
}

/// What the D term differentiates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DerivativeOf {
    /// The control error, so that a setpoint step kicks. Assumed default.
    Error,
    /// The negated measurement.
    Measurement,
}

/// What happens to the integral while the output saturates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AntiWindup {
    /// The excess is taken back out of the integral. Assumed default (vendor forum: firmware 4.1.27 "added a back calculator").
    BackCalculation,
    /// The integral is held while the error drives further into saturation.
    Hold,
    /// The integral winds up.
    None,
}

/// How a position move is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PositionForm {
    /// The position loop acts on the distance to the target; its speed is limited by the command's speed and ramps.
    /// Assumed default.
    TargetError,
    /// The position loop follows a trapezoidal profile and adds the profile's speed.
    ProfileTracking,
}

/// What a distance move does at its end when another command waits behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DistanceEnd {
    /// It runs its whole distance at speed and the next command starts from there; with an empty queue it decelerates
    /// so as to end at the distance. Assumed default: the vendor's example queues a move of 42000 and one of speed 0, and
    /// counts the 6000 of the second one's ramp on top.
    CarryOn,
    /// It always stops at the distance.
    AlwaysStop,
}

/// What an acceleration of 0 means in a duty command (range 0 to 655359, MCP manual command 52).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ZeroDutyAcceleration {
    /// The highest rate, 100 % to -100 % in 100 ms. Assumed default.
    Fastest,
    /// No ramp at all, as in the manual's `move` example with acceleration 0.
    NoRamp,
    /// The duty never changes, the letter of "the rate at which the duty changes".
    Frozen,
}

impl Default for ControlLaw {
    fn default() -> Self {
        ControlLaw {
            rate_hz: 300,
            gain_timing: GainTiming::PerTick,
            derivative_timing: None,
            position_gain_scale: scale::POSITION_GAIN,
            feed_forward: true,
            velocity_estimate: VelocityEstimate::LastTick,
            derivative_of: DerivativeOf::Error,
            derivative_filter_s: 0.0,
            output_delay_ticks: 0,
            anti_windup: AntiWindup::BackCalculation,
            position_form: PositionForm::TargetError,
            distance_end: DistanceEnd::CarryOn,
            zero_duty_acceleration: ZeroDutyAcceleration::Fastest,
            raw_speed_ticks: 1,
            filtered_speed_ticks: 30,
            current_bandwidth_hz: 200.0,
            relay_period_units_per_s: 1_000_000,
            relay_time_limit_s: 10,
        }
    }
}

impl ControlLaw {
    /// Longest output delay, ticks.
    pub const MAX_DELAY_TICKS: u8 = 7;

    /// The default law at 625 Hz, the update rate the manual documents for input signals (MCP manual 1.9.12).
    #[must_use]
    pub fn at_625_hz() -> Self {
        ControlLaw { rate_hz: 625, raw_speed_ticks: 2, filtered_speed_ticks: 62, ..ControlLaw::default() }
    }

    /// The same law with every field brought into its documented range, so that no loop divides by zero.
    #[must_use]
    pub fn repaired(mut self) -> Self {
        let default = ControlLaw::default();
        self.rate_hz = self.rate_hz.clamp(50, 10_000);
        let second = u16::try_from(self.rate_hz).unwrap_or(u16::MAX);
        self.raw_speed_ticks = self.raw_speed_ticks.clamp(1, second);
        self.filtered_speed_ticks = self.filtered_speed_ticks.clamp(1, second);
        self.output_delay_ticks = self.output_delay_ticks.min(ControlLaw::MAX_DELAY_TICKS);
        self.relay_period_units_per_s = self.relay_period_units_per_s.max(1);
        self.position_gain_scale = positive_or(self.position_gain_scale, default.position_gain_scale);
        self.current_bandwidth_hz = positive_or(self.current_bandwidth_hz, default.current_bandwidth_hz);
        self.derivative_filter_s = positive_or(self.derivative_filter_s, 0.0);
        self.velocity_estimate = match self.velocity_estimate {
            VelocityEstimate::LastTick => VelocityEstimate::LastTick,
            VelocityEstimate::MovingAverage { ticks } => {
                VelocityEstimate::MovingAverage { ticks: ticks.clamp(1, second) }
            }
            VelocityEstimate::LowPass { time_constant_s } => {
                VelocityEstimate::LowPass { time_constant_s: positive_or(time_constant_s, 0.0) }
            }
        };
        self
    }

    /// Length of a tick, s.
    #[must_use]
    pub fn tick_s(&self) -> f64 {
        1.0 / f64::from(self.rate_hz)
    }

    /// When tick `number` is due, counted from a start at zero: exact to the nanosecond, without drift at rates that
    /// do not divide a second.
    #[must_use]
    pub fn tick_at(&self, number: u64) -> Duration {
        let rate = u64::from(self.rate_hz.max(1));
        let fraction = (number % rate) * 1_000_000_000 / rate;
        Duration::new(number / rate, u32::try_from(fraction).unwrap_or(0))
    }

    /// What each tick adds of the error to the integral: 1 per tick, or the tick length.
    #[must_use]
    pub fn gain_step(&self) -> f64 {
        self.step_of(self.gain_timing)
    }

    /// What a difference of two ticks is divided by for the derivative, likewise.
    #[must_use]
    pub fn derivative_step(&self) -> f64 {
        self.step_of(self.derivative_timing.unwrap_or(self.gain_timing))
    }

    fn step_of(&self, timing: GainTiming) -> f64 {
        match timing {
            GainTiming::PerTick => 1.0,
            GainTiming::PerSecond => self.tick_s(),
        }
    }
}

fn positive_or(value: f64, fallback: f64) -> f64 {
    if value.is_finite() && value > 0.0 { value } else { fallback }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_of_300_hz_fall_on_exact_seconds() {
        let law = ControlLaw::default();
        assert_eq!(law.tick_at(1), Duration::from_nanos(3_333_333));
        assert_eq!(law.tick_at(300), Duration::from_secs(1));
        assert_eq!(law.tick_at(3_000_001), Duration::from_secs(10_000) + Duration::from_nanos(3_333_333));
    }

    #[test]
    fn a_law_written_as_json_may_leave_out_what_it_does_not_change() {
        let law: ControlLaw = serde_json::from_str(
            r#"{"rate_hz": 625, "velocity_estimate": {"moving_average": {"ticks": 4}}}"#,
        )
        .unwrap();
        assert_eq!(law.rate_hz, 625);
        assert_eq!(law.velocity_estimate, VelocityEstimate::MovingAverage { ticks: 4 });
        assert_eq!(law.gain_timing, ControlLaw::default().gain_timing);
    }

    #[test]
    fn repair_leaves_a_good_law_alone_and_mends_a_broken_one() {
        assert_eq!(ControlLaw::default().repaired(), ControlLaw::default());
        assert_eq!(ControlLaw::at_625_hz().repaired(), ControlLaw::at_625_hz());
        let broken = ControlLaw {
            rate_hz: 0,
            raw_speed_ticks: 0,
            position_gain_scale: f64::NAN,
            velocity_estimate: VelocityEstimate::MovingAverage { ticks: 0 },
            ..ControlLaw::default()
        };
        let corrected = broken.repaired();
        assert_eq!(corrected.rate_hz, 50);
        assert_eq!(corrected.raw_speed_ticks, 1);
        assert_eq!(corrected.position_gain_scale, 1024.0);
        assert_eq!(corrected.velocity_estimate, VelocityEstimate::MovingAverage { ticks: 1 });
    }
}
