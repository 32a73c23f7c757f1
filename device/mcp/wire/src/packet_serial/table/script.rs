//! Scripts and the firmware loader. The format of a compiled script is not public.

use super::super::command::{ClientUse, Command, Effect, Form, Reply, Simulated};
use super::super::field::{byte, field};
use super::super::name;
use super::super::number;
use super::{CLIENTS, G1, G4, MANUAL_ADVANCED, fields, forms, reads, sets, write, write_for};
use crate::models::Family;
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = &[
    manual(
        number::SET_SCRIPT_AUTORUN,
        "script autorun delay",
        sets![DELAY],
    )
    .note("A client of 2025 refuses to send 1 to 99."),
    manual(
        number::READ_SCRIPT_AUTORUN,
        "read script autorun delay",
        reads![DELAY],
    ),
    manual(number::START_SCRIPT, "start script", forms![write(G1, G4, Effect::Script, &[])]),
    manual(number::STOP_SCRIPT, "stop script", forms![write(G1, G4, Effect::Stop, &[])]),
    Command::new(number::ERASE_SCRIPT, "erase script", CLIENTS, ERASE).only(Family::Mcp),
    Command::new(number::WRITE_SCRIPT, "write script", CLIENTS, WRITE).only(Family::Mcp),
    Command::new(number::READ_SCRIPT, "read script", CLIENTS, &[])
        .simulated(Simulated::Silent("only the number is public, not the layout"))
        .client(ClientUse::Never("only the number is public, not the layout"))
        .only(Family::Mcp),
    Command::new(
        number::ENTER_LOADER,
        "enter firmware loader",
        CLIENTS,
        forms![write(G1, G4, Effect::Loader, LOADER)],
    )
    .note(
        "It ends packet serial: the unit restarts as a USB device of another name and waits for an image. Libraries do not \
         insist on the acknowledgement.",
    ),
];

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

const fn manual(number: u8, title: &'static str, forms: &'static [Form]) -> Command {
    // MCL is the MCP's (MCP manual 3.0.1): no RoboClaw manual has these numbers.
    Command::new(number, title, MANUAL_ADVANCED, forms).only(Family::Mcp)
}
