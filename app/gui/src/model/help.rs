//! The pages of help, the one that is open, and what is looked for in it.

use super::help_page::HelpPage;
use crate::family;

/// All pages, those of the families among them.
pub fn pages() -> Vec<HelpPage> {
    let mut all = vec![HelpPage::FIRST_STEPS, HelpPage::TUNING, HelpPage::SHORTCUTS, HelpPage::ABOUT];
    all.extend(family::all().iter().flat_map(|family| family.help_pages()));
    all.sort_by_key(|page| page.group);
    all
}

/// The window of help.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Help {
    /// None while it is closed.
    pub page: Option<HelpPage>,
    pub search: String,
    /// The entry of a reference that is shown in full, by its key.
    pub entry: Option<String>,
    /// The keyboard goes to the search field in the next frame.
    pub wants_focus: bool,
}

impl Help {
    /// Opens a page, with nothing looked for.
    pub fn open(&mut self, page: HelpPage) {
        *self = Self { page: Some(page), wants_focus: true, ..Self::default() };
    }
}
