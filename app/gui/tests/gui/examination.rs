//! The window that examines a controller, against a simulated one in virtual time.

use crate::support::bench::Bench;
use brushwork_core::examine::State;
use brushwork_gui::model::link::Arming;
use brushwork_mcp_sim::settings::Settings;
use brushwork_values::Motor;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

/// Connected, its settings read, with the window open.
fn opened() -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(3000);
    bench.model().front.examination.open = true;
    bench.pass_ms(200);
    bench
}

/// Lets it go on until it has ended; the greatest duty on the way.
fn run(bench: &mut Bench) -> f64 {
    let mut greatest = 0.0_f64;
    for _ in 0..3000 {
        if !bench.model().front.examination.is_running() {
            break;
        }
        bench.pass_ms(100);
        greatest = greatest.max(bench.real_duty(Motor::M1).abs());
    }
    assert!(!bench.model().front.examination.is_running(), "{:?}", bench.said());
    bench.pass_ms(500);
    greatest
}

fn state_of(bench: &mut Bench, key: &str) -> State {
    let found = bench.model().front.examination.found().expect("there is a report").clone();
    found
        .answers
        .iter()
        .find(|answer| answer.key == key)
        .map(|answer| answer.state)
        .expect("it is a question")
}

/// What the simulated controller holds.
fn ram(bench: &Bench) -> Settings {
    bench.line.with(|bus| bus.controllers()[0].settings())
}

fn tick(bench: &mut Bench, step: &str) {
    bench.harness.get_by_role_and_label(Role::CheckBox, step).click();
    bench.pass_ms(200);
}

#[test]
fn without_a_tick_it_reads_and_says_what_was_not_asked() {
    let mut bench = opened();
    let before = ram(&bench);
    bench.press("Examine");
    let greatest = run(&mut bench);
    assert!(greatest < f64::EPSILON, "nothing moves");
    assert_eq!(ram(&bench), before);
    assert!(bench.said().iter().any(|text| text == "The examination is done."), "{:?}", bench.said());
    let found = bench.model().front.examination.found().expect("there is a report").clone();
    let of = |state| found.answers.iter().filter(|answer| answer.state == state).count();
    assert!(of(State::Answered) > 0 && of(State::NotAsked) > 0);
    assert!(found.text().contains("the owner did not agree"), "{}", found.text());
}

#[test]
fn the_moving_step_is_armed_for_itself_and_leaves_everything_as_it_was() {
    let mut bench = opened();
    let before = ram(&bench);
    tick(&mut bench, "Look at the loops of a motor");
    bench.press("Examine");
    let greatest = run(&mut bench);
    assert!(greatest > 0.0, "the motor has moved");
    assert!(bench.both_stand());
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
    assert_eq!(state_of(&mut bench, "loop_rate"), State::Answered, "{:?}", bench.said());
    assert_eq!(ram(&bench), before);
}

#[test]
fn stop_ends_it_and_what_was_changed_is_put_back() {
    let mut bench = opened();
    let before = ram(&bench);
    tick(&mut bench, "Look at the loops of a motor");
    bench.press("Examine");
    for _ in 0..2000 {
        bench.pass_ms(50);
        if bench.real_duty(Motor::M1).abs() > 0.05 {
            break;
        }
    }
    assert!(bench.real_duty(Motor::M1).abs() > 0.05, "it has begun to move");
    bench.key(Key::Escape);
    bench.pass_ms(300);
    assert!(bench.both_stand(), "duty is 0");
    run(&mut bench);
    let said = bench.said();
    assert!(said.iter().any(|text| text.contains("ended before its end: Stop was pressed")), "{said:?}");
    assert_eq!(ram(&bench), before);
}

#[test]
fn another_unit_that_is_chosen_meanwhile_is_not_given_what_is_put_back() {
    let mut bench = Bench::with_two_units();
    bench.connect();
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(8000);
    let both = |bench: &Bench| bench.line.with(|bus| [0, 1].map(|unit| bus.controllers()[unit].settings()));
    let before = both(&bench);
    bench.model().front.examination.open = true;
    bench.pass_ms(200);
    tick(&mut bench, "Look at the loops of a motor");
    bench.press("Examine");
    for _ in 0..4000 {
        bench.pass_ms(50);
        if bench.real_duty(Motor::M1).abs() > 0.05 {
            break;
        }
    }
    assert!(bench.real_duty(Motor::M1).abs() > 0.05, "{:?}", bench.said());
    bench.press("0x81  MCP266");
    run(&mut bench);
    bench.pass_ms(3000);
    let said = bench.said();
    assert_eq!(bench.model().front.link.selected, Some(0x81), "{said:?}");
    assert!(bench.both_stand());
    assert_eq!(both(&bench), before);
}
