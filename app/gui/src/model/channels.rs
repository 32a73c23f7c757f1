//! How a controller's channels stand in the graph at first.

use brushwork_link::device::Channel;

use super::screen::Screen;
use crate::graph::{ChannelInfo, Scale};

/// The channels with the scales they begin with; those of the status screen are shown at first.
pub fn graph_channels(channels: &[Channel]) -> Vec<ChannelInfo> {
    let info = |channel: &Channel| ChannelInfo {
        key: channel.key.to_owned(),
        label: channel.label.to_owned(),
        unit: channel.unit.to_owned(),
        decimals: channel.decimals,
        scale: Scale { low: channel.range[0], high: channel.range[1] },
        shown: Screen::DeviceStatus.first_channels().contains(channel),
        is_pin: channel.is_pin(),
    };
    channels.iter().map(info).collect()
}
