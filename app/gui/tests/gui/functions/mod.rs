//! Walks the table of Ion Studio's functions (`tests/ion_studio/functions.md`): finds each widget by role and label, uses it, and
//! compares with what the simulated controller then holds, does or sends.
#![expect(clippy::print_stdout, reason = "a failed row is named in the record of the test")]

mod driving;
mod graph;
mod mcl;
mod scenes;
mod tuning;

use crate::support::bench::Bench;
use brushwork_gui::model::screen::Screen;
use brushwork_link::settings::SettingsTable;
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use egui::accesskit::Role;
use egui::{Key, Theme};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

const TABLE: &str = include_str!("../../../../../tests/ion_studio/functions.md");

/// DIN4/AN4/P4 of an MCP266, in the order of command 144.
const PIN: usize = 3;

#[derive(Clone, Copy, Debug)]
struct Row {
    section: &'static str,
    function: &'static str,
    place: &'static str,
    role: &'static str,
    label: &'static str,
    usage: &'static str,
    controller: &'static str,
}

fn rows() -> Vec<Row> {
    let lines = TABLE.lines().filter(|line| line.starts_with("| 1."));
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [section, function, place, role, label, usage, controller] = cells[..] else {
            panic!("seven columns: {line}")
        };
        Row { section, function, place, role, label, usage, controller }
    };
    lines.map(row).collect()
}

/// Rows of one place after the other share a window.
fn walk(wanted: &[&str]) {
    let rows: Vec<Row> = rows().into_iter().filter(|row| wanted.contains(&row.section)).collect();
    assert!(!rows.is_empty(), "no rows of {wanted:?}");
    for group in rows.chunk_by(|one, next| one.place == next.place && one.section == next.section) {
        let mut bench = opened(group[0].place);
        for row in group {
            use_row(&mut bench, row);
        }
    }
}

#[test]
fn connection_and_status() {
    walk(&["1.2.2", "1.2.3", "1.2.4", "1.2.5"]);
}

#[test]
fn menus() {
    walk(&["1.2.6", "1.2.7", "1.2.8", "1.2.9"]);
}

#[test]
fn general_settings() {
    walk(&["1.2.10"]);
}

#[test]
fn pwm_settings() {
    walk(&["1.2.11"]);
}

#[test]
fn velocity_settings() {
    walk(&["1.2.12"]);
}

#[test]
fn position_settings() {
    walk(&["1.2.13"]);
}

#[test]
fn mcl_editor() {
    walk(&["1.2.14"]);
}

#[test]
fn ports_and_buses() {
    walk(&["1.9.2", "1.9.3", "1.9.4", "1.9.5", "1.9.6", "1.9.7"]);
}

#[test]
fn inputs_and_outputs() {
    walk(&["1.9.8", "1.9.9", "1.9.10", "1.9.11", "1.9.12"]);
}

#[test]
fn every_section_of_the_manual_is_walked() {
    let mut sections: Vec<&str> = rows().iter().map(|row| row.section).collect();
    sections.dedup();
    for section in (2..=14).map(|section| format!("1.2.{section}")) {
        assert!(sections.contains(&section.as_str()), "{section}");
    }
    for section in (2..=12).map(|section| format!("1.9.{section}")) {
        assert!(sections.contains(&section.as_str()), "{section}");
    }
}

/// On which controllers a setting can be written, by its title: as the table of settings says of each generation.
fn controllers(title: &str) -> Option<String> {
    brushwork_link::install(&[&brushwork_mcp_client::McpDriver]);
    let model = models::lookup("mcp266").expect("it is listed");
    let is_writable = |generation: Generation| {
        let table = SettingsTable::new(brushwork_mcp_client::subject(model, generation));
        let row = table.rows().iter().find(|row| row.title() == title);
        row.map(|row| (generation.number(), row.locked(false).is_none()))
    };
    let generations: Vec<(u8, bool)> = Generation::ALL.into_iter().filter_map(is_writable).collect();
    let first = generations.iter().find(|(_, is_writable)| *is_writable);
    match first {
        _ if generations.is_empty() => None,
        None => Some("simulated only".to_owned()),
        Some(_) if generations.iter().all(|(_, is_writable)| *is_writable) => Some("real".to_owned()),
        Some((first, _)) => Some(format!("real from generation {first}")),
    }
}

#[test]
fn the_table_says_of_each_function_on_which_controllers_it_works() {
    let mut judged = 0;
    for row in rows() {
        let wanted = match (row.function, row.usage) {
            ("Digital input", _) => controllers("DIN4/AN4/P4: digital input"),
            // The compiler's images are for simulated controllers (`device/mcp/client/src/script`).
            (_, "do mcl_download") => Some("simulated only".to_owned()),
            _ => controllers(row.label),
        };
        judged += usize::from(wanted.is_some());
        assert_eq!(row.controller, wanted.as_deref().unwrap_or("real"), "{row:?}");
    }
    assert!(judged > 50, "{judged} rows are settings of the table");
}

// ----- places

/// A window on the place that a row names.
fn opened(place: &str) -> Bench {
    let mut bench = Bench::sized([1280.0, 1000.0], Theme::Dark);
    if place == "Start" {
        bench.pass_ms(300);
        return bench;
    }
    bench.connect();
    if place.starts_with("Menu") || matches!(place, "Left" | "Top" | "Bottom" | "MCL") {
        return bench;
    }
    let (screen, part) = place.split_once(", ").unwrap_or((place, ""));
    if Screen::ALL.iter().any(|known| known.title() == screen) {
        bench.press(screen);
        bench.pass_ms(1000);
        match part {
            "Velocity loop" => bench.press("Velocity loop"),
            "tuned" => tune_position(&mut bench),
            "Tune" => bench.press("Tune"),
            _ => {
                let screen = bench.model().screen;
                let tabs = bench.model().front.family().tabs(screen);
                tabs.first().map(|tab| tab.title(screen)).into_iter().for_each(|title| bench.open_tab(title));
            }
        }
        return bench;
    }
    bench.press("General Settings");
    bench.pass_ms(3000);
    let (page, mode) = place.split_once(", ").unwrap_or((place, ""));
    let section = format!("Section {page}");
    bench.button(&section).scroll_to_me();
    bench.pass_ms(300);
    bench.press(&section);
    if !mode.is_empty() {
        pick(&mut bench, &format!("{page}: mode"), "Analog");
        if mode == "load home" {
            pick(&mut bench, &format!("{page}: minimum action"), "M1 load home");
        }
        write(&mut bench);
    }
    bench
}

/// Loops that work on both motors: position over velocity, within -20 000 to 20 000 counts.
fn tune_position(bench: &mut Bench) {
    bench.press("Velocity loop");
    for (field, value) in [("M1 QPPS", "10600"), ("M1 Velocity I", "0.05"), ("M1 Velocity D", "0")] {
        bench.enter(field, value);
    }
    bench.press("Copy M1 to M2");
    apply(bench);
    bench.press("Position loop");
    for (field, value) in
        [("M1 Position P", "15"), ("M1 Minimum position", "-20000"), ("M1 Maximum position", "20000")]
    {
        bench.enter(field, value);
    }
    bench.press("Copy M1 to M2");
    apply(bench);
}

fn apply(bench: &mut Bench) {
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
}

fn write(bench: &mut Bench) {
    bench.press("Write settings");
    bench.press("Write to controller");
    for _ in 0..60 {
        bench.pass_ms(100);
        if bench.model().front.settings.running().is_none() {
            break;
        }
    }
}

/// Chooses from a list, which is scrolled to the entry first, as with a wheel.
fn pick(bench: &mut Bench, list: &str, entry: &str) {
    bench.press(list);
    bench.button(entry).scroll_to_me();
    bench.pass_ms(300);
    bench.press(entry);
}

fn arm(bench: &mut Bench) {
    bench.press("Arm");
    bench.pass_ms(500);
}

// ----- rows

fn use_row(bench: &mut Bench, row: &Row) {
    let menu = row.place.strip_prefix("Menu ");
    mcl::prepare(bench, row.usage.trim_start_matches("do "));
    if let Some(menu) = menu {
        bench.press(menu);
    }
    println!("{} {}: {}", row.section, row.function, row.usage);
    assert!(finds(bench, row), "nothing of this role and label: {row:?}");
    let (verb, rest) = row.usage.split_once(' ').unwrap_or((row.usage, ""));
    let (given, held) = rest.split_once(" -> ").unwrap_or((rest, ""));
    match verb {
        "type" => {
            type_into(bench, row.label, given);
            write(bench);
        }
        "choose" => {
            pick(bench, row.label, given);
            write(bench);
        }
        "tick" => {
            bench.press(row.label);
            write(bench);
        }
        "do" => scenes::play(bench, row, given),
        other => panic!("{other}: {row:?}"),
    }
    if let Some((key, expected)) = held.rsplit_once(' ') {
        let settings = bench.line.with(|bus| bus.controllers()[0].settings());
        assert_eq!(value_of(&settings, key).to_string(), expected, "{row:?}");
    }
}

fn role_of(row: &Row) -> Role {
    match row.role {
        "Button" => Role::Button,
        "MenuItem" => Role::MenuItem,
        "Label" => Role::Label,
        "Status" => Role::Status,
        "TextInput" => Role::TextInput,
        "ComboBox" => Role::ComboBox,
        "CheckBox" => Role::CheckBox,
        "SpinButton" => Role::SpinButton,
        "Slider" => Role::Slider,
        "Image" => Role::Image,
        "RadioButton" => Role::RadioButton,
        other => panic!("no such role: {other}"),
    }
}

fn finds(bench: &Bench, row: &Row) -> bool {
    let role = role_of(row);
    let is = |text: &str| {
        text == row.label || role == Role::Label && text.starts_with(&format!("{}: ", row.label))
    };
    let mut nodes = bench.harness.query_all_by_label_contains(row.label);
    nodes.any(|node| {
        let node = node.accesskit_node();
        node.role() == role
            && (node.label().is_some_and(|text| is(&text)) || node.value().is_some_and(|text| is(&text)))
    })
}

fn type_into(bench: &mut Bench, field: &str, text: &str) {
    bench.harness.get_by_role_and_label(Role::TextInput, field).focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, field).type_text(text);
    bench.pass_ms(100);
    bench.key(Key::Enter);
    bench.pass_ms(100);
}

/// What the controller works with, by a short name.
fn value_of(settings: &Settings, key: &str) -> i64 {
    let motor = usize::from(key.ends_with("_m2"));
    let motion = &settings.motors[motor].motion;
    let signal = &settings.signals[PIN];
    let [usb, rs232, ttl1, ttl2, _] = &settings.streams;
    match key {
        "address" => settings.unit.address.into(),
        "estop_lock" => settings.unit.estop_lock.into(),
        "mixed" => settings.unit.mixed.into(),
        "pwm_mode" => settings.motors[0].pwm_mode.into(),
        "bridged" => settings.unit.bridged.into(),
        "encoder_m1" | "encoder_m2" => settings.motors[motor].encoder_mode.into(),
        "main_min" => settings.battery.main_min_tenths.into(),
        "main_max" => settings.battery.main_max_tenths.into(),
        "logic_min" => settings.battery.logic_min_tenths.into(),
        "logic_max" => settings.battery.logic_max_tenths.into(),
        "max_current_m1" | "max_current_m2" => motion.max_current_raw.into(),
        "min_current_m1" | "min_current_m2" => motion.min_current_raw.into(),
        "priority_1" => settings.priority[0].into(),
        "priority_2" => settings.priority[1].into(),
        "priority_3" => settings.priority[2].into(),
        "autorun_ms" => settings.unit.script_autorun_ms.into(),
        "can_rate" => settings.unit.can_rate_bps.into(),
        "can_node" => settings.unit.can_node_id.into(),
        "i2c_rate" => settings.unit.i2c_rate_bps.into(),
        "usb_kind" => usb.kind.into(),
        "usb_timeout" => usb.timeout_ms.into(),
        "rs232_kind" => rs232.kind.into(),
        "rs232_rate" => rs232.rate_bps.into(),
        "rs232_timeout" => rs232.timeout_ms.into(),
        "ttl1_kind" => ttl1.kind.into(),
        "ttl1_rate" => ttl1.rate_bps.into(),
        "ttl1_timeout" => ttl1.timeout_ms.into(),
        "ttl1_multi" => ttl1.multi_unit.into(),
        "ttl2_kind" => ttl2.kind.into(),
        "dout_inverted" => settings.outputs[0].inverted.into(),
        "pin_kind" => signal.kind.into(),
        "pin_digital" => signal.digital.into(),
        "pin_timeout" => signal.timeout_ms.into(),
        "pin_min" => signal.min.into(),
        "pin_center" => signal.center.into(),
        "pin_max" => signal.max.into(),
        "pin_low_pass" => signal.low_pass.into(),
        "pin_deadband" => signal.deadband.into(),
        "pin_power_exp" => signal.power_exp_raw.into(),
        "pin_power_min" => signal.power_min.into(),
        "pin_load_home" => signal.load_home.into(),
        "pin_min_action" => signal.min_action.into(),
        "pin_max_action" => signal.max_action.into(),
        "pin_mode" => signal.mode.into(),
        "pin_min_output" => signal.min_output.into(),
        "pin_max_output" => signal.max_output.into(),
        "pin_target" => signal.target.into(),
        _ => loop_value(motion, key.trim_end_matches("_m1").trim_end_matches("_m2")),
    }
}

fn loop_value(motion: &brushwork_mcp_sim::motion::MotionSettings, key: &str) -> i64 {
    match key {
        "velocity_p" => motion.velocity_p_raw.into(),
        "velocity_i" => motion.velocity_i_raw.into(),
        "velocity_d" => motion.velocity_d_raw.into(),
        "qpps" => motion.qpps.into(),
        "inductance" => motion.inductance_raw.into(),
        "resistance" => motion.resistance_raw.into(),
        "position_p" => motion.position_p_raw.into(),
        "position_i" => motion.position_i_raw.into(),
        "position_d" => motion.position_d_raw.into(),
        "max_i" => motion.position_max_i.into(),
        "deadzone" => motion.position_deadzone_counts.into(),
        "position_min" => motion.position_min_counts.into(),
        "position_max" => motion.position_max_counts.into(),
        _ => panic!("no such value: {key}"),
    }
}
