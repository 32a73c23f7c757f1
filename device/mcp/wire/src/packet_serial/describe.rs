//! The traffic decoder: packets in words, with physical units.
//!
//! A request reads "0x80 M1 velocity PID: P 1.0, I 0.5, D 0.25, QPPS 44000", a reply "0x80 read main battery: 24.3 V".

use super::command::Command;
use super::framer::{Discarded, Framed, FramerEvent};
use super::identity::{Address, Generation};
use super::request::Request;
use super::status;
use brushwork_values::hex;
use brushwork_values::{Field, Kind, Unit};
use brushwork_values::{Value, Values};

/// What a request asks of a controller of `generation`.
pub fn describe_request(request: &Request, generation: Generation) -> String {
    match (request.row(), request.arguments(generation)) {
        (Some(command), Ok(values)) => sentence(request.address, command, &values, generation),
        (Some(command), Err(error)) => format!("{} {}: {error}", request.address, command.title(generation)),
        (None, _) => format!("{} unknown command {}", request.address, request.command),
    }
}

/// What a controller of `generation` answered to `request`. No values stand for a plain acknowledgement.
pub fn describe_reply(request: &Request, values: &Values, generation: Generation) -> String {
    let Some(command) = request.row() else {
        return format!("{} reply to unknown command {}", request.address, request.command);
    };
    if values.is_empty() {
        return format!("{} {}: acknowledged", request.address, command.title(generation));
    }
    sentence(request.address, command, values, generation)
}

/// What a controller's framer found.
pub fn describe_event(event: &FramerEvent, generation: Generation) -> String {
    match event {
        FramerEvent::Request(framed) => describe_framed(framed, generation),
        FramerEvent::Discarded(discarded) => describe_discarded(discarded),
    }
}

/// A request as it came, which may have the layout of another generation.
pub fn describe_framed(framed: &Framed, generation: Generation) -> String {
    sentence(framed.address, framed.command, &framed.values, generation)
}

/// Bytes that were no request.
pub fn describe_discarded(discarded: &Discarded) -> String {
    format!("dropped {}: {}", hex(&discarded.bytes), discarded.why)
}

/// All values with their names and units, "P 1.0, I 0.5"; a single one without its name.
pub fn describe_values(values: &Values, generation: Generation) -> String {
    let mut shown: Vec<_> = values.iter().collect();
    shown.sort_by_key(|(field, _)| field.rank);
    if let [(field, value)] = shown.as_slice() {
        return describe_value(field, value, generation);
    }
    let parts: Vec<String> = shown
        .into_iter()
        .map(|(field, value)| format!("{} {}", label(field), describe_value(field, value, generation)))
        .collect();
    parts.join(", ")
}

/// One value with its unit: "24.3 V".
pub fn describe_value(field: &Field, value: &Value, generation: Generation) -> String {
    match value {
        Value::Int(raw) => describe_int(field, *raw, generation),
        Value::Text(text) => format!("{text:?}"),
        Value::Bytes(bytes) => hex(bytes),
        Value::Records(records) => describe_records(field, records, generation),
    }
}

/// What a field is called: its label, or its name in words ("accel_m1" is "accel M1").
pub fn label(field: &Field) -> String {
    if !field.label.is_empty() {
        return field.label.to_owned();
    }
    let words = field.name.split('_').map(|word| match word {
        "m1" => "M1",
        "m2" => "M2",
        other => other,
    });
    words.collect::<Vec<_>>().join(" ")
}

fn sentence(address: Address, command: &Command, values: &Values, generation: Generation) -> String {
    let title = command.title(generation);
    if values.is_empty() {
        return format!("{address} {title}");
    }
    format!("{address} {title}: {}", describe_values(values, generation))
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn describe_int(field: &Field, raw: i64, generation: Generation) -> String {
    if let Some(code) = brushwork_values::by_raw(field.codes, raw) {
        return code.label.to_owned();
    }
    match field.unit {
        Unit::Bits => bits(field, raw),
        Unit::Status => describe_status(field, raw, generation),
        Unit::None => raw.to_string(),
        unit => {
            let number = decimal(field.physical(raw), field.decimals, trims(unit));
            let space = if unit.symbol().is_empty() { "" } else { " " };
            format!("{number}{space}{}", unit.symbol())
        }
    }
}

fn bits(field: &Field, raw: i64) -> String {
    let digits = field.kind.width().unwrap_or(0) * 2;
    format!("0x{raw:0digits$X}")
}

fn describe_status(field: &Field, raw: i64, generation: Generation) -> String {
    let word = raw as u32;
    let conditions = status::decode(word, generation);
    let unknown = status::unknown_bits(word, generation);
    let rest = if unknown == 0 { String::new() } else { format!(", unknown bits 0x{unknown:X}") };
    format!("{} ({conditions}{rest})", bits(field, raw))
}

fn describe_records(field: &Field, records: &[Vec<i64>], generation: Generation) -> String {
    let Kind::Counted(fields) = field.kind else {
        return format!("{records:?}");
    };
    let record = |ints: &Vec<i64>| {
        let values = ints.iter().map(|&int| Value::Int(int)).collect();
        describe_values(&Values::new(fields, values), generation)
    };
    let records: Vec<String> = records.iter().map(record).collect();
    format!("{} × [{}]", records.len(), records.join("; "))
}

/// Units whose numbers lose the zeros at their end, down to one decimal.
const fn trims(unit: Unit) -> bool {
    matches!(
        unit,
        Unit::Gain | Unit::Percent | Unit::PercentPerSecond | Unit::Henries | Unit::Ohms | Unit::Seconds
    )
}

fn decimal(number: f64, decimals: u8, trim: bool) -> String {
    let mut text = format!("{number:.*}", usize::from(decimals));
    if trim && text.contains('.') {
        let short = text.trim_end_matches('0').len();
        let point = text.find('.').unwrap_or(0);
        text.truncate(short.max(point + 2));
    }
    let is_zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    match text.strip_prefix('-') {
        Some(positive) if is_zero => positive.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{COMMANDS, number, parse_reply};
    use super::*;
    use crate::packet_serial::{ReplyProgress, encode_reply, framer::RequestFramer};

    const GEN1: Generation = Generation::Gen1;

    fn reported(number: u8, values: &[i64]) -> String {
        describe_request(&Request::new(Address::DEFAULT, number, values), GEN1)
    }

    fn answered(number: u8, generation: Generation, values: &[Value]) -> String {
        let request = Request::new(Address::DEFAULT, number, &[]);
        let bytes = encode_reply(&request, generation, values).expect("fits");
        match parse_reply(&request, generation, &bytes) {
            ReplyProgress::Done { values, .. } => describe_reply(&request, &values, generation),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn requests_read_as_sentences_with_units() {
        // The wire order of the gains is D, P, I.
        let pid = reported(number::SET_VELOCITY_PID_M1, &[0x4000, 0x10000, 0x8000, 44_000]);
        assert_eq!(pid, "0x80 M1 velocity PID: P 1.0, I 0.5, D 0.25, QPPS 44000");
        assert_eq!(reported(number::READ_MAIN_BATTERY, &[]), "0x80 read main battery");
        assert_eq!(reported(number::DUTY_M1, &[16_384]), "0x80 M1 duty: 50.0 %");
        assert_eq!(
            reported(number::DUTY_BOTH, &[32_767, -32_767]),
            "0x80 duty: duty M1 100.0 %, duty M2 -100.0 %"
        );
        assert_eq!(reported(number::DUTY_M1, &[-1]), "0x80 M1 duty: 0.0 %");
        assert_eq!(
            reported(number::DUTY_ACCEL_M2, &[3277, 655_359]),
            "0x80 M2 duty with acceleration: duty 10.0 %, accel 2000.0 %/s"
        );
        assert_eq!(
            reported(number::SPEED_DISTANCE_M1, &[-1200, 5000, 1]),
            "0x80 M1 distance: speed -1200 counts/s, distance 5000 counts, buffer 1"
        );
        assert_eq!(
            reported(number::SET_MAIN_VOLTAGES, &[100, 340]),
            "0x80 main voltage limits: min 10.0 V, max 34.0 V"
        );
        assert_eq!(
            reported(number::SET_STREAM, &[1, 1, 38_400, 1000]),
            "0x80 stream properties: index RS-232 (UART0), type Packet serial, rate 38400 bit/s, timeout 1000 ms"
        );
        assert_eq!(
            reported(number::SET_INDUCTANCE_RESISTANCE_M1, &[10_066, 1_677_722]),
            "0x80 M1 inductance and resistance: L 0.0006 H, R 0.1 Ω"
        );
        assert_eq!(reported(number::SAVE_SETTINGS, &[]), "0x80 save settings: 0xE22EAB7A");
    }

    #[test]
    fn replies_read_as_sentences_with_units() {
        let int = Value::Int;
        assert_eq!(answered(number::READ_MAIN_BATTERY, GEN1, &[int(243)]), "0x80 read main battery: 24.3 V");
        assert_eq!(
            answered(number::READ_CURRENTS, GEN1, &[int(150), int(-5)]),
            "0x80 read motor currents: current M1 1.50 A, current M2 -0.05 A"
        );
        assert_eq!(
            answered(number::READ_TEMPERATURE_1, GEN1, &[int(-12)]),
            "0x80 read temperature 1: -1.2 °C"
        );
        assert_eq!(
            answered(number::READ_VERSION, GEN1, &["MCP266 2x60A v1.0.0".into()]),
            "0x80 read version: \"MCP266 2x60A v1.0.0\""
        );
        assert_eq!(answered(number::READ_STATUS, GEN1, &[int(4)]), "0x80 read status: 0x0004 (E-Stop)");
        assert_eq!(
            answered(number::READ_STATUS, Generation::Gen3, &[int(0x4001)]),
            "0x80 read status: 0x00004001 (E-Stop, unknown bits 0x4000)"
        );
        assert_eq!(
            answered(number::READ_DOUT_ACTIONS, GEN1, &[Value::Records(vec![vec![7], vec![99]])]),
            "0x80 read digital output actions: 2 × [Over voltage; 99]"
        );
        assert_eq!(answered(number::RESET_ENCODERS, GEN1, &[]), "0x80 zero both encoders: acknowledged");
    }

    #[test]
    fn what_cannot_be_read_is_told_too() {
        assert_eq!(reported(169, &[]), "0x80 unknown command 169");
        assert_eq!(
            reported(number::READ_ALL_STATUS, &[]),
            "0x80 read all status: firmware of generation 1 has no command 73"
        );
        assert_eq!(
            reported(number::DUTY_M1, &[]),
            "0x80 M1 duty: wrong number of values for command 32: 0 given, 1 expected"
        );
        let mut framer = RequestFramer::new(GEN1);
        let now = std::time::Duration::ZERO;
        let events: Vec<FramerEvent> =
            [0x11, 0x80, 0x18].into_iter().filter_map(|byte| framer.feed(byte, now)).collect();
        let reported: Vec<String> = events.iter().map(|event| describe_event(event, GEN1)).collect();
        assert_eq!(reported, ["dropped 11: no packet starts so", "0x80 read main battery"]);
    }

    #[test]
    fn no_label_is_empty() {
        for command in COMMANDS {
            for form in command.forms {
                assert!(form.request.iter().chain(form.reply.fields()).all(|field| !label(field).is_empty()));
            }
        }
    }
}
