//! Driving a Motion Mind 3 from the window: arming, sliders, jogs and steps by mode, every way out, and the assistants; by role
//! and label against a simulated unit in virtual time.

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_motion_mind_sim::{Mode, MotionMindConfig, pin};
use brushwork_motion_mind_wire::register_named;
use brushwork_plant::machine::Machine as _;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;
use egui::Key;

/// A window connected to one Motion Mind in a mode.
fn connected(mode: Mode) -> Bench {
    let mut bench = Bench::with_minds(vec![MotionMindConfig::new(mode)]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(3000);
    bench
}

fn duty(bench: &Bench) -> f64 {
    match bench.minds.with(|bus| bus.views().remove(0)).axes[Motor::M1.index()].output {
        brushwork_plant::bridge::BridgeOutput::Duty(duty) => duty,
        _ => 0.0,
    }
}

fn register(bench: &Bench, name: &str) -> i64 {
    let number = register_named(name).expect("a register of the manual").number;
    bench.minds.with(|bus| bus.motion_minds()[0].read_one(number))
}

/// A motor that runs at 40 % in mode 3.
fn running() -> Bench {
    let mut bench = connected(Mode::Serial);
    bench.arm_on("Duty");
    bench.enter("Motor duty exact", "40");
    bench.pass_ms(1000);
    assert!(duty(&bench) > 0.35, "{}", duty(&bench));
    bench
}

fn stands(bench: &Bench) -> bool {
    duty(bench) == 0.0
}

#[test]
fn a_disarmed_slider_moves_nothing() {
    let mut bench = connected(Mode::Serial);
    bench.press("Duty");
    bench.pass_ms(1000);
    assert!(stands(&bench));
    assert!(bench.sees("Arm"));
}

type Act = fn(&mut Bench);

#[test]
fn every_way_out_stops_the_motor() {
    let ways: [(&str, Act); 6] = [
        ("Space", |bench| bench.key(Key::Space)),
        ("Esc", |bench| bench.key(Key::Escape)),
        ("Stop All", |bench| bench.press("Stop All")),
        ("the arm switch", |bench| bench.press("Arm")),
        ("another screen", |bench| bench.press("Registers")),
        ("Disconnect", |bench| bench.press("Disconnect")),
    ];
    for (name, way) in ways {
        let mut bench = running();
        way(&mut bench);
        bench.pass_ms(800);
        assert!(stands(&bench), "{name}: {}", duty(&bench));
        assert!(
            bench.model().connections().all(|connection| connection.link.arming == Arming::Disarmed),
            "{name}"
        );
    }
}

#[test]
fn a_frozen_window_stops_the_motor() {
    let mut bench = running();
    bench.freeze(std::time::Duration::from_millis(900));
    assert!(stands(&bench), "{}", duty(&bench));
}

#[test]
fn a_brake_that_is_pulled_disarms() {
    let mut bench = running();
    let ground = PinSignal::Volts { volts: 0.0 };
    bench.minds.with(|bus| bus.apply(0, &WorldAction::SetPin { pin: pin::BRAKE, signal: ground }));
    bench.pass_ms(1500);
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

#[test]
fn a_velocity_is_held_in_counts_per_loop_and_a_jog_ends_with_the_hand() {
    let mut bench = connected(Mode::SerialPid);
    bench.arm_on("Velocity");
    bench.enter("Motor velocity exact", "10");
    bench.pass_ms(2500);
    let velocity = register(&bench, "VELOCITY");
    assert!((8..=12).contains(&velocity), "{velocity}");
    bench.press("Motor velocity to zero");
    bench.pass_ms(1500);
    assert!(register(&bench, "VELOCITY").abs() <= 1);
    bench.hold("Motor jog forward");
    bench.pass_ms(1000);
    assert!(register(&bench, "VELOCITY") > 3);
    bench.let_go("Motor jog forward");
    bench.pass_ms(1500);
    assert!(register(&bench, "VELOCITY").abs() <= 1);
}

#[test]
fn a_position_is_gone_to_and_steps_add_to_it() {
    let mut bench = connected(Mode::SerialPid);
    bench.arm_on("Position");
    bench.enter("Motor position exact", "1000");
    bench.pass_ms(3000);
    let position = register(&bench, "POSITION");
    assert_eq!(register(&bench, "DESIREDPOSITION"), 1000);
    assert!((position - 1000).abs() < 300, "{position}");
    bench.press("Step forward");
    bench.pass_ms(3000);
    assert_eq!(register(&bench, "DESIREDPOSITION"), 1500);
}

#[test]
fn the_step_assistant_prepares_turns_and_puts_back() {
    let mut bench = connected(Mode::SerialPid);
    bench.arm_on("Position");
    bench.press("Step response");
    bench.press("Prepare the registers");
    bench.pass_ms(6000);
    assert_eq!((register(&bench, "ITERM"), register(&bench, "VELOCITYFF")), (0, 0));
    bench.press("Next stage");
    let before = register(&bench, "PIDSCALAR");
    bench.press("Output ×2");
    bench.pass_ms(6000);
    assert_eq!(register(&bench, "PIDSCALAR"), before - 1);
    bench.press("Step forward");
    bench.pass_ms(5500);
    assert!(bench.sees_part("Last step: Step of 500 counts"), "the response was judged");
    bench.press("Put all back");
    bench.pass_ms(6000);
    assert_eq!((register(&bench, "ITERM"), register(&bench, "PIDSCALAR")), (35, before));
}

#[test]
fn the_radio_assistant_finds_the_ends_of_the_stick_and_writes_them_when_asked() {
    let mut bench = connected(Mode::RadioControl);
    bench.press("Inputs and R/C");
    bench.pass_ms(1000);
    bench.press("Start the calibration");
    let stick = |bench: &mut Bench, microseconds: f64| {
        let signal = PinSignal::Pulse { microseconds };
        bench.minds.with(|bus| bus.apply(0, &WorldAction::SetPin { pin: pin::INDEX_RC, signal }));
        bench.pass_ms(1500);
    };
    stick(&mut bench, 1560.0);
    bench.press("The stick is in the middle");
    assert!(bench.sees_part("Trim the transmitter"));
    stick(&mut bench, 1500.0);
    bench.press("The stick is in the middle");
    stick(&mut bench, 1930.0);
    bench.press("It was fully forward");
    stick(&mut bench, 1080.0);
    bench.press("It was fully back");
    bench.press("Use these values…");
    bench.pass_ms(500);
    bench.press("Write to controller");
    bench.pass_ms(5000);
    let near = |name: &str, microseconds: f64| {
        let found = register(&bench, name) as f64 * 1.736;
        assert!((found - microseconds).abs() < 4.0, "{name}: {found}");
    };
    near("RCMAX", 1930.0);
    near("RCMIN", 1080.0);
}

#[test]
fn the_graph_has_this_familys_channels() {
    let mut bench = running();
    bench.pass_ms(1000);
    assert!(bench.sees("Show M1 PWM") && bench.sees("Show M1 Velocity"));
    assert!(!bench.sees("Show M2 PWM") && !bench.sees("Show Main Battery"));
}
