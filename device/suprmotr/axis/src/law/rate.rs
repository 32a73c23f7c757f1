//! How often the loop turns: all that the manual leaves open of its law.

use serde::{Deserialize, Serialize};

/// The rate that is taken for granted before anything is known. Assumed.
const USUAL_RATE_HZ: u32 = 1_000;

/// The law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SuprMotrLaw {
    /// Turns of the loop in a second.
    pub rate_hz: u32,
}

impl Default for SuprMotrLaw {
    fn default() -> Self {
        Self { rate_hz: USUAL_RATE_HZ }
    }
}
