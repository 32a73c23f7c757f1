//! Everything between a port and a typed controller: transports, requests with deadlines, and the device thread.
//!
//! Units stand in names; times are durations since the epoch of the [`Clock`] in use. There is no window here
//! and no simulator. See `ARCHITECTURE.md`.

pub mod clock;
pub mod device;
pub mod diagnosis;
pub mod exchange;
pub mod failure;
pub mod firmware;
pub mod script;
pub mod settings;
#[cfg(test)]
mod testing;
pub mod transport;
pub mod unit;
pub mod wire;

pub use clock::{Clock, SystemClock, VirtualClock};
pub use exchange::{ExchangeError, Interruption, LinkStatistics};
pub use failure::Failure;
pub use transport::{ConnectTarget, Stream, Transport, TransportError};
pub use unit::{FirmwareGeneration, UnitAddress};
pub use wire::{HiddenSettings, TypedWire, Wire};
