//! The family by name, and the way between shared names of units and those of packet serial.

use crate::McpFacts;
use brushwork_link::device::Identity;
use brushwork_link::family::{Family, FamilyRef, Model, UsbProduct};
use brushwork_link::settings::Subject;
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_mcp_wire::loader::USB_NAME_PART;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use std::sync::LazyLock;

/// MCP and RoboClaw controllers.
pub const MCP: FamilyRef = FamilyRef::new(&Mcp);

#[derive(Debug)]
struct Mcp;

/// Those of the manuals' lists.
static LISTED: LazyLock<Vec<Model>> = LazyLock::new(|| models::MODELS.iter().map(shared).collect());
/// Boards that no manual lists.
static UNLISTED: LazyLock<Vec<Model>> = LazyLock::new(|| models::UNLISTED.iter().map(shared).collect());

fn shared(model: &models::Model) -> Model {
    Model {
        key: model.key,
        name: model.name,
        rating: model.rating(),
        family: MCP,
        pins: model.pins.iter().map(|pin| pin.label).collect(),
        streams: model.streams,
        douts: model.douts,
    }
}

impl Family for Mcp {
    fn key(&self) -> &'static str {
        "mcp"
    }

    fn label(&self) -> &'static str {
        "MCP or RoboClaw"
    }

    /// The default of the family (public clients, 2015-2025).
    fn default_baud(&self) -> u32 {
        38_400
    }

    fn models(&self) -> &'static [Model] {
        &LISTED
    }

    fn model(&self, name: &str) -> Option<&'static Model> {
        let key = models::lookup(name)?.key;
        LISTED.iter().chain(UNLISTED.iter()).find(|model| model.key == key)
    }

    fn identify(&self, version_text: &str) -> Option<&'static Model> {
        self.model(models::identify(version_text)?.key)
    }

    fn has_address(&self, number: u8) -> bool {
        Address::new(number).is_some()
    }

    fn addresses(&self) -> &'static str {
        "0x80 to 0x87"
    }

    fn factory_address(&self) -> u8 {
        Address::DEFAULT.get()
    }

    fn address_text(&self, number: u8) -> String {
        format!("0x{number:02X}")
    }

    fn check_generation(&self, number: i64) -> Result<u8, &'static str> {
        let generation = u8::try_from(number).ok().and_then(Generation::from_number);
        generation.map(Generation::number).ok_or("is no firmware generation; there are 1 to 4")
    }

    fn generation_text(&self, number: u8) -> String {
        Generation::from_number(number).map_or_else(|| number.to_string(), |known| known.to_string())
    }

    fn is_on_can_buses(&self) -> bool {
        true
    }

    /// Names of USB devices: "MCP266 2x60A", "USB Roboclaw 2x7A"; in the loader "MCP266ASTULDR" (public clients, 2015-2020).
    fn usb_product(&self, name: &str) -> Option<UsbProduct> {
        if name.to_ascii_uppercase().contains(USB_NAME_PART) {
            return Some(UsbProduct::Loader);
        }
        let name = name.to_ascii_lowercase();
        let is_named = name.contains("roboclaw") || USB_NAMES.iter().any(|known| name.contains(known));
        is_named.then_some(UsbProduct::Controller)
    }
}

/// Product names of the family's USB devices, in lower case. "mcp2" alone would also fit Microchip's USB-serial
/// chips such as the MCP2221.
const USB_NAMES: [&str; 12] = [
    "mcp233", "mcp236", "mcp263", "mcp266", "mcp2123", "mcp2126", "mcp2163", "mcp2166", "mcp2206", "mcp2128",
    "mcp2168", "mcp 2x",
];

/// A unit of packet serial as shared code names it.
#[must_use]
pub fn unit_address(address: Address) -> UnitAddress {
    UnitAddress::new(MCP, address.get()).unwrap_or(UnitAddress::factory(MCP))
}

/// The address as packet serial has it; `None` for units of other families.
#[must_use]
pub fn packet_address(address: UnitAddress) -> Option<Address> {
    Address::new(address.get()).filter(|_| address.family() == MCP)
}

/// A generation as shared code names it.
#[must_use]
pub fn firmware_of(generation: Generation) -> FirmwareGeneration {
    FirmwareGeneration::new(MCP, generation.number())
}

/// The generation of packet serial; `None` for other families.
#[must_use]
pub fn packet_generation(firmware: FirmwareGeneration) -> Option<Generation> {
    Generation::from_number(firmware.number()).filter(|_| firmware.family() == MCP)
}

/// The generation whose layouts packets have. Only for code that speaks packet serial and nothing else; another family's
/// unit would get those of the first.
#[must_use]
pub fn layout_of(firmware: FirmwareGeneration) -> Generation {
    packet_generation(firmware).unwrap_or(Generation::Gen1)
}

/// What a settings table is made for.
///
/// # Panics
/// Never: every model of the wire is one of the family.
#[must_use]
pub fn subject(model: &models::Model, generation: Generation) -> Subject {
    let model = Mcp.model(model.key).expect("every model of the wire is one of the family");
    Subject::new(model, firmware_of(generation))
}

/// The model with its ratings and pins; `None` for other families.
#[must_use]
pub fn model_of(subject: &Subject) -> Option<&'static models::Model> {
    models::lookup(subject.model.key)
}

/// Whether a unit is an MCP rather than a RoboClaw.
#[must_use]
pub fn is_mcp(identity: &Identity) -> bool {
    identity.facts.get::<McpFacts>().is_some_and(|facts| facts.is_mcp)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_controller_is_known_by_its_usb_name_and_an_adapter_is_not() {
        for product in ["MCP266 2x60A", "MCP2166 2x160A", "USB Roboclaw 2x7A", "USB Roboclaw 2x15a"] {
            assert_eq!(Mcp.usb_product(product), Some(UsbProduct::Controller), "{product}");
        }
        for product in ["FT232R USB UART", "MCP2221 USB-I2C/UART Combo", "CP2102 USB to UART", ""] {
            assert_eq!(Mcp.usb_product(product), None, "{product}");
        }
    }

    #[test]
    fn an_address_is_written_as_packet_serial_writes_it_and_read_again() {
        for (number, text) in [(0x80, "0x80"), (0x87, "0x87")] {
            let address = UnitAddress::new(MCP, number).unwrap();
            assert_eq!(address.to_string(), text);
            assert_eq!(UnitAddress::parse(MCP, text), Some(address));
        }
        for number in [0, 1, 0x7F, 0x88, 255] {
            assert_eq!(UnitAddress::new(MCP, number), None, "{number} is nobody's");
        }
    }
}
