//! What waits until a run or an examination has put back what it changed.

use brushwork_core::messages::EndedMessage;

/// What was asked for during a run or an examination and would cut it off from its controller: it follows when what it changed is put back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Afterwards {
    Disconnect,
    /// The unit at this address.
    Select(u8),
}

impl Afterwards {
    /// Why the run ends.
    pub const fn why(self) -> EndedMessage {
        match self {
            Self::Disconnect => EndedMessage::LinkCloses,
            Self::Select(_) => EndedMessage::OtherUnit,
        }
    }

    /// What follows, as the beginning of a sentence.
    pub const fn what(self) -> &'static str {
        match self {
            Self::Disconnect => "The link closes (ask again to close it at once)",
            Self::Select(_) => "The other unit is shown",
        }
    }
}
