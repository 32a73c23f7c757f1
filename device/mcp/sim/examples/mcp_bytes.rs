//! A simulated MCP266 in virtual time, byte by byte: `cargo run -p brushwork-mcp-sim --example mcp_bytes`.
//!
//! Asks who it is, drives motor 1, looks at the encoder, falls silent, and shows that the unit's own time-out stops the motor.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::{Address, EncodeError, Generation, Request, number};
use brushwork_plant::machine::StreamIndex;
use brushwork_values::hex;
use std::error::Error;
use std::time::Duration;

const USB: StreamIndex = StreamIndex::Usb;

fn main() -> Result<(), Box<dyn Error>> {
    let mut unit = Controller::new(ControllerConfig::default())?;
    exchange(&mut unit, number::READ_VERSION, &[])?;
    exchange(&mut unit, number::DUTY_M1, &[16_384])?;
    for _ in 0..5 {
        unit.advance(unit.now() + Duration::from_millis(100));
        exchange(&mut unit, number::READ_ENCODER_M1, &[])?;
    }
    println!("silence from now on");
    for _ in 0..8 {
        unit.advance(unit.now() + Duration::from_millis(250));
        let axis = &unit.view().axes[0];
        println!(
            "{:8.3} s  the truth: {} counts, {:.1} rad/s, {:.2} A",
            unit.now().as_secs_f64(),
            axis.encoder_counts,
            axis.truth.motor_radians_per_second,
            axis.truth.amps
        );
    }
    Ok(())
}

/// Sends a request and prints what comes back within 20 ms.
fn exchange(unit: &mut Controller, command: u8, values: &[i64]) -> Result<(), EncodeError> {
    let request = Request::new(Address::DEFAULT, command, values).encode(Generation::Gen1)?;
    println!("{:8.3} s  > {}", unit.now().as_secs_f64(), hex(&request));
    let deadline = unit.now() + Duration::from_millis(20);
    unit.receive(USB, &request);
    while let Some(due) = unit.next_output_at().filter(|due| *due <= deadline) {
        unit.advance(due);
        while let Some(reply) = unit.take_output(USB) {
            println!("{:8.3} s  < {}", unit.now().as_secs_f64(), hex(&reply));
        }
    }
    Ok(())
}
