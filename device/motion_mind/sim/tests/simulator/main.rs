//! The simulated Motion Mind by its bytes, its manual and damaged input.

mod bench;
mod bytes;
mod manual;
mod mutations;
