//! The page of help that is open, and what is looked for in it.

/// A page of help.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum HelpPage {
    #[default]
    FirstSteps,
    Tuning,
    MotionMind,
    Settings,
    PacketSerial,
    Mcl,
    Shortcuts,
    About,
}

impl HelpPage {
    pub const ALL: [Self; 8] = [
        Self::FirstSteps,
        Self::Tuning,
        Self::MotionMind,
        Self::Settings,
        Self::PacketSerial,
        Self::Mcl,
        Self::Shortcuts,
        Self::About,
    ];

    pub const fn title(self) -> &'static str {
        match self {
            Self::FirstSteps => "First Steps",
            Self::Tuning => "Tuning",
            Self::MotionMind => "Motion Mind 3",
            Self::Settings => "Settings Reference",
            Self::PacketSerial => "Packet Serial Reference",
            Self::Mcl => "MCL Reference",
            Self::Shortcuts => "Keyboard Shortcuts",
            Self::About => "About Brushwork",
        }
    }

    /// Whether the page is long enough to be searched.
    pub const fn is_searched(self) -> bool {
        matches!(self, Self::MotionMind | Self::Settings | Self::PacketSerial | Self::Mcl | Self::Shortcuts)
    }
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
