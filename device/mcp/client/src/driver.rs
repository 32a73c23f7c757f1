//! The family as links and the settings engine know it.

use crate::MCP;
use crate::can::{BusTransport, CanOpen};
use crate::controller::PacketSerial;
use crate::readings::McpReadings;
use crate::settings::McpSettings;
use brushwork_canopen::adapter::Form;
use brushwork_canopen::bus::Monitor;
use brushwork_link::device::Readings;
use brushwork_link::device::controller::Search;
use brushwork_link::driver::CanLine;
use brushwork_link::settings::FamilySettings;
use brushwork_link::{Clock, Driver, FamilyRef, Transport};
use std::sync::Arc;

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

    fn readings(&self) -> &'static dyn Readings {
        &McpReadings
    }

    fn on_can(
        &self,
        adapter: Box<dyn Transport>,
        clock: Arc<dyn Clock>,
        form: Form,
    ) -> Result<CanLine, Box<dyn Transport>> {
        let monitor = Monitor::default();
        let line = BusTransport::new(adapter, clock, form, monitor.clone());
        let search = CanOpen::new(form, monitor.clone());
        Ok(CanLine { transport: Box::new(line), search: Box::new(search), monitor })
    }
}
