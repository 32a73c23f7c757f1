//! One test per kind of conflict; and none where nothing is wrong.

use crate::subject;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::Generation;

use crate::settings::{ConflictKind, conflicts};
use brushwork_link::settings::{SettingValue, SettingsImage, SettingsTable};

const CHOICE: fn(&'static str) -> SettingValue = SettingValue::Choice;

fn table(model: &str) -> SettingsTable {
    brushwork_link::register(&crate::McpDriver);
    SettingsTable::new(subject(models::lookup(model).unwrap(), Generation::Gen2))
}

/// What is found on an MCP266 with its defaults and these changes: kind, first row, sentence.
fn found(changes: &[(&str, SettingValue)]) -> Vec<(ConflictKind, String, String)> {
    let table = table("mcp266");
    let mut image = table.default_image();
    for (key, value) in changes {
        assert!(table.row(key).is_some(), "{key}");
        image.set(key, *value);
    }
    let all = conflicts(&table, &|key| image.get(key));
    for conflict in &all {
        assert!(conflict.keys.iter().all(|key| table.row(key).is_some()), "{conflict:?}");
    }
    all.into_iter().map(|one| (one.kind, one.keys[0].clone(), one.sentence.to_string())).collect()
}

/// The only conflict of these changes.
fn only(changes: &[(&str, SettingValue)]) -> (ConflictKind, String, String) {
    let mut all = found(changes);
    assert_eq!(all.len(), 1, "{all:?}");
    all.remove(0)
}

#[test]
fn the_defaults_of_every_model_and_what_is_not_known_have_no_conflict() {
    for model in models::MODELS.iter().filter(|model| model.family == Family::Mcp) {
        for generation in Generation::ALL {
            brushwork_link::register(&crate::McpDriver);
            let table = SettingsTable::new(subject(model, generation));
            let image = table.default_image();
            assert_eq!(conflicts(&table, &|key| image.get(key)), [], "{}", model.key);
            let nothing = SettingsImage::default();
            assert_eq!(conflicts(&table, &|key| nothing.get(key)), []);
        }
    }
}

#[test]
fn two_functions_on_one_pin() {
    // Pin 4 is DIN4/AN4/P4.
    let (kind, key, sentence) =
        only(&[("pin.4.type", CHOICE("analog")), ("pin.4.digital", SettingValue::Bool(true))]);
    assert_eq!((kind, key.as_str()), (ConflictKind::TwoFunctions, "pin.4.type"));
    assert!(sentence.contains("digital input and as analog at once"), "{sentence}");
}

#[test]
fn a_function_that_the_pin_does_not_have() {
    // Pin 3 is DIN3/AN3.
    let (kind, key, sentence) = only(&[("pin.3.type", CHOICE("pulse"))]);
    assert_eq!((kind, key.as_str()), (ConflictKind::NoSuchFunction, "pin.3.type"));
    assert!(sentence.starts_with("DIN3/AN3 is set to pulse, which this pin cannot measure"), "{sentence}");
}

#[test]
fn a_uart_holds_a_pin_that_is_set_as_an_input() {
    // Pin 5 is DIN5/TX2, and TTL UART2 is in use by default.
    let digital = ("pin.5.digital", SettingValue::Bool(true));
    let (kind, key, sentence) = only(&[digital]);
    assert_eq!((kind, key.as_str()), (ConflictKind::PortHoldsPin, "pin.5.type"));
    assert!(sentence.contains("Disable TTL UART2"), "{sentence}");
    assert_eq!(found(&[digital, ("stream.ttl2.type", CHOICE("disabled"))]), []);
}

#[test]
fn encoder_pins_not_in_pairs() {
    // Pins 7 and 9 are ENC1A and ENC1B.
    let (kind, key, sentence) = only(&[("pin.9.type", CHOICE("analog"))]);
    assert_eq!((kind, key.as_str()), (ConflictKind::HalfAnEncoder, "pin.7.type"));
    assert!(sentence.contains("encoder 1") && sentence.contains("in pairs"), "{sentence}");
    let (_, key, _) = only(&[("pin.8.type", CHOICE("analog"))]);
    assert_eq!(key, "pin.10.type");
}

#[test]
fn an_encoder_on_a_pin_that_measures_nothing() {
    let (kind, key, sentence) = only(&[("motor1.encoder.pin", SettingValue::Int(2))]);
    assert_eq!((kind, key.as_str()), (ConflictKind::EncoderUnread, "motor1.encoder.pin"));
    assert!(sentence.contains("from DIN3/AN3, which measures nothing"), "{sentence}");
    let none = [("motor1.encoder.pin", SettingValue::Int(255))];
    assert_eq!(found(&none), [], "none is a choice");
}

#[test]
fn an_action_on_a_pin_that_measures_nothing_never_fires() {
    let (kind, key, sentence) = only(&[("pin.3.min_action", CHOICE("e_stop"))]);
    assert_eq!((kind, key.as_str()), (ConflictKind::ActionNeverFires, "pin.3.min_action"));
    assert!(sentence.contains("minimum action of DIN3/AN3 never acts"), "{sentence}");
    let analog = ("pin.3.type", CHOICE("analog"));
    assert_eq!(found(&[analog, ("pin.3.min_action", CHOICE("e_stop"))]), []);
}

#[test]
fn an_action_behind_a_value_that_the_input_never_reaches_never_fires() {
    let analog = ("pin.3.type", CHOICE("analog"));
    let low = [analog, ("pin.3.min_action", CHOICE("m1_off")), ("pin.3.min", SettingValue::Int(-1))];
    let (kind, _, sentence) = only(&low);
    assert_eq!(kind, ConflictKind::ActionNeverFires);
    assert!(sentence.contains("never goes down to -1"), "{sentence}");
    let high = [analog, ("pin.3.max_action", CHOICE("m1_off")), ("pin.3.max", SettingValue::Int(5000))];
    assert!(only(&high).2.contains("never goes up to 5000"));
    let pulse = [
        ("pin.4.type", CHOICE("pulse")),
        ("pin.4.max_action", CHOICE("m1_off")),
        ("pin.4.max", SettingValue::Int(5000)),
    ];
    assert_eq!(found(&pulse), [], "a pulse may be that long");
}

#[test]
fn an_action_of_a_pin_that_a_uart_holds_never_fires() {
    let changes = [("pin.5.digital", SettingValue::Bool(true)), ("pin.5.max_action", CHOICE("m1_off"))];
    let kinds: Vec<_> = found(&changes).into_iter().map(|(kind, ..)| kind).collect();
    assert_eq!(kinds, [ConflictKind::PortHoldsPin, ConflictKind::ActionNeverFires]);
}

#[test]
fn an_action_without_anything_to_act_on() {
    let analog = ("pin.3.type", CHOICE("analog"));
    let home = [
        analog,
        ("pin.3.max_action", CHOICE("m2_load_home")),
        ("motor2.encoder.pin", SettingValue::Int(255)),
    ];
    assert!(only(&home).2.contains("motor 2 has no encoder"));
    let bridged =
        [analog, ("pin.3.max_action", CHOICE("m2_off")), ("unit.bridge_channels", SettingValue::Bool(true))];
    assert!(only(&bridged).2.contains("channels are bridged"));
}

#[test]
fn a_range_that_is_none() {
    let analog = ("pin.3.type", CHOICE("analog"));
    let cases = [
        (("pin.3.min", SettingValue::Int(4095)), "not below its maximum"),
        (("pin.3.center", SettingValue::Int(5000)), "center 5000 is not between"),
        (("pin.3.deadband", SettingValue::Int(2048)), "covers the whole range"),
    ];
    for (change, why) in cases {
        let (kind, key, sentence) = only(&[analog, change]);
        assert_eq!((kind, key.as_str()), (ConflictKind::NoRange, change.0));
        assert!(sentence.contains(why), "{sentence}");
        assert_eq!(found(&[change]), [], "a pin without a mode needs no range");
    }
}

#[test]
fn an_input_whose_kind_is_at_no_priority_level_never_commands() {
    let changes = [
        ("pin.3.type", CHOICE("analog")),
        ("pin.3.target", CHOICE("motor1")),
        ("priority.3", CHOICE("disabled")),
    ];
    let (kind, key, sentence) = only(&changes);
    assert_eq!((kind, key.as_str()), (ConflictKind::NeverCommands, "pin.3.target"));
    assert!(sentence.contains("analog inputs are at no priority level"), "{sentence}");
    assert_eq!(found(&changes[..2]), []);
}

#[test]
fn two_inputs_of_a_kind_cannot_command_one_motor() {
    let changes = [
        ("pin.3.type", CHOICE("analog")),
        ("pin.3.target", CHOICE("both")),
        ("pin.4.type", CHOICE("analog")),
        ("pin.4.target", CHOICE("motor2")),
    ];
    let (kind, key, sentence) = only(&changes);
    assert_eq!((kind, key.as_str()), (ConflictKind::TwoCommanders, "pin.4.target"));
    assert!(sentence.contains("both control motor 2"), "{sentence}");
    let mut other_kind = changes;
    other_kind[2].1 = CHOICE("pulse");
    assert_eq!(found(&other_kind), [], "a pulse takes over from an analog input by its priority level");
}

#[test]
fn a_bus_has_certain_rates_only() {
    let (kind, key, sentence) = only(&[("can.rate", SettingValue::Int(300_000))]);
    assert_eq!((kind, key.as_str()), (ConflictKind::NoSuchRate, "can.rate"));
    assert!(sentence.contains("CANopen has no rate of 300000 bit/s"), "{sentence}");
    assert!(only(&[("i2c.rate", SettingValue::Int(200_000))]).2.contains("100000, 400000, 1000000"));
}
