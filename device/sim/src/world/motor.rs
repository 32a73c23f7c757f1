//! The two motor channels of a unit.

use serde::{Deserialize, Serialize};

/// One of the two motor channels of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Motor {
    /// Motor 1.
    M1,
    /// Motor 2.
    M2,
}

impl Motor {
    /// Both, in order.
    pub const BOTH: [Self; 2] = [Self::M1, Self::M2];

    /// 0 or 1.
    pub const fn index(self) -> usize {
        match self {
            Self::M1 => 0,
            Self::M2 => 1,
        }
    }
}
