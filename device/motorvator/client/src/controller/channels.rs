//! What half a board can tell, in order: what the library says that it has told the motors, and the analog inputs of the whole board.

use brushwork_link::device::{Channel, ChannelDescription, Role};

/// An analog input: ReadAnalogue gives 0 to 255, and no page says of how many volts.
const fn analog(key: &'static str, label: &'static str) -> ChannelDescription {
    let usual = ChannelDescription::new(key, label, Role::Analog);
    ChannelDescription { unit: "", decimals: 0, range: [0.0, 255.0], ..usual }
}

/// The analog inputs, from 1 on.
pub const ANALOG: [Channel; 6] = [
    Channel::of(const { &analog("analog_input_1", "Analog Input 1") }),
    Channel::of(const { &analog("analog_input_2", "Analog Input 2") }),
    Channel::of(const { &analog("analog_input_3", "Analog Input 3") }),
    Channel::of(const { &analog("analog_input_4", "Analog Input 4") }),
    Channel::of(const { &analog("analog_input_5", "Analog Input 5") }),
    Channel::of(const { &analog("analog_input_6", "Analog Input 6") }),
];

/// All of them.
pub const CHANNELS: &[Channel] = &[
    Channel::M1_SETPOINT,
    Channel::M1_PWM,
    Channel::M2_SETPOINT,
    Channel::M2_PWM,
    ANALOG[0],
    ANALOG[1],
    ANALOG[2],
    ANALOG[3],
    ANALOG[4],
    ANALOG[5],
];
