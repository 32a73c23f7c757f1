//! Guided motion: setpoint profiles, the measurement of QPPS and the voltage clamp test, as jobs on the device thread; and whether motors do
//! what they are told.
//!
//! What is to be done ([`profile`]) and what the readings mean ([`speed`], [`check`]) are pure; [`player`], [`qpps`] and [`clamp`] are the
//! jobs. All need an armed screen, live on its renewals and end with the motors stopped, whatever their way out. They draw
//! nothing; the window's model starts them and shows what they hand back.
#![allow(
    missing_docs,
    reason = "the program is no library: only its window and its own tests see these items"
)]

pub mod check;
pub mod clamp;
pub mod player;
pub mod profile;
pub mod qpps;
pub mod reader;
pub mod speed;
