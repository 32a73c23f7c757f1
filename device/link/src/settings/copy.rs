//! One motor's settings for the other one.

use super::image::SettingsImage;
use super::row::Row;
use super::table::SettingsTable;
use crate::messages::PlanMessage;
use brushwork_values::Message;

/// The settings of one motor as those of the other.
#[derive(Clone, Debug, PartialEq)]
pub struct CopiedMotor {
    /// The values that the other motor does not have yet.
    pub wanted: SettingsImage,
    /// What each motor keeps for itself, a sentence each.
    pub left_out: Vec<Message>,
}

/// What each motor has of its own: which input is its encoder.
const OWN: [&str; 1] = ["motor{n}.encoder.pin"];

/// The settings of motor `from` (1 or 2) as wanted ones of the other, as far as `image` has them and `table` lets
/// them be written.
pub fn copy_motor(table: &SettingsTable, image: &SettingsImage, from: usize, simulated: bool) -> CopiedMotor {
    let to = 3 - from;
    let mut copied = CopiedMotor { wanted: SettingsImage::default(), left_out: Vec::new() };
    let of_motor = |row: &&Row| row.key.starts_with(&format!("motor{from}."));
    for row in table.rows().iter().filter(of_motor) {
        let key = row.pattern.replace("{n}", &to.to_string());
        let (Some(there), Some(value)) = (table.row(&key), image.get(&row.key)) else { continue };
        if image.get(&key) == Some(value) {
            continue;
        }
        if OWN.contains(&row.pattern) {
            copied.left_out.push(PlanMessage::OwnInput { title: there.title() }.into());
        } else if let Some(reason) = there.locked(simulated) {
            copied.left_out.push(PlanMessage::CannotBeCopied { title: there.title(), reason }.into());
        } else if let Err(why) = there.check(value) {
            copied.left_out.push(PlanMessage::NotCopied { title: there.title(), why }.into());
        } else {
            copied.wanted.set(&key, value);
        }
    }
    copied
}
