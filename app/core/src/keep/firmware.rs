//! What firmware is known to answer, kept by what it calls itself: models and versions differ in their commands, boards of one version do not.

use std::path::PathBuf;

use brushwork_link::capability::{CapabilityMap, KeepsCapabilities};
use serde::{Deserialize, Serialize};

use super::store::{Record, Store};

const CAPABILITIES: &str = "capabilities";
/// Longer names of files are cut; the text inside tells two that agree so far apart.
const LONGEST_NAME: usize = 80;

#[derive(Serialize, Deserialize)]
struct Kept {
    firmware: String,
    answers: CapabilityMap,
}

impl KeepsCapabilities for Store {
    fn load(&self, firmware: &str) -> CapabilityMap {
        let path = self.firmware_path(firmware);
        // What a damaged file said is learned again, which takes a second.
        let kept: Option<Kept> = path.and_then(|path| self.json(Record::Capabilities, &path).ok()?);
        // Two texts may share a name of a file.
        kept.filter(|kept| kept.firmware == firmware).map(|kept| kept.answers).unwrap_or_default()
    }

    fn keep(&self, firmware: &str, map: &CapabilityMap) {
        let kept = Kept { firmware: firmware.to_owned(), answers: map.clone() };
        let Some((path, text)) = self.firmware_path(firmware).zip(serde_json::to_string_pretty(&kept).ok())
        else {
            return;
        };
        // What is not kept is learned again, which takes a second.
        drop(self.put(Record::Capabilities, &path, &text));
    }
}

impl Store {
    fn firmware_path(&self, firmware: &str) -> Option<PathBuf> {
        let safe = |letter: char| if letter.is_ascii_alphanumeric() || letter == '.' { letter } else { '-' };
        let name: String = firmware.chars().map(safe).take(LONGEST_NAME).collect();
        self.path(&[CAPABILITIES, &format!("firmware-{name}.json")]).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::capability::CapabilityBook;
    use std::fs;
    use std::sync::Arc;
    use std::time::Duration;

    #[test]
    fn a_map_comes_back_and_that_of_a_text_with_the_same_name_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path());
        let mut book = CapabilityBook::new(Some(Arc::new(store.clone())));
        book.introduce(0x80, "MCP266 v1");
        (1..30).for_each(|command| book.answered(0x80, command, Duration::from_millis(2), 0));
        book.silent(0x80, 90, 3);
        let told = book.take_news();
        let map = store.load("MCP266 v1");
        assert_eq!(map, told[0].1);
        assert_eq!(map.absent().collect::<Vec<_>>(), [90]);
        assert!(store.load("MCP266/v1").is_empty(), "the same file, another firmware");
        assert!(Store::at(folder.path().join("none")).load("MCP266 v1").is_empty());
    }

    #[test]
    fn a_damaged_file_counts_as_none() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path());
        store.keep("v", &CapabilityMap::default());
        for text in ["", "{", "[]", "{\"firmware\": \"v\", \"answers\": {\"commands\": {\"900\": {}}}}"] {
            fs::write(store.firmware_path("v").unwrap(), text).unwrap();
            assert!(store.load("v").is_empty(), "{text}");
        }
    }
}
