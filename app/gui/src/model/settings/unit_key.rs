//! Which unit settings belong to.

use brushwork_link::device::Identity;

/// A unit, wherever the link to it is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct UnitKey {
    pub port: String,
    pub address: u8,
    pub version_text: String,
}

impl UnitKey {
    pub fn of(identity: &Identity) -> Self {
        Self {
            port: identity.port.clone(),
            address: identity.address,
            version_text: identity.version_text.clone(),
        }
    }
}
