//! A MotorVator in the window, by role and label, against a simulated board in virtual time: what it shows, its motors, its stepper, its
//! terminal.

use crate::support::alone::{LIMIT, alone};
use crate::support::one::One;
use brushwork_gui::motorvator::Motorvator;
use brushwork_motorvator::sim_spec::{MotorvatorSpec, library};
use brushwork_motorvator_client::MotorvatorDriver;
use brushwork_motorvator_sim::DrivenMotorvator;
use brushwork_plant::machine::Machine as _;
use egui_kittest::kittest::Queryable as _;

type Bench = One<DrivenMotorvator>;

/// A window on a board that runs the host library.
fn connected(folder: &tempfile::TempDir) -> Bench {
    let spec = MotorvatorSpec::parse("motorvator-3,seed=0").expect("it is a board");
    let board = spec.board(library()).expect("the preset is sound");
    let mut bench = Bench::new(folder, (&MotorvatorDriver, &Motorvator), board, "sim:motorvator-3");
    bench.app().open("sim:motorvator-3");
    bench.pass_ms(3000);
    assert!(bench.app().model.front.is_connected());
    bench
}

/// What motors A, B, C and D get, in percent.
fn told(bench: &Bench) -> [i32; 4] {
    bench.line.with(|machine| machine.board().motors())
}

fn type_in(bench: &mut Bench, label: &str, text: &str) {
    let field = bench.harness.get_by_label(label);
    field.focus();
    field.type_text(text);
    bench.harness.step();
    bench.harness.key_press(egui::Key::Enter);
    bench.pass_ms(500);
}

#[test]
fn the_display_the_motors_and_every_way_out_of_driving() {
    alone("motorvator::the_display_the_motors_and_every_way_out_of_driving", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder);
        assert!(bench.sees("Display H2"), "the display of the library");
        assert!(bench.sees("HOST: OK"), "an indicator");
        bench.press("Motors");
        bench.app().model.front.pwm.set_duty(brushwork_values::Motor::M1, 40.0);
        bench.pass_ms(500);
        assert_eq!(told(&bench), [0; 4], "a disarmed slider moves nothing");
        for way in ["Stop All", "Arm", "Device Status"] {
            bench.press("Motors");
            bench.press("Arm");
            bench.pass_ms(300);
            bench.app().model.front.pwm.set_duty(brushwork_values::Motor::M1, 40.0);
            bench.app().model.front.pwm.set_duty(brushwork_values::Motor::M2, -25.4);
            bench.pass_ms(500);
            assert_eq!(told(&bench), [40, -25, 0, 0], "before {way}");
            bench.press(way);
            bench.pass_ms(500);
            assert_eq!(told(&bench), [0; 4], "{way}");
        }
    });
}

#[test]
fn the_search_finds_the_smallest_waits_that_lose_no_steps() {
    alone("motorvator::the_search_finds_the_smallest_waits_that_lose_no_steps", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder);
        bench.press("Stepper");
        bench.press("Arm");
        bench.pass_ms(300);
        // A rotor without current does not hold what it was moved.
        bench.app().model.front.motorvator_mut().stepper.hold_percent = 50.0;
        bench.press("Find the smallest waits");
        let lost = |bench: &Bench| bench.line.with(|machine| machine.lost_steps()[0]);
        let mut before = lost(&bench);
        let mut trials = 0;
        while !bench.sees("Found, with a fifth more") {
            assert!(trials < 25, "it does not end");
            for _ in 0..100 {
                if bench.sees("The mark came back") {
                    break;
                }
                bench.pass_ms(500);
            }
            let now = lost(&bench);
            bench.press(if now == before { "The mark came back" } else { "The stepper lost steps" });
            (before, trials) = (now, trials + 1);
        }
        bench.pass_ms(500);
        let found = bench.app().model.front.motorvator().stepper.config();
        println!("{trials} trials: {}", found.statement(1));
        assert!(found.least <= found.most && found.most < 20, "{found:?}");
        // What was found loses nothing, and much less does.
        bench.press("Move forward");
        bench.pass_ms(8000);
        assert_eq!(lost(&bench), before);
        assert_eq!(bench.line.with(|machine| machine.board().steps()[0]), 200);
        assert!(bench.sees(&found.statement(1)), "the line for a program");
    });
}

#[test]
fn the_terminal_makes_triplets_and_tells_what_came_back() {
    alone("motorvator::the_terminal_makes_triplets_and_tells_what_came_back", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder);
        bench.press("Terminal");
        type_in(&mut bench, "Line", "80 7");
        assert!(bench.sees("> I080007") && bench.sees("host library, version 2, answer 7"));
        type_in(&mut bench, "Line", "H");
        assert!(bench.sees("MotorVator AWOS 2.32"));
        type_in(&mut bench, "Line", "77 1 1 70 60");
        assert!(bench.sees("not armed"));
        // G starts what is in the memory, here the library anew, when its risk was accepted.
        type_in(&mut bench, "Line", "G");
        assert!(bench.sees("It may move motors at once"), "Enter starts nothing");
        bench.press("I have the switch of the motors' power at hand");
        bench.press("Start the program");
        bench.pass_ms(4000);
        assert!(!bench.sees("It may move motors at once"));
        type_in(&mut bench, "Line", "80 9");
        assert!(bench.sees("host library, version 2, answer 9"));
        assert_eq!(told(&bench), [0; 4]);
        assert_eq!(bench.line.with(|machine| machine.units()), 2);
    });
}
