//! Guided tuning in the window against a simulated controller: a whole run, what is refused and how, Stop and leaving in the middle,
//! gains into RAM and back. The device loop runs in lockstep with the frames.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_core::tune::law::AnyRegisters;
use brushwork_core::tune::law::Report;
use brushwork_gui::model::link::Arming;
use brushwork_gui::model::loop_settings::VELOCITY;
use brushwork_gui::model::settings::SettingsAction;
use brushwork_gui::tune::Loop;
use brushwork_gui::tune::run::Run;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_plant::presets;
use brushwork_plant::world::WorldAction;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::registers::RegisterTable as _;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Identification;
use brushwork_tuning::winding::{Winding, WindingUnknown};
use brushwork_values::Motor;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

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

/// Presses what may have to be scrolled to first, as with a wheel.
fn press_below(bench: &mut Bench, label: &str) {
    bench.button(label).scroll_to_me();
    bench.pass_ms(300);
    bench.press(label);
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

/// A run that has begun, and the gains from before it.
fn running(preset: &str, screen: &str) -> (Bench, MotionSettings) {
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
fn tuned(screen: &str, which: Loop) -> Bench {
    let (mut bench, _) = running("small-gearmotor", screen);
    finish(&mut bench);
    let run = run(&mut bench, which);
    assert_ne!(run.report.verdict, Verdict::Refused, "{:?}", run.report.causes);
    bench
}

/// Looks each 100 ms at a run until it has ended.
#[track_caller]
fn while_running(bench: &mut Bench, mut look: impl FnMut(&Bench)) {
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
fn run(bench: &mut Bench, which: Loop) -> Run {
    let said: Vec<String> = bench.model().messages.past().map(|message| message.text.to_string()).collect();
    let run = bench.model().front.tune.front(which).run().cloned();
    run.unwrap_or_else(|| panic!("no run: {said:?}"))
}

fn proposed(bench: &mut Bench, which: Loop) -> AnyRegisters {
    run(bench, which).shown.expect("gains").registers
}

/// Bytes that have gone to the controller so far, and gains among them.
fn gains_sent(bench: &Bench) -> MotionSettings {
    held(bench, Motor::M1)
}

#[track_caller]
fn assert_holds(bench: &Bench, wanted: AnyRegisters) {
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

#[test]
fn a_velocity_loop_is_tuned_applied_verified_and_undone_and_nothing_stays_by_itself() {
    let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
    let shortened = timeout_ms(&bench);
    bench.pass_ms(2500);
    assert!(bench.sees_part("Live speed of the run"));
    assert!(bench.sees_part("s left"));
    finish(&mut bench);
    let tuned = run(&mut bench, Loop::Velocity);
    assert_ne!(tuned.report.verdict, Verdict::Refused, "{:?}", tuned.report.causes);
    assert_eq!(held(&bench, Motor::M1), before, "nothing stays in the controller by itself");
    assert_eq!((shortened, timeout_ms(&bench)), (200, 1000), "for the run, and the user's again after it");
    assert!(bench.sees_part("Measured speed over the predicted one: predicted"));
    bench.press("Apply (RAM)");
    bench.pass_ms(4000);
    let wanted = proposed(&mut bench, Loop::Velocity);
    assert_holds(&bench, wanted);
    // Verified with the gains that are in force now, which stay in force.
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Verify");
    bench.pass_ms(700);
    assert!(bench.model().front.tune.is_running());
    finish(&mut bench);
    assert!(
        bench.sees("Verified: the machine behaves as predicted."),
        "{:?}",
        run(&mut bench, Loop::Velocity).verified
    );
    let wanted = proposed(&mut bench, Loop::Velocity);
    assert_holds(&bench, wanted);
    bench.press("Undo");
    bench.pass_ms(3000);
    assert_eq!(held(&bench, Motor::M1), before);
    assert_eq!(timeout_ms(&bench), timeout_of_factory());
}

/// What the simulated controller's ports begin with.
fn timeout_of_factory() -> u32 {
    let unit = Controller::new(ControllerConfig::default()).expect("the default is sound");
    unit.settings().streams[0].timeout_ms
}

#[test]
fn a_position_loop_is_tuned_by_each_method_and_applied_whole() {
    for (method, has_velocity) in [("PD", false), ("PID", false), ("PIV", true)] {
        let mut bench = opened("small-gearmotor", "Position Settings");
        bench.press(method);
        assert!(
            bench.button("Tune M1").accesskit_node().is_disabled(),
            "how far the axis may go is to be said first"
        );
        bench.press("Turns freely");
        bench.press("Tune M1");
        finish(&mut bench);
        let tuned = run(&mut bench, Loop::Position);
        assert_ne!(tuned.report.verdict, Verdict::Refused, "{method}: {:?}", tuned.report.causes);
        assert!(bench.sees_part("Measured position over the predicted one"), "{method}");
        let gains = proposed(&mut bench, Loop::Position);
        let gives_speed = gains.first.first.velocity.is_some_and(|velocity| velocity.p > 0);
        assert_eq!(gives_speed, has_velocity, "{method}: {gains:?}");
        assert!(gains.first.first.position.is_some_and(|position| position.p > 0), "{method}: {gains:?}");
        bench.press("Apply (RAM)");
        bench.pass_ms(4000);
        assert_holds(&bench, gains);
    }
}

#[test]
fn the_other_methods_are_picked_and_the_rules_on_their_model_are_considered_beside_their_own() {
    // The controller's own test wants an encoder that is finer than its hysteresis.
    for (preset, label, identification, other) in [
        ("small-gearmotor", "By step", Identification::Step, "Tyreus-Luyben"),
        ("small-gearmotor", "By relay", Identification::Relay, "SIMC"),
        ("large-gearmotor", "By controller", Identification::Controller, "SIMC"),
    ] {
        let mut bench = opened(preset, "Velocity Settings");
        bench.press(label);
        bench.enter("About duty", "45");
        bench.press("Tune M1");
        finish(&mut bench);
        let tuned = run(&mut bench, Loop::Velocity);
        assert_ne!(tuned.report.verdict, Verdict::Refused, "{label}: {:?}", tuned.report.causes);
        assert_eq!(tuned.report.request.identification, identification);
        assert!(tuned.tried.is_some(), "its gains were tried on the machine");
        let before = held(&bench, Motor::M1);
        let rule = tuned.rules.iter().find(|found| found.rule.name() == other).expect("it is listed");
        press_below(&mut bench, other);
        bench.pass_ms(300);
        let shown = run(&mut bench, Loop::Velocity).shown.expect("it is on the model");
        assert!(shown.registers.same_gains(&rule.registers), "{label}: {other} is considered");
        assert!(bench.sees_part("Considered on the model only"));
        assert_eq!(held(&bench, Motor::M1), before, "nothing was sent");
    }
}

#[test]
fn within_its_travel_an_actuator_is_tuned_without_leaving_it() {
    let mut bench = opened("linear-actuator", "Position Settings");
    let start = bench.truth().axes[0].encoder_counts;
    bench.press("Within");
    bench.enter("Travel low", &(start - 600).to_string());
    bench.enter("Travel high", &(start + 600).to_string());
    bench.press("Tune M1");
    let (mut low, mut high) = (start, start);
    while_running(&mut bench, |bench| {
        let now = bench.truth().axes[0].encoder_counts;
        (low, high) = (low.min(now), high.max(now));
    });
    assert!(low >= start - 600 && high <= start + 600, "{low} {high} about {start}");
    let tuned = run(&mut bench, Loop::Position);
    assert_ne!(tuned.report.verdict, Verdict::Refused, "{:?}", tuned.report.causes);
}

#[test]
fn the_level_and_gains_by_hand_redraw_the_prediction_and_send_nothing() {
    let mut bench = tuned("Position Settings", Loop::Position);
    let (before, first) = (gains_sent(&bench), run(&mut bench, Loop::Position).shown.expect("gains"));
    bench.focus_label("M1 level");
    for _ in 0..25 {
        bench.key(Key::ArrowRight);
    }
    let stiffer = run(&mut bench, Loop::Position);
    assert!(stiffer.level > 60.0, "{}", stiffer.level);
    let shown = stiffer.shown.expect("gains");
    assert_ne!(shown.registers, first.registers);
    // Stiffness is what the design weighs: the error under a load over time. Its peak alone may rise a little where the gains of D fall.
    let figures = [&first.forecast, &shown.forecast].map(|of| (of.score.load, of.ms));
    assert!(figures[1].0 < figures[0].0 && figures[1].1 > figures[0].1, "{figures:?}");
    assert!(bench.sees_part("Considered on the model only"));
    bench.enter("M1 proposed Position P", "4000");
    assert!(bench.sees_part("Unstable on the model"), "what would happen is told before it does");
    bench.pass_ms(2000);
    assert_eq!(gains_sent(&bench), before, "nothing was sent");
    assert!(bench.both_stand());
    bench.press("As proposed");
    assert_eq!(proposed(&mut bench, Loop::Position), first.registers);
    for (kind, picture) in [
        ("Step", "Predicted step of the position: proposed"),
        ("Load", "Predicted position under a load step: proposed"),
        ("Bode", "Bode gain of the open loop: proposed"),
        ("Nyquist", "Nyquist plot with the Ms circle: proposed"),
        ("Sensitivity", "Sensitivity over frequency: proposed"),
    ] {
        bench.press(kind);
        assert!(bench.sees(picture), "{picture}");
    }
}

/// Ends runs at several moments, and looks that the motors stand with the old gains in force, whenever it is.
#[track_caller]
fn end_at_any_moment(how: &str, end: impl Fn(&mut Bench), after: impl Fn(&mut Bench)) {
    for after_ms in [0, 700, 2600] {
        let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
        bench.pass_ms(after_ms);
        assert!(bench.model().front.tune.is_running(), "{how} after {after_ms} ms comes too late");
        end(&mut bench);
        bench.pass_ms(600);
        assert!(bench.both_stand(), "{how} after {after_ms} ms: {}", bench.real_duty(Motor::M1));
        bench.pass_ms(2000);
        assert_at_rest(&mut bench);
        after(&mut bench);
        assert!(!bench.model().front.tune.is_running(), "{how} after {after_ms} ms");
        assert_eq!(held(&bench, Motor::M1), before, "{how} after {after_ms} ms");
        assert_eq!(timeout_ms(&bench), timeout_of_factory(), "{how} after {after_ms} ms");
        assert_at_rest(&mut bench);
    }
}

#[test]
fn space_and_esc_stop_a_run_at_any_moment_and_put_the_old_gains_back() {
    end_at_any_moment("Space", |bench| bench.key(Key::Space), |_| {});
    end_at_any_moment("Esc", |bench| bench.key(Key::Escape), |_| {});
}

#[test]
fn the_buttons_stop_a_run_at_any_moment_and_put_the_old_gains_back() {
    end_at_any_moment("Stop All", |bench| bench.press("Stop All"), |_| {});
    end_at_any_moment("Stop the run", |bench| bench.press("Stop the run"), |_| {});
}

#[test]
fn disarming_or_leaving_the_screen_ends_a_run_at_any_moment_and_puts_the_old_gains_back() {
    end_at_any_moment("leaving", |bench| bench.press("Device Status"), |_| {});
    end_at_any_moment(
        "disarming",
        |bench| bench.key_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::A),
        |_| {},
    );
}

#[test]
fn a_cable_pulled_out_in_a_run_stops_the_motor_and_the_old_gains_are_put_back_when_it_is_in_again() {
    let unplug = |bench: &mut Bench| bench.act(&WorldAction::Unplug { unplugged: true });
    end_at_any_moment("unplugging", unplug, |bench| {
        bench.act(&WorldAction::Unplug { unplugged: false });
        bench.press("Connect");
        bench.pass_ms(5000);
    });
}

#[test]
fn a_frozen_window_stops_the_motor_and_the_old_gains_are_put_back_when_it_lives_again() {
    let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
    for _ in 0..60 {
        if bench.real_duty(Motor::M1) > 0.9 {
            break;
        }
        bench.pass_ms(100);
    }
    assert!(bench.real_duty(Motor::M1) > 0.9);
    // 250 ms, and 50 ms that full duty takes to go to 0 at the highest deceleration.
    bench.freeze(Duration::from_millis(320));
    assert!(bench.both_stand(), "{}", bench.real_duty(Motor::M1));
    bench.pass_ms(2500);
    assert_at_rest(&mut bench);
    assert!(!bench.model().front.tune.is_running());
    assert_eq!(held(&bench, Motor::M1), before);
    assert!(bench.sees_part("The run was stopped: this computer answered late"));
}

#[test]
fn a_refusal_says_what_was_seen_shows_where_and_offers_another_try() {
    let on = true;
    for (wrong, sketch, word) in [
        (WorldAction::ReverseEncoder { motor: Motor::M1, on }, "Sketch: The motor leads OR", "counts down"),
        (WorldAction::ReverseLeads { motor: Motor::M1, on }, "Sketch: The motor leads OR", "counts down"),
        (WorldAction::LoseEncoder { motor: Motor::M1, on }, "Sketch: The encoder's plug", "counts nothing"),
        (WorldAction::LockShaft { motor: Motor::M1, on }, "Sketch: The shaft is held", "Free the shaft"),
        (WorldAction::OpenLead { motor: Motor::M1, on }, "Sketch: A motor lead", "No current"),
    ] {
        let mut bench = opened("small-gearmotor", "Velocity Settings");
        let before = held(&bench, Motor::M1);
        bench.act(&wrong);
        bench.press("Tune M1");
        finish(&mut bench);
        assert_eq!(run(&mut bench, Loop::Velocity).report.verdict, Verdict::Refused, "{wrong:?}");
        assert!(bench.sees_part(sketch), "{wrong:?}: {:?}", run(&mut bench, Loop::Velocity).report.causes);
        assert!(bench.sees_part(word), "{wrong:?}");
        assert_eq!(held(&bench, Motor::M1), before, "{wrong:?}");
        let turned = bench.truth().axes[0].encoder_counts.abs();
        assert!(turned < 500, "{wrong:?}: {turned}");
    }
}

#[test]
fn after_a_refusal_is_mended_another_try_succeeds_and_both_runs_are_kept() {
    let mut bench = opened("small-gearmotor", "Velocity Settings");
    bench.act(&WorldAction::ReverseLeads { motor: Motor::M1, on: true });
    bench.press("Tune M1");
    finish(&mut bench);
    bench.act(&WorldAction::ReverseLeads { motor: Motor::M1, on: false });
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Try again");
    finish(&mut bench);
    assert_ne!(run(&mut bench, Loop::Velocity).report.verdict, Verdict::Refused);
    assert_eq!(bench.model().front.tune.front(Loop::Velocity).runs.len(), 2);
    assert!(bench.sees("Runs so far"));
}

#[test]
fn a_resistance_that_is_not_told_says_why_and_what_would_tell_it() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    let mut report = run(&mut bench, Loop::Velocity).report;
    for (why, word) in [
        (WindingUnknown::NoCurrents, "no motor current"),
        (WindingUnknown::TooFew, "too few readings"),
        (WindingUnknown::Alike, "about the same current all the time"),
        (WindingUnknown::Vague, "scatter too much"),
    ] {
        (report.winding, report.winding_unknown) = (None, Some(why));
        bench.model().front.tune.panel_mut(Loop::Velocity, Motor::M1).add(report.clone());
        bench.pass_ms(200);
        assert!(bench.sees_part("R of the winding was not reported") && bench.sees_part(word), "{why:?}");
        assert!(bench.sees_part("measure R with a meter") || why == WindingUnknown::TooFew);
        assert!(!bench.sees_part("Enter as R"));
    }
}

#[test]
fn runs_are_compared_by_what_they_were_and_the_level_that_is_shown_is_the_one_that_is_tuned() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    let first = run(&mut bench, Loop::Velocity).first.expect("gains");
    assert!(bench.sees_part("imited by ") || bench.sees_part("No bound limits here"), "what limits is told");
    bench.focus_label("M1 level");
    for _ in 0..30 {
        bench.key(Key::ArrowRight);
    }
    let level = run(&mut bench, Loop::Velocity).level;
    assert!(level >= 75.0, "{level}");
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Tune M1");
    finish(&mut bench);
    let second = run(&mut bench, Loop::Velocity);
    assert_eq!((second.number, second.report.request.level), (2, level));
    let runs = bench.model().front.tune.front(Loop::Velocity).runs.clone();
    assert_eq!(
        runs[0].shown.as_ref().map(|shown| shown.registers),
        Some(first),
        "not what was considered after it"
    );
    assert_eq!(runs[0].level, 50.0);
    // Each in its row, drawn beneath the one that is looked at, and left out by its box.
    bench.press("Step");
    assert!(bench.sees_part("Predicted step of the speed: run 1"));
    press_below(&mut bench, "Draw run 1");
    assert!(!bench.sees_part("Predicted step of the speed: run 1"));
    // The row that is chosen brings its level back to the slider, and so to the next run.
    press_below(&mut bench, "Run 1");
    assert_eq!(bench.model().front.tune.front(Loop::Velocity).level(), 50.0);
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Tune M1");
    finish(&mut bench);
    assert_eq!(run(&mut bench, Loop::Velocity).report.request.level, 50.0);
}

#[test]
fn a_refusal_before_anything_moves_says_that_there_is_nothing_to_see() {
    let mut bench = opened("small-gearmotor", "Velocity Settings");
    bench.act(&WorldAction::SetBatteryVolts { volts: 5.5 });
    bench.press("Tune M1");
    finish(&mut bench);
    assert!(bench.sees_part("Sketch: The main battery sags or is empty"));
    assert!(bench.sees("Live speed of the run"), "an empty picture, which says why");
}

#[test]
fn a_report_is_saved_as_the_command_line_writes_it_and_opened_again() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    let verdict_top = |bench: &Bench, run: usize| {
        bench.harness.get_by_label_contains(&format!("· run {run} ·")).rect().top()
    };
    let top = verdict_top(&bench, 1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("run.json");
    bench.model().front.tune.path = path.display().to_string();
    press_below(&mut bench, "Save report");
    let saved: Report =
        serde_json::from_str(&std::fs::read_to_string(&path).expect("written")).expect("a report");
    assert_eq!(saved, run(&mut bench, Loop::Velocity).report);
    assert_eq!(saved.replay().expect("the record belongs to it"), saved, "the same to the last bit");
    std::fs::write(&path, "precious").expect("it can be written");
    press_below(&mut bench, "Save report");
    assert_eq!(
        std::fs::read_to_string(&path).expect("it is there"),
        "precious",
        "nothing is replaced unasked"
    );
    assert!(bench.said().iter().any(|text| text.contains("already")), "{:?}", bench.said());
    std::fs::remove_file(&path).expect("it is there");
    press_below(&mut bench, "Save report");
    assert!(verdict_top(&bench, 1) < top, "its end was looked at");
    press_below(&mut bench, "Open report");
    bench.pass_ms(300);
    assert_eq!(bench.model().front.tune.front(Loop::Velocity).runs.len(), 2);
    assert_eq!(verdict_top(&bench, 2), top, "a new result is seen from its verdict on");
    assert_eq!(run(&mut bench, Loop::Velocity).report, saved);
}

#[test]
fn tuning_needs_an_armed_screen() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Velocity Settings");
    bench.press("Tune");
    bench.press("Tune M1");
    bench.pass_ms(1500);
    assert!(!bench.model().front.tune.is_running() && bench.both_stand());
    assert!(bench.sees_part("Arm this screen to tune"));
}

#[test]
fn the_second_motor_is_tuned_and_the_first_stands() {
    let mut bench = opened("small-gearmotor", "Velocity Settings");
    let before = bench.truth().axes[0].encoder_counts;
    bench.press("Tune M2");
    finish(&mut bench);
    assert_ne!(run(&mut bench, Loop::Velocity).report.verdict, Verdict::Refused);
    assert_eq!(bench.model().front.tune.motor(Loop::Velocity), Motor::M2);
    assert_eq!(bench.truth().axes[0].encoder_counts, before);
}

#[test]
fn a_trajectory_that_both_motors_follow_sets_the_sliders_of_the_screens() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    assert!(bench.sees_part("A trajectory that the motor follows"));
    assert!(!bench.sees_part("One that both motors follow alike"), "of the second nothing is known");
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Tune M2");
    finish(&mut bench);
    assert!(bench.sees_part("One that both motors follow alike"));
    let of = |bench: &mut Bench, motor| {
        let run = bench.model().front.tune.panel(Loop::Velocity, motor).run().cloned();
        run.and_then(|run| run.report.trajectory()).expect("it is tuned")
    };
    let (first, second) = (of(&mut bench, Motor::M1), of(&mut bench, Motor::M2));
    let both = first.of_both(second);
    press_below(&mut bench, "Use for the sliders");
    let model = bench.model();
    let accel = both.accel_counts_per_s2.round();
    assert_eq!(model.front.velocity.accel_counts_per_s2, accel);
    let position = model.front.position;
    assert_eq!((position.accel_counts_per_s2, position.decel_counts_per_s2), (accel, accel));
    assert_eq!(position.speed_counts_per_s, both.speed_counts_per_s.round());
}

#[test]
fn what_load_the_loop_stands_is_told_and_follows_the_gains_that_are_considered() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    assert!(bench.sees_part("Other loads: Ms stays up to 2 at"));
    assert!(bench.sees_part("It holds a steady load of up to"));
    press_below(&mut bench, "Other loads");
    bench.pass_ms(500);
    for row in ["inertia x 0.25", "inertia x 4", "friction x 2"] {
        assert!(bench.sees_part(row), "{row}");
    }
    let lowest = |bench: &mut Bench| {
        let run = run(bench, Loop::Velocity);
        let shown = run.shown.expect("it has gains");
        shown.stood(&run.report).and_then(|stood| stood.calm?.low).unwrap_or(0.0)
    };
    let before = lowest(&mut bench);
    bench.focus_label("M1 level");
    for _ in 0..40 {
        bench.key(Key::ArrowLeft);
    }
    assert!(lowest(&mut bench) < before, "softer gains stand a lighter load");
}

#[test]
fn an_axis_with_position_limits_stays_within_them_unless_a_person_says_otherwise() {
    let mut config = config("small-gearmotor");
    let mut settings = Controller::new(config.clone()).expect("the preset is sound").stored_settings();
    for motor in &mut settings.motors {
        (motor.motion.position_min_counts, motor.motion.position_max_counts) = (-3000, 3000);
    }
    config.settings = Some(settings);
    let mut bench = Bench::of(Controller::new(config).expect("the configuration is sound"));
    bench.connect();
    bench.arm_on("Position Settings");
    bench.press("Tune");
    bench.press("Tune M2");
    let mut farthest = 0;
    while_running(&mut bench, |bench| {
        farthest = farthest.max(bench.truth().axes[1].encoder_counts.abs());
    });
    assert!(farthest > 20 && farthest <= 3000, "{farthest}");
    assert_ne!(run(&mut bench, Loop::Position).report.verdict, Verdict::Refused);
    bench.press("Turns freely");
    bench.pass_ms(500);
    assert!(bench.model().front.tune.front(Loop::Position).setting.turns_freely);
}

#[test]
fn calibration_by_hand_makes_the_changes_of_the_manual_and_says_what_the_motor_does() {
    let mut bench = Bench::of(Controller::new(config("small-gearmotor")).expect("the preset is sound"));
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(1000);
    bench.open_tab("Velocity loop");
    bench.enter("M1 QPPS", "10600");
    bench.press("Apply to RAM");
    bench.pass_ms(3000);
    bench.press("By hand");
    assert!(bench.sees("QPPS is 10600 counts/s. If that is right, go on."));
    bench.press("Next step");
    bench.press("Set P 1, I 0, D 0");
    bench.pass_ms(1500);
    let now = held(&bench, Motor::M1);
    assert_eq!((now.velocity_p_raw, now.velocity_i_raw, now.velocity_d_raw), (0x1_0000, 0, 0));
    assert!(bench.sees("Arm the screen and move the slider; then wait a second."));
    bench.press("Arm");
    bench.pass_ms(500);
    bench.enter("M1 speed exact", "3500");
    bench.pass_ms(4000);
    assert!(bench.sees_part("It turns and the loop has it."));
    bench.press("3. P");
    assert!(bench.sees_part("Go on to I.") || bench.sees_part("Raise P."));
    // Far too much P: the loop oscillates, and the assistant sees it.
    for _ in 0..16 {
        bench.press("P up 25 %");
        bench.pass_ms(900);
    }
    bench.pass_ms(2500);
    assert!(bench.sees_part("It vibrates"), "P {}", held(&bench, Motor::M1).velocity_p_raw);
    let rough = held(&bench, Motor::M1).velocity_p_raw;
    bench.press("P to two thirds");
    bench.pass_ms(1500);
    let calmer = held(&bench, Motor::M1).velocity_p_raw;
    assert!((f64::from(calmer) / f64::from(rough) - 2.0 / 3.0).abs() < 1e-4, "{rough} {calmer}");
    bench.key(Key::Space);
    bench.pass_ms(1500);
    assert_at_rest(&mut bench);
}

/// A controller in torque mode, since L and R are both set, whose run was refused for that; and its settings.
fn refused_for_its_winding() -> (Bench, MotionSettings) {
    let mut config = config("small-gearmotor");
    let mut settings = Controller::new(config.clone()).expect("the preset is sound").stored_settings();
    (settings.motors[0].motion.inductance_raw, settings.motors[0].motion.resistance_raw) =
        (67_109, 134_217_728);
    config.settings = Some(settings);
    let mut bench = Bench::of(Controller::new(config).expect("the configuration is sound"));
    bench.connect();
    bench.arm_on("Velocity Settings");
    bench.press("Tune");
    let before = held(&bench, Motor::M1);
    bench.press("Tune M1");
    finish(&mut bench);
    (bench, before)
}

#[test]
fn with_l_and_r_set_a_run_is_refused_until_they_are_cleared_for_it_and_they_are_put_back_after() {
    let (mut bench, before) = refused_for_its_winding();
    assert!(bench.sees_part("Sketch: L and R are both set"));
    assert_eq!(held(&bench, Motor::M1), before);
    bench.press("Clear L and R for the run");
    bench.pass_ms(4000);
    let cleared = held(&bench, Motor::M1);
    assert_eq!((cleared.inductance_raw, cleared.resistance_raw), (0, 0));
    assert!(bench.sees_part("L and R of M1 are cleared"));
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Try again");
    finish(&mut bench);
    bench.pass_ms(3000);
    assert_ne!(run(&mut bench, Loop::Velocity).report.verdict, Verdict::Refused);
    assert_eq!(held(&bench, Motor::M1), before, "L, R and the old gains are in force");
}

#[test]
fn saving_while_a_run_is_at_work_waits_for_its_end_and_saves_the_users_values() {
    let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
    bench.pass_ms(1500);
    assert_ne!(timeout_ms(&bench), timeout_of_factory(), "the run has shortened it");
    bench.model().front.tune.waiting = Some(SettingsAction::Save);
    bench.pass_ms(300);
    assert_eq!(bench.model().front.tune.waiting, Some(SettingsAction::Save), "it waits");
    bench.key(Key::Escape);
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.model().front.is_idle() && bench.model().front.tune.waiting.is_none() {
            break;
        }
    }
    bench.act(&WorldAction::Power { on: false });
    bench.pass_ms(500);
    bench.act(&WorldAction::Power { on: true });
    bench.pass_ms(1500);
    assert_eq!(timeout_ms(&bench), timeout_of_factory(), "EEPROM holds the user's time-out");
    assert_eq!(held(&bench, Motor::M1), before);
}

#[test]
fn the_kind_of_encoder_follows_the_controller_until_a_person_chooses_another() {
    let mut bench = opened("linear-actuator", "Position Settings");
    bench.pass_ms(500);
    let shown = |bench: &mut Bench| bench.model().front.tune.front(Loop::Position).setting;
    assert_eq!(shown(&mut bench).encoder, EncoderClass::Absolute);
    assert!(!shown(&mut bench).is_encoder_chosen);
    bench.press("Tune M1");
    finish(&mut bench);
    let run = run(&mut bench, Loop::Position);
    assert_eq!(run.report.before.map(|setup| setup.encoder), Some(EncoderClass::Absolute));
    assert_ne!(run.report.verdict, Verdict::Refused, "{:?}", run.report.causes);
    if let Some(winding) = run.report.winding {
        // 4 ohm in the preset.
        assert!((winding.ohms - 4.0).abs() < 2.0 * winding.interval_ohms, "{winding:?}");
    }
}

#[test]
fn the_measured_resistance_is_offered_as_an_edit_and_not_sent() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    let mut report = run(&mut bench, Loop::Velocity).report;
    let winding = Winding { ohms: 0.75, interval_ohms: 0.05, volts_per_count_per_s: 0.001, samples: 40 };
    (report.winding, report.winding_unknown) = (Some(winding), None);
    bench.model().front.tune.panel_mut(Loop::Velocity, Motor::M1).add(report);
    bench.pass_ms(300);
    assert!(bench.sees_part("Measured R 0.750") && bench.sees_part("become current (torque) commands"));
    press_below(&mut bench, "Enter as R");
    assert_eq!(
        bench.model().front.settings.unit().map(|unit| unit.loop_edits(VELOCITY).len()),
        Some(1),
        "R alone is edited"
    );
    assert_eq!(held(&bench, Motor::M1).resistance_raw, 0, "and nothing was sent");
}

#[test]
fn a_travel_that_is_wrong_is_refused_with_its_sketch_before_the_axis_moves() {
    for (low, high, word) in [("5000", "9000", "stands outside"), ("-30", "400", "too near to an end")] {
        let mut bench = opened("small-gearmotor", "Position Settings");
        bench.press("Within");
        bench.enter("Travel low", low);
        bench.enter("Travel high", high);
        bench.press("Tune M1");
        finish(&mut bench);
        let run = run(&mut bench, Loop::Position);
        assert_eq!(run.report.verdict, Verdict::Refused);
        assert!(bench.sees_part(word), "{low} to {high}: {:?}", run.report.causes);
        assert!(bench.sees_part("Sketch: "), "{:?}", run.report.causes);
        assert!(bench.sees("Try again"));
        assert!(bench.truth().axes[0].encoder_counts.abs() < 400, "{}", bench.truth().axes[0].encoder_counts);
    }
}

#[test]
fn a_link_that_is_lost_in_a_run_teaches_too_and_another_try_succeeds() {
    let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
    bench.pass_ms(2600);
    bench.act(&WorldAction::Unplug { unplugged: true });
    bench.pass_ms(1500);
    assert!(bench.both_stand());
    let said = bench.said();
    assert!(said.iter().any(|text| text.contains("M1 was not tuned: the link was lost.")), "{said:?}");
    assert!(said[0].contains("put back when it answers again"), "{said:?}");
    assert!(
        !said.iter().any(|text| text.contains("the old gains are in force")),
        "nobody can know: {said:?}"
    );
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.press("Connect");
    bench.pass_ms(5000);
    assert_eq!(held(&bench, Motor::M1), before);
    assert!(bench.said().iter().any(|text| text.contains("The previous gains of M1 are back.")));
    bench.press("Velocity Settings");
    assert!(bench.sees_part("M1 was not tuned"), "{:?}", bench.said());
    assert!(bench.sees_part("Sketch: The cable to the controller is open"));
    assert!(bench.sees_part("Check the cable to the controller and connect again."));
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Try again");
    finish(&mut bench);
    assert_ne!(run(&mut bench, Loop::Velocity).report.verdict, Verdict::Refused);
}

/// What EEPROM holds for motor 1.
fn stored(bench: &Bench) -> MotionSettings {
    bench.line.with(|bus| bus.controllers()[0].stored_settings().motors[0].motion)
}

fn save(bench: &mut Bench) {
    bench.press("Save…");
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.sees("Save") {
            break;
        }
    }
    bench.press("Save");
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.model().front.is_idle() {
            break;
        }
    }
}

#[test]
fn saved_gains_stay_in_eeprom_when_they_are_undone_in_ram_and_undo_outlives_the_link() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    let before = held(&bench, Motor::M1);
    bench.press("Apply (RAM)");
    bench.pass_ms(4000);
    let applied = held(&bench, Motor::M1);
    assert_ne!(applied, before);
    save(&mut bench);
    assert_eq!(stored(&bench), applied, "{:?}", bench.said());
    // The cable is out and in again: the run, its picture and Undo are still there.
    bench.act(&WorldAction::Unplug { unplugged: true });
    bench.pass_ms(1500);
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.press("Connect");
    bench.pass_ms(5000);
    bench.press("Velocity Settings");
    bench.pass_ms(2000);
    bench.press("Undo");
    bench.pass_ms(3000);
    assert_eq!(held(&bench, Motor::M1), before);
    assert_eq!(stored(&bench), applied, "EEPROM is written by Save alone");
}

#[test]
fn the_settings_screen_saves_after_the_run_that_it_ended_and_what_it_saves_is_the_users() {
    let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
    bench.pass_ms(1500);
    assert_ne!(timeout_ms(&bench), timeout_of_factory(), "the run has shortened it");
    bench.press("General Settings");
    bench.pass_ms(300);
    bench.press("Save to EEPROM");
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.sees("Save") {
            break;
        }
    }
    bench.press("Save");
    for _ in 0..60 {
        bench.pass_ms(500);
        if bench.model().front.is_idle() && bench.model().front.tune.waiting.is_none() {
            break;
        }
    }
    let of_stream = bench.line.with(|bus| bus.controllers()[0].stored_settings().streams[0].timeout_ms);
    assert_eq!((of_stream, timeout_ms(&bench)), (timeout_of_factory(), timeout_of_factory()));
    assert_eq!((stored(&bench), held(&bench, Motor::M1)), (before, before));
}

/// The armed screen of a controller in torque mode whose L and R were cleared for a run.
fn cleared() -> (Bench, MotionSettings) {
    let (mut bench, before) = refused_for_its_winding();
    bench.press("Clear L and R for the run");
    bench.pass_ms(4000);
    assert_eq!(held(&bench, Motor::M1).resistance_raw, 0);
    (bench, before)
}

#[test]
fn l_and_r_that_were_cleared_are_put_back_on_leaving_by_the_button_and_after_a_lost_link() {
    let (mut bench, before) = cleared();
    bench.press("Device Status");
    bench.pass_ms(4000);
    assert_eq!(held(&bench, Motor::M1), before, "{:?}", bench.said());
    assert!(bench.said().iter().any(|text| text.contains("L and R are put back")));

    let (mut bench, before) = cleared();
    bench.press("Put L and R back");
    bench.pass_ms(4000);
    assert_eq!(held(&bench, Motor::M1), before, "{:?}", bench.said());

    let (mut bench, before) = cleared();
    bench.act(&WorldAction::Unplug { unplugged: true });
    bench.pass_ms(1500);
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.press("Connect");
    bench.pass_ms(6000);
    assert_eq!(held(&bench, Motor::M1), before, "{:?}", bench.said());

    // A stop that breaks into the writing: it is written again.
    let (mut bench, before) = cleared();
    bench.press("Put L and R back");
    bench.key(Key::Escape);
    bench.pass_ms(6000);
    assert_eq!(held(&bench, Motor::M1), before, "{:?}", bench.said());
}

#[test]
fn applied_gains_are_known_to_every_screen() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    press_below(&mut bench, "Apply (RAM)");
    bench.pass_ms(8000);
    let held = held(&bench, Motor::M1).velocity_p_raw;
    let unit = bench.model().front.settings.unit().expect("it is connected");
    assert_eq!(unit.held(Motor::M1, "velocity.p"), Some(f64::from(held) / 65_536.0));
    assert!(unit.is_read() && unit.confirmed("motor1.velocity.p").is_some());
    assert!(unit.edits().is_empty());
}
