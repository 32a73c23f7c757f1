//! The family as links and the settings engine know it.

use crate::controller::Boards;
use crate::family::MOTORVATOR;
use crate::settings::MotorvatorSettings;
use brushwork_link::device::controller::Search;
use brushwork_link::settings::FamilySettings;
use brushwork_link::{Driver, FamilyRef};

/// What speaks with MotorVators.
#[derive(Clone, Copy, Debug)]
pub struct MotorvatorDriver;

impl Driver for MotorvatorDriver {
    fn family(&self) -> FamilyRef {
        MOTORVATOR
    }

    fn search(&self) -> Box<dyn Search> {
        Box::new(Boards)
    }

    fn settings(&self) -> &'static dyn FamilySettings {
        &MotorvatorSettings
    }
}
