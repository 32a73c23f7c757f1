//! The values of a controller as a list for people and for JSON: one entry per row, in screen order.

use serde::Serialize;

use super::image::SettingsImage;
use super::row::{Group, Row};
use super::table::SettingsTable;
use super::value::SettingValue;
use brushwork_values::Message;

/// One setting with its value.
#[derive(Clone, Debug, Serialize)]
pub struct ListedSetting {
    /// The key.
    pub key: String,
    /// Full name: "Motor 1: velocity P".
    pub title: String,
    /// The part of the settings it belongs to.
    pub group: Group,
    /// The value; `None` when it is not known.
    pub value: Option<SettingValue>,
    /// The unit's symbol; empty for bare numbers.
    pub unit: &'static str,
    /// The value with its unit, or "-".
    pub text: String,
    /// The default with its unit.
    pub default: String,
    /// Whether the value is the default; `None` when it is not known.
    pub is_default: Option<bool>,
    /// Why it cannot be written on this controller; empty when it can.
    pub locked: &'static str,
    /// What the value means besides its text: the pin behind an encoder input number.
    pub note: Option<Message>,
}

/// Every row of the table with its value in `image`.
pub fn list(table: &SettingsTable, image: &SettingsImage, simulated: bool) -> Vec<ListedSetting> {
    table.rows().iter().map(|row| listed(table, row, image.get(&row.key), simulated)).collect()
}

/// The list as lines of key, value and default, each group under its heading. A "*" marks what is not the
/// default, a "#" what cannot be written on this controller.
pub fn list_text(settings: &[ListedSetting]) -> String {
    let widest = |text: fn(&ListedSetting) -> &str| {
        settings.iter().map(|setting| text(setting).chars().count()).max().unwrap_or(0)
    };
    let (keys, texts) = (widest(|setting| &setting.key), widest(|setting| &setting.text));
    let mut lines = Vec::new();
    let mut group = None;
    for setting in settings {
        if group != Some(setting.group) {
            group = Some(setting.group);
            lines.push(format!("\n{}", setting.group.label()));
        }
        lines.push(line(setting, keys, texts));
    }
    lines.join("\n").trim_start().to_owned()
}

fn line(setting: &ListedSetting, keys: usize, texts: usize) -> String {
    let changed = if setting.is_default == Some(false) { "*" } else { " " };
    let locked = if setting.locked.is_empty() { " " } else { "#" };
    let note = setting.note.as_ref().map_or_else(String::new, |note| format!("  ({note})"));
    let (key, text, default) = (&setting.key, &setting.text, &setting.default);
    format!("  {key:<keys$} {changed}{locked} {text:<texts$}  default {default}{note}").trim_end().to_owned()
}

fn listed(table: &SettingsTable, row: &Row, value: Option<SettingValue>, simulated: bool) -> ListedSetting {
    ListedSetting {
        key: row.key.clone(),
        title: row.title(),
        group: row.group,
        value,
        unit: row.unit.symbol(),
        text: value.map_or_else(|| "-".to_owned(), |value| row.format(value)),
        default: row.format(row.default),
        is_default: value.map(|value| value == row.default),
        locked: row.locked(simulated).unwrap_or(""),
        note: value.and_then(|value| table.note(row, value)),
    }
}
