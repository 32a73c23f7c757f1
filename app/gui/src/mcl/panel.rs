//! The panel below the text: one tab at a time.

/// What the panel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    #[default]
    Problems,
    Debugger,
    Terminal,
}

impl Tab {
    pub const ALL: [Self; 3] = [Self::Problems, Self::Debugger, Self::Terminal];

    pub const fn title(self) -> &'static str {
        match self {
            Self::Problems => "Problems",
            Self::Debugger => "Debugger",
            Self::Terminal => "Terminal",
        }
    }
}

/// The panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panel {
    pub open: bool,
    pub tab: Tab,
}

impl Default for Panel {
    fn default() -> Self {
        Self { open: true, tab: Tab::Problems }
    }
}

impl Panel {
    /// Shows a tab, or hides the panel if that tab is shown.
    pub fn press(&mut self, tab: Tab) {
        *self = Self { open: !(self.open && self.tab == tab), tab };
    }
}
