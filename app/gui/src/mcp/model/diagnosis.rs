//! All that is known for a diagnosis of an MCP.

use brushwork_link::device::PinSignal;
use brushwork_mcp_client::diagnosis::{Evidence, Measured, PinEnd, Script};

use crate::model::connection::Connection;

/// Where pins stand, by their signals.
pub fn ends(signals: &[PinSignal]) -> Vec<PinEnd> {
    signals.iter().map(|signal| PinEnd::of_percent(signal.percent.into())).collect()
}

impl Connection {
    /// Where the unit's input pins stand, while they are read.
    pub fn pin_ends(&self) -> Option<Vec<PinEnd>> {
        self.watch.pins().map(ends)
    }

    /// All that is known for a diagnosis; `None` before the status was read.
    pub fn evidence<'a>(&'a self, pins: Option<&'a [PinEnd]>) -> Option<Evidence<'a>> {
        let identity = self.link.identity()?;
        let status = self.link.status.as_ref()?;
        Some(Evidence {
            settings: self.diagnosed(),
            pins,
            stream: self.link.stream,
            measured: Measured::of(|channel| self.link.readings.get(channel)),
            script: match self.script_runs() {
                None => Script::NotKnown,
                Some(true) => Script::Started,
                Some(false) => Script::Stopped,
            },
            ..Evidence::of(status, identity)
        })
    }
}
