//! The table of one controller: its rows in screen order, found by key.

use std::collections::HashMap;

use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_mcp_wire::models::Family;

use super::image::SettingsImage;
use super::mcp;
use super::motion_mind::rows as motion_mind;
use super::row::{Group, Row};
use super::subject::Subject;
use super::value::SettingValue;

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
