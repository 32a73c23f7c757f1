//! What an MCP or RoboClaw can tell, in order: the motors' signals, then its input pins.

use crate::device::channel::{Channel, ChannelDescription, Role};

/// The channel of the input pin with this number.
macro_rules! pin {
    ($number:literal) => {
        Channel::of(
            const { &ChannelDescription::new(concat!("din", $number), concat!("DIN", $number), Role::Pin) },
        )
    };
}

/// All of them; a model has the first of the pins, as many as it has. No model has more than these.
pub const CHANNELS: &[Channel] = &[
    Channel::M1_SETPOINT,
    Channel::M1_PWM,
    Channel::M1_VELOCITY,
    Channel::M1_POSITION,
    Channel::M1_CURRENT,
    Channel::M2_SETPOINT,
    Channel::M2_PWM,
    Channel::M2_VELOCITY,
    Channel::M2_POSITION,
    Channel::M2_CURRENT,
    Channel::TEMPERATURE_1,
    Channel::TEMPERATURE_2,
    Channel::MAIN_BATTERY,
    Channel::LOGIC_BATTERY,
    Channel::M1_SPEED_ERROR,
    Channel::M2_SPEED_ERROR,
    Channel::M1_POSITION_ERROR,
    Channel::M2_POSITION_ERROR,
    pin!(1),
    pin!(2),
    pin!(3),
    pin!(4),
    pin!(5),
    pin!(6),
    pin!(7),
    pin!(8),
    pin!(9),
    pin!(10),
    pin!(11),
    pin!(12),
    pin!(13),
    pin!(14),
    pin!(15),
    pin!(16),
    pin!(17),
    pin!(18),
];

/// The channels of the input pins in the order of command 144.
pub fn pins() -> impl Iterator<Item = Channel> {
    CHANNELS.iter().copied().filter(|channel| channel.is_pin())
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::models::MODELS;

    #[test]
    fn every_channel_has_names_of_its_own_and_every_pin_a_channel() {
        for (index, channel) in CHANNELS.iter().enumerate() {
            assert_eq!(channel.key, channel.label.to_ascii_lowercase().replace(' ', "_"));
            assert_eq!(CHANNELS.iter().position(|other| other == channel), Some(index));
        }
        assert!(MODELS.iter().all(|model| model.pins.len() <= pins().count()));
        assert_eq!(pins().nth(2).map(|pin| pin.key), Some("din3"));
    }
}
