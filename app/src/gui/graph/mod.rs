//! The graph: storage of every sample, and what of it is drawn.
//!
//! Storing ([`history`], [`series`]) and thinning ([`trace`]) know no egui, so that both are tested and measured
//! without a window.

pub mod history;
pub mod series;
pub mod trace;

pub use history::History;
pub use trace::{Columns, Trace, View};
