//! Device Status: why motors stand, indicators with their times, LEDs and history, against the simulated controller.

use crate::support::bench::Bench;
use crate::support::causes;
use brushwork_mcp_client::diagnosis::diagnose;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::{PinSignal, UnitFault, WorldAction};
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// The sentences of the diagnosis as they can be read in the window.
fn reasons(bench: &Bench) -> Vec<String> {
    let parts = ["Diagnosis: ", "Another reason: "];
    let labels = parts.into_iter().flat_map(|part| bench.harness.query_all_by_label_contains(part));
    labels.filter_map(|node| node.accesskit_node().label().or(node.accesskit_node().value())).collect()
}

#[test]
fn the_window_says_of_every_cause_what_is_so_and_what_to_do() {
    // A simulated controller in the program tells that its script does not run; `brushwork status` has to guess.
    for cause in causes::all().into_iter().filter(|cause| cause.name != "a script") {
        let mut bench = Bench::of(cause.controller());
        for action in &cause.actions {
            bench.act(action);
        }
        bench.connect();
        bench.pass_ms(1500);
        let reasons = reasons(&bench);
        let [what, cure] = cause.says;
        let lower = |text: &str| text.to_lowercase();
        let reported =
            |reason: &String| lower(reason).contains(&lower(what)) && lower(reason).contains(&lower(cure));
        assert!(reasons.iter().any(reported), "{}: {reasons:#?}", cause.name);
    }
}

#[test]
fn a_blocked_shaft_is_told_as_a_current_limit_while_the_motor_drives() {
    let mut bench = Bench::of(causes::limited_to_one_amp());
    bench.connect();
    bench.arm();
    bench.act(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.set_duty(Motor::M1, "100");
    bench.pass_ms(2000);
    assert!(bench.sees("M1OC: warning"));
    let evidence = {
        let pins = bench.model().front.pin_ends();
        bench.model().front.evidence(pins.as_deref()).map(|evidence| diagnose(&evidence).sentence())
    };
    let sentence = evidence.expect("the status was read");
    assert!(
        sentence.to_string().contains("motor 1 is at its current limit (")
            && sentence.to_string().contains("Free the shaft"),
        "{sentence}"
    );
    bench.press("Device Status");
    assert!(bench.sees_part("M1 over-current warning came"));
}

#[test]
fn indicators_say_since_when_and_the_history_lists_what_came_and_went() {
    let mut bench = Bench::new();
    bench.connect();
    let described = |bench: &Bench, label: &str| {
        bench
            .harness
            .get_by_role_and_label(Role::Status, label)
            .accesskit_node()
            .description()
            .unwrap_or_default()
    };
    assert!(described(&bench, "Emergency stop: OK").starts_with("since 0:00:0"));
    bench.pass_ms(10_000);
    bench.act(&WorldAction::EStop { pressed: true });
    bench.pass_ms(1000);
    assert!(described(&bench, "Emergency stop: error").starts_with("since 0:00:1"));
    assert!(bench.sees_part("0x80  E-Stop came"));
    assert!(bench.sees("E-Stop ×1"));
    bench.act(&WorldAction::EStop { pressed: false });
    bench.act(&WorldAction::Power { on: false });
    bench.pass_ms(3000);
    assert!(!bench.model().is_connected());
    // Why the link ended can still be read.
    assert!(bench.sees_part("Could not go on talking to the controller"));
    assert!(bench.sees_part("E-Stop came") && bench.sees("Link lost ×1"));
    bench.press("Clear history");
    assert!(!bench.sees_part("E-Stop came"));
}

#[test]
fn stops_and_disarmings_are_in_the_history_with_their_reasons() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.set_duty(Motor::M1, "30");
    bench.pass_ms(500);
    bench.key(egui::Key::Space);
    bench.pass_ms(500);
    bench.press("Device Status");
    for part in ["Armed for", "Disarmed: Stop was pressed", "Stop on the wire after"] {
        assert!(bench.sees_part(part), "{part}");
    }
    assert!(bench.sees("Stopped ×1"));
}

#[test]
fn the_leds_are_shown_as_the_simulated_controller_lights_them_and_in_words() {
    let mut bench = Bench::new();
    bench.connect();
    assert!(bench.sees("LED ERR: dark"));
    bench.act(&WorldAction::SetLogicVolts { volts: 20.0 });
    bench.pass_ms(1500);
    assert!(bench.sees("LED ERR: flashes 3 times"));
    assert!(bench.sees_part("logic battery high: the motors freewheel until a restart"));
    assert!(bench.sees_part("As the simulated controller lights them."));
    bench.act(&WorldAction::EStop { pressed: true });
    bench.pass_ms(1500);
    for led in ["LED STAT1: lit", "LED STAT2: lit", "LED ERR: lit"] {
        assert!(bench.sees(led), "{led}");
    }
}

#[test]
fn a_driver_fault_of_a_roboclaw_lights_its_indicator_and_disarms() {
    let model = models::lookup("roboclaw-2x30a").expect("it is in the list");
    let config = ControllerConfig { generation: Generation::Gen4, ..ControllerConfig::of(model) };
    let mut bench = Bench::of(Controller::new(config).expect("the default world is sound"));
    bench.connect();
    assert!(bench.sees("Motor 2 driver fault: OK"));
    bench.act(&WorldAction::SetUnitFault { fault: UnitFault::M2Driver, on: true });
    bench.act(&WorldAction::SetUnitFault { fault: UnitFault::Can, on: true });
    bench.pass_ms(1500);
    assert!(bench.sees("Motor 2 driver fault: error"));
    assert!(bench.sees_part("M2 driver fault came") && bench.sees_part("CAN warning came"));
    assert!(reasons(&bench)[0].contains("The motors do not run: the controller reports: M2 driver fault"));
}

#[test]
fn the_home_indicator_of_an_mcp_follows_the_action_of_its_pin() {
    let cause = causes::all().into_iter().find(|cause| cause.name == "an input at its end");
    let mut bench = Bench::of(cause.expect("it is in the list").controller());
    bench.act(&WorldAction::SetPin { pin: 0, signal: PinSignal::Volts { volts: 2.5 } });
    bench.connect();
    bench.pass_ms(1500);
    assert!(bench.sees("Motor 1 home or limit switch: OK"));
    assert!(bench.sees_part("M1HM and M2HM follow the actions of the input pins"));
    bench.act(&WorldAction::SetPin { pin: 0, signal: PinSignal::Volts { volts: 0.0 } });
    bench.pass_ms(1500);
    assert!(bench.sees("Motor 1 home or limit switch: active"));
    assert!(bench.sees("M1HM: active"));
    assert!(bench.sees_part("M1 home came"));
    assert_eq!(
        bench.model().front.link.status.map(|status| status.word),
        Some(0),
        "the word has no bit for it"
    );
}

#[test]
fn a_motor_that_gets_nothing_though_no_status_says_why_is_told_in_the_message_line() {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm();
    bench.set_duty(Motor::M1, "25");
    bench.pass_ms(2500);
    let told =
        |bench: &mut Bench| bench.said().iter().filter(|text| text.contains("M1 gets no output")).count();
    assert_eq!(told(&mut bench), 0);
    bench.act(&WorldAction::SetUnitFault { fault: UnitFault::M1Driver, on: true });
    bench.pass_ms(3000);
    assert_eq!(told(&mut bench), 1, "{:?}", bench.said());
    assert!(bench.sees_part("M1 gets no output, though a duty of 25.0 % was commanded and confirmed."));
}
