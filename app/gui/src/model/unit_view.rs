//! How a unit was looked at, kept from one time to the next: the screen, and of its graph the channels, their scales and the time in view.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Connection, Screen, to_all};
use crate::graph::{GraphAction, Scale};

/// How a unit was looked at.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct UnitView {
    /// What the unit is called, with its place and port.
    pub unit: String,
    /// The screen's title.
    pub screen: String,
    /// The time in view.
    pub span_s: f64,
    /// Whether the list of channels is folded away.
    pub folded: bool,
    /// The keys of the channels that the graph of a screen shows, by the screen's title.
    pub shown: BTreeMap<String, Vec<String>>,
    /// Bottom and top of the scales that were set by hand, by the channel's key.
    pub scales: BTreeMap<String, [f64; 2]>,
}

impl Connection {
    /// What the unit that is looked at is called, with its place and port.
    pub fn unit_name(&self) -> Option<String> {
        self.link.identity().map(to_all::unit_name)
    }

    /// How the unit that is looked at is looked at.
    pub fn unit_view(&self, screen: Screen) -> Option<UnitView> {
        let sheet = &self.graph.live;
        let key = |index: usize| sheet.channels.get(index).map(|channel| channel.info.key.clone());
        let keys = |shown: &[bool]| -> Vec<String> {
            let places = shown.iter().enumerate().filter(|(_, shown)| **shown);
            places.filter_map(|(index, _)| key(index)).collect()
        };
        let now: Vec<bool> = sheet.channels.iter().map(|channel| channel.shown).collect();
        let mut shown: BTreeMap<String, Vec<String>> =
            self.graph_choices.iter().map(|(title, shown)| ((*title).to_owned(), keys(shown))).collect();
        shown.insert(self.graph_of.title().to_owned(), keys(&now));
        let by_hand = sheet.channels.iter().filter(|channel| !channel.grows);
        let scales =
            by_hand.map(|channel| (channel.info.key.clone(), [channel.scale.low, channel.scale.high]));
        Some(UnitView {
            unit: self.unit_name()?,
            screen: screen.title().to_owned(),
            span_s: sheet.span_s(),
            folded: self.graph.legend.is_some(),
            shown,
            scales: scales.collect(),
        })
    }

    /// Looks at the unit as before. What makes no sense, or what it has no more, stays as it is at first.
    pub fn look_as(&mut self, view: &UnitView) {
        if view.span_s.is_finite() && view.span_s > 0.0 {
            self.graph.live.set_span_s(view.span_s);
        }
        if view.folded != self.graph.legend.is_some() {
            self.graph.act(GraphAction::ToggleList);
        }
        for screen in Screen::ALL {
            let Some(keys) = view.shown.get(screen.title()) else { continue };
            let channels = self.graph.live.channels.iter();
            let shown: Vec<bool> = channels.map(|channel| keys.contains(&channel.info.key)).collect();
            self.graph_choices.insert(screen.title(), shown);
        }
        self.show_channels(self.graph_of);
        for (key, [low, high]) in &view.scales {
            if let Some(channel) = self.graph.live.track.channel_of_key(key) {
                self.graph.live.set_scale(channel, Scale { low: *low, high: *high });
            }
        }
    }
}
