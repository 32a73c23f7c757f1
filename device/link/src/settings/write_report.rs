//! What is known of each change after a write, and how it is told.

use serde::Serialize;

use super::image::SettingsImage;
use super::row::Row;
use super::table::SettingsTable;
use super::value::SettingValue;
use crate::failure::Failure;
use crate::messages::WriteMessage;
use crate::unit::UnitAddress;
use brushwork_values::Message;

/// What became of each change.
#[derive(Clone, Debug, Serialize)]
pub struct WriteReport {
    /// Every row that was to be changed, in screen order.
    pub rows: Vec<RowOutcome>,
    /// What the user should know, a sentence each.
    pub warnings: Vec<Message>,
    /// Why writing ended early, if it did.
    pub ended_early: Option<Failure>,
    /// Where the controller answers now.
    pub address: UnitAddress,
    /// Commands sent, reads included.
    pub transactions: usize,
}

/// What became of one change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowOutcome {
    /// The row.
    pub key: String,
    /// Its value before, if it could be read.
    pub before: Option<SettingValue>,
    /// The value wanted.
    pub wanted: SettingValue,
    /// The value read back, if it could be.
    pub found: Option<SettingValue>,
    /// What that means.
    pub state: RowState,
}

/// What is known of a change.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RowState {
    /// Read back as wanted.
    Taken,
    /// Read back, and not as wanted; with what was wrong with the command, if anything was.
    DidNotTake {
        /// What came back when it was written; empty when it was acknowledged.
        why: Message,
    },
    /// Not sent; the controller holds the old value.
    NotSent {
        /// Why, as a sentence.
        why: Message,
    },
    /// Sent, and not read back.
    Unverified {
        /// Why, as a sentence.
        why: Message,
    },
}

impl WriteReport {
    /// Whether every row was read back as wanted.
    pub fn is_complete(&self) -> bool {
        self.rows.iter().all(|row| row.state == RowState::Taken)
    }

    /// The rows that are not known to hold what was wanted.
    pub fn did_not_take(&self) -> impl Iterator<Item = &RowOutcome> {
        self.rows.iter().filter(|row| row.state != RowState::Taken)
    }

    /// A sentence for each row that is not known to hold what was wanted.
    pub fn sentences(&self, table: &SettingsTable) -> Vec<Message> {
        self.did_not_take().filter_map(|outcome| Some(outcome.sentence(table.row(&outcome.key)?))).collect()
    }

    /// What the controller holds as far as this write knows: `ram` with what was read back.
    pub fn merge_into(&self, ram: &mut SettingsImage) {
        for row in &self.rows {
            match (row.found, &row.state) {
                (Some(found), _) => ram.set(&row.key, found),
                (None, RowState::NotSent { .. }) => {}
                (None, _) => ram.remove(&row.key),
            }
        }
    }
}

impl RowOutcome {
    fn sentence(&self, row: &Row) -> Message {
        let title = row.title();
        let [wanted, found] = row.format_both([Some(self.wanted), self.found]);
        let found = if self.found.is_some() { found } else { "unknown".to_owned() };
        match self.state.clone() {
            RowState::Taken => WriteMessage::Taken { title, wanted },
            RowState::DidNotTake { why } if why.is_empty() => WriteMessage::NotTaken { title, wanted, found },
            RowState::DidNotTake { why } => WriteMessage::NotTakenFor { title, wanted, found, why },
            RowState::NotSent { why } => WriteMessage::NotSent { title, wanted, why },
            RowState::Unverified { why } => WriteMessage::Unverified { title, wanted, why },
        }
        .into()
    }
}
