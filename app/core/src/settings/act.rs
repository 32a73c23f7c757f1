//! One act on a controller's settings, as a job does it: read, write, save, restore, load.

use std::time::Duration;

use crate::messages::CoreActMessage;
use brushwork_link::device::JobContext;
use brushwork_link::messages::{ActMessage, settings};
use brushwork_link::settings::{
    DefaultsReport, Known, SaveReport, WriteError, WriteReport, defaults_kept, read_all, read_some,
    reload_kept, save_kept, write_kept_knowing,
};
use brushwork_link::{
    Failure, Keeper, Message, ReadReport, SettingsImage, SettingsTable, Wire, WriteOptions,
};

/// Longest time for reading: a serial line of 2400 bit/s takes most of it.
const READING_LIMIT: Duration = Duration::from_secs(120);
/// Longest time for anything that writes, reading before and after included.
const WRITING_LIMIT: Duration = Duration::from_secs(400);

/// What is done. Whatever changes a controller has a backup and a journal first.
#[derive(Debug)]
pub enum Act {
    /// Reads what the controller works with.
    Read,
    /// Reads some settings.
    ReadKeys(Vec<String>),
    /// Makes the controller load its EEPROM, then reads.
    Reload,
    /// Writes values to RAM and reads them back.
    Write {
        /// The values.
        wanted: SettingsImage,
        /// What goes from one of a series of small writes to the next, so that not each of them reads everything for its backup.
        known: Known,
    },
    /// Saves RAM to EEPROM and reads that back.
    Save,
    /// Restores the factory settings.
    RestoreDefaults,
}

/// What came of it.
#[derive(Debug)]
pub enum Done {
    /// Everything, or some settings, as the controller works with them.
    Read(Box<ReadReport>),
    /// What was in EEPROM.
    Reloaded(Box<ReadReport>),
    /// What became of each value, and what is known for the next write.
    Written(Box<WriteReport>, Known),
    /// Nothing was written.
    NotWritten(WriteError),
    /// What is known of the EEPROM now.
    Saved(Box<SaveReport>),
    /// What the controller works with by default.
    Restored(Box<DefaultsReport>),
}

impl Act {
    /// What it does, for sentences: "write 2 settings".
    #[must_use]
    pub fn name(&self) -> Message {
        match self {
            Self::Read => ActMessage::ReadSettings.into(),
            Self::ReadKeys(keys) => CoreActMessage::ReadSome { settings: settings(keys.len()) }.into(),
            Self::Reload => CoreActMessage::LoadFromEeprom.into(),
            Self::Write { wanted, .. } => {
                CoreActMessage::WriteSome { settings: settings(wanted.len()) }.into()
            }
            Self::Save => CoreActMessage::SaveToEeprom.into(),
            Self::RestoreDefaults => CoreActMessage::RestoreDefaults.into(),
        }
    }

    /// How long it may take.
    #[must_use]
    pub fn limit(&self) -> Duration {
        match self {
            Self::Read | Self::ReadKeys(_) => READING_LIMIT,
            Self::Reload | Self::Write { .. } | Self::Save | Self::RestoreDefaults => WRITING_LIMIT,
        }
    }

    /// What a job does to do it. It fails where nothing was done, or the controller does not answer.
    pub fn work(
        mut self,
        table: SettingsTable,
        options: WriteOptions,
        mut keeper: Box<dyn Keeper>,
    ) -> impl FnMut(&mut JobContext<'_>) -> Result<Done, Failure> + Send + 'static {
        move |wire| self.run(wire, &table, options, &mut *keeper)
    }

    fn run(
        &mut self,
        wire: &mut dyn Wire,
        table: &SettingsTable,
        options: WriteOptions,
        keeper: &mut dyn Keeper,
    ) -> Result<Done, Failure> {
        let subject = *table.subject();
        match self {
            Self::Read => read_all(wire, subject).map(|report| Done::Read(Box::new(report))),
            Self::ReadKeys(keys) => read_some(wire, table, keys).map(|report| Done::Read(Box::new(report))),
            Self::Reload => reload_kept(wire, table, keeper).map(|report| Done::Reloaded(Box::new(report))),
            Self::Write { wanted, known } => {
                Ok(match write_kept_knowing(wire, table, wanted, options, keeper, known) {
                    Ok(report) => Done::Written(Box::new(report), std::mem::take(known)),
                    Err(error) => Done::NotWritten(error),
                })
            }
            Self::Save => save_kept(wire, table, options, keeper).map(|report| Done::Saved(Box::new(report))),
            Self::RestoreDefaults => {
                defaults_kept(wire, subject, keeper).map(|report| Done::Restored(Box::new(report)))
            }
        }
    }
}

/// "1 setting", "7 settings".
#[must_use]
pub fn counted(count: usize) -> String {
    settings(count).to_string()
}
