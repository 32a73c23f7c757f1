//! What screens of one family alone ask for: the action brings along what is done about it, and the window lends it a hand.

use std::fmt::Debug;

use brushwork_core::keep::Store;
use brushwork_core::session::firmware::LoaderPlace;
use brushwork_link::{ConnectTarget, Message, Request, SettingsImage};
use brushwork_values::Value;

use super::model::screen::Screen;
use super::model::{ConnectionId, Model};

/// Something that the screens of a family ask for.
pub trait FamilyAction: Debug {
    /// Does it; why not, as a sentence.
    fn act(&self, host: &mut dyn Host) -> Result<(), Message>;
}

/// What the window does for an action.
pub trait Host {
    /// All there is to see.
    fn model(&mut self) -> &mut Model;

    /// Sends a command with its values to the unit in front, as if it had been put together by hand: with a backup of the settings before one
    /// that changes them. The answer has the number `id`.
    fn transact(&mut self, id: u64, command: u8, values: Vec<Value>);

    /// Queues a request to a link; a refusal is told.
    fn request_of(&mut self, connection: ConnectionId, request: Request) -> bool;

    /// Writes values to the RAM of the unit in front, with a backup before, and reads them back.
    fn write_ram(&mut self, wanted: SettingsImage) -> Result<(), Message>;

    /// Goes to a screen.
    fn show(&mut self, screen: Screen);

    /// Disarms the screen in front.
    fn disarm(&mut self);

    /// Connects to a target, as if it had been typed.
    fn connect_to(&mut self, target: &str);

    /// Where backups are kept.
    fn store(&self) -> Store;

    /// Where a unit behind a target waits for firmware.
    fn loader_place(&mut self, target: &ConnectTarget) -> LoaderPlace;
}
