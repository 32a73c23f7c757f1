//! The system registers (MCP manual 3.1.15 and the pages of each): one table for compiler, machine, editor and reference.
//!
//! Where table and pages differ, the pages' spelling counts. SIGNALTICK, SIGNALITER and I2CERROR stand outside the table;
//! the size of SIGNALITER is assumed. The table gives SIGNALMINACTION and SIGNALMAXACTION a byte, but their values go to 0x8000,
//! so they are words here; it gives SIGNALPERCENT an unsigned word, but a signal goes both ways.

mod table;
mod values;

use super::words::{self, Known};
pub use table::{MISSPELT, REGISTERS, Register, RegisterId};
pub use values::{dispute, values};

/// The register of this name, in any case; the second part is true for a spelling of [`MISSPELT`].
#[must_use]
pub fn lookup(name: &str) -> Option<(RegisterId, bool)> {
    match words::known(name) {
        Some(Known::Register(id)) => Some((id, false)),
        Some(Known::Misspelt(id)) => Some((id, true)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_register_is_found_by_its_name_in_any_case() {
        for (index, register) in REGISTERS.iter().enumerate() {
            let (id, misspelt) = lookup(&register.name.to_lowercase()).unwrap();
            assert_eq!((usize::from(id.0), misspelt), (index, false), "{}", register.name);
        }
        assert_eq!(lookup("SINGALTIMEOUT").unwrap().0.row().name, "SIGNALTIMEOUT");
        assert!(lookup("SINGALTIMEOUT").unwrap().1);
        assert_eq!(lookup("SYSNOTHING"), None);
    }
}
