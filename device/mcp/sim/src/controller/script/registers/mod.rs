//! The system registers of scripts (MCP manual 3.1.15 and the pages behind it), bound to the firmware by their names.
//!
//! A write changes the setting in RAM, as the command of packet serial does that carries it; nothing is written to EEPROM.

mod motor;
mod signal;
mod stream;
mod system;

use super::ScriptHost;
use brushwork_script::mcl::registers::{REGISTERS, RegisterId};
use brushwork_script::mcl::words::register as lookup;
use std::sync::LazyLock;

/// Gives an element.
type Read = fn(&mut ScriptHost<'_>, usize) -> u32;
/// Sets an element. The value has only the bits that the register keeps, its sign spread.
type Write = fn(&mut ScriptHost<'_>, usize, u32);

/// One register by its name.
type Binding = (&'static str, Read, Option<Write>);

/// How one register is reached; none for a name that the table of registers lacks.
type Access = Option<(Read, Option<Write>)>;

static BOUND: LazyLock<[Access; REGISTERS.len()]> = LazyLock::new(|| {
    let mut bound = [None; REGISTERS.len()];
    for (name, read, write) in all() {
        if let Some((id, _)) = lookup(name) {
            bound[usize::from(id.0)] = Some((*read, *write));
        }
    }
    bound
});

fn all() -> impl Iterator<Item = &'static Binding> {
    [system::BINDINGS, motor::BINDINGS, stream::BINDINGS, signal::BINDINGS].into_iter().flatten()
}

/// An element of a register; one that the unit does not have is 0.
pub fn read(host: &mut ScriptHost<'_>, id: RegisterId, element: u8) -> u32 {
    match BOUND.get(usize::from(id.0)) {
        Some(Some((read, _))) => read(host, element.into()),
        _ => 0,
    }
}

/// Sets an element of a register; one that the unit does not have takes nothing.
pub fn write(host: &mut ScriptHost<'_>, id: RegisterId, element: u8, value: u32) {
    if let Some(Some((_, Some(write)))) = BOUND.get(usize::from(id.0)) {
        write(host, element.into(), value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_register_is_bound_once_and_only_what_is_writable_can_be_written() {
        assert_eq!(all().count(), REGISTERS.len());
        for (register, bound) in REGISTERS.iter().zip(&*BOUND) {
            let (_, write) = bound.unwrap_or_else(|| panic!("{} is not bound", register.name));
            assert_eq!(write.is_some(), register.writable, "{}", register.name);
        }
    }
}
