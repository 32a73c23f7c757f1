//! The device thread's rules in virtual time, against a bus of units that answer from the command table.

mod harness;

mod arming;
mod connecting;
mod family;
mod jobs;
mod reading;
mod stopping;
