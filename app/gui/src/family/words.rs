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

/// The words of a family that has none of its own.
pub(super) static USUAL: SettingsWords = SettingsWords {
    title: "General Settings",
    many: "settings",
    save: "Save to EEPROM…",
    save_now: "Save",
    save_text: "Saves all settings that the controller works with now, loads them back and compares. The controller may \
                restart; motors must stand still.",
    save_warning: None,
    defaults: "Default…",
    defaults_now: "Restore defaults",
    defaults_text: "Makes the controller work with its factory settings, then reads them. They last only once they are saved \
                    to EEPROM.",
    defaults_warning: None,
    reload_text: "Load from EEPROM makes the controller take back what it saved last, then reads that. \
                  What it works with now and was not saved is lost.",
};
