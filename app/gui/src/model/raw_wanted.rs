//! What the page for raw numbers asks of a connection: what a register holds, and what is to be written to it.

use brushwork_core::settings::raw::{Raw, held, undoing};
use brushwork_core::settings::write_options;
use brushwork_link::{Message, WriteOptions};
use brushwork_values::Sentences;

use super::raw::{RawAction, number};
use super::{Arming, Connection};
use crate::messages::RawPageMessage;

impl Connection {
    /// What the chosen setting's register holds, as far as it was read.
    pub fn raw_held(&self) -> Option<i64> {
        let unit = self.settings.unit()?;
        held(unit.table().row(&self.raw.key)?, unit.ram()?)
    }

    /// The setting and the number that undo the newest write.
    pub fn raw_undo(&self) -> Option<(String, i64)> {
        undoing(self.raw.writes())
    }

    /// What an action writes, and how.
    ///
    /// # Errors
    /// Why it cannot be written.
    pub fn raw_wanted(&self, action: RawAction) -> Result<(Raw, WriteOptions), Message> {
        if self.link.arming != Arming::Disarmed {
            return Err(RawPageMessage::Armed.into());
        }
        if self.is_guided() || self.errand.is_running() {
            return Err(RawPageMessage::Busy.into());
        }
        let identity = self.link.identity().ok_or(RawPageMessage::NotConnected)?;
        let unit = self.settings.unit().ok_or(RawPageMessage::NotConnected)?;
        let ram = unit.ram().ok_or(RawPageMessage::NotReadYet)?;
        let (key, raw) = match action {
            RawAction::Write => {
                let typed = number(&self.raw.typed);
                (
                    self.raw.key.clone(),
                    typed.ok_or(RawPageMessage::NoNumber { text: self.raw.typed.clone() })?,
                )
            }
            RawAction::Undo => self.raw_undo().ok_or(RawPageMessage::NothingToUndo)?,
        };
        let wanted = Raw::new(unit.table(), ram, &key, raw)?;
        if wanted.is_there() {
            return Err(RawPageMessage::HeldAlready { key, raw }.into());
        }
        let options =
            WriteOptions { own_stream: self.link.stream, simulated: identity.simulated, as_read: false };
        let options = write_options(&wanted.table, ram, &wanted.changes, |_, _| true, options);
        let options = options.map_err(|refusals| {
            let why = Sentences(refusals.into_iter().map(|refusal| refusal.sentence).collect());
            Message::from(RawPageMessage::CannotBe { why })
        })?;
        Ok((wanted, options))
    }
}
