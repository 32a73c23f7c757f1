//! A simulated Motion Mind 3 in virtual time, byte by byte: `cargo run -p brushwork-motion-mind-sim --example motion_mind_bytes`.
//!
//! Drives the motor in mode 3, looks at its position, falls silent, and shows that the motor goes on: this unit has no time-out of its own.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindConfig};
use brushwork_motion_mind_wire::{Address, Command, EncodeError, encode_frame, register_number};
use brushwork_values::hex;
use std::error::Error;
use std::time::Duration;

fn main() -> Result<(), Box<dyn Error>> {
    let mut unit = MotionMind::new(MotionMindConfig::new(Mode::Serial))?;
    unit.advance(Duration::from_secs(2)); // it blinks its mode first
    exchange(&mut unit, Command::ChangeSpeed(512))?;
    for _ in 0..5 {
        unit.advance(unit.now() + Duration::from_millis(100));
        exchange(&mut unit, Command::ReadRegister(register_number::POSITION))?;
    }
    println!("silence from now on");
    for _ in 0..4 {
        unit.advance(unit.now() + Duration::from_millis(500));
        println!(
            "{:8.3} s  the truth: duty {:.2}, {:.1} rad/s",
            unit.now().as_secs_f64(),
            unit.duty(),
            unit.truth().motor_radians_per_second
        );
    }
    Ok(())
}

/// Sends a command and prints what comes back within 50 ms.
fn exchange(unit: &mut MotionMind, command: Command) -> Result<(), EncodeError> {
    let request = encode_frame(Address::FACTORY, &command)?;
    println!("{:8.3} s  > {}", unit.now().as_secs_f64(), hex(&request));
    let deadline = unit.now() + Duration::from_millis(50);
    unit.receive(&request);
    while let Some(due) = unit.next_output_at().filter(|due| *due <= deadline) {
        unit.advance(due);
        while let Some(reply) = unit.take_output() {
            println!("{:8.3} s  < {}", unit.now().as_secs_f64(), hex(&reply));
        }
    }
    Ok(())
}
