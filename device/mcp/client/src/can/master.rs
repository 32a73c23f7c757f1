//! This program as a node of the bus: its number, and nodes that watch its heartbeat.

use crate::can::access::{read, write};
use crate::can::place::Place;
use crate::messages::McpCauseMessage;
use brushwork_canopen::NodeId;
use brushwork_canopen::nmt::objects;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::ExchangeError;
use std::time::Duration;

/// The node that this program is on the bus, by its heartbeat: the highest, since other masters take low ones. Assumed free.
pub const MASTER: NodeId = NodeId::new(NodeId::MAX).expect("127 is a node id");
/// After how much silence of this program a node that watches it stops its motors.
pub const MASTER_LIMIT: Duration = Duration::from_millis(1000);

impl Place {
    /// Makes the node watch this program's heartbeat, and sees whether it does.
    pub fn watch_master(self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        let [low, high] = u16::try_from(MASTER_LIMIT.as_millis()).unwrap_or(u16::MAX).to_le_bytes();
        let value = [low, high, MASTER.get(), 0];
        write(line, self, objects::CONSUMER_HEARTBEAT, 1, &value)?;
        let kept = read(line, self, objects::CONSUMER_HEARTBEAT, 1)?.0;
        if kept != value {
            return Err(ExchangeError::impossible(McpCauseMessage::HeartbeatNotKept));
        }
        Ok(())
    }

    /// Lets the node stop watching.
    pub fn unwatch_master(self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        write(line, self, objects::CONSUMER_HEARTBEAT, 1, &[0; 4]).map(drop)
    }
}
