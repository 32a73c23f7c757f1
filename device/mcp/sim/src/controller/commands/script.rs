//! Scripts and the firmware loader: commands 246 to 251, 255. Command 254 has no public layout and is never framed.

use super::super::answer::{Answer, Arguments, Handlers, On, tell};
use super::super::firmware::Firmware;
use super::super::loader::Loader;
use super::super::script::{BLOCK_WRITE_TIME, ERASE_TIME, STATUS_DONE, STATUS_NOT_DONE};
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::script_image::BLOCK_BYTES;
use brushwork_script::debug::StopCause;
use std::time::Duration;

pub(super) const HANDLERS: Handlers = &[
    &On(commands::SET_SCRIPT_AUTORUN, |unit, args| {
        unit.settings.unit.script_autorun_ms = args.u32(DELAY);
        Answer::Ack
    }),
    &On(commands::READ_SCRIPT_AUTORUN, |unit, _| {
        Answer::of([tell(DELAY, unit.settings.unit.script_autorun_ms.into())])
    }),
    &On(commands::START_SCRIPT, |unit, _| {
        let up_for = unit.up_for();
        match unit.script.start(&unit.memory.script, up_for) {
            Ok(()) => Answer::Ack,
            Err(_) => Answer::Refused,
        }
    }),
    &On(commands::STOP_SCRIPT, |unit, _| {
        unit.script.stop();
        Answer::Ack
    }),
    &On(commands::ERASE_SCRIPT, |unit, args| {
        if args.int_or(KEY, 0) != ERASE_KEY {
            return Answer::Silence;
        }
        unit.script.stop_for(StopCause::NewImage);
        unit.memory.script.erase();
        Answer::AckThenStatus { status: STATUS_DONE, after: ERASE_TIME }
    }),
    &On(commands::WRITE_SCRIPT, write_block),
    &On(commands::ENTER_LOADER, |unit, args| {
        if (args.int_or(MARK, 0), args.int_or(KEY, 0)) != (LOADER_MARK, LOADER_KEY) {
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

fn write_block<const L: u8>(unit: &mut Firmware, args: &Arguments<'_, L>) -> Answer<L> {
    let address = args.u32(ADDRESS) as usize;
    let block = args.bytes::<BLOCK_BYTES, _>(DATA);
    unit.script.stop_for(StopCause::NewImage);
    let is_stored = block.is_some_and(|block| unit.memory.script.write(address, block));
    let status = if is_stored { STATUS_DONE } else { STATUS_NOT_DONE };
    Answer::AckThenStatus { status, after: if is_stored { BLOCK_WRITE_TIME } else { Duration::ZERO } }
}
