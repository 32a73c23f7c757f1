//! Fields and layouts of packets in words.

use crate::packet_serial::command::Form;
use brushwork_values::{Field, Kind, Unit};

/// How many bytes a field has, and of what.
pub fn kind(kind: &Kind) -> String {
    match kind {
        Kind::U8 => "u8".to_owned(),
        Kind::I8 => "i8".to_owned(),
        Kind::U16 => "u16".to_owned(),
        Kind::I16 => "i16".to_owned(),
        Kind::U24 => "u24".to_owned(),
        Kind::U32 => "u32".to_owned(),
        Kind::I32 => "i32".to_owned(),
        Kind::Text { max } => format!("text ending 0A 00, at most {max} bytes"),
        Kind::Ascii36 => "u8 length + 36 bytes ASCII".to_owned(),
        Kind::Utf16Le36 => "u8 length + 36 bytes UTF-16LE".to_owned(),
        Kind::Bytes(count) => format!("{count} bytes"),
        Kind::Counted(_) => "u8 count + records".to_owned(),
    }
}

/// "1", "2 to 4": the generations of a form.
pub fn generations(form: &Form) -> String {
    if form.first == form.last {
        return form.first.number().to_string();
    }
    format!("{} to {}", form.first.number(), form.last.number())
}

/// How one raw count reads: "1 raw = 0.1 V", or nothing for plain numbers.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn scale_words(field: &Field) -> String {
    let symbol = field.unit.symbol();
    match field.unit {
        Unit::None | Unit::Bits | Unit::Status => String::new(),
        Unit::Gain => format!("{} raw = 1.0", (1.0 / field.scale).round()),
        _ if field.scale == 1.0 => format!("in {symbol}"),
        _ if field.scale < 0.01 => {
            let hundred =
                if matches!(field.unit, Unit::Percent | Unit::PercentPerSecond) { 100.0 } else { 1.0 };
            format!("{} raw = {hundred} {symbol}", (hundred / field.scale).round())
        }
        _ => format!("1 raw = {} {symbol}", field.scale),
    }
}

fn code_words(field: &Field) -> String {
    let codes: Vec<String> = field.codes.iter().map(|code| format!("{} {}", code.raw, code.label)).collect();
    codes.join(", ")
}

/// All that there is to say about a field.
pub fn field_words(field: &Field) -> String {
    let mut parts = vec![kind(&field.kind)];
    parts.extend(Some(scale_words(field)).filter(|words| !words.is_empty()));
    parts.extend(field.raw_range.map(|(low, high)| format!("{low} to {high}")));
    parts.extend(Some(code_words(field)).filter(|words| !words.is_empty()));
    parts.push(field.doc.to_owned());
    let label = if field.label.is_empty() { String::new() } else { format!(" ({})", field.label) };
    format!("{}{label}: {}", field.name, parts.join("; "))
}
