//! One state of a unit's settings behind all screens: an edit, a write or a read of one is that of the others.

use crate::support::bench::Bench;
use brushwork_gui::model::loop_settings::VELOCITY;
use brushwork_gui::model::settings::UnitSettings;
use brushwork_gui::motion_mind::model::registers::key;
use brushwork_link::settings::SettingValue;
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use brushwork_motion_mind_wire::register_named;
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

const P: &str = "motor1.velocity.p";
/// The field of it in General Settings.
const TITLE: &str = "Motor 1: velocity P";

/// Connected, with everything read.
fn opened() -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(3000);
    assert!(unit(&mut bench).is_read());
    bench
}

fn unit(bench: &mut Bench) -> &mut UnitSettings {
    bench.model().front.settings.unit_mut().expect("a unit is looked at")
}

fn held_p_raw(bench: &Bench) -> u32 {
    bench.line.with(|bus| bus.controllers()[0].settings().motors[0].motion.velocity_p_raw)
}

/// Shows the velocity P of motor 1 in General Settings.
fn show_in_general(bench: &mut Bench) {
    bench.press("General Settings");
    bench.pass_ms(300);
    bench.model().front.general_view().go_to(P);
    bench.pass_ms(300);
}

fn field(bench: &Bench, title: &str) -> String {
    bench.harness.get_by_role_and_label(Role::TextInput, title).accesskit_node().value().unwrap_or_default()
}

fn type_into(bench: &mut Bench, title: &str, text: &str) {
    bench.harness.get_by_role_and_label(Role::TextInput, title).focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, title).type_text(text);
    bench.pass_ms(100);
    bench.key(egui::Key::Enter);
    bench.pass_ms(100);
}

#[test]
fn p_edited_in_general_settings_is_the_same_edit_on_the_velocity_screen() {
    let mut bench = opened();
    show_in_general(&mut bench);
    type_into(&mut bench, TITLE, "2.500");
    assert!(bench.sees("Edits: 1 not written"));
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    bench.open_tab("Velocity loop");
    assert!(bench.sees("1 setting changed and not applied yet."));
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    assert_eq!(held_p_raw(&bench), 0x2_8000);
    assert!(bench.sees("As the controller holds them."));
    show_in_general(&mut bench);
    assert!(bench.sees("Edits: none"));
    assert!(bench.sees_part("EEPROM: 1 written, not saved"));
    assert_eq!(field(&bench, TITLE), "2.500");
}

#[test]
fn p_edited_on_the_velocity_screen_is_the_same_edit_in_general_settings() {
    let mut bench = opened();
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    bench.open_tab("Velocity loop");
    bench.enter("M1 Velocity P", "2.500");
    show_in_general(&mut bench);
    assert!(bench.sees("Edits: 1 not written"));
    assert_eq!(field(&bench, TITLE), "2.500");
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert_eq!(held_p_raw(&bench), 0x2_8000);
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    bench.open_tab("Velocity loop");
    assert!(bench.sees("As the controller holds them."));
    assert!(unit(&mut bench).loop_edits(VELOCITY).is_empty());
}

#[test]
fn every_change_of_ram_or_of_an_edit_raises_the_revision() {
    let mut bench = opened();
    let mut before = unit(&mut bench).revision();
    let mut rises = |bench: &mut Bench, what: &str| {
        let now = unit(bench).revision();
        assert!(now > before, "{what}");
        before = now;
    };
    unit(&mut bench).set(P, SettingValue::Number(2.0));
    rises(&mut bench, "an edit");
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    bench.open_tab("Velocity loop");
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    rises(&mut bench, "a write");
    bench.press("Read again");
    bench.pass_ms(1000);
    rises(&mut bench, "a read");
    unit(&mut bench).set(P, SettingValue::Number(3.0));
    unit(&mut bench).revert(P);
    rises(&mut bench, "an edit taken back");
}

#[test]
fn a_command_by_hand_that_changes_ram_is_seen_on_every_screen() {
    let mut bench = opened();
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    bench.open_tab("Velocity loop");
    bench.model().front.traffic.open = true;
    bench.pass_ms(200);
    bench.press("Send a command");
    let composer = &mut bench.model().front.mcp_mut().composer;
    composer.choose(number::SET_VELOCITY_PID_M1, Generation::Gen1);
    // D, P, I and QPPS (MCP manual 2.4.1).
    composer.arguments = ["0", "131072", "0", "9000"].map(str::to_owned).to_vec();
    bench.pass_ms(200);
    bench.press("Send these bytes");
    bench.pass_ms(6000);
    assert_eq!(held_p_raw(&bench), 0x2_0000);
    assert_eq!(unit(&mut bench).held(Motor::M1, "velocity.p"), Some(2.0));
    assert_eq!(unit(&mut bench).confirmed(P), Some(SettingValue::Number(2.0)));
    assert_eq!(bench.model().front.top_speeds()[0], 9000.0, "the slider goes by it");
    let profile = unit(&mut bench).profile(false).expect("all is known");
    assert_eq!(profile.settings.get(P), Some(SettingValue::Number(2.0)));
}

#[test]
fn what_is_known_is_not_read_again_when_a_screen_opens() {
    let mut bench = opened();
    bench.model().front.traffic.open = true;
    bench.pass_ms(200);
    bench.press("Velocity Settings");
    bench.pass_ms(1000);
    bench.open_tab("Velocity loop");
    bench.press("General Settings");
    bench.pass_ms(1000);
    assert!(!bench.model().front.traffic.log.to_text().contains("velocity PID"), "nothing was asked for");
    assert!(bench.model().front.settings.running().is_none());
}

#[test]
fn a_register_written_by_one_screen_of_a_motion_mind_is_known_to_the_others() {
    let mut bench = Bench::with_minds(vec![MotionMindConfig::new(Mode::SerialPid)]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(3000);
    let pterm = key(register_named("PTERM").expect("it is in the manual"));
    unit(&mut bench).set(&pterm, SettingValue::Int(1234));
    assert_eq!(bench.model().front.settings.unit().map(|unit| unit.changes().len()), Some(1));
    bench.press("Registers");
    bench.pass_ms(1000);
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert!(unit(&mut bench).edits().is_empty());
    assert_eq!(bench.model().front.register("PTERM"), Some(1234));
}

#[test]
fn what_was_edited_elsewhere_is_not_applied_at_once_by_opening_a_screen() {
    let mut bench = opened();
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    bench.open_tab("Velocity loop");
    bench.press("At once");
    bench.press("General Settings");
    unit(&mut bench).set(P, SettingValue::Number(2.0));
    bench.press("Velocity Settings");
    bench.pass_ms(1000);
    bench.open_tab("Velocity loop");
    assert!(bench.sees("1 setting changed and not applied yet."));
    assert_eq!(held_p_raw(&bench), 0x1_0000);
}
