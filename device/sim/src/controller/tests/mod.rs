//! Conversations with a simulated controller in virtual time.

mod conversation;
mod every_command;
mod memory;
mod support;
