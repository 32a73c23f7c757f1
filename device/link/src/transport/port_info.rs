//! What the system tells of a serial port, and whether that is a controller's USB.

use super::stream::Stream;
use crate::family::{UsbProduct, families};
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
    /// Whether the USB device calls itself a controller of any family.
    #[must_use]
    pub fn names_a_controller(&self) -> bool {
        self.usb_product() == Some(UsbProduct::Controller)
    }

    /// Whether the USB device is a controller that waits for firmware.
    #[must_use]
    pub fn is_loader(&self) -> bool {
        self.usb_product() == Some(UsbProduct::Loader)
    }

    fn usb_product(&self) -> Option<UsbProduct> {
        let product = self.product.as_deref()?;
        families().iter().find_map(|family| family.usb_product(product))
    }
}
