//! The best gains of a plant, as they are kept: working them out costs far more than the tuning that they judge.
//!
//! `brushwork bench tuning --seed 7 --plants 200 --write-oracle tuning/bench/oracle/seed-7.json` makes a file anew.

use brushwork_tuning::model::Gains;
use brushwork_tuning::tune::Method;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The optimum of one plant for one method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optimum {
    /// Worst cost over gains moved by 2 %.
    pub cost: f64,
    /// Root mean square of the duty at rest.
    pub duty_rms: f64,
    /// The gains.
    pub gains: Gains,
}

/// The optima of one plant.
pub trait Optima: Copy + Send + Sync + Serialize + DeserializeOwned {
    /// Those of the methods.
    fn worked_out(of: impl Fn(Method) -> Option<Optimum>) -> Self;
    /// What a method is measured against.
    fn of(&self, method: Method) -> Option<Optimum>;
}

/// Optima by the number of the plant.
pub type OptimaByPlant<O> = BTreeMap<usize, O>;
