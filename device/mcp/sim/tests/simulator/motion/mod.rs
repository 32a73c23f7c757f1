//! The control side of the simulated firmware against motors simple enough to know the answer beforehand.

mod buffers;
mod closed_loop;
mod inputs;
mod laws;
mod open_loop;
mod plant;
mod position;
mod relay;
mod rig;
mod robustness;
