//! The simulated board as a whole: programs in, frames and a trace out.

mod bench;
mod driven;
mod host;
mod line;
mod manual;
mod odd;
mod programs;
