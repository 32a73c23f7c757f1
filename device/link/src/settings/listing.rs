//! The values of a controller as a list for people and for JSON: one entry per row, in screen order.

use serde::Serialize;

use super::image::SettingsImage;
use super::row::{Group, Row};
use super::table::SettingsTable;
use super::value::SettingValue;

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
    pub note: Option<String>,
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

#[cfg(test)]
mod tests {
    use super::super::Subject;
    use super::*;
    use brushwork_mcp_wire::models;
    use brushwork_mcp_wire::packet_serial::Generation;

    #[test]
    fn the_list_marks_what_is_changed_unknown_or_locked() {
        let model = models::lookup("mcp266").expect("it is in the list");
        let table = SettingsTable::new(Subject::new(model, Generation::Gen1));
        let mut image = table.default_image();
        image.set("motor1.velocity.p", SettingValue::Number(2.0));
        image.remove("motor2.velocity.qpps");
        let settings = list(&table, &image, false);
        let text = list_text(&settings);
        let line = |key: &str| {
            let start = format!("  {key} ");
            text.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("{key} in {text}"))
        };
        let words = |key: &str| line(key).split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(words("motor1.velocity.p"), "motor1.velocity.p * 2.000 default 1.000");
        assert_eq!(words("motor2.velocity.qpps"), "motor2.velocity.qpps - default 44000 counts/s");
        assert_eq!(words("unit.bridge_channels"), "unit.bridge_channels # no default no");
        assert!(
            words("motor1.encoder.pin")
                .ends_with("(counted from 0 in the pin list: DIN7/AN7/P7/ENC1A, assumed)")
        );
        assert!(text.starts_with("Unit settings\n  unit.address"), "{text}");
        let json = serde_json::to_value(&settings).expect("it is plain data");
        assert_eq!(json[0]["key"], "unit.address");
        assert_eq!(json[0]["value"], 128);
    }
}
