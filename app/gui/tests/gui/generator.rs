//! The profile generator and the jog buttons on the screens that drive, against a simulated controller.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::Key;

/// An armed screen with its generator open.
fn armed_on(screen: &str) -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    bench.arm_on(screen);
    bench.pass_ms(500);
    bench.press("Generator");
    bench
}

fn assert_at_rest(bench: &mut Bench) {
    assert!(bench.both_stand(), "{} {}", bench.real_duty(Motor::M1), bench.real_duty(Motor::M2));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

/// The duties of motor 1 while the profile plays, one each 100 ms; it ends by itself.
fn play(bench: &mut Bench) -> Vec<f64> {
    bench.press("Run profile");
    let mut duties = Vec::new();
    for _ in 0..600 {
        if !bench.model().front.is_guided() {
            bench.pass_ms(300);
            assert_at_rest(bench);
            return duties;
        }
        duties.push(bench.real_duty(Motor::M1));
        bench.pass_ms(100);
    }
    panic!("it does not end");
}

#[test]
fn a_step_of_duty_is_played_judged_and_stops_by_itself() {
    let mut bench = armed_on("PWM Settings");
    let duties = play(&mut bench);
    assert!(duties.iter().any(|duty| (duty - 0.30).abs() < 0.005), "{duties:?}");
    assert!(duties.iter().all(|duty| *duty < 0.305), "{duties:?}");
    assert_eq!(bench.real_duty(Motor::M2), 0.0);
    let steps = bench.model().front.generator.last_steps(brushwork_core::motion::profile::Mode::Duty).len();
    assert_eq!(steps, 1);
    let step =
        bench.model().front.generator.last_steps(brushwork_core::motion::profile::Mode::Duty)[0].clone();
    let figures = step.figures.expect("it was judged");
    println!("{step:?}");
    assert!(figures.overshoot < 0.01, "a motor without a loop has none: {figures:?}");
    let (rise_s, sure_s) =
        (figures.rise_time_s.expect("it was reached"), step.spread.rise_s.expect("it has one"));
    assert!(rise_s > 0.05 && sure_s < 0.2 * rise_s, "{rise_s} ± {sure_s}");
    assert!(bench.sees_part(" ± "), "what is told has its uncertainty");
    for heading in ["Rise", "Overshoot", "Settling", "ITAE"] {
        assert!(bench.sees(heading), "{heading}");
    }
    assert!(bench.sees("M1 to 30.0 %"));
}

#[test]
fn both_motors_play_a_profile_together() {
    let mut bench = armed_on("PWM Settings");
    bench.press("M2");
    bench.press("Run profile");
    let mut together = false;
    for _ in 0..100 {
        bench.pass_ms(100);
        together |= Motor::BOTH.into_iter().all(|motor| (bench.real_duty(motor) - 0.30).abs() < 0.005);
        if !bench.model().front.is_guided() {
            break;
        }
    }
    bench.pass_ms(300);
    assert!(together);
    assert_at_rest(&mut bench);
}

#[test]
fn a_square_wave_goes_there_and_back_as_often_as_asked() {
    let mut bench = armed_on("PWM Settings");
    bench.choose("Shape", "Square wave");
    bench.enter("Profile from", "-20");
    bench.enter("Profile to", "20");
    bench.enter("Profile dwell", "0.5");
    bench.enter("Profile count", "4");
    let duties = play(&mut bench);
    let ups = duties.windows(2).filter(|pair| pair[0] < 0.1 && pair[1] > 0.15).count();
    assert_eq!(ups, 4, "{duties:?}");
}

#[test]
fn a_trapezoid_changes_at_the_acceleration_of_the_screen() {
    let mut bench = armed_on("PWM Settings");
    bench.choose("Shape", "Trapezoid");
    bench.enter("Acceleration", "20");
    bench.enter("Profile to", "40");
    bench.enter("Profile count", "1");
    let duties = play(&mut bench);
    let ramp = duties.iter().filter(|duty| **duty > 0.05 && **duty < 0.35).count();
    // 1.5 s from 5 to 35 % at 20 %/s, up and down.
    assert!((26..=34).contains(&ramp), "{ramp}: {duties:?}");
}

#[test]
fn a_jog_by_duty_goes_from_point_to_point() {
    let mut bench = armed_on("PWM Settings");
    bench.choose("Shape", "Jog between two points");
    bench.enter("Profile to", "4000");
    bench.enter("Profile count", "2");
    bench.press("Run profile");
    let mut turns = Vec::new();
    for _ in 0..600 {
        if !bench.model().front.is_guided() {
            break;
        }
        turns.push(bench.truth().axes[0].encoder_counts);
        bench.pass_ms(100);
    }
    bench.pass_ms(300);
    assert_at_rest(&mut bench);
    let arrivals = turns.windows(2).filter(|pair| pair[0] < 4000 && pair[1] >= 4000).count();
    assert_eq!(arrivals, 2, "{turns:?}");
    assert!(turns.last().is_some_and(|counts| *counts < 500), "it came back: {turns:?}");
    assert!(turns.iter().all(|counts| (-1500..6000).contains(counts)), "{turns:?}");
}

#[test]
fn a_jog_with_a_reversed_encoder_is_given_up_with_what_to_do() {
    let mut bench = armed_on("PWM Settings");
    bench.act(&WorldAction::ReverseEncoder { motor: Motor::M1, on: true });
    bench.choose("Shape", "Jog between two points");
    bench.enter("Profile from", "-2000");
    bench.enter("Profile to", "4000");
    play(&mut bench);
    assert!(bench.sees_part("counts the wrong way"));
}

#[test]
fn a_step_of_speed_reaches_its_speed_and_its_figures() {
    let mut bench = armed_on("Velocity Settings");
    bench.enter("Profile dwell", "3");
    bench.press("Run profile");
    bench.pass_ms(5500);
    let before = bench.truth().axes[0].encoder_counts;
    bench.pass_ms(100);
    let speed = (bench.truth().axes[0].encoder_counts - before) * 10;
    assert!((speed - 5000).abs() < 500, "{speed}");
    bench.pass_ms(4000);
    assert_at_rest(&mut bench);
    let steps = bench.model().front.generator.last_steps(brushwork_core::motion::profile::Mode::Speed);
    let figures = steps[0].figures.expect("it was judged");
    assert!(figures.rise_time_s.is_some_and(|time| time < 3.0), "{figures:?}");
}

/// A position loop over a speed loop on both motors, within -20 000 to 20 000 counts.
fn tune_position(bench: &mut Bench) {
    let loops: [(&str, &[(&str, &str)]); 2] = [
        ("Velocity loop", &[("M1 QPPS", "10600"), ("M1 Velocity I", "0.05"), ("M1 Velocity D", "0")]),
        (
            "Position loop",
            &[("M1 Position P", "15"), ("M1 Minimum position", "-20000"), ("M1 Maximum position", "20000")],
        ),
    ];
    for (tab, fields) in loops {
        bench.press(tab);
        for (field, value) in fields {
            bench.enter(field, value);
        }
        bench.press("Copy M1 to M2");
        bench.press("Apply to RAM");
        bench.pass_ms(1000);
    }
}

#[test]
fn a_step_of_position_is_opened_from_the_menu_goes_there_and_stops_by_itself() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Position Settings");
    bench.pass_ms(1000);
    tune_position(&mut bench);
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Device");
    bench.press("Setpoint Generator…");
    bench.enter("Profile to", "3000");
    bench.enter("Profile dwell", "3");
    bench.press("Run profile");
    let mut reached = false;
    for _ in 0..200 {
        bench.pass_ms(100);
        reached |= (bench.truth().axes[0].encoder_counts - 3000).abs() < 150;
        if !bench.model().front.is_guided() {
            break;
        }
    }
    bench.pass_ms(1500);
    assert!(reached, "{} counts", bench.truth().axes[0].encoder_counts);
    assert_at_rest(&mut bench);
}

#[test]
fn the_measurement_of_full_speed_is_reached_from_the_menu() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Device");
    bench.press("Measure QPPS…");
    assert_eq!(bench.model().screen, brushwork_gui::model::screen::Screen::Pwm);
    assert!(bench.sees_part("QPPS"));
    assert!(bench.both_stand());
}

#[test]
fn stop_cancel_leaving_unplugging_and_freezing_in_the_middle_stand_the_motors() {
    type End = fn(&mut Bench);
    let ends: [End; 5] = [
        |bench| bench.key(Key::Space),
        |bench| bench.press("Cancel"),
        |bench| bench.press("Device Status"),
        |bench| bench.act(&WorldAction::Unplug { unplugged: true }),
        |bench| bench.freeze(Duration::from_millis(300)),
    ];
    for end in ends {
        let mut bench = armed_on("PWM Settings");
        bench.press("Run profile");
        bench.pass_ms(1300);
        assert!(bench.real_duty(Motor::M1) > 0.25);
        end(&mut bench);
        bench.pass_ms(1500);
        assert_at_rest(&mut bench);
        assert!(!bench.model().front.is_guided());
    }
}

#[test]
fn what_cannot_be_played_says_why_and_moves_nothing() {
    let mut bench = armed_on("PWM Settings");
    bench.enter("Profile to", "0");
    assert!(bench.sees_part("From and To are the same"));
    bench.press("Run profile");
    bench.pass_ms(500);
    assert!(bench.both_stand());
}

#[test]
fn a_jog_button_runs_its_motor_while_it_is_held_by_mouse() {
    for (screen, least) in [("PWM Settings", 0.19), ("Velocity Settings", 0.02)] {
        let mut bench = armed_on(screen);
        bench.hold("M1 jog backward");
        bench.pass_ms(1000);
        assert!(bench.real_duty(Motor::M1) < -least, "{screen}");
        bench.let_go("M1 jog backward");
        bench.pass_ms(1500);
        let stands = bench.truth().axes[0].encoder_counts;
        bench.pass_ms(500);
        let crept = bench.truth().axes[0].encoder_counts - stands;
        assert!(crept.abs() < 50, "{screen}: {crept}");
    }
}

#[test]
fn a_jog_button_runs_its_motor_while_enter_is_held_and_the_window_has_the_focus() {
    let mut bench = armed_on("PWM Settings");
    bench.focus("M1 jog forward");
    bench.harness.key_down(Key::Enter);
    bench.pass_ms(1000);
    assert!(bench.real_duty(Motor::M1) > 0.19);
    bench.harness.key_up(Key::Enter);
    bench.pass_ms(800);
    assert!(bench.both_stand());
    bench.harness.key_down(Key::Enter);
    bench.pass_ms(1000);
    assert!(bench.real_duty(Motor::M1) > 0.19);
    bench.harness.input_mut().focused = false;
    bench.pass_ms(800);
    assert!(bench.both_stand(), "the window lost the focus");
}

#[test]
fn a_held_jog_dies_with_a_frozen_window_and_with_stop() {
    let mut bench = armed_on("PWM Settings");
    bench.hold("M1 jog forward");
    bench.pass_ms(1000);
    bench.freeze(Duration::from_millis(300));
    assert!(bench.both_stand());
    bench.pass_ms(1000);
    assert_at_rest(&mut bench);
    let mut bench = armed_on("PWM Settings");
    bench.hold("M1 jog forward");
    bench.pass_ms(1000);
    bench.key(Key::Space);
    bench.pass_ms(1000);
    assert_at_rest(&mut bench);
}
