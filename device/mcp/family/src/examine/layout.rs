//! How writes are taken that are not as the manual has them. What is written is what the registers hold already.

use super::{Asked, address, hear, with_crc};
use brushwork_family::examine::Examination;
use brushwork_link::device::{JobContext, Leave};
use brushwork_mcp_client::{TypedWire as _, layout_of};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::name::{D, I, P, QPPS};
use brushwork_mcp_wire::packet_serial::{ACK, Request, commands, give, number};
use brushwork_values::hex;
use serde_json::{Value, json};
use std::time::Duration;

/// After what may have been taken for half a packet, until the unit listens again: the gap, and some for both clocks.
const PAUSE: Duration = Duration::from_millis(25);
/// Bytes of a CRC.
const CRC: usize = 2;

/// Asks.
pub fn ask(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let usual = usual_write(context)?;
    acknowledgement(context, found, &usual)?;
    let (without_crc, _) = usual.split_at(usual.len() - CRC);
    let longer = with_quiet_crc(without_crc);
    let shorter = with_crc(without_crc[..without_crc.len() - 1].to_vec());
    let doubled = [&usual[..1], &usual].concat();
    for (key, bytes) in
        [("longer_payload", longer), ("shorter_payload", shorter), ("doubled_address", doubled)]
    {
        let (value, sentence) = taken(context, &bytes, &usual)?;
        found.answered(key, value, sentence);
    }
    legacy(context, found)
}

/// The write of the registers of motor 1's velocity loop as they are.
fn usual_write(context: &mut JobContext<'_>) -> Asked<Vec<u8>> {
    let held = context.ask(commands::READ_VELOCITY_PID_M1, &[])?;
    let given =
        [give(D, held.int(D)), give(P, held.int(P)), give(I, held.int(I)), give(QPPS, held.int(QPPS))];
    let generation = layout_of(context.generation());
    let request = Request::typed(address(context), commands::SET_VELOCITY_PID_M1, generation, &given);
    let bytes = request.and_then(|request| request.encode(generation));
    bytes.map_err(|error| brushwork_link::ExchangeError::Encode { why: error.to_string() })
}

/// The same with one byte more, whose CRC holds no byte that could be an address: whoever does not take the packet as a whole finds no
/// other one in what is left of it.
fn with_quiet_crc(bytes: &[u8]) -> Vec<u8> {
    let longer = |filler: u8| [bytes, &[filler]].concat();
    let is_quiet = |filler: &u8| crc16_xmodem(&longer(*filler)).to_be_bytes().iter().all(|byte| *byte < 0x80);
    with_crc(longer((0..0x80).find(is_quiet).unwrap_or(0)))
}

fn acknowledgement(context: &mut JobContext<'_>, found: &mut Examination, usual: &[u8]) -> Asked {
    let heard = hear(context, usual, Leave::Write)?;
    let sentence = match heard.bytes.as_slice() {
        [] => "Nothing.".to_owned(),
        [ACK] => "One byte FF, as the manual says.".to_owned(),
        bytes => format!("{}.", hex(bytes)),
    };
    found.answered("acknowledgement", json!(hex(&heard.bytes)), sentence);
    Ok(())
}

/// Whether a packet is taken, and what it has done to the registers.
fn taken(context: &mut JobContext<'_>, bytes: &[u8], usual: &[u8]) -> Asked<(Value, String)> {
    let heard = hear(context, bytes, Leave::Write)?;
    context.sleep(PAUSE)?;
    let is_unchanged = usual_write(context)? == usual;
    if !is_unchanged {
        hear(context, usual, Leave::Write)?;
    }
    let answer = match heard.bytes.as_slice() {
        [] => "silent",
        [ACK] => "acknowledged",
        _ => "answered otherwise",
    };
    let did = if is_unchanged {
        "the registers are as before"
    } else {
        "it changed the registers, which were put back"
    };
    Ok((json!({ "answer": answer, "changed": !is_unchanged }), format!("It is {answer}; {did}.")))
}

/// Whether the oldest commands are acknowledged: forward at power 0 is a stop.
fn legacy(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let bytes = with_crc(vec![address(context).get(), number::FORWARD_M1, 0]);
    let heard = hear(context, &bytes, Leave::Write)?;
    let is_acknowledged = heard.bytes == [ACK];
    let sentence = if is_acknowledged { "Yes." } else { "No: nothing comes back." };
    found.answered("legacy_acknowledgement", json!(is_acknowledged), sentence);
    Ok(())
}
