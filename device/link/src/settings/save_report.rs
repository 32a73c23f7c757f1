//! What is known of a save to EEPROM, and how it is told.

use serde::Serialize;

use super::difference::Difference;
use super::image::SettingsImage;
use super::write_report::WriteReport;
use crate::failure::Failure;

/// What is known of a save.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SaveVerdict {
    /// The settings were loaded back from EEPROM and are the ones that were to be saved.
    Verified,
    /// The controller acknowledged the save, and did not answer when asked to load it back.
    Acknowledged,
    /// The controller acknowledged each setting as stored and it reads as stored; there is no way to read EEPROM itself.
    Stored,
    /// EEPROM holds something else.
    NotSaved,
    /// The controller did not acknowledge, or was not there afterwards.
    Unknown,
}

/// What became of a save.
#[derive(Clone, Debug, Serialize)]
pub struct SaveReport {
    /// What is known.
    pub verdict: SaveVerdict,
    /// Rows whose value in EEPROM is not the one that was to be saved: wanted, then found.
    pub differences: Vec<Difference>,
    /// What EEPROM holds, where that was read.
    pub eeprom: Option<SettingsImage>,
    /// Putting RAM back to what it was, when loading EEPROM had changed it.
    pub put_back: Option<WriteReport>,
    /// The last failure, where there was one.
    pub failure: Option<Failure>,
}

impl SaveReport {
    /// What became of the save, in a sentence or two.
    pub fn sentence(&self) -> String {
        let count = self.differences.len();
        match (self.verdict, &self.failure) {
            (SaveVerdict::Verified, _) => {
                "The settings are saved; they were read back from EEPROM.".to_owned()
            }
            (SaveVerdict::Acknowledged, _) => "The controller acknowledged the save. It did not answer \
                                               when asked to load its EEPROM, so the save is not proven; \
                                               that happens after good saves too."
                .to_owned(),
            (SaveVerdict::Stored, _) => "The settings are saved: each register was acknowledged as stored and read back. EEPROM itself is \
                                         read at a new start alone: load the settings from EEPROM to prove it."
                .to_owned(),
            (SaveVerdict::NotSaved, _) => {
                let settings = if count == 1 { "1 setting".to_owned() } else { format!("{count} settings") };
                if self.eeprom.is_none() {
                    return format!("The save did not take: {settings} read otherwise afterwards. Save again.");
                }
                format!(
                    "The save did not take: {settings} came back from EEPROM otherwise. {}",
                    self.put_back_sentence()
                )
            }
            (SaveVerdict::Unknown, Some(failure)) => {
                format!("It is not known whether the settings are saved. {failure} Save again to be sure.")
            }
            (SaveVerdict::Unknown, None) => {
                "It is not known whether the settings are saved. Save again to be sure.".to_owned()
            }
        }
    }

    fn put_back_sentence(&self) -> &'static str {
        match &self.put_back {
            Some(report) if report.is_complete() => {
                "The controller works on with the settings that were to be saved."
            }
            Some(_) => "Not all of them could be written to the controller again.",
            None => "The controller works on with what EEPROM held.",
        }
    }
}

/// A save of which nobody knows whether it was done.
#[must_use]
pub fn unknown(failure: Failure) -> SaveReport {
    SaveReport {
        verdict: SaveVerdict::Unknown,
        differences: Vec::new(),
        eeprom: None,
        put_back: None,
        failure: Some(failure),
    }
}
