//! What is known of settings, as families are told it.

use brushwork_link::settings::SettingValue;

/// What is known of a setting, by its key.
pub type Known<'a> = &'a dyn Fn(&str) -> Option<SettingValue>;
