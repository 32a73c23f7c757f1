//! Where an input pin stands within its range.

use brushwork_mcp_wire::packet_serial::{Read, name};

/// Full scale of a signal's percent (MCP manual 1.9.12).
const FULL_SCALE: i64 = 32_767;

/// Where an input stands within its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinEnd {
    /// At its minimum or below.
    Lowest,
    /// In between.
    Between,
    /// At its maximum or above.
    Highest,
}

/// Where each pin stands, from a reply to command 147.
///
/// Assumed: percent reaches full scale exactly at the ends; with a curve that ends early it may say so a little before.
#[must_use]
pub fn pin_ends<const LAYOUT: u8>(values: &Read<LAYOUT>) -> Vec<PinEnd> {
    values.records().map(|record| PinEnd::of_percent(record.int(name::PERCENT))).collect()
}

impl PinEnd {
    /// From the raw percent of command 147.
    #[must_use]
    pub fn of_percent(percent_raw: i64) -> Self {
        match percent_raw {
            percent if percent <= -FULL_SCALE => Self::Lowest,
            percent if percent >= FULL_SCALE => Self::Highest,
            _ => Self::Between,
        }
    }
}
