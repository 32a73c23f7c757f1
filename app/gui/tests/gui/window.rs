//! The window against a simulated controller, in virtual time, by what a person reads and presses.

use crate::support::bench::Bench;
use brushwork_gui::model::message::Gravity;
use brushwork_gui::model::screen::Screen;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

#[test]
fn the_simulated_controller_is_in_the_list_and_connects() {
    let mut bench = Bench::new();
    assert!(bench.sees("Simulated MCP266: in this program, available"));
    bench.connect();
    assert!(bench.sees("Simulated MCP266: MCP266 · 0x80 · v1.0.0, connected"));
    assert!(bench.sees("Model: MCP266 (simulated)"));
    assert!(bench.sees("M1OC: OK"));
    assert!(bench.sees_part("Main battery: 24.0 V"));
    assert!(bench.both_stand(), "connecting never moves a motor");
}

#[test]
fn before_a_controller_is_connected_every_place_says_what_to_do() {
    let mut bench = Bench::new();
    bench.pass_ms(200);
    assert!(bench.sees("Start"));
    assert!(bench.sees("M1 encoder: no value"));
    assert!(bench.sees("ESTP: unknown"));
    assert!(bench.see("Zero M1 encoder").accesskit_node().is_disabled());
    for screen in ["PWM Settings", "Velocity Settings", "General Settings"] {
        bench.press(screen);
        assert!(bench.sees_part("No serial port is there. Plug the controller in"), "{screen}");
        assert!(bench.sees("Open MCP266") && bench.sees("Open Motion Mind 3"), "{screen}");
    }
    bench.press("MCL Editor");
    assert!(!bench.sees("Start"), "programs are written without a controller");
}

#[test]
fn the_start_page_opens_a_simulated_controller_a_port_and_what_was_open_before() {
    let mut bench = Bench::new();
    bench.pass_ms(200);
    bench.press("Open MCP266");
    bench.pass_ms(1000);
    assert!(bench.sees("Model: MCP266 (simulated)"));
    bench.press("Disconnect");
    bench.pass_ms(500);
    bench.press("Start page");
    assert!(bench.sees("sim:mcp266"), "what was open before");
    bench.press("Device Status");
    assert!(bench.sees("EVENT HISTORY"), "a screen of the list leads back to what was");
    bench.press("Start page");
    bench.plug_in_port("/dev/ttyUSB3");
    bench.pass_ms(200);
    bench.press("Connect to /dev/ttyUSB3");
    bench.pass_ms(500);
    assert!(bench.sees_part("/dev/ttyUSB3"), "{:?}", bench.said());
}

#[test]
fn what_is_in_the_way_of_a_port_is_told_with_what_to_type() {
    let mut bench = Bench::new();
    bench.pass_ms(200);
    assert!(!bench.sees_part("Use a cable that carries data"));
    bench.press("It does not appear, or cannot be opened");
    bench.pass_ms(500);
    assert!(bench.sees_part("Use a cable that carries data"));
    #[cfg(target_os = "linux")]
    assert!(bench.sees_part("sudo usermod -aG"));
}

#[test]
fn a_lost_link_leaves_the_graph_under_a_band_and_connecting_again_arms_nothing() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1500);
    let rows = bench.model().front.graph.live.track.history.rows().end;
    bench.act(&WorldAction::Unplug { unplugged: true });
    bench.pass_ms(3000);
    assert!(bench.sees("Start page") && bench.sees_part("Link lost"), "{:?}", bench.said());
    assert!(bench.sees_part("the controller stops its motors by itself after"), "what it does by itself");
    assert!(bench.sees_part("Live graph of the last"), "what was sampled stays in sight");
    assert!(bench.model().front.graph.live.track.history.rows().end >= rows);
    bench.press("Device Status");
    assert!(bench.sees_part("Link lost"), "the same band above what happened");
    assert!(bench.sees("EVENT HISTORY"));
    assert!(bench.sees_part("Live graph of the last"), "and below that the graph, here too");
    bench.press("PWM Settings");
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.press("Connect to sim:mcp266 again");
    bench.until("the controller answers again", |bench| bench.sees_part("connected"));
    bench.pass_ms(1500);
    assert!(!bench.sees("Start page"), "the band is gone: {:?}", bench.said());
    assert_eq!(bench.model().front.link.arming, brushwork_gui::model::Arming::Disarmed);
    bench.pass_ms(500);
    assert!(bench.both_stand());
}

#[test]
fn disconnecting_takes_back_what_was_shown_of_the_controller() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Disconnect");
    bench.pass_ms(500);
    assert!(bench.sees("Connect"));
    assert!(bench.sees("Model: no value"));
    assert!(bench.sees("M1OC: unknown"));
}

#[test]
fn serial_ports_come_and_go_in_the_list() {
    let mut bench = Bench::new();
    bench.plug_in_port("/dev/ttyUSB3");
    bench.pass_ms(200);
    bench.press("/dev/ttyUSB3: USB, available");
    bench.unplug_ports();
    bench.pass_ms(200);
    assert!(bench.sees("/dev/ttyUSB3: unplugged, gone"), "a chosen port is not dropped silently");
    bench.press("Simulated MCP266: in this program, available");
    assert!(!bench.sees_part("/dev/ttyUSB3"));
}

#[test]
fn a_typed_path_that_cannot_be_opened_is_told_in_a_sentence() {
    let mut bench = Bench::new();
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, "Other device").type_text("/dev/nothing");
    bench.pass_ms(100);
    bench.key(egui::Key::Enter);
    bench.pass_ms(500);
    assert!(bench.sees_part("Error: Could not open /dev/nothing"));
    assert!(bench.sees_part("there is no such port"));
    bench.press("Dismiss");
    assert!(!bench.sees_part("Error:"));
}

#[test]
fn the_thirteen_indicators_are_shown_in_full_on_the_status_screen() {
    let mut bench = Bench::new();
    bench.connect();
    for title in ["Motor 1 over current: OK", "Logic battery under voltage: OK", "Temperature 2: OK"] {
        assert!(bench.sees(title), "{title}");
    }
    // The manual: driver faults are not applicable to MCP controllers.
    assert!(bench.sees("Motor 1 driver fault: not reported"));
    bench.act(&WorldAction::EStop { pressed: true });
    bench.pass_ms(1500);
    assert!(bench.sees("Emergency stop: error"));
    assert!(bench.sees("ESTP: error"));
    assert!(bench.sees("Reset emergency stop"));
}

#[test]
fn a_low_battery_lights_its_indicator() {
    let mut bench = Bench::new();
    bench.connect();
    bench.act(&WorldAction::SetBatteryVolts { volts: 7.0 });
    bench.pass_ms(2500);
    assert!(bench.sees("MBLO: error") || bench.sees("MBLO: warning"));
    assert!(bench.sees_part("Main battery: 7.0 V"));
}

#[test]
fn armed_sliders_drive_the_motors_they_belong_to() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    assert!(bench.both_stand(), "arming never moves a motor");
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1500);
    assert!((bench.real_duty(Motor::M1) - 0.4).abs() < 0.01, "{}", bench.real_duty(Motor::M1));
    assert_eq!(bench.real_duty(Motor::M2), 0.0);
    assert!(bench.sees_part("M1 output: 40.0 %"));
    bench.pass_ms(5000);
    assert!(bench.real_duty(Motor::M1) > 0.3, "motion lives on while the window is alive");
}

#[test]
fn the_duty_follows_the_slider_at_the_acceleration_that_was_set() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.model().front.pwm.accel_percent_per_s = 20.0;
    bench.set_duty(Motor::M1, "100");
    bench.pass_ms(1000);
    let after_a_second = bench.real_duty(Motor::M1);
    assert!((0.15..0.40).contains(&after_a_second), "{after_a_second}");
}

#[test]
fn synchronised_sliders_drive_both_motors() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.press("Sync motors");
    bench.set_duty(Motor::M2, "-25");
    bench.pass_ms(1000);
    for motor in Motor::BOTH {
        assert!((bench.real_duty(motor) + 0.25).abs() < 0.01, "{motor}: {}", bench.real_duty(motor));
    }
}

#[test]
fn a_disarmed_slider_moves_nothing() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("PWM Settings");
    assert!(bench.see("M1 duty").accesskit_node().is_disabled());
    bench.model().front.pwm.set_duty(Motor::M1, 50.0);
    bench.pass_ms(1000);
    assert!(bench.both_stand());
}

#[test]
fn arming_is_refused_with_the_reason_while_the_emergency_stop_is_pressed() {
    let mut bench = Bench::new();
    bench.connect();
    bench.act(&WorldAction::EStop { pressed: true });
    bench.pass_ms(1500);
    bench.press("PWM Settings");
    bench.press("Arm");
    bench.pass_ms(500);
    assert!(!bench.model().front.link.refusals.is_empty(), "{:?}", bench.model().front.link.arming);
    assert_eq!(bench.model().messages.shown.as_ref().unwrap().gravity, Gravity::Error);
    assert!(bench.sees_part("Disarmed: nothing on this screen moves a motor"));
}

#[test]
fn zeroing_sets_the_count_of_that_encoder() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.set_duty(Motor::M1, "60");
    bench.pass_ms(2000);
    bench.key(egui::Key::Escape);
    bench.pass_ms(2000);
    let counted =
        bench.model().front.link.readings.text(brushwork_link::device::Channel::M1_POSITION).unwrap();
    assert_ne!(counted, "0");
    bench.press("Zero M1 encoder");
    bench.pass_ms(500);
    assert!(bench.sees("M1 encoder: 0"));
}

#[test]
fn screens_are_reached_by_key() {
    let mut bench = Bench::new();
    bench.connect();
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Num3);
    bench.pass_ms(200);
    assert_eq!(bench.model().screen, Screen::Pwm);
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Num6);
    bench.pass_ms(200);
    assert_eq!(bench.model().screen, Screen::MclEditor);
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Num4);
    bench.pass_ms(200);
    assert_eq!(bench.model().screen, Screen::Velocity);
}

#[test]
fn the_graph_names_what_it_shows_and_channels_are_switched_by_their_boxes() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("PWM Settings");
    bench.pass_ms(2000);
    assert!(bench.sees("Live graph of the last 10 s: M1 PWM, M1 Velocity, M1 Current"));
    bench.press("Show M1 Velocity");
    bench.press("Time in view");
    bench.press("30 s");
    assert!(bench.sees("Live graph of the last 30 s: M1 PWM, M1 Current"));
    let rows = bench.model().front.graph.live.track.history.rows();
    assert!((18..=60).contains(&(rows.end - rows.start)), "{rows:?} in about 2 s at 100 ms");
}

#[test]
fn the_world_panel_does_to_the_machine_what_it_says() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Simulated world");
    bench.press("E-stop pressed");
    assert!(bench.truth().estop_pressed);
    bench.press("E-stop pressed");
    assert!(!bench.truth().estop_pressed);
    bench.harness.get_by_label("Battery voltage").focus();
    bench.pass_ms(100);
    bench.harness.get_by_label("Battery voltage").type_text("18.5");
    bench.key(egui::Key::Enter);
    bench.pass_ms(1500);
    assert_eq!(bench.truth().battery_volts, 18.5);
    assert!(bench.sees_part("Main battery: 18.5 V"));
    bench.harness.get_all_by_label("Encoder lost").next().unwrap().click();
    bench.pass_ms(200);
    assert!(bench.truth().axes[0].truth.encoder_lost);
    bench.press("Power");
    assert!(!bench.truth().powered);
}

#[test]
fn a_cable_that_was_pulled_out_can_be_plugged_in_and_connected_again() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Simulated world");
    bench.press("Unplug cable");
    bench.pass_ms(500);
    assert!(bench.sees_part("Error:"));
    assert!(bench.sees("Connect"), "the link is closed, and nothing connects by itself");
    bench.pass_ms(5000);
    assert!(!bench.model().is_connected());
    bench.press("Plug cable in");
    bench.press("Dismiss");
    bench.connect();
}

#[test]
fn a_controller_without_power_is_told_in_a_sentence() {
    let mut bench = Bench::new();
    bench.act(&WorldAction::Power { on: false });
    bench.press("Connect");
    bench.pass_ms(5000);
    assert!(!bench.model().is_connected());
    assert!(bench.sees("Connect"));
    assert!(bench.sees_part("Error: Could not"));
}

#[test]
fn units_that_share_a_line_are_listed_and_one_is_looked_at() {
    let mut bench = Bench::with_two_units();
    bench.connect();
    assert!(bench.sees("0x80  MCP266") && bench.sees("0x81  MCP266"));
    bench.press("0x81  MCP266");
    bench.pass_ms(500);
    assert_eq!(bench.model().front.link.selected, Some(0x81));
    bench.arm();
    bench.set_duty(Motor::M1, "50");
    bench.pass_ms(1500);
    assert_eq!(bench.real_duty_of(0, Motor::M1), 0.0);
    assert!(bench.real_duty_of(1, Motor::M1) > 0.45);
    bench.press("0x80  MCP266");
    bench.pass_ms(500);
    assert_eq!(bench.real_duty_of(1, Motor::M1), 0.0, "going to another unit stops the one before");
}

#[test]
fn each_unit_of_a_line_has_a_row_with_its_battery_currents_and_errors() {
    let mut bench = Bench::with_two_units();
    bench.connect();
    let low = WorldAction::SetBatteryVolts { volts: 7.0 };
    bench.act_on(1, &low);
    bench.pass_ms(6_000);
    assert_eq!(bench.model().front.link.selected, Some(0x80));
    let row = |bench: &mut Bench, address| {
        let boards = &bench.model().front.link.boards;
        (boards.figures(address), boards.state(address).1)
    };
    let (first, second) = (row(&mut bench, 0x80), row(&mut bench, 0x81));
    assert!(first.0.starts_with("24.0 V  ") && first.0.contains("M2 "), "{first:?}");
    assert!(second.0.starts_with("7.0 V  ") && second.0.contains("M2 "), "{second:?}");
    assert_eq!(first.1, "OK");
    assert!(second.1.contains("Main battery low"), "{second:?}");
    assert!(bench.sees(&second.0) && bench.sees(&second.1), "the rows show it");
}

#[test]
fn the_panel_of_the_world_acts_on_the_unit_that_is_looked_at() {
    let mut bench = Bench::with_two_units();
    bench.connect();
    bench.press("0x81  MCP266");
    bench.press("Simulated world");
    bench.press("E-stop pressed");
    let pressed = bench.line.with(|bus| {
        use brushwork_plant::machine::Machine as _;
        bus.views().iter().map(|view| view.estop_pressed).collect::<Vec<_>>()
    });
    assert_eq!(pressed, [false, true]);
}

#[test]
fn the_graph_goes_on_after_a_new_connection_and_shows_the_time_between_as_a_gap() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(1000);
    bench.press("Disconnect");
    bench.pass_ms(3000);
    bench.connect();
    bench.pass_ms(1000);
    let graph = &bench.model().front.graph;
    let columns = brushwork_gui::graph::Columns::new(&graph.live.track.history, &graph.live.view(1000));
    let battery = graph.live.track.channel_of_key("main_battery").unwrap();
    let lines = graph.live.lines(battery, &columns);
    assert_eq!(lines.len(), 2, "{lines:?}");
}

#[test]
fn a_limit_switch_is_wired_to_a_pin_and_held_closed() {
    let mut bench = Bench::sized([1280.0, 1600.0], Theme::Dark);
    bench.connect();
    bench.press("Simulated world");
    bench.press("Pin 3 is connected to");
    bench.press("M1 forward switch");
    bench.harness.get_all_by_label("forward").next().unwrap().click();
    bench.pass_ms(300);
    assert_eq!(bench.truth().axes[0].switches_closed, [true, false, false]);
    bench.press("Pin 3 is connected to");
    bench.press("a voltage");
    assert_eq!(bench.truth().pins[2], brushwork_plant::world::PinSignal::Volts { volts: 2.5 });
    assert!(bench.truth().wiring.switches.is_empty());
}

#[test]
fn the_sampling_rate_is_chosen_beside_the_graph() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("PWM Settings");
    bench.press("Sampling");
    bench.press("every 10 ms");
    let before = bench.model().front.graph.live.track.history.rows().end;
    bench.pass_ms(1000);
    let samples = bench.model().front.graph.live.track.history.rows().end - before;
    assert!((90..=110).contains(&samples), "{samples} in a second");
}

#[test]
fn fitting_and_clearing_are_done_to_the_channel_that_was_selected() {
    // As high as the list of channels needs to show them all.
    let mut bench = Bench::sized([1280.0, 1100.0], Theme::Dark);
    bench.connect();
    bench.press("PWM Settings");
    bench.pass_ms(2000);
    let battery = bench.model().front.graph.live.track.channel_of_key("main_battery").unwrap();
    bench.press("Show Main Battery");
    assert_eq!(bench.model().front.graph.live.selected, battery);
    bench.press("Fit scale");
    let scale = bench.model().front.graph.live.channels[battery].scale;
    assert!(scale.low > 20.0 && scale.high < 28.0, "{scale:?}");
    bench.press("Clear");
    let graph = &bench.model().front.graph;
    let columns = brushwork_gui::graph::Columns::new(&graph.live.track.history, &graph.live.view(1000));
    let drawn: usize = graph.live.lines(battery, &columns).iter().map(Vec::len).sum();
    assert!(drawn <= 3, "{drawn} points are left");
}
