//! What a family draws itself, and the list of the families that do: everything has a default, so that a new family is shown by the shared
//! screens alone.

use std::sync::OnceLock;

use brushwork_link::FamilyRef;
use egui::{Context, Rect, Ui};

use crate::actions::Action;
use crate::command::Commands;
use crate::family::Family;
use crate::family_action::Host;
use crate::model::connection::ConnectionId;
use crate::model::{Connection, GeneralView, Help, HelpPage, Model, Simulated, Tab};

/// What a family draws itself.
pub trait Face: Sync {
    /// The open screen. False where the shared one is to be drawn.
    fn screen_ui(&self, _ui: &mut Ui, _model: &mut Model, _commands: &mut Commands) -> bool {
        false
    }

    /// Its assistant above the graph, where its screens have a tab for one.
    fn steps_ui(&self, _ui: &mut Ui, _model: &mut Model, _commands: &mut Commands) {}

    /// A tab of its own above the graph.
    fn tab_ui(&self, _ui: &mut Ui, _model: &mut Model, _tab: Tab, _commands: &mut Commands) {}

    /// What keeps the motors from running, at the head of Device Status.
    fn reasons_ui(&self, _ui: &mut Ui, _connection: &Connection, _commands: &mut Commands) {}

    /// The LEDs of the board.
    fn leds_ui(&self, _ui: &mut Ui, _connection: &Connection) {}

    /// What stands before and behind the rows of the part of the settings that is open.
    fn around_rows_ui(&self, _ui: &mut Ui, _general: &mut GeneralView<'_>, _is_before: bool) {}

    /// What is done with the program in front on its controllers, behind the arm switch of the editor. False where the shared line is to be drawn.
    fn run_ui(&self, _ui: &mut Ui, _model: &mut Model, _commands: &mut Commands) -> bool {
        false
    }

    /// A raw command, put together by hand. False where there is no unit that takes one.
    fn composer_ui(&self, _ui: &mut Ui, _model: &mut Model, _commands: &mut Commands) -> bool {
        false
    }

    /// Its own windows, within the room.
    fn windows_ui(&self, _ctx: &Context, _model: &mut Model, _commands: &mut Commands, _room: Rect) {}

    /// A page of help. False where it is not one of its own.
    fn help_ui(&self, _ui: &mut Ui, _page: HelpPage, _help: &mut Help) -> bool {
        false
    }

    /// What can be chosen of a simulated unit besides its model.
    fn simulated_ui(&self, _ui: &mut Ui, _simulated: &mut Simulated) {}

    /// Its own entries of the menus.
    fn actions(&self) -> &'static [Action] {
        &[]
    }

    /// Goes on with what it has at work for a link, in front or not.
    fn go_on(&self, _host: &mut dyn Host, _connection: ConnectionId, _ctx: &Context) {}
}

/// A family as the window has it: what is known of it, and what it draws.
pub trait Window: Family + Face {}

impl<T: Family + Face> Window for T {}

static FACES: OnceLock<Vec<(FamilyRef, &'static dyn Face)>> = OnceLock::new();

/// Sets the list, once.
pub(crate) fn install(windows: &[&'static dyn Window]) {
    let faces = windows.iter().map(|window| (window.family(), *window as &dyn Face)).collect();
    // A second list is that of another test.
    let _ = FACES.set(faces);
}

/// All there are.
pub fn all() -> impl Iterator<Item = &'static dyn Face> {
    FACES.get().into_iter().flatten().map(|(_, face)| *face)
}

/// What a family draws itself.
pub fn of(family: &dyn Family) -> &'static dyn Face {
    struct Plain;
    impl Face for Plain {}
    let found = FACES.get().into_iter().flatten().find(|(known, _)| *known == family.family());
    found.map_or(&Plain, |(_, face)| *face)
}
