//! What differs between families of controllers in the window, in ONE place that the shell and the shared screens ask.
//!
//! A family says which screens there are, which figures stand in the top row, which lamps at the bottom, how many motors a
//! controller has and which channels its graph. A screen that is shared asks its desk's family and never which one it is. To
//! add a family, implement [`Family`], name it in [`of`], and its screens in `screens`.

use std::collections::BTreeSet;

use brushwork_link::device::{Channel, Identity};

mod facts;
mod mcp;
mod motion_mind;
mod words;

pub use facts::{Ability, ActiveIndicator, Family, Figure, Figures, Sliders};
pub use words::SettingsWords;

/// Which family a controller is of, as far as the window tells them apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FamilyKind {
    /// MCP and RoboClaw, over packet serial or CANopen. Shown before anything was ever connected.
    #[default]
    Mcp,
    MotionMind,
}

impl FamilyKind {
    /// The family of a unit that answered.
    pub fn of_unit(identity: &Identity) -> Self {
        if brushwork_motion_mind_client::is_motion_mind(identity) { Self::MotionMind } else { Self::Mcp }
    }

    /// The family that a target names before anything has answered there, if it names one.
    pub fn of_target(target: &str) -> Option<Self> {
        let simulated = target.strip_prefix("sim:")?;
        Some(if simulated.starts_with("motion-mind") { Self::MotionMind } else { Self::Mcp })
    }
}

/// What controllers of any family can tell, each channel once: a file may be of another controller than the one at hand.
pub fn all_channels() -> Vec<Channel> {
    let families = [FamilyKind::Mcp, FamilyKind::MotionMind].map(of);
    let mut all: Vec<Channel> = families.iter().flat_map(|family| family.channels()).copied().collect();
    let mut known = BTreeSet::new();
    all.retain(|channel| known.insert(channel.key));
    all
}

/// The family behind a kind.
pub fn of(kind: FamilyKind) -> &'static dyn Family {
    match kind {
        FamilyKind::Mcp => &mcp::Mcp,
        FamilyKind::MotionMind => &motion_mind::MotionMind,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::motion_mind::Driven;

    #[test]
    fn in_each_family_lamps_and_screens_have_names_of_their_own() {
        for family in [FamilyKind::Mcp, FamilyKind::MotionMind].map(of) {
            let shorts: BTreeSet<_> = family.lamps().iter().map(|lamp| lamp.short).collect();
            assert_eq!(shorts.len(), family.lamps().len(), "{family:?}");
            let screens = family.screens(Driven::Nothing);
            let titles: BTreeSet<_> = screens.iter().map(|screen| family.title(*screen)).collect();
            assert_eq!(titles.len(), screens.len(), "{family:?}");
        }
    }
}
