//! The graph: storage of every sample, and what of it is drawn.
//!
//! Storing ([`history`], [`series`]) and thinning ([`mod@trace`]) know no egui, so that both are tested and measured
//! without a window; [`live`] is the state of what is shown, [`plot`] and [`list`] draw it.

pub mod history;
pub mod list;
pub mod live;
pub mod memo;
pub mod plot;
pub mod scale;
pub mod series;
pub mod trace;

pub use history::History;
pub use live::{ChannelInfo, LiveGraph};
pub use scale::Scale;
pub use trace::{Columns, Trace, View};
