//! Which sentence each cause of standing motors gives.

use crate::controller::indicators::indicators;
use crate::diagnosis::*;
use brushwork_link::Stream;
use brushwork_link::device::StatusReport;
use brushwork_link::settings::{SettingValue, SettingsImage};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_mcp_wire::packet_serial::status::{CONDITIONS, Condition, Conditions, encode};
use brushwork_values::Severity;
use std::time::Duration;

/// The report of a generation that can tell the condition.
fn reported(reported: &[Condition]) -> StatusReport {
    let reported: Conditions = reported.iter().copied().collect();
    let generation =
        Generation::ALL.into_iter().find(|generation| reported.known_to(*generation) == reported);
    let generation = generation.expect("one can tell them");
    StatusReport::new(0x80, Duration::ZERO, encode(reported, generation), indicators(generation))
}

fn settings(pairs: &[(&str, SettingValue)]) -> SettingsImage {
    pairs.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect()
}

fn choice(key: &'static str) -> SettingValue {
    SettingValue::Choice(key)
}

fn of_settings(pairs: &[(&str, SettingValue)]) -> Diagnosis {
    diagnose(&Evidence { settings: Some(&settings(pairs)), ..Evidence::default() })
}

#[test]
fn nothing_wrong_says_so() {
    assert!(diagnose(&Evidence::default()).sentence().to_string().starts_with("Nothing that can be read"));
}

#[test]
fn every_warning_and_every_error_is_a_finding_with_a_cure() {
    for row in &CONDITIONS {
        let status = reported(&[row.condition]);
        let diagnosis = diagnose(&Evidence { status: Some(&status), ..Evidence::default() });
        assert_eq!(diagnosis.findings.len(), 1, "{}", row.title);
        assert!(!diagnosis.findings[0].cure.is_empty());
        let stops = diagnosis.findings[0].hindrance > Hindrance::Limits;
        assert!(stops || row.severity != Severity::Error, "{} stops a motor", row.title);
    }
}

#[test]
fn an_emergency_stop_comes_before_a_setting() {
    let status = reported(&[Condition::M1OverCurrentWarning, Condition::EStop]);
    let image = settings(&[("motor1.velocity.qpps", SettingValue::Int(0))]);
    let diagnosis =
        diagnose(&Evidence { status: Some(&status), settings: Some(&image), ..Evidence::default() });
    let order: Vec<Hindrance> = diagnosis.findings.iter().map(|finding| finding.hindrance).collect();
    assert_eq!(order, [Hindrance::BlocksAll, Hindrance::BlocksSome, Hindrance::Limits]);
    let sentence = diagnosis.sentence();
    assert!(
        sentence.to_string().contains("E-Stop") && sentence.to_string().contains("2 more reasons"),
        "{sentence}"
    );
}

#[test]
fn the_cure_of_an_emergency_stop_is_the_one_its_reset_method_allows() {
    let cure = |method| {
        let status = reported(&[Condition::EStop]);
        let image = settings(&[("unit.estop_reset", choice(method))]);
        diagnose(&Evidence { status: Some(&status), settings: Some(&image), ..Evidence::default() })
            .sentence()
    };
    assert!(cure("hardware").to_string().contains("restart the controller"));
    assert!(cure("software").to_string().contains("reset it on the Device Status screen"));
    assert!(cure("automatic").to_string().ends_with("the reset is automatic."));
}

#[test]
fn a_voltage_window_is_told_with_both_figures() {
    let status = reported(&[Condition::MainBatteryLowWarning]);
    let image = settings(&[("limits.main_battery.min_volts", SettingValue::Number(10.0))]);
    let measured = Measured { main_volts: Some(7.04), ..Measured::default() };
    let evidence =
        Evidence { status: Some(&status), settings: Some(&image), measured, ..Evidence::default() };
    let sentence = diagnose(&evidence).sentence();
    assert!(
        sentence.to_string().contains("the main battery is at 7.0 V, below its minimum of 10.0 V"),
        "{sentence}"
    );
    // A latched error whose cause is over does not claim that the voltage is still wrong.
    let measured = Measured { main_volts: Some(12.0), ..measured };
    let sentence = diagnose(&Evidence { measured, ..evidence }).sentence();
    assert!(sentence.to_string().contains("(now 12.0 V)"), "{sentence}");
}

#[test]
fn equal_position_limits_are_told_with_the_motor_and_the_cure() {
    let sentence = of_settings(&[
        ("motor2.position.min", SettingValue::Int(0)),
        ("motor2.position.max", SettingValue::Int(0)),
    ])
    .sentence();
    assert!(sentence.to_string().contains("the position limits of motor 2 (0 to 0)"), "{sentence}");
    assert!(sentence.to_string().ends_with("Set the lowest and the highest position."), "{sentence}");
}

#[test]
fn serial_in_no_priority_level_blocks_all() {
    let levels = |third| {
        of_settings(&[
            ("priority.1", choice("pulse")),
            ("priority.2", choice("analog")),
            ("priority.3", choice(third)),
        ])
    };
    assert_eq!(levels("disabled").findings[0].hindrance, Hindrance::BlocksAll);
    assert!(levels("serial").findings.is_empty());
}

#[test]
fn an_input_above_serial_that_commands_a_motor_is_named() {
    let with = |kind, target, timeout| {
        of_settings(&[
            ("priority.1", choice("pulse")),
            ("priority.2", choice("analog")),
            ("priority.3", choice("serial")),
            ("pin.1.type", choice("none")),
            ("pin.1.target", choice("motor1")),
            ("pin.2.type", choice(kind)),
            ("pin.2.target", choice(target)),
            ("pin.2.timeout", SettingValue::Int(timeout)),
        ])
    };
    assert!(with("analog", "none", 100).findings.is_empty());
    let analog = with("analog", "both", 100);
    assert_eq!(analog.findings[0].hindrance, Hindrance::BlocksAll);
    assert!(analog.sentence().to_string().contains("the analog input pin 2"), "{}", analog.sentence());
    assert!(with("pulse", "motor2", 100).sentence().to_string().contains("for as long as pulses come"));
    assert!(with("pulse", "motor2", 0).sentence().to_string().contains("for good"));
}

#[test]
fn a_time_out_of_zero_of_the_port_that_is_used_is_why_nothing_arms() {
    let image = settings(&[
        ("stream.usb.type", choice("packet_serial")),
        ("stream.usb.timeout", SettingValue::Int(1000)),
        ("stream.rs232.type", choice("packet_serial")),
        ("stream.rs232.timeout", SettingValue::Int(0)),
    ]);
    let over = |stream| diagnose(&Evidence { settings: Some(&image), stream, ..Evidence::default() });
    assert!(over(Some(Stream::Usb)).findings.is_empty());
    assert!(over(Some(Stream::Rs232)).sentence().to_string().contains("the time-out of RS232 UART0 is 0"));
    // Nobody said which port it is: any of them could be the one without.
    assert_eq!(over(None).findings[0].hindrance, Hindrance::BlocksAll);
}

#[test]
fn a_script_is_suspected_told_or_known_to_have_ended() {
    let image = settings(&[("script.autorun_delay", SettingValue::Int(500))]);
    let with = |script| diagnose(&Evidence { settings: Some(&image), script, ..Evidence::default() });
    assert!(
        with(Script::NotKnown).sentence().to_string().contains("starts 500 ms after power-up may be running")
    );
    assert!(with(Script::Started).sentence().to_string().contains("a script is running"));
    assert!(with(Script::Stopped).findings.is_empty());
    assert!(of_settings(&[("script.autorun_delay", SettingValue::Int(0))]).findings.is_empty());
}

#[test]
fn a_pin_at_its_end_stops_what_its_action_says_and_lights_the_home_indicators() {
    let image = settings(&[
        ("pin.1.type", choice("none")),
        ("pin.1.digital", SettingValue::Bool(true)),
        ("pin.1.min_action", choice("m1_safe_stop")),
        ("pin.1.max_action", choice("none")),
        ("pin.2.type", choice("analog")),
        ("pin.2.min_action", choice("none")),
        ("pin.2.max_action", choice("both_off")),
        ("pin.3.type", choice("none")),
        ("pin.3.min_action", choice("both_off")),
    ]);
    let with = |pins: &[PinEnd]| {
        let evidence = Evidence { settings: Some(&image), pins: Some(pins), ..Evidence::default() };
        (diagnose(&evidence), homed(&image, pins))
    };
    let (diagnosis, indicators) = with(&[PinEnd::Between, PinEnd::Lowest, PinEnd::Lowest]);
    assert!(diagnosis.findings.is_empty(), "pin 3 has no type");
    assert_eq!(indicators, [false, false]);
    let (diagnosis, indicators) = with(&[PinEnd::Lowest, PinEnd::Between, PinEnd::Between]);
    assert_eq!(indicators, [true, false]);
    let sentence = diagnosis.sentence();
    assert!(
        sentence.to_string().contains("pin 1 is at its minimum, whose action stops motor 1"),
        "{sentence}"
    );
    let (diagnosis, indicators) = with(&[PinEnd::Between, PinEnd::Highest, PinEnd::Between]);
    assert_eq!(diagnosis.findings[0].hindrance, Hindrance::BlocksAll);
    assert_eq!(indicators, [true, true]);
}

#[test]
fn bridged_channels_are_told_to_whoever_commands_motor_2() {
    assert!(
        of_settings(&[("unit.bridge_channels", SettingValue::Bool(true))])
            .sentence()
            .to_string()
            .contains("motor 2")
    );
}

#[test]
fn every_key_that_is_judged_is_in_the_table_and_among_those_to_read() {
    use brushwork_link::settings::SettingsTable;
    use brushwork_mcp_wire::packet_serial::Generation;
    for generation in Generation::ALL {
        let model = models::lookup("MCP266").expect("it is in the list");
        brushwork_link::register(&crate::McpDriver);
        let table = SettingsTable::new(crate::subject(model, generation));
        let keys = keys(&table);
        for key in [
            "unit.estop_reset",
            "unit.bridge_channels",
            "limits.main_battery.min_volts",
            "limits.logic_battery.max_volts",
            "priority.3",
            "script.autorun_delay",
            "pin.10.max_action",
            "pin.1.digital",
            "pin.1.target",
            "pin.1.timeout",
            "stream.usb.type",
            "stream.ttl3.timeout",
            "motor1.velocity.qpps",
            "motor2.position.max",
            "motor2.position.p",
        ] {
            assert!(keys.iter().any(|wanted| wanted == key), "{key} in {generation}");
        }
        assert!(keys.len() < table.rows().len());
    }
    assert!(brushwork_mcp_wire::codes::PRIORITY_SIGNALS.iter().any(|code| code.key == "serial"));
}
