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

/// MCP and RoboClaw.
pub(super) static MCP: SettingsWords = SettingsWords {
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

/// Motion Mind 3 (Motion Mind manual 5.8, 5.11 and 5.12).
pub(super) static MOTION_MIND: SettingsWords = SettingsWords {
    title: "Registers",
    many: "rows",
    save: "Store to EEPROM…",
    save_now: "Store",
    save_text: "Stores what the unit works with now, register by register, only those that differ or whose EEPROM is not known, \
                then makes the unit load its EEPROM and compares. The EEPROM lasts about a million writes: do not store in a loop.",
    save_warning: Some("The motor stops while the EEPROM is written, up to 40 ms for each register."),
    defaults: "Restore…",
    defaults_now: "Restore factory values",
    defaults_text: "Brings back the factory's values, in RAM and in EEPROM at once, then reads them. The unit answers to address 1 \
                    afterwards.",
    defaults_warning: Some(
        "The motor stops, and what the EEPROM held is lost. A backup of the registers is made first.",
    ),
    reload_text: "Load from EEPROM resets the unit, which loads its EEPROM as at power-up, then reads that. The motor stops. \
                  What the unit works with now and was not stored is lost.",
};
