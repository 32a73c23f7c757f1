//! The numbers that were written raw to a unit from this computer. Each is noted before it goes out, so that one that is cut short is known.

use brushwork_link::Failure;
use brushwork_link::messages::ActMessage;
use brushwork_link::settings::{Act, Ending, Entry, Keeper};

use super::store::{KeepError, Record, Store};
use super::unit::UnitId;
use crate::examine::RawWrite;

const RAW: &str = "raw";
/// As many raw writes as are remembered of a unit.
const MOST_RAW_WRITES: usize = 200;

impl Store {
    /// The numbers that were written to the unit raw from this computer, oldest first.
    ///
    /// # Errors
    /// Their file is damaged or cannot be read.
    pub fn raw_writes(&self, unit: &UnitId) -> Result<Vec<RawWrite>, KeepError> {
        Ok(self.json(Record::RawWrites, &self.memory_path(RAW, unit)?)?.unwrap_or_default())
    }

    /// Notes one more. A damaged file is put aside.
    ///
    /// # Errors
    /// It cannot be kept.
    pub fn note_raw_write(&self, unit: &UnitId, write: RawWrite) -> Result<(), KeepError> {
        let mut writes = match self.raw_writes(unit) {
            Err(KeepError::Damaged { record, path, .. }) => {
                self.put_aside(record, &path)?;
                Vec::new()
            }
            known => known?,
        };
        writes.push(write);
        writes.drain(..writes.len().saturating_sub(MOST_RAW_WRITES));
        self.put_raw_writes(unit, &writes)
    }

    /// Ends those that were begun and not read back, by what each register was found to hold: `found` gives that, or `None` where it was not read.
    /// They are handed back as they were noted, with what was found.
    ///
    /// # Errors
    /// The list cannot be read or kept.
    pub fn end_raw_writes(
        &self,
        unit: &UnitId,
        found: impl Fn(&RawWrite) -> Option<i64>,
    ) -> Result<Vec<RawWrite>, KeepError> {
        let mut writes = self.raw_writes(unit)?;
        let mut ended = Vec::new();
        for write in writes.iter_mut().filter(|write| write.is_open) {
            let Some(raw) = found(write) else { continue };
            (write.found, write.is_open) = (Some(raw), false);
            ended.push(write.clone());
        }
        if !ended.is_empty() {
            self.put_raw_writes(unit, &writes)?;
        }
        Ok(ended)
    }

    /// The newest was never sent: it is as if it had not been begun.
    fn forget_raw_write(&self, unit: &UnitId) -> Result<(), KeepError> {
        let mut writes = self.raw_writes(unit)?;
        if writes.pop_if(|newest| newest.is_open).is_some() {
            self.put_raw_writes(unit, &writes)?;
        }
        Ok(())
    }

    fn put_raw_writes(&self, unit: &UnitId, writes: &[RawWrite]) -> Result<(), KeepError> {
        let text = serde_json::to_string_pretty(writes).unwrap_or_default();
        self.put_memory(Record::RawWrites, RAW, unit, &text)
    }
}

/// Keeps backup and journal of a raw write as of every write, and notes it itself before the first byte of it goes out.
pub struct RawKeeper {
    inner: Box<dyn Keeper>,
    store: Store,
    unit: UnitId,
    write: RawWrite,
}

impl RawKeeper {
    /// For one write, which is noted as not ended yet. Whoever has read back what came of it ends it by [`Store::end_raw_writes`].
    #[must_use]
    pub fn boxed(inner: Box<dyn Keeper>, store: Store, unit: UnitId, write: RawWrite) -> Box<dyn Keeper> {
        Box::new(Self { inner, store, unit, write: RawWrite { found: None, is_open: true, ..write } })
    }
}

impl Keeper for RawKeeper {
    fn begin(&mut self, entry: Entry) {
        self.inner.begin(entry);
    }

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        let begun = self.inner.begun()?;
        Some(begun.and_then(|()| {
            let noted = self.store.note_raw_write(&self.unit, self.write.clone());
            noted.map_err(|error| error.failure(ActMessage::KeepBackup { act: Act::Write.label() }))
        }))
    }

    fn end(&mut self, ending: Ending) {
        if ending == Ending::NotDone {
            // One that stays is told once more, and found to hold what it held.
            let _ = self.store.forget_raw_write(&self.unit);
        }
        self.inner.end(ending);
    }

    fn ended(&mut self) -> bool {
        self.inner.ended()
    }
}
