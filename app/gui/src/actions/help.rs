//! The Help menu (MCP manual 1.2.9): pages drawn from the tables in place of PDF files.

use egui::Key;

use super::{Action, Keys, key};
use crate::model::help_page::HelpPage;

pub(super) const ACTIONS: &[Action] = &[
    page!("help.first-steps": "First Steps", key(Key::F1), HelpPage::FIRST_STEPS, "From an empty window to a motor that turns."),
    page!("help.tuning": "How Tuning Works", Keys::None, HelpPage::TUNING, "How the tuner works, what its figures mean, and what it refuses."),
    page!("help.shortcuts": "Keyboard Shortcuts", key(Key::F2), HelpPage::SHORTCUTS, "Every key that does something."),
    page!("help.about": "About Brushwork", Keys::None, HelpPage::ABOUT, "Version, licence and what it is built with."),
];
