//! What a stop may change of a unit for a while, as a journal like that of a tuning run: it says what is to be there again, and the next connection
//! compares and offers it.

use brushwork_link::device::Identity;
use brushwork_link::loan::KeepsLoans;
use brushwork_link::settings::{Act, Journal};
use brushwork_link::transport::list_ports;
use brushwork_link::{Failure, SettingsImage};

use super::journals::OpenJournal;
use super::store::{KeepError, Record, Store};
use super::unit::{UnitId, profile_of};
use crate::messages::CoreActMessage;

/// What tells a loan from other journals.
const NOTE: &str = "before a stop";

impl KeepsLoans for Store {
    fn lend(&self, identity: &Identity, held: &SettingsImage) -> Result<(), Failure> {
        let (unit, Some(subject)) = (unit_of(identity), identity.subject()) else { return Ok(()) };
        if loans(self, &unit).iter().any(|open| keys(&open.journal.wanted.settings).eq(keys(held))) {
            return Ok(());
        }
        let (address, version) = (identity.unit_address(), &identity.version_text);
        let mut profile = profile_of(subject, address, version, &unit.place, held.clone());
        profile.note = NOTE.to_owned();
        let journal = Journal { act: Act::Trial, before: profile.clone(), wanted: profile };
        let kept = self.open_journal(&unit, &journal).map(drop);
        kept.map_err(|error| as_loan(error).failure(CoreActMessage::NoteLoan))
    }

    fn given_back(&self, identity: &Identity, held: &SettingsImage) {
        for open in loans(self, &unit_of(identity)) {
            let mut wanted = open.journal.wanted.settings.iter();
            if wanted.all(|(key, value)| held.get(key) == Some(value)) {
                // One that stays is told at the next connection as what it is: all as it was.
                let _ = self.close_journal(&open.path);
            }
        }
    }
}

/// The same error of a journal that is a loan: a stop goes on without it.
fn as_loan(error: KeepError) -> KeepError {
    match error {
        KeepError::Write { path, source, .. } => KeepError::Write { record: Record::Loan, path, source },
        KeepError::Read { path, what, .. } => KeepError::Read { record: Record::Loan, path, what },
        other @ (KeepError::NoFolder | KeepError::NotWhole | KeepError::Damaged { .. }) => other,
    }
}

fn unit_of(identity: &Identity) -> UnitId {
    // Without a list of ports a unit is told by the name of its port.
    UnitId::new(identity, &list_ports().unwrap_or_default())
}

fn loans(store: &Store, unit: &UnitId) -> Vec<OpenJournal> {
    let mut open = store.open_journals(unit).0;
    open.retain(|open| open.journal.act == Act::Trial && open.journal.before.note == NOTE);
    open
}

fn keys(image: &SettingsImage) -> impl Iterator<Item = &str> {
    image.iter().map(|(key, _)| key)
}
