//! Reads whose layout is a guess, one at a time.

use super::{Asked, address, hear, if_answered, with_crc};
use brushwork_family::examine::Examination;
use brushwork_link::device::{JobContext, Leave};
use brushwork_mcp_client::leave_for;
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::name::NODE_ID;
use brushwork_mcp_wire::packet_serial::{COMMANDS, commands, number};
use serde_json::{Map, json};

/// The device type, which every CANopen node has.
const DEVICE_TYPE: [u8; 3] = [0x10, 0x00, 0];
/// Bytes of the two layouts of command 180 that libraries have, CRC included.
const ERROR_REGISTER: usize = 6;
const WAITING_MESSAGES: usize = 3;

/// Asks.
pub fn ask(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    relay_results(context, found)?;
    can_errors(context, found)?;
    can_dictionary(context, found)
}

/// The reads without arguments that are guesses, but for that of the CAN bus.
fn relay_results(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let mut widths = Map::new();
    let is_asked = |row: &&brushwork_mcp_wire::packet_serial::Command| {
        leave_for(row) == Some(Leave::Guess)
            && row.number != number::READ_CAN_ERRORS
            && row.forms.iter().all(|form| form.request.is_empty())
    };
    let mut sentences = Vec::new();
    for row in COMMANDS.iter().filter(is_asked) {
        let bytes = [address(context).get(), row.number];
        let heard = hear(context, &bytes, Leave::Guess)?;
        let bytes = heard.took.map(|_| heard.bytes.len());
        sentences.push(match (bytes, heard.bytes.len()) {
            (Some(bytes), _) => format!("{} came in {bytes} bytes with a CRC that fits", row.number),
            (None, 0) => format!("{} is not answered", row.number),
            (None, bytes) => format!("{} came in {bytes} bytes without a CRC that fits", row.number),
        });
        widths.insert(row.number.to_string(), json!(bytes));
    }
    found.answered("guessed_reads", widths.into(), sentences.join("; ") + ".");
    Ok(())
}

fn can_errors(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let bytes = [address(context).get(), number::READ_CAN_ERRORS];
    let heard = hear(context, &bytes, Leave::Guess)?;
    let bytes = heard.took.map(|_| heard.bytes.len());
    let sentence = match bytes {
        Some(ERROR_REGISTER) => "Four bytes and a CRC: an error register, as the Python library has it.",
        Some(WAITING_MESSAGES) => {
            "One byte and a CRC: the number of waiting messages, as the C++ library has it."
        }
        Some(_) => "It came in a width that no library has.",
        None if heard.bytes.is_empty() => "It is not answered.",
        None => "Something came whose CRC does not fit.",
    };
    found.answered("can_errors", json!(bytes), sentence);
    Ok(())
}

/// Reads the device type of the unit's own node, without and with a CRC behind the request.
fn can_dictionary(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let reply = if_answered(context.transact(number::READ_NODE_ID, &[]))?;
    let node =
        reply.and_then(|values| commands::READ_NODE_ID.reply(values)).map_or(1, |values| values.int(NODE_ID));
    let node = u8::try_from(node).unwrap_or(1);
    let own = address(context).get();
    let request = [&[own, number::READ_CAN_DICTIONARY, node][..], &DEVICE_TYPE].concat();
    for (has_crc, bytes) in [(false, request.clone()), (true, with_crc(request.clone()))] {
        let heard = hear(context, &bytes, Leave::Guess)?;
        if heard.bytes.is_empty() {
            continue;
        }
        let reply_crc = crc_of(&request, &heard.bytes);
        let (with, goes) =
            (if has_crc { "with" } else { "without" }, reply_crc.unwrap_or("fits neither way"));
        let sentence = format!(
            "A request {with} a CRC is answered in {} bytes; the reply's CRC {goes}.",
            heard.bytes.len()
        );
        let value = json!({ "request_crc": has_crc, "bytes": heard.bytes.len(), "reply_crc": reply_crc });
        found.answered("can_dictionary", value, sentence);
        return Ok(());
    }
    found.answered("can_dictionary", json!(null), "It is not answered, with a CRC or without.");
    Ok(())
}

/// How the CRC of a reply is counted.
fn crc_of(request: &[u8], reply: &[u8]) -> Option<&'static str> {
    let (data, crc) = reply.split_last_chunk::<2>()?;
    let fits = |before: &[u8]| crc16_xmodem(&[before, data].concat()) == u16::from_be_bytes(*crc);
    match () {
        () if fits(request) => Some("goes on from the request"),
        () if fits(&[]) => Some("restarts"),
        () => None,
    }
}
