//! What a board does that can be seen, with its time: a trace.

use brushwork_motorvator_wire::Frame;
use serde::Serialize;
use std::time::Duration;

/// Something that was seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Happening {
    /// Seconds since the program began.
    pub t: f64,
    /// What it was.
    #[serde(flatten)]
    pub what: What,
}

/// What was seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "event", rename_all = "lowercase")]
#[expect(missing_docs, reason = "the line above each shows its parts")]
pub enum What {
    /// DisplayChars or DisplayHex: the two characters, a control character as a space.
    Display { text: String },
    /// Beep with its two figures.
    Beep { pitch: u32, length: u32 },
    /// A motor's direction and its speed in percent; 0 where it stands.
    Motor { motor: u32, direction: char, speed: u32 },
    /// A stepper begins to make so many steps, or has made them: `state` is "moving" or "done", `position` counts from power-up.
    Stepper { stepper: u32, state: &'static str, direction: char, steps: u32, position: i64 },
    /// A servo's direction and angle.
    Servo { servo: u32, direction: char, angle: u32 },
    /// The time of a timer is over.
    Timer { timer: u32 },
    /// The statement Debug.
    Debug,
    /// Transmit: the frame that was sent, or that was lost since another was under way.
    Transmit { bytes: Frame, lost: bool },
    /// A frame has come.
    Receive { bytes: Frame },
    /// An on/off input has changed.
    Input { input: u32, on: bool },
    /// The program has ended.
    End { line: u32 },
    /// The program cannot go on.
    Fault { line: u32, message: String },
}

impl Happening {
    /// Something that is seen now.
    #[must_use]
    pub fn new(now: Duration, what: What) -> Self {
        Self { t: now.as_secs_f64(), what }
    }
}
