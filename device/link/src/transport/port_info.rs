//! What the system tells of a serial port, and whether that is a controller's USB.

use super::stream::Stream;
use brushwork_mcp_wire::loader::USB_NAME_PART;
use serde::Serialize;

/// One serial port of this machine.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PortInfo {
    /// Path or COM name to open it by.
    pub name: String,
    /// Whether it hangs on USB (a controller's own USB or an adapter).
    pub is_usb: bool,
    /// USB vendor and product number.
    pub usb_id: Option<(u16, u16)>,
    /// What the device calls itself: "MCP266 2x60A", "FT232R USB UART".
    pub product: Option<String>,
    /// Who made it.
    pub manufacturer: Option<String>,
    /// Its serial number.
    pub serial_number: Option<String>,
    /// Which of the controller's streams it is, where the device name tells: the USB of a controller.
    pub stream: Option<Stream>,
}

impl PortInfo {
    /// Whether the USB device calls itself a controller of this family ("MCP266 2x60A", "USB Roboclaw 2x7A"; public clients,
    /// 2015-2019, list these names).
    #[must_use]
    pub fn names_a_controller(&self) -> bool {
        let product = self.product.as_deref().unwrap_or_default().to_ascii_lowercase();
        !self.is_loader()
            && (product.contains("roboclaw") || MCP_NAMES.iter().any(|name| product.contains(name)))
    }

    /// Whether the USB device is a controller of this family that waits for firmware ("MCP266ASTULDR"; public clients, 2015-2020).
    #[must_use]
    pub fn is_loader(&self) -> bool {
        self.product.as_deref().is_some_and(|product| product.to_ascii_uppercase().contains(USB_NAME_PART))
    }
}

/// Product names of the family's USB devices, in lower case. "mcp2" alone would also fit Microchip's USB-serial
/// chips such as the MCP2221.
const MCP_NAMES: [&str; 12] = [
    "mcp233", "mcp236", "mcp263", "mcp266", "mcp2123", "mcp2126", "mcp2163", "mcp2166", "mcp2206", "mcp2128",
    "mcp2168", "mcp 2x",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_controller_is_known_by_its_usb_name_and_an_adapter_is_not() {
        let named = |product: &str| {
            PortInfo { product: Some(product.to_owned()), ..PortInfo::default() }.names_a_controller()
        };
        for product in ["MCP266 2x60A", "MCP2166 2x160A", "USB Roboclaw 2x7A", "USB Roboclaw 2x15a"] {
            assert!(named(product), "{product}");
        }
        for product in ["FT232R USB UART", "MCP2221 USB-I2C/UART Combo", "CP2102 USB to UART", ""] {
            assert!(!named(product), "{product}");
        }
    }
}
