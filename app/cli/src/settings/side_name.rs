//! The copies of a controller's settings that `brushwork settings compare` can name.

use std::path::PathBuf;
use std::str::FromStr;

/// One of the copies of a controller's settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SideName {
    /// What the controller works with.
    Ram,
    /// What its EEPROM held when that was proven last.
    Eeprom,
    /// What restoring the defaults would give, as far as known.
    Default,
    /// The newest backup, or the one of that name.
    Backup(Option<String>),
    /// A profile's file.
    File(PathBuf),
}

impl FromStr for SideName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(match text {
            "ram" => Self::Ram,
            "eeprom" => Self::Eeprom,
            "default" | "defaults" => Self::Default,
            "backup" => Self::Backup(None),
            _ => match text.strip_prefix("backup:") {
                Some(name) => Self::Backup(Some(name.to_owned())),
                None => Self::File(PathBuf::from(text)),
            },
        })
    }
}

impl SideName {
    /// Whether the controller itself has to be asked.
    pub fn needs_controller(&self) -> bool {
        matches!(self, Self::Ram | Self::Eeprom | Self::Backup(None))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_is_a_copy_a_backup_or_a_file() {
        let parse = |text: &str| text.parse::<SideName>().unwrap();
        assert_eq!(parse("ram"), SideName::Ram);
        assert_eq!(parse("backup"), SideName::Backup(None));
        assert_eq!(parse("backup:x"), SideName::Backup(Some("x".to_owned())));
        assert_eq!(parse("cart.json"), SideName::File(PathBuf::from("cart.json")));
    }
}
