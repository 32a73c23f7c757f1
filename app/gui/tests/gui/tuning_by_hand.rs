//! The assistant for calibration by hand, from its first step to its last, by somebody who does what it says and nothing else.

use crate::support::bench::Bench;
use brushwork_gui::tune::Loop;
use brushwork_gui::tune::calibration::Advice;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_plant::presets;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::Key;

/// Full speed of the preset, counts/s, as measured.
const QPPS: &str = "10600";
/// More of its advice than this nobody follows.
const PATIENCE: usize = 60;

fn bench(screen: &str) -> Bench {
    let axis = presets::lookup("small-gearmotor").expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    let unit = Controller::new(ControllerConfig { world, ..default }).expect("the preset is sound");
    let mut bench = Bench::of(unit);
    bench.connect();
    bench.press(screen);
    bench.pass_ms(1000);
    if !bench.sees("M1 QPPS") {
        bench.press("Velocity loop");
    }
    bench.enter("M1 QPPS", QPPS);
    bench.press("Apply to RAM");
    bench.pass_ms(3000);
    bench.press("By hand");
    bench
}

fn held(bench: &Bench) -> MotionSettings {
    bench.line.with(|bus| bus.controllers()[0].settings().motors[0].motion)
}

/// What the assistant says now.
fn advice(bench: &mut Bench, which: Loop) -> Advice {
    let front = &bench.model().front;
    let held = front.held_gains(Motor::M1, which == Loop::Position);
    front.tune.calibration(which).advice(which, held)
}

fn arm(bench: &mut Bench) {
    bench.press("Arm");
    bench.pass_ms(500);
}

/// Says which button the advice speaks of; none when it is content.
fn button(text: &str) -> Option<&'static str> {
    let pairs = [
        ("Take P to two thirds", "P to two thirds"),
        ("Take I back", "I to two thirds"),
        ("Take D back", "D down 20 %"),
        ("Raise P", "P up 25 %"),
        ("raise it", "Next step"),
        ("Raise D", "D up 25 %"),
        ("Raise I", "I up"),
        ("Widen the deadzone", "Deadzone +1"),
    ];
    pairs.iter().find(|(words, _)| text.contains(words)).map(|(_, label)| *label)
}

#[test]
fn whoever_follows_it_ends_with_an_exact_and_smooth_velocity_loop() {
    let mut bench = bench("Velocity Settings");
    assert!(bench.sees("QPPS is 10600 counts/s. If that is right, go on."));
    bench.press("Next step");
    bench.press("Set P 1, I 0, D 0");
    bench.pass_ms(1500);
    assert!(bench.sees("Arm the screen and move the slider; then wait a second."));
    arm(&mut bench);
    bench.enter("M1 speed exact", "3500");
    bench.pass_ms(500);
    assert!(bench.sees_part("Watching the motor"), "{:?}", advice(&mut bench, Loop::Velocity));
    bench.pass_ms(4000);
    let mut said = Vec::new();
    for _ in 0..PATIENCE {
        let now = advice(&mut bench, Loop::Velocity);
        said.push(format!("{now:?}"));
        match now {
            Advice::Good(text) if text.to_string().contains("You are done") => break,
            Advice::Good(_) => bench.press("Next step"),
            Advice::Change(text) => {
                let label = button(&text.to_string())
                    .unwrap_or_else(|| panic!("nothing to press for {text:?}: {said:?}"));
                bench.press(if label == "I up" { "I up 0.02" } else { label });
            }
            Advice::Wait(_) => {}
            Advice::Danger(text) => panic!("{text}: {said:?}"),
        }
        bench.pass_ms(3500);
    }
    assert!(bench.sees_part("You are done"), "{said:#?}");
    let speed = bench.model().front.link.readings.get(brushwork_link::device::Channel::M1_VELOCITY);
    assert!(speed.is_some_and(|speed| (speed - 3500.0).abs() < 100.0), "{speed:?}");
    bench.key(Key::Space);
    bench.pass_ms(1500);
    assert!(bench.both_stand());
}

#[test]
fn whoever_follows_it_ends_with_a_position_loop_that_goes_there_and_is_quiet() {
    let mut bench = bench("Position Settings");
    assert!(bench.sees_part("Min and Max leave no travel"));
    bench.press("No end stops: a minute each way");
    bench.pass_ms(1500);
    assert!(bench.sees_part("velocity loop are not 0"));
    bench.press("Velocity P, I, D to 0");
    bench.pass_ms(1500);
    let now = held(&bench);
    let reach = 60 * i64::from(now.qpps);
    assert_eq!((-i64::from(now.position_min_counts), now.position_max_counts.into()), (reach, reach));
    assert!(bench.sees_part(&format!("and the travel goes from -{reach} to {reach} counts")));
    bench.press("Travel speed to QPPS");
    bench.press("Next step");
    bench.press("Set P 2, I 0, D 0");
    bench.pass_ms(1500);
    arm(&mut bench);
    let (mut said, mut there) = (Vec::new(), false);
    for _ in 0..PATIENCE {
        there = !there;
        bench.enter("M1 position exact", if there { "3000" } else { "0" });
        bench.pass_ms(5000);
        let now = advice(&mut bench, Loop::Position);
        said.push(format!("{now:?}"));
        match now {
            Advice::Good(text) if text.to_string().contains("You are done") => break,
            Advice::Good(_) => bench.press("Next step"),
            Advice::Change(text) => {
                let label = button(&text.to_string())
                    .unwrap_or_else(|| panic!("nothing to press for {text:?}: {said:?}"));
                bench.press(label);
                if label == "I up" {
                    bench.press("5. Max I");
                    bench.press("Max I up");
                    bench.pass_ms(1500);
                    bench.press("4. I and deadzone");
                }
            }
            Advice::Wait(_) => {}
            Advice::Danger(text) => panic!("{text}: {said:?}"),
        }
        bench.pass_ms(1500);
    }
    assert!(bench.sees_part("You are done"), "{said:#?}");
    let off = (bench.truth().axes[0].encoder_counts - if there { 3000 } else { 0 }).abs();
    assert!(off <= 3, "{off} counts from the place: {:?}", held(&bench));
    bench.key(Key::Escape);
    bench.pass_ms(1500);
    assert!(bench.both_stand());
}

#[test]
fn a_motor_that_runs_away_is_called_a_danger_at_once() {
    let mut bench = bench("Velocity Settings");
    bench.act(&WorldAction::ReverseLeads { motor: Motor::M1, on: true });
    bench.press("Next step");
    bench.press("Set P 1, I 0, D 0");
    bench.pass_ms(1500);
    arm(&mut bench);
    bench.enter("M1 speed exact", "2000");
    bench.pass_ms(4000);
    assert!(bench.sees_part("It runs away at full duty: stop."), "{:?}", advice(&mut bench, Loop::Velocity));
    bench.key(Key::Escape);
    bench.pass_ms(1500);
    assert!(bench.both_stand());
}

#[test]
fn ending_it_in_the_middle_stops_the_motor_and_leaves_what_was_turned_to_be_seen() {
    type End = fn(&mut Bench);
    let ends: [(&str, End); 4] = [
        ("Space", |bench| bench.key(Key::Space)),
        ("Esc", |bench| bench.key(Key::Escape)),
        ("leaving", |bench| bench.press("Device Status")),
        ("unplugging", |bench| bench.act(&WorldAction::Unplug { unplugged: true })),
    ];
    for (how, end) in ends {
        for step in 1..5 {
            let mut bench = bench("Velocity Settings");
            bench.press("Next step");
            bench.press("Set P 1, I 0, D 0");
            bench.pass_ms(1500);
            for _ in 1..step {
                bench.press("Next step");
            }
            arm(&mut bench);
            bench.enter("M1 speed exact", "3000");
            bench.pass_ms(1500);
            assert!(bench.real_duty(Motor::M1) > 0.1, "{how}, step {step}");
            end(&mut bench);
            bench.pass_ms(1500);
            assert!(bench.both_stand(), "{how}, step {step}: {}", bench.real_duty(Motor::M1));
            assert_eq!(
                held(&bench).velocity_p_raw,
                0x1_0000,
                "what was turned by hand stays until it is turned back"
            );
        }
    }
}
