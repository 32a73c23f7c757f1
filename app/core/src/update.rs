//! After a firmware update: whether the controller runs the new firmware, and whether its settings are those of the backup.
//!
//! That all pages were confirmed says that the line was good, and nothing else. An update is called done when the controller has
//! been connected again and says so itself.

use brushwork_link::work::receive_within;
use std::sync::Arc;
use std::time::{Duration, Instant};

use brushwork_link::device::Event;
use brushwork_link::settings::{Profile, ReadReport, diff};
use brushwork_link::{ConnectTarget, Identity, Message, SystemClock};
use crossbeam_channel::RecvTimeoutError;

use crate::keep::{KeepError, Store, UnitId};
use crate::messages::UpdateMessage;
use crate::session::{self, Session, SessionOptions, Simulation};

/// The settings from before an update.
#[derive(Clone, Debug)]
pub struct Kept {
    /// The settings.
    pub profile: Profile,
    /// What the backup is called.
    pub title: String,
    /// What names the backup in commands.
    pub name: String,
}

/// What is known of an update before it begins, to be compared with what comes of it.
#[derive(Clone, Debug)]
pub struct Expected {
    /// The text of the version from before; none where an update is resumed of which nothing is known.
    pub before: Option<String>,
    /// The version that the image announces, where it is one that tells.
    pub announced: Option<String>,
    /// The settings from before; none where an update is resumed.
    pub kept: Option<Kept>,
}

/// Which firmware runs after an update.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Another one than before.
    Updated {
        /// The text of the version from before.
        from: String,
        /// That of now.
        to: String,
    },
    /// The one that was announced, or just one, where nobody knows what ran before.
    Runs(String),
    /// The same as before.
    NotChanged(String),
    /// Another one than the image announces.
    Unexpected {
        /// The version that it announces.
        announced: String,
        /// The text of the version that runs.
        found: String,
    },
}

/// How the settings are after an update, against the backup.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// A line for each that differs: "M1 QPPS: 44000 counts/s in the backup, 12000 counts/s now".
    pub differences: Vec<String>,
    /// Why they could not be compared.
    pub failure: Option<Message>,
}

/// Reads of a unit are kept as its backup before its firmware is replaced.
///
/// # Errors
/// A sentence: not all settings were read, or they could not be kept.
pub fn keep(report: &ReadReport, identity: &Identity, unit: &UnitId, store: &Store) -> Result<Kept, Message> {
    let told = |error: KeepError| {
        let unread = report.unread().next().map(|unread| unread.failure.message());
        let error = Message::error(error);
        match unread {
            Some(unread) => UpdateMessage::NotKept { error, unread }.into(),
            None => error,
        }
    };
    let (profile, backup) = store.back_up_for_firmware(unit, identity, report).map_err(told)?;
    Ok(Kept { profile, title: backup.title(), name: backup.name })
}

impl Expected {
    /// What is known of an update that is resumed: what was noted when it was begun at that place.
    #[must_use]
    pub fn resumed(store: &Store, place: &str, announced: Option<String>) -> Self {
        // Whoever resumes an update names model and image himself: what cannot be read is not compared.
        let begun = store.update_at(place).ok().flatten();
        let kept = begun.as_ref().and_then(|begun| {
            let backup = store.backups(None).into_iter().find(|backup| backup.name == begun.backup)?;
            let profile = backup.open().ok()?.profile;
            Some(Kept { profile, title: backup.title(), name: backup.name })
        });
        Self { before: begun.map(|begun| begun.before), announced, kept }
    }

    /// What the controller says of itself now that it is connected again.
    #[must_use]
    pub fn verdict(&self, now: &Identity) -> Verdict {
        self.judge(&now.version_text, &now.firmware)
    }

    fn judge(&self, version_text: &str, firmware: &str) -> Verdict {
        let found = version_text.trim().to_owned();
        match (&self.announced, &self.before) {
            (Some(announced), _) if firmware != announced => {
                Verdict::Unexpected { announced: announced.clone(), found }
            }
            (_, Some(before)) if before.trim() == found => Verdict::NotChanged(found),
            (_, Some(before)) => Verdict::Updated { from: before.trim().to_owned(), to: found },
            (_, None) => Verdict::Runs(found),
        }
    }
}

impl Verdict {
    /// Whether the update may be called done.
    #[must_use]
    pub fn is_good(&self) -> bool {
        matches!(self, Self::Updated { .. } | Self::Runs(_))
    }

    /// What it means, as sentences.
    #[must_use]
    pub fn sentence(&self) -> UpdateMessage {
        match self.clone() {
            Self::Updated { from, to } => UpdateMessage::Updated { from, to },
            Self::Runs(version) => UpdateMessage::Runs { version },
            Self::NotChanged(version) => UpdateMessage::NotChanged { version },
            Self::Unexpected { announced, found } => UpdateMessage::Unexpected { announced, found },
        }
    }
}

impl Kept {
    /// How what was read after an update differs from the backup.
    #[must_use]
    pub fn compare(&self, report: &ReadReport) -> Compared {
        let fitted = self.profile.fitted_to(&report.table).profile.settings;
        let reported = diff(&report.table, &fitted, &report.image).into_iter().filter_map(|difference| {
            let row = report.table.row(&difference.key)?;
            let text = |value: Option<_>| value.map_or("nothing".to_owned(), |value| row.format(value));
            Some(format!(
                "{}: {} in the backup, {} now",
                row.title(),
                text(difference.left),
                text(difference.right)
            ))
        });
        Compared { differences: reported.collect(), failure: None }
    }
}

impl Compared {
    /// What came of it, in a sentence.
    #[must_use]
    pub fn sentence(&self) -> UpdateMessage {
        match (&self.failure, self.differences.len()) {
            (Some(why), _) => UpdateMessage::NotCompared { why: why.clone() },
            (None, 0) => UpdateMessage::AsInBackup,
            (None, 1) => UpdateMessage::OneDiffers,
            (None, count) => UpdateMessage::Differ { count },
        }
    }
}

/// How long a controller may take to restart and be found again.
const RETURN_LIMIT: Duration = Duration::from_secs(30);
/// How long a line is left alone between two looks: a unit that restarts is not asked while it does.
const RETURN_PAUSE: Duration = Duration::from_millis(500);
/// How long one look waits for the device thread's events.
const SLICE: Duration = Duration::from_millis(50);

/// Waits until a controller answers at `target` again, as after the restart that ends an update.
///
/// # Errors
/// A sentence on what came back at the last look; the search was given up, or the limit is over.
pub fn wait_for_return(
    target: &ConnectTarget,
    options: SessionOptions,
    simulation: Option<&Arc<Simulation>>,
    goes_on: &dyn Fn() -> bool,
) -> Result<(), Message> {
    let begun_at = Instant::now();
    let mut came_back = UpdateMessage::NotWaited.into();
    while goes_on() && begun_at.elapsed() < RETURN_LIMIT {
        std::thread::sleep(RETURN_PAUSE);
        match session::open(target, options, SystemClock::shared(), simulation.cloned()) {
            Ok(session) => match look(&session, goes_on) {
                Ok(()) => return Ok(()),
                Err(why) => came_back = why,
            },
            Err(error) => came_back = Message::error(error),
        }
    }
    Err(came_back)
}

fn look(session: &Session, goes_on: &dyn Fn() -> bool) -> Result<(), Message> {
    let begun_at = Instant::now();
    while goes_on() && begun_at.elapsed() < RETURN_LIMIT {
        match receive_within(session.device.events(), SLICE) {
            Ok(Event::Selected { .. }) => return Ok(()),
            Ok(Event::Lost(failure)) => return Err(failure.message()),
            Ok(_) | Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    Err(UpdateMessage::NobodyAnswered.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expected(before: Option<&str>, announced: Option<&str>) -> Expected {
        Expected { before: before.map(str::to_owned), announced: announced.map(str::to_owned), kept: None }
    }

    #[test]
    fn an_update_is_done_when_another_version_answers_and_not_before() {
        let (old, new) = ("MCP266 2x60A v1.0.0", "MCP266 2x60A v1.1.0");
        let verdict = expected(Some(old), None).judge(new, "1.1.0");
        assert!(verdict.is_good());
        assert_eq!(
            verdict.sentence().to_string(),
            "The firmware is updated: MCP266 2x60A v1.0.0 before, MCP266 2x60A v1.1.0 now."
        );
        let verdict = expected(Some(old), None).judge(old, "1.0.0");
        assert!(!verdict.is_good());
        assert!(
            verdict.sentence().to_string().starts_with("The version did not change"),
            "{}",
            verdict.sentence()
        );
        let verdict = expected(Some(old), Some("1.2.0")).judge(new, "1.1.0");
        assert!(
            !verdict.is_good() && verdict.sentence().to_string().contains("version 1.2.0"),
            "{}",
            verdict.sentence()
        );
        assert!(
            expected(None, Some("1.1.0")).judge(new, "1.1.0").is_good(),
            "resumed, nothing known of before"
        );
    }
}
