//! Which serial ports there are, and which of them is a controller's USB.

pub use super::port_info::PortInfo;

use super::available;
use super::stream::Stream;
use crate::failure::Failure;
use crate::messages::{ActMessage, CauseMessage, RemedyMessage};
use brushwork_values::Message;
use std::panic;
use std::path::Path;

/// The serial ports of this machine, sorted by name. Pseudo-terminals are never listed: any path may be typed instead.
pub fn list_ports() -> Result<Vec<PortInfo>, Failure> {
    // The list is made by a crate that panics where Linux has no such directory (in some containers).
    if cfg!(target_os = "linux") && !Path::new("/sys/class/tty").is_dir() {
        return Ok(Vec::new());
    }
    let failure =
        |came_back: Message| Failure::new(ActMessage::ListPorts, "", came_back, RemedyMessage::TypePath);
    match panic::catch_unwind(available::listed) {
        Ok(Ok(mut ports)) => {
            ports.sort_by(|a, b| a.name.cmp(&b.name));
            Ok(ports)
        }
        Ok(Err(error)) => Err(failure(Message::error(error))),
        Err(_) => Err(failure(CauseMessage::ListUnreadable.into())),
    }
}

/// Which stream of a controller a port is, by its device name; `None` means that the user must be asked.
#[must_use]
pub fn stream_of(path: &str, ports: &[PortInfo]) -> Option<Stream> {
    let real = std::fs::canonicalize(path).ok();
    let real = real.as_ref().and_then(|real| real.to_str()).unwrap_or(path);
    ports.iter().find(|port| port.name == real || port.name == path).and_then(|port| port.stream)
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
    fn the_stream_is_known_by_device_name_only() {
        let usb = PortInfo { name: "COM4".into(), stream: Some(Stream::Usb), ..PortInfo::default() };
        let adapter = PortInfo { name: "COM5".into(), ..PortInfo::default() };
        let ports = [usb, adapter];
        assert_eq!(stream_of("COM4", &ports), Some(Stream::Usb));
        assert_eq!(stream_of("COM5", &ports), None);
        assert_eq!(stream_of("/dev/pts/3", &ports), None);
    }
}
