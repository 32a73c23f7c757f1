//! The mode and the protocol of a Motion Mind, which its switches choose.

use brushwork_motion_mind_wire::{Mode, Protocol};
use serde::Serialize;

/// What the switches of a Motion Mind say, as far as they can be found out over the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MotionMindFacts {
    /// What moves its motor, from switches 2 to 4 at power-up.
    pub mode: Mode,
    /// Which protocol it speaks, switch 6.
    pub protocol: Protocol,
}
