//! Which controller something was kept of, as far as a computer can tell one from another.

use brushwork_link::family::model_named;
use brushwork_link::files::process_id;
use brushwork_link::{Identity, PortInfo, Profile, SettingsImage, Subject, UnitAddress};

use super::today::today;

/// How the names of files begin that are for one process alone.
pub(super) const OWNER: &str = "process-";

/// What tells a unit from others: its model, its address, and the serial number of its USB device or else the port
/// it is at.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct UnitId {
    /// The model's key: "mcp266".
    pub model: String,
    /// A serial number, or a port's name.
    pub place: String,
    /// Whether the place is a serial number.
    pub has_serial_number: bool,
    /// Its address.
    pub address: u8,
    /// Whether it is simulated in this program and gone with it.
    pub is_simulated: bool,
}

impl UnitId {
    /// The unit that answered. `ports` gives the serial number of the port's USB device, where it has one.
    pub fn new(identity: &Identity, ports: &[PortInfo]) -> Self {
        let path = identity.port.split(',').next().unwrap_or_default();
        let real = std::fs::canonicalize(path).ok();
        let real = real.as_ref().and_then(|real| real.to_str()).unwrap_or(path);
        let port = ports.iter().find(|port| port.name == real || port.name == path);
        let serial =
            port.and_then(|port| port.serial_number.clone()).filter(|serial| !serial.trim().is_empty());
        Self {
            model: identity.subject().map_or("unknown", |subject| subject.model.key).to_owned(),
            has_serial_number: serial.is_some(),
            place: serial.unwrap_or_else(|| identity.port.clone()),
            address: identity.address,
            is_simulated: identity.simulated,
        }
    }

    /// A name for files.
    pub fn file_name(&self) -> String {
        let safe = |letter: char| if letter.is_ascii_alphanumeric() || letter == '.' { letter } else { '-' };
        let place: String = self.place.chars().map(safe).collect();
        // Long names are cut; two ports whose names agree that far would share their files.
        let place: String = place.trim_matches('-').chars().take(80).collect();
        format!("{}-{:#04x}-{place}", self.model, self.address)
    }

    /// How the names of files begin that are about the present of this unit: one that is simulated in this program
    /// is gone with it, and the next of that name is another one.
    pub(super) fn owner(&self) -> String {
        if self.is_simulated { format!("{OWNER}{}-", process_id()) } else { String::new() }
    }

    /// Whether a profile was taken of this unit, or could have been before it got another address.
    pub fn is_of(&self, profile: &Profile) -> bool {
        self.model == profile.subject.model.key && self.place == profile.unit
    }

    /// "MCP266 at 0x80, serial number 1234".
    pub fn describe(&self) -> String {
        let model = model_named(&self.model).map_or(self.model.as_str(), |model| model.name);
        let place = if self.has_serial_number {
            format!("serial number {}", self.place)
        } else {
            format!("port {}", self.place)
        };
        format!("{model} at {:#04x}, {place}", self.address)
    }

    /// How far the identification can be trusted, in a sentence.
    pub fn limits(&self) -> &'static str {
        if self.has_serial_number {
            "Counted on this computer by model, USB serial number and address; what others saved is not in it."
        } else {
            "Counted on this computer by model, port and address, since the port tells no serial number: another unit \
             at this port counts as the same, this unit at another port as another; what others saved is not in it."
        }
    }
}

/// Values as a profile of now. `place` tells which unit it is, where that is known; `firmware` is what the unit says of itself.
pub fn profile_of(
    subject: Subject,
    address: UnitAddress,
    firmware: &str,
    place: &str,
    settings: SettingsImage,
) -> Profile {
    let (firmware, unit) = (firmware.trim_end().to_owned(), place.to_owned());
    Profile { subject, firmware, address, date: today(), unit, note: String::new(), settings }
}
