//! The simulated MotorVator V3: a board that runs MeccCode, with what a program finds on it. Deterministic: bytes and time in, bytes out.
//!
//! Programs are those of `brushwork_script::mecc`; the byte code of the real board is not public. What no page says stands in [`assumed`].

#![doc = include_str!("../README.md")]
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod assumed;
mod debugging;
mod happening;
mod hardware;
mod machine;
mod rotor;
mod stepper;
#[cfg(test)]
mod tests;
mod unit;

pub use happening::{Happening, What};
pub use hardware::{Hardware, MotorOutput, ServoOutput};
pub use machine::DrivenMotorvator;
pub use rotor::{Rotor, RotorParams};
pub use unit::Motorvator;
