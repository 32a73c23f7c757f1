//! Scripts and the firmware loader. The format of a compiled script is not public.

use super::super::command::{ClientUse, Command, Effect, Form, Reply, Simulated};
use super::super::field::{byte, field};
use super::super::name;
use super::{CLIENTS, G1, G4, MANUAL_ADVANCED, fields, forms, reads, rows, sets, write, write_for};
use crate::models::Family;
use brushwork_values::{Field, Kind, Unit};

// MCL is the MCP's (MCP manual 3.0.1): no RoboClaw manual has these numbers.
pub(super) const ROWS: &[Command] = rows! {
    MANUAL_ADVANCED SET_SCRIPT_AUTORUN "script autorun delay" sets![DELAY], only Family::Mcp,
        note "A client of 2025 refuses to send 1 to 99.";
    MANUAL_ADVANCED READ_SCRIPT_AUTORUN "read script autorun delay" reads![DELAY], only Family::Mcp;
    MANUAL_ADVANCED START_SCRIPT "start script" forms![write(G1, G4, Effect::Script, &[])], only Family::Mcp;
    MANUAL_ADVANCED STOP_SCRIPT "stop script" forms![write(G1, G4, Effect::Stop, &[])], only Family::Mcp;
    CLIENTS ERASE_SCRIPT "erase script" ERASE, only Family::Mcp;
    CLIENTS WRITE_SCRIPT "write script" WRITE, only Family::Mcp;
    CLIENTS READ_SCRIPT "read script" &[],
        simulated Simulated::Silent("only the number is public, not the layout"),
        client ClientUse::Never("only the number is public, not the layout"), only Family::Mcp;
    CLIENTS ENTER_LOADER "enter firmware loader" forms![write(G1, G4, Effect::Loader, LOADER)],
        note "It ends packet serial: the unit restarts as a USB device of another name and waits for an image. Libraries do not \
         insist on the acknowledgement.";
};

const DELAY: Field = field(name::DELAY, Kind::U32, "time after a reset; below 100 the script is not run")
    .unit(Unit::Milliseconds);

/// The reply's second byte comes when the work is done; what it says is not public.
const STATUS: &[Field] =
    fields![byte(name::STATUS, "comes when the work is done; its meaning is not public")];

const ERASE: &[Form] = forms![write_for(
    G1,
    G4,
    Effect::Memory,
    fields![field(name::KEY, Kind::U16, "the key 55AA").unit(Unit::Bits).fixed(0x55AA)],
    Reply::AckThenStatus(STATUS)
)];

const WRITE: &[Form] = forms![write_for(
    G1,
    G4,
    Effect::Memory,
    fields![
        field(name::ADDRESS, Kind::U24, "place in the script memory").unit(Unit::Bits),
        field(name::DATA, Kind::Bytes(16), "four words of the compiled file, the bytes of each reversed"),
    ],
    Reply::AckThenStatus(STATUS)
)];

const LOADER: &[Field] = fields![
    byte(name::MARK, "always FF").unit(Unit::Bits).fixed(0xFF),
    field(name::KEY, Kind::U32, "the key A5A51234").unit(Unit::Bits).fixed(0xA5A5_1234),
];
