//! A RoboClaw's control pins, homing, inputs, outputs and configuration word, through wire bytes and what a person does to the pins.

mod config;
mod homing;
mod inputs;
mod outputs;
mod pins;

use super::support::Bench;
use crate::controller::ControllerConfig;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::status::{Condition, decode};
use brushwork_mcp_wire::packet_serial::{Generation, commands, name, scale};
use brushwork_mcp_wire::roboclaw::ConfigWord;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;
use std::time::Duration;

const A_MOMENT: Duration = Duration::from_millis(100);
/// The pins in the order of the simulated world.
const S1: usize = 0;
const S2: usize = 1;
const S3: usize = 2;
const S4: usize = 3;
const S5: usize = 4;

fn config(generation: Generation) -> ControllerConfig {
    let model = models::lookup("roboclaw-2x30a").expect("it is listed");
    ControllerConfig { generation, ..ControllerConfig::of(model) }
}

/// A RoboClaw on USB.
fn claw(generation: Generation) -> Bench {
    Bench::of(config(generation))
}

/// A RoboClaw whose EEPROM holds a configuration word.
fn claw_with(generation: Generation, word: ConfigWord, stream: StreamIndex) -> Bench {
    let mut config = config(generation);
    let mut settings = config.stored_settings();
    settings.unit.config_word = word.0;
    config.settings = Some(settings);
    Bench::on(config, stream)
}

/// Sets the functions of S3, S4 and S5, and nothing on D1 and D2.
fn set_pins(bench: &mut Bench, functions: [i64; 3]) {
    let mut all = functions.to_vec();
    if bench.generation == Generation::Gen4 {
        all.extend([0, 0]);
    }
    bench.ask(commands::SET_PIN_FUNCTIONS, &all);
}

fn put(bench: &mut Bench, pin: usize, signal: PinSignal) {
    bench.apply(&WorldAction::SetPin { pin, signal });
}

/// Closes or opens a switch to ground.
fn pull(bench: &mut Bench, pin: usize, is_low: bool) {
    put(bench, pin, if is_low { PinSignal::Volts { volts: 0.0 } } else { PinSignal::Open });
}

fn volts(bench: &mut Bench, pin: usize, volts: f64) {
    put(bench, pin, PinSignal::Volts { volts });
}

fn pulse(bench: &mut Bench, pin: usize, microseconds: f64) {
    put(bench, pin, PinSignal::Pulse { microseconds });
}

/// Saves the settings and switches the power off and on.
fn save_and_restart(bench: &mut Bench) {
    bench.ask(commands::SAVE_SETTINGS, &[i64::from(scale::SETTINGS_KEY)]);
    bench.wait(Duration::from_secs(2));
    restart(bench);
}

fn restart(bench: &mut Bench) {
    bench.apply(&WorldAction::Power { on: false });
    bench.wait(Duration::from_secs(2));
    bench.apply(&WorldAction::Power { on: true });
}

fn has(bench: &mut Bench, condition: Condition) -> bool {
    let word = bench.read(commands::READ_STATUS, name::STATUS) as u32;
    decode(word, bench.generation).contains(condition)
}

/// Duty of motor 1 in percent as the wire has it.
fn duties(bench: &mut Bench) -> [f64; 2] {
    let reply = bench.ask(commands::READ_PWMS, &[]);
    [reply.int(name::DUTY_M1), reply.int(name::DUTY_M2)].map(|raw| raw as f64 * scale::DUTY_PERCENT)
}

fn duty(bench: &mut Bench) -> f64 {
    duties(bench)[0]
}

fn is_near(value: f64, wanted: f64) -> bool {
    (value - wanted).abs() < 0.5
}

fn position(bench: &mut Bench) -> i64 {
    i64::from(bench.read(commands::READ_ENCODERS, name::ENCODER_M1) as u32 as i32)
}

/// Where motor 1's output shaft is.
fn shaft(bench: &Bench) -> f64 {
    bench.unit().world().truth(Motor::M1).load_radians
}
