//! The motors of a unit.

use serde::{Deserialize, Serialize};
use std::fmt;

/// One of the two motor channels of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
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

    /// The other one.
    pub const fn other(self) -> Self {
        match self {
            Self::M1 => Self::M2,
            Self::M2 => Self::M1,
        }
    }
}

impl fmt::Display for Motor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::M1 => "M1",
            Self::M2 => "M2",
        })
    }
}
