//! One SuprMotr, and what is known of it from one act to the next.

use crate::controller::speaker::Speaker;
use brushwork_link::device::Identity;
use brushwork_link::device::controller::Line;
use brushwork_suprmotr_wire::{Command, Mnemonic};
use std::time::Duration;

/// One SuprMotr V9.
pub struct SuprMotr {
    pub(super) speaker: Speaker,
    pub(super) identity: Identity,
    /// Where it was when it was last asked, and when that was.
    pub(super) last_position: Option<(i32, Duration)>,
    /// The limit of the following error as it was last set here: nothing tells it.
    pub(super) following_error: Option<i32>,
    /// A stop has switched the motor off, since its loop did not hold it still.
    pub(super) switched_off: bool,
}

impl SuprMotr {
    pub(super) fn new(speaker: Speaker, identity: Identity) -> Self {
        Self { speaker, identity, last_position: None, following_error: None, switched_off: false }
    }

    /// The unit and its port, for sentences.
    pub(super) fn name(&self, line: &mut Line<'_>) -> String {
        format!("{} at {}", self.identity.place(), line.exchange().port())
    }

    /// What commands that were carried out change in what is known of the unit.
    pub(super) fn note(&mut self, commands: &[Command]) {
        for command in commands {
            if command.mnemonic == Mnemonic::SM {
                self.following_error = command.number;
            }
            if [Mnemonic::DH, Mnemonic::RT].contains(&command.mnemonic) {
                self.last_position = None;
            }
            if command.mnemonic == Mnemonic::RT {
                self.following_error = None;
            }
        }
    }
}
