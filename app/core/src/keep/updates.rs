//! Firmware updates that were begun: kept until a controller answers at that place again, so that a silent line is not taken for a
//! wrong baud rate.

use brushwork_link::Message;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::store::{KeepError, Record, Store};
use crate::messages::UpdateMessage;

const FOLDER: &str = "updates";
/// Longer names of files are cut; the text inside tells two that agree so far apart.
const LONGEST_NAME: usize = 80;

/// An update that was begun.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OpenUpdate {
    /// Where the controller was connected, as typed.
    pub place: String,
    /// The key of its model.
    pub model: String,
    /// The text of the version that it ran.
    pub before: String,
    /// The image that was sent.
    pub file: PathBuf,
    /// The backup of its settings.
    pub backup: String,
}

impl OpenUpdate {
    /// What to know when nobody answers at its place.
    #[must_use]
    pub fn sentence(&self) -> Message {
        UpdateMessage::Begun {
            unit: self.before.clone(),
            place: self.place.clone(),
            file: self.file.display().to_string(),
            model: self.model.clone(),
            backup: self.backup.clone(),
        }
        .into()
    }
}

impl Store {
    /// Keeps it until it is closed.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn open_update(&self, update: &OpenUpdate) -> Result<(), KeepError> {
        let path = self.update_path(&update.place)?;
        self.put(Record::Update, &path, &serde_json::to_string_pretty(update).unwrap_or_default())
    }

    /// The update that was begun at a place and did not end, if there is one.
    ///
    /// # Errors
    /// The note is damaged or cannot be read.
    pub fn update_at(&self, place: &str) -> Result<Option<OpenUpdate>, KeepError> {
        // A user without a home has kept nothing.
        let Ok(path) = self.update_path(place) else { return Ok(None) };
        let update: Option<OpenUpdate> = self.json(Record::Update, &path)?;
        Ok(update.filter(|update| update.place == place))
    }

    /// What is known of a place at which nobody answers, in a sentence: an update that was begun there and did not end.
    #[must_use]
    pub fn waiting_at(&self, place: &str) -> Option<Message> {
        match self.update_at(place) {
            Ok(update) => update.map(|update| update.sentence()),
            Err(fault) => Some(Message::error(fault)),
        }
    }

    /// A controller answers there again.
    pub fn close_update(&self, place: &str) {
        let is_of_another = matches!(self.update_at(place), Ok(None));
        if let Ok(path) = self.update_path(place)
            && !is_of_another
        {
            // What stays is told once more when nobody answers, which is true then too.
            let _ = self.take_away(Record::Update, &path);
        }
    }

    fn update_path(&self, place: &str) -> Result<PathBuf, KeepError> {
        let safe = |letter: char| if letter.is_ascii_alphanumeric() || letter == '.' { letter } else { '-' };
        let name: String = place.chars().map(safe).take(LONGEST_NAME).collect();
        self.path(&[FOLDER, &format!("update-{name}.json")])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_update_is_known_at_its_place_until_it_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path());
        let update = OpenUpdate {
            place: "/dev/ttyACM0".to_owned(),
            model: "mcp266".to_owned(),
            before: "MCP266 2x60A v1.0.0".to_owned(),
            file: PathBuf::from("new.bin"),
            backup: "000001".to_owned(),
        };
        store.open_update(&update).unwrap();
        assert_eq!(store.update_at("/dev/ttyACM0").unwrap(), Some(update.clone()));
        assert_eq!(store.update_at("/dev-ttyACM0").unwrap(), None, "the same file, another place");
        let sentence = update.sentence().to_string();
        assert!(sentence.contains("--connect /dev/ttyACM0 --resume --model mcp266"), "{sentence}");
        store.close_update("/dev-ttyACM0");
        assert!(store.update_at("/dev/ttyACM0").unwrap().is_some());
        store.close_update("/dev/ttyACM0");
        assert_eq!(store.update_at("/dev/ttyACM0").unwrap(), None);
    }
}
