//! Which serial ports there are, which of them is a controller's USB, and what to do about a port that refuses.

use super::serial;
use super::target::Stream;
use crate::failure::Failure;
use brushwork_mcp_wire::loader::USB_NAME_PART;
use serde::Serialize;
use std::panic;
use std::path::Path;

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

/// The serial ports of this machine, sorted by name. Pseudo-terminals are never listed: any path may be typed instead.
pub fn list_ports() -> Result<Vec<PortInfo>, Failure> {
    // The list is made by a crate that panics where Linux has no such directory (in some containers).
    if cfg!(target_os = "linux") && !Path::new("/sys/class/tty").is_dir() {
        return Ok(Vec::new());
    }
    let failure = |came_back: &str| {
        Failure::new("list the serial ports", "", came_back, "Type the path of the port instead")
    };
    match panic::catch_unwind(serial::listed) {
        Ok(Ok(mut ports)) => {
            ports.sort_by(|a, b| a.name.cmp(&b.name));
            Ok(ports)
        }
        Ok(Err(error)) => Err(failure(&error.to_string())),
        Err(_) => Err(failure("the system's list cannot be read")),
    }
}

/// Which stream of a controller a port is, by its device name; `None` means that the user must be asked.
#[must_use]
pub fn stream_of(path: &str, ports: &[PortInfo]) -> Option<Stream> {
    let real = std::fs::canonicalize(path).ok();
    let real = real.as_ref().and_then(|real| real.to_str()).unwrap_or(path);
    ports.iter().find(|port| port.name == real || port.name == path).and_then(|port| port.stream)
}

/// Whether the system knows a device of that name.
pub(super) fn exists(path: &str) -> bool {
    if cfg!(windows) {
        let bare = path.trim_start_matches(r"\\.\");
        list_ports().is_ok_and(|ports| ports.iter().any(|port| port.name.eq_ignore_ascii_case(bare)))
    } else {
        Path::new(path).exists()
    }
}

/// What to do when opening is not allowed: the group that owns the device, and how to join it.
pub(super) fn permission_mend(path: &str) -> String {
    match owning_group(path) {
        Some(group) => format!(
            "The port belongs to the group {group}: run `sudo usermod -aG {group} $USER`, then log out and in again."
        ),
        None => "Give your user the right to open serial ports, then try again.".to_owned(),
    }
}

/// The program that holds a port open, with its process number, where this can be found out.
pub(super) fn holder(path: &str) -> Option<String> {
    let real = std::fs::canonicalize(path).ok()?;
    std::fs::read_dir("/proc").ok()?.flatten().find_map(|process| {
        let number: u32 = process.file_name().to_str()?.parse().ok()?;
        let files = std::fs::read_dir(process.path().join("fd")).ok()?;
        let holds =
            files.flatten().any(|file| std::fs::read_link(file.path()).is_ok_and(|target| target == real));
        let name = std::fs::read_to_string(process.path().join("comm")).unwrap_or_default();
        holds.then(|| format!("{} (process {number})", name.trim()))
    })
}

/// Whether the path is there and is a plain file or a directory.
#[cfg(unix)]
pub(super) fn is_no_device(path: &str) -> bool {
    use std::os::unix::fs::FileTypeExt;
    std::fs::metadata(path).is_ok_and(|data| !data.file_type().is_char_device())
}

/// Windows has no device files.
#[cfg(not(unix))]
pub(super) fn is_no_device(_path: &str) -> bool {
    false
}

/// The name of the group that owns a device, if it is not root's.
#[cfg(unix)]
fn owning_group(path: &str) -> Option<String> {
    use std::os::unix::fs::MetadataExt;
    let number = std::fs::metadata(path).ok()?.gid();
    let groups = std::fs::read_to_string("/etc/group").ok()?;
    group_name(&groups, number)
        .filter(|name| *name != "root")
        .map(str::to_owned)
        .or(Some("dialout".to_owned()))
}

#[cfg(not(unix))]
fn owning_group(_path: &str) -> Option<String> {
    None
}

/// Looks up a group in the text of /etc/group: `name:password:number:members`.
#[cfg(unix)]
fn group_name(groups: &str, number: u32) -> Option<&str> {
    groups.lines().find_map(|line| {
        let mut fields = line.split(':');
        let name = fields.next()?;
        (fields.nth(1)?.parse() == Ok(number)).then_some(name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn listing_ports_gives_a_list_or_a_sentence_and_never_panics() {
        match list_ports() {
            Ok(ports) => assert!(ports.iter().all(|port| !port.name.is_empty())),
            Err(failure) => assert!(failure.to_string().contains("Type the path")),
        }
    }

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

    #[test]
    fn the_stream_is_known_by_device_name_only() {
        let usb = PortInfo { name: "COM4".into(), stream: Some(Stream::Usb), ..PortInfo::default() };
        let adapter = PortInfo { name: "COM5".into(), ..PortInfo::default() };
        let ports = [usb, adapter];
        assert_eq!(stream_of("COM4", &ports), Some(Stream::Usb));
        assert_eq!(stream_of("COM5", &ports), None);
        assert_eq!(stream_of("/dev/pts/3", &ports), None);
    }

    #[cfg(unix)]
    #[test]
    fn the_group_of_a_device_is_named_with_the_command_that_joins_it() {
        let groups = "root:x:0:\ndialout:x:20:ann,bob\nbroken\n";
        assert_eq!(group_name(groups, 20), Some("dialout"));
        assert_eq!(group_name(groups, 21), None);
        let file = tempfile::NamedTempFile::new().unwrap();
        let mend = permission_mend(file.path().to_str().unwrap());
        assert!(mend.contains("sudo usermod -aG") && mend.contains("log out"), "{mend}");
    }
}
