//! Which settings mean nothing while others stand as they do (MCP manual 1.9.2: "will be grayed out").

use brushwork_link::settings::{Group, Row, SettingValue};

/// Why the row has no effect now, as a sentence; `wanted` gives the value of any key.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub(super) fn why_not(row: &Row, wanted: impl Fn(&str) -> Option<SettingValue>) -> Option<&'static str> {
    match row.group {
        Group::PINS => pin(row, wanted),
        Group::STREAMS => stream(row, wanted),
        Group::BUSES => bus(row, wanted),
        _ => control(row, wanted),
    }
}

/// What depends on the control mode of a board that has one.
fn control(row: &Row, wanted: impl Fn(&str) -> Option<SettingValue>) -> Option<&'static str> {
    let mode = choice(wanted("roboclaw.config.mode"));
    let has_inputs = mode.is_none_or(|mode| matches!(mode, "rc" | "analog"));
    let has_packets = mode.is_none_or(|mode| mode == "packet_serial");
    let is_simple = mode.is_none_or(|mode| mode == "simple_serial");
    let of_inputs = |suffix| row.key.starts_with("roboclaw.") && row.key.ends_with(suffix);
    let is_of_inputs = of_inputs("deadband.reverse")
        || of_inputs("deadband.forward")
        || row.key.starts_with("roboclaw.s1.")
        || row.key.starts_with("roboclaw.s2.")
        || row.key.ends_with(".encoder.in_rc");
    match row.key.as_str() {
        _ if is_of_inputs && !has_inputs => {
            Some("Not applicable: the control mode is serial. It is for R/C and analog inputs.")
        }
        "roboclaw.config.bit_11" if !is_simple => {
            Some("Not applicable: it is for the control mode simple serial.")
        }
        "roboclaw.config.slave_select" | "roboclaw.config.open_drain" if !has_packets => {
            Some("Not applicable: it is for the control mode packet serial.")
        }
        "limits.main_battery.min_volts" | "limits.main_battery.max_volts"
            if choice(wanted("roboclaw.config.battery")).is_some_and(|battery| battery != "user") =>
        {
            Some("Not applicable: the battery cut-off sets it by a number of cells.")
        }
        _ => None,
    }
}

fn pin(row: &Row, wanted: impl Fn(&str) -> Option<SettingValue>) -> Option<&'static str> {
    let number = row.instance.as_ref()?.number;
    let of_pin = |field: &str| wanted(&format!("pin.{number}.{field}"));
    if matches!(row.pattern, "pin.{n}.type" | "pin.{n}.digital") {
        return None;
    }
    let kind = choice(of_pin("type"))?;
    let is_digital = of_pin("digital") == Some(SettingValue::Bool(true));
    if kind == "none" && !is_digital {
        return Some("Not applicable: this pin measures nothing. Choose its mode first.");
    }
    match row.pattern {
        "pin.{n}.timeout" if kind != "pulse" => {
            Some("Not applicable: the time-out is for pulse inputs only. MCP manual 1.9.8.")
        }
        "pin.{n}.load_home" => {
            let loads = |field| choice(of_pin(field)).is_none_or(|action| action.ends_with("load_home"));
            (!loads("min_action") && !loads("max_action"))
                .then_some("Not applicable: neither action of this pin loads the home position.")
        }
        _ => None,
    }
}

fn stream(row: &Row, wanted: impl Fn(&str) -> Option<SettingValue>) -> Option<&'static str> {
    let stream = row.key.rsplit_once('.')?.0;
    let is = |kind| choice(wanted(&format!("{stream}.type"))) == Some(kind);
    match row.pattern {
        "stream.{n}.type" => None,
        _ if is("disabled") => Some("Not applicable: this port is disabled. Choose its mode first."),
        "stream.{n}.rate" if stream == "stream.usb" => Some("Not applicable: USB has no bit rate."),
        "stream.{n}.timeout" if is("mcl") => {
            Some("Not applicable: a port that belongs to the script has no priority time-out.")
        }
        _ => None,
    }
}

fn bus(row: &Row, wanted: impl Fn(&str) -> Option<SettingValue>) -> Option<&'static str> {
    let in_use = |stream: &str| choice(wanted(stream)).is_some_and(|kind| kind != "disabled");
    if row.key.starts_with("can.") && in_use("stream.rs232.type") {
        Some("Not applicable: the pins serve RS-232. Disable UART0 to use them for CANopen.")
    } else if row.key.starts_with("i2c.") && in_use("stream.ttl1.type") {
        Some("Not applicable: the pins serve TTL UART1. Disable it to use them for I2C.")
    } else {
        None
    }
}

fn choice(value: Option<SettingValue>) -> Option<&'static str> {
    value?.choice()
}

#[cfg(test)]
mod tests {
    use brushwork_link::settings::{SettingsImage, SettingsTable};
    use brushwork_mcp_wire::models;
    use brushwork_mcp_wire::packet_serial::Generation;

    use super::*;

    fn reason(table: &SettingsTable, image: &SettingsImage, key: &str) -> Option<&'static str> {
        why_not(table.row(key).expect("the table has the row"), |key| image.get(key))
    }

    #[test]
    fn a_pins_settings_follow_its_type() {
        brushwork_link::register(&brushwork_mcp_client::McpDriver);
        let table = SettingsTable::new(brushwork_mcp_client::subject(
            models::lookup("mcp266").unwrap(),
            Generation::Gen1,
        ));
        let mut image = table.default_image();
        image.set("pin.1.type", SettingValue::Choice("none"));
        assert_eq!(reason(&table, &image, "pin.1.type"), None);
        assert!(reason(&table, &image, "pin.1.deadband").unwrap().contains("Choose its mode"));
        image.set("pin.1.type", SettingValue::Choice("analog"));
        assert_eq!(reason(&table, &image, "pin.1.deadband"), None);
        assert!(reason(&table, &image, "pin.1.timeout").unwrap().contains("pulse inputs only"));
        assert!(reason(&table, &image, "pin.1.load_home").unwrap().contains("neither action"));
        image.set("pin.1.max_action", SettingValue::Choice("m1_load_home"));
        assert_eq!(reason(&table, &image, "pin.1.load_home"), None);
    }

    #[test]
    fn a_disabled_port_leaves_its_pins_to_the_bus() {
        brushwork_link::register(&brushwork_mcp_client::McpDriver);
        let table = SettingsTable::new(brushwork_mcp_client::subject(
            models::lookup("mcp266").unwrap(),
            Generation::Gen1,
        ));
        let mut image = table.default_image();
        image.set("stream.rs232.type", SettingValue::Choice("packet_serial"));
        assert!(reason(&table, &image, "can.rate").unwrap().contains("Disable UART0"));
        assert_eq!(reason(&table, &image, "stream.rs232.rate"), None);
        image.set("stream.rs232.type", SettingValue::Choice("disabled"));
        assert_eq!(reason(&table, &image, "can.rate"), None);
        assert!(reason(&table, &image, "stream.rs232.rate").unwrap().contains("disabled"));
        assert!(reason(&table, &image, "stream.usb.rate").unwrap().contains("no bit rate"));
    }

    #[test]
    fn what_is_not_known_locks_nothing() {
        brushwork_link::register(&brushwork_mcp_client::McpDriver);
        let table = SettingsTable::new(brushwork_mcp_client::subject(
            models::lookup("mcp266").unwrap(),
            Generation::Gen1,
        ));
        let nothing = SettingsImage::default();
        for row in table.rows() {
            let reason = why_not(row, |key| nothing.get(key));
            assert!(reason.is_none() || row.key == "stream.usb.rate", "{}: {reason:?}", row.key);
        }
    }
}
