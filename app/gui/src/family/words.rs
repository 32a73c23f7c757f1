//! What acts on settings are called in a family, and what they do to its controllers, in sentences.

/// The words of a family.
#[derive(Debug)]
pub struct SettingsWords {
    /// Heading of the screen.
    pub title: &'static str,
    /// What there are many of.
    pub many: &'static str,
    /// The button that keeps RAM over a power cycle, and what it says on its sheet.
    pub save: &'static str,
    pub save_now: &'static str,
    pub save_text: &'static str,
    /// What saving does to a motor that turns.
    pub save_warning: Option<&'static str>,
    /// The button that brings back the factory's values.
    pub defaults: &'static str,
    pub defaults_now: &'static str,
    pub defaults_text: &'static str,
    pub defaults_warning: Option<&'static str>,
    /// What loading the EEPROM does.
    pub reload_text: &'static str,
}
