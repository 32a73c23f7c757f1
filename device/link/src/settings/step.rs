//! One command of a plan and when it is sent, how a plan is to be written, and why a change is refused.

use crate::family::FamilyRef;
use crate::transport::Stream;
use brushwork_values::Message;
use serde::Serialize;

/// What writing has to know besides the values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// The controller's stream that this program is connected through, where known. Its settings are written
    /// last.
    pub own_stream: Option<Stream>,
    /// Whether the controller is simulated, so that settings without a public wire form can be set.
    pub simulated: bool,
    /// Whether the values were read from such a unit once, so that one that nobody may choose there, out of range or without a
    /// name, is written as it was, with a warning.
    pub as_read: bool,
}

/// One command of a plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// Whose command it is.
    #[serde(skip)]
    pub family: FamilyRef,
    /// Command number.
    pub command: u8,
    /// Raw arguments by field name, in wire order.
    pub arguments: Vec<(&'static str, i64)>,
    /// The rows that it changes.
    pub keys: Vec<String>,
    /// When it is sent.
    pub stage: Stage,
}

/// The order of writing: limits before what they limit, inputs before the levels that let them act, and last
/// what changes the way to the controller itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Voltage, current and error limits.
    Limits,
    /// Gains, travel, accelerations, encoder pins, PWM mode, mixing.
    Motors,
    /// Digital outputs.
    Outputs,
    /// Input pins.
    Pins,
    /// Serial ports other than our own, CAN node.
    Ports,
    /// Which inputs may act.
    Priorities,
    /// What starts by itself: script autorun, E-Stop reset.
    Autonomy,
    /// The unit's address.
    Address,
    /// The port that this program is connected through.
    OwnPort,
}

/// Why a change is not planned.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refusal {
    /// The row.
    pub key: String,
    /// The reason as a sentence.
    pub sentence: Message,
}
