//! A motor through a row of duty steps, recorded over the wire: `cargo run -p brushwork-mcp-sim --example record > steps.csv`.
//!
//! Prints the columns `time_s,duty,counts`: a line with a duty is a command, a line with counts is a poll, and each time is the middle of
//! the exchange, as a host sees it. The example `identify` of `brushwork-tuning` reads such a record. An argument names the preset that is
//! driven; without one it is the default.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::name::ENCODER_M1;
use brushwork_mcp_wire::packet_serial::{
    Address, Generation, Read, ReplyProgress, Request, Typed, commands, parse_reply, scale,
};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::presets;
use std::error::Error;
use std::time::Duration;

/// When each duty begins: up, settled, down again, reversed, and off, so that friction and time constant both show.
const STEPS: [(f64, f64); 7] =
    [(0.05, 1.0), (0.9, 0.3), (1.3, 0.65), (1.6, 0.3), (1.9, 0.65), (2.2, -1.0), (3.2, 0.0)];
const LENGTH_S: f64 = 4.0;
const POLL: Duration = Duration::from_millis(10);

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| presets::DEFAULT.to_owned());
    let preset =
        presets::lookup(&name).ok_or_else(|| format!("presets are {}", presets::keys().join(", ")))?;
    let config = ControllerConfig::default();
    let world = presets::world_of(preset, preset, config.model.pins.len());
    let unit = Controller::new(ControllerConfig { world, seed: 1, ..config })?;
    let mut line = Bus::single(unit, StreamIndex::Usb);

    println!("time_s,duty,counts");
    let mut steps = STEPS.iter().peekable();
    while line.now().as_secs_f64() < LENGTH_S {
        let next_poll = line.now() + POLL;
        if let Some((_, duty)) = steps.next_if(|(from_s, _)| *from_s <= line.now().as_secs_f64()) {
            let raw = (duty * scale::FULL_DUTY_RAW as f64) as i64;
            let (time_s, _) = ask(&mut line, commands::DUTY_ACCEL_M1, &[raw, scale::MAX_DUTY_ACCEL_RAW])?;
            println!("{time_s:.6},{duty},");
        }
        let (time_s, counts) = ask(&mut line, commands::READ_ENCODERS, &[])?;
        println!("{time_s:.6},,{}", counts.int(ENCODER_M1) as i32);
        line.advance(next_poll);
    }
    Ok(())
}

/// One exchange: the middle of it, and what came back.
fn ask<const L: u8>(
    line: &mut Bus,
    command: Typed<L>,
    values: &[i64],
) -> Result<(f64, Read<L>), Box<dyn Error>> {
    let request = Request::new(Address::DEFAULT, command.number(), values);
    let sent = line.now();
    let reply = line.exchange(&request.encode(Generation::Gen1)?, Duration::from_millis(50));
    let middle_s = 0.5 * (sent + line.now()).as_secs_f64();
    match parse_reply(&request, Generation::Gen1, &reply) {
        ReplyProgress::Done { values, .. } => {
            Ok((middle_s, command.reply(values).ok_or("the reply of another command")?))
        }
        other => Err(format!("{command:?}: {other:?}").into()),
    }
}
