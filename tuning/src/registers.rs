//! Gains as the registers of a controller, and back: the rounded gains are what the loop gets.

use crate::axis::{PositionRegisters, VelocityRegisters};
use crate::model::{Gains, LoopLaw, Pid};
use serde::{Deserialize, Serialize};

/// Wire value of a velocity gain of 1 (MCP manual, command 28).
const VELOCITY_SCALE: f64 = 65_536.0;

/// Velocity registers of an MCP or RoboClaw.
#[must_use]
pub fn velocity_registers(velocity: &Pid, qpps: f64, law: &LoopLaw) -> VelocityRegisters {
    let [p, i, d] = per_step(velocity, law).map(|gain| raw(gain, VELOCITY_SCALE));
    VelocityRegisters { p, i, d, qpps: whole(qpps) }
}

/// The velocity gains that registers stand for.
#[must_use]
pub fn velocity_gains(registers: &VelocityRegisters, law: &LoopLaw) -> Pid {
    let step_s = law.tick_s() / law.gain_step();
    Pid {
        p: f64::from(registers.p) / VELOCITY_SCALE,
        i: f64::from(registers.i) / VELOCITY_SCALE / step_s,
        d: f64::from(registers.d) / VELOCITY_SCALE * step_s,
    }
}

/// Position registers of an MCP or RoboClaw, with the travel as position limits.
#[must_use]
pub fn position_registers(gains: &Gains, law: &LoopLaw, travel: (i32, i32)) -> PositionRegisters {
    let position = gains.position.unwrap_or_default();
    let [p, i, d] = per_step(&position, law).map(|gain| raw(gain, law.position_scale));
    // The integral is a sum over ticks where gains count per tick.
    let max_i = whole(gains.max_integral * law.gain_step() / law.tick_s());
    PositionRegisters { p, i, d, max_i, deadzone: whole(gains.deadzone_counts), min: travel.0, max: travel.1 }
}

/// The gains that both sets of registers stand for.
#[must_use]
pub fn gains_of(velocity: &VelocityRegisters, position: &PositionRegisters, law: &LoopLaw) -> Gains {
    let step_s = law.tick_s() / law.gain_step();
    let scaled = |raw: u32| f64::from(raw) / law.position_scale;
    Gains {
        velocity: velocity_gains(velocity, law),
        position: Some(Pid {
            p: scaled(position.p),
            i: scaled(position.i) / step_s,
            d: scaled(position.d) * step_s,
        }),
        max_integral: f64::from(position.max_i) * step_s,
        deadzone_counts: f64::from(position.deadzone),
    }
}

fn per_step(pid: &Pid, law: &LoopLaw) -> [f64; 3] {
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

/// Registers of a Motion Mind 3 (sections 3.10 to 3.15 of its manual): `PWM = (PTERM e + ITERM sum(e) + DTERM diff(e)) / 2^PIDSCALAR
/// + speed x VELOCITYFF / 255`, every 5 ms, 1023 = full duty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionMindRegisters {
    /// Proportional.
    pub pterm: u16,
    /// Integral.
    pub iterm: u16,
    /// Derivative.
    pub dterm: u16,
    /// Power of two that the sum is divided by.
    pub pidscalar: u8,
    /// Feed-forward, 255 = 1 per count and loop.
    pub velocity_ff: u8,
    /// Share of the wanted feed-forward that the register can carry; below 1 for slow encoders.
    pub covered_feed_forward: f64,
}

/// Position gains (counts in, counts/s out) as Motion Mind registers.
#[must_use]
pub fn motion_mind_registers(position: &Pid, qpps: f64) -> MotionMindRegisters {
    const LOOP_S: f64 = 0.005;
    const FULL_PWM: f64 = 1023.0;
    let plain = [position.p, position.i * LOOP_S, position.d / LOOP_S].map(|gain| FULL_PWM * gain / qpps);
    let fits =
        |scalar: u8| plain.iter().all(|gain| (gain * 2.0_f64.powi(i32::from(scalar))).round() <= 65_535.0);
    let pidscalar = (0..=32).rev().find(|scalar| fits(*scalar)).unwrap_or(0);
    let scale = 2.0_f64.powi(i32::from(pidscalar));
    let [pterm, iterm, dterm] = plain.map(|gain| (gain * scale).round() as u16);
    let wanted = 255.0 * FULL_PWM / (qpps * LOOP_S);
    let velocity_ff = wanted.round().min(255.0) as u8;
    MotionMindRegisters {
        pterm,
        iterm,
        dterm,
        pidscalar,
        velocity_ff,
        covered_feed_forward: (255.0 / wanted).min(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_and_gains_are_each_others_inverse_up_to_rounding() {
        for law in [LoopLaw::default(), LoopLaw { rate_hz: 625, per_tick: false, ..LoopLaw::default() }] {
            let pid = Pid { p: 2.5, i: 40.0, d: 0.01 };
            let back = velocity_gains(&velocity_registers(&pid, 12_345.0, &law), &law);
            assert!((back.p - pid.p).abs() < 1e-4 && (back.i / pid.i - 1.0).abs() < 1e-3);
            assert!((back.d / pid.d - 1.0).abs() < 1e-2);
        }
    }

    #[test]
    fn the_factory_gains_are_one_half_and_a_quarter_per_tick() {
        let law = LoopLaw::default();
        let factory = VelocityRegisters { p: 0x1_0000, i: 0x8000, d: 0x4000, qpps: 44_000 };
        let gains = velocity_gains(&factory, &law);
        assert_eq!((gains.p, gains.i), (1.0, 150.0));
        assert!((gains.d - 0.25 / 300.0).abs() < 1e-12);
    }

    #[test]
    fn motion_mind_feed_forward_saturates_below_204600_counts_per_second() {
        let slow = motion_mind_registers(&Pid { p: 10.0, i: 0.0, d: 0.1 }, 20_460.0);
        assert_eq!(slow.velocity_ff, 255);
        assert!((slow.covered_feed_forward - 0.1).abs() < 1e-9);
        assert!(slow.pterm.max(slow.dterm) > 32_767, "the scale uses the register's range: {slow:?}");
        assert_eq!(motion_mind_registers(&Pid::default(), 409_200.0).velocity_ff, 128);
    }
}
