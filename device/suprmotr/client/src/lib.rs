//! SuprMotr controllers as the device thread and the settings engine speak to them.
//!
//! [`SuprMotrDriver`] is the family as shared code knows it, and [`SUPRMOTR`] its name. Everything else here is for those who know that
//! they have such a controller in front of them.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod controller;
mod driver;
mod family;
pub mod messages;
mod settings;
#[cfg(test)]
mod tests;

pub use controller::{
    COMPUTED_TARGET, COMPUTED_VELOCITY, SuprMotr, SuprMotrFacts, SuprMotrs, channels, describe_received,
    describe_sent, indicators, status_of_word,
};
pub use driver::SuprMotrDriver;
pub use family::{SUPRMOTR, is_suprmotr, subject, unit_address};
