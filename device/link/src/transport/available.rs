//! The serial ports that the `serialport` crate finds, with what USB says of each.

use super::port_info::PortInfo;
use super::stream::Stream;
use serialport::SerialPortType;
use std::io;

/// The ports the system lists; see [`list_ports`](super::list_ports), which guards this call.
pub(super) fn listed() -> Result<Vec<PortInfo>, io::Error> {
    let found = serialport::available_ports().map_err(io::Error::from)?;
    Ok(found.into_iter().map(|port| port_info(port.port_name, port.port_type)).collect())
}

fn port_info(name: String, kind: SerialPortType) -> PortInfo {
    let mut info = PortInfo { name, ..PortInfo::default() };
    match kind {
        SerialPortType::UsbPort(usb) => {
            info.is_usb = true;
            info.usb_id = Some((usb.vid, usb.pid));
            info.product = usb.product;
            info.manufacturer = usb.manufacturer;
            info.serial_number = usb.serial_number;
        }
        SerialPortType::BluetoothPort => info.product = Some("Bluetooth".to_owned()),
        SerialPortType::PciPort | SerialPortType::Unknown => {}
    }
    info.stream = info.names_a_controller().then_some(Stream::Usb);
    info
}
