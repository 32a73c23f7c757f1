//! A simulated SuprMotr in virtual time, byte by byte: `cargo run -p brushwork-suprmotr-sim --example suprmotr_bytes`.
//!
//! Selects the board, moves its slide, looks on by single characters, and stops it with the character that every board hears.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_suprmotr_sim::{SuprMotr, SuprMotrBus, SuprMotrConfig};
use brushwork_suprmotr_wire::{Address, Selection, Single};
use std::error::Error;
use std::time::Duration;

fn main() -> Result<(), Box<dyn Error>> {
    let mut bus = SuprMotrBus::new(vec![SuprMotr::new(SuprMotrConfig::new(Address::FACTORY))?]);
    exchange(&mut bus, &Selection::Unit(Address::FACTORY).bytes());
    exchange(&mut bus, b"EF\r");
    exchange(&mut bus, b"MA20000\r");
    for _ in 0..5 {
        bus.advance(bus.now() + Duration::from_millis(100));
        exchange(&mut bus, &[Single::Position.character()]);
        exchange(&mut bus, &[Single::FollowingError.character()]);
    }
    exchange(&mut bus, &[Single::Abort.character()]);
    exchange(&mut bus, &[Single::Status.character()]);
    Ok(())
}

/// Sends bytes and prints what comes back within 5 ms.
fn exchange(bus: &mut SuprMotrBus, bytes: &[u8]) {
    println!("{:8.3} s  > {}", bus.now().as_secs_f64(), bytes.escape_ascii());
    bus.receive(StreamIndex::Usb, bytes);
    bus.advance(bus.now() + Duration::from_millis(5));
    while let Some(reply) = bus.take_output(StreamIndex::Usb) {
        println!("{:8.3} s  < {}", bus.now().as_secs_f64(), reply.escape_ascii());
    }
}
