//! What the window does for the screens and panels that one family alone has.

use brushwork_core::keep::Store;
use brushwork_core::session::firmware::LoaderPlace;
use brushwork_link::{ConnectTarget, DeviceHandle, Message, Request, SettingsImage};
use brushwork_values::Value;
use egui::{Context, ViewportCommand};

use super::App;
use crate::command::Command;
use crate::family_action::Host;
use crate::model::{ConnectionId, Model, Screen};

impl Host for App {
    fn model(&mut self) -> &mut Model {
        &mut self.model
    }

    fn transact(&mut self, id: u64, command: u8, values: Vec<Value>) {
        self.apply(Command::Transact { id, command, values });
    }

    fn request_of(&mut self, connection: ConnectionId, request: Request) -> bool {
        Self::request_of(self, connection, request)
    }

    fn write_ram(&mut self, wanted: SettingsImage) -> Result<(), Message> {
        Self::write_ram(self, wanted)
    }

    fn show(&mut self, screen: Screen) {
        Self::show(self, screen);
    }

    fn disarm(&mut self) {
        Self::disarm(self);
    }

    fn connect_to(&mut self, target: &str) {
        Self::connect_to(self, target, target.parse());
    }

    fn store(&self) -> Store {
        self.parts.keeping.store().clone()
    }

    fn loader_place(&mut self, target: &ConnectTarget) -> LoaderPlace {
        self.parts.opener.loader_place(target, &self.model.devices.ports)
    }
}

impl App {
    /// Has read what the open screen of the device in front needs besides the signals.
    pub(super) fn read_for_screen(&mut self) {
        let Some(now) = self.device().map(DeviceHandle::now) else { return };
        let (screen, front) = (self.model.screen, &mut self.model.front);
        let is_free = front.is_connected() && !front.is_guided() && front.settings.running().is_none();
        let wants_read = is_free && front.family().shows_registers(screen);
        let Some(unit) = front.link.identity().filter(|_| wants_read).cloned() else { return };
        let Some(request) = front.own.iter_mut().find_map(|own| own.read(&unit, now)) else { return };
        // A link that is busy is asked again later; nobody has to be told.
        if self.device().is_none_or(|device| device.request(request).is_err()) {
            self.model.front.own.iter_mut().for_each(|own| own.not_read());
        }
    }

    /// Sends bytes of a terminal. Between the moves of a tuning run they would be in the way.
    pub(super) fn send_raw(&mut self, id: u64, bytes: Vec<u8>) {
        let is_free = !self.model.front.is_guided();
        if !(is_free && self.request(Request::Raw { id, bytes })) {
            self.model.front.own.iter_mut().for_each(|own| own.not_sent(id));
        }
    }

    /// Keeps the window open while something is at work that must not be cut short.
    pub(super) fn hold_open(&mut self, ctx: &Context) {
        let asked = self.closing || ctx.input(|input| input.viewport().close_requested());
        let why = self
            .model
            .connections()
            .flat_map(|connection| connection.own.iter())
            .find_map(|own| own.holds_window());
        let Some(why) = why.filter(|_| asked) else { return };
        self.closing = false;
        ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        self.model.messages.fail(why);
    }
}
