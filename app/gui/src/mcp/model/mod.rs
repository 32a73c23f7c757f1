//! What the window keeps of an MCP's own: the firmware update, the composer of raw commands, and what its settings mean.

use std::path::Path;

use brushwork_link::{Event, Failure, Message};

pub mod composer;
mod diagnosis;
pub mod family;
pub mod firmware;
mod pins;
mod script;

use crate::family::Own;
use crate::messages::FirmwareMessage;
use crate::model::connection::Connection;
use composer::Composer;
use firmware::{Firmware, Stage};

/// The state of an MCP's own panels.
#[derive(Debug, Default)]
pub struct McpConnection {
    /// The firmware window and the update that runs.
    pub firmware: Firmware,
    pub composer: Composer,
}

impl Own for McpConnection {
    fn take(&mut self, event: &Event) -> bool {
        self.firmware.note(event);
        if let Event::Transacted { id, result } = event {
            self.composer.answered(*id, result);
        }
        false
    }

    fn link_ended(&mut self) {
        self.firmware.not_entered(FirmwareMessage::LinkLost);
        self.composer.forget_waiting();
    }

    fn is_busy(&self) -> bool {
        self.firmware.stage.is_running()
    }

    fn holds_window(&self) -> Option<Message> {
        let stage = &self.firmware.stage;
        (matches!(stage, Stage::Sending { .. }) && !stage.can_be_cancelled())
            .then(|| FirmwareMessage::HoldsWindow.into())
    }

    fn not_transacted(&mut self) {
        self.composer.forget_waiting();
    }

    fn refused(&mut self, id: u64, why: Failure) {
        self.composer.answered(id, &Err(why));
    }

    fn open_firmware(&mut self, file: Option<&Path>) {
        self.firmware.open = true;
        if let Some(file) = file {
            self.firmware.choose(file);
        }
    }
}

impl Connection {
    /// What is kept of its own.
    pub fn mcp(&self) -> &McpConnection {
        self.own()
    }

    pub fn mcp_mut(&mut self) -> &mut McpConnection {
        self.own_mut()
    }
}
