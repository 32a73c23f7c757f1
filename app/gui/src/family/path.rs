//! The steps that lead from a controller that was just connected to an axis that is tuned, saved and backed up, as a family has them.

use super::goal::Goal;
use crate::model::drawer::Tab;
use crate::model::screen::Screen;

/// What is to be done in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    Limits,
    Direction,
    Encoder,
    Switches,
    Velocity,
    Position,
    Save,
    BackUp,
}

impl Step {
    pub const fn title(self) -> &'static str {
        match self {
            Self::Limits => "Power and limits",
            Self::Direction => "Which way it turns",
            Self::Encoder => "Encoder",
            Self::Switches => "Switches and homing",
            Self::Velocity => "Velocity loop",
            Self::Position => "Position loop",
            Self::Save => "Save",
            Self::BackUp => "Back up",
        }
    }

    /// Why it is a step at all.
    pub const fn why(self) -> &'static str {
        match self {
            Self::Limits => {
                "A current that the motor can take, and a battery limit, keep a mistake from costing hardware."
            }
            Self::Direction => {
                "A loop whose encoder counts against its motor runs away at full power. Hold a jog button and compare the two arrows."
            }
            Self::Encoder => "Every loop goes by its count. Turn the shaft and see the count follow.",
            Self::Switches => {
                "An axis with ends wants a home switch, to know where it is, and limit switches, to stop there."
            }
            Self::Velocity => {
                "Guided tuning measures the motor and designs the gains in about 20 s. Nothing stays before you apply it."
            }
            Self::Position => "An axis that goes to places needs it. Guided tuning designs it in one run.",
            Self::Save => "What is in RAM alone is lost with the power.",
            Self::BackUp => {
                "A copy on this computer brings everything back after a mistake, a new firmware or a new board."
            }
        }
    }
}

/// One step: how it is seen that it was done, and where it is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathStep {
    pub step: Step,
    pub shown_by: ShownBy,
    pub place: Place,
}

/// What shows that a step was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownBy {
    /// One of these settings is not the factory's; `{n}` stands for the number of the motor.
    Settings(&'static [&'static str]),
    /// The same of what not every axis needs.
    IfWanted(&'static [&'static str]),
    /// Motor and encoder were seen to turn the same way.
    Turning,
    /// A count was seen to change.
    Counting,
    /// A pin can stop a motor; not every axis needs that.
    Switches,
    Saved,
    BackedUp,
}

/// Where a step is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The first of these groups of settings that the unit has, by their labels.
    Settings(&'static [&'static str]),
    Screen(Screen),
    Drawer(Screen, Tab),
    /// One of the recipes.
    Recipe(Goal),
    /// Here: a sheet that shows what is saved.
    Save,
    /// Here and at once.
    BackUp,
}

/// Saving and backing up are the same with all families.
pub const SAVE: PathStep = PathStep { step: Step::Save, shown_by: ShownBy::Saved, place: Place::Save };
pub const BACK_UP: PathStep =
    PathStep { step: Step::BackUp, shown_by: ShownBy::BackedUp, place: Place::BackUp };
