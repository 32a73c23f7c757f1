//! The family as links and the settings engine know it.

use crate::controller::MotionMinds;
use crate::family::MOTION_MIND;
use crate::settings::MotionMindSettings;
use brushwork_link::device::controller::Search;
use brushwork_link::settings::FamilySettings;
use brushwork_link::{Driver, FamilyRef};

/// What speaks with Motion Mind 3 controllers.
#[derive(Clone, Copy, Debug)]
pub struct MotionMindDriver;

impl Driver for MotionMindDriver {
    fn family(&self) -> FamilyRef {
        MOTION_MIND
    }

    fn search(&self) -> Box<dyn Search> {
        Box::new(MotionMinds::new())
    }

    fn settings(&self) -> &'static dyn FamilySettings {
        &MotionMindSettings
    }
}
