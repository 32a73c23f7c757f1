//! The settings of the MCP and RoboClaw controllers: the one table that everything else reads.
//!
//! Each file holds the lines of one part of it, in screen order. A line names the commands and fields that
//! carry the setting by their names in the protocol table, so the order of fields on the wire never matters
//! here. Lines that differ between firmware generations have several forms; a setting without a public wire
//! form has a reason instead.

mod motor;
mod pins;
mod ports;
mod roboclaw;
mod scales;
mod unit;

use crate::settings::template::Template;

/// Every line of the table, in screen order.
pub(crate) fn templates() -> impl Iterator<Item = &'static Template> {
    [unit::ROWS, motor::ROWS, pins::ROWS, ports::ROWS, roboclaw::ROWS].into_iter().flatten()
}

/// Commands that set something in the controller and carry no setting of this table, and why.
pub(crate) static NOT_SETTINGS: &[(u8, &str)] = &[
    (2, "old form of 57, minimum only"),
    (3, "old form of 57, maximum only"),
    (26, "old form of 58, minimum only"),
    (27, "old form of 58, maximum only"),
    (96, "a label of the owner's, as text"),
    (102, "the level of an output, not a setting of it"),
    (103, "the level of an output, not a setting of it"),
    (200, "acts at once and keeps nothing"),
    (253, "memory for the user's script, not for settings"),
];
