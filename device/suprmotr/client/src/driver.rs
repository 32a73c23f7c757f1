//! The family as links and the settings engine know it.

use crate::controller::SuprMotrs;
use crate::family::SUPRMOTR;
use crate::settings::SuprMotrSettings;
use brushwork_link::device::controller::Search;
use brushwork_link::settings::FamilySettings;
use brushwork_link::{Driver, FamilyRef};

/// What speaks with SuprMotr controllers.
#[derive(Clone, Copy, Debug)]
pub struct SuprMotrDriver;

impl Driver for SuprMotrDriver {
    fn family(&self) -> FamilyRef {
        SUPRMOTR
    }

    fn search(&self) -> Box<dyn Search> {
        Box::new(SuprMotrs::new())
    }

    fn settings(&self) -> &'static dyn FamilySettings {
        &SuprMotrSettings
    }
}
