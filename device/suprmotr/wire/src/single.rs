//! The commands of one character, which are taken at any time (SuprMotr manual, "Sub-Commands").

use super::table::Mnemonic;

/// A command of one character. It needs no carriage return and does not end a macro or a wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Single {
    /// `'`: the position.
    Position,
    /// `?`: the following error.
    FollowingError,
    /// `\`: the counter of repeats.
    Iteration,
    /// `%`: the status.
    Status,
    /// `#`: the digital channels.
    Channels,
    /// `!`: stops every controller of the line, also those that are not selected.
    Abort,
    /// Backspace: ends a running macro or repeat. It takes no character back.
    EndMacro,
}

impl Single {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Position,
        Self::FollowingError,
        Self::Iteration,
        Self::Status,
        Self::Channels,
        Self::Abort,
        Self::EndMacro,
    ];

    /// Its character.
    pub const fn character(self) -> u8 {
        match self {
            Self::Position => b'\'',
            Self::FollowingError => b'?',
            Self::Iteration => b'\\',
            Self::Status => b'%',
            Self::Channels => b'#',
            Self::Abort => b'!',
            Self::EndMacro => 0x08,
        }
    }

    /// The one of that character.
    pub fn from_character(character: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|single| single.character() == character)
    }

    /// The command that does the same; backspace has none.
    pub const fn mnemonic(self) -> Option<Mnemonic> {
        match self {
            Self::Position => Some(Mnemonic::TP),
            Self::FollowingError => Some(Mnemonic::TF),
            Self::Iteration => Some(Mnemonic::TI),
            Self::Status => Some(Mnemonic::TS),
            Self::Channels => Some(Mnemonic::TC),
            Self::Abort => Some(Mnemonic::AB),
            Self::EndMacro => None,
        }
    }
}
