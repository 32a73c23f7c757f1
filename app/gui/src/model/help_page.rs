//! One page of help: what it is called and where it stands.

/// A page of help.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct HelpPage {
    pub title: &'static str,
    /// Pages of a group stand together, as in the menu.
    pub group: u8,
    /// Whether the page is long enough to be searched.
    pub is_searched: bool,
}

impl HelpPage {
    pub const FIRST_STEPS: Self = Self { title: "First Steps", group: 0, is_searched: false };
    pub const TUNING: Self = Self { title: "Tuning", group: 0, is_searched: false };
    pub const SHORTCUTS: Self = Self { title: "Keyboard Shortcuts", group: 2, is_searched: true };
    pub const ABOUT: Self = Self { title: "About Brushwork", group: 3, is_searched: false };
}
