//! Auto-tuning as Ion Studio has it: the buttons, the levels and the methods, against what the controller is made to do.

use brushwork_gui::model::screen::Screen;
use brushwork_gui::tune::Loop;
use brushwork_tuning::registers::RegisterTable as _;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;
use egui::Key;

use super::{Row, arm};
use crate::support::bench::Bench;

pub fn play(bench: &mut Bench, row: &Row, name: &str) {
    let which = if row.section == "1.2.12" { Loop::Velocity } else { Loop::Position };
    let motor = if row.label.contains("M2") { Motor::M2 } else { Motor::M1 };
    match name {
        "tune_m1" | "tune_m2" => tune(bench, row, which, motor),
        "tune_level" => level(bench, row, which, motor),
        "tune_method" => method(bench, row),
        other => panic!("no such scene: {other}"),
    }
}

/// A whole run: gains are proposed, the other motor has not moved, nothing has stayed in the controller.
fn tune(bench: &mut Bench, row: &Row, which: Loop, motor: Motor) {
    let other = usize::from(motor == Motor::M1);
    let before = (bench.truth().axes[other].encoder_counts, settings(bench));
    // How far the axis may go is asked for; that the button waits for it is tested with the guided run.
    bench.model().front.tune.panel_mut(which, motor).setting.is_travel_chosen = true;
    arm(bench);
    bench.press(row.label);
    for _ in 0..60 {
        bench.pass_ms(1000);
        if !bench.model().front.tune.is_running() {
            break;
        }
    }
    let run =
        bench.model().front.tune.panel(which, motor).run().cloned().unwrap_or_else(|| panic!("{row:?}"));
    assert_ne!(run.report.verdict, Verdict::Refused, "{row:?}: {:?}", run.report.causes);
    assert!(run.first.is_some_and(|gains| gains.raw("velocity.qpps") > Some(1000)), "{row:?}");
    assert_eq!((bench.truth().axes[other].encoder_counts, settings(bench)), before, "{row:?}");
    assert!(bench.both_stand(), "{row:?}");
}

/// The keyboard moves it, and after a run the gains of that level are considered.
fn level(bench: &mut Bench, row: &Row, which: Loop, motor: Motor) {
    bench.focus_label(row.label);
    for _ in 0..2 {
        bench.key(Key::PageUp);
    }
    let panel = bench.model().front.tune.panel(which, motor);
    assert_eq!(panel.setting.level, 70.0, "{row:?}");
    let run = panel.run().unwrap_or_else(|| panic!("tuned in the row before: {row:?}"));
    assert!(run.shown.is_some() && run.level == 70.0, "{row:?}");
}

fn method(bench: &mut Bench, row: &Row) {
    assert_eq!(bench.model().screen, Screen::Position);
    bench.press(row.label);
    let chosen = bench.model().front.tune.panel(Loop::Position, Motor::M1).setting.method;
    let wanted = match row.label {
        "PD" => Method::Pd,
        "PID" => Method::Pid,
        _ => Method::Piv,
    };
    assert_eq!(chosen, wanted, "{row:?}");
}

fn settings(bench: &Bench) -> [brushwork_mcp_sim::motion::MotionSettings; 2] {
    let settings = bench.line.with(|bus| bus.controllers()[0].settings());
    [settings.motors[0].motion, settings.motors[1].motion]
}
