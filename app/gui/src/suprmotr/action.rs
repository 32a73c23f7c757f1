//! What the screens of a SuprMotr ask for: its gains in RAM.

use brushwork_link::Message;
use brushwork_link::settings::SettingsImage;

use crate::family_action::{FamilyAction, Host};

/// Writes gains and the pace of moves to RAM, with a backup before, and reads them back.
#[derive(Debug)]
pub struct WriteGains(pub SettingsImage);

impl FamilyAction for WriteGains {
    fn act(&self, host: &mut dyn Host) -> Result<(), Message> {
        host.write_ram(self.0.clone())
    }
}
