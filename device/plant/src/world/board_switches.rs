//! The switches on the board of a Motion Mind: what they choose holds from the next power-up on (Motion Mind manual 3.5).

use serde::{Deserialize, Serialize};

/// How the switches 2 to 7 of SW1 stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoardSwitches {
    /// Switches 2 to 4, as the number of the mode that they choose, 0 to 7.
    pub mode: u8,
    /// Switch 5: 19,200 baud, else 9,600.
    pub is_fast: bool,
    /// Switch 6: lines of text, else binary.
    pub is_text: bool,
    /// Switch 7: one count a line of the encoder, else four.
    pub counts_lines: bool,
}
