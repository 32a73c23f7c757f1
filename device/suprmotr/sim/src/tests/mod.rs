//! The simulated SuprMotr V9 in virtual time, through the bytes of its manual.

mod bench;
mod bus;
mod channels;
mod lines;
mod macros;
mod moves;
mod mutations;
mod power;
mod switches;
