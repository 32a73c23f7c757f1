//! Limits, reference, the 16 channels, analog inputs and the analog output (SuprMotr manual, connectors J1 to J4).

use super::assumed::{ON_VOLTS, OPEN_VOLTS};
use super::config::{CHANNELS, pin};
use brushwork_plant::world::{PinState, SWITCH_OPEN_VOLTS, World};

/// Full scale of the analog inputs and the analog output, in volts.
const FULL_VOLTS: f64 = 5.0;
/// Steps of 19.5 mV.
const ANALOG_STEPS: f64 = 256.0;

/// What is on the inputs now, and what the outputs are told.
#[derive(Clone, Debug, Default)]
pub struct Channels {
    /// Each bit a channel that is an output.
    directions: u16,
    /// What the outputs are told, and what a channel gives that becomes one.
    latches: u16,
    levels: u16,
    limit_levels: [bool; 3],
    analog: [u8; 2],
    analog_output: u8,
}

/// The lines at the motor connector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// E1.
    Negative,
    /// Index or reference.
    Reference,
    /// E2.
    Positive,
}

impl Channels {
    /// Reads all inputs.
    pub fn read(&mut self, world: &mut World) {
        // The pull-ups of the limit lines are on the board.
        let limit_pins = [pin::NEGATIVE_LIMIT, pin::REFERENCE, pin::POSITIVE_LIMIT];
        self.limit_levels = limit_pins.map(|pin| volts(world.pin(pin), SWITCH_OPEN_VOLTS) >= ON_VOLTS);
        self.levels = (0..CHANNELS)
            .filter(|channel| volts(world.pin(pin::CHANNEL_1 + channel), OPEN_VOLTS) >= ON_VOLTS)
            .fold(0, |levels, channel| levels | 1 << channel);
        self.analog = [
            step_of(volts(world.pin(pin::ANALOG_1), OPEN_VOLTS)),
            step_of(volts(world.pin(pin::ANALOG_2), FULL_VOLTS)),
        ];
    }

    /// Whether a limit or the reference is active, which is high or low.
    pub fn is_active(&self, line: Line, is_active_high: bool) -> bool {
        self.limit_levels[line as usize] == is_active_high
    }

    /// All inputs, channel 1 in bit 0; a channel that is an output reads what it gives.
    pub fn inputs(&self) -> u16 {
        (self.levels & !self.directions) | (self.latches & self.directions)
    }

    /// All outputs, channel 1 in bit 0; a channel that is an input gives nothing.
    pub fn outputs(&self) -> u16 {
        self.latches & self.directions
    }

    /// Whether an input is on, its channel counted from 1.
    pub fn is_on(&self, channel: i64) -> bool {
        self.inputs() & mask_of(channel) != 0
    }

    /// Turns an output on or off, which makes its channel one; 0 means all.
    pub fn switch(&mut self, channel: i64, is_on: bool) {
        let mask = if channel == 0 { u16::MAX } else { mask_of(channel) };
        self.directions |= mask;
        self.latches = if is_on { self.latches | mask } else { self.latches & !mask };
    }

    /// Sets all outputs, channel 1 in bit 0.
    pub fn set_pattern(&mut self, pattern: i64) {
        self.directions = u16::MAX;
        // What is above 16 bits has no channel.
        self.latches = (pattern & i64::from(u16::MAX)) as u16;
    }

    /// Makes a channel an output, or an input; 0 means all.
    pub fn set_direction(&mut self, channel: i64, is_output: bool) {
        let mask = if channel == 0 { u16::MAX } else { mask_of(channel) };
        self.directions = if is_output { self.directions | mask } else { self.directions & !mask };
    }

    /// Analog inputs 1 and 2, in steps of 19.5 mV.
    pub fn analog(&self) -> [u8; 2] {
        self.analog
    }

    /// The analog output, in steps of 19.5 mV.
    pub fn analog_output(&self) -> u8 {
        self.analog_output
    }

    /// Sets it.
    pub fn set_analog_output(&mut self, steps: i64) {
        self.analog_output = steps.clamp(0, 255) as u8;
    }

    /// Changes it, and goes on from the other end: the manual makes a saw-tooth of that.
    pub fn change_analog_output(&mut self, by: i64) {
        self.analog_output = (i64::from(self.analog_output) + by).rem_euclid(ANALOG_STEPS as i64) as u8;
    }

    /// The address that channels 14 to 16 make, the lowest in bit 0.
    pub fn address_pins(&self) -> u8 {
        (self.levels >> 13) as u8
    }
}

fn mask_of(channel: i64) -> u16 {
    let bit = u32::try_from(channel - 1).unwrap_or(u32::MAX);
    1_u16.checked_shl(bit).unwrap_or(0)
}

fn volts(state: PinState, open_volts: f64) -> f64 {
    match state {
        PinState::Volts(volts) => volts,
        PinState::Open | PinState::Pulse { .. } | PinState::Counts(_) => open_volts,
    }
}

fn step_of(volts: f64) -> u8 {
    (volts / FULL_VOLTS * ANALOG_STEPS).floor().clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_reads_what_it_gives_and_an_input_what_is_on_it() {
        let mut channels = Channels { levels: 0b1010, ..Channels::default() };
        channels.switch(1, true);
        channels.switch(2, false);
        assert_eq!((channels.inputs(), channels.outputs()), (0b1001, 0b0001));
        channels.set_direction(2, false);
        assert!(channels.is_on(2), "it is an input again");
        channels.switch(0, true);
        assert_eq!(channels.outputs(), 0xFFFF);
        channels.set_pattern(0x1_8001);
        assert_eq!(channels.outputs(), 0x8001);
        assert!(!channels.is_on(17) && !channels.is_on(-3), "there are 16");
    }

    #[test]
    fn the_analog_output_goes_on_from_the_other_end() {
        let mut channels = Channels::default();
        channels.set_analog_output(255);
        channels.change_analog_output(1);
        assert_eq!(channels.analog_output(), 0);
        channels.change_analog_output(-2);
        assert_eq!(channels.analog_output(), 254);
    }

    /// 2.5 V of 5 V in 256 steps; 19.5 mV a step.
    #[test]
    fn analog_inputs_have_steps_of_19_5_millivolts() {
        assert_eq!([0.0, 0.0196, 2.5, 5.0, 12.0, -3.0].map(step_of), [0, 1, 128, 255, 255, 0]);
    }
}
