//! The screens and panels of an MCP, as far as they are its own.

use egui::{Context, Rect, Ui};

use super::model::family::{HELP_COMMANDS, HELP_MCL, HELP_SETTINGS};
use super::{Mcp, updating};
use crate::actions::{Action, Keys, page};
use crate::command::Commands;
use crate::family_action::Host;
use crate::help::mcl::mcl_ui;
use crate::model::{Connection, ConnectionId, GeneralView, Help, HelpPage, Model, Screen};
use crate::screens::face::Face;

mod calibrate;
mod clamp;
mod composer;
mod conflicts;
mod firmware;
mod general;
mod help;
mod leds;
mod pin;
mod reasons;
mod signal_graph;

impl Face for Mcp {
    fn screen_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands) -> bool {
        let is_own = model.screen == Screen::GeneralSettings;
        if is_own {
            general::general_ui(ui, model, commands);
        }
        is_own
    }

    fn reasons_ui(&self, ui: &mut Ui, connection: &Connection, commands: &mut Commands) {
        reasons::reasons_ui(ui, connection, commands);
        ui.add_space(8.0);
    }

    fn leds_ui(&self, ui: &mut Ui, connection: &Connection) {
        leds::leds_ui(ui, connection);
    }

    fn around_rows_ui(&self, ui: &mut Ui, general: &mut GeneralView<'_>, is_before: bool) {
        general::around_rows_ui(ui, general, is_before);
    }

    fn composer_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands) -> bool {
        composer::composer_ui(ui, model, commands).is_some()
    }

    fn windows_ui(&self, ctx: &Context, model: &mut Model, commands: &mut Commands, room: Rect) {
        firmware::firmware_ui(ctx, model, commands, room);
    }

    fn help_ui(&self, ui: &mut Ui, page: HelpPage, help: &mut Help) -> bool {
        match page {
            HELP_SETTINGS => help::settings_ui(ui, help),
            HELP_COMMANDS => help::packet_serial_ui(ui, help),
            HELP_MCL => mcl_ui(ui, help),
            _ => return false,
        }
        true
    }

    fn actions(&self) -> &'static [Action] {
        ACTIONS
    }

    fn go_on(&self, host: &mut dyn Host, connection: ConnectionId, ctx: &Context) {
        updating::look_after_firmware(host, connection, ctx);
    }
}

const ACTIONS: &[Action] = &[
    page!("help.settings": HELP_SETTINGS.title, Keys::None, HELP_SETTINGS, "Every setting: unit, range, default, and how it is read and written."),
    page!("help.packet-serial": HELP_COMMANDS.title, Keys::None, HELP_COMMANDS, "Every command of the protocol, byte by byte, and the bits of the status word."),
    page!("help.mcl": HELP_MCL.title, Keys::None, HELP_MCL, "Every command, operator, modifier, type and register of the MCL language, and where the manual contradicts itself."),
];
