//! Simulated controllers by their bytes, their motion and their world.

mod faults;
mod hurry;
mod manual_scripts;
mod mind_bench;
mod motion;
mod motion_mind;
mod motion_mind_manual;
mod motion_mind_mutations;
mod motion_wire;
mod pacing;
mod plant;
mod presets;
mod pty;
mod random_machines;
mod served;
mod server;
mod speed;
mod support;
mod world;
