//! No request, no byte and nothing done to the machine makes a controller panic or go astray.

use super::support::Bench;
use crate::controller::ControllerConfig;
use brushwork_mcp_wire::models::MODELS;
use brushwork_mcp_wire::packet_serial::{COMMANDS, Generation, Request};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;
use brushwork_values::{Field, Kind, Value};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::time::Duration;

const SEED: u64 = 20_150_115;

fn below(rng: &mut ChaCha8Rng, limit: u64) -> u64 {
    rng.next_u64() % limit
}

/// A value of a field, with a liking for the ends of its range.
fn any_value(rng: &mut ChaCha8Rng, field: &Field) -> Value {
    let text = |rng: &mut ChaCha8Rng| "x".repeat(below(rng, 18) as usize);
    match field.kind {
        Kind::Text { .. } | Kind::Ascii36 | Kind::Utf16Le36 => Value::Text(text(rng)),
        Kind::Bytes(count) => Value::Bytes((0..count).map(|_| rng.next_u32() as u8).collect()),
        Kind::Counted(_) => Value::Records(Vec::new()),
        _ => {
            let (low, high) = field.kind.limits().unwrap_or((0, 0));
            let span = (high - low) as u64 + 1;
            Value::Int(match below(rng, 6) {
                0 => low,
                1 => high,
                2 => 0_i64.clamp(low, high),
                3 => (below(rng, 2_001) as i64 - 1_000).clamp(low, high),
                4 => field.fixed.unwrap_or(high),
                _ => low + below(rng, span) as i64,
            })
        }
    }
}

fn any_action(rng: &mut ChaCha8Rng) -> WorldAction {
    let motor = if below(rng, 2) == 0 { Motor::M1 } else { Motor::M2 };
    let on = below(rng, 2) == 0;
    let amount = below(rng, 1_000) as f64 / 10.0 - 20.0;
    match below(rng, 12) {
        0 => WorldAction::SetLoadTorque { motor, newton_metres: amount },
        1 => WorldAction::SetBatteryVolts { volts: amount },
        2 => WorldAction::SetLogicVolts { volts: amount },
        3 => WorldAction::SetPin { pin: below(rng, 20) as usize, signal: PinSignal::Volts { volts: amount } },
        4 => {
            let signal = PinSignal::Pulse { microseconds: amount * 30.0 };
            WorldAction::SetPin { pin: below(rng, 20) as usize, signal }
        }
        5 => WorldAction::SetPin { pin: below(rng, 20) as usize, signal: PinSignal::Encoder { motor } },
        6 => WorldAction::EStop { pressed: on },
        7 => WorldAction::LockShaft { motor, on },
        8 => WorldAction::SetBoardCelsius { celsius: on.then_some(amount) },
        9 => WorldAction::Power { on },
        10 => WorldAction::ReverseEncoder { motor, on },
        _ => WorldAction::SetHidden { key: "pin.1.digital".to_owned(), value: i64::from(on) },
    }
}

#[test]
fn random_requests_and_random_mischief_end_in_a_working_controller() {
    for (index, model) in MODELS.iter().enumerate() {
        for generation in Generation::ALL {
            let seed = SEED + 10 * index as u64 + u64::from(generation.number());
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut bench = Bench::of(ControllerConfig { generation, seed, ..ControllerConfig::of(model) });
            for _ in 0..400 {
                let command = &COMMANDS[below(&mut rng, COMMANDS.len() as u64) as usize];
                // 255 ends the conversation and 145 can close the port.
                if let Some(form) = command.form(generation).filter(|_| ![145, 255].contains(&command.number))
                {
                    let values = form.request.iter().map(|field| any_value(&mut rng, field)).collect();
                    let request = Request { address: bench.address, command: command.number, values };
                    let bytes = request.encode(generation).expect("values fit their fields");
                    bench.bus.receive(StreamIndex::Usb, &bytes);
                }
                if below(&mut rng, 8) == 0 {
                    let action = any_action(&mut rng);
                    Machine::apply(&mut bench.bus, 0, &action);
                }
                bench.wait(Duration::from_millis(below(&mut rng, 40)));
                while bench.bus.take_output(StreamIndex::Usb).is_some() {}
                let view = bench.unit().view();
                assert!(view.axes.iter().all(|axis| axis.truth.amps.is_finite()), "seed {seed}");
            }
            restart(&mut bench);
            assert!(!bench.raw(&[0x80, 21]).is_empty(), "{} in {generation}, seed {seed}", model.key);
        }
    }
}

#[test]
fn random_bytes_do_no_harm() {
    let mut bench = Bench::new(Generation::Gen4);
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    for _ in 0..20_000 {
        let byte = [rng.next_u32() as u8];
        bench.bus.receive(StreamIndex::Usb, &byte);
        if below(&mut rng, 5) == 0 {
            bench.wait(Duration::from_millis(below(&mut rng, 25)));
        }
        while bench.bus.take_output(StreamIndex::Usb).is_some() {}
    }
    restart(&mut bench);
    assert!(!bench.raw(&[0x80, 21]).is_empty(), "seed {SEED}");
}

/// Everything that could be wrong with the supply and the settings is put right.
fn restart(bench: &mut Bench) {
    bench.apply(&WorldAction::SetBatteryVolts { volts: 24.0 });
    bench.apply(&WorldAction::Power { on: false });
    bench.wait(Duration::from_secs(1));
    bench.apply(&WorldAction::Power { on: true });
    bench.wait(Duration::from_secs(1));
}
