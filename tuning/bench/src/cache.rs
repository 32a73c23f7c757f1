//! The optima of the seeds that are quoted, worked out once: they cost far more than the tuning they judge.
//!
//! `brushwork bench tuning --seed 7 --plants 200 --write-oracle tuning/bench/oracle/seed-7.json` makes a file anew.

use crate::oracle::{Optima, Optimum};
use std::collections::BTreeMap;

/// Optima by the number of the plant.
pub type OptimaByPlant = BTreeMap<usize, Optima>;

const SEED_7: &str = include_str!("../oracle/seed-7.json");
const SEED_11: &str = include_str!("../oracle/seed-11.json");

/// What is known of a seed; nothing for one that is not quoted.
#[must_use]
pub fn known(seed: u64) -> OptimaByPlant {
    let text = match seed {
        7 => SEED_7,
        11 => SEED_11,
        _ => return OptimaByPlant::new(),
    };
    serde_json::from_str(text).unwrap_or_default()
}

/// Optima of the Motion Mind's plants by number: velocity, PD, PID.
pub type MindOptima = BTreeMap<usize, [Option<Optimum>; 3]>;

const MIND_SEED_7: &str = include_str!("../oracle/motion-mind-7.json");
const MIND_SEED_11: &str = include_str!("../oracle/motion-mind-11.json");

/// The same for the Motion Mind; with `--family motion-mind`.
#[must_use]
pub fn known_mind(seed: u64) -> MindOptima {
    let text = match seed {
        7 => MIND_SEED_7,
        11 => MIND_SEED_11,
        _ => return MindOptima::new(),
    };
    serde_json::from_str(text).unwrap_or_default()
}
