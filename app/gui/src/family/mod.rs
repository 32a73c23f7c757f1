//! What differs between families of controllers in the window, in ONE place that the shell and the shared screens ask.
//!
//! A family says which screens there are, which figures stand in the top row, which indicators at the bottom, how many motors a
//! controller has and which channels its graph. A screen that is shared asks its connection's family and never which one it is. A
//! family has a folder of its own in this crate; the program names those that it has, once, by [`install`].

use std::collections::BTreeSet;
use std::sync::OnceLock;

use brushwork_link::{ArmScope, Channel, FamilyRef};

use crate::messages::NameMessage;
use crate::model::Screen;

mod facts;
mod goal;
mod known;
mod own;
pub mod path;
pub mod recipe;
mod words;

pub use facts::{Ability, ActiveIndicator, Family, Figure, Figures, Sliders};
pub use known::Known;
pub use own::Own;
pub use words::SettingsWords;

static FAMILIES: OnceLock<Vec<&'static dyn Family>> = OnceLock::new();

/// Names the families that the window has, the one that is shown before anything was connected at the head. Only the first list counts as
/// the program's.
pub fn install(families: Vec<&'static dyn Family>) {
    // A second list is that of another test.
    let _ = FAMILIES.set(families);
}

/// The families that the window has.
pub fn all() -> &'static [&'static dyn Family] {
    #[cfg(test)]
    FAMILIES.get_or_init(tests::families);
    FAMILIES.get().map_or(&[], Vec::as_slice)
}

/// The family of a unit or of a choice.
///
/// # Panics
/// If the window has no such family.
pub fn of(family: FamilyRef) -> &'static dyn Family {
    let found = all().iter().find(|known| known.family() == family).copied();
    found.unwrap_or_else(|| panic!("the window has no family {}", family.key()))
}

/// What an armed scope is called for a family: its screen, by the title that the family gives it.
pub fn armed_text(family: &dyn Family, scope: ArmScope) -> String {
    let screen = Screen::ALL.into_iter().find(|screen| screen.arm_scope() == Some(scope));
    match screen.filter(|screen| family.title(*screen) != screen.title()) {
        Some(screen) => NameMessage::Screen { title: family.title(screen) }.to_string(),
        None => scope.to_string(),
    }
}

/// The family that is shown before anything was ever connected.
///
/// # Panics
/// If none was installed.
pub fn first() -> &'static dyn Family {
    all().first().copied().unwrap_or_else(|| panic!("the window has no family of controllers"))
}

/// The family that a target names before anything has answered there, if it names one.
pub fn of_target(target: &str) -> Option<&'static dyn Family> {
    let model = target.strip_prefix("sim:")?.split(',').next()?;
    let found = all().iter().find(|family| family.simulated().iter().any(|(key, _)| key.starts_with(model)));
    Some(found.copied().unwrap_or_else(first))
}

/// All models that are simulated, by key and name: first one of each family.
pub fn simulated_models() -> impl Iterator<Item = (&'static str, &'static str)> {
    let part = |first: bool| {
        let of_family = move |family: &&dyn Family| {
            let models = family.simulated().into_iter().enumerate();
            models.filter(move |(place, _)| (*place == 0) == first).map(|(_, model)| model)
        };
        all().iter().flat_map(of_family)
    };
    part(true).chain(part(false))
}

/// The family that simulates a model.
pub fn of_model(key: &str) -> &'static dyn Family {
    let has = |family: &&&dyn Family| family.simulated().iter().any(|(known, _)| *known == key);
    all().iter().find(has).copied().unwrap_or_else(first)
}

/// What controllers of any family can tell, each channel once: a file may be of another controller than the one at hand.
pub fn all_channels() -> Vec<Channel> {
    let mut all: Vec<Channel> = all().iter().flat_map(|family| family.channels()).copied().collect();
    let mut known = BTreeSet::new();
    all.retain(|channel| known.insert(channel.key));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Those that the tests of this crate have.
    pub(super) fn families() -> Vec<&'static dyn Family> {
        vec![&crate::mcp::Mcp, &crate::motion_mind::MotionMind]
    }

    #[test]
    fn what_is_armed_has_the_title_that_the_family_gives_the_screen() {
        assert_eq!(armed_text(&crate::mcp::Mcp, ArmScope::Pwm), "the PWM screen");
        assert_eq!(armed_text(&crate::suprmotr::SuprMotr, ArmScope::Position), "the Motion screen");
        assert_eq!(armed_text(&crate::motorvator::Motorvator, ArmScope::Position), "the Stepper screen");
        assert_eq!(armed_text(&crate::motorvator::Motorvator, ArmScope::CommandLine), "the command line");
    }

    #[test]
    fn in_each_family_indicators_and_screens_have_names_of_their_own() {
        for family in all() {
            let shorts: BTreeSet<_> = family.indicators().iter().map(|indicator| indicator.short).collect();
            assert_eq!(shorts.len(), family.indicators().len(), "{family:?}");
            let screens = family.screens(None, &|_| None);
            let titles: BTreeSet<_> = screens.iter().map(|screen| family.title(*screen)).collect();
            assert_eq!(titles.len(), screens.len(), "{family:?}");
        }
    }
}
