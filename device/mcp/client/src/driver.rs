//! The family as links and the settings engine know it.

use crate::MCP;
use crate::controller::PacketSerial;
use crate::settings::McpSettings;
use brushwork_link::device::controller::Search;
use brushwork_link::settings::FamilySettings;
use brushwork_link::{Driver, FamilyRef};

/// What speaks with MCP and RoboClaw controllers.
#[derive(Clone, Copy, Debug)]
pub struct McpDriver;

impl Driver for McpDriver {
    fn family(&self) -> FamilyRef {
        MCP
    }

    fn search(&self) -> Box<dyn Search> {
        Box::new(PacketSerial)
    }

    fn settings(&self) -> &'static dyn FamilySettings {
        &McpSettings
    }
}
