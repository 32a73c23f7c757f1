//! A SuprMotr in the window, by role and label, against a simulated controller in virtual time: its inputs and outputs, its macros, its
//! terminal.

use crate::support::alone::{LIMIT, alone};
use crate::support::one::One;
use brushwork_gui::suprmotr::SuprMotr;
use brushwork_link::settings::SettingValue;
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_suprmotr::sim_spec::SuprMotrSpec;
use brushwork_suprmotr_client::SuprMotrDriver;
use brushwork_suprmotr_sim::{SuprMotrBus, pin};
use brushwork_suprmotr_wire::Radix;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use std::time::Duration;

type Bench = One<SuprMotrBus>;

const TARGET: &str = "sim:suprmotr-v9";

/// A board that was told these lines before anybody connected, and was then switched off and on.
fn board(lines: &[&str]) -> SuprMotrBus {
    let spec = SuprMotrSpec::parse("suprmotr-v9,seed=0").expect("it is a board");
    let mut bus = spec.bus().expect("the preset is sound");
    let mut time = Duration::from_millis(200);
    bus.advance(time);
    bus.exchange(b"\x010", Duration::from_millis(20));
    for line in lines {
        bus.exchange(format!("{line}\r").as_bytes(), Duration::from_millis(50));
    }
    for on in [false, true] {
        bus.apply(0, &WorldAction::Power { on });
        time = bus.now() + Duration::from_millis(500);
        bus.advance(time);
    }
    while bus.take_output(StreamIndex::Usb).is_some() {}
    bus
}

/// A window on a board.
fn connected(folder: &tempfile::TempDir, lines: &[&str]) -> Bench {
    let mut bench = Bench::new(folder, (&SuprMotrDriver, &SuprMotr), board(lines), TARGET);
    let begun = bench.line.with(|bus| bus.now());
    bench.line.clock.advance_to(begun);
    bench.app().open(TARGET);
    bench.pass_ms(5000);
    let phase = format!("{:?}", bench.app().model.front.phase);
    assert!(bench.app().model.front.is_connected(), "{phase}");
    bench
}

fn volts(bench: &Bench, pin: usize, volts: f64) {
    let signal = PinSignal::Volts { volts };
    bench.line.with(|bus| bus.apply(0, &WorldAction::SetPin { pin, signal }));
}

fn outputs(bench: &Bench) -> u16 {
    bench.line.with(|bus| bus.suprmotrs()[0].outputs())
}

/// Whether a button can be pressed.
fn can_press(bench: &Bench, label: &str) -> bool {
    let found = bench.harness.query_all_by_label(label);
    let mut buttons = found.filter(|node| node.accesskit_node().role() == Role::Button);
    !buttons.next().expect("there is such a button").accesskit_node().is_disabled()
}

#[test]
fn channels_are_turned_switched_and_seen_and_analog_lines_have_volts() {
    alone("suprmotr::channels_are_turned_switched_and_seen_and_analog_lines_have_volts", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &[]);
        bench.press("Inputs and Outputs");
        bench.pass_ms(2000);
        assert!(bench.sees("Channel 1 reads off") && bench.sees("Channel 16 reads off"));
        volts(&bench, pin::CHANNEL_1 + 6, 5.0);
        volts(&bench, pin::ANALOG_1, 2.49);
        bench.pass_ms(2000);
        assert!(bench.sees("Channel 7 reads on") && bench.sees("Channel 8 reads off"));
        assert!(bench.sees("Input 1 (J1 pin 3): 2.49 V (127)"), "an input in volts");
        assert!(bench.sees("Input 2 (J2 pin 1): 5.00 V (255)"), "its pull-up");
        assert!(bench.sees("Brake output (J3 pin 4): released"));

        // A channel is an output before it can be switched.
        assert!(!can_press(&bench, "Switch channel 3 on"));
        bench.press("Make channel 3 an output");
        bench.pass_ms(500);
        assert_eq!(outputs(&bench), 0);
        bench.press("Switch channel 3 on");
        bench.pass_ms(1000);
        assert_eq!(outputs(&bench), 0x0004);
        assert!(bench.sees("Channel 3 reads on"));
        // The same by the keyboard alone.
        bench.harness.get_by_label("Switch channel 3 off").focus();
        bench.harness.step();
        bench.harness.key_press(egui::Key::Enter);
        bench.pass_ms(1000);
        assert_eq!(outputs(&bench), 0);
        assert!(bench.sees("Channel 3 reads off"));
        bench.press("Make channel 3 an input");
        bench.pass_ms(500);
        assert!(!can_press(&bench, "Switch channel 3 on"));

        bench.app().model.front.suprmotr_mut().channels.wanted_volts = 2.5;
        bench.press("Set the analog output");
        bench.pass_ms(2000);
        assert_eq!(bench.line.with(|bus| bus.suprmotrs()[0].analog_output()), 128);
        assert!(bench.sees("Output (J3 pin 17): 2.51 V (128)"));
    });
}

#[test]
fn a_macro_goes_on_while_its_channels_are_watched_and_nothing_else_is_sent() {
    alone("suprmotr::a_macro_goes_on_while_its_channels_are_watched_and_nothing_else_is_sent", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &["MD0,CN5,WA900,CF5,WA900,RP"]);
        assert!(bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()), "it runs from power-up on");
        bench.press("Inputs and Outputs");
        let mut seen = [false; 2];
        for _ in 0..60 {
            bench.pass_ms(100);
            seen[0] |= bench.sees("Channel 5 reads off");
            seen[1] |= bench.sees("Channel 5 reads on");
        }
        assert_eq!(seen, [true; 2], "both levels are seen");
        assert!(bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()), "and it still runs");
        assert!(bench.sees("A macro or a wait is in process"));
        assert!(bench.sees("Input 1 (J1 pin 3): not read"));
        for label in ["Make channel 3 an output", "Switch channel 5 on", "Set the analog output"] {
            assert!(!can_press(&bench, label), "{label}");
        }
        bench.press("Stop All");
        bench.pass_ms(3000);
        assert!(!bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()));
        assert!(!bench.sees("A macro or a wait is in process"));
        assert!(bench.sees("Input 1 (J1 pin 3): 0.00 V (0)"), "lines are sent again");
        assert!(can_press(&bench, "Make channel 3 an output"));
    });
}

/// What stands in the editor, checked.
fn write(bench: &mut Bench, text: &str) {
    let document = bench.app().model.mcl.front_mut();
    document.replace_all(text);
    document.known();
    bench.pass_ms(100);
}

fn commands_of(bench: &Bench, number: u8) -> Vec<String> {
    bench.line.with(|bus| {
        let commands = bus.suprmotrs()[0].eeprom().macro_of(number).to_vec();
        commands.into_iter().map(|command| command.text(Radix::Decimal)).collect()
    })
}

const SHUTTLE: &str = "\
# To and fro.
const FAR = 2000

macro shuttle = 3
    MA FAR, WS 300
    MA 0, WS 300
    RP

macro twice
    MC shuttle
";

#[test]
fn macros_are_checked_stored_read_back_compared_and_run_when_armed() {
    alone("suprmotr::macros_are_checked_stored_read_back_compared_and_run_when_armed", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &["MD3,GH", "MD9,MF"]);
        bench.press("Macros");
        bench.press("New macro file");
        write(&mut bench, "macro shuttle = 3\n    MA FAR, QQ 5\n");
        assert!(bench.sees("line 2") && bench.sees("There is no command QQ"));
        assert!(!can_press(&bench, "Store macros on the board"), "it has errors");
        let problem = bench.harness.query_all_by_label_contains("There is no command QQ").next();
        problem.expect("it is listed").click();
        bench.pass_ms(100);
        assert!(bench.sees("line 2"), "the caret is where the mistake is");
        let caret = bench.app().model.mcl.front().caret.range();
        assert_eq!(caret.start, "macro shuttle = 3\n    MA FAR, ".len());

        write(&mut bench, SHUTTLE);
        assert!(bench.sees("No problems."));
        bench.press("Compare macros with the board");
        bench.pass_ms(6000);
        assert!(bench.sees(
            "Other commands on the board: 3 shuttle. Not on the board: 1 twice. On the board alone: 9."
        ));
        bench.press("Store macros on the board");
        bench.pass_ms(4000);
        assert!(bench.sees("Stored and read back: 2 macros."));
        assert_eq!(commands_of(&bench, 3), ["MA2000", "WS300", "MA0", "WS300", "RP"]);
        assert_eq!(
            (commands_of(&bench, 1), commands_of(&bench, 9)),
            (vec!["MC3".to_owned()], vec!["MF".to_owned()])
        );

        // What is read takes its names from the file in front.
        bench.press("Read macros from the board");
        bench.pass_ms(6000);
        assert!(bench.sees("Read from the board: 3 macros."));
        let read = bench.app().model.mcl.front().text.text();
        assert!(
            read.contains("macro shuttle = 3")
                && read.contains("MC shuttle")
                && read.contains("macro macro_9 = 9"),
            "{read}"
        );
        bench.press("Compare macros with the board");
        bench.pass_ms(6000);
        assert!(bench.sees("The board and the file have the same: 3 macros."));

        // A macro moves the motor: only when armed, and Stop ends it.
        bench.app().model.front.suprmotr_mut().board.chosen = 3;
        bench.pass_ms(100);
        assert!(!can_press(&bench, "Run macro"));
        bench.press("Arm");
        bench.pass_ms(1000);
        bench.press("Run macro");
        bench.pass_ms(1000);
        assert!(bench.sees("Macro 3 was called."));
        let position = |bench: &Bench| bench.line.with(|bus| bus.suprmotrs()[0].position());
        let mut furthest = 0;
        for _ in 0..50 {
            bench.pass_ms(100);
            furthest = furthest.max(position(&bench));
        }
        assert!((1900..2100).contains(&furthest), "{furthest}");
        assert!(bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()), "polling leaves it alone");
        // A line would end it, so none is sent.
        bench.press("Read macros from the board");
        bench.pass_ms(1000);
        assert!(bench.sees("A macro or a wait is in process, which a line would end."));
        assert!(bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()));
        bench.press("Stop All");
        bench.pass_ms(2000);
        assert!(!bench.line.with(|bus| bus.suprmotrs()[0].is_in_macro()));
        let stopped = position(&bench);
        bench.pass_ms(1000);
        assert!((position(&bench) - stopped).abs() < 5);
    });
}

#[test]
fn a_macro_that_runs_at_power_up_is_stored_by_a_second_word_alone() {
    alone("suprmotr::a_macro_that_runs_at_power_up_is_stored_by_a_second_word_alone", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &[]);
        bench.press("Macros");
        bench.press("New macro file");
        write(&mut bench, "macro home = 0\n    GH, WS 100\n");
        assert!(bench.sees("it runs as soon as the controller has power"), "a warning in its place");
        assert!(!can_press(&bench, "Store macros on the board"));
        bench.press("Autostart");
        bench.press("Store macros on the board");
        bench.pass_ms(3000);
        assert!(bench.sees("Stored and read back: 1 macro."));
        assert_eq!(commands_of(&bench, 0), ["GH", "WS100"]);
        // Another text has to be agreed to anew.
        write(&mut bench, "macro home = 0\n    MA 500, WS 100\n");
        assert!(!can_press(&bench, "Store macros on the board"));
    });
}

fn type_in(bench: &mut Bench, text: &str) {
    let field = bench.harness.get_by_label("Line");
    field.focus();
    field.type_text(text);
    bench.harness.step();
    bench.harness.key_press(egui::Key::Enter);
    bench.pass_ms(1500);
}

#[test]
fn the_terminal_tells_lines_and_characters_in_words_and_moves_nothing() {
    alone("suprmotr::the_terminal_tells_lines_and_characters_in_words_and_moves_nothing", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &["MD5,CN 5,WA 500,CF 5"]);
        bench.press("Terminal");
        type_in(&mut bench, "GP");
        assert!(bench.sees("> GP") && bench.sees("Get P-Term"));
        type_in(&mut bench, "%");
        assert!(bench.sees("Trajectory complete"), "a status in words");
        type_in(&mut bench, "TM5");
        assert!(bench.sees("Wait 500 ms"), "a macro in words");
        for moves in ["MR 500", "MC5", "RT"] {
            type_in(&mut bench, moves);
            assert!(bench.sees("not armed"), "{moves}");
            bench.press("Clear");
        }
        assert_eq!(bench.line.with(|bus| bus.suprmotrs()[0].position()), 0);
        type_in(&mut bench, "CN 3");
        assert_eq!(outputs(&bench), 0x0004);
        assert!(bench.sees("Channel On"));
    });
}

#[test]
fn gains_are_bytes_beside_the_graph_and_are_written_by_a_button_alone() {
    alone("suprmotr::gains_are_bytes_beside_the_graph_and_are_written_by_a_button_alone", LIMIT, || {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut bench = connected(&folder, &[]);
        bench.press("Motion");
        bench.press("Gains");
        bench.pass_ms(4000);
        assert!(bench.sees("As the unit holds them: whole numbers, gains up to 255."));
        let edit = |bench: &mut Bench, key: &str, value: i64| {
            let unit = bench.app().model.front.settings.unit_mut().expect("its settings are there");
            unit.set(key, SettingValue::Int(value));
            bench.pass_ms(500);
        };
        let held = |bench: &Bench| bench.line.with(|bus| bus.suprmotrs()[0].parameters().clone());
        assert!(!can_press(&bench, "Apply gains to RAM"));
        // More than a byte cannot be typed.
        let field = bench.harness.get_by_label("P");
        field.focus();
        field.type_text("300");
        bench.harness.step();
        bench.harness.key_press(egui::Key::Enter);
        bench.pass_ms(500);
        let wanted = bench.app().model.front.settings.unit().and_then(|unit| unit.wanted("loop.p"));
        assert!(matches!(wanted, Some(SettingValue::Int(..=255))), "{wanted:?}");
        edit(&mut bench, "loop.p", 90);
        edit(&mut bench, "loop.i", 3);
        assert!(bench.sees("Edited and not applied: 2."));
        assert_eq!((held(&bench).proportional, held(&bench).integral), (75, 0), "nothing is written yet");
        edit(&mut bench, "loop.integral_limit", 0);
        assert!(bench.sees("DI does nothing while DL is 0."));
        edit(&mut bench, "loop.integral_limit", 100);
        bench.press("Apply gains to RAM");
        bench.pass_ms(6000);
        assert_eq!((held(&bench).proportional, held(&bench).integral), (90, 3));
        assert!(bench.sees("As the unit holds them"));
        assert_eq!(bench.line.with(|bus| bus.suprmotrs()[0].eeprom_writes()), 0);
    });
}

#[test]
fn the_home_guide_of_the_manual_makes_the_edge_of_the_limit_switch_zero_and_a_stop_leaves_all_as_it_was() {
    alone(
        "suprmotr::the_home_guide_of_the_manual_makes_the_edge_of_the_limit_switch_zero_and_a_stop_leaves_all_as_it_was",
        LIMIT,
        || {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            let mut bench = connected(&folder, &[]);
            bench.press("Motion");
            bench.press("Home");
            bench.pass_ms(4000);
            assert!(!can_press(&bench, "Find home"), "disarmed");
            let velocity = |bench: &Bench| bench.line.with(|bus| bus.suprmotrs()[0].parameters().velocity);
            let position = |bench: &Bench| bench.line.with(|bus| bus.suprmotrs()[0].position());
            for is_stopped in [true, false] {
                bench.press("Arm");
                bench.pass_ms(1000);
                bench.press("Find home");
                bench.pass_ms(2500);
                assert!(bench.sees("Home step FE1: to the negative limit switch: runs"));
                assert_eq!(velocity(&bench), 10_000);
                assert!(position(&bench) < -1_000, "it moves");
                if is_stopped {
                    bench.press("Stop All");
                    bench.pass_ms(3000);
                    assert!(bench.sees("Stopped: nothing was made 0"));
                    let stood = position(&bench);
                    bench.pass_ms(1000);
                    assert!((position(&bench) - stood).abs() < 30 && stood < -1_000, "{stood}");
                    assert_eq!(velocity(&bench), 20_000, "the user's again");
                    continue;
                }
                for _ in 0..120 {
                    if bench.sees("Home: this place is 0.") {
                        break;
                    }
                    bench.pass_ms(500);
                }
                assert!(bench.sees("Home: this place is 0."));
                assert!(position(&bench).abs() < 60, "{}", position(&bench));
                assert_eq!(velocity(&bench), 20_000);
                assert!(
                    !bench.app().model.front.link.arming.is_armed_for(brushwork_link::ArmScope::Position)
                );
            }
        },
    );
}

#[test]
fn a_macro_is_stepped_through_on_a_simulated_board_of_the_window_and_nothing_is_sent() {
    alone(
        "suprmotr::a_macro_is_stepped_through_on_a_simulated_board_of_the_window_and_nothing_is_sent",
        LIMIT,
        || {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            let mut bench = connected(&folder, &[]);
            bench.press("Macros");
            assert!(!bench.sees("This port goes to the controller's"), "it has no streams to choose from");
            bench.app().model.mcl.open_named("slide.macros", "macro go = 3\n    MA 500, WS 50\n    CN 1\n");
            bench.pass_ms(500);
            let halted = |bench: &mut Bench| bench.app().model.mcl.front().run.halted_at;
            bench.press("Step through the macro in the simulator");
            bench.pass_ms(200);
            assert!(bench.sees("Simulated: go MA"));
            assert_eq!(halted(&mut bench), Some(1));
            for command in ["Simulated: go WS", "Simulated: go CN"] {
                bench.press("Step through the macro in the simulator");
                bench.pass_ms(200);
                let (told, _) = bench.app().model.front.suprmotr().board.steps().expect("it goes on");
                assert!(told.starts_with(command), "{told}");
            }
            assert_eq!(halted(&mut bench), Some(2));
            bench.press("Step through the macro in the simulator");
            bench.pass_ms(200);
            assert!(bench.sees("Simulated: ended") && bench.sees("outputs 0000000000000001"));
            assert_eq!(halted(&mut bench), None);
            assert_eq!((outputs(&bench), bench.line.with(|bus| bus.suprmotrs()[0].position())), (0, 0));
            bench.press("End the simulated steps");
            bench.pass_ms(200);
            assert!(!bench.sees("Simulated:"));
        },
    );
}
