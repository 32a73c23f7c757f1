//! One named value of a coded field.

use std::fmt;

/// One named value of a coded field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Code {
    /// The number on the wire.
    pub raw: i64,
    /// Stable name for files and command lines: snake_case.
    pub key: &'static str,
    /// Name for people.
    pub label: &'static str,
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.label)
    }
}

/// The code with wire number `raw`.
pub fn by_raw(codes: &'static [Code], raw: i64) -> Option<&'static Code> {
    codes.iter().find(|code| code.raw == raw)
}

/// The code with key `key`.
pub fn by_key(codes: &'static [Code], key: &str) -> Option<&'static Code> {
    codes.iter().find(|code| code.key == key)
}
