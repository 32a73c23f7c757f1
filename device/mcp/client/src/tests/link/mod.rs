//! The device thread in virtual time, with units of packet serial and of a family of two bytes at the far end.

mod arming;
mod connecting;
mod harness;
mod jobs;
mod reading;
mod stopping;
