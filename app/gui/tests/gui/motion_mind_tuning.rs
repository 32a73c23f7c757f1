//! Guided tuning of a Motion Mind 3 in the window, by role and label: the same guide as the MCP's with this family's registers. The
//! device loop runs in lockstep with the frames, in virtual time.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_gui::tune::Loop;
use brushwork_gui::tune::run::Run;
use brushwork_motion_mind_axis::law::{MotionMindRegisters, bits};
use brushwork_motion_mind_sim::{Mode, MotionMindConfig, Protocol};
use brushwork_motion_mind_wire::register_named;
use brushwork_plant::machine::Machine as _;
use brushwork_plant::world::WorldAction;
use brushwork_tuning::registers::RegisterTable as _;
use brushwork_tuning::report::Verdict;
use brushwork_values::Motor;
use egui::{Key, Modifiers};

/// The registers that a run touches, by number.
const TOUCHED: [u8; 11] = [2, 3, 4, 5, 6, 8, 23, 24, 26, 28, 30];

/// An armed screen with guided tuning open.
fn opened_with(config: MotionMindConfig, screen: &str) -> Bench {
    let mut bench = Bench::with_minds(vec![config]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(3000);
    bench.arm_on(screen);
    bench.press("Tune");
    bench
}

fn opened(screen: &str) -> Bench {
    opened_with(MotionMindConfig::new(Mode::SerialPid), screen)
}

fn held(bench: &Bench) -> Vec<i64> {
    bench.minds.with(|bus| TOUCHED.map(|number| bus.motion_minds()[0].read_one(number)).to_vec())
}

/// A register as the simulated unit has it.
fn read(bench: &Bench, name: &str) -> i64 {
    let number = register_named(name).expect("a register of the manual").number;
    bench.minds.with(|bus| bus.motion_minds()[0].read_one(number))
}

fn eeprom_writes(bench: &Bench) -> u64 {
    bench.minds.with(|bus| bus.motion_minds()[0].eeprom_writes())
}

fn duty(bench: &Bench) -> f64 {
    match bench.minds.with(|bus| bus.views().remove(0)).axes[Motor::M1.index()].output {
        brushwork_plant::bridge::BridgeOutput::Duty(duty) => duty,
        _ => 0.0,
    }
}

/// A loop that holds its motor at rest may give it a little.
fn stands(bench: &Bench) -> bool {
    duty(bench).abs() < 0.1
}

#[track_caller]
fn finish(bench: &mut Bench) {
    for _ in 0..90 {
        if !bench.model().front.tune.is_running() {
            break;
        }
        bench.pass_ms(1000);
    }
    assert!(!bench.model().front.tune.is_running(), "it ends by itself: {:?}", bench.said());
    bench.pass_ms(1500);
    assert!(stands(bench), "{}", duty(bench));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

#[track_caller]
fn run(bench: &mut Bench, which: Loop) -> Run {
    let run = bench.model().front.tune.front(which).run().cloned();
    run.unwrap_or_else(|| panic!("no run: {:?}", bench.said()))
}

fn proposed(bench: &mut Bench, which: Loop) -> MotionMindRegisters {
    run(bench, which)
        .shown
        .expect("gains")
        .registers
        .first
        .second
        .motion_mind
        .expect("registers of a Motion Mind")
}

/// Presses what may have to be scrolled to first, as with a wheel.
fn press_below(bench: &mut Bench, label: &str) {
    bench.button(label).scroll_to_me();
    bench.pass_ms(300);
    bench.press(label);
}

#[track_caller]
fn assert_holds(bench: &Bench, wanted: MotionMindRegisters) {
    let gains = ["PTERM", "ITERM", "DTERM", "PIDSCALAR", "VELOCITYFF"].map(|name| read(bench, name));
    let terms = [wanted.pterm, wanted.iterm, wanted.dterm].map(i64::from);
    assert_eq!(gains[..3], terms);
    assert_eq!(gains[3..], [i64::from(wanted.pidscalar), i64::from(wanted.velocity_ff)]);
    assert_eq!(read(bench, "FUNCTION"), i64::from(wanted.function));
}

#[test]
fn a_velocity_loop_is_tuned_applied_verified_saved_and_undone() {
    let mut bench = opened("Velocity");
    let before = held(&bench);
    assert!(
        !bench.sees("Tune M2") && !bench.sees("PIV") && !bench.sees("Encoder"),
        "what does not apply is not shown"
    );
    bench.press("Tune M1");
    bench.pass_ms(2500);
    assert!(bench.sees_part("Live speed of the run"));
    assert!(bench.sees_part("s left"));
    finish(&mut bench);
    let tuned = run(&mut bench, Loop::Velocity);
    assert_ne!(tuned.report.verdict, Verdict::Refused, "{:?}", tuned.report.causes);
    assert_eq!(held(&bench), before, "nothing stays in the unit by itself");
    assert!(bench.sees_part("Measured speed over the predicted one: predicted"));
    for register in ["PTERM", "DTERM", "PIDSCALAR", "VELOCITYFF"] {
        assert!(bench.sees(&format!("M1 proposed {register}")), "{register}");
    }
    assert!(bench.sees_part("of a speed's duty"), "how much the feed-forward gives");
    let wanted = proposed(&mut bench, Loop::Velocity);
    bench.press("Apply (RAM)");
    bench.pass_ms(6000);
    assert_holds(&bench, wanted);
    assert_eq!(eeprom_writes(&bench), 0, "RAM alone");
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Verify");
    bench.pass_ms(1500);
    assert!(bench.model().front.tune.is_running(), "{:?}", bench.said());
    finish(&mut bench);
    let verified = run(&mut bench, Loop::Velocity).verified;
    assert!(bench.sees("Verified: the machine behaves as predicted."), "{verified:?}");
    assert_holds(&bench, wanted);
    press_below(&mut bench, "Save…");
    assert!(bench.sees_part("The motor stops while the EEPROM is written"));
    bench.press("Save");
    bench.pass_ms(9000);
    let stored = bench.minds.with(|bus| bus.motion_minds()[0].stored(4));
    assert_eq!(stored, i64::from(wanted.pterm), "{:?}", bench.said());
    bench.press("Velocity");
    press_below(&mut bench, "Undo");
    bench.pass_ms(6000);
    assert_eq!(held(&bench), before, "{:?}", bench.said());
}

#[test]
fn a_position_loop_is_tuned_by_both_methods_in_both_protocols() {
    for (method, protocol) in [("PD", Protocol::Binary), ("PID", Protocol::Text)] {
        let config = MotionMindConfig { protocol, ..MotionMindConfig::new(Mode::SerialPid) };
        let mut bench = opened_with(config, "Position");
        bench.press("Turns freely");
        bench.press(method);
        bench.press("Tune M1");
        finish(&mut bench);
        let tuned = run(&mut bench, Loop::Position);
        assert_ne!(tuned.report.verdict, Verdict::Refused, "{method}: {:?}", tuned.report.causes);
        assert!(bench.sees_part("Measured position over the predicted one"), "{method}");
        let gains = proposed(&mut bench, Loop::Position);
        assert!(gains.pterm > 0 && (method == "PID" || gains.iterm == 0), "{gains:?}");
        bench.press("Apply (RAM)");
        bench.pass_ms(9000);
        assert_holds(&bench, gains);
    }
}

#[test]
fn the_level_and_registers_by_hand_redraw_the_prediction_and_send_nothing() {
    let mut bench = opened("Position");
    bench.press("Turns freely");
    bench.press("PD");
    bench.press("Tune M1");
    finish(&mut bench);
    let (before, first) = (held(&bench), run(&mut bench, Loop::Position).shown.expect("gains"));
    bench.focus_label("M1 level");
    for _ in 0..25 {
        bench.key(Key::ArrowRight);
    }
    let shown = run(&mut bench, Loop::Position).shown.expect("gains");
    assert!(!shown.registers.same_gains(&first.registers));
    assert!(shown.forecast.load_dip < first.forecast.load_dip && shown.forecast.ms > first.forecast.ms);
    assert!(bench.sees_part("Considered on the model only"));
    bench.enter("M1 proposed PIDSCALAR", "2");
    assert!(bench.sees_part("Unstable on the model"), "what would happen is told before it does");
    bench.press("As proposed");
    assert!(run(&mut bench, Loop::Position).shown.expect("gains").registers.same_gains(&first.registers));
    for (kind, picture) in [
        ("Step", "Predicted step of the position: current, proposed"),
        ("Load", "Predicted position under a load step: current, proposed"),
        ("Bode", "Bode gain of the open loop: current, proposed"),
    ] {
        bench.press(kind);
        assert!(bench.sees(picture), "{picture}");
    }
    bench.pass_ms(1500);
    assert_eq!(held(&bench), before, "nothing was sent");
    assert!(stands(&bench));
}

/// Ends runs at several moments, and looks that the motor stands with the old registers in force, whenever it is.
#[track_caller]
fn end_at_any_moment(how: &str, end: impl Fn(&mut Bench), after: impl Fn(&mut Bench)) {
    for after_ms in [0, 700, 2600] {
        let mut bench = opened("Velocity");
        let before = held(&bench);
        bench.press("Tune M1");
        bench.pass_ms(after_ms);
        assert!(bench.model().front.tune.is_running(), "{how} after {after_ms} ms comes too late");
        end(&mut bench);
        bench.pass_ms(4000);
        after(&mut bench);
        assert!(stands(&bench), "{how} after {after_ms} ms: {}", duty(&bench));
        assert!(!bench.model().front.tune.is_running(), "{how} after {after_ms} ms: {:?}", bench.said());
        assert_eq!(bench.model().front.link.arming, Arming::Disarmed, "{how} after {after_ms} ms");
        assert_eq!(held(&bench), before, "{how} after {after_ms} ms");
    }
}

#[test]
fn space_esc_the_buttons_leaving_and_disarming_end_a_run_at_any_moment() {
    end_at_any_moment("Space", |bench| bench.key(Key::Space), |_| {});
    end_at_any_moment("Esc", |bench| bench.key(Key::Escape), |_| {});
    end_at_any_moment("Stop the run", |bench| bench.press("Stop the run"), |_| {});
    end_at_any_moment("leaving", |bench| bench.press("Device Status"), |_| {});
    end_at_any_moment(
        "disarming",
        |bench| bench.key_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::A),
        |_| {},
    );
}

#[test]
fn a_cable_pulled_out_in_a_run_leaves_nothing_behind_when_it_is_in_again() {
    let plug = |bench: &Bench, unplugged| {
        bench.minds.with(|bus| bus.apply(0, &WorldAction::Unplug { unplugged }));
    };
    end_at_any_moment(
        "unplugging",
        |bench| plug(bench, true),
        |bench| {
            plug(bench, false);
            bench.press("Connect");
            bench.pass_ms(12_000);
        },
    );
}

#[test]
fn a_frozen_window_stops_the_motor() {
    let mut bench = opened("Velocity");
    let before = held(&bench);
    bench.press("Tune M1");
    for _ in 0..80 {
        if duty(&bench) > 0.6 {
            break;
        }
        bench.pass_ms(100);
    }
    assert!(duty(&bench) > 0.6, "{}", duty(&bench));
    bench.freeze(Duration::from_millis(900));
    assert!(stands(&bench), "{}", duty(&bench));
    bench.pass_ms(5000);
    assert!(!bench.model().front.tune.is_running());
    assert_eq!(held(&bench), before);
}

#[test]
fn a_refusal_says_what_was_seen_and_offers_another_try() {
    let (motor, on) = (Motor::M1, true);
    for (wrong, sketch) in [
        (WorldAction::ReverseEncoder { motor, on }, "Sketch: The motor leads OR"),
        (WorldAction::LoseEncoder { motor, on }, "Sketch: The encoder's plug"),
        (WorldAction::LockShaft { motor, on }, "Sketch: The shaft is held"),
    ] {
        let mut bench = opened("Velocity");
        let before = held(&bench);
        bench.minds.with(|bus| bus.apply(0, &wrong));
        bench.press("Tune M1");
        finish(&mut bench);
        let causes = run(&mut bench, Loop::Velocity).report.causes;
        assert_eq!(run(&mut bench, Loop::Velocity).report.verdict, Verdict::Refused, "{wrong:?}");
        assert!(bench.sees_part(sketch), "{wrong:?}: {causes:?}");
        assert!(bench.sees("Try again"), "{wrong:?}");
        assert!(
            !bench.sees_part("PWM screen") && !bench.sees_part("General Settings"),
            "{wrong:?}: words of another family"
        );
        // With a fault the loop could drive the motor away: it stays off, which is said with how it comes back.
        let mut off = before;
        off[1] |= i64::from(bits::DISABLEPID);
        assert_eq!(held(&bench), off, "{wrong:?}");
        assert!(bench.sees_part("The controller's loop was left switched off (DISABLEPID"), "{wrong:?}");
    }
}

#[test]
fn where_it_cannot_be_tuned_the_tab_says_why() {
    let mut bench = Bench::with_minds_sized(
        vec![MotionMindConfig::new(Mode::AnalogPid)],
        [1920.0, 1080.0],
        egui::Theme::Dark,
    );
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(3000);
    bench.press("Registers");
    for act in ["Bits of FUNCTION", "FUNCTION ADSERIAL", "Write settings", "Write to controller"] {
        bench.press(act);
    }
    bench.pass_ms(4000);
    bench.press("Position");
    bench.press("Tune");
    assert!(bench.sees_part("Guided tuning needs mode 4"));
    assert!(!bench.sees("Tune M1"));
}

#[test]
fn tuning_needs_an_armed_screen() {
    let mut bench = opened("Velocity");
    bench.press("Arm");
    bench.pass_ms(300);
    bench.press("Tune M1");
    bench.pass_ms(1000);
    assert!(!bench.model().front.tune.is_running() && stands(&bench));
}

#[test]
fn a_loop_that_a_refused_run_left_off_is_seen_in_the_registers_and_switched_on_again() {
    let configs = vec![MotionMindConfig::new(Mode::SerialPid)];
    let mut bench = Bench::with_minds_sized(configs, [1920.0, 1080.0], egui::Theme::Dark);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(3000);
    bench.arm_on("Velocity");
    bench.press("Tune");
    let wrong = |on| WorldAction::ReverseEncoder { motor: Motor::M1, on };
    bench.minds.with(|bus| bus.apply(0, &wrong(true)));
    bench.press("Tune M1");
    finish(&mut bench);
    assert_eq!(read(&bench, "FUNCTION") & i64::from(bits::DISABLEPID), i64::from(bits::DISABLEPID));
    bench.minds.with(|bus| bus.apply(0, &wrong(false)));
    bench.press("Registers");
    bench.pass_ms(3000);
    assert!(bench.sees("FUNCTION in RAM: 0x4000"));
    bench.press("Velocity");
    bench.press("Arm");
    bench.pass_ms(2000);
    assert_eq!(read(&bench, "FUNCTION"), 0, "arming switches it on: {:?}", bench.said());
    bench.press("Tune M1");
    finish(&mut bench);
    assert_ne!(run(&mut bench, Loop::Velocity).report.verdict, Verdict::Refused);
}
