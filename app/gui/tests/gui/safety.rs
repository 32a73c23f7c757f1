//! The safety rules, each against the real device loop and a simulated controller: what stops the motors, and when.

use std::time::Duration;

use crate::support::bench::{Bench, SECOND};
use brushwork_gui::model::link::Arming;
use brushwork_link::{Addresses, Clock as _};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// A window that drives motor 1 at 50 % and motor 2 at -30 %.
fn driving() -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.set_duty(Motor::M1, "50");
    bench.set_duty(Motor::M2, "-30");
    bench.pass_ms(1500);
    assert!(bench.real_duty(Motor::M1) > 0.45 && bench.real_duty(Motor::M2) < -0.25);
    bench
}

fn assert_stopped_and_disarmed(bench: &mut Bench) {
    assert!(bench.both_stand(), "{} {}", bench.real_duty(Motor::M1), bench.real_duty(Motor::M2));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
    assert_eq!(bench.model().front.pwm.setpoints.values, [0.0; 2]);
}

#[test]
fn space_stops_both_motors_and_disarms() {
    let mut bench = driving();
    bench.key(Key::Space);
    assert_stopped_and_disarmed(&mut bench);
    bench.pass_ms(3000);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn escape_stops_both_motors_and_disarms() {
    let mut bench = driving();
    bench.key(Key::Escape);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn the_stop_button_stops_and_so_does_enter_on_it() {
    let mut bench = driving();
    bench.press("Stop All");
    assert_stopped_and_disarmed(&mut bench);
    let mut bench = driving();
    bench.harness.get_by_role_and_label(Role::Button, "Stop All").focus();
    bench.pass_ms(100);
    bench.key(Key::Enter);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn space_stops_from_every_screen_that_there_is() {
    let screens = ["Device Status", "General Settings", "Velocity Settings", "Position Settings"];
    for screen in screens {
        let mut bench = driving();
        bench.press(screen);
        assert_stopped_and_disarmed(&mut bench);
        let stops = stops_seen(&mut bench);
        bench.key(Key::Space);
        bench.pass_ms(300);
        assert_eq!(stops_seen(&mut bench), stops + 1, "{screen}");
    }
}

/// How many stops the device thread has reported.
fn stops_seen(bench: &mut Bench) -> usize {
    bench.model().messages.past().filter(|message| message.text.to_string().starts_with("Stopped.")).count()
}

#[test]
fn space_never_presses_the_button_that_has_focus() {
    let mut bench = driving();
    for label in ["PWM Settings", "Device Status", "Zero M1 encoder", "Disconnect", "Arm", "M1 duty to zero"]
    {
        bench.focus(label);
        bench.key(Key::Space);
        bench.pass_ms(300);
        assert_stopped_and_disarmed(&mut bench);
        assert!(bench.model().is_connected(), "Space pressed {label}");
        assert_eq!(bench.model().screen, brushwork_gui::model::screen::Screen::Pwm, "Space pressed {label}");
    }
}

#[test]
fn enter_presses_the_button_that_has_focus() {
    let mut bench = Bench::new();
    bench.focus("PWM Settings");
    bench.key(Key::Enter);
    assert_eq!(bench.model().screen, brushwork_gui::model::screen::Screen::Pwm);
}

#[test]
fn space_stops_in_a_field_for_numbers_too() {
    let mut bench = driving();
    bench.harness.get_by_label("M1 duty exact").focus();
    bench.pass_ms(100);
    bench.harness.get_by_label("M1 duty exact").type_text("90");
    bench.key(Key::Space);
    bench.pass_ms(300);
    assert_stopped_and_disarmed(&mut bench);
    // What was typed and never entered does not come back when the field is left.
    bench.press("PWM Settings");
    bench.pass_ms(300);
    assert_stopped_and_disarmed(&mut bench);
    bench.press("Arm");
    bench.pass_ms(1000);
    assert!(bench.both_stand());
}

#[test]
fn a_space_typed_into_a_field_for_words_is_a_letter_and_escape_still_stops() {
    let mut bench = Bench::new();
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass_ms(100);
    bench.harness.event(egui::Event::Text("a".to_owned()));
    bench.harness.key_press(Key::Space);
    bench.harness.event(egui::Event::Text(" ".to_owned()));
    bench.harness.event(egui::Event::Text("b".to_owned()));
    bench.pass_ms(200);
    assert_eq!(bench.model().devices.typed, "a b");
}

/// The keys that the button names.
fn keys_of_stop_all(bench: &Bench) -> Option<String> {
    let button = bench.harness.get_by_role_and_label(Role::Button, "Stop All");
    button.accesskit_node().data().keyboard_shortcut().map(str::to_owned)
}

/// Whether the button is red at its edge, where no letters are.
fn stop_all_is_red(bench: &mut Bench) -> bool {
    let corner = bench.harness.get_by_role_and_label(Role::Button, "Stop All").rect().left_top();
    let picture = bench.harness.render().expect("a picture");
    let [red, green, blue, _] = picture.get_pixel(corner.x as u32 + 8, corner.y as u32 + 8).0;
    red > 2 * green.max(blue)
}

/// What has the keyboard is said to leave Space a letter or not, and that is what it is; Esc stops either way.
fn assert_keys_are_as_said(bench: &mut Bench, where_: &str, is_for_words: bool) {
    let said = if is_for_words { "Esc" } else { "Space or Esc" };
    assert_eq!(keys_of_stop_all(bench).as_deref(), Some(said), "{where_}");
    let stops = stops_seen(bench);
    bench.harness.key_press(Key::Space);
    bench.harness.event(egui::Event::Text(" ".to_owned()));
    bench.pass_ms(300);
    let by_space = usize::from(!is_for_words);
    assert_eq!(stops_seen(bench), stops + by_space, "{where_}: Space");
    bench.key(Key::Escape);
    bench.pass_ms(300);
    assert_eq!(stops_seen(bench), stops + by_space + 1, "{where_}: Esc");
}

#[test]
fn escape_stops_wherever_the_keyboard_is_and_the_button_names_the_keys_that_do() {
    let mut bench = Bench::new();
    bench.connect();
    assert_keys_are_as_said(&mut bench, "nowhere", false);
    bench.press("PWM Settings");
    bench.focus_label("M1 duty exact");
    assert_keys_are_as_said(&mut bench, "a number field", false);
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass_ms(200);
    assert_keys_are_as_said(&mut bench, "a field for words", true);
    bench.key_with(Modifiers { shift: true, ..Modifiers::COMMAND }, Key::P);
    bench.pass_ms(200);
    assert!(bench.sees("Command"));
    assert_keys_are_as_said(&mut bench, "the palette", true);
    assert!(!bench.sees("Command"), "Esc has closed it, too");
    bench.key(Key::F10);
    bench.pass_ms(3000);
    assert!(bench.sees("Back"), "a dialog is open: {:?}", bench.said());
    assert_keys_are_as_said(&mut bench, "a dialog", false);
    assert!(!bench.sees("Back"), "Esc has closed it, too");
    bench.press("MCL Editor");
    bench.pass_ms(200);
    bench.harness.event(egui::Event::Text("speed".to_owned()));
    bench.pass_ms(200);
    assert_keys_are_as_said(&mut bench, "the editor", true);
    bench.harness.get_by_role_and_label(Role::MultilineTextInput, "Program Untitled 1").focus();
    bench.key(Key::Home);
    bench.key_with(Modifiers { shift: true, ..Modifiers::COMMAND }, Key::R);
    bench.pass_ms(200);
    bench.harness.get_by_role_and_label(Role::TextInput, "New name");
    assert_keys_are_as_said(&mut bench, "the field of a rename", true);
    assert!(
        bench.harness.query_by_role_and_label(Role::TextInput, "New name").is_none(),
        "Esc has closed it, too"
    );
}

#[test]
fn words_on_an_armed_screen_name_the_keys_that_stop_at_this_moment() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    assert!(bench.said().contains(&"Armed for the PWM screen. Esc stops.".to_owned()));
    assert!(bench.sees_part("Keep clear. Space or Esc stops both."));
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass_ms(200);
    assert!(bench.sees_part("Keep clear. Esc stops both."));
    assert!(!bench.sees_part("Space or Esc"));
}

#[test]
fn stop_all_is_red_and_acts_while_any_unit_is_connected_and_another_is_searched() {
    let mut bench = Bench::new();
    assert!(!stop_all_is_red(&mut bench));
    bench.connect();
    assert!(stop_all_is_red(&mut bench));
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").type_text(SECOND);
    bench.pass_ms(100);
    bench.harness.key_press(Key::Enter);
    bench.harness.step();
    bench.harness.step();
    assert_eq!(bench.model().front.target.as_deref(), Some(SECOND));
    assert!(!bench.model().is_connected(), "the one in front is still searched");
    assert!(stop_all_is_red(&mut bench));
    let others = stops_of_first(&mut bench);
    bench.press("Stop All");
    bench.pass_ms(300);
    assert_eq!(stops_of_first(&mut bench), others + 1);
}

/// How many stops the first device has reported from the background.
fn stops_of_first(bench: &mut Bench) -> usize {
    bench
        .model()
        .messages
        .past()
        .filter(|message| message.text.to_string().starts_with("sim:mcp266: Stopped."))
        .count()
}

#[test]
fn a_stop_in_the_moment_of_arming_leaves_the_screen_disarmed() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("PWM Settings");
    bench.button("Arm").click();
    bench.harness.step();
    bench.harness.key_press(Key::Space);
    bench.harness.step();
    bench.pass_ms(1000);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn leaving_the_screen_disarms_and_stops() {
    let mut bench = driving();
    bench.press("Device Status");
    bench.pass_ms(200);
    assert_stopped_and_disarmed(&mut bench);
    bench.press("PWM Settings");
    bench.pass_ms(1000);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn the_arm_switch_disarms_and_stops() {
    let mut bench = driving();
    bench.press("Arm");
    bench.pass_ms(200);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn a_stop_from_another_program_stops_disarms_and_says_where_it_came_from() {
    let mut bench = driving();
    let app = bench.harness.state().as_ref().expect("the first frame made it");
    let told = app.device().expect("a link is open").stopper().stop_from_outside(Addresses::Scan);
    bench.pass_ms(500);
    assert_stopped_and_disarmed(&mut bench);
    let (units, report) = told.try_recv().expect("it was served");
    assert!(report.confirmed() && report.from_outside && units.len() == 1);
    let said = "Stopped by `brushwork stop`, from another program. The stop was on the wire after ";
    assert!(bench.sees_part(said), "{:?}", bench.said());
    // The next one is the window's own.
    bench.key(Key::Escape);
    bench.pass_ms(300);
    assert!(bench.said().first().is_some_and(|said| said.starts_with("Stopped. ")), "{:?}", bench.said());
}

#[test]
fn disconnecting_stops_first() {
    let mut bench = driving();
    bench.press("Disconnect");
    bench.pass_ms(500);
    assert_stopped_and_disarmed(&mut bench);
    assert!(!bench.model().is_connected());
}

#[test]
fn a_fault_of_the_controller_disarms() {
    let mut bench = driving();
    bench.act(&WorldAction::EStop { pressed: true });
    bench.pass_ms(1500);
    assert_stopped_and_disarmed(&mut bench);
    bench.act(&WorldAction::EStop { pressed: false });
    bench.pass_ms(3000);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn losing_the_link_disarms_and_the_controller_stops_by_its_own_time_out() {
    let mut bench = driving();
    bench.act(&WorldAction::Unplug { unplugged: true });
    bench.pass_ms(500);
    assert!(!bench.model().is_connected());
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
    assert!(bench.sees_part("the controller stops its motors by itself after 1.0 s of silence"));
    bench.pass_ms(1500);
    assert!(bench.both_stand());
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.pass_ms(5000);
    assert!(!bench.model().is_connected(), "nothing connects by itself");
    assert!(bench.both_stand());
}

#[test]
fn a_frozen_window_stops_the_motors_within_a_quarter_second_and_a_little() {
    let mut bench = driving();
    bench.freeze(Duration::from_millis(300));
    assert!(bench.both_stand(), "{}", bench.real_duty(Motor::M1));
    bench.pass_ms(500);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn after_a_pause_of_the_whole_program_the_screen_is_disarmed() {
    let mut bench = driving();
    // The computer slept: window and device loop stood still, only the controller's time went on.
    bench.line.clock.advance(Duration::from_secs(3));
    assert!(bench.both_stand(), "the controller's own time-out has stopped them");
    // The window wakes first and renews.
    bench.harness.step();
    bench.pass_ms(300);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn closing_the_window_stops_the_motors() {
    let mut bench = driving();
    let line = bench.line.clone();
    let mut device_loop = bench.take_loop();
    // The handle goes with the window; the loop then closes the link, which is what dropping waits for.
    drop(bench);
    while device_loop.step() != brushwork_link::device::Step::Ended {
        assert!(line.clock.now() < Duration::from_secs(60), "the loop ends");
    }
    line.clock.advance(Duration::from_millis(50));
    let duties = line.with(|bus| {
        use brushwork_plant::machine::Machine as _;
        bus.views().remove(0).axes.map(|axis| axis.output)
    });
    assert!(
        duties.iter().all(
            |output| !matches!(output, brushwork_plant::bridge::BridgeOutput::Duty(duty) if *duty != 0.0)
        ),
        "{duties:?}"
    );
}

#[test]
fn the_stop_is_on_the_wire_in_the_frame_of_the_key() {
    let mut bench = driving();
    bench.key(Key::Space);
    bench.pass_ms(300);
    let reported = bench
        .model()
        .messages
        .past()
        .find(|message| message.text.to_string().starts_with("Stopped."))
        .cloned();
    let reported = reported.expect("a stop is reported").text.to_string();
    let milliseconds: f64 = reported
        .split("after ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .and_then(|number| number.parse().ok())
        .expect("the sentence names the time");
    assert!(milliseconds <= 10.0, "{reported}");
}
