//! The signals that a controller can tell, each described by its family, and one sweep's readings of them.

use brushwork_values::Motor;
use std::fmt;
use std::ops::Deref;
use std::time::Duration;

/// What a channel is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// What a motor was last told by this program, in the unit of that command: %, counts/s or counts.
    Setpoint,
    /// A motor's output, % of full duty.
    Pwm,
    /// A motor's speed, counts/s.
    Velocity,
    /// A position, counts.
    Position,
    /// A motor's current, A.
    Current,
    /// A speed error as the controller reports it, counts/s.
    SpeedError,
    /// A position error as the controller reports it, counts.
    PositionError,
    /// Degrees Celsius.
    Temperature,
    /// A supply, V.
    Battery,
    /// Width of a radio control pulse, ms.
    Pulse,
    /// An analog input, V.
    Analog,
    /// How far an input pin is in its range, %. Pins are read on request only.
    Pin,
}

impl Role {
    /// Unit, digits after the point, and the range that a graph begins with. A setpoint's unit comes with its command.
    const fn reading(self) -> (&'static str, usize, [f64; 2]) {
        match self {
            Self::Setpoint => ("", 1, [-100.0, 100.0]),
            Self::Pwm => ("%", 1, [-100.0, 100.0]),
            Self::Velocity | Self::SpeedError => ("counts/s", 0, [-1000.0, 1000.0]),
            Self::Position | Self::PositionError => ("counts", 0, [-1000.0, 1000.0]),
            Self::Current => ("A", 2, [-1.0, 1.0]),
            Self::Temperature => ("°C", 1, [0.0, 100.0]),
            Self::Battery => ("V", 1, [0.0, 40.0]),
            Self::Pulse => ("ms", 3, [0.0, 2.5]),
            Self::Analog => ("V", 2, [0.0, 5.0]),
            Self::Pin => ("%", 0, [-1000.0, 1000.0]),
        }
    }
}

/// What there is to know of a channel; a family has one for each signal that it can tell.
#[derive(Debug)]
pub struct ChannelDescription {
    /// Name in files and on the command line: snake_case, its own among all families unless it is the same signal.
    pub key: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Unit of its values.
    pub unit: &'static str,
    /// What it is of.
    pub role: Role,
    /// The motor that it belongs to.
    pub motor: Option<Motor>,
    /// Digits after the point of a readout.
    pub decimals: usize,
    /// From where to where a graph begins.
    pub range: [f64; 2],
}

impl ChannelDescription {
    /// A channel that is read as usual in its role.
    #[must_use]
    pub const fn new(key: &'static str, label: &'static str, role: Role) -> Self {
        let (unit, decimals, range) = role.reading();
        Self { key, label, unit, role, motor: None, decimals, range }
    }
}

/// One signal of a controller: a handle to its description, known by its key.
#[derive(Clone, Copy)]
pub struct Channel(&'static ChannelDescription);

/// The channels that more than one family has: name, key, label, role, motor, and a range where it is not that of the role.
macro_rules! shared {
    ($($(#[$doc:meta])* $name:ident $key:literal $label:literal $role:ident [$($motor:ident)?] $($range:expr)?;)*) => {
        impl Channel {$(
            $(#[$doc])*
            pub const $name: Self = Self(const {
                &ChannelDescription {
                    $(motor: Some(Motor::$motor),)?
                    $(range: $range,)?
                    ..ChannelDescription::new($key, $label, Role::$role)
                }
            });
        )*}
    };
}

shared! {
    /// What motor 1 was last told by this program.
    M1_SETPOINT "m1_setpoint" "M1 Setpoint" Setpoint [M1];
    /// Motor 1's output.
    M1_PWM "m1_pwm" "M1 PWM" Pwm [M1];
    /// Motor 1's speed.
    M1_VELOCITY "m1_velocity" "M1 Velocity" Velocity [M1];
    /// Motor 1's encoder.
    M1_POSITION "m1_position" "M1 Position" Position [M1];
    /// Motor 1's current.
    M1_CURRENT "m1_current" "M1 Current" Current [M1];
    /// Motor 1's speed error.
    M1_SPEED_ERROR "m1_speed_error" "M1 Speed Error" SpeedError [M1];
    /// Motor 1's position error.
    M1_POSITION_ERROR "m1_position_error" "M1 Position Error" PositionError [M1];
    /// What motor 2 was last told by this program.
    M2_SETPOINT "m2_setpoint" "M2 Setpoint" Setpoint [M2];
    /// Motor 2's output.
    M2_PWM "m2_pwm" "M2 PWM" Pwm [M2];
    /// Motor 2's speed.
    M2_VELOCITY "m2_velocity" "M2 Velocity" Velocity [M2];
    /// Motor 2's encoder.
    M2_POSITION "m2_position" "M2 Position" Position [M2];
    /// Motor 2's current.
    M2_CURRENT "m2_current" "M2 Current" Current [M2];
    /// Motor 2's speed error.
    M2_SPEED_ERROR "m2_speed_error" "M2 Speed Error" SpeedError [M2];
    /// Motor 2's position error.
    M2_POSITION_ERROR "m2_position_error" "M2 Position Error" PositionError [M2];
    /// First board temperature.
    TEMPERATURE_1 "temperature_1" "Temperature 1" Temperature [];
    /// Second board temperature.
    TEMPERATURE_2 "temperature_2" "Temperature 2" Temperature [];
    /// Main battery.
    MAIN_BATTERY "main_battery" "Main Battery" Battery [];
    /// Logic battery.
    LOGIC_BATTERY "logic_battery" "Logic Battery" Battery [] [0.0, 20.0];
}

impl Channel {
    /// A channel that a family describes.
    #[must_use]
    pub const fn of(description: &'static ChannelDescription) -> Self {
        Self(description)
    }

    /// Whether it is an input pin.
    #[must_use]
    pub fn is_pin(self) -> bool {
        self.role == Role::Pin
    }
}

impl Deref for Channel {
    type Target = ChannelDescription;

    fn deref(&self) -> &ChannelDescription {
        self.0
    }
}

impl fmt::Debug for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key)
    }
}

impl PartialEq for Channel {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for Channel {}

impl std::hash::Hash for Channel {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.key.hash(state);
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

/// A value of one channel with the host times of its own exchange.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The channel.
    pub channel: Channel,
    /// Its value in the channel's unit.
    pub value: f64,
    /// When the request was written.
    pub requested_at: Duration,
    /// When the reply was complete.
    pub replied_at: Duration,
}

impl Reading {
    /// When it was read: half way between its request and its reply.
    #[must_use]
    pub fn read_at(&self) -> Duration {
        self.requested_at + self.replied_at.saturating_sub(self.requested_at) / 2
    }
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
    /// Whether all that this unit can be asked has been read once by now, or was found not to answer.
    pub is_all_read: bool,
    /// By input pin; empty in a sweep that did not read them.
    pub signals: Vec<PinSignal>,
    readings: Vec<Reading>,
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
            is_all_read: false,
            signals: Vec::new(),
            readings: Vec::new(),
        }
    }

    /// Enters a reading with the host times of its request and its reply. What is no number was not read.
    pub fn set(&mut self, channel: Channel, value: f64, requested_at: Duration, replied_at: Duration) {
        self.remove(channel);
        if !value.is_nan() {
            self.readings.push(Reading { channel, value, requested_at, replied_at });
        }
        self.requested_at = self.requested_at.min(requested_at);
        self.replied_at = self.replied_at.max(replied_at);
    }

    /// Takes out a reading.
    pub fn remove(&mut self, channel: Channel) {
        self.readings.retain(|reading| reading.channel != channel);
    }

    /// All that was read.
    #[must_use]
    pub fn readings(&self) -> &[Reading] {
        &self.readings
    }

    fn reading(&self, channel: Channel) -> Option<&Reading> {
        self.readings.iter().find(|reading| reading.channel == channel)
    }

    /// The reading of a channel, if this sweep has one.
    #[must_use]
    pub fn get(&self, channel: Channel) -> Option<f64> {
        self.reading(channel).map(|reading| reading.value)
    }

    /// Host times of the request and of the complete reply that brought a channel's reading.
    #[must_use]
    pub fn span(&self, channel: Channel) -> Option<(Duration, Duration)> {
        self.reading(channel).map(|reading| (reading.requested_at, reading.replied_at))
    }

    /// When a channel was read: half way between its request and its reply.
    #[must_use]
    pub fn read_at(&self, channel: Channel) -> Option<Duration> {
        self.reading(channel).map(Reading::read_at)
    }

    /// Whether nothing was read at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.readings.is_empty()
    }
}

/// The newest value of every channel that was ever read.
#[derive(Clone, Debug, Default)]
pub struct Newest(Vec<(Channel, f64)>);

impl Newest {
    /// Takes over what the sample has read and keeps the rest.
    pub fn update(&mut self, sample: &Sample) {
        for reading in &sample.readings {
            match self.0.iter_mut().find(|(channel, _)| *channel == reading.channel) {
                Some((_, value)) => *value = reading.value,
                None => self.0.push((reading.channel, reading.value)),
            }
        }
    }

    /// A channel's newest value, if it was ever read.
    #[must_use]
    pub fn get(&self, channel: Channel) -> Option<f64> {
        self.0.iter().find(|(known, _)| *known == channel).map(|(_, value)| *value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_spans_its_exchanges_and_dates_each_reading_by_its_own() {
        let ms = Duration::from_millis;
        let mut sample = Sample::new(0x80);
        assert!(sample.is_empty());
        sample.set(Channel::M1_PWM, 12.5, ms(100), ms(102));
        sample.set(Channel::MAIN_BATTERY, 24.0, ms(102), ms(106));
        assert_eq!((sample.requested_at, sample.replied_at), (ms(100), ms(106)));
        assert_eq!(sample.read_at(Channel::MAIN_BATTERY), Some(ms(104)));
        assert_eq!(sample.span(Channel::M1_PWM), Some((ms(100), ms(102))));
        assert_eq!(sample.span(Channel::M2_PWM), None);
        assert_eq!(sample.get(Channel::M1_PWM), Some(12.5));
        assert_eq!(sample.get(Channel::M2_PWM), None);
        assert_eq!(sample.read_at(Channel::M2_PWM), None);
    }
}
