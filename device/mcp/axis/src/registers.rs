//! Gains as the registers of a controller, and back: the rounded gains are what the loop gets.

use brushwork_tuning::axis::AxisError;
use brushwork_tuning::law::{Law, Windup};
use brushwork_tuning::model::{DerivativeFilter, Gains, Pid};
use serde::{Deserialize, Serialize};

/// Wire value of a velocity gain of 1 (MCP manual, command 28).
pub const VELOCITY_SCALE: f64 = 65_536.0;

/// The firmware's law, as far as the tuner must know it.
///
/// Assumed, since none of it is public: `duty = (feed_forward v + P e + I sum(e) + D diff(e)) / QPPS`. A run measures its figures, but
/// for the velocity's D, which no gains of ours use: its scale is taken to be that of P.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct McpLaw {
    /// Loop rate, Hz.
    pub rate_hz: u32,
    /// Whether I and D count per tick; otherwise per second.
    pub per_tick: bool,
    /// Wire value of a position gain of 1.
    pub position_scale: f64,
    /// How much of the setpoint over QPPS is added to the duty: all of it is `true` in a file, none is `false`.
    #[serde(with = "share")]
    pub feed_forward: f64,
    /// Wire value of a velocity P of 1.
    #[serde(default = "usual_scale", skip_serializing_if = "is_usual_scale")]
    pub velocity_scale: f64,
    /// Wire value of a velocity I that adds the error once per tick, or per second.
    #[serde(default = "usual_scale", skip_serializing_if = "is_usual_scale")]
    pub integral_scale: f64,
    /// Whether the velocity loop takes its sum before the present error is added to it (forward Euler), not after (backward Euler).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub forward_sum: bool,
    /// What the integral of the velocity loop does while its duty is cut.
    #[serde(default, skip_serializing_if = "is_open")]
    pub windup: Windup,
    /// Seconds that a position D of 1 multiplies the speed with, where that is not what I counts by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative_s: Option<f64>,
    /// The filter of the speed that a position D sees, where it sees that of the velocity loop and no differences of counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative_filter: Option<DerivativeFilter>,
}

fn usual_scale() -> f64 {
    VELOCITY_SCALE
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn is_usual_scale(scale: &f64) -> bool {
    *scale == VELOCITY_SCALE
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn is_open(windup: &Windup) -> bool {
    *windup == Windup::Open
}

/// A share as files have it: reports of earlier versions know all or nothing.
mod share {
    use serde::{Deserialize, Deserializer, Serializer};

    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Share {
        Whole(bool),
        Part(f64),
    }

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    pub(super) fn serialize<S: Serializer>(share: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        match *share {
            1.0 => serializer.serialize_bool(true),
            0.0 => serializer.serialize_bool(false),
            part => serializer.serialize_f64(part),
        }
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(match Share::deserialize(deserializer)? {
            Share::Whole(whole) => f64::from(u8::from(whole)),
            Share::Part(part) => part,
        })
    }
}

impl Default for McpLaw {
    /// Assumed: 300 Hz, gains per tick, position gains x 1024, with feed-forward.
    fn default() -> Self {
        Self {
            rate_hz: 300,
            per_tick: true,
            position_scale: 1024.0,
            feed_forward: 1.0,
            velocity_scale: VELOCITY_SCALE,
            integral_scale: VELOCITY_SCALE,
            forward_sum: false,
            windup: Windup::Open,
            derivative_s: None,
            derivative_filter: None,
        }
    }
}

impl McpLaw {
    /// Seconds that a position D of 1 multiplies the speed with.
    #[must_use]
    pub fn derivative_s(&self) -> f64 {
        self.derivative_s.unwrap_or_else(|| self.tick_s() / self.gain_step())
    }

    /// What a sum that the present error is not in yet takes from P, per I: the same loop is one with that sum and less P.
    pub(crate) fn sum_late_s(&self) -> f64 {
        if self.forward_sum { self.tick_s() } else { 0.0 }
    }

    /// Seconds that one unit of the integral or derivative stands for.
    fn gain_step(&self) -> f64 {
        if self.per_tick { 1.0 } else { self.tick_s() }
    }
}

/// Registers of the velocity loop as they travel (commands 28, 55): gains x 65536, QPPS in counts/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct VelocityRegisters {
    /// Proportional.
    pub p: u32,
    /// Integral.
    pub i: u32,
    /// Derivative.
    pub d: u32,
    /// Speed at full duty, counts/s.
    pub qpps: u32,
}

/// Registers of the position loop as they travel (commands 61, 63).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PositionRegisters {
    /// Proportional.
    pub p: u32,
    /// Integral.
    pub i: u32,
    /// Derivative.
    pub d: u32,
    /// Bound of the integral.
    pub max_i: u32,
    /// Errors up to this many counts are none.
    pub deadzone: u32,
    /// Lowest position, counts.
    pub min: i32,
    /// Highest position, counts.
    pub max: i32,
}

/// The loops that a controller holds before a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct McpHeld {
    /// Velocity loop (commands 55, 56).
    pub velocity: VelocityRegisters,
    /// Position loop (commands 63, 64).
    pub position: PositionRegisters,
}

/// The loops that are proposed; none in a refusal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct McpRegisters {
    /// Velocity loop.
    pub velocity: Option<VelocityRegisters>,
    /// Position loop, of the methods that have one.
    pub position: Option<PositionRegisters>,
}

/// One loop is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum McpWrite {
    /// Velocity loop (commands 28, 29).
    Velocity(VelocityRegisters),
    /// Position loop (commands 61, 62).
    PositionLoop(PositionRegisters),
}

/// The same with its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum McpNote {
    /// Velocity registers written.
    Velocity(VelocityRegisters, Result<(), AxisError>),
    /// Position registers written.
    PositionLoop(PositionRegisters, Result<(), AxisError>),
}

/// Velocity registers of an MCP or RoboClaw.
#[must_use]
pub fn velocity_registers(velocity: &Pid, qpps: f64, law: &McpLaw) -> VelocityRegisters {
    let [p, i, d] = per_step(&Pid { p: velocity.p + velocity.i * law.sum_late_s(), ..*velocity }, law);
    let (scale, integral) = (law.velocity_scale, law.integral_scale);
    VelocityRegisters { p: raw(p, scale), i: raw(i, integral), d: raw(d, scale), qpps: whole(qpps) }
}

/// The velocity gains that registers stand for.
#[must_use]
pub fn velocity_gains(registers: &VelocityRegisters, law: &McpLaw) -> Pid {
    let step_s = law.tick_s() / law.gain_step();
    let i = f64::from(registers.i) / law.integral_scale / step_s;
    Pid {
        p: f64::from(registers.p) / law.velocity_scale - i * law.sum_late_s(),
        i,
        d: f64::from(registers.d) / law.velocity_scale * step_s,
    }
}

/// Position registers of an MCP or RoboClaw, with the travel as position limits.
#[must_use]
pub fn position_registers(gains: &Gains, law: &McpLaw, travel: (i32, i32)) -> PositionRegisters {
    let position = gains.position.unwrap_or_default();
    let [p, i, _] = per_step(&position, law).map(|gain| raw(gain, law.position_scale));
    let d = raw(position.d / law.derivative_s(), law.position_scale);
    // The integral is a sum over ticks where gains count per tick.
    let max_i = whole(gains.max_integral * law.gain_step() / law.tick_s());
    PositionRegisters { p, i, d, max_i, deadzone: whole(gains.deadzone_counts), min: travel.0, max: travel.1 }
}

/// The gains that both sets of registers stand for.
#[must_use]
pub fn gains_of(velocity: &VelocityRegisters, position: &PositionRegisters, law: &McpLaw) -> Gains {
    let step_s = law.tick_s() / law.gain_step();
    let scaled = |raw: u32| f64::from(raw) / law.position_scale;
    Gains {
        velocity: velocity_gains(velocity, law),
        velocity_sum: 0.0,
        position: Some(Pid {
            p: scaled(position.p),
            i: scaled(position.i) / step_s,
            d: scaled(position.d) * law.derivative_s(),
        }),
        max_integral: f64::from(position.max_i) * step_s,
        deadzone_counts: f64::from(position.deadzone),
    }
}

fn per_step(pid: &Pid, law: &McpLaw) -> [f64; 3] {
    let step_s = law.tick_s() / law.gain_step();
    [pid.p, pid.i * step_s, pid.d / step_s]
}

fn raw(gain: f64, scale: f64) -> u32 {
    // The cast saturates.
    (gain * scale).round() as u32
}

fn whole(value: f64) -> u32 {
    value.round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_and_gains_are_each_others_inverse_up_to_rounding() {
        let usual = McpLaw::default();
        let others =
            [McpLaw { rate_hz: 625, per_tick: false, ..usual }, McpLaw { forward_sum: true, ..usual }];
        for law in [usual].into_iter().chain(others) {
            let pid = Pid { p: 2.5, i: 40.0, d: 0.01 };
            let back = velocity_gains(&velocity_registers(&pid, 12_345.0, &law), &law);
            assert!((back.p - pid.p).abs() < 1e-4 && (back.i / pid.i - 1.0).abs() < 1e-3);
            assert!((back.d / pid.d - 1.0).abs() < 1e-2);
        }
    }

    /// Both sums tick by tick under the same registers: the one before the error is in it gives what the other gives with the gains that stand for it.
    #[test]
    fn a_sum_that_the_error_is_not_in_yet_is_less_p() {
        let law = McpLaw { forward_sum: true, ..McpLaw::default() };
        let registers = VelocityRegisters { p: 0x1_0000, i: 0x4000, d: 0, qpps: 10_000 };
        let gains = velocity_gains(&registers, &law);
        let (p, i) = (1.0, 0.25);
        let (mut before, mut after) = (0.0, 0.0);
        for error in [100.0, 60.0, -20.0, 5.0] {
            let of_unit = p * error + i * before;
            before += error;
            after += error * law.tick_s();
            let of_gains = gains.p * error + gains.i * after;
            assert!((of_unit - of_gains).abs() < 1e-9, "{of_unit} {of_gains}");
        }
    }

    #[test]
    fn the_factory_gains_are_one_half_and_a_quarter_per_tick() {
        let law = McpLaw::default();
        let factory = VelocityRegisters { p: 0x1_0000, i: 0x8000, d: 0x4000, qpps: 44_000 };
        let gains = velocity_gains(&factory, &law);
        assert_eq!((gains.p, gains.i), (1.0, 150.0));
        assert!((gains.d - 0.25 / 300.0).abs() < 1e-12);
    }
}
