//! What is done with the widgets that take no value: connection, status, menus, pins.

use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::codes::{DOUT_ACTIONS, SIGNAL_ACTIONS_GENERATION_1};
use brushwork_mcp_wire::models;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Code;
use brushwork_values::Motor;
use egui::Key;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{PIN, Row, apply, driving, graph, mcl, tuning, value_of, write};
use crate::support::bench::Bench;

/// Plays the scene that a row names.
pub fn play(bench: &mut Bench, row: &Row, scene: &str) {
    let (name, given) = scene.split_once(' ').unwrap_or((scene, ""));
    match name {
        "shown" => {}
        "applied" => {
            bench.enter(row.label, given);
            apply(bench);
        }
        "actions" => each_choice(bench, row, SIGNAL_ACTIONS_GENERATION_1, |settings| {
            let pin = &settings.signals[PIN];
            if row.label.ends_with("minimum action") { pin.min_action.into() } else { pin.max_action.into() }
        }),
        "dout_actions" => each_choice(bench, row, DOUT_ACTIONS, |settings| settings.outputs[0].action.into()),
        "choose_device" => {
            bench.press(row.label);
            let target = bench.model().devices.target().map(|target| target.to_string());
            assert_eq!(target.ok().as_deref(), Some("sim:mcp266"));
        }
        "connect" => bench.connect(),
        "screen" => {
            bench.press(row.label);
            assert_eq!(bench.model().screen.title(), row.label);
        }
        "monitored" => monitored(bench, row.label),
        "zero_m1" => zero(bench, row, Motor::M1),
        "zero_m2" => zero(bench, row, Motor::M2),
        "pin_list" => pin_list(bench, row),
        "encoder_pin" => encoder_pin(bench, row),
        "live" | "signal_graph" | "match_input" | "set_min" | "set_center" | "set_max" => {
            signal(bench, row, name);
        }
        name if name.starts_with("tune_") => tuning::play(bench, row, name),
        name if name.starts_with("mcl_") => mcl::play(bench, row, name),
        name if name.starts_with("stop_") => stop(bench, row, name),
        name if name.starts_with("indicator_") => indicator(bench, row, name),
        name if name.starts_with("help_") => help(bench, row),
        name if name.starts_with("graph_") || name == "channel" => graph::play(bench, row, name),
        "firmware" | "exit" | "canopen" | "read_settings" | "default_settings" | "save_settings" => {
            menu(bench, row, name);
        }
        _ => driving::play(bench, row, name),
    }
}

fn stop(bench: &mut Bench, row: &Row, name: &str) {
    bench.arm();
    bench.set_duty(Motor::M1, "30");
    bench.set_duty(Motor::M2, "-30");
    bench.pass_ms(800);
    assert!(!bench.both_stand());
    match name {
        "stop_all" => bench.press(row.label),
        _ => bench.key(Key::Space),
    }
    bench.pass_ms(300);
    assert!(bench.both_stand(), "{row:?}");
}

fn zero(bench: &mut Bench, row: &Row, motor: Motor) {
    let count = |bench: &Bench| {
        let count =
            |unit: &brushwork_mcp_sim::controller::UnitView<'_>| unit.channel(motor).encoder().count();
        bench.line.with(|bus| bus.controllers()[0].unit().as_ref().map(count))
    };
    bench.arm();
    bench.set_duty(motor, "30");
    bench.pass_ms(1000);
    bench.key(Key::Space);
    bench.pass_ms(1500);
    assert!(count(bench).is_some_and(|count| count > 100), "{:?}", count(bench));
    bench.press(row.label);
    bench.pass_ms(300);
    assert_eq!(count(bench), Some(0), "{row:?}");
}

/// What a readout shows, without its name.
pub fn shown(bench: &Bench, label: &str) -> String {
    let start = format!("{label}: ");
    let text = |node: egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        node.label().filter(|text| text.starts_with(&start)).or_else(|| node.value())
    };
    let mut texts = bench.harness.query_all_by_label_contains(&start).filter_map(text);
    let found = texts.find_map(|text| text.strip_prefix(&start).map(str::to_owned));
    found.unwrap_or_else(|| panic!("nothing shows {label}"))
}

fn number(text: &str) -> f64 {
    let number = text.split(' ').next().unwrap_or_default().replace('\u{2212}', "-");
    number.parse().unwrap_or_else(|_| panic!("{text:?} begins with no number"))
}

/// A readout against the machine itself, while both motors turn.
fn monitored(bench: &mut Bench, label: &str) {
    let has_its_own = label == "Temp 2";
    if has_its_own {
        with_two_sensors(bench);
    }
    bench.act(&WorldAction::SetBatteryVolts { volts: 21.5 });
    bench.arm();
    bench.set_duty(Motor::M1, "30");
    bench.set_duty(Motor::M2, "-40");
    bench.pass_ms(3000);
    let got = number(&shown(bench, label));
    let motor = usize::from(label.starts_with("M2"));
    let view = bench.truth();
    let axis = &view.axes[motor];
    let (truth, within) = match label {
        "Temp 1" => (view.board_celsius[0], 0.3),
        "Temp 2" => (view.board_celsius[1], 0.3),
        "M1 amps" | "M2 amps" => (axis.truth.amps, 0.3),
        "M1 encoder" | "M2 encoder" => (axis.encoder_counts as f64, got.abs() * 0.1),
        "M1 speed" | "M2 speed" => {
            let before = axis.encoder_counts;
            bench.pass_ms(1000);
            ((bench.truth().axes[motor].encoder_counts - before) as f64, got.abs() * 0.05)
        }
        "Main battery" => (view.bus_volts, 0.3),
        "Logic battery" => (view.logic_volts, 0.15),
        other => panic!("{other}"),
    };
    bench.key(Key::Space);
    bench.pass_ms(1000);
    assert!((got - truth).abs() <= within, "{label}: shows {got}, really {truth}");
    assert!(got != 0.0, "{label} never moved");
    if has_its_own {
        *bench = super::opened("Top");
    }
}

/// An MCP266 has one temperature sensor, an MCP2166 has two.
fn with_two_sensors(bench: &mut Bench) {
    let model = models::lookup("mcp2166").expect("it is listed");
    *bench = Bench::of(Controller::new(ControllerConfig::of(model)).expect("the default world is sound"));
    bench.connect();
}

/// The world in which an indicator burns.
fn indicator(bench: &mut Bench, row: &Row, name: &str) {
    match name {
        "indicator_m1oc" => over_current(bench, Motor::M1),
        "indicator_m2oc" => over_current(bench, Motor::M2),
        "indicator_mbhi" => bench.act(&WorldAction::SetBatteryVolts { volts: 75.0 }),
        "indicator_mblo" => bench.act(&WorldAction::SetBatteryVolts { volts: 7.0 }),
        "indicator_lbhi" => bench.act(&WorldAction::SetLogicVolts { volts: 18.0 }),
        // The logic runs on the higher of both supplies, so both have to be low.
        "indicator_lblo" => {
            bench.act(&WorldAction::SetBatteryVolts { volts: 7.0 });
            bench.act(&WorldAction::SetLogicVolts { volts: 7.0 });
        }
        "indicator_tmp1" => bench.act(&WorldAction::SetBoardCelsius { celsius: Some(101.0) }),
        "indicator_tmp2" => {
            with_two_sensors(bench);
            assert_eq!(shown(bench, "TMP2"), "OK");
            bench.act(&WorldAction::SetBoardCelsius { celsius: Some(101.0) });
        }
        "indicator_estp" => bench.act(&WorldAction::EStop { pressed: true }),
        _ => home(bench, if name == "indicator_m1hm" { 1 } else { 2 }),
    }
    bench.pass_ms(2500);
    let indicator = &row.label[..4];
    let state = shown(bench, indicator);
    let burns = state == "error" || state == "warning" || state == "active";
    assert!(burns, "{indicator}: {state}");
    *bench = super::opened(row.place);
}

/// A motor that pulls against a blocked shaft, at a limit of one ampere.
fn over_current(bench: &mut Bench, motor: Motor) {
    *bench = Bench::of(crate::support::causes::limited_to_one_amp());
    bench.connect();
    bench.arm();
    bench.act(&WorldAction::LockShaft { motor, on: true });
    bench.set_duty(motor, "100");
}

/// An analog input whose minimum action stops a motor (1 is motor 1, 2 is motor 2 in generation 1), at its minimum.
fn home(bench: &mut Bench, action: u16) {
    bench.line.with(|bus| {
        let unit = &mut bus.controllers_mut()[0];
        let mut settings = unit.settings();
        settings.signals[PIN].kind = 1;
        settings.signals[PIN].min_action = action;
        let config = ControllerConfig { settings: Some(settings), ..unit.config().clone() };
        *unit = Controller::new(config).expect("the settings are sound");
    });
    bench.act(&WorldAction::SetPin { pin: PIN, signal: PinSignal::Volts { volts: 0.0 } });
    bench.press("Disconnect");
    bench.pass_ms(1000);
    bench.connect();
}

fn help(bench: &mut Bench, row: &Row) {
    bench.press(row.label);
    bench.pass_ms(300);
    let words = match row.usage {
        "do help_first_steps" => "Arm",
        "do help_packet_serial" => "CRC",
        "do help_settings" => "Main battery maximum",
        _ => env!("CARGO_PKG_VERSION"),
    };
    let lower = words.to_lowercase();
    let all = bench.harness.query_all_by(|node| {
        let text = node.label().or_else(|| node.value()).unwrap_or_default().to_lowercase();
        text.contains(&lower)
    });
    assert!(all.count() > 0, "{}: {words:?} is nowhere", row.label);
    bench.key(Key::Escape);
    bench.pass_ms(300);
}

fn menu(bench: &mut Bench, row: &Row, name: &str) {
    match name {
        "read_settings" | "default_settings" | "save_settings" => settings_menu(bench, row, name),
        "exit" => {
            bench.press(row.label);
            bench.pass_ms(1000);
            let closes = bench.harness.output().viewport_output.values().any(|viewport| {
                viewport.commands.iter().any(|command| matches!(command, egui::ViewportCommand::Close))
            });
            assert!(closes || !bench.model().is_connected(), "neither closed nor disconnected");
        }
        _ => {
            bench.press(row.label);
            bench.pass_ms(500);
            let word = if name == "firmware" { "firmware" } else { "can" };
            let said = bench.harness.query_all_by(|node| {
                let text = node.label().or_else(|| node.value()).unwrap_or_default();
                text.to_lowercase().contains(word)
            });
            assert!(said.count() > 1, "{row:?}");
            bench.key(Key::Escape);
            bench.pass_ms(300);
        }
    }
}

/// Device menu: each asks first, then does it.
fn settings_menu(bench: &mut Bench, row: &Row, name: &str) {
    let ram = |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].settings());
    let stored = |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].stored_settings());
    bench.key(Key::Escape);
    bench.press("General Settings");
    bench.pass_ms(3000);
    bench.press("Section Voltage limits");
    super::type_into(bench, "Main battery maximum", "33");
    write(bench);
    assert_eq!(value_of(&ram(bench), "main_max"), 330);
    bench.press("Device");
    bench.press(row.label);
    bench.pass_ms(300);
    match name {
        "save_settings" => {
            bench.press("Save");
            bench.pass_ms(10_000);
            assert_eq!(value_of(&stored(bench), "main_max"), 330);
        }
        "default_settings" => {
            bench.press("Restore defaults");
            bench.pass_ms(5_000);
            assert_eq!(value_of(&ram(bench), "main_max"), 600);
        }
        _ => {
            bench.press("Load from EEPROM");
            bench.pass_ms(5_000);
            assert_eq!(value_of(&ram(bench), "main_max"), 600, "what was not saved is gone");
        }
    }
    *bench = super::opened(row.place);
}

fn pin_list(bench: &mut Bench, row: &Row) {
    bench.press(row.label);
    bench.pass_ms(300);
    let name = row.label.trim_start_matches("Section ");
    assert!(bench.sees_part(&format!("{name}: mode")), "{name}");
    bench.press("Section Unit settings");
}

fn encoder_pin(bench: &mut Bench, row: &Row) {
    let description = bench.button("Section DIN7/AN7/P7/ENC1A").accesskit_node().description();
    assert_eq!(description.as_deref(), Some("DIN7/AN7/P7/ENC1A: Encoder"));
    // The other line of the pair.
    let other = bench.button("Section DIN9/AN8/P8/ENC1B").accesskit_node().description();
    assert_eq!(other.as_deref(), Some("DIN9/AN8/P8/ENC1B: Encoder"));
    super::pick(bench, row.label, "Analog");
    bench.press("Section Conflicts");
    bench.pass_ms(300);
    assert!(bench.sees_part("ENC1B"), "half a pair is told");
}

/// Every entry of a list, each held by the controller by its number.
fn each_choice(bench: &mut Bench, row: &Row, codes: &[Code], held: impl Fn(&Settings) -> i64) {
    for code in codes.iter().rev() {
        super::pick(bench, row.label, code.label);
        write(bench);
        let settings = bench.line.with(|bus| bus.controllers()[0].settings());
        assert_eq!(held(&settings), code.raw, "{}: {}", row.label, code.label);
    }
}

/// A live analog signal on the pin.
fn signal(bench: &mut Bench, row: &Row, name: &str) {
    let reading = match name {
        "set_min" => 300,
        "set_max" => 3500,
        _ => 1500,
    };
    let volts = f64::from(reading) / 4095.0 * 5.1;
    bench.act(&WorldAction::SetPin { pin: PIN, signal: PinSignal::Volts { volts } });
    bench.pass_ms(2500);
    let settings =
        |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].settings()).signals[PIN].clone();
    match name {
        "set_min" | "set_center" | "set_max" => {
            bench.press(row.label);
            write(bench);
            let signal = settings(bench);
            let taken = match name {
                "set_min" => signal.min,
                "set_center" => signal.center,
                _ => signal.max,
            };
            assert!((taken - reading).abs() <= 3, "{row:?}: {taken}");
        }
        "match_input" => {
            bench.press(row.label);
            write(bench);
            let signal = settings(bench);
            let range = (signal.min - signal.center, signal.max - signal.center);
            assert_eq!((signal.min_output, signal.max_output), range, "MCP manual 1.9.11");
        }
        "signal_graph" => assert!(bench.sees_part("Signal graph of DIN4/AN4/P4")),
        _ => {
            let shown = shown(bench, row.label);
            assert!(shown != "no value", "{row:?}");
            if row.label == "Signal position" {
                let center = settings(bench).center;
                assert!((number(&shown) - f64::from(reading - center)).abs() <= 3.0, "{shown}");
            }
        }
    }
}
