//! Motion Mind 3 controllers, in both of their protocols.
//!
//! [`MotionMinds`] finds units, [`MotionMind`] is one of them. What it reads, how it drives, stops and is armed stand in a file
//! each. Nothing outside this folder and the settings of the family knows a register.
//!
//! Commands by number ([`Controller::transact`](brushwork_link::device::controller::Controller::transact)) are those of the binary protocol with their values in order
//! (`brushwork_motion_mind_wire::COMMANDS`), whichever protocol the unit speaks. The self-test of the text protocol has no
//! number: nothing here can send it.

mod acts;
mod arming;
mod borrowed;
pub mod channels;
mod discover;
mod driving;
mod facts;
pub mod indicators;
mod inquiry;
mod learned;
mod polling;
mod raw;
mod registers;
mod speaker;
mod stopping;
#[cfg(test)]
mod tests;
mod traffic;
mod unit;

pub use discover::MotionMinds;
pub use driving::{COUNTS_PER_S_PER_STEP, objection, preview, taken};
pub use facts::MotionMindFacts;
pub use traffic::{describe_received, describe_sent};
pub use unit::MotionMind;
