//! A machine behind its faults and the pace of its line.

use crate::faults::Faulty;
use crate::pacing::Paced;

/// The machine with everything between it and the endpoint.
pub type Stack<M> = Paced<Faulty<M>>;
