//! Guided tuning that is refused: what is said, what is shown, and what helps.

use crate::support::bench::Bench;
use crate::support::tuning::{config, finish, held, opened, run, running};
use brushwork_gui::tune::Loop;
use brushwork_mcp_sim::controller::Controller;
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_plant::world::WorldAction;
use brushwork_tuning::report::Verdict;
use brushwork_values::Motor;
use egui::Key;

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
fn a_refusal_before_anything_moves_says_that_there_is_nothing_to_see() {
    let mut bench = opened("small-gearmotor", "Velocity Settings");
    bench.act(&WorldAction::SetBatteryVolts { volts: 5.5 });
    bench.press("Tune M1");
    finish(&mut bench);
    assert!(bench.sees_part("Sketch: The main battery sags or is empty"));
    assert!(bench.sees("Live speed of the run"), "an empty picture, which says why");
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
