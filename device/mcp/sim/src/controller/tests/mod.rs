//! Conversations with a simulated controller in virtual time.

mod any_input;
mod can_bus;
mod control_source;
mod conversation;
mod every_command;
mod inputs;
mod memory;
mod protection;
mod roboclaw;
mod script;
mod specials;
mod support;
