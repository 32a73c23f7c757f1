//! The voltage clamp test of General Settings against a simulated controller on a supply that takes nothing back, with
//! and without a brake resistor, in virtual time.

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_gui::model::message::Gravity;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_plant::presets;
use brushwork_plant::world::WorldAction;
use brushwork_plant::{BrakeResistorParams, SupplyParams};
use brushwork_values::Motor;
use egui::Key;

const OVER_VOLTAGE: u8 = 7;
/// Where the controller clamps, and where the test stops at first.
const MAXIMUM_VOLTS: f64 = 28.0;

/// A unit with a heavy flywheel on a 24 V supply that takes nothing back, set to clamp with DOUT1 above its maximum.
fn unit(resistor_ohms: Option<f64>, maximum_volts: f64) -> Controller {
    let mut config = ControllerConfig::default();
    let flywheel = presets::lookup("flywheel").expect("it is built in");
    config.world = presets::world_of(flywheel, flywheel, config.model.pins.len());
    config.world.supply = SupplyParams {
        can_sink: false,
        brake_resistor: resistor_ohms.map(|ohms| BrakeResistorParams { ohms, dout: 0 }),
        ..config.world.supply
    };
    let mut settings = Settings::factory(config.model, config.address.get());
    settings.battery.main_max_tenths = (maximum_volts * 10.0) as u16;
    settings.outputs[0].action = OVER_VOLTAGE;
    config.settings = Some(settings);
    Controller::new(config).expect("the world is sound")
}

/// Connected, on the page of the test, armed.
fn armed(resistor_ohms: Option<f64>) -> Bench {
    armed_with(unit(resistor_ohms, MAXIMUM_VOLTS))
}

fn armed_with(unit: Controller) -> Bench {
    let mut bench = Bench::of(unit);
    bench.connect();
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(3000);
    bench.press("Section Voltage clamp test");
    bench.press("Arm");
    bench.pass_ms(500);
    assert!(
        matches!(bench.model().front.link.arming, Arming::Armed { .. }),
        "{:?}",
        bench.model().front.link.refusals
    );
    bench
}

fn run(bench: &mut Bench) {
    bench.press("Start clamp test");
    for _ in 0..400 {
        if !bench.model().front.general.clamp.job.is_running() {
            break;
        }
        bench.pass_ms(500);
    }
    assert!(!bench.model().front.general.clamp.job.is_running());
    bench.pass_ms(500);
}

fn assert_stopped(bench: &mut Bench) {
    assert!(bench.both_stand());
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

#[test]
fn with_a_brake_resistor_the_test_runs_to_full_speed_and_the_voltage_stays_below_the_limit() {
    let mut bench = armed(Some(1.0));
    assert!(bench.sees_part("DOUT1 clamps over-voltage"));
    run(&mut bench);
    let test = &bench.model().front.general.clamp;
    let steps = test.steps.clone();
    let verdict = test.verdict.clone().unwrap();
    assert_eq!(verdict.gravity, Gravity::Note, "{verdict:?}");
    let duties: Vec<u32> = steps.iter().map(|step| (step.duty * 100.0).round() as u32).collect();
    assert_eq!(duties, (25..=100).step_by(5).collect::<Vec<_>>());
    let highest = steps.iter().map(|step| step.peak_volts).fold(0.0, f64::max);
    assert!((MAXIMUM_VOLTS..MAXIMUM_VOLTS + 2.0).contains(&highest), "the clamp had work to do: {highest}");
    assert!(
        steps.iter().all(|step| step.readings > 50 && !step.is_braked()),
        "the voltage was watched closely"
    );
    assert!(bench.sees_part("stayed below 30.0 V from every speed"));
    assert_stopped(&mut bench);
}

#[test]
fn without_one_it_stops_at_the_first_speed_from_which_the_voltage_reaches_the_limit() {
    // With a maximum of 40 V the controller itself does not brake before the test's limit.
    let mut bench = armed_with(unit(None, 40.0));
    bench.enter("Clamp test limit", "30");
    run(&mut bench);
    let test = &bench.model().front.general.clamp;
    let steps = test.steps.clone();
    let verdict = test.verdict.clone().unwrap();
    let (last, before) = steps.split_last().unwrap();
    assert!(last.is_over && last.duty < 1.0 && last.peak_volts >= 30.0, "{last:?}");
    assert!(before.iter().all(|step| !step.is_over && step.peak_volts < 30.0));
    assert_eq!(verdict.gravity, Gravity::Error);
    let sentence = verdict.sentence.to_string();
    assert!(sentence.contains("Stopped at") && sentence.contains("fewer ohms"), "{verdict:?}");
    assert_stopped(&mut bench);
    bench.pass_ms(3000);
    assert!(bench.both_stand(), "and nothing starts again");
}

#[test]
fn without_one_it_stops_where_the_controller_has_to_brake_by_itself() {
    let mut bench = armed(None);
    run(&mut bench);
    let test = &bench.model().front.general.clamp;
    let last = *test.steps.last().unwrap();
    let verdict = test.verdict.clone().unwrap();
    assert!(last.is_braked() && !last.is_over && last.duty < 1.0, "{last:?}");
    assert_eq!(verdict.gravity, Gravity::Error);
    assert!(
        verdict.sentence.to_string().contains("the controller braked the motor by itself"),
        "{verdict:?}"
    );
    assert_stopped(&mut bench);
}

#[test]
fn the_page_is_reached_and_armed_by_the_keyboard_alone() {
    let mut bench = Bench::of(unit(Some(1.0), MAXIMUM_VOLTS));
    bench.connect();
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, Key::P);
    bench.pass_ms(300);
    bench.harness.event(egui::Event::Text("voltage clamp".to_owned()));
    bench.pass_ms(300);
    bench.key(Key::Enter);
    bench.pass_ms(3000);
    assert!(bench.sees("Start clamp test"));
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, Key::A);
    bench.pass_ms(500);
    assert!(matches!(bench.model().front.link.arming, Arming::Armed { .. }));
    bench.focus("Start clamp test");
    bench.key(Key::Enter);
    bench.pass_ms(1500);
    assert!(bench.real_duty(Motor::M1) > 0.1);
    bench.key(Key::Escape);
    bench.pass_ms(500);
    assert_stopped(&mut bench);
}

#[test]
fn nothing_moves_before_the_page_is_armed() {
    let mut bench = armed(None);
    bench.press("Arm");
    bench.pass_ms(500);
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
    assert!(egui_kittest::kittest::NodeT::accesskit_node(&bench.button("Start clamp test")).is_disabled());
}

#[test]
fn cancel_space_leaving_and_a_frozen_window_each_end_it_with_the_motors_stopped() {
    for way in ["cancel", "space", "section", "screen", "sheet", "freeze", "unplug"] {
        let mut bench = armed(Some(1.0));
        bench.press("Start clamp test");
        bench.pass_ms(1500);
        assert!(bench.real_duty(Motor::M1) > 0.1, "{way}: it runs");
        match way {
            "cancel" => bench.press("Cancel clamp test"),
            "space" => bench.key(Key::Space),
            "section" => bench.press("Section Unit settings"),
            "screen" => bench.press("Device Status"),
            "sheet" => bench.press("Open profile"),
            "freeze" => bench.freeze(std::time::Duration::from_millis(600)),
            _ => bench.act(&WorldAction::Unplug { unplugged: true }),
        }
        bench.pass_ms(2500);
        assert!(bench.both_stand(), "{way}");
        assert_eq!(bench.model().front.link.arming, Arming::Disarmed, "{way}");
        assert!(!bench.model().front.general.clamp.job.is_running(), "{way}");
    }
}

#[test]
fn a_limit_below_the_supply_is_refused() {
    let mut bench = armed(None);
    bench.enter("Clamp test limit", "20");
    run(&mut bench);
    let verdict = bench.model().front.general.clamp.verdict.clone().unwrap();
    assert!(verdict.sentence.to_string().contains("not below the limit of 20.0 V"), "{verdict:?}");
    assert_stopped(&mut bench);
}
