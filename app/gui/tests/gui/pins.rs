//! The pins of General Settings against a simulated controller, in virtual time, by role and label.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_core::keep::UnitId;
use brushwork_gui::model::screen::Screen;
use brushwork_link::settings::SettingValue;
use brushwork_mcp_client::settings::{ConflictKind, PinMode, SignalShape};
use brushwork_mcp_sim::settings::SignalSettings;
use brushwork_plant::world::{PinSignal, WorldAction};
use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// DIN4/AN4/P4 of an MCP266, in the order of command 144.
const PIN: usize = 3;
const NAME: &str = "DIN4/AN4/P4";

/// Connected, with the pin's page open.
fn opened() -> Bench {
    let mut bench = Bench::sized([1280.0, 1000.0], Theme::Dark);
    bench.connect();
    open(&mut bench);
    bench.press(&format!("Section {NAME}"));
    bench
}

fn open(bench: &mut Bench) {
    bench.harness.key_press_modifiers(Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(3000);
    assert_eq!(bench.model().screen, Screen::GeneralSettings);
}

/// What the controller works with on the pin.
fn truth(bench: &Bench) -> SignalSettings {
    bench.line.with(|bus| bus.controllers()[0].settings()).signals[PIN].clone()
}

fn write(bench: &mut Bench) {
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(3000);
}

/// Types a value into a field.
fn enter(bench: &mut Bench, title: &str, text: &str) {
    bench.harness.get_by_role_and_label(Role::TextInput, title).focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, title).type_text(text);
    bench.pass_ms(100);
    bench.key(Key::Enter);
    bench.pass_ms(100);
}

/// Chooses a mode as a hand does.
fn choose(bench: &mut Bench, mode: &str) {
    bench.press(&format!("{NAME}: mode"));
    bench.press(mode);
}

/// The page of a pin that is an analog input on the controller too.
fn analog() -> Bench {
    let mut bench = opened();
    choose(&mut bench, "Analog");
    write(&mut bench);
    assert_eq!(truth(&bench).kind, 1);
    bench
}

fn apply_volts(bench: &mut Bench, volts: f64) {
    bench.act(&WorldAction::SetPin { pin: PIN, signal: PinSignal::Volts { volts } });
    bench.pass_ms(500);
}

/// The voltage that is read as `reading`.
fn volts(reading: f64) -> f64 {
    reading / 4095.0 * 5.1
}

fn wanted(bench: &mut Bench, field: &str) -> SettingValue {
    let unit = bench.model().front.settings.unit().expect("a unit is looked at");
    unit.wanted(&format!("pin.{}.{field}", PIN + 1)).expect("the pin was read")
}

/// Moves the input and holds it there.
fn hold(bench: &mut Bench, reading: f64) {
    apply_volts(bench, volts(reading));
    bench.pass_ms(1000);
}

#[test]
fn each_pin_tells_what_it_does_at_a_glance() {
    let mut bench = opened();
    let described = |bench: &Bench, name: &str| {
        let node = bench.button(&format!("Section {name}")).accesskit_node().description();
        node.unwrap_or_default()
    };
    assert_eq!(described(&bench, "USB"), "USB: Packet serial");
    assert_eq!(described(&bench, "DIN5/TX2"), "DIN5/TX2: UART2 in use");
    assert_eq!(described(&bench, "DIN7/AN7/P7/ENC1A"), "DIN7/AN7/P7/ENC1A: Encoder");
    assert_eq!(described(&bench, NAME), format!("{NAME}: None"));
    choose(&mut bench, "Pulse");
    bench.model().front.settings.unit_mut().unwrap().set("pin.4.target", SettingValue::Choice("both"));
    bench.pass_ms(200);
    assert_eq!(described(&bench, NAME), format!("{NAME}: Pulse, M1 + M2"));
}

#[test]
fn a_new_mode_puts_every_other_setting_of_the_pin_back_to_its_default() {
    let mut bench = analog();
    enter(&mut bench, &format!("{NAME}: deadband"), "77");
    enter(&mut bench, &format!("{NAME}: center"), "2000");
    write(&mut bench);
    assert_eq!((truth(&bench).deadband, truth(&bench).center), (77, 2000));
    choose(&mut bench, "Pulse");
    assert_eq!(wanted(&mut bench, "deadband"), SettingValue::Int(0));
    assert_eq!(wanted(&mut bench, "center"), SettingValue::Int(2048));
    assert_eq!(truth(&bench).deadband, 77, "nothing changes before it is written");
    write(&mut bench);
    let pin = truth(&bench);
    assert_eq!((pin.kind, pin.deadband, pin.center), (2, 0, 2048));
    choose(&mut bench, "Digital");
    write(&mut bench);
    assert!(truth(&bench).digital);
    choose(&mut bench, "Analog");
    write(&mut bench);
    assert!(!truth(&bench).digital);
}

#[test]
fn the_live_status_is_what_the_controller_says() {
    let mut bench = analog();
    apply_volts(&mut bench, volts(1024.0));
    assert!(bench.sees("Signal input: 1024"), "the reading behind the position");
    assert!(bench.sees("Signal position: -1024"));
    assert!(bench.sees("Signal percent: -50.0 %"));
    assert!(bench.sees("Signal command: -16383"));
    assert!(bench.sees_part("Signal graph of DIN4/AN4/P4: 0 to 4095 around 2048"));
    assert!(bench.sees_part("signal at 1024, -50.0 %"));
    bench.pass_ms(2000);
    assert!(bench.sees("Signal instantaneous speed: 0 /s"));
    assert!(bench.sees("Signal average speed: 0 /s"));
}

#[test]
fn the_pins_are_read_only_while_their_page_is_open() {
    let mut bench = analog();
    assert!(bench.model().front.link.readings.signal(PIN + 1).is_some());
    bench.press("Section Unit settings");
    bench.pass_ms(500);
    assert_eq!(bench.model().front.link.readings.signal(PIN + 1), None);
    bench.press(&format!("Section {NAME}"));
    bench.pass_ms(500);
    assert!(bench.model().front.link.readings.signal(PIN + 1).is_some());
    bench.press("Device Status");
    bench.pass_ms(500);
    assert_eq!(bench.model().front.link.readings.signal(PIN + 1), None);
}

#[test]
fn the_handles_of_the_signal_graph_are_dragged_and_what_they_give_is_written() {
    let mut bench = analog();
    let handle =
        |bench: &Bench, name: &str| bench.harness.get_by_role_and_label(Role::Slider, name).rect().center();
    let mut drag = |name: &str, by: egui::Vec2| {
        let from = handle(&bench, name);
        bench.harness.drag_at(from);
        bench.pass_ms(100);
        bench.harness.hover_at(from + by);
        bench.pass_ms(100);
        bench.harness.drop_at(from + by);
        bench.pass_ms(200);
        handle(&bench, name) - from
    };
    let moved = drag("Deadband handle", vec2(20.0, 0.0));
    assert!((moved.x - 20.0).abs() < 1.5 && moved.y == 0.0, "{moved:?}");
    let moved = drag("Power minimum handle", vec2(0.0, -12.0));
    assert!((moved.y + 12.0).abs() < 1.5 && moved.x == 0.0, "{moved:?}");
    let moved = drag("Power exponent handle", vec2(0.0, -15.0));
    assert!((moved.y + 15.0).abs() < 2.0, "{moved:?}");
    write(&mut bench);
    let pin = truth(&bench);
    assert!((300..500).contains(&pin.deadband), "{pin:?}");
    assert!((200..400).contains(&pin.power_min), "{pin:?}");
    assert!(pin.power_exp_raw > 10_000, "upwards is steeper at the center: {pin:?}");
    // What is drawn is what the controller does.
    apply_volts(&mut bench, volts(3300.0));
    let unit = bench.model().front.settings.unit().unwrap();
    let shape = SignalShape::of(&|key| unit.on_controller(key), PIN + 1).unwrap();
    let signal = bench.model().front.link.readings.signal(PIN + 1).unwrap();
    assert_eq!(signal.position, shape.position(3300.0) as i32);
}

#[test]
fn the_handles_are_moved_by_the_keyboard() {
    let mut bench = analog();
    bench.focus_label("Deadband handle");
    for _ in 0..3 {
        bench.key(Key::ArrowRight);
    }
    bench.harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
    bench.pass_ms(200);
    assert_eq!(wanted(&mut bench, "deadband"), SettingValue::Int(13));
    bench.key(Key::Home);
    assert_eq!(wanted(&mut bench, "deadband"), SettingValue::Int(0));
    bench.focus_label("Power minimum handle");
    bench.key(Key::PageUp);
    assert_eq!(wanted(&mut bench, "power_min"), SettingValue::Int(102));
    bench.focus_label("Power exponent handle");
    bench.key(Key::ArrowDown);
    bench.key(Key::ArrowDown);
    let SettingValue::Number(exponent) = wanted(&mut bench, "power_exp") else { panic!("it is a number") };
    assert!((exponent + 0.1).abs() < 1e-4, "{exponent}");
    bench.key(Key::Space);
    assert!(bench.both_stand(), "Space is Stop even here");
}

#[test]
fn set_takes_minimum_center_and_maximum_from_the_live_signal() {
    let mut bench = analog();
    for (reading, field, title) in
        [(400.0, "min", "minimum"), (2100.0, "center", "center"), (3700.0, "max", "maximum")]
    {
        apply_volts(&mut bench, volts(reading));
        bench.press(&format!("Set {NAME}: {title} from the live signal"));
        assert_eq!(wanted(&mut bench, field), SettingValue::Int(reading as i64));
    }
    write(&mut bench);
    let pin = truth(&bench);
    assert_eq!((pin.min, pin.center, pin.max), (400, 2100, 3700));
    // Beyond the range the controller tells no reading, so none is made up.
    apply_volts(&mut bench, 5.1);
    let button = format!("Set {NAME}: maximum from the live signal");
    assert!(bench.button(&button).accesskit_node().is_disabled());
    assert!(bench.sees("Signal input: high end"));
}

#[test]
fn match_input_makes_the_command_range_as_wide_as_the_input_range() {
    let mut bench = analog();
    // MCP manual 1.9.11: 1000, 2000 and 3000 give -1000 and +1000.
    for (field, value) in [("minimum", "1000"), ("center", "2000"), ("maximum", "3000")] {
        enter(&mut bench, &format!("{NAME}: {field}"), value);
    }
    bench.press("Match Input");
    assert_eq!(wanted(&mut bench, "min_output"), SettingValue::Int(-1000));
    assert_eq!(wanted(&mut bench, "max_output"), SettingValue::Int(1000));
}

#[test]
fn an_input_is_calibrated_by_moving_it() {
    let mut bench = analog();
    enter(&mut bench, &format!("{NAME}: deadband"), "5");
    bench.model().front.settings.unit_mut().unwrap().set("pin.4.target", SettingValue::Choice("motor1"));
    write(&mut bench);
    apply_volts(&mut bench, volts(300.0));
    bench.press(&format!("Calibrate {NAME}"));
    bench.pass_ms(2000);
    assert!(bench.sees("Step 1 of 2"));
    assert_eq!((truth(&bench).target, truth(&bench).center), (0, 0), "it commands nothing meanwhile");
    let unit = UnitId::new(bench.model().front.link.identity().unwrap(), &[]);
    assert!(bench.store().backups(Some(&unit))[0].name.ends_with("-before-trial"));
    assert_eq!(bench.store().open_journals(&unit).0.len(), 1, "open until the input is put back");
    hold(&mut bench, 300.0);
    bench.press("Take ends");
    assert!(bench.sees_part("The input moved over"), "one end alone is refused");
    // One reading that jumps is no end.
    bench.act(&WorldAction::SetPin { pin: PIN, signal: PinSignal::Volts { volts: 0.0 } });
    bench.pass_ms(100);
    hold(&mut bench, 3900.0);
    assert!(bench.sees("Calibration lowest: 300") && bench.sees("Calibration highest: 3900"));
    bench.press("Take ends");
    assert!(bench.sees("Step 2 of 2"));
    bench.press("Take center");
    assert!(bench.sees_part("Too few readings") || bench.sees_part("one of its ends"));
    hold(&mut bench, 2150.0);
    bench.pass_ms(1000);
    bench.press("Take center");
    bench.pass_ms(2000);
    let pin = truth(&bench);
    assert_eq!((pin.target, pin.min, pin.center, pin.max, pin.deadband), (1, 0, 2048, 4095, 5), "put back");
    assert!(bench.store().open_journals(&unit).0.is_empty());
    assert_eq!(wanted(&mut bench, "min"), SettingValue::Int(300));
    assert_eq!(wanted(&mut bench, "center"), SettingValue::Int(2150));
    assert_eq!(wanted(&mut bench, "max"), SettingValue::Int(3900));
    assert!(bench.sees("Edits: 3 not written"));
    write(&mut bench);
    let pin = truth(&bench);
    assert_eq!((pin.min, pin.center, pin.max), (300, 2150, 3900));
}

#[test]
fn a_cancelled_calibration_leaves_everything_as_it_was() {
    let mut bench = analog();
    enter(&mut bench, &format!("{NAME}: minimum"), "50");
    let before = truth(&bench);
    bench.press(&format!("Calibrate {NAME}"));
    bench.pass_ms(2000);
    assert_ne!(truth(&bench), before);
    assert!(bench.see("Save to EEPROM").accesskit_node().is_disabled(), "an open range is never saved");
    bench.press("Cancel calibration");
    bench.pass_ms(2000);
    assert_eq!(truth(&bench), before);
    assert!(bench.sees("Edits: 1 not written"), "the edit from before is there");
}

#[test]
fn leaving_the_screen_ends_a_calibration() {
    let mut bench = analog();
    let before = truth(&bench);
    bench.press(&format!("Calibrate {NAME}"));
    bench.pass_ms(2000);
    bench.press("Device Status");
    bench.pass_ms(3000);
    assert_eq!(truth(&bench), before);
    assert!(bench.model().front.general.calibration.is_none());
}

#[test]
fn a_link_lost_while_calibrating_leaves_the_old_settings_as_changes_to_write() {
    let mut bench = analog();
    let before = truth(&bench);
    bench.press(&format!("Calibrate {NAME}"));
    bench.pass_ms(2000);
    bench.press("Disconnect");
    bench.pass_ms(1000);
    bench.connect();
    open(&mut bench);
    assert_ne!(truth(&bench), before, "nothing could put it back");
    assert!(bench.sees_part("A tuning run or a calibration begun"), "the journal tells it");
    assert!(bench.sees_part("not written"));
    write(&mut bench);
    assert_eq!(truth(&bench), before);
    let unit = UnitId::new(bench.model().front.link.identity().unwrap(), &[]);
    assert!(bench.store().open_journals(&unit).0.is_empty(), "all is as it was");
}

#[test]
fn conflicts_are_listed_and_lead_to_their_rows() {
    let mut bench = opened();
    bench.press("Section Conflicts");
    assert!(bench.sees_part("Nothing contradicts itself"));
    let unit = bench.model().front.settings.unit_mut().unwrap();
    unit.set_pin_mode(5, PinMode::Digital);
    unit.set("pin.9.type", SettingValue::Choice("analog"));
    bench.pass_ms(200);
    let kinds: Vec<_> =
        bench.model().front.settings.unit().unwrap().conflicts().into_iter().map(|one| one.kind).collect();
    assert_eq!(kinds, [ConflictKind::PortHoldsPin, ConflictKind::HalfAnEncoder]);
    assert!(bench.sees_part("DIN5/TX2 is set to digital, but TTL UART2 is in use and holds the pin"));
    bench.press("Go to DIN7/AN7/P7/ENC1A: type");
    assert!(bench.sees("DIN7/AN7/P7/ENC1A: mode"));
    bench.press("Write settings");
    assert!(bench.sees_part("DIN5/TX2 is set to digital, but TTL UART2"), "the write sheet warns too");
}

#[test]
fn a_mode_without_a_wire_form_is_not_offered_on_a_real_controller() {
    let mut bench = opened();
    let mut identity = bench.model().front.link.units[0].clone();
    identity.simulated = false;
    identity.port = "/dev/ttyACM0".to_owned();
    bench.model().front.link.units[0] = identity;
    bench.pass_ms(3000);
    bench.press(&format!("{NAME}: mode"));
    assert!(bench.button("Digital").accesskit_node().is_disabled());
    bench.press("Analog");
    write(&mut bench);
    assert_eq!(truth(&bench).kind, 1);
}

#[test]
fn the_page_fits_a_small_window() {
    let mut bench = Bench::sized([1024.0, 700.0], Theme::Light);
    bench.connect();
    open(&mut bench);
    bench.model().front.general_view().go_to("pin.4.type");
    bench.model().front.settings.unit_mut().unwrap().set_pin_mode(4, PinMode::Analog);
    bench.pass(Duration::from_millis(500));
    let right = bench.harness.get_by_label_contains("Signal command").rect().right();
    assert!(right < 1024.0, "{right}");
    let handle = bench.harness.get_by_role_and_label(Role::Slider, "Power minimum handle").rect();
    assert!(handle.right() < 1024.0 && handle.bottom() < 700.0);
    assert!(bench.model().front.link.readings.signal(4).is_some());
}

#[test]
fn bridging_the_channels_shows_its_wiring_warning() {
    let mut bench = opened();
    bench.press("Section Unit settings");
    assert!(!bench.sees_part("exactly as in MCP manual 1.8.2"));
    bench.press("Bridge channels");
    assert!(bench.sees_part("exactly as in MCP manual 1.8.2"));
    bench.press("Write settings");
    assert!(bench.sees_part("exactly as in MCP manual 1.8.2"));
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert!(bench.line.with(|bus| bus.controllers()[0].settings()).unit.bridged);
}

#[test]
fn a_motors_encoder_is_chosen_by_the_name_of_its_pin() {
    let mut bench = opened();
    bench.press("Section Encoders");
    bench.press("Motor 1: encoder input number");
    bench.press("2: DIN3/AN3");
    write(&mut bench);
    let motors = bench.line.with(|bus| bus.controllers()[0].settings()).motors;
    assert_eq!(motors[0].encoder_mode, 2);
}

#[test]
fn the_buses_stand_with_the_ports_whose_lines_they_share() {
    let mut bench = opened();
    bench.press("Section CAN/RS-232 UART0");
    assert!(bench.sees_part("CANopen node is locked: Not applicable: the pins serve RS-232"));
    bench.press("RS-232 (UART0): mode");
    bench.press("Disabled: CANopen");
    enter(&mut bench, "CANopen node", "17");
    enter(&mut bench, "CANopen rate", "500 kbit/s");
    write(&mut bench);
    let settings = bench.line.with(|bus| bus.controllers()[0].settings()).unit;
    assert_eq!((settings.can_node_id, settings.can_rate_bps), (17, 500_000));
    let described = bench.button("Section CAN/RS-232 UART0").accesskit_node().description();
    assert_eq!(described.as_deref(), Some("CAN/RS-232 UART0: CANopen"));
}

#[test]
fn a_script_on_power_up_is_switched_by_a_box_over_its_delay() {
    let mut bench = opened();
    bench.press("Section Scripting");
    bench.press("Execute script on power-up");
    write(&mut bench);
    let delay = |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].settings()).unit.script_autorun_ms;
    assert_eq!(delay(&bench), 100);
    bench.press("Execute script on power-up");
    write(&mut bench);
    assert_eq!(delay(&bench), 0);
}
