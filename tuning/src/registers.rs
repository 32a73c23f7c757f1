//! Gains as the registers of a controller, and back: the rounded gains are what the loop gets.

use crate::axis::{PositionRegisters, VelocityRegisters};
use crate::model::{Gains, LoopLaw, Pid};

/// Wire value of a velocity gain of 1 (MCP manual, command 28).
pub(crate) const VELOCITY_SCALE: f64 = 65_536.0;

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
        velocity_sum: 0.0,
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
}
