//! Motors, worlds, faults, pacing and the server, without any controller.

mod faults;
mod hurry;
mod motors;
mod pacing;
mod presets;
mod pty;
mod random_machines;
mod server;
mod support;
mod world;
