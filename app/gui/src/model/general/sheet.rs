//! The sheets of the General Settings screen.

use brushwork_link::Message;

/// What stands in place of the list until it is answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sheet {
    Read,
    Write,
    Save,
    Defaults,
    OpenProfile,
    SaveProfile,
    /// What has to be changed of a profile before it fits.
    Upgrade,
    /// Any two copies side by side.
    Compare,
    Backups,
    CopyMotor,
    /// What was cut short on this controller.
    Unfinished,
    /// What did not go as wanted, a sentence each.
    Report {
        title: Message,
        sentences: Vec<Message>,
    },
}
