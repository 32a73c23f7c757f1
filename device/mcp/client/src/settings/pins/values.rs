//! The settings of one pin, wherever their values are looked up.

use brushwork_link::settings::SettingValue;

/// Where the values of settings are looked up, by key.
pub(crate) type Lookup<'a> = &'a dyn Fn(&str) -> Option<SettingValue>;

/// The settings of one pin, counted from 1, as some image or screen has them.
#[derive(Clone, Copy)]
pub(super) struct PinValues<'a> {
    get: Lookup<'a>,
    number: usize,
}

impl<'a> PinValues<'a> {
    pub(super) fn new(get: Lookup<'a>, number: usize) -> Self {
        Self { get, number }
    }

    pub(super) fn key(self, field: &str) -> String {
        format!("pin.{}.{field}", self.number)
    }

    pub(super) fn choice(self, field: &str) -> Option<&'static str> {
        choice(self.get, &self.key(field))
    }

    pub(super) fn is_on(self, field: &str) -> bool {
        (self.get)(&self.key(field)) == Some(SettingValue::Bool(true))
    }

    pub(super) fn number(self, field: &str) -> Option<f64> {
        let value = (self.get)(&self.key(field))?;
        value.number().or(value.int().map(|number| number as f64))
    }
}

/// The choice that stands under a key.
pub(crate) fn choice(get: Lookup<'_>, key: &str) -> Option<&'static str> {
    get(key)?.choice()
}
