//! A profile from its text and as text.

use super::content::{OpenedProfile, Profile, Strictness};
use super::error::ProfileError;
use super::{json, parse};

impl Profile {
    /// The profile in `text`. Refuses anything that is not exactly right, with every fault it found.
    pub fn parse(text: &str) -> Result<Self, ProfileError> {
        Self::read(text, Strictness::Refuse).map(|opened| opened.profile)
    }

    /// The profile in `text`, with what reading it changed: an older schema is brought to the newest, and with
    /// [`Strictness::Repair`] settings that are unknown or of a wrong type are left out. A value out of range is
    /// no fault: a unit may hold it. What is wrong with the file as a whole refuses it either way.
    pub fn read(text: &str, strictness: Strictness) -> Result<OpenedProfile, ProfileError> {
        parse::parse(text, strictness)
    }

    /// The profile as text: one line per setting, in screen order.
    pub fn to_json(&self) -> String {
        json::write(self)
    }
}
