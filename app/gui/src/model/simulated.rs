//! Which simulated controller the device list offers, and how its switches stand.

/// What is simulated. How the model's name, address and target follow from it, its family says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Simulated {
    /// A key of the models.
    pub model: String,
    /// Switches 2 to 4 of a board that has a mode.
    pub mode: u8,
    /// Switch 6 of such a board: lines of text in place of bytes.
    pub is_text: bool,
    /// What the first such unit answers to.
    pub address: u8,
    /// How many of them share the bus; the others follow the first one's address.
    pub units: u8,
}

impl Default for Simulated {
    fn default() -> Self {
        Self { model: "mcp266".to_owned(), mode: 4, is_text: false, address: 1, units: 1 }
    }
}
