//! The CAN bus seen from packet serial.

use super::super::command::{ClientUse, Command, Effect, Reply, Simulated};
use super::super::field::{byte, field};
use super::super::name;
use super::{CLIENTS, G3, G4, fields, forms, read, read_at, rows, write, write_for};
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    CLIENTS SET_NODE_ID "CANopen node id" forms![write(G3, G4, Effect::Setting, fields![NODE_ID])],
        simulated NO_BUS;
    CLIENTS READ_NODE_ID "read CANopen node id" forms![read(G3, G4, fields![NODE_ID])], simulated NO_BUS;
    CLIENTS READ_CAN_ERRORS "read CAN error state"
        forms![
            read(G4, G4, fields![field(name::ERRORS, Kind::U32, "the CAN error register").unit(Unit::Bits)])
                .assumed(CONTRADICT)
        ], simulated QUIET_BUS, client NEVER,
        note "The vendor's C++ library of 2025 reads one byte, the number of waiting messages.";
    CLIENTS PUT_CAN_PACKET "send CAN message" forms![write(G4, G4, Effect::Bus, MESSAGE)],
        simulated LOOP_BACK;
    CLIENTS GET_CAN_PACKET "read CAN message" forms![read(G4, G4, RECEIVED)], simulated LOOP_BACK,
        note "In the vendor's C++ library of 2025 a reply that does not start with 0xFF ends after that byte.";
    CLIENTS WRITE_CAN_DICTIONARY "write CANopen dictionary"
        forms![
            write_for(G4, G4, Effect::Bus, WRITE_ENTRY, Reply::AckThenData(fields![RESULT]))
                .assumed(CONTRADICT)
        ], simulated DICTIONARY, client NEVER,
        note "The vendor's C++ library of 2025 expects no acknowledgement before the result.";
    CLIENTS READ_CAN_DICTIONARY "read CANopen dictionary"
        forms![read_at(G4, G4, ENTRY, READ_ENTRY).assumed(CONTRADICT)], simulated DICTIONARY, client NEVER,
        note "The vendor's C++ library of 2025 appends a CRC and begins the reply's CRC again.";
};

const NO_BUS: Simulated =
    Simulated::StoredOnly("on a simulated CAN bus the unit answers to it from its next start on");
const QUIET_BUS: Simulated = Simulated::Inert("the simulated port is in loop-back and has no errors");
const LOOP_BACK: Simulated = Simulated::StoredOnly(
    "the port is in loop-back for packet serial, also on a simulated CAN bus: what is sent is what is received next",
);
const DICTIONARY: Simulated = Simulated::StoredOnly(
    "the dictionary keeps what is written to it; objects from 0x2000 on read as the command of that number",
);
const CONTRADICT: &str = "the vendor's Python and C++ libraries of 2025 contradict each other";
const NEVER: ClientUse = ClientUse::Never(CONTRADICT);

const NODE_ID: Field = byte(name::NODE_ID, "CANopen node id").range(1, 127);
const COB_ID: Field = field(name::COB_ID, Kind::U16, "identifier of the message").unit(Unit::Bits);
const RTR: Field = byte(name::RTR, "1 asks for the message instead of carrying it");
const LENGTH: Field = byte(name::LENGTH, "bytes used of the data").range(0, 8);
const DATA: Field = field(name::DATA, Kind::Bytes(8), "content, always eight bytes");
const MESSAGE: &[Field] = fields![COB_ID, RTR, LENGTH, DATA];
const RECEIVED: &[Field] =
    fields![byte(name::PRESENT, "0xFF if there was a message"), COB_ID, RTR, LENGTH, DATA];

const NODE: Field = byte(name::NODE, "node that owns the dictionary");
const ENTRY_INDEX: Field = field(name::INDEX, Kind::U16, "index of the entry").unit(Unit::Bits);
const SUBINDEX: Field = byte(name::SUBINDEX, "subindex of the entry");
const VALUE: Field = field(name::VALUE, Kind::U32, "value of the entry");
const SIZE: Field = byte(name::SIZE, "bytes used of the value");
const RESULT: Field = field(name::RESULT, Kind::U32, "0, or why it failed").unit(Unit::Bits);
const ENTRY: &[Field] = fields![NODE, ENTRY_INDEX, SUBINDEX];
const WRITE_ENTRY: &[Field] = fields![NODE, ENTRY_INDEX, SUBINDEX, VALUE, SIZE];
const READ_ENTRY: &[Field] = fields![VALUE, SIZE, byte(name::TYPE, "CANopen data type"), RESULT];
