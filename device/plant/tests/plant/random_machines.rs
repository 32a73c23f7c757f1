//! Machines drawn at random and treated at random: whatever they are, they stay finite, inside their travel and repeatable.

use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::presets::{presets, world_of};
use brushwork_plant::world::{World, WorldAction, WorldParams};
use brushwork_plant::{
    CouplingParams, Datasheet, EncoderKind, EncoderParams, GearParams, ShaftSide, StopKind, TravelParams,
};
use brushwork_values::Motor;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::time::Duration;

struct Dice(ChaCha8Rng);

impl Dice {
    fn share(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4_294_967_296.0
    }

    /// Even over the logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    fn coin(&mut self) -> bool {
        self.share() < 0.5
    }
}

fn machine(dice: &mut Dice) -> WorldParams {
    let mut params = world_of(&presets()[0], &presets()[0], 2);
    for axis in &mut params.axes {
        let sheet = Datasheet {
            volts: 24.0,
            no_load_radians_per_second: dice.between(1.0, 3000.0),
            stall_amps: dice.between(0.2, 400.0),
            mechanical_time_constant_s: dice.between(0.001, 5.0),
            electrical_time_constant_s: dice.between(1e-6, 0.02),
            coulomb_share: dice.between(0.001, 0.3),
            stiction_ratio: dice.between(1.0, 2.0),
            viscous_share: dice.between(0.001, 0.1),
            load_share: dice.share() * 0.98 + 0.01,
        };
        let gear = GearParams {
            ratio: dice.between(0.5, 500.0),
            backlash_radians: if dice.coin() { dice.between(1e-4, 0.3) } else { 0.0 },
        };
        let encoder = EncoderParams {
            kind: EncoderKind::Quadrature,
            counts_per_turn: dice.between(12.0, 65_536.0),
            side: if dice.coin() { ShaftSide::Motor } else { ShaftSide::Load },
            start_counts: 0.0,
            wraps: false,
            noise_counts: 0.0,
        };
        *axis = sheet.axis(gear, encoder);
        if dice.coin() {
            let coupling =
                CouplingParams::with_resonance(axis, dice.between(1.0, 3000.0), dice.between(0.001, 2.0));
            axis.load.coupling = Some(coupling);
        }
        if dice.coin() {
            let stop = if dice.coin() {
                StopKind::Hard
            } else {
                StopKind::Spring {
                    stiffness_newton_metres_per_radian: dice.between(1e-2, 1e9),
                    damping_newton_metre_seconds_per_radian: dice.between(1e-9, 1e3),
                }
            };
            axis.load.travel = Some(TravelParams { lower_radians: -1.0, upper_radians: 2.0, stop });
        }
    }
    params.supply.internal_ohms = dice.between(1e-3, 10.0);
    params.supply.capacitance_farads = dice.between(1e-5, 0.1);
    params.supply.can_sink = dice.coin();
    params
}

fn deed(dice: &mut Dice, params: &WorldParams) -> WorldAction {
    let motor = if dice.coin() { Motor::M1 } else { Motor::M2 };
    let axis = &params.axes[motor.index()];
    let stall = axis.stall_amps(24.0) * axis.motor.torque_constant_newton_metres_per_amp * axis.gear.ratio;
    let on = dice.coin();
    match dice.0.next_u32() % 8 {
        0 => WorldAction::SetLoadTorque { motor, newton_metres: (dice.share() - 0.5) * stall },
        1 => WorldAction::LockShaft { motor, on },
        2 => WorldAction::OpenLead { motor, on },
        3 => WorldAction::ReverseLeads { motor, on },
        4 => WorldAction::ConnectBattery { connected: on },
        5 => WorldAction::SetBatteryVolts { volts: dice.between(1.0, 60.0) },
        6 => WorldAction::Power { on },
        _ => WorldAction::ReverseEncoder { motor, on },
    }
}

fn output(dice: &mut Dice) -> BridgeOutput {
    match dice.0.next_u32() % 5 {
        0 => BridgeOutput::Coast,
        1 => BridgeOutput::Brake,
        _ => BridgeOutput::Duty(dice.share() * 2.4 - 1.2),
    }
}

/// Treats a machine badly for three seconds of its time and says where it ended.
fn torment(seed: u64) -> Vec<u64> {
    let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
    let params = machine(&mut dice);
    let mut world = World::new(&params, seed).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
    let mut outputs = [BridgeOutput::Coast; 2];
    for tick in 0..900 {
        if tick % 15 == 0 {
            outputs = [output(&mut dice), output(&mut dice)];
        }
        if tick % 40 == 0 {
            world.apply(&deed(&mut dice, &params));
        }
        world.advance(outputs, 1.0 / 300.0);
        let view = world.view(Duration::ZERO);
        assert!(view.bus_volts.is_finite() && view.bus_volts >= 0.0, "seed {seed}, tick {tick}");
        for (axis, params) in view.axes.iter().zip(&params.axes) {
            let truth = axis.truth;
            // With a lead open, half the stall torque against viscous friction alone may reach 500 times the speed at 24 V.
            let fastest = 2000.0 * params.steady_speed_radians_per_second(24.0).max(1.0);
            let most_volts = 100.0 + fastest * params.motor.back_emf_volts_per_radian_per_second;
            let calm = truth.amps.abs() < params.stall_amps(most_volts)
                && truth.motor_radians_per_second.abs() < fastest
                && truth.load_radians_per_second.abs() < fastest;
            assert!(calm, "seed {seed}, tick {tick}: {truth:?}");
            if let Some(TravelParams { lower_radians, upper_radians, stop: StopKind::Hard }) =
                params.load.travel
            {
                let inside = (lower_radians - 1e-9..=upper_radians + 1e-9).contains(&truth.load_radians);
                assert!(inside, "seed {seed}, tick {tick}: {}", truth.load_radians);
            }
        }
    }
    world.view(Duration::ZERO).axes.map(|axis| axis.truth.load_radians.to_bits()).to_vec()
}

#[test]
fn machines_of_any_make_survive_any_treatment() {
    for seed in 1..=400 {
        torment(seed);
    }
}

#[test]
fn the_same_seed_ends_in_the_same_place_to_the_last_bit() {
    for seed in 1..=20 {
        assert_eq!(torment(seed), torment(seed), "seed {seed}");
    }
}

#[test]
fn a_duty_that_is_no_number_and_absurd_figures_do_no_harm() {
    let mut world = World::new(&world_of(&presets()[0], &presets()[0], 0), 0).expect("presets are valid");
    for volts in [f64::NAN, f64::INFINITY, -5.0, 1e300] {
        world.apply(&WorldAction::SetBatteryVolts { volts });
        world.apply(&WorldAction::SetLoadTorque { motor: Motor::M1, newton_metres: volts });
        world.advance([BridgeOutput::Duty(f64::NAN), BridgeOutput::Duty(1.0)], 0.1);
        let view = world.view(Duration::ZERO);
        assert!(view.bus_volts.is_finite());
        assert!(view.axes.iter().all(|axis| axis.truth.motor_radians.is_finite()), "{volts}");
    }
    let mut broken = world_of(&presets()[0], &presets()[0], 0);
    broken.supply.internal_ohms = -1.0;
    let refusal = World::new(&broken, 0).expect_err("less than nothing").to_string();
    assert_eq!(refusal, "supply.internal_ohms is -1: it must be 0 or more");
}
