//! Guided tuning in the window against a simulated controller: a whole run, what is refused and how, Stop and leaving in the middle,
//! gains into RAM and back. The device loop runs in lockstep with the frames.

mod support;

use brushwork::gui::model::link::Arming;
use brushwork::gui::tune::Loop;
use brushwork_protocol::packet_serial::Motor;
use brushwork_sim::controller::{Controller, ControllerConfig};
use brushwork_sim::motion::MotionSettings;
use brushwork_sim::presets;
use brushwork_tuning::report::Verdict;
use support::bench::Bench;

fn config(preset: &str) -> ControllerConfig {
    let axis = presets::lookup(preset).expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    ControllerConfig { world, ..default }
}

/// The armed screen with guided tuning open.
fn opened(preset: &str, screen: &str) -> Bench {
    let mut bench = Bench::of(Controller::new(config(preset)).expect("the preset is sound"));
    bench.connect();
    bench.arm_on(screen);
    bench.press("Tune");
    bench
}

/// What the controller holds for a motor.
fn held(bench: &Bench, motor: Motor) -> MotionSettings {
    bench.line.with(|bus| bus.controllers()[0].settings().motors[motor.index()].motion)
}

fn timeout_ms(bench: &Bench) -> u32 {
    bench.line.with(|bus| bus.controllers()[0].settings().streams[0].timeout_ms)
}

#[track_caller]
fn finish(bench: &mut Bench) {
    for _ in 0..90 {
        if !bench.model().front.tune.is_running() {
            break;
        }
        bench.pass_ms(1000);
    }
    assert!(!bench.model().front.tune.is_running(), "it ends by itself");
    bench.pass_ms(1500);
    assert_at_rest(bench);
}

#[track_caller]
fn assert_at_rest(bench: &mut Bench) {
    assert!(bench.both_stand(), "{} {}", bench.real_duty(Motor::M1), bench.real_duty(Motor::M2));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

#[test]
fn a_velocity_loop_is_tuned_and_the_old_gains_are_in_force_until_the_new_ones_are_applied() {
    let mut bench = opened("small-gearmotor", "Velocity Settings");
    let (before, timeout) = (held(&bench, Motor::M1), timeout_ms(&bench));
    bench.press("Tune M1");
    assert!(bench.model().front.tune.is_running());
    bench.pass_ms(3000);
    assert!(bench.sees("Live speed of the run: speed") || bench.sees_part("Live speed of the run"));
    assert!(bench.sees_part("s left"));
    finish(&mut bench);
    let said: Vec<String> = bench.model().messages.past().map(|message| message.text.clone()).collect();
    let run = bench.model().front.tune.front(Loop::Velocity).run().cloned();
    let run = run.unwrap_or_else(|| panic!("{said:?}"));
    assert_ne!(run.report.verdict, Verdict::Refused, "{:?}", run.report.causes);
    assert_eq!(held(&bench, Motor::M1), before, "nothing stays in the controller by itself");
    assert_eq!(timeout_ms(&bench), timeout, "the time-out is the user's again");
    let proposed = run.first.expect("gains").velocity;
    bench.press("Apply (RAM)");
    bench.pass_ms(4000);
    let now = held(&bench, Motor::M1);
    assert_eq!(
        (now.velocity_p_raw, now.velocity_i_raw, now.velocity_d_raw, now.qpps),
        (proposed.p, proposed.i, proposed.d, proposed.qpps)
    );
    bench.press("Undo");
    bench.pass_ms(3000);
    assert_eq!(held(&bench, Motor::M1), before);
}
