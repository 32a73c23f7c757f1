//! What a file is, by what stands in it and how its name ends: whoever opens or drops one does not have to say.

use std::io::Read as _;
use std::path::Path;

use brushwork_link::bounded::{self, MOST_BYTES};
use brushwork_link::files;
use brushwork_link::settings::FORMAT;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use crate::messages::KnownFileMessage;

/// How a recording in the compact form begins.
const RECORDING: &[u8] = b"BWREC";

/// What a file can be opened as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KnownFile {
    /// Settings of a controller: a profile or a backup.
    Profile,
    /// A tuning run.
    Report,
    /// Samples over time.
    Recording,
    /// A program for a controller, as text.
    Script,
    /// A firmware image.
    Firmware,
}

impl KnownFile {
    /// All there are.
    pub const ALL: [Self; 5] = [Self::Profile, Self::Report, Self::Recording, Self::Script, Self::Firmware];

    /// How the names of such files end, without the dot.
    #[must_use]
    pub const fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Profile | Self::Report => &["json"],
            Self::Recording => &["bwr", "csv"],
            Self::Script => &["mcl", "mecc", "macros"],
            Self::Firmware => &["bin"],
        }
    }
}

/// What tells settings and reports from other JSON.
#[derive(Deserialize)]
struct Head {
    format: Option<Value>,
    request: Option<IgnoredAny>,
    record: Option<IgnoredAny>,
}

/// What a file is.
///
/// # Errors
/// It is none of ours, longer than any of them, or cannot be read.
pub fn recognise(path: &Path) -> Result<KnownFile, KnownFileMessage> {
    let shown = path.display().to_string();
    let unread =
        |error: std::io::Error| KnownFileMessage::NotRead { path: shown.clone(), error: error.to_string() };
    let found = files::look(path).map_err(unread)?;
    // A device or a pipe may never end.
    if !found.is_file {
        return Err(KnownFileMessage::NoFile { path: shown });
    }
    let mut begin = Vec::new();
    let file = files::open(path).map_err(unread)?;
    file.take(RECORDING.len() as u64).read_to_end(&mut begin).map_err(unread)?;
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let is = |kind: KnownFile| kind.endings().contains(&ending.as_str());
    if begin == RECORDING || is(KnownFile::Recording) {
        return Ok(KnownFile::Recording);
    }
    if found.bytes > MOST_BYTES {
        return Err(KnownFileMessage::TooLong { path: shown, mebibytes: MOST_BYTES >> 20 });
    }
    if let Some(kind) = [KnownFile::Script, KnownFile::Firmware].into_iter().find(|kind| is(*kind)) {
        return Ok(kind);
    }
    if !is(KnownFile::Profile) && !begin.trim_ascii_start().starts_with(b"{") {
        return Err(KnownFileMessage::Unknown { path: shown });
    }
    let text = bounded::read_text(path).map_err(unread)?;
    of_json(&text).ok_or(KnownFileMessage::OtherJson { path: shown })
}

/// Of which kind JSON is. What is damaged counts by the words in it, so that its reader tells the place.
fn of_json(text: &str) -> Option<KnownFile> {
    let (is_profile, is_report) = match serde_json::from_str::<Head>(text) {
        Ok(head) => {
            let is_profile = head.format.as_ref().and_then(Value::as_str) == Some(FORMAT);
            (is_profile, head.request.is_some() && head.record.is_some())
        }
        Err(_) => (text.contains(FORMAT), text.contains("\"request\"") && text.contains("\"record\"")),
    };
    match (is_profile, is_report) {
        (true, _) => Some(KnownFile::Profile),
        (false, true) => Some(KnownFile::Report),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, text: &[u8]) -> Result<KnownFile, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        recognise(&path).map_err(|why| why.to_string())
    }

    #[test]
    fn what_stands_in_a_file_counts_before_how_its_name_ends() {
        assert_eq!(of("a.json", br#"{"format": "brushwork-settings"}"#), Ok(KnownFile::Profile));
        assert_eq!(of("a.json", br#"{"format": 2, "request": {}, "record": []}"#), Ok(KnownFile::Report));
        assert_eq!(
            of("renamed", br#" {"format": "brushwork-settings", "x": [1, 2]}"#),
            Ok(KnownFile::Profile)
        );
        assert_eq!(of("renamed.bin", b"BWREC\x01\r\n"), Ok(KnownFile::Recording));
        for (name, kind) in [
            ("a.CSV", KnownFile::Recording),
            ("a.bwr", KnownFile::Recording),
            ("a.mcl", KnownFile::Script),
            ("a.mecc", KnownFile::Script),
            ("a.bin", KnownFile::Firmware),
        ] {
            assert_eq!(of(name, b"whatever"), Ok(kind), "{name}");
        }
    }

    #[test]
    fn a_damaged_file_goes_to_the_reader_that_tells_the_place() {
        assert_eq!(of("a.json", br#"{"format": "brushwork-settings", "model" "#), Ok(KnownFile::Profile));
        assert_eq!(of("a.json", br#"{"request": {}, "record": [1,"#), Ok(KnownFile::Report));
    }

    #[test]
    fn what_is_none_of_ours_is_refused_in_a_sentence() {
        let folder = tempfile::tempdir().unwrap();
        for told in [
            of("a.json", b"{}").unwrap_err(),
            of("a.png", b"\x89PNG").unwrap_err(),
            of("empty", b"").unwrap_err(),
            recognise(folder.path()).unwrap_err().to_string(),
            recognise(&folder.path().join("none")).unwrap_err().to_string(),
        ] {
            assert!(told.ends_with('.') && told.len() > 30, "{told}");
        }
    }

    #[test]
    fn what_is_longer_than_any_of_them_is_not_read_but_a_recording_may_be_of_any_length() {
        let folder = tempfile::tempdir().unwrap();
        for (name, is_taken) in [("a.mcl", false), ("a.json", false), ("a.bin", false), ("a.csv", true)] {
            let path = folder.path().join(name);
            std::fs::File::create(&path).unwrap().set_len(MOST_BYTES + 1).unwrap();
            assert_eq!(recognise(&path).is_ok(), is_taken, "{name}");
        }
    }
}
