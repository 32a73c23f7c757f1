//! Any command at any time in any condition: no panic, and a bridge output that is one.

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{
    AntiWindup, BridgeOverride, Buffering, Conditions, ControlLaw, DerivativeOf, DistanceEnd, DistanceMove,
    GainTiming, MotionCommand, MotionSettings, PositionForm, PositionMove, PositionTarget, RelayCommand,
    RelayOn, VelocityEstimate,
};
use brushwork_plant::bridge::BridgeOutput;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Draws values with a taste for the ends of their range.
struct Dice(ChaCha8Rng);

impl Dice {
    fn u32(&mut self) -> u32 {
        match self.0.next_u32() % 6 {
            0 => 0,
            1 => u32::MAX,
            2 => 1,
            3 => self.0.next_u32() % 50_000,
            4 => i32::MAX as u32,
            _ => self.0.next_u32(),
        }
    }

    fn i32(&mut self) -> i32 {
        self.u32() as i32
    }

    fn i16(&mut self) -> i16 {
        self.u32() as i16
    }

    fn optional(&mut self) -> Option<u32> {
        self.one_in(3).then(|| self.u32())
    }

    fn one_in(&mut self, n: u32) -> bool {
        self.0.next_u32().is_multiple_of(n)
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.0.next_u32() as usize % from.len()]
    }

    fn command(&mut self) -> MotionCommand {
        let buffering = self.pick(&[Buffering::Queue, Buffering::Immediate]);
        match self.0.next_u32() % 8 {
            0 => MotionCommand::Duty { duty_raw: self.i16(), acceleration_raw: self.optional() },
            1 => MotionCommand::Speed { speed_counts_per_s: self.i32(), acceleration: self.optional() },
            2 | 3 => MotionCommand::Distance(
                DistanceMove {
                    speed_counts_per_s: self.i32(),
                    acceleration: self.optional(),
                    distance_counts: self.u32(),
                },
                buffering,
            ),
            4 => MotionCommand::Position(
                PositionMove {
                    acceleration: self.optional(),
                    speed_counts_per_s: self.optional(),
                    deceleration: self.optional(),
                    target: if self.one_in(2) {
                        PositionTarget::Counts(self.i32())
                    } else {
                        PositionTarget::Percent(self.i16())
                    },
                },
                buffering,
            ),
            5 => MotionCommand::Relay(RelayCommand {
                on: self.pick(&[RelayOn::Speed, RelayOn::Position]),
                amplitude_raw: self.u32(),
                hysteresis: self.u32(),
            }),
            6 => MotionCommand::Home { duty_raw: self.i16(), timeout_300ths: self.u32() },
            _ => self.pick(&[MotionCommand::SafeStop, MotionCommand::Coast]),
        }
    }

    fn settings(&mut self) -> MotionSettings {
        MotionSettings {
            velocity_p_raw: self.u32(),
            velocity_i_raw: self.u32(),
            velocity_d_raw: self.u32(),
            qpps: self.u32(),
            position_p_raw: self.u32(),
            position_i_raw: self.u32(),
            position_d_raw: self.u32(),
            position_max_i: self.u32(),
            position_deadzone_counts: self.u32(),
            position_min_counts: self.i32(),
            position_max_counts: self.i32(),
            default_accel_raw: self.u32(),
            default_decel_raw: self.u32(),
            default_speed_raw: self.u32() as u16,
            inductance_raw: self.u32(),
            resistance_raw: self.u32(),
            max_current_raw: self.u32(),
            min_current_raw: self.i32(),
            speed_error_limit: self.u32(),
            position_error_limit: self.u32(),
            pwm_idle_raw: self.u32() as u8,
        }
    }

    fn conditions(&mut self) -> Conditions {
        Conditions {
            safe_stop: self.one_in(10),
            off: self.one_in(10),
            reverse: self.one_in(4),
            forward_limit: self.one_in(6),
            backward_limit: self.one_in(6),
            bridge: if self.one_in(8) {
                self.pick(&[BridgeOverride::Brake, BridgeOverride::Freewheel])
            } else {
                BridgeOverride::None
            },
            current_limit_share: self.pick(&[0.0, 0.3, 1.0]),
        }
    }

    fn law(&mut self) -> ControlLaw {
        ControlLaw {
            rate_hz: self.pick(&[0, 300, 625, 10_000]),
            gain_timing: self.pick(&[GainTiming::PerTick, GainTiming::PerSecond]),
            derivative_timing: self.pick(&[None, Some(GainTiming::PerTick), Some(GainTiming::PerSecond)]),
            velocity_estimate: self.pick(&[
                VelocityEstimate::LastTick,
                VelocityEstimate::MovingAverage { ticks: 7 },
                VelocityEstimate::LowPass { time_constant_s: 0.02 },
            ]),
            derivative_of: self.pick(&[DerivativeOf::Error, DerivativeOf::Measurement]),
            derivative_filter_s: self.pick(&[0.0, 0.01]),
            output_delay_ticks: self.u32() as u8,
            anti_windup: self.pick(&[AntiWindup::BackCalculation, AntiWindup::Hold, AntiWindup::None]),
            position_form: self.pick(&[PositionForm::TargetError, PositionForm::ProfileTracking]),
            distance_end: self.pick(&[DistanceEnd::CarryOn, DistanceEnd::AlwaysStop]),
            ..ControlLaw::default()
        }
    }
}

fn assert_sound(output: BridgeOutput, seed: u64) {
    let duty = output.duty();
    assert!(duty.is_finite() && duty.abs() <= 1.0, "seed {seed}: {output:?}");
}

#[test]
fn no_command_setting_or_condition_breaks_a_channel() {
    for seed in 0..300 {
        let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
        let mut rig = Rig::new(&dice.law(), settings(1.0, 0.1, 0.0), Motor::lag(10_000.0, 0.05));
        for _ in 0..60 {
            if dice.one_in(2) {
                rig.settings = dice.settings();
            }
            rig.conditions = dice.conditions();
            let _ = rig.command(dice.command());
            if dice.one_in(10) {
                rig.channel.encoder_mut().set(dice.u32());
            }
            for _ in 0..10 {
                assert_sound(rig.tick(), seed);
                let amps = dice.pick(&[0.0, 40.0, -300.0, f64::MAX]);
                let volts = dice.pick(&[0.0, 24.0]);
                assert_sound(rig.channel.refine(amps, volts, 0.0005), seed);
            }
            let _ = rig.channel.state();
            let _ = (rig.channel.speeds(), rig.channel.errors(), rig.channel.relay_result_raw());
        }
    }
}

#[test]
fn the_same_commands_give_the_same_outputs() {
    let run = || {
        let mut dice = Dice(ChaCha8Rng::seed_from_u64(7));
        let mut rig = Rig::new(&ControlLaw::default(), settings(1.0, 0.1, 0.0), Motor::lag(10_000.0, 0.05));
        let mut outputs = Vec::new();
        for _ in 0..100 {
            let _ = rig.command(dice.command());
            outputs.extend((0..20).map(|_| rig.tick().duty().to_bits()));
        }
        outputs
    };
    assert_eq!(run(), run());
}
