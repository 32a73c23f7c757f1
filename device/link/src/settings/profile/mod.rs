//! A profile: the settings of one controller in a file, with what is needed to judge whether they fit another
//! one.
//!
//! The form is JSON with a schema number; each value carries its unit. Reading takes all or nothing: every
//! fault is told with its place, and nothing is half taken over. The date comes from outside, there is no
//! clock here.

mod changes;
mod content;
mod error;
mod file;
mod fit;
mod json;
mod parse;
mod schema;
mod text;

pub use changes::ProfileChanges;
pub use content::{FORMAT, OpenedProfile, Profile, SCHEMA, Strictness};
pub use error::{Problem, ProfileError, ProfileFileError};
pub use fit::Fitted;
