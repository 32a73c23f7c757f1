//! Registers by their numbers: in the mask of a read, in its reply, and what FUNCTION makes units return.

use brushwork_motion_mind_wire::{Reply, Returns, register};

/// The mask of READ for some registers.
pub fn mask(numbers: &[u8]) -> u32 {
    numbers.iter().filter_map(|number| register(*number)).fold(0, |mask, row| mask | row.mask())
}

/// The value of a register in a reply.
pub fn value_in(reply: &Reply, index: u8) -> Option<i64> {
    let Reply::Registers(registers) = reply else { return None };
    registers.iter().find(|(number, _)| *number == index).map(|(_, value)| *value)
}

/// The return bits of a FUNCTION register.
pub fn returns_of(function: i64) -> Returns {
    Returns::of_function(u16::try_from(function).unwrap_or_default())
}

/// Every set of return bits that a unit may have.
pub fn all_returns() -> [Returns; 8] {
    std::array::from_fn(|bits| Returns {
        position: bits & 1 != 0,
        velocity: bits & 2 != 0,
        time: bits & 4 != 0,
    })
}
