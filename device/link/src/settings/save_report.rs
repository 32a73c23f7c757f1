//! What is known of a save to EEPROM, and how it is told.

use serde::Serialize;

use super::difference::{Difference, diff};
use super::image::SettingsImage;
use super::read::ReadReport;
use super::write_report::WriteReport;
use crate::failure::Failure;
use crate::messages::{SaveMessage, settings};
use brushwork_values::Message;

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
    pub fn sentence(&self) -> Message {
        let settings = settings(self.differences.len());
        match (self.verdict, &self.failure) {
            (SaveVerdict::Verified, _) => SaveMessage::Verified,
            (SaveVerdict::Acknowledged, _) => SaveMessage::Acknowledged,
            (SaveVerdict::Stored, _) => SaveMessage::Stored,
            (SaveVerdict::NotSaved, _) if self.eeprom.is_none() => SaveMessage::ReadOtherwise { settings },
            (SaveVerdict::NotSaved, _) => {
                SaveMessage::CameBackOtherwise { settings, now: self.put_back_sentence() }
            }
            (SaveVerdict::Unknown, Some(failure)) => SaveMessage::UnknownFor { failure: failure.message() },
            (SaveVerdict::Unknown, None) => SaveMessage::Unknown,
        }
        .into()
    }

    fn put_back_sentence(&self) -> Message {
        match &self.put_back {
            Some(report) if report.is_complete() => SaveMessage::PutBack,
            Some(_) => SaveMessage::NotPutBack,
            None => SaveMessage::AsInEeprom,
        }
        .into()
    }
}

/// A save that a controller acknowledged and whose EEPROM cannot be read: what reads otherwise than before was not stored.
#[must_use]
pub fn stored(before: &ReadReport, after: &ReadReport) -> SaveReport {
    let is_known = |difference: &Difference| difference.left.is_some() && difference.right.is_some();
    let differences: Vec<Difference> =
        diff(&before.table, &before.image, &after.image).into_iter().filter(is_known).collect();
    let is_stored = differences.is_empty();
    SaveReport {
        verdict: if is_stored { SaveVerdict::Stored } else { SaveVerdict::NotSaved },
        differences,
        eeprom: is_stored.then(|| before.image.clone()),
        put_back: None,
        failure: None,
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
