//! What a Motion Mind can tell, in order.

use brushwork_link::device::{Channel, ChannelDescription, Role};

/// Width of the R/C pulse.
pub const RC_PULSE: Channel =
    Channel::of(const { &ChannelDescription::new("r_c_pulse", "R/C Pulse", Role::Pulse) });
/// Analog control input.
pub const ANALOG_CONTROL: Channel =
    Channel::of(const { &ChannelDescription::new("analog_control", "Analog Control", Role::Analog) });
/// Analog feedback input.
pub const ANALOG_FEEDBACK: Channel =
    Channel::of(const { &ChannelDescription::new("analog_feedback", "Analog Feedback", Role::Analog) });
/// Position at the last index pulse.
pub const INDEX_POSITION: Channel =
    Channel::of(const { &ChannelDescription::new("index_position", "Index Position", Role::Position) });

/// All of them.
pub const CHANNELS: &[Channel] = &[
    Channel::M1_SETPOINT,
    Channel::M1_PWM,
    Channel::M1_VELOCITY,
    Channel::M1_POSITION,
    Channel::M1_CURRENT,
    Channel::TEMPERATURE_1,
    Channel::M1_POSITION_ERROR,
    RC_PULSE,
    ANALOG_CONTROL,
    ANALOG_FEEDBACK,
    INDEX_POSITION,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_has_names_of_its_own() {
        for (index, channel) in CHANNELS.iter().enumerate() {
            assert_eq!(channel.key, channel.label.to_ascii_lowercase().replace(['/', ' '], "_"));
            assert_eq!(CHANNELS.iter().position(|other| other == channel), Some(index));
        }
    }
}
