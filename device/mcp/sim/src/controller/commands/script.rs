//! Scripts and the firmware loader: commands 246 to 251, 255. Command 254 has no public layout and is never framed.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use super::super::loader::Loader;
use super::super::script::{BLOCK_WRITE_TIME, ERASE_TIME, STATUS_DONE, STATUS_NOT_DONE};
use brushwork_mcp_wire::packet_serial::number;
use brushwork_mcp_wire::script_image::BLOCK_BYTES;
use brushwork_script::debug::StopCause;
use std::time::Duration;

pub(super) const HANDLERS: Handlers = &[
    (number::SET_SCRIPT_AUTORUN, |unit, args| {
        unit.settings.unit.script_autorun_ms = args.u32("delay");
        Answer::Ack
    }),
    (number::READ_SCRIPT_AUTORUN, |unit, _| {
        Answer::ints([("delay", unit.settings.unit.script_autorun_ms.into())])
    }),
    (number::START_SCRIPT, |unit, _| {
        let up_for = unit.up_for();
        match unit.script.start(&unit.memory.script, up_for) {
            Ok(()) => Answer::Ack,
            Err(_) => Answer::Refused,
        }
    }),
    (number::STOP_SCRIPT, |unit, _| {
        unit.script.stop();
        Answer::Ack
    }),
    (number::ERASE_SCRIPT, |unit, args| {
        if args.int_or("key", 0) != ERASE_KEY {
            return Answer::Silence;
        }
        unit.script.stop_for(StopCause::NewImage);
        unit.memory.script.erase();
        Answer::AckThenStatus { status: STATUS_DONE, after: ERASE_TIME }
    }),
    (number::WRITE_SCRIPT, write_block),
    (number::ENTER_LOADER, |unit, args| {
        if (args.int_or("mark", 0), args.int_or("key", 0)) != (LOADER_MARK, LOADER_KEY) {
            return Answer::Silence;
        }
        unit.stop_both();
        unit.loader = Some(Loader::new(unit.model.family));
        Answer::Ack
    }),
];

/// Keys of 250 and 255 (public clients, 2015-2020).
const ERASE_KEY: i64 = 0x55aa;
const LOADER_MARK: i64 = 0xff;
const LOADER_KEY: i64 = 0xa5a5_1234;

fn write_block(unit: &mut Firmware, args: &Arguments<'_>) -> Answer {
    let address = args.u32("address") as usize;
    let block = args.values.bytes("data").and_then(|bytes| <[u8; BLOCK_BYTES]>::try_from(bytes).ok());
    unit.script.stop_for(StopCause::NewImage);
    let is_stored = block.is_some_and(|block| unit.memory.script.write(address, block));
    let status = if is_stored { STATUS_DONE } else { STATUS_NOT_DONE };
    Answer::AckThenStatus { status, after: if is_stored { BLOCK_WRITE_TIME } else { Duration::ZERO } }
}
