//! The CAN port seen from packet serial: commands 150, 151, 180 to 182, 190, 191.

use super::super::answer::{Answer, AnyAnswer, Arguments, Handlers, On, find, tell, tell_value};
use super::super::can::{ACCESS_DONE, COMMAND_OBJECTS, CanFrame, CanObject};
use super::super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Direction, commands, lookup};
use brushwork_values::{Value, Values};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::SET_NODE_ID, |unit, args| {
        unit.settings.unit.can_node_id = args.u8(NODE_ID);
        Answer::Ack
    }),
    &On(commands::READ_NODE_ID, |unit, _| Answer::of([tell(NODE_ID, unit.settings.unit.can_node_id.into())])),
    &On(commands::READ_CAN_ERRORS, |unit, _| Answer::of([tell(ERRORS, unit.can.error_state().into())])),
    &On(commands::PUT_CAN_PACKET, |unit, args| {
        let data = args.bytes(DATA).unwrap_or_default();
        let (cob_id, remote, length) = (args.u16(COB_ID), args.u8(RTR), args.u8(LENGTH));
        unit.can.put(CanFrame { cob_id, remote, length, data });
        Answer::Ack
    }),
    &On(commands::GET_CAN_PACKET, |unit, _| {
        let received = unit.can.take();
        packet(received.is_some(), &received.unwrap_or_default())
    }),
    &On(commands::WRITE_CAN_DICTIONARY, |unit, args| {
        let object = CanObject { value: args.u32(VALUE), size: args.u8(SIZE) };
        let result = unit.can.write(args.u16(INDEX), args.u8(SUBINDEX), object);
        Answer::of([tell(RESULT, result.into())])
    }),
    &On(commands::READ_CAN_DICTIONARY, read_dictionary),
];

/// First byte of the answer to 182 where there was a message.
const THERE: i64 = 0xff;
/// CANopen data type UNSIGNED32. Assumed for every object.
const TYPE_UNSIGNED32: i64 = 0x07;

fn packet<const L: u8>(is_there: bool, frame: &CanFrame) -> Answer<L> {
    Answer::of([
        tell(PRESENT, if is_there { THERE } else { 0 }),
        tell(COB_ID, frame.cob_id.into()),
        tell(RTR, frame.remote.into()),
        tell(LENGTH, frame.length.into()),
        tell_value(DATA, Value::Bytes(frame.data.to_vec())),
    ])
}

/// An entry that was written, or the present value of a packet serial command without arguments.
fn read_dictionary<const L: u8>(unit: &mut Firmware, args: &Arguments<'_, L>) -> Answer<L> {
    let (index, subindex) = (args.u16(INDEX), args.u8(SUBINDEX));
    let found = match unit.can.read(index, subindex) {
        Ok(object) => Ok(object),
        Err(abort) => command_object(unit, index, subindex).ok_or(abort),
    };
    let (object, result) = match found {
        Ok(object) => (object, ACCESS_DONE),
        Err(abort) => (CanObject::default(), abort),
    };
    Answer::of([
        tell(VALUE, object.value.into()),
        tell(SIZE, object.size.into()),
        tell(TYPE, TYPE_UNSIGNED32),
        tell(RESULT, result.into()),
    ])
}

/// Object 0x2000 + command: its only field at sub-index 0, several fields from sub-index 1 on.
fn command_object(unit: &mut Firmware, index: u16, subindex: u8) -> Option<CanObject> {
    let number = u8::try_from(index.checked_sub(COMMAND_OBJECTS)?).ok()?;
    let form = lookup(number)?.form(unit.generation)?;
    if form.direction != Direction::Read || !form.request.is_empty() {
        return None;
    }
    let fields = form.reply.fields();
    let at = if fields.len() == 1 { usize::from(subindex) } else { usize::from(subindex).checked_sub(1)? };
    let field = fields.get(at)?;
    let AnyAnswer::Data(values) = unit.answer(number, &Values::default()) else { return None };
    let value = find(&values, field.name)?.as_int()?;
    Some(CanObject { value: value as u32, size: u8::try_from(field.kind.width()?).ok()? })
}
