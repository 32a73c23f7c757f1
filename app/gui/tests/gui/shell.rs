//! What is always in view: device list, menus, palette, help, marks; and several devices open at once.

use crate::support::bench::{Bench, FRAME, SECOND};
use crate::support::words;
use brushwork_gui::actions;
use brushwork_gui::model::link::Arming;
use brushwork_gui::model::screen::Screen;
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use brushwork_plant::machine::Machine as _;
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// The duty that a motor of the second machine gets.
fn second_duty(bench: &Bench, motor: Motor) -> f64 {
    match bench.second.with(|bus| bus.views().remove(0)).axes[motor.index()].output {
        brushwork_plant::bridge::BridgeOutput::Duty(duty) => duty,
        _ => 0.0,
    }
}

/// Opens the second machine by the field for other devices; it comes to the front.
fn connect_second(bench: &mut Bench) {
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass(FRAME);
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").type_text(SECOND);
    bench.pass(FRAME);
    bench.key(Key::Enter);
    bench.pass_ms(1500);
    assert_eq!(bench.model().front.target.as_deref(), Some(SECOND));
    assert_eq!(bench.model().devices.typed, "", "it has a row of its own now");
    assert!(bench.model().is_connected(), "{:?}", bench.model().messages.past().collect::<Vec<_>>());
}

fn both_open() -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    connect_second(&mut bench);
    bench
}

fn press_keys(bench: &mut Bench, modifiers: Modifiers, key: Key) {
    bench.harness.key_press_modifiers(modifiers, key);
    bench.harness.step();
    bench.pass(FRAME * 2);
}

const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

// ---- several devices ----

#[test]
fn a_second_device_opens_beside_the_first_and_both_are_read() {
    let mut bench = both_open();
    assert_eq!(bench.model().others.len(), 1);
    assert!(bench.model().others[0].is_connected());
    assert!(bench.sees("Simulated MCP266: MCP266 · 0x80 · v1.0.0, connected"));
    assert!(bench.sees(&format!("{SECOND}: MCP266 · 0x80 · v1.0.0, connected, in front")));
    let rows = |bench: &mut Bench| {
        let others = &bench.model().others[0].graph;
        others.sheet().track.history.rows().end
    };
    let before = rows(&mut bench);
    bench.pass_ms(2000);
    let recorded = rows(&mut bench) - before;
    assert!(recorded >= 15, "the graph in the background recorded {recorded} samples in 2 s");
}

#[test]
fn stop_all_stops_every_open_device() {
    let mut bench = both_open();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1000);
    assert!(second_duty(&bench, Motor::M1) > 0.35);
    // The one behind is driven by somebody else on its line.
    let duty_of_m1 = brushwork_mcp_wire::packet_serial::Request::new(
        brushwork_mcp_wire::packet_serial::Address::new(0x80).unwrap(),
        32,
        &[16_384],
    );
    let bytes = duty_of_m1.encode(brushwork_mcp_wire::packet_serial::Generation::Gen1).unwrap();
    bench.line.with(|bus| {
        let stream = bus.stream();
        bus.receive(stream, &bytes);
    });
    bench.pass_ms(300);
    assert!(bench.real_duty(Motor::M1) > 0.45, "{}", bench.real_duty(Motor::M1));
    bench.key(Key::Space);
    bench.pass_ms(300);
    assert_eq!(second_duty(&bench, Motor::M1), 0.0);
    assert!(bench.both_stand(), "the device behind is stopped too");
}

#[test]
fn a_device_that_is_frozen_delays_the_stop_of_no_other() {
    let mut bench = both_open();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1000);
    // The first controller loses its power: its link waits for answers that never come.
    bench.act(&brushwork_plant::world::WorldAction::Power { on: false });
    bench.pass_ms(150);
    bench.key(Key::Space);
    bench.pass_ms(100);
    assert_eq!(second_duty(&bench, Motor::M1), 0.0, "within the frame after the key");
}

#[test]
fn switching_devices_disarms_and_stops_the_one_before() {
    let mut bench = both_open();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1000);
    bench.press("Simulated MCP266: MCP266 · 0x80 · v1.0.0, connected");
    bench.pass_ms(300);
    assert_eq!(bench.model().front.target.as_deref(), Some("sim:mcp266"));
    assert_eq!(second_duty(&bench, Motor::M1), 0.0);
    assert!(bench.model().connections().all(|connection| connection.link.arming == Arming::Disarmed));
    // The sliders of the one in front move the one in front.
    bench.arm();
    bench.set_duty(Motor::M2, "30");
    bench.pass_ms(1000);
    assert!(bench.real_duty(Motor::M2) > 0.25);
    assert_eq!(second_duty(&bench, Motor::M2), 0.0);
}

#[test]
fn opening_another_device_disarms_the_one_in_front() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1000);
    connect_second(&mut bench);
    assert!(bench.both_stand());
    assert!(bench.model().connections().all(|connection| connection.link.arming == Arming::Disarmed));
}

#[test]
fn keys_go_through_the_open_devices() {
    let mut bench = both_open();
    let second = bench.model().front.id();
    press_keys(&mut bench, Modifiers::COMMAND, Key::PageDown);
    assert_ne!(bench.model().front.id(), second);
    press_keys(&mut bench, Modifiers::COMMAND, Key::PageUp);
    assert_eq!(bench.model().front.id(), second);
}

#[test]
fn one_device_is_disconnected_and_the_other_goes_on() {
    let mut bench = both_open();
    bench.press("Disconnect from Simulated MCP266");
    bench.pass_ms(500);
    assert!(bench.model().is_connected());
    assert!(!bench.model().others[0].is_connected());
    bench.press(&format!("Disconnect from {SECOND}"));
    bench.pass_ms(500);
    assert!(!bench.model().is_connected());
    bench.press(&format!("Forget {SECOND}"));
    assert!(bench.model().connections().all(|connection| connection.target.as_deref() != Some(SECOND)));
}

#[test]
fn what_a_device_in_the_background_says_names_it() {
    let mut bench = both_open();
    bench.act(&brushwork_plant::world::WorldAction::Unplug { unplugged: true });
    bench.pass_ms(1000);
    assert!(bench.sees_part("sim:mcp266: "));
    assert!(bench.model().is_connected(), "the one in front is not touched");
}

#[test]
fn a_place_is_opened_once_and_connecting_again_brings_it_to_the_front() {
    let mut bench = both_open();
    bench.press("Simulated MCP266: MCP266 · 0x80 · v1.0.0, connected");
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass(FRAME);
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").type_text(SECOND);
    bench.pass(FRAME);
    bench.key(Key::Enter);
    assert_eq!(bench.model().front.target.as_deref(), Some(SECOND));
    assert_eq!(bench.model().connections().count(), 2);
}

#[test]
fn connections_of_before_are_in_the_recent_menu() {
    let mut bench = both_open();
    bench.press(&format!("Disconnect from {SECOND}"));
    bench.pass_ms(500);
    bench.press("Recent");
    bench.press(SECOND);
    bench.pass_ms(1500);
    assert_eq!(bench.model().front.target.as_deref(), Some(SECOND));
    assert!(bench.model().is_connected());
}

#[test]
fn ports_come_and_go_in_the_list() {
    let mut bench = Bench::new();
    bench.plug_in_port("/dev/ttyACM7");
    bench.pass_ms(200);
    bench.press("/dev/ttyACM7: USB, available");
    bench.unplug_ports();
    bench.pass_ms(200);
    assert!(bench.sees("/dev/ttyACM7: unplugged, gone"));
}

// ---- menus, palette, shortcuts ----

#[test]
fn every_menu_shows_its_actions_and_says_why_one_cannot_be_done() {
    let mut bench = Bench::new();
    for menu in actions::Menu::ALL {
        bench.press(menu.title());
        for action in actions::of_menu(menu) {
            let ready = (action.ready)(bench.model());
            let shown = bench.harness.query_all_by_label(action.title);
            let mut items = shown.filter(|node| {
                matches!(node.accesskit_node().role(), Role::MenuItem | Role::MenuItemCheckBox)
            });
            let node = items.next().unwrap_or_else(|| panic!("{} is not in its menu", action.id));
            assert_eq!(node.accesskit_node().is_disabled(), ready.is_err(), "{}", action.id);
            let reported = node.accesskit_node().data().description().unwrap_or_default().to_owned();
            assert_eq!(reported, ready.err().unwrap_or(action.help.into()), "{}", action.id);
        }
        bench.press(menu.title());
    }
}

#[test]
fn a_menu_item_does_what_it_says() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Device");
    bench.press("Default Settings…");
    // The settings are read first.
    bench.pass_ms(5000);
    assert_eq!(bench.model().screen, Screen::GeneralSettings);
    assert_eq!(
        bench.model().front.general.sheet.as_ref(),
        Some(&brushwork_gui::model::general::Sheet::Defaults)
    );
    bench.press("View");
    bench.press("Dark Theme");
    assert_eq!(bench.model().appearance.theme, egui::ThemePreference::Dark);
    bench.press("Help");
    bench.press("About Brushwork");
    assert!(bench.sees_part("Licence:"));
}

#[test]
fn menus_are_worked_by_keyboard_alone() {
    let mut bench = Bench::new();
    bench.focus("View");
    bench.key(Key::Enter);
    bench.pass(FRAME * 2);
    let item = bench.harness.get_by_role_and_label(Role::MenuItemCheckBox, "Light Theme");
    item.focus();
    bench.pass(FRAME);
    bench.key(Key::Enter);
    assert_eq!(bench.model().appearance.theme, egui::ThemePreference::Light);
}

#[test]
fn the_palette_finds_an_action_by_a_few_letters_and_runs_it_by_key() {
    let mut bench = Bench::new();
    press_keys(&mut bench, CTRL_SHIFT, Key::P);
    assert!(bench.sees("Command"));
    bench.harness.event(egui::Event::Text("velset".to_owned()));
    bench.pass(FRAME * 2);
    bench.key(Key::Enter);
    assert_eq!(bench.model().screen, Screen::Velocity);
    assert!(bench.model().palette.is_none());
}

#[test]
fn enter_in_a_palette_that_nothing_was_typed_into_does_nothing() {
    let mut bench = Bench::new();
    let tabs = bench.model().mcl.documents().len();
    press_keys(&mut bench, CTRL_SHIFT, Key::P);
    bench.key(Key::Enter);
    bench.pass(FRAME * 3);
    assert!(bench.model().palette.is_some(), "letters may be on their way");
    assert_eq!((bench.model().screen, bench.model().mcl.documents().len()), (Screen::DeviceStatus, tabs));
    bench.key(Key::ArrowDown);
    bench.key(Key::Enter);
    bench.pass(FRAME * 3);
    assert!(bench.model().palette.is_none(), "what was walked to is run");
}

#[test]
fn the_palette_is_walked_by_arrows_and_says_why_something_cannot_be_done() {
    let mut bench = Bench::new();
    press_keys(&mut bench, CTRL_SHIFT, Key::P);
    bench.harness.event(egui::Event::Text("zero encoder m2".to_owned()));
    bench.pass(FRAME * 2);
    bench.key(Key::ArrowDown);
    bench.key(Key::ArrowUp);
    bench.key(Key::Enter);
    assert!(bench.sees_part("Warning: Device: Zero Encoder M2: No controller is connected."));
    press_keys(&mut bench, CTRL_SHIFT, Key::P);
    bench.key(Key::Escape);
    assert!(bench.model().palette.is_none());
}

#[test]
fn a_space_typed_into_the_palette_is_a_letter_and_escape_in_it_still_stops() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1000);
    press_keys(&mut bench, CTRL_SHIFT, Key::P);
    bench.harness.key_press(Key::Space);
    bench.harness.event(egui::Event::Text(" ".to_owned()));
    bench.pass_ms(300);
    assert_eq!(bench.model().palette.as_ref().map(|palette| palette.query.as_str()), Some(" "));
    assert!(bench.real_duty(Motor::M1) > 0.35);
    bench.key(Key::Escape);
    bench.pass_ms(200);
    assert!(bench.both_stand());
}

#[test]
fn a_shortcut_of_what_cannot_be_done_says_why() {
    let mut bench = Bench::new();
    bench.key(Key::F5);
    assert!(bench.sees_part("Download MCL: "));
}

#[test]
fn the_window_is_made_larger_and_smaller() {
    let mut bench = Bench::new();
    press_keys(&mut bench, Modifiers::COMMAND, Key::Plus);
    assert_eq!(bench.model().appearance.scale_percent, 110);
    assert!((bench.harness.ctx.zoom_factor() - 1.1).abs() < 1e-6);
    press_keys(&mut bench, Modifiers::COMMAND, Key::Num0);
    assert!((bench.harness.ctx.zoom_factor() - 1.0).abs() < 1e-6);
}

// ---- help ----

#[test]
fn the_references_are_searched_and_show_an_entry_in_full() {
    let mut bench = Bench::new();
    bench.press("Help");
    bench.press("Packet Serial Reference");
    bench.pass(FRAME * 2);
    bench.harness.event(egui::Event::Text("duty_both".to_owned()));
    bench.pass(FRAME * 2);
    let entry = bench.harness.query_all_by_label_contains("34 ").next().expect("command 34 is found");
    entry.click();
    bench.pass(FRAME * 2);
    assert!(bench.sees_part("duty_m1: i16"));
    bench.press("Settings Reference");
    bench.pass(FRAME * 2);
    bench.harness.event(egui::Event::Text("max_amps".to_owned()));
    bench.pass(FRAME * 2);
    let entries = bench.harness.query_all_by_role(Role::ListBoxOption).count();
    assert!(entries > 0);
    bench.harness.query_all_by_role(Role::ListBoxOption).next().unwrap().click();
    bench.pass(FRAME * 2);
    assert!(bench.sees("Default") && bench.sees("On the wire"));
    bench.key(Key::Escape);
    assert!(bench.model().help.page.is_none());
}

#[test]
fn help_lists_every_shortcut() {
    let mut bench = Bench::sized([1280.0, 1600.0], Theme::Light);
    bench.key(Key::F2);
    bench.pass(FRAME * 2);
    let ctx = bench.harness.ctx.clone();
    for action in actions::all().filter(|action| action.keys != actions::Keys::None) {
        assert!(bench.harness.query_all_by_label(&action.keys_text(&ctx)).next().is_some(), "{}", action.id);
    }
}

// ---- marks ----

#[test]
fn the_mark_at_the_bottom_tells_where_the_settings_are() {
    let mut bench = Bench::new();
    assert!(bench.sees("Settings: no controller, no profile open"));
    bench.connect();
    assert!(bench.sees("Settings: EEPROM not known, no profile open"));
    bench.press("Settings: EEPROM not known, no profile open");
    assert_eq!(bench.model().screen, Screen::GeneralSettings);
}

// ---- names and room ----

/// Whatever can be used and has no name, by its role and place.
fn without_a_name(bench: &Bench) -> Vec<String> {
    words::without_a_name(&bench.harness)
}

#[test]
fn everything_that_can_be_used_has_a_name_on_every_screen() {
    let mut bench = both_open();
    for screen in Screen::USUAL.into_iter() {
        bench.press(screen.title());
        bench.pass_ms(4000);
        assert_eq!(without_a_name(&bench), [] as [String; 0], "{}", screen.title());
    }
    for open in ["Traffic", "Simulated World", "Settings Reference", "Packet Serial Reference", "First Steps"]
    {
        let action = actions::all().find(|action| action.title == open).unwrap();
        bench.press(action.place.menu.title());
        assert_eq!(without_a_name(&bench), [] as [String; 0], "menu {}", action.place.menu.title());
        let is_item = |node: &egui_kittest::Node<'_>| {
            matches!(node.accesskit_node().role(), Role::MenuItem | Role::MenuItemCheckBox)
        };
        bench.harness.get_all_by_label(open).find(is_item).expect("it is in its menu").click();
        bench.pass(FRAME * 3);
        assert_eq!(without_a_name(&bench), [] as [String; 0], "{open}");
    }
    press_keys(&mut bench, CTRL_SHIFT, Key::P);
    assert_eq!(without_a_name(&bench), [] as [String; 0], "the palette");
}

#[test]
fn everything_that_can_be_used_has_a_name_on_every_screen_of_a_motion_mind_and_in_its_tabs() {
    for mode in [Mode::RadioControl, Mode::Serial, Mode::SerialPid] {
        let mut bench =
            Bench::with_minds_sized(vec![MotionMindConfig::new(mode)], [1024.0, 700.0], Theme::Dark);
        bench.pass_ms(200);
        bench.choose("Simulated model", "Motion Mind 3");
        bench.connect();
        bench.pass_ms(3000);
        let family = bench.model().front.family();
        for screen in bench.model().front.screens() {
            let title = family.title(screen);
            bench.press(title);
            bench.pass_ms(1000);
            assert_eq!(without_a_name(&bench), [] as [String; 0], "{title} in {mode:?}");
            for tab in family.tabs(screen) {
                bench.press(tab.title(screen));
                assert_eq!(without_a_name(&bench), [] as [String; 0], "{} of {title}", tab.title(screen));
            }
            for label in ["Stop All", "BRK: OK", "IDX: OK", "Zero M1 encoder", "Disconnect"] {
                let window = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1024.0, 700.0));
                let mut found = bench.harness.query_all_by_label(label);
                assert!(found.any(|node| window.contains_rect(node.rect())), "{label} is cut off on {title}");
            }
        }
        bench.key_with(Modifiers::COMMAND, Key::B);
        bench.pass_ms(300);
        assert_eq!(without_a_name(&bench), [] as [String; 0], "the world");
    }
}

#[test]
fn at_the_smallest_size_the_shell_is_whole_on_every_screen() {
    let mut bench = Bench::sized([1024.0, 700.0], Theme::Dark);
    bench.connect();
    connect_second(&mut bench);
    let window = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1024.0, 700.0));
    for screen in Screen::USUAL.into_iter() {
        bench.press(screen.title());
        bench.pass_ms(1000);
        let always = [
            "Stop All",
            "M1OC: OK",
            "M2HM: OK",
            "Zero M2 encoder",
            "File",
            "Help",
            "Disconnect",
            screen.title(),
        ];
        for label in always {
            let found = bench.harness.query_all_by_label(label).any(|node| window.contains_rect(node.rect()));
            assert!(found, "{label} is cut off on {}", screen.title());
        }
        let battery = bench.harness.query_all_by_label_contains("Main battery: ").next().expect("a reading");
        assert!(window.contains_rect(battery.rect()), "{:?}", battery.rect());
    }
}

#[test]
fn a_typed_path_with_its_rate_fits_into_the_list() {
    let mut bench = Bench::sized([1024.0, 700.0], Theme::Dark);
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass(FRAME);
    bench
        .harness
        .get_by_role_and_label(Role::TextInput, "Other device")
        .type_text("/tmp/somewhere/controller");
    bench.pass(FRAME * 3);
    let edge = bench.see("Stop All").rect().right() + 0.5;
    for label in ["Other device", "Recent", "Address", "Baud rate", "Connect", "Device Status"] {
        let right = bench.see(label).rect().right();
        assert!(right <= edge, "{label} ends at {right} in a list of {edge}");
    }
}

#[test]
fn exit_stops_every_device_and_asks_the_window_to_close() {
    let mut bench = both_open();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1000);
    assert!(second_duty(&bench, Motor::M1) > 0.35);
    bench.harness.key_press_modifiers(Modifiers::COMMAND, Key::Q);
    bench.harness.step();
    let viewports = &bench.harness.output().viewport_output;
    let asked = viewports.values().flat_map(|viewport| &viewport.commands);
    assert!(asked.into_iter().any(|command| *command == egui::ViewportCommand::Close));
    bench.pass_ms(100);
    assert_eq!(second_duty(&bench, Motor::M1), 0.0);
}
