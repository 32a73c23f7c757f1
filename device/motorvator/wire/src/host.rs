//! What the frames mean that a program exchanges with the host library, `assets/mecc/host.mecc`: orders to it and its answers.
//!
//! The board itself has no such orders; what stands here is no more than what the library makes of the eight bytes.

use super::{Frame, LINE_END, line_of_host, parse_line_of_board};
use std::fmt;

/// The library, as a program of the board.
pub const LIBRARY: &str = include_str!("../host.mecc");
/// Its version.
pub const VERSION: u8 = 2;
/// Motor outputs.
pub const MOTORS: u8 = 4;
/// Steppers.
pub const STEPPERS: u8 = 2;
/// Analog inputs.
pub const ANALOG_INPUTS: u8 = 6;
/// Waits between steps and hold current of a stepper when the library begins.
pub const STEPPER_DEFAULT: StepperConfig = StepperConfig { least: 10, most: 20, hold_percent: 0 };

/// What answers and unasked frames begin with.
const ANSWER: u8 = b'R';
/// The order of a frame that comes unasked.
const BEACON: u8 = b'B';
/// What is added to a speed that is backward.
const BACKWARD: u8 = 128;

/// Bits of the flags.
pub mod flags {
    /// Stepper 1 moves.
    pub const STEPPER_1: u8 = 1;
    /// Stepper 2 moves.
    pub const STEPPER_2: u8 = 2;
    /// The order was not known.
    pub const UNKNOWN_ORDER: u8 = 64;
    /// No order came for 250 ms, and the library has stopped what moved.
    pub const DEAD_MAN: u8 = 128;
}

/// Which way a motor or a stepper turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// "F".
    Forward,
    /// "B".
    Backward,
}

impl Direction {
    /// Its letter.
    #[must_use]
    pub fn letter(self) -> u8 {
        match self {
            Self::Forward => b'F',
            Self::Backward => b'B',
        }
    }

    fn of(letter: u8) -> Option<Self> {
        [Self::Forward, Self::Backward].into_iter().find(|direction| direction.letter() == letter)
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Forward => "forward",
            Self::Backward => "backward",
        })
    }
}

/// What ConfigStepper sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepperConfig {
    /// MinWait: between steps at the highest speed.
    pub least: u8,
    /// MaxWait: between steps at the lowest speed.
    pub most: u8,
    /// HoldCurrent.
    pub hold_percent: u8,
}

impl StepperConfig {
    /// The statement of MeccCode that sets it.
    #[must_use]
    pub fn statement(&self, stepper: u8) -> String {
        format!("ConfigStepper {stepper}, {}, {}, {}", self.least, self.most, self.hold_percent)
    }
}

/// What a host asks of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HostOrder {
    /// Is it there, and which version?
    Ping,
    /// What do the motors do?
    State,
    /// Turns a motor, 1 to 4, with 0 to 100 %.
    Motor {
        /// Which.
        motor: u8,
        /// Which way.
        direction: Direction,
        /// How fast.
        percent: u8,
    },
    /// Moves a stepper.
    Steps {
        /// 1 or 2.
        stepper: u8,
        /// Which way.
        direction: Direction,
        /// How far.
        steps: u16,
    },
    /// Turns a servo.
    Servo {
        /// 1 or 2.
        servo: u8,
        /// From the middle.
        direction: Direction,
        /// Degrees.
        angle: u8,
    },
    /// Sets how a stepper moves.
    Configure(u8, StepperConfig),
    /// How is a stepper set?
    Configuration(u8),
    /// Shows two characters, or tells what is shown where the first is 0.
    Display([u8; 2]),
    /// The analog inputs from this one on.
    Analog(u8),
    /// Stops all motors and steppers.
    Stop,
}

impl HostOrder {
    /// Its letter.
    #[must_use]
    pub fn letter(&self) -> u8 {
        match self {
            Self::Ping => b'P',
            Self::State => b'S',
            Self::Motor { .. } => b'M',
            Self::Steps { .. } => b'T',
            Self::Servo { .. } => b'V',
            Self::Configure(..) => b'C',
            Self::Configuration(_) => b'Q',
            Self::Display(_) => b'D',
            Self::Analog(_) => b'A',
            Self::Stop => b'X',
        }
    }

    /// Whether it can set something in motion.
    #[must_use]
    pub fn may_move(&self) -> bool {
        matches!(self, Self::Motor { .. } | Self::Steps { .. } | Self::Servo { .. })
    }

    /// The bytes of its frame; zeros at the end are left out.
    #[must_use]
    pub fn bytes(&self, number: u8) -> Vec<u8> {
        let values = match *self {
            Self::Ping | Self::State | Self::Stop => Vec::new(),
            Self::Motor { motor, direction, percent } => vec![motor, direction.letter(), percent],
            Self::Steps { stepper, direction, steps } => {
                let [low, high] = steps.to_le_bytes();
                vec![stepper, direction.letter(), low, high]
            }
            Self::Servo { servo, direction, angle } => vec![servo, direction.letter(), angle],
            Self::Configure(stepper, StepperConfig { least, most, hold_percent }) => {
                vec![stepper, least, most, hold_percent]
            }
            Self::Configuration(stepper) => vec![stepper],
            Self::Display(characters) => characters.to_vec(),
            Self::Analog(first) => vec![first],
        };
        [vec![self.letter(), number], values].concat()
    }

    /// Its line, the end included.
    #[must_use]
    pub fn line(&self, number: u8) -> Vec<u8> {
        line_of_host(&self.bytes(number))
    }

    /// The order that a frame to the library is, with its number; `None` where it is none.
    #[must_use]
    pub fn parse(frame: &Frame) -> Option<(Self, u8)> {
        let [letter, number, first, second, third, fourth, ..] = *frame;
        let order = match letter {
            b'P' => Self::Ping,
            b'S' => Self::State,
            b'M' => Self::Motor { motor: first, direction: Direction::of(second)?, percent: third },
            b'T' => Self::Steps {
                stepper: first,
                direction: Direction::of(second)?,
                steps: u16::from_le_bytes([third, fourth]),
            },
            b'V' => Self::Servo { servo: first, direction: Direction::of(second)?, angle: third },
            b'C' => {
                Self::Configure(first, StepperConfig { least: second, most: third, hold_percent: fourth })
            }
            b'Q' => Self::Configuration(first),
            b'D' => Self::Display([first, second]),
            b'A' => Self::Analog(first),
            b'X' => Self::Stop,
            _ => return None,
        };
        Some((order, number))
    }
}

impl fmt::Display for HostOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ping => f.write_str("ping"),
            Self::State => f.write_str("tell the motors' state"),
            Self::Motor { motor, direction, percent } => write!(f, "motor {motor} {direction} {percent} %"),
            Self::Steps { stepper, direction, steps } => {
                let unit = if *steps == 1 { "step" } else { "steps" };
                write!(f, "stepper {stepper} {direction} {steps} {unit}")
            }
            Self::Servo { servo, direction, angle } => write!(f, "servo {servo} {direction} {angle}°"),
            Self::Configure(stepper, config) => f.write_str(&config.statement(*stepper)),
            Self::Configuration(stepper) => write!(f, "tell how stepper {stepper} is configured"),
            Self::Display([0, _]) => f.write_str("tell display and inputs"),
            Self::Display(characters) => write!(f, "show \"{}\"", characters_text(*characters)),
            Self::Analog(first) => write!(f, "tell the analog inputs from {first} on"),
            Self::Stop => f.write_str("stop all motors and steppers"),
        }
    }
}

/// The two characters of the display as they are seen.
#[must_use]
pub fn characters_text(characters: [u8; 2]) -> String {
    let letter = |byte: u8| if byte.is_ascii_graphic() { char::from(byte) } else { ' ' };
    characters.into_iter().map(letter).collect()
}

/// What the library sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostAnswer {
    /// The letter of the order.
    pub order: u8,
    /// Its number.
    pub number: u8,
    /// What it told.
    pub values: [u8; 4],
    /// [`flags`].
    pub flags: u8,
}

impl HostAnswer {
    /// The answer that a line of a board is, without its end; `None` where it is none.
    #[must_use]
    pub fn parse(line: &[u8]) -> Option<Self> {
        let frame: Frame = parse_line_of_board(line)?.try_into().ok()?;
        Self::of_frame(&frame)
    }

    /// The answer that a frame of a board is.
    #[must_use]
    pub fn of_frame(frame: &Frame) -> Option<Self> {
        let [ANSWER, order, number, first, second, third, fourth, told] = *frame else { return None };
        let known = [b'P', b'S', b'M', b'T', b'V', b'C', b'Q', b'D', b'A', b'X', BEACON];
        let is_answer = known.contains(&order) || told & flags::UNKNOWN_ORDER != 0;
        is_answer.then_some(Self { order, number, values: [first, second, third, fourth], flags: told })
    }

    /// Whether it came unasked.
    #[must_use]
    pub fn is_beacon(&self) -> bool {
        self.order == BEACON
    }

    /// The version of the library, where it tells that.
    #[must_use]
    pub fn version(&self) -> Option<u8> {
        [BEACON, b'P'].contains(&self.order).then_some(self.values[0])
    }

    /// The speeds of the four motors in percent, with a minus for backward, where it tells them.
    #[must_use]
    pub fn speeds(&self) -> Option<[i16; MOTORS as usize]> {
        let tells = [b'S', b'M', b'T', b'V', b'X'].contains(&self.order);
        let signed = |value: u8| match value.checked_sub(BACKWARD) {
            Some(backward) => -i16::from(backward),
            None => i16::from(value),
        };
        tells.then(|| self.values.map(signed))
    }

    /// A stepper and how it is set, where it tells that.
    #[must_use]
    pub fn stepper(&self) -> Option<(u8, StepperConfig)> {
        let [stepper, least, most, hold_percent] = self.values;
        [b'C', b'Q'].contains(&self.order).then_some((stepper, StepperConfig { least, most, hold_percent }))
    }

    /// The characters that are shown and the inputs that have changed, where it tells them.
    #[must_use]
    pub fn display(&self) -> Option<([u8; 2], u8)> {
        let [left, right, changed, _] = self.values;
        (self.order == b'D').then_some(([left, right], changed))
    }
}

impl fmt::Display for HostAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = char::from(self.order);
        if let Some(version) = self.version() {
            write!(f, "host library, version {version}")?;
            if !self.is_beacon() {
                write!(f, ", answer {}", self.number)?;
            }
        } else if self.flags & flags::UNKNOWN_ORDER != 0 {
            write!(f, "answer {}: order {letter} is not known", self.number)?;
        } else {
            write!(f, "answer {} to {letter}: ", self.number)?;
            if let Some(speeds) = self.speeds() {
                let each: Vec<String> = speeds.iter().map(i16::to_string).collect();
                write!(f, "motors {} %", each.join(", "))?;
            } else if let Some((stepper, config)) = self.stepper() {
                f.write_str(&config.statement(stepper))?;
            } else if let Some((characters, changed)) = self.display() {
                write!(f, "display \"{}\", inputs changed {changed:04b}", characters_text(characters))?;
            } else {
                let each: Vec<String> = self.values.iter().map(u8::to_string).collect();
                write!(f, "analog {}", each.join(", "))?;
            }
        }
        for (bit, words) in [
            (flags::STEPPER_1, "stepper 1 moves"),
            (flags::STEPPER_2, "stepper 2 moves"),
            (flags::DEAD_MAN, "stopped by the dead-man"),
        ] {
            if self.flags & bit != 0 {
                write!(f, ", {words}")?;
            }
        }
        Ok(())
    }
}

/// The bytes of a stop that may go out whatever was written before. A line that was cut short is ended first, by an end that is not
/// alone on its line: to a controller of another kind that would be the order to do its last line once more.
#[must_use]
pub fn stop_bytes() -> Vec<u8> {
    let mut bytes = super::PREFIX.as_bytes().to_vec();
    bytes.push(LINE_END);
    bytes.extend(HostOrder::Stop.line(0));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Order;
    use proptest::prelude::*;

    #[test]
    fn orders_are_the_bytes_that_the_library_describes() {
        let motor = HostOrder::Motor { motor: 3, direction: Direction::Backward, percent: 60 };
        assert_eq!(motor.line(7), b"I077007003066060\r");
        let steps = HostOrder::Steps { stepper: 2, direction: Direction::Forward, steps: 10_000 };
        assert_eq!(steps.line(1), b"I084001002070016039\r");
        let config = StepperConfig { least: 2, most: 4, hold_percent: 50 };
        assert_eq!(HostOrder::Configure(1, config).line(9), b"I067009001002004050\r");
        assert_eq!(config.statement(1), "ConfigStepper 1, 2, 4, 50");
        assert_eq!(stop_bytes(), b"073\rI088000\r");
        assert_eq!(HostOrder::Ping.line(255), b"I080255\r");
        assert_eq!(motor.to_string(), "motor 3 backward 60 %");
    }

    #[test]
    fn answers_tell_what_their_order_asked_for() {
        let parse = |line: &[u8]| HostAnswer::parse(line).unwrap();
        let state = parse(b"073082083005060000228000130");
        assert_eq!((state.number, state.speeds()), (5, Some([60, 0, -100, 0])));
        assert_eq!(
            state.to_string(),
            "answer 5 to S: motors 60, 0, -100, 0 %, stepper 2 moves, stopped by the dead-man"
        );
        let beacon = parse(b"073082066000002000000000000");
        assert!(beacon.is_beacon() && beacon.version() == Some(VERSION));
        let display = parse(b"073082068001072050005000000");
        assert_eq!(display.display(), Some((*b"H2", 5)));
        assert_eq!(parse(b"073082063001000000000000064").to_string(), "answer 1: order ? is not known");
        for line in [&b"073084088049050051052053054"[..], b"073082083005", b"", b"I082083005060000228000130"]
        {
            assert_eq!(HostAnswer::parse(line), None);
        }
    }

    #[test]
    fn the_version_is_that_of_the_library() {
        assert!(LIBRARY.contains(&format!("value1 = {VERSION}\n")));
        assert!(LIBRARY.contains(&format!("Declare Byte right = \"{VERSION}\"")));
    }

    proptest! {
        #[test]
        fn orders_come_back(kind in 0usize..10, first in 1u8..=6, back: bool, value: u16, number: u8) {
            let direction = if back { Direction::Backward } else { Direction::Forward };
            let [low, high] = value.to_le_bytes();
            let config = StepperConfig { least: low, most: high, hold_percent: first };
            let order = [
                HostOrder::Ping,
                HostOrder::State,
                HostOrder::Motor { motor: first, direction, percent: low },
                HostOrder::Steps { stepper: first, direction, steps: value },
                HostOrder::Servo { servo: first, direction, angle: low },
                HostOrder::Configure(first, config),
                HostOrder::Configuration(first),
                HostOrder::Display([first, low]),
                HostOrder::Analog(first),
                HostOrder::Stop,
            ][kind];
            let line = order.line(number);
            let Some(Order::Data(frame)) = Order::of_line(&line[..line.len() - 1]) else { panic!() };
            prop_assert_eq!(HostOrder::parse(&frame), Some((order, number)));
        }

        #[test]
        fn any_frame_is_answered(frame: [u8; 8]) {
            let _ = HostOrder::parse(&frame).map(|(order, _)| order.to_string());
            let _ = HostAnswer::of_frame(&frame).map(|answer| answer.to_string());
        }
    }
}
