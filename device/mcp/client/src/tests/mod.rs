//! Tests of the device thread, the exchange and the settings engine, with units of this family at the far end.

mod exchange;
mod link;
mod settings;
pub mod testing;
