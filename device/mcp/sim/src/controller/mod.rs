//! A simulated controller: bytes and time in, bytes out, with its machine around it.
//!
//! [`Controller`] is one unit and [`Bus`] several on one wire; both are driven as [`Machine`](brushwork_plant::machine::Machine)s, in real
//! or in virtual time. The unit is firmware (settings, inputs, supervision, commands) over two motion channels; the machine is a
//! [`World`](brushwork_plant::world::World). What a power cycle forgets is one value that is made anew.

mod answer;
mod bus;
mod can;
mod canbus;
mod commands;
mod config;
mod control;
mod debugging;
mod dispatch;
mod firmware;
mod inputs;
mod loader;
mod memory;
mod object;
mod pins;
mod port;
mod quirks;
mod readings;
mod script;
mod status;
#[cfg(test)]
mod tests;
mod unit;
mod unit_view;
mod watch;

pub use bus::{Bus, BusError};
pub use canbus::OtherNode;
pub use config::{ControllerConfig, FirmwareOptions};
pub use loader::{ERASE_TIME, Flash, PAGE_WRITE_TIME};
pub use port::{FAST_TURNAROUND, SLOW_TURNAROUND, turnaround};
pub use quirks::Quirks;
pub use readings::Readings;
pub use script::INSTRUCTION_TIME;
pub use unit::Controller;
pub use unit_view::UnitView;
