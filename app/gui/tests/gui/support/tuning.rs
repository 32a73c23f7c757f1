//! Guided tuning on the screens of an MCP: begun, watched, ended.

use crate::support::bench::Bench;
use brushwork_core::tune::law::AnyRegisters;
use brushwork_gui::model::link::Arming;
use brushwork_gui::tune::Loop;
use brushwork_gui::tune::run::Run;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_plant::presets;
use brushwork_tuning::report::Verdict;
use brushwork_values::Motor;

pub fn config(preset: &str) -> ControllerConfig {
    let axis = presets::lookup(preset).expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    ControllerConfig { world, ..default }
}

/// The armed screen with guided tuning open.
pub fn opened(preset: &str, screen: &str) -> Bench {
    let mut bench = Bench::of(Controller::new(config(preset)).expect("the preset is sound"));
    bench.connect();
    bench.arm_on(screen);
    bench.press("Tune");
    bench
}

/// What the controller holds for a motor.
pub fn held(bench: &Bench, motor: Motor) -> MotionSettings {
    bench.line.with(|bus| bus.controllers()[0].settings().motors[motor.index()].motion)
}

/// Presses what may have to be scrolled to first, as with a wheel.
pub fn press_below(bench: &mut Bench, label: &str) {
    bench.button(label).scroll_to_me();
    bench.pass_ms(300);
    bench.press(label);
}

pub fn timeout_ms(bench: &Bench) -> u32 {
    bench.line.with(|bus| bus.controllers()[0].settings().streams[0].timeout_ms)
}

#[track_caller]
pub fn finish(bench: &mut Bench) {
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
pub fn assert_at_rest(bench: &mut Bench) {
    assert!(bench.both_stand(), "{} {}", bench.real_duty(Motor::M1), bench.real_duty(Motor::M2));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

/// A run that has begun, and the gains from before it.
pub fn running(preset: &str, screen: &str) -> (Bench, MotionSettings) {
    let mut bench = opened(preset, screen);
    let before = held(&bench, Motor::M1);
    if screen == "Position Settings" {
        bench.press("Turns freely");
    }
    bench.press("Tune M1");
    assert!(bench.model().front.tune.is_running());
    (bench, before)
}

/// A loop of motor 1 that was tuned to its end.
pub fn tuned(screen: &str, which: Loop) -> Bench {
    let (mut bench, _) = running("small-gearmotor", screen);
    finish(&mut bench);
    let run = run(&mut bench, which);
    assert_ne!(run.report.verdict, Verdict::Refused, "{:?}", run.report.causes);
    bench
}

/// Looks each 100 ms at a run until it has ended.
#[track_caller]
pub fn while_running(bench: &mut Bench, mut look: impl FnMut(&Bench)) {
    /// Ten minutes: no run goes on for so long.
    const LOOKS: usize = 6000;
    for _ in 0..LOOKS {
        if !bench.model().front.tune.is_running() {
            return;
        }
        bench.pass_ms(100);
        look(bench);
    }
    panic!("it does not end by itself: {:?}", bench.said());
}

#[track_caller]
pub fn run(bench: &mut Bench, which: Loop) -> Run {
    let said: Vec<String> = bench.model().messages.past().map(|message| message.text.to_string()).collect();
    let run = bench.model().front.tune.front(which).run().cloned();
    run.unwrap_or_else(|| panic!("no run: {said:?}"))
}

pub fn proposed(bench: &mut Bench, which: Loop) -> AnyRegisters {
    run(bench, which).shown.expect("gains").registers
}

/// Bytes that have gone to the controller so far, and gains among them.
pub fn gains_sent(bench: &Bench) -> MotionSettings {
    held(bench, Motor::M1)
}

#[track_caller]
pub fn assert_holds(bench: &Bench, wanted: AnyRegisters) {
    let now = held(bench, Motor::M1);
    let velocity = wanted.first.first.velocity.expect("it has a velocity loop");
    assert_eq!(
        (now.velocity_p_raw, now.velocity_i_raw, now.velocity_d_raw, now.qpps),
        (velocity.p, velocity.i, velocity.d, velocity.qpps)
    );
    if let Some(position) = wanted.first.first.position {
        assert_eq!(
            (now.position_p_raw, now.position_i_raw, now.position_d_raw, now.position_max_i),
            (position.p, position.i, position.d, position.max_i)
        );
        assert_eq!((now.position_min_counts, now.position_max_counts), (position.min, position.max));
    }
}

/// What the simulated controller's ports begin with.
pub fn timeout_of_factory() -> u32 {
    let unit = Controller::new(ControllerConfig::default()).expect("the default is sound");
    unit.settings().streams[0].timeout_ms
}
