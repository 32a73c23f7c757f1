//! Conversations with a simulated controller in virtual time.

mod conversation;
mod every_command;
mod inputs;
mod memory;
mod protection;
mod support;
