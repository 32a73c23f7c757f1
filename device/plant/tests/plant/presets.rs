//! Each preset does what its data sheet says.

use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::presets;
use brushwork_plant::presets::{Preset, keys, lookup, presets, world_of};
use brushwork_plant::world::{World, WorldAction};
use brushwork_plant::{EncoderKind, StopKind};
use brushwork_values::Motor;
use std::f64::consts::TAU;

const FULL: [BridgeOutput; 2] = [BridgeOutput::Duty(1.0), BridgeOutput::Coast];
const REVERSE: [BridgeOutput; 2] = [BridgeOutput::Duty(-1.0), BridgeOutput::Coast];

/// The preset alone on the first channel, without travel stops, so that it can reach its speed.
fn free_world(preset: &Preset) -> World {
    let mut params = world_of(preset, presets().first().expect("there are presets"), 0);
    params.axes[0].load.travel = None;
    World::new(&params, 0).expect("the preset is valid")
}

fn speed(world: &World) -> f64 {
    world.truth(Motor::M1).motor_radians_per_second
}

fn assert_within(got: f64, range: [f64; 2], what: &str, preset: &Preset) {
    assert!(got >= range[0] && got <= range[1], "{} of {}: {got} is not in {range:?}", what, preset.key);
}

#[test]
fn there_are_at_least_six_presets_each_with_its_file_name_and_a_description() {
    assert!(presets().len() >= 6);
    for preset in presets() {
        let file = format!("{}/presets/{}.json", env!("CARGO_MANIFEST_DIR"), preset.key);
        assert!(std::path::Path::new(&file).is_file(), "{file}");
        assert!(preset.description.ends_with('.') && !preset.title.is_empty());
        preset.axis.validate().expect("a preset is valid");
    }
    let files = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/presets"));
    assert_eq!(files.expect("the folder is there").count(), presets().len(), "each file is built in");
    assert_eq!(presets()[0].key, presets::DEFAULT);
}

#[test]
fn each_preset_reaches_its_speed_in_its_time() {
    for preset in presets() {
        let mut world = free_world(preset);
        let step_s = 1e-4;
        let mut speeds = vec![0.0];
        let settle_s = preset.stated.time_constant_s[1] * 12.0;
        while (speeds.len() as f64) * step_s < settle_s {
            world.advance(FULL, step_s);
            speeds.push(speed(&world));
        }
        let top = speed(&world);
        let rpm = top / TAU * 60.0;
        assert_within(rpm, preset.stated.motor_rpm, "speed", preset);
        let rise = speeds.iter().position(|speed| *speed >= 0.632 * top).expect("it got there");
        assert_within(rise as f64 * step_s, preset.stated.time_constant_s, "time constant", preset);
        let before = world.truth(Motor::M1).motor_radians;
        world.advance(FULL, 1.0);
        let counts = (world.truth(Motor::M1).motor_radians - before) * preset.axis.counts_per_motor_radian();
        assert_within(counts, preset.stated.counts_per_second, "counts per second", preset);
        let back = {
            world.advance(REVERSE, settle_s);
            speed(&world)
        };
        assert!((back + top).abs() < 0.02 * top, "{} is as fast backwards: {back}", preset.key);
    }
}

#[test]
fn each_preset_draws_its_stall_current_with_the_shaft_locked() {
    for preset in presets() {
        let mut world = free_world(preset);
        world.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
        world.apply(&WorldAction::SetBatteryOhms { ohms: 0.0 });
        world.advance(FULL, 0.5);
        assert_within(world.truth(Motor::M1).amps, preset.stated.stall_amps, "stall current", preset);
        assert_eq!(speed(&world), 0.0);
    }
}

#[test]
fn each_preset_starts_at_a_small_duty_and_rests_without_any() {
    for preset in presets() {
        let mut world = free_world(preset);
        world.advance([BridgeOutput::Duty(0.2), BridgeOutput::Coast], 1.0);
        assert!(speed(&world) > 0.0, "{} does not start at 20 % duty", preset.key);
        world.advance([BridgeOutput::Brake, BridgeOutput::Coast], 20.0);
        assert_eq!(speed(&world), 0.0, "{} does not come to rest", preset.key);
    }
}

#[test]
fn the_linear_actuator_runs_to_its_ends_and_its_potentiometer_tells_where_it_is() {
    let actuator = lookup("linear-actuator").expect("it is built in");
    let travel = actuator.axis.load.travel.expect("it has end stops");
    assert_eq!(travel.stop, StopKind::Hard);
    let mut quiet = world_of(actuator, actuator, 0);
    quiet.axes[0].encoder.noise_counts = 0.0;
    let mut world = World::new(&quiet, 0).expect("the preset is valid");
    let start = world.encoder(Motor::M1);
    assert_eq!((start.kind, start.counts), (EncoderKind::Analog, 2047));
    world.advance(FULL, 20.0);
    assert!((world.truth(Motor::M1).load_radians - travel.upper_radians).abs() < 1e-6);
    assert!((4090..=4095).contains(&world.encoder(Motor::M1).counts));
    world.advance(REVERSE, 30.0);
    assert!((world.truth(Motor::M1).load_radians - travel.lower_radians).abs() < 1e-6);
    assert!((0..=5).contains(&world.encoder(Motor::M1).counts));
}

#[test]
fn presets_are_found_by_key_whatever_its_case() {
    assert_eq!(lookup("Flywheel").map(|preset| preset.key.as_str()), Some("flywheel"));
    assert!(lookup("hamster-wheel").is_none());
    assert_eq!(keys().len(), presets().len());
}
