//! The parts of the settings, as Ion Studio groups them: the unit's own first, then one for each port, pin and
//! output.

use brushwork_link::settings::{Group, Row, SettingsTable};

/// A part of the settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// All rows of a group.
    Group(Group),
    /// The rows of one port, pin or output: its group, and its number there.
    One(Group, usize),
    /// What contradicts itself.
    Conflicts,
    /// The voltage clamp test.
    ClampTest,
    /// What people want, with the settings that do it.
    Recipes,
}

/// The ports whose lines are also those of a bus (MCP manual 1.9.4, 1.9.6): their numbers and what to call them.
const RS232: (usize, &str) = (2, "CAN/RS-232 UART0");
const TTL1: (usize, &str) = (3, "I2C/TTL UART1");

impl Default for Section {
    fn default() -> Self {
        Self::Group(Group::UNIT)
    }
}

impl Section {
    /// The section a row stands in.
    pub fn of(row: &Row) -> Self {
        match (&row.instance, row.group) {
            (Some(instance), Group::STREAMS | Group::PINS | Group::OUTPUTS) => {
                Self::One(row.group, instance.number)
            }
            (_, Group::BUSES) if row.key.starts_with("i2c.") => Self::One(Group::STREAMS, TTL1.0),
            (_, Group::BUSES) => Self::One(Group::STREAMS, RS232.0),
            _ => Self::Group(row.group),
        }
    }

    /// Whether it stands in the second list, that of pins.
    pub fn is_pin(self) -> bool {
        matches!(self, Self::One(..))
    }
}

/// The sections of a controller with their names: first those of the unit, then those of its pins.
pub fn sections(table: &SettingsTable) -> Vec<(Section, &str)> {
    let mut found: Vec<(Section, &str)> = Vec::new();
    for row in table.rows() {
        let section = Section::of(row);
        if found.iter().all(|(known, _)| *known != section) {
            let name = match (section, &row.instance) {
                (Section::One(Group::STREAMS, number), _) if number == RS232.0 => RS232.1,
                (Section::One(Group::STREAMS, number), _) if number == TTL1.0 => TTL1.1,
                (Section::One(..), Some(instance)) => instance.name.as_str(),
                _ => row.group.label(),
            };
            found.push((section, name));
        }
    }
    // Ion Studio lists ports, buses, inputs and outputs in this order.
    let place = |section: Section| match section {
        Section::Conflicts | Section::ClampTest | Section::Recipes => (0, Group::UNIT),
        Section::Group(group) => (0, group),
        Section::One(group @ Group::STREAMS, _) => (1, group),
        Section::One(group @ Group::PINS, _) => (3, group),
        Section::One(group, _) => (4, group),
    };
    found.sort_by_key(|(section, _)| place(*section));
    found
}
