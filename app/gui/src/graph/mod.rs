//! The graph: storage of every sample, and what of it is drawn.
//!
//! Storing ([`history`], [`series`]) and thinning ([`mod@trace`]) know no egui, so that both are tested and measured
//! without a window. A [`Track`] is samples with their marks, a [`Sheet`] is how a track is looked at, and a
//! [`LiveGraph`] has one sheet for what comes in and one for a recording. [`picture`] decides what is drawn; [`plot`],
//! [`toolbar`], [`list`] and [`measure`] are its widgets, put together by [`panel`].

pub mod action;
pub mod cursors;
pub mod feed;
pub mod files;
pub mod history;
pub mod icons;
pub mod list;
pub mod live;
pub mod load;
pub mod marks;
pub mod measure;
pub mod memo;
pub mod messages;
pub mod moments;
pub mod panel;
pub mod picture;
pub mod plot;
pub mod rate;
pub mod runs;
pub mod scale;
pub mod series;
pub mod sheet;
pub mod toolbar;
pub mod trace;
pub mod track;
pub mod trigger;

pub use action::GraphAction;
pub use history::History;
pub use live::LiveGraph;
pub use marks::MarkKind;
pub use scale::Scale;
pub use sheet::Sheet;
pub use trace::{Columns, Trace, View};
pub use track::{ChannelInfo, Track};

pub use cursors::Cursors;
pub use marks::Mark;
pub use trigger::{TriggerMode, TriggerSource};
