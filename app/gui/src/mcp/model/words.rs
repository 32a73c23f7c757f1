//! How acts on the settings of an MCP are told.

use crate::family::SettingsWords;

/// MCP and RoboClaw.
pub(super) static WORDS: SettingsWords = SettingsWords {
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
