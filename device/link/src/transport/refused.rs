//! Why a serial port refuses, and what to do about it: rights, another program, no such device.

use super::ports::list_ports;
use crate::messages::PortMessage;
use std::path::Path;

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
pub(super) fn permission_remedy(path: &str) -> PortMessage {
    match owning_group(path) {
        Some(group) => PortMessage::JoinGroup { group },
        None => PortMessage::GiveRight,
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

/// The name of the group that owns a device, if it is not root's: whoever is in it may open the device.
#[cfg(unix)]
#[must_use]
pub fn owning_group(path: &str) -> Option<String> {
    use std::os::unix::fs::MetadataExt;
    let number = std::fs::metadata(path).ok()?.gid();
    let groups = std::fs::read_to_string("/etc/group").ok()?;
    group_name(&groups, number)
        .filter(|name| *name != "root")
        .map(str::to_owned)
        .or(Some("dialout".to_owned()))
}

/// Windows has no groups that own devices.
#[cfg(not(unix))]
#[must_use]
pub fn owning_group(_path: &str) -> Option<String> {
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
#[cfg(unix)]
mod tests {
    use super::*;

    #[test]
    fn the_group_of_a_device_is_named_with_the_command_that_joins_it() {
        let groups = "root:x:0:\ndialout:x:20:ann,bob\nbroken\n";
        assert_eq!(group_name(groups, 20), Some("dialout"));
        assert_eq!(group_name(groups, 21), None);
        let file = tempfile::NamedTempFile::new().unwrap();
        let remedy = permission_remedy(file.path().to_str().unwrap()).to_string();
        assert!(remedy.contains("sudo usermod -aG") && remedy.contains("log out"), "{remedy}");
    }
}
