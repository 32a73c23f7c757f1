//! The EEPROM of a SuprMotr: UD stores all parameters, and a restart alone loads them.
//!
//! A restart (RT) loses the position and runs macro 0, so a save is not proven that way unless the user asks for it, and not where there is a
//! macro 0. What is stored is what reads as it was to be.

use super::rows::rows;
use crate::controller::values::RESTART;
use crate::messages::SuprMotrActMessage;
use brushwork_link::failure::Failure;
use brushwork_link::settings::await_unit;
use brushwork_link::settings::{ReadReport, read_all, went_out};
use brushwork_link::settings::{SaveReport, stored, unknown};
use brushwork_link::wire::Wire;
use brushwork_suprmotr_wire::Mnemonic;

/// Stores every setting as the controller works with it. An error means that nothing was stored.
pub fn save(wire: &mut dyn Wire, before: &ReadReport) -> Result<SaveReport, Failure> {
    if let Err(error) = wire.transact(Mnemonic::UD.number(), &[]) {
        let failure = error.failure(SuprMotrActMessage::Save, wire.describe());
        return if went_out(&error) { Ok(unknown(failure)) } else { Err(failure) };
    }
    Ok(match read_all(wire, *before.table.subject()) {
        Ok(after) => stored(before, &after),
        Err(failure) => unknown(failure),
    })
}

/// Starts the unit anew, which loads its EEPROM, and waits until it answers. Refused where a macro 0 would run.
pub fn reload(wire: &mut dyn Wire) -> Result<(), Failure> {
    wire.transact(RESTART, &[])
        .map_err(|error| error.failure(SuprMotrActMessage::Reload, wire.describe()))?;
    await_unit(wire, SuprMotrActMessage::Reload)
}

/// Writes the factory values, into RAM alone. The address stays.
pub fn restore(wire: &mut dyn Wire) -> Result<(), Failure> {
    for row in rows().iter().filter(|row| row.key != super::rows::ADDRESS) {
        let (Some(sink), Some(raw)) = (row.sink(), row.encode(row.default)) else { continue };
        wire.transact(sink.command, &[raw])
            .map_err(|error| error.failure(SuprMotrActMessage::Restore, wire.describe()))?;
    }
    Ok(())
}
