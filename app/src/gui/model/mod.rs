//! The window's state as plain data. Screens read it and ask for changes; nothing here draws or waits.

use std::collections::BTreeMap;
use std::sync::Arc;

use brushwork_link::device::{Addresses, Channel, PollRate};
use brushwork_sim::world::WorldView;
use egui::ThemePreference;

use super::graph::{ChannelInfo, LiveGraph, Scale};

pub mod devices;
pub mod general;
pub mod lamps;
pub mod link;
pub mod loop_settings;
pub mod message;
pub mod pwm;
pub mod readings;
pub mod screen;
pub mod setpoints;
pub mod velocity;
pub mod world;

use devices::Devices;
use general::General;
use link::LinkView;
use loop_settings::LoopSettings;
use message::Messages;
use pwm::Pwm;
use screen::Screen;
use velocity::Velocity;
use world::WorldPanel;

/// Everything the window shows.
#[derive(Debug)]
pub struct Model {
    pub screen: Screen,
    pub appearance: Appearance,
    pub devices: Devices,
    /// Which addresses to look for when connecting.
    pub addresses: Addresses,
    pub phase: Phase,
    /// What is known of the open link; empty while there is none.
    pub link: LinkView,
    pub messages: Messages,
    pub poll: PollRate,
    pub graph: LiveGraph,
    pub pwm: Pwm,
    /// The settings of the units met so far, and what is being done with them.
    pub general: General,
    pub velocity: Velocity,
    pub loops: LoopSettings,
    /// Which channels the graph showed when a screen that drives was left.
    graph_choices: BTreeMap<&'static str, Vec<bool>>,
    /// The screen whose channels the graph shows while a screen without a graph is open.
    graph_of: Option<Screen>,
    pub world: WorldPanel,
    /// The worlds of the simulated units, while they run.
    pub worlds: Option<Arc<Vec<WorldView>>>,
    /// Which of them is looked at.
    pub world_unit: usize,
}

/// How the window looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    pub theme: ThemePreference,
    /// Hard edges, which software rendering draws in less time.
    pub plain: bool,
}

/// Where the link is between closed and open.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    #[default]
    Closed,
    Opening {
        target: String,
    },
    Open {
        target: String,
    },
    /// Asked to close; the motors are being stopped.
    Closing {
        target: String,
    },
}

impl Phase {
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Open { .. })
    }

    /// What the link goes to.
    pub fn target(&self) -> Option<&str> {
        match self {
            Self::Closed => None,
            Self::Opening { target } | Self::Open { target } | Self::Closing { target } => Some(target),
        }
    }
}

impl Default for Model {
    fn default() -> Self {
        Self {
            screen: Screen::default(),
            appearance: Appearance { theme: ThemePreference::System, plain: false },
            devices: Devices::default(),
            addresses: Addresses::default(),
            phase: Phase::default(),
            link: LinkView::default(),
            messages: Messages::default(),
            poll: PollRate::default(),
            graph: LiveGraph::new(graph_channels(), 0.1),
            pwm: Pwm::default(),
            general: General::default(),
            velocity: Velocity::default(),
            loops: LoopSettings::default(),
            graph_choices: BTreeMap::new(),
            graph_of: None,
            world: WorldPanel::default(),
            worlds: None,
            world_unit: 0,
        }
    }
}

impl Model {
    /// Whether a unit has answered on an open link.
    pub fn is_connected(&self) -> bool {
        self.phase.is_open() && self.link.identity().is_some()
    }

    /// The sliders of every screen go back to rest, with nothing left to send.
    pub fn rest(&mut self) {
        self.pwm.setpoints.stop();
        self.velocity.setpoints.stop();
    }

    /// Goes to a screen. Each screen that drives keeps its own choice of channels.
    pub fn turn_to(&mut self, screen: Screen) {
        let left = std::mem::replace(&mut self.screen, screen);
        if screen.arm_scope().is_none() {
            // The graph stays as it is until another screen shows it.
            self.graph_of = self.graph_of.or(left.arm_scope().map(|_| left));
            return;
        }
        let before =
            self.graph_of.take().unwrap_or(if left.arm_scope().is_some() { left } else { Screen::Pwm });
        if before == screen {
            return;
        }
        let channels = &mut self.graph.channels;
        self.graph_choices.insert(before.title(), channels.iter().map(|channel| channel.shown).collect());
        let chosen = self.graph_choices.get(screen.title());
        for (index, channel) in channels.iter_mut().enumerate() {
            let at_first = || screen.first_channels().contains(&Channel::ALL[index]);
            channel.shown = chosen.and_then(|chosen| chosen.get(index)).copied().unwrap_or_else(at_first);
        }
    }
}

/// Every channel of a controller but its input pins, with the scale it begins with; duty and current of both motors are shown at first.
pub fn graph_channels() -> Vec<ChannelInfo> {
    let info = |channel: Channel| ChannelInfo {
        label: channel.label(),
        unit: channel.unit(),
        decimals: decimals(channel),
        scale: first_scale(channel),
        shown: Screen::Pwm.first_channels().contains(&channel),
    };
    Channel::ALL.into_iter().filter(|channel| !channel.is_signal()).map(info).collect()
}

/// Digits after the point that a channel's readings have.
pub fn decimals(channel: Channel) -> usize {
    match channel {
        Channel::M1Current | Channel::M2Current => 2,
        Channel::M1Setpoint | Channel::M2Setpoint | Channel::M1Pwm | Channel::M2Pwm => 1,
        Channel::Temperature1 | Channel::Temperature2 | Channel::MainBattery | Channel::LogicBattery => 1,
        _ => 0,
    }
}

fn first_scale(channel: Channel) -> Scale {
    match channel {
        Channel::M1Setpoint | Channel::M2Setpoint | Channel::M1Pwm | Channel::M2Pwm => {
            Scale::around_zero(100.0)
        }
        Channel::M1Current | Channel::M2Current => Scale::around_zero(1.0),
        Channel::Temperature1 | Channel::Temperature2 => Scale::from_zero(100.0),
        Channel::MainBattery => Scale::from_zero(40.0),
        Channel::LogicBattery => Scale::from_zero(20.0),
        _ => Scale::around_zero(1000.0),
    }
}
