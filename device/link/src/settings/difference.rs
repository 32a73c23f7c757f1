//! Where two images of the same settings differ.

use serde::Serialize;

use super::image::SettingsImage;
use super::row::Row;
use super::table::SettingsTable;
use super::value::SettingValue;

/// One setting that two images do not agree on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The row's key.
    pub key: String,
    /// The value in the first image, if it has one.
    pub left: Option<SettingValue>,
    /// The value in the second image, if it has one.
    pub right: Option<SettingValue>,
}

impl Difference {
    /// "Main battery maximum: 34.0 V -> 24.0 V", with "-" for a value that is not there.
    pub fn describe(&self, row: &Row) -> String {
        let [left, right] = row.format_both([self.left, self.right]);
        format!("{}: {left} -> {right}", row.title())
    }
}

/// Every setting of the table that differs, in screen order. Keys the table does not have are left out; so
/// are keys that neither image has.
pub fn diff(table: &SettingsTable, left: &SettingsImage, right: &SettingsImage) -> Vec<Difference> {
    let difference = |row: &Row| {
        let (left, right) = (left.get(&row.key), right.get(&row.key));
        (left != right).then(|| Difference { key: row.key.clone(), left, right })
    };
    table.rows().iter().filter_map(difference).collect()
}

/// The changes that turn `from` into `to`: what `to` has and `from` has not, or has otherwise.
pub fn changes(table: &SettingsTable, from: &SettingsImage, to: &SettingsImage) -> SettingsImage {
    let wanted = diff(table, from, to).into_iter();
    wanted.filter_map(|difference| difference.right.map(|value| (difference.key, value))).collect()
}
