//! What a person can ask of the window. Screens send commands; [`super::app::App`] applies them in one place.

use brushwork_link::device::{ArmScope, PollRate};
use brushwork_link::transport::Stream;
use brushwork_protocol::packet_serial::{Motor, Value};
use brushwork_sim::world::WorldAction;

use super::model::general::SettingsWish;
use super::model::loop_settings::Column;
use super::model::screen::Screen;

/// One wish.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Opens a link to what is chosen in the device list.
    Connect,
    /// Closes the link, or gives up opening it.
    Disconnect,
    Show(Screen),
    /// Stops all motors of every open link.
    Stop,
    Arm(ArmScope),
    Disarm,
    SelectUnit(u8),
    /// Which of the controller's ports this one is wired to.
    SetStream(Stream),
    ZeroEncoder(Motor),
    ResetEmergencyStop,
    Poll(PollRate),
    /// Reads the settings of the control loops again.
    ReadLoops,
    /// Writes the edits of these settings of the control loops to the controller's RAM.
    ApplyLoops(&'static [Column]),
    /// Something done to the world of the simulated unit that is looked at.
    World(WorldAction),
    /// Something to be done with the settings of the unit that is looked at.
    Settings(SettingsWish),
    /// Sends one raw command; the answer comes with `id`.
    Transact {
        id: u64,
        command: u8,
        values: Vec<Value>,
    },
    DismissMessage,
}

/// The wishes of one frame, in order.
pub type Commands = Vec<Command>;
