//! Values: raw to physical and back, text, ranges and their sentences.

use brushwork_mcp_wire::packet_serial::Generation;

use crate::tests::settings::{every_table, table};
use brushwork_link::settings::{Kind, Row, SettingValue};

fn row(model: &str, key: &str) -> Row {
    table(model, Generation::Gen4).row(key).unwrap_or_else(|| panic!("{key} is missing")).clone()
}

#[test]
fn every_raw_number_of_a_scaled_row_survives_the_way_to_text_and_back() {
    for table in every_table() {
        for row in table.rows().iter().filter(|row| matches!(row.kind, Kind::Fixed { .. })) {
            let (low, high) = (
                row.encode(SettingValue::Number(row.range.min)),
                row.encode(SettingValue::Number(row.range.max)),
            );
            let (low, high) = (low.expect("a number"), high.expect("a number"));
            let (low, high) = (low.min(high), low.max(high));
            for step in 0..=200_i64 {
                // Both ends, the neighbours of the ends and a spread between them.
                let raw = match step {
                    0..=2 => low + step.min(high - low),
                    3..=5 => high - (step - 3).min(high - low),
                    _ => low + ((high - low) as i128 * i128::from(step) / 200) as i64,
                };
                let value = row.decode(raw);
                let expected = row.decode(row.encode(value).expect("a number"));
                assert_eq!(value, expected, "{}: {raw}", row.key);
                let text = row.format(value);
                assert_eq!(row.parse(&text), Ok(value), "{}: {raw} as {text}", row.key);
                let bare = row.format_bare(value);
                assert_eq!(row.parse(&bare), Ok(value), "{}: {raw} as {bare}", row.key);
            }
        }
    }
}

#[test]
fn every_named_value_survives_the_way_to_text_and_back() {
    for table in every_table() {
        for row in table.rows() {
            let Kind::Choice(codes) = row.kind else { continue };
            for code in codes {
                let value = row.decode(code.raw);
                assert_eq!(value, SettingValue::Choice(code.key));
                assert_eq!(row.encode(value), Some(code.raw));
                for text in [
                    code.key.to_owned(),
                    code.label.to_owned(),
                    code.label.to_uppercase(),
                    code.raw.to_string(),
                ] {
                    assert_eq!(row.parse(&text), Ok(value), "{}: {text}", row.key);
                }
            }
        }
    }
}

#[test]
fn values_are_written_as_people_write_them() {
    let volts = row("mcp266", "limits.main_battery.max_volts");
    assert_eq!(volts.format(volts.decode(243)), "24.3 V");
    assert_eq!(volts.range_text(), "10.0 V to 60.0 V");
    let gain = row("mcp266", "motor1.velocity.p");
    assert_eq!(gain.format(gain.decode(65_536)), "1.000");
    assert_eq!(gain.format(gain.decode(1)), "0.00002");
    let amps = row("mcp266", "motor1.current.max_amps");
    assert_eq!(amps.format(amps.decode(5989)), "59.89 A");
    let address = row("mcp266", "unit.address");
    assert_eq!(address.parse("0x82"), Ok(SettingValue::Int(0x82)));
    let mixing = row("mcp266", "unit.mixing");
    assert_eq!(mixing.format(SettingValue::Bool(true)), "yes");
    assert_eq!(mixing.parse("on"), Ok(SettingValue::Bool(true)));
}

#[test]
fn units_may_be_written_in_several_ways() {
    let henries = row("mcp266", "motor1.inductance_henries");
    let expected = henries.parse("0.0006").expect("a number");
    for text in ["0.6 mH", "0.6mH", "600 uH", "0.0006 H", "600 µH"] {
        assert_eq!(henries.parse(text), Ok(expected), "{text}");
    }
    let timeout = row("mcp266", "stream.usb.timeout");
    assert_eq!(timeout.parse("1.5 s"), Ok(SettingValue::Int(1500)));
    assert_eq!(timeout.parse("1500ms"), Ok(SettingValue::Int(1500)));
    assert!(timeout.parse("0.1 ms").is_err());
    let amps = row("mcp266", "motor1.current.max_amps");
    assert_eq!(amps.parse("500 mA"), Ok(SettingValue::Number(0.5)));
    assert!(amps.parse("500 mV").is_err());
}

#[test]
fn what_is_out_of_range_is_refused_in_a_sentence_that_names_the_bound() {
    let amps = row("mcp266", "motor1.current.max_amps");
    let refusal = |row: &Row, text: &str| row.parse(text).expect_err("it is refused").to_string();
    assert_eq!(refusal(&amps, "80"), "Motor 1: maximum current 80.00 A is above the MCP266's 60.00 A.");
    let volts = row("mcp233", "limits.main_battery.min_volts");
    assert_eq!(refusal(&volts, "6"), "Main battery minimum 6.0 V is below the MCP233's 10.0 V.");
    let address = row("mcp266", "unit.address");
    assert_eq!(refusal(&address, "136"), "Packet serial address 136 is above the highest value, 135.");
    let qpps = row("mcp266", "motor2.velocity.qpps");
    assert_eq!(refusal(&qpps, "fast"), "Motor 2: QPPS: 'fast' is not a number of counts/s.");
    let action = row("mcp266", "dout.1.action");
    assert!(action.parse("explode").is_err_and(|why| {
        why.to_string().starts_with("DOUT1: action: 'explode' is none of none, motor1_on")
    }));
    for text in ["NaN", "inf", "-inf", "", "1e400", "0x", "--1"] {
        assert!(amps.parse(text).is_err(), "{text}");
        assert!(qpps.parse(text).is_err(), "{text}");
    }
}

#[test]
fn repair_moves_a_value_to_the_nearest_bound_and_says_so() {
    let amps = row("mcp266", "motor1.current.max_amps");
    let (value, warning) = amps.repair(SettingValue::Number(80.0));
    assert_eq!(value, SettingValue::Number(60.0));
    assert_eq!(
        warning.unwrap(),
        "Motor 1: maximum current 80.00 A is above the MCP266's 60.00 A. 60.00 A is used instead."
    );
    assert_eq!(amps.repair(SettingValue::Number(12.344)), (SettingValue::Number(12.34), None));
    let (value, warning) = amps.repair(SettingValue::Bool(true));
    assert_eq!(value, amps.default);
    assert!(warning.is_some());
    let (value, _) = amps.repair(SettingValue::Number(f64::NAN));
    assert_eq!(value, amps.default);
}

#[test]
fn a_number_without_a_name_is_kept_and_never_written() {
    let action = row("mcp266", "dout.1.action");
    let value = action.decode(99);
    assert_eq!(value, SettingValue::UnknownCode(99));
    assert_eq!(action.encode(value), Some(99));
    assert_eq!(action.format(value), "unknown (99)");
    assert!(
        action
            .check(value)
            .is_err_and(|why| why.to_string().contains("99 is none of the values known for it"))
    );
}
