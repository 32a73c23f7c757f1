//! Guided tuning in the window against a simulated controller: whole runs of each method, what they show and what is chosen,
//! gains into RAM and back. The device loop runs in lockstep with the frames.

use crate::support::bench::Bench;
use crate::support::tuning::{
    assert_at_rest, assert_holds, config, finish, gains_sent, held, opened, press_below, proposed, run,
    running, timeout_ms, timeout_of_factory, tuned, while_running,
};
use brushwork_gui::model::loop_settings::VELOCITY;
use brushwork_gui::tune::Loop;
use brushwork_mcp_sim::controller::Controller;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::registers::RegisterTable as _;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Identification;
use brushwork_tuning::winding::{Winding, WindingUnknown};
use brushwork_values::Motor;
use egui::Key;
use egui_kittest::kittest::NodeT as _;

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
fn a_position_is_tuned_by_step_relay_and_the_controllers_own_test_freely_and_in_a_travel() {
    for (label, identification, method) in [
        ("By step", Identification::Step, "PD"),
        ("By relay", Identification::Relay, "PIV"),
        ("By controller", Identification::Controller, "PID"),
    ] {
        for is_inside in [false, true] {
            let mut bench = opened("small-gearmotor", "Position Settings");
            let start = bench.truth().axes[0].encoder_counts;
            bench.press(method);
            bench.press(label);
            assert_eq!(bench.sees("about"), label == "By step", "a relay works about where the axis stands");
            if is_inside {
                bench.press("Within");
                bench.enter("Travel low", &(start - 2_000).to_string());
                bench.enter("Travel high", &(start + 2_000).to_string());
            } else {
                bench.press("Turns freely");
            }
            bench.press("Tune M1");
            finish(&mut bench);
            let tuned = run(&mut bench, Loop::Position);
            let case = format!("{label}, {method}, inside: {is_inside}");
            assert_ne!(tuned.report.verdict, Verdict::Refused, "{case}: {:?}", tuned.report.causes);
            assert_eq!(tuned.report.request.identification, identification, "{case}");
            assert_eq!(tuned.report.position_relay.is_some(), label == "By relay", "{case}");
            assert_eq!(tuned.report.own_position_test.is_some(), label == "By controller", "{case}");
            assert!(tuned.rules.len() > 2, "{case}: the rules stand beside it");
            let proposed = proposed(&mut bench, Loop::Position);
            bench.press("Apply (RAM)");
            bench.pass_ms(4000);
            assert_holds(&bench, proposed);
        }
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
