//! The table of one controller: its rows in screen order, found by key.

use std::collections::HashMap;

use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_mcp_wire::models::{Family, Model};

use super::image::SettingsImage;
use super::mcp;
use super::motion_mind;
use super::row::{Group, Row};
use super::value::SettingValue;
use crate::unit::FirmwareGeneration;

/// What the table has to know about the controller in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subject {
    /// The model: ratings, pin names.
    pub model: &'static Model,
    /// The firmware generation: which settings there are, and in which form.
    pub generation: FirmwareGeneration,
    /// Number of input pins, as command 144 counts them.
    pub pins: usize,
    /// Number of serial streams, as command 146 counts them.
    pub streams: usize,
    /// Number of digital outputs, as command 138 counts them.
    pub douts: usize,
}

impl Subject {
    /// A controller with the pins, streams and outputs its model is listed with.
    pub fn new(model: &'static Model, generation: impl Into<FirmwareGeneration>) -> Self {
        Self {
            model,
            generation: generation.into(),
            pins: model.pins.len(),
            streams: model.streams,
            douts: model.douts,
        }
    }

    /// The label of pin `index` (from 0), or "Pin 7" when the unit has more pins than its model is listed
    /// with.
    pub fn pin_name(&self, index: usize) -> String {
        self.model.pins.get(index).map_or_else(|| format!("Pin {}", index + 1), |pin| pin.label.to_owned())
    }

    /// The signal number of phase A of a motor's own encoder; on a RoboClaw, encoder mode 0.
    pub(super) fn encoder_pin(&self, motor: usize) -> i64 {
        let own = |pin: &brushwork_mcp_wire::models::Pin| {
            pin.encoder_channel()
                .is_some_and(|(number, phase)| usize::from(number) == motor + 1 && phase == 'A')
        };
        match self.model.family {
            Family::RoboClaw | Family::MotionMind => 0,
            Family::Mcp => {
                let index = self.model.pins.iter().position(own).and_then(|index| i64::try_from(index).ok());
                index.unwrap_or(ENCODER_PIN_NONE)
            }
        }
    }
}

/// The settings of one controller.
#[derive(Clone, Debug)]
pub struct SettingsTable {
    subject: Subject,
    rows: Vec<Row>,
    by_key: HashMap<String, usize>,
}

impl SettingsTable {
    /// The table of a controller.
    pub fn new(subject: Subject) -> Self {
        let rows: Vec<Row> = match subject.model.family {
            Family::MotionMind => motion_mind::rows(),
            Family::Mcp | Family::RoboClaw => {
                mcp::templates().flat_map(|template| template.expand(&subject)).collect()
            }
        };
        let by_key = rows.iter().enumerate().map(|(index, row)| (row.key.clone(), index)).collect();
        Self { subject, rows, by_key }
    }

    /// Whether it is the table of a Motion Mind.
    pub fn is_motion_mind(&self) -> bool {
        self.subject.model.family == Family::MotionMind
    }

    /// The controller the table was made for.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Every row, in screen order.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The row with that key.
    pub fn row(&self, key: &str) -> Option<&Row> {
        self.by_key.get(key).map(|index| &self.rows[*index])
    }

    /// The rows of one group, in screen order.
    pub fn group(&self, group: Group) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.group == group)
    }

    /// What a value means besides its text: the pin behind an encoder input number, as far as we assume it.
    pub fn note(&self, row: &Row, value: SettingValue) -> Option<String> {
        let number = match value {
            SettingValue::Int(number) if row.pattern == "motor{n}.encoder.pin" => number,
            _ => return None,
        };
        if number == ENCODER_PIN_NONE {
            return Some("none, assumed".to_owned());
        }
        let index = usize::try_from(number).ok().filter(|index| *index < self.subject.pins)?;
        Some(format!("counted from 0 in the pin list: {}, assumed", self.subject.pin_name(index)))
    }

    /// Every row at its default.
    pub fn default_image(&self) -> SettingsImage {
        self.rows.iter().map(|row| (row.key.clone(), row.default)).collect()
    }
}
