//! What an MCP or RoboClaw can tell, in order: the signals of Ion Studio's graphs and status row (MCP manual 1.2), the errors of its
//! loops, then its input pins.

use brushwork_link::device::{Channel, ChannelDescription, Role};

/// A list of shared channels by their names, then of input pins by their numbers.
macro_rules! channels {
    ($($shared:ident)*; $($pin:literal)*) => {
        &[
            $(Channel::$shared,)*
            $(Channel::of(const {
                &ChannelDescription::new(concat!("din", $pin), concat!("DIN", $pin), Role::Pin)
            }),)*
        ]
    };
}

/// All of them; a model has the first of the pins, as many as it has. No model has more than these.
pub const CHANNELS: &[Channel] = channels! {
    M1_SETPOINT M1_PWM M1_VELOCITY M1_POSITION M1_CURRENT
    M2_SETPOINT M2_PWM M2_VELOCITY M2_POSITION M2_CURRENT
    TEMPERATURE_1 TEMPERATURE_2 MAIN_BATTERY LOGIC_BATTERY
    M1_SPEED_ERROR M2_SPEED_ERROR M1_POSITION_ERROR M2_POSITION_ERROR;
    1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18
};

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
