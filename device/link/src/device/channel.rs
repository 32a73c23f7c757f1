//! The signals that a graph can show, and one sweep's readings of them.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// One signal of a controller. Those before the errors are of Ion Studio's graphs and status row (MCP manual 1.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// What motor 1 was last told by this program, in the unit of that command: %, counts/s or counts.
    M1Setpoint,
    /// Motor 1's output, % of full duty.
    M1Pwm,
    /// Motor 1's speed, counts/s.
    M1Velocity,
    /// Motor 1's encoder, counts.
    M1Position,
    /// Motor 1's current, A.
    M1Current,
    /// What motor 2 was last told by this program, in the unit of that command: %, counts/s or counts.
    M2Setpoint,
    /// Motor 2's output, % of full duty.
    M2Pwm,
    /// Motor 2's speed, counts/s.
    M2Velocity,
    /// Motor 2's encoder, counts.
    M2Position,
    /// Motor 2's current, A.
    M2Current,
    /// First board temperature, degrees Celsius.
    Temperature1,
    /// Second board temperature, degrees Celsius.
    Temperature2,
    /// Main battery, V.
    MainBattery,
    /// Logic battery, V.
    LogicBattery,
    /// Motor 1's speed error as the controller reports it, counts/s.
    M1SpeedError,
    /// Motor 2's speed error as the controller reports it, counts/s.
    M2SpeedError,
    /// Motor 1's position error as the controller reports it, counts.
    M1PositionError,
    /// Motor 2's position error as the controller reports it, counts.
    M2PositionError,
    /// Width of the R/C pulse of a Motion Mind, ms.
    RcPulse,
    /// Analog control input of a Motion Mind, V.
    AnalogControl,
    /// Analog feedback input of a Motion Mind, V.
    AnalogFeedback,
    /// Position at the last index pulse of a Motion Mind, counts.
    IndexPosition,
    /// How far input 1 is in its range, %.
    Signal1,
    /// How far input 2 is in its range, %.
    Signal2,
    /// How far input 3 is in its range, %.
    Signal3,
    /// How far input 4 is in its range, %.
    Signal4,
    /// How far input 5 is in its range, %.
    Signal5,
    /// How far input 6 is in its range, %.
    Signal6,
    /// How far input 7 is in its range, %.
    Signal7,
    /// How far input 8 is in its range, %.
    Signal8,
    /// How far input 9 is in its range, %.
    Signal9,
    /// How far input 10 is in its range, %.
    Signal10,
    /// How far input 11 is in its range, %.
    Signal11,
    /// How far input 12 is in its range, %.
    Signal12,
    /// How far input 13 is in its range, %.
    Signal13,
    /// How far input 14 is in its range, %.
    Signal14,
    /// How far input 15 is in its range, %.
    Signal15,
    /// How far input 16 is in its range, %.
    Signal16,
    /// How far input 17 is in its range, %.
    Signal17,
    /// How far input 18 is in its range, %.
    Signal18,
}

impl Channel {
    /// How many channels there are.
    pub const COUNT: usize = 22 + Self::SIGNALS;

    /// How many of them are input pins; no model of the family has more. They come last and are read on request only.
    pub const SIGNALS: usize = 18;

    /// What an MCP or RoboClaw can tell; pins as far as the model has them.
    pub const PACKET_SERIAL: &'static [Self] = &[
        Self::M1Setpoint,
        Self::M1Pwm,
        Self::M1Velocity,
        Self::M1Position,
        Self::M1Current,
        Self::M2Setpoint,
        Self::M2Pwm,
        Self::M2Velocity,
        Self::M2Position,
        Self::M2Current,
        Self::Temperature1,
        Self::Temperature2,
        Self::MainBattery,
        Self::LogicBattery,
        Self::M1SpeedError,
        Self::M2SpeedError,
        Self::M1PositionError,
        Self::M2PositionError,
        Self::Signal1,
        Self::Signal2,
        Self::Signal3,
        Self::Signal4,
        Self::Signal5,
        Self::Signal6,
        Self::Signal7,
        Self::Signal8,
        Self::Signal9,
        Self::Signal10,
        Self::Signal11,
        Self::Signal12,
        Self::Signal13,
        Self::Signal14,
        Self::Signal15,
        Self::Signal16,
        Self::Signal17,
        Self::Signal18,
    ];

    /// What a Motion Mind can tell.
    pub const MOTION_MIND: &'static [Self] = &[
        Self::M1Setpoint,
        Self::M1Pwm,
        Self::M1Velocity,
        Self::M1Position,
        Self::M1Current,
        Self::Temperature1,
        Self::M1PositionError,
        Self::RcPulse,
        Self::AnalogControl,
        Self::AnalogFeedback,
        Self::IndexPosition,
    ];

    /// All of them in the order of their index.
    pub const ALL: [Self; Self::COUNT] = [
        Self::M1Setpoint,
        Self::M1Pwm,
        Self::M1Velocity,
        Self::M1Position,
        Self::M1Current,
        Self::M2Setpoint,
        Self::M2Pwm,
        Self::M2Velocity,
        Self::M2Position,
        Self::M2Current,
        Self::Temperature1,
        Self::Temperature2,
        Self::MainBattery,
        Self::LogicBattery,
        Self::M1SpeedError,
        Self::M2SpeedError,
        Self::M1PositionError,
        Self::M2PositionError,
        Self::RcPulse,
        Self::AnalogControl,
        Self::AnalogFeedback,
        Self::IndexPosition,
        Self::Signal1,
        Self::Signal2,
        Self::Signal3,
        Self::Signal4,
        Self::Signal5,
        Self::Signal6,
        Self::Signal7,
        Self::Signal8,
        Self::Signal9,
        Self::Signal10,
        Self::Signal11,
        Self::Signal12,
        Self::Signal13,
        Self::Signal14,
        Self::Signal15,
        Self::Signal16,
        Self::Signal17,
        Self::Signal18,
    ];

    /// Place in [`Channel::ALL`] and in a sample's values.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// Name for people, as Ion Studio's graph writes it.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::M1Setpoint => "M1 Setpoint",
            Self::M1Pwm => "M1 PWM",
            Self::M1Velocity => "M1 Velocity",
            Self::M1Position => "M1 Position",
            Self::M1Current => "M1 Current",
            Self::M2Setpoint => "M2 Setpoint",
            Self::M2Pwm => "M2 PWM",
            Self::M2Velocity => "M2 Velocity",
            Self::M2Position => "M2 Position",
            Self::M2Current => "M2 Current",
            Self::Temperature1 => "Temperature 1",
            Self::Temperature2 => "Temperature 2",
            Self::MainBattery => "Main Battery",
            Self::LogicBattery => "Logic Battery",
            Self::M1SpeedError => "M1 Speed Error",
            Self::M2SpeedError => "M2 Speed Error",
            Self::M1PositionError => "M1 Position Error",
            Self::M2PositionError => "M2 Position Error",
            Self::RcPulse => "R/C Pulse",
            Self::AnalogControl => "Analog Control",
            Self::AnalogFeedback => "Analog Feedback",
            Self::IndexPosition => "Index Position",
            Self::Signal1 => "DIN1",
            Self::Signal2 => "DIN2",
            Self::Signal3 => "DIN3",
            Self::Signal4 => "DIN4",
            Self::Signal5 => "DIN5",
            Self::Signal6 => "DIN6",
            Self::Signal7 => "DIN7",
            Self::Signal8 => "DIN8",
            Self::Signal9 => "DIN9",
            Self::Signal10 => "DIN10",
            Self::Signal11 => "DIN11",
            Self::Signal12 => "DIN12",
            Self::Signal13 => "DIN13",
            Self::Signal14 => "DIN14",
            Self::Signal15 => "DIN15",
            Self::Signal16 => "DIN16",
            Self::Signal17 => "DIN17",
            Self::Signal18 => "DIN18",
        }
    }

    /// Name for files and the command line: snake_case.
    #[must_use]
    pub fn key(self) -> String {
        self.label().to_ascii_lowercase().replace(['/', ' '], "_")
    }

    /// The unit of its values. A setpoint has the unit of the command it came with, so it has none here.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::M1Setpoint | Self::M2Setpoint => "",
            Self::M1Pwm | Self::M2Pwm => "%",
            Self::M1Velocity | Self::M2Velocity | Self::M1SpeedError | Self::M2SpeedError => "counts/s",
            Self::M1Position | Self::M2Position | Self::M1PositionError | Self::M2PositionError => "counts",
            Self::M1Current | Self::M2Current => "A",
            Self::Temperature1 | Self::Temperature2 => "°C",
            Self::MainBattery | Self::LogicBattery | Self::AnalogControl | Self::AnalogFeedback => "V",
            Self::IndexPosition => "counts",
            Self::RcPulse => "ms",
            _ => "%",
        }
    }

    /// Whether it is an input pin.
    #[must_use]
    pub fn is_signal(self) -> bool {
        self >= Self::Signal1
    }

    /// The channel of an input pin, counted from 0 in the order of command 144.
    #[must_use]
    pub fn signal(pin: usize) -> Option<Self> {
        Self::ALL.get(Self::COUNT - Self::SIGNALS..)?.get(pin).copied()
    }
}

/// What a controller makes of one input pin: a record of command 147 (MCP manual 1.9.12).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PinSignal {
    /// What the pin commands, in steps of 1/32767 of full output.
    pub command: i32,
    /// Shaped distance from the center, in units of the input.
    pub position: i32,
    /// The position as a share of its side of the range, in steps of 1/32767.
    pub percent: i32,
    /// Speed at this moment, units of the input per second.
    pub speed: i32,
    /// Averaged speed, units of the input per second.
    pub average_speed: i32,
}

/// What one sweep read from one controller. Signals that are read in rotation are absent from most sweeps.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The unit's address on its bus.
    pub address: u8,
    /// Counts up by one with each sample of a link, so that dropped ones leave a visible gap.
    pub sequence: u64,
    /// Host time at which the sweep's first request was written.
    pub requested_at: Duration,
    /// Host time at which the sweep's last reply was complete.
    pub replied_at: Duration,
    /// By [`Channel::index`]; NaN for what this sweep did not read.
    pub values: [f64; Channel::COUNT],
    /// By input pin; empty in a sweep that did not read them.
    pub signals: Vec<PinSignal>,
    /// Host times of request and reply of each value's own exchange.
    spans: [(Duration, Duration); Channel::COUNT],
}

impl Sample {
    /// A sample without readings.
    #[must_use]
    pub fn new(address: u8) -> Self {
        Self {
            address,
            sequence: 0,
            requested_at: Duration::MAX,
            replied_at: Duration::ZERO,
            values: [f64::NAN; Channel::COUNT],
            signals: Vec::new(),
            spans: [(Duration::ZERO, Duration::ZERO); Channel::COUNT],
        }
    }

    /// Enters a reading with the host times of its request and its reply.
    pub fn set(&mut self, channel: Channel, value: f64, requested_at: Duration, replied_at: Duration) {
        self.values[channel.index()] = value;
        self.spans[channel.index()] = (requested_at, replied_at);
        self.requested_at = self.requested_at.min(requested_at);
        self.replied_at = self.replied_at.max(replied_at);
    }

    /// The reading of a channel, if this sweep has one.
    #[must_use]
    pub fn get(&self, channel: Channel) -> Option<f64> {
        let value = self.values[channel.index()];
        (!value.is_nan()).then_some(value)
    }

    /// Host times of the request and of the complete reply that brought a channel's reading.
    #[must_use]
    pub fn span(&self, channel: Channel) -> Option<(Duration, Duration)> {
        self.get(channel).map(|_| self.spans[channel.index()])
    }

    /// When a channel was read: half way between its request and its reply.
    #[must_use]
    pub fn read_at(&self, channel: Channel) -> Option<Duration> {
        let (requested_at, replied_at) = self.spans[channel.index()];
        self.get(channel).map(|_| requested_at + replied_at.saturating_sub(requested_at) / 2)
    }

    /// Whether nothing was read at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.iter().all(|value| value.is_nan())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_stands_at_its_own_index_and_has_its_own_names() {
        for (index, channel) in Channel::ALL.into_iter().enumerate() {
            assert_eq!(channel.index(), index);
        }
        let mut keys: Vec<_> = Channel::ALL.iter().map(|channel| channel.key()).collect();
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), Channel::COUNT);
        assert_eq!(Channel::M1SpeedError.key(), "m1_speed_error");
        assert_eq!(Channel::signal(2), Some(Channel::Signal3));
        assert_eq!(Channel::signal(18), None);
        assert_eq!(Channel::ALL.iter().filter(|channel| channel.is_signal()).count(), Channel::SIGNALS);
    }

    #[test]
    fn a_sample_spans_its_exchanges_and_dates_each_reading_by_its_own() {
        let ms = Duration::from_millis;
        let mut sample = Sample::new(0x80);
        assert!(sample.is_empty());
        sample.set(Channel::M1Pwm, 12.5, ms(100), ms(102));
        sample.set(Channel::MainBattery, 24.0, ms(102), ms(106));
        assert_eq!((sample.requested_at, sample.replied_at), (ms(100), ms(106)));
        assert_eq!(sample.read_at(Channel::MainBattery), Some(ms(104)));
        assert_eq!(sample.span(Channel::M1Pwm), Some((ms(100), ms(102))));
        assert_eq!(sample.span(Channel::M2Pwm), None);
        assert_eq!(sample.get(Channel::M1Pwm), Some(12.5));
        assert_eq!(sample.get(Channel::M2Pwm), None);
        assert_eq!(sample.read_at(Channel::M2Pwm), None);
    }
}
