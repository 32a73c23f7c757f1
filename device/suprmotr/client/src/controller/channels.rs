//! What a SuprMotr can tell, in order.

use brushwork_link::device::{Channel, ChannelDescription, Role};
use brushwork_values::Motor;

/// Where the trajectory is: position and following error, read one after the other, added up.
pub const COMPUTED_TARGET: Channel = Channel::of(
    const {
        &ChannelDescription {
            motor: Some(Motor::M1),
            ..ChannelDescription::new("computed_target", "Computed Target", Role::Position)
        }
    },
);
/// The difference of two positions over the time between them.
pub const COMPUTED_VELOCITY: Channel = Channel::of(
    const {
        &ChannelDescription {
            motor: Some(Motor::M1),
            ..ChannelDescription::new("computed_velocity", "Computed Velocity", Role::Velocity)
        }
    },
);

/// All of them.
pub const CHANNELS: &[Channel] = &[
    Channel::M1_SETPOINT,
    Channel::M1_POSITION,
    COMPUTED_TARGET,
    Channel::M1_POSITION_ERROR,
    COMPUTED_VELOCITY,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_has_names_of_its_own_and_what_is_computed_says_so() {
        for (index, channel) in CHANNELS.iter().enumerate() {
            assert_eq!(channel.key, channel.label.to_ascii_lowercase().replace(' ', "_"));
            assert_eq!(CHANNELS.iter().position(|other| other == channel), Some(index));
        }
    }
}
