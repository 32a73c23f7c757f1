//! The CAN port seen from packet serial: commands 150, 151, 180 to 182, 190, 191.

use super::super::answer::{Answer, Arguments, Handlers, Named, find};
use super::super::can::{ACCESS_DONE, COMMAND_OBJECTS, CanFrame, CanObject};
use super::super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::{Direction, lookup, number};
use brushwork_values::{Value, Values};

pub(super) const HANDLERS: Handlers = &[
    (number::SET_NODE_ID, |unit, args| {
        unit.settings.unit.can_node_id = args.u8("node_id");
        Answer::Ack
    }),
    (number::READ_NODE_ID, |unit, _| Answer::ints([("node_id", unit.settings.unit.can_node_id.into())])),
    (number::READ_CAN_ERRORS, |unit, _| Answer::ints([("errors", unit.can.error_state().into())])),
    (number::PUT_CAN_PACKET, |unit, args| {
        let mut data = [0; 8];
        if let Some(bytes) = args.values.bytes("data") {
            data.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
        }
        let (cob_id, remote, length) = (args.u16("cob_id"), args.u8("rtr"), args.u8("length"));
        unit.can.put(CanFrame { cob_id, remote, length, data });
        Answer::Ack
    }),
    (number::GET_CAN_PACKET, |unit, _| {
        let received = unit.can.take();
        let present = received.is_some();
        Answer::Data(packet(present, &received.unwrap_or_default()))
    }),
    (number::WRITE_CAN_DICTIONARY, |unit, args| {
        let object = CanObject { value: args.u32("value"), size: args.u8("size") };
        let result = unit.can.write(args.u16("index"), args.u8("subindex"), object);
        Answer::ints([("result", result.into())])
    }),
    (number::READ_CAN_DICTIONARY, read_dictionary),
];

/// First byte of the answer to 182 where there was a message.
const PRESENT: i64 = 0xff;
/// CANopen data type UNSIGNED32. Assumed for every object.
const TYPE_UNSIGNED32: i64 = 0x07;

fn packet(present: bool, frame: &CanFrame) -> Vec<Named> {
    vec![
        ("present", Value::Int(if present { PRESENT } else { 0 })),
        ("cob_id", Value::Int(frame.cob_id.into())),
        ("rtr", Value::Int(frame.remote.into())),
        ("length", Value::Int(frame.length.into())),
        ("data", Value::Bytes(frame.data.to_vec())),
    ]
}

/// An entry that was written, or the present value of a packet serial command without arguments.
fn read_dictionary(unit: &mut Firmware, args: &Arguments<'_>) -> Answer {
    let (index, subindex) = (args.u16("index"), args.u8("subindex"));
    let found = match unit.can.read(index, subindex) {
        Ok(object) => Ok(object),
        Err(abort) => command_object(unit, index, subindex).ok_or(abort),
    };
    let (object, result) = match found {
        Ok(object) => (object, ACCESS_DONE),
        Err(abort) => (CanObject::default(), abort),
    };
    Answer::ints([
        ("value", object.value.into()),
        ("size", object.size.into()),
        ("type", TYPE_UNSIGNED32),
        ("result", result.into()),
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
    let Answer::Data(values) = unit.answer(number, &Values::default()) else { return None };
    let value = find(&values, field.name)?.as_int()?;
    Some(CanObject { value: value as u32, size: u8::try_from(field.kind.width()?).ok()? })
}
