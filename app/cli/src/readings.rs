//! What has been read of a unit so far, for `brushwork status` and `drive`.

use brushwork_link::capability::CapabilityMap;
use brushwork_link::device::Newest;
use brushwork_link::{Channel, Event, Identity, SettingsImage, StatusReport, Stream};
use serde_json::{Map, Value, json};

/// The newest of everything.
#[derive(Default)]
pub struct Readings {
    newest: Newest,
    is_all_read: bool,
    /// What the unit's firmware is known to answer.
    pub capabilities: CapabilityMap,
    /// What the unit reports.
    pub status: Option<StatusReport>,
    /// The stream that the port is wired to.
    pub stream: Option<Stream>,
    /// The settings in RAM.
    pub settings: Option<SettingsImage>,
    /// Where the input pins stand, raw as the wire carries it, where the unit tells.
    pub inputs: Option<Vec<i64>>,
}

impl Readings {
    /// Takes over what an event tells.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn take(&mut self, event: &Event) {
        match event {
            Event::Sample(sample) => {
                self.is_all_read |= sample.is_all_read;
                self.newest.update(sample);
            }
            Event::Capabilities { map, .. } => self.capabilities = map.clone(),
            Event::Status(status) => self.status = Some(*status),
            Event::Selected { stream, .. } => self.stream = *stream,
            _ => {}
        }
    }

    /// A channel's newest value.
    pub fn get(&self, channel: Channel) -> Option<f64> {
        self.newest.get(channel)
    }

    /// Whether the signals that every unit tells have come round, or all that this one tells.
    pub fn is_complete(&self, identity: &Identity) -> bool {
        let wanted = [
            Channel::M1_POSITION,
            Channel::M1_VELOCITY,
            Channel::M1_CURRENT,
            Channel::MAIN_BATTERY,
            Channel::LOGIC_BATTERY,
            Channel::TEMPERATURE_1,
        ];
        let is_there = |channel| !identity.channels().contains(&channel) || self.get(channel).is_some();
        self.is_all_read || self.status.is_some() && wanted.into_iter().all(is_there)
    }

    /// The channels of a unit but the input pins as JSON, by their keys; what was not read is null.
    pub fn to_json(&self, identity: &Identity) -> Map<String, Value> {
        let polled = identity.channels().iter().copied().filter(|channel| !channel.is_pin());
        polled.map(|channel| (channel.key.to_owned(), json!(self.get(channel)))).collect()
    }
}
