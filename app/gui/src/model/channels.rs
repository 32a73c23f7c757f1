//! How a controller's channels stand in the graph at first, and with how many digits they are read.

use brushwork_link::device::Channel;

use super::screen::Screen;
use crate::graph::{ChannelInfo, Scale};

/// Every channel of a controller with the scale it begins with; those of the PWM screen are shown at first.
pub fn graph_channels() -> Vec<ChannelInfo> {
    let info = |channel: Channel| ChannelInfo {
        key: channel.key(),
        label: channel.label().to_owned(),
        unit: channel.unit().to_owned(),
        decimals: decimals(channel),
        scale: first_scale(channel),
        shown: Screen::Pwm.first_channels().contains(&channel),
        is_pin: channel.is_signal(),
    };
    Channel::ALL.into_iter().map(info).collect()
}

/// Digits after the point that a channel's readings have.
pub fn decimals(channel: Channel) -> usize {
    match channel {
        Channel::M1Current | Channel::M2Current => 2,
        Channel::M1Setpoint | Channel::M2Setpoint | Channel::M1Pwm | Channel::M2Pwm => 1,
        Channel::Temperature1 | Channel::Temperature2 | Channel::MainBattery | Channel::LogicBattery => 1,
        Channel::RcPulse => 3,
        Channel::AnalogControl | Channel::AnalogFeedback => 2,
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
        Channel::RcPulse => Scale::from_zero(2.5),
        Channel::AnalogControl | Channel::AnalogFeedback => Scale::from_zero(5.0),
        _ => Scale::around_zero(1000.0),
    }
}
