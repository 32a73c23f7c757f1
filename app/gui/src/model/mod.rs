//! The window's state as plain data. Screens read it and ask for changes; nothing here draws or waits.

use crate::language::Language;
use std::collections::BTreeMap;

use brushwork_link::device::{ArmScope, Identity};
use brushwork_link::settings::Profile;
use egui::ThemePreference;

use super::mcl::Editor;

pub mod addressing;
mod afterwards;
pub mod boards;
pub mod canopen;
pub mod channels;
pub mod connection;
pub mod devices;
pub mod drawer;
pub mod errand;
pub mod examination;
pub mod general;
pub mod generator;
pub mod guided;
pub mod help;
pub mod help_page;
pub mod history;
pub mod indicator;
pub mod indicators;
pub mod jobs;
pub mod link;
pub mod loop_settings;
pub mod message;
pub mod messages;
pub mod open_files;
pub mod palette;
pub mod path;
mod path_steps;
pub mod position;
pub mod pwm;
pub mod qpps;
pub mod raw;
pub mod raw_lines;
mod raw_wanted;
pub mod readings;
pub mod screen;
pub mod script;
pub mod setpoints;
pub mod settings;
pub mod simulated;
pub mod to_all;
pub mod traffic;
pub mod unit_view;
pub mod velocity;
pub mod watch;
pub mod watched;
pub mod world;

pub use afterwards::Afterwards;
pub use connection::{Connection, ConnectionId, Phase, place_of};
use devices::Devices;
use message::Messages;
use palette::Palette;

pub use general::{General, GeneralView, Section, Sheet};
pub use help::Help;
pub use help_page::HelpPage;
pub use indicator::{IndicatorInfo, IndicatorState};
pub use jobs::Owner;
pub use link::{Arming, Effect, LinkView};
pub use loop_settings::Column;
pub use message::Gravity;
pub use screen::Screen;
pub use setpoints::{Direction, Setpoints};
pub use settings::{SettingsAction, UnitSettings};
pub use simulated::Simulated;
pub use watched::Watched;

pub use channels::graph_channels;
pub use devices::Choice;
pub use drawer::Tab;
pub use general::{Side, Take};
pub use history::{History, clock_text};
pub use indicator::state_of;
pub use position::Position;
pub use pwm::Pwm;
pub use settings::{Saved, Settings, Settle, Summary};
pub use velocity::Velocity;
pub use watched::interruption;

/// Everything the window shows.
#[derive(Debug, Default)]
pub struct Model {
    pub screen: Screen,
    pub appearance: Appearance,
    pub layout: Layout,
    pub devices: Devices,
    pub messages: Messages,
    /// Open while there is one.
    pub palette: Option<Palette>,
    pub help: Help,
    /// Files that are opened, and settings that are looked at without a controller.
    pub files: open_files::OpenFiles,
    /// The window for connecting to a CANopen bus.
    pub canopen: canopen::CanOpenChoice,
    /// The assistant that gives boards their addresses.
    pub addressing: addressing::Addressing,
    /// One profile for every unit of the open links.
    pub to_all: to_all::ToAll,
    /// The MCL programs that are open; they belong to no link.
    pub mcl: Editor,
    /// The link that is looked at. Only this one can be armed.
    pub front: Connection,
    /// The links in the background. They are read and recorded like the one in front.
    pub others: Vec<Connection>,
}

/// Closed links that stay in the list behind the one in front.
pub const MOST_CLOSED: usize = 8;

/// How the window looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Appearance {
    pub theme: ThemePreference,
    /// Size of everything, percent.
    pub scale_percent: u16,
    /// Hard edges, which software rendering draws in less time.
    pub plain: bool,
    pub language: Language,
}

/// What was dragged: widths in points, and parts of a height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    pub left_width: f32,
    pub world_width: f32,
    /// What the graph has of the height of each screen, where its bar was moved.
    graph_parts: [Option<f32>; Screen::ALL.len()],
}

impl Default for Layout {
    fn default() -> Self {
        Self { left_width: 216.0, world_width: 292.0, graph_parts: [None; Screen::ALL.len()] }
    }
}

impl Layout {
    /// Narrower cuts off the device list, wider takes too much from the screens.
    pub const LEFT_RANGE: std::ops::RangeInclusive<f32> = 208.0..=340.0;
    pub const WORLD_RANGE: std::ops::RangeInclusive<f32> = 280.0..=420.0;

    /// What the graph has of a screen's height, if its bar was moved.
    pub fn graph_part(&self, screen: Screen) -> Option<f32> {
        self.graph_parts[screen as usize]
    }

    /// Moves the bar above a screen's graph; what makes no sense leaves it where it was at first.
    pub fn set_graph_part(&mut self, screen: Screen, part: Option<f32>) {
        self.graph_parts[screen as usize] = part.filter(|part| (0.0..=1.0).contains(part));
    }

    /// Sets both widths; what makes no sense stays as it is.
    pub fn set(&mut self, left_width: f32, world_width: f32) {
        if Self::LEFT_RANGE.contains(&left_width) {
            self.left_width = left_width;
        }
        if Self::WORLD_RANGE.contains(&world_width) {
            self.world_width = world_width;
        }
    }
}

impl Default for Appearance {
    fn default() -> Self {
        Self { theme: ThemePreference::System, scale_percent: 100, plain: false, language: Language::English }
    }
}

impl Appearance {
    /// Sizes that can be read on one side and leave room for the screens on the other.
    pub const SCALES_PERCENT: std::ops::RangeInclusive<u16> = 60..=250;

    pub fn set_scale(&mut self, percent: u16) {
        self.scale_percent = percent.clamp(*Self::SCALES_PERCENT.start(), *Self::SCALES_PERCENT.end());
    }
}

impl Model {
    /// What can be armed where the window stands.
    pub fn arm_scope(&self) -> Option<ArmScope> {
        let shows_settings = self.screen == Screen::GeneralSettings;
        let in_settings = || self.front.general.arm_scope().filter(|_| shows_settings);
        let examined = self.front.examination.arm_scope();
        examined.or(self.screen.arm_scope()).or_else(in_settings)
    }

    /// Whether a unit has answered on the link in front.
    pub fn is_connected(&self) -> bool {
        self.front.is_connected()
    }

    /// All links: the one in front first.
    pub fn connections(&self) -> impl Iterator<Item = &Connection> {
        std::iter::once(&self.front).chain(&self.others)
    }

    /// All links: the one in front first.
    pub fn connections_mut(&mut self) -> impl Iterator<Item = &mut Connection> {
        std::iter::once(&mut self.front).chain(&mut self.others)
    }

    pub fn connection(&self, id: ConnectionId) -> Option<&Connection> {
        self.connections().find(|connection| connection.id() == id)
    }

    pub fn connection_mut(&mut self, id: ConnectionId) -> Option<&mut Connection> {
        self.connections_mut().find(|connection| connection.id() == id)
    }

    /// The link that stands before or behind the one in front, in the order they were opened; round at the ends.
    pub fn neighbour(&self, forward: bool) -> ConnectionId {
        let front = self.front.id();
        let mut ids: Vec<ConnectionId> = self.connections().map(Connection::id).collect();
        ids.sort_unstable();
        let at = ids.iter().position(|id| *id == front).unwrap_or_default();
        let by = if forward { 1 } else { ids.len() - 1 };
        ids[(at + by) % ids.len()]
    }

    /// Puts another link in front. Nothing is armed across this: the window disarms first.
    pub fn bring_to_front(&mut self, id: ConnectionId) {
        if let Some(connection) = self.others.iter_mut().find(|connection| connection.id() == id) {
            std::mem::swap(&mut self.front, connection);
            self.front.graph_for(self.screen);
        }
    }

    /// The settings of the units of the open links that are of the family of the unit in front and not that unit, by what they are called.
    pub fn other_units(&self) -> BTreeMap<String, Profile> {
        let Some(identity) = self.front.link.identity() else { return BTreeMap::new() };
        let is_other = |of: &Connection, unit: &Identity| {
            unit.family == identity.family && (of.id() != self.front.id() || unit.address != identity.address)
        };
        let open = self.connections().filter(|connection| connection.is_connected());
        let units = open.flat_map(|of| of.link.units.iter().map(move |unit| (of, unit)));
        units
            .filter(|(of, unit)| is_other(of, unit))
            .filter_map(|(of, unit)| Some((to_all::unit_name(unit), of.settings.profile_at(unit)?)))
            .collect()
    }

    /// The link at a place, open or not.
    pub fn connection_at(&self, place: &str) -> Option<&Connection> {
        self.connections().find(|connection| connection.is_at(place))
    }

    /// Puts an empty connection in front: a new one, or the one in front if nobody would miss what it holds.
    pub fn add_connection(&mut self) {
        if self.front.is_blank() {
            return;
        }
        let next =
            self.connections().map(Connection::id).max().map_or(ConnectionId::default(), ConnectionId::next);
        let before = std::mem::replace(&mut self.front, Connection::new(next));
        self.others.push(before);
        self.front.graph_for(self.screen);
    }

    /// Links that were closed long ago, beyond so many of them: their graphs take memory. One with edits that were not
    /// written, or whose recording still runs, is kept.
    pub fn closed_too_many(&self) -> Vec<ConnectionId> {
        let is_over = |connection: &&Connection| {
            connection.phase == Phase::Closed
                && !connection.settings.has_edits()
                && !connection.graph.files.is_recording()
        };
        let mut closed: Vec<ConnectionId> = self.others.iter().filter(is_over).map(Connection::id).collect();
        closed.sort_unstable();
        closed.truncate(closed.len().saturating_sub(MOST_CLOSED));
        closed
    }

    /// Takes a connection away. Without any other an empty one comes in its place.
    pub fn remove_connection(&mut self, id: ConnectionId) {
        if id == self.front.id() {
            let next = self.neighbour(true);
            if next == id {
                self.front = Connection::new(id.next());
            } else {
                self.bring_to_front(next);
            }
        }
        self.others.retain(|connection| connection.id() != id);
    }

    /// Shows the start page in the place of what is left of a connection, or of a file.
    pub fn show_start(&mut self) {
        self.files.close();
        self.front.shows_start = true;
    }

    /// Goes to a screen. Each screen that drives keeps its own choice of channels.
    pub fn turn_to(&mut self, screen: Screen) {
        self.screen = screen;
        self.front.graph_for(screen);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_links_that_were_closed_the_newest_stay_and_so_do_those_with_something_to_lose() {
        let mut model = Model::default();
        for number in 0..12 {
            let values = vec![0.0; model.front.graph.live.channels.len()];
            model.front.target = Some(format!("tcp:host:{number}"));
            model.front.graph.push(f64::from(number), &values);
            if number == 1 {
                model.front.phase = Phase::Open { target: "tcp:host:1".to_owned() };
            }
            model.add_connection();
        }
        let over = model.closed_too_many();
        assert_eq!(over.len(), 11 - MOST_CLOSED, "all but the open one were closed");
        for connection in over {
            model.remove_connection(connection);
        }
        assert!(model.closed_too_many().is_empty());
        let left: Vec<&str> =
            model.others.iter().filter_map(|connection| connection.target.as_deref()).collect();
        assert!(left.contains(&"tcp:host:1") && left.contains(&"tcp:host:11"), "{left:?}");
        assert!(!left.contains(&"tcp:host:0") && !left.contains(&"tcp:host:2"), "{left:?}");
    }
}
