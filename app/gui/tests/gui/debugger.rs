//! The MCL debugger in the window, by role and label: a script in the simulated controller is run, stopped, looked into and changed.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_gui::graph::MarkKind;
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_script::debug::Wanted;
use brushwork_script::{image, mcl};
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

const PROGRAM: &str = "\
rounds var long
word1 var word
name var byte(4)
power 0,8192,0
main
rounds = rounds+1
gosub double[rounds],word1
puts 0,[dec word1,13]
pause 20
goto main

a var long
double [a]
return a*2
";

/// Lets frames pass until something is so; what compiles on its own thread needs real time.
fn until(bench: &mut Bench, what: &str, holds: impl FnMut(&mut Bench) -> bool) {
    bench.until_in_time(what, holds);
}

/// The MCL screen with the debugger open and a program in the editor and in the controller.
fn bench_with(text: &str, mut bench: Bench) -> Bench {
    bench.connect();
    bench.press("MCL Editor");
    let program = mcl::compile(text).program.expect("it compiles");
    let bytes = image::encode(&program);
    bench.line.with(|bus| bus.controllers_mut()[0].install_script(&bytes));
    bench.model().mcl.open_new(text);
    bench.press("Debugger");
    // Breakpoints with conditions need the names, and those a thread of the real world.
    until(&mut bench, "it is compiled", |bench| !bench.model().front.debug.is_compiling());
    bench
}

fn bench(text: &str) -> Bench {
    bench_with(text, Bench::new())
}

/// The same with the script paused at its first line.
fn paused(text: &str) -> Bench {
    let mut bench = bench(text);
    bench.press("Stop at start");
    start(&mut bench);
    until(&mut bench, "it stops at its start", |bench| bench.model().front.debug.is_paused());
    until(&mut bench, "its names are known", |bench| bench.model().front.debug.loaded().is_some());
    bench
}

fn start(bench: &mut Bench) {
    bench.key_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::A);
    bench.pass_ms(500);
    bench.press("Run");
    bench.pass_ms(100);
}

fn line(bench: &mut Bench) -> u32 {
    bench.pass_ms(300);
    bench.model().front.debug.view.as_ref().expect("a script").line
}

fn halted(bench: &mut Bench) -> Option<usize> {
    bench.model().mcl.front().run.halted_at.map(|line| line + 1)
}

#[test]
fn without_a_simulated_controller_the_panel_says_why_and_what_to_do() {
    let mut bench = Bench::new();
    bench.press("MCL Editor");
    bench.press("Debugger");
    assert!(bench.sees_part("connect to sim:mcp266, then download and start the program"));
    bench.press("Terminal");
    assert!(bench.sees_part("connect to sim:mcp266"));
    bench.connect();
    bench.model().front.worlds = None;
    let why = brushwork_gui::debugger::why_not(bench.model()).expect("a real controller");
    assert!(why.contains("cannot stop a program in the middle") && why.contains("sim:mcp266"), "{why}");
}

#[test]
fn running_needs_an_armed_screen_and_a_script_moves_its_motor() {
    let mut bench = bench(PROGRAM);
    bench.press("Run");
    assert!(bench.sees_part("arm the MCL Editor first"));
    assert!(bench.both_stand());
    start(&mut bench);
    bench.pass_ms(500);
    assert!((bench.real_duty(Motor::M1) - 0.25).abs() < 0.05);
    assert!(bench.sees_part("The script runs"));
    bench.press("Pause");
    until(&mut bench, "it pauses", |bench| bench.model().front.debug.is_paused());
    assert!(bench.sees_part("because Pause was asked for"));
    assert!(bench.sees("The motors go on as they were told."));
    let line = line(&mut bench);
    assert!(bench.sees(&format!("Script paused, line {line}")), "the left column tells the same");
    assert!(!bench.sees_part("Script running"));
    assert!((bench.real_duty(Motor::M1) - 0.25).abs() < 0.05);
    bench.press("Continue");
    until(&mut bench, "it goes on", |bench| bench.model().front.debug.is_running());
    bench.key(Key::Escape);
    until(&mut bench, "Stop ends it", |bench| bench.sees_part("command 249"));
    assert!(bench.both_stand());
}

#[test]
fn steps_show_each_line_in_the_text_and_the_keys_do_the_same_as_the_buttons() {
    let mut bench = paused(PROGRAM);
    assert_eq!((line(&mut bench), halted(&mut bench)), (4, Some(4)));
    assert!(bench.sees_part("Paused before the first line that does something, line 4."));
    bench.press("Step into");
    assert_eq!((line(&mut bench), halted(&mut bench)), (6, Some(6)));
    bench.key(Key::F11);
    assert_eq!(line(&mut bench), 7);
    bench.key(Key::F11);
    assert_eq!(line(&mut bench), 13);
    bench.press("Step out");
    assert_eq!(line(&mut bench), 8);
    bench.press("Step over");
    assert_eq!(line(&mut bench), 9);
    bench.key(Key::F12);
    assert_eq!(line(&mut bench), 10);
    bench.key(Key::F11);
    bench.key(Key::F11);
    bench.key(Key::F11);
    assert_eq!((line(&mut bench), halted(&mut bench)), (13, Some(13)));
    bench.key_with(Modifiers::SHIFT, Key::F11);
    assert_eq!(line(&mut bench), 8);
    bench.key_with(Modifiers::COMMAND, Key::F5);
    until(&mut bench, "it runs", |bench| bench.model().front.debug.is_running());
    assert_eq!(halted(&mut bench), None);
    bench.key_with(Modifiers::COMMAND, Key::F6);
    until(&mut bench, "it pauses", |bench| bench.model().front.debug.is_paused());
    let marks = bench.model().front.graph.live.track.marks.clone();
    let words: Vec<String> =
        marks.iter().filter(|mark| mark.kind == MarkKind::Note).map(|mark| mark.text.clone()).collect();
    assert!(words.iter().any(|text| text.starts_with("script paused at line")), "{words:?}");
}

#[test]
fn the_caret_is_where_a_script_runs_to_and_where_a_breakpoint_is_set() {
    let mut bench = paused(PROGRAM);
    bench.model().mcl.front_mut().go_to_line(8);
    bench.press("Run to cursor");
    assert_eq!(line(&mut bench), 9);
    assert!(bench.sees_part("Paused at line 9, which was to be run to."));
    bench.model().mcl.front_mut().go_to_line(6);
    bench.key_with(Modifiers::COMMAND, Key::F8);
    assert!(bench.sees("Line 7"));
    bench.key_with(Modifiers::COMMAND, Key::F10);
    assert_eq!(line(&mut bench), 7);
    assert!(bench.sees_part("Paused at the breakpoint on line 7, reached for the first time."));
}

#[test]
fn breakpoints_are_listed_switched_off_conditioned_and_removed() {
    let mut bench = bench(PROGRAM);
    for line in [4, 7] {
        bench.model().mcl.front_mut().breakpoints.toggle(line);
    }
    bench.pass_ms(200);
    let condition = "Condition of breakpoint at line 8";
    bench.see(condition).focus();
    bench.pass_ms(100);
    bench.see(condition).type_text("rounds = 3 and word1 > 5");
    bench.pass_ms(200);
    bench.press("Line 5");
    start(&mut bench);
    until(&mut bench, "its condition comes true", |bench| bench.model().front.debug.is_paused());
    assert!(bench.sees_part(
        "Paused at the breakpoint on line 8 (rounds = 3 and word1 > 5), reached for the first time."
    ));
    assert!(bench.sees_part("at line 6"), "the one without code has moved");
    bench.press("Remove breakpoint at line 8");
    bench.press("Continue");
    bench.pass_ms(300);
    assert!(bench.model().front.debug.is_running());
    bench.press("Line 5");
    until(&mut bench, "the other one stops it", |bench| bench.model().front.debug.is_paused());
    assert_eq!(line(&mut bench), 6);
    bench.press("Clear all");
    bench.pass_ms(200);
    assert!(bench.model().mcl.front().breakpoints.is_empty());
    assert!(bench.sees_part("Click left of a line number"));
}

#[test]
fn a_condition_that_is_none_says_so() {
    let mut bench = paused(PROGRAM);
    bench.model().mcl.front_mut().breakpoints.toggle(5);
    bench.pass_ms(200);
    let condition = "Condition of breakpoint at line 6";
    bench.see(condition).focus();
    bench.pass_ms(100);
    bench.see(condition).type_text("rouds > 3");
    bench.pass_ms(300);
    assert!(bench.sees_part("`rouds` is not defined. Did you mean"), "{:?}", bench.model().front.debug.view);
}

#[test]
fn variables_show_their_values_and_what_has_changed() {
    let mut bench = paused(PROGRAM);
    assert!(bench.sees("rounds is 0"));
    bench.press("Step over");
    bench.press("Step over");
    bench.pass_ms(200);
    assert!(bench.sees("rounds is 1, changed"));
    bench.press("Step over");
    bench.pass_ms(200);
    assert!(bench.sees("word1 is 2, changed") && bench.sees("rounds is 1"));
    bench.choose("Number form", "Hex");
    assert!(bench.sees("word1 is 0x0002, changed"));
    bench.press("name, 4 × Byte");
    bench.pass_ms(500);
    assert!(bench.sees("name(3) is 0x00"));
}

#[test]
fn registers_are_shown_by_groups() {
    let mut bench = paused("main\nMOTORMAXCURRENT(0) = SYSTICK\npause 10\ngoto main\n");
    bench.press("Used by this program");
    bench.pass_ms(600);
    assert!(bench.sees_part("SYSTICK is ") && bench.sees_part("MOTORMAXCURRENT(1) is "));
    bench.press("Used by this program");
    bench.pass_ms(600);
    bench.press("Motors");
    bench.pass_ms(600);
    assert!(bench.sees_part("MOTORFLAGS(1) is "));
}

#[test]
fn a_watch_follows_an_expression_and_can_be_taken_away() {
    let mut bench = paused(PROGRAM);
    bench.enter("Add watch", "rounds * 10 + name(rounds)");
    bench.pass_ms(300);
    assert!(bench.sees("rounds * 10 + name(rounds) =") && bench.sees("0"));
    bench.press("Step over");
    bench.press("Step over");
    bench.pass_ms(300);
    assert!(bench.sees("10"));
    bench.enter("Add watch", "nothing");
    bench.pass_ms(300);
    assert!(bench.sees_part("`nothing` is not defined"));
    bench.press("Remove watch nothing");
    bench.press("Remove watch rounds * 10 + name(rounds)");
    assert!(bench.model().front.debug.watches.is_empty());
}

#[test]
fn a_variable_and_a_register_are_set_while_the_script_is_paused() {
    let mut bench = paused(PROGRAM);
    bench.enter("Variable or register to set", "rounds");
    bench.enter("New value", "41");
    bench.pass_ms(300);
    assert!(bench.sees("rounds is 41 now."));
    bench.press("Step over");
    bench.press("Step over");
    bench.pass_ms(300);
    assert!(bench.sees_part("rounds is 42"));
    bench.press("word1 is 0");
    assert_eq!(bench.model().front.debug.set_place, "word1");
    bench.model().front.debug.set_value = "70000".to_owned();
    bench.press("Set");
    bench.pass_ms(300);
    assert!(bench.sees("70000 does not fit `word1`, a Word: it goes from 0 to 65535."));
    bench.model().front.debug.set_place = "SYSMINMBAT".to_owned();
    bench.model().front.debug.set_value = "110".to_owned();
    bench.press("Set");
    bench.pass_ms(300);
    assert!(bench.sees("SYSMINMBAT is 110 now."));
    bench.press("Continue");
    bench.press("Set");
    bench.pass_ms(300);
    assert!(bench.sees_part("cannot be set while the script runs: pause it first."));
}

#[test]
fn the_call_stack_tells_arguments_and_leads_to_their_lines() {
    let mut bench = paused(PROGRAM);
    bench.model().mcl.front_mut().breakpoints.toggle(13);
    bench.press("Continue");
    until(&mut bench, "it is in the subroutine", |bench| bench.model().front.debug.is_paused());
    bench.pass_ms(200);
    assert!(bench.sees("double a = 1: line 14"));
    bench.press("main program: line 7");
    assert_eq!(bench.model().mcl.front().caret_line(), 6);
}

#[test]
fn counts_stand_beside_the_lines_and_can_begin_anew() {
    let mut bench = paused(PROGRAM);
    bench.press("Counts");
    bench.press("Continue");
    bench.pass_ms(1_000);
    let counts = bench.model().mcl.front().run.counts.clone();
    assert!(counts[3] == 1 && counts[5] > 20 && counts[13] + 1 >= counts[5], "{counts:?}");
    bench.press("Pause");
    bench.pass_ms(300);
    bench.press("Clear counts");
    bench.pass_ms(300);
    assert!(bench.model().mcl.front().run.counts.iter().all(|count| *count == 0));
}

#[test]
fn the_terminal_shows_what_was_sent_and_takes_what_gets_waits_for() {
    let mut bench =
        bench("v var long\nputs 0,[\"hello\",13]\ngets 2,[dec v]\nputs 2,[\"got \",dec v,13]\nend\n");
    start(&mut bench);
    until(&mut bench, "it listens", |bench| bench.sees_part("GETS at line 3 waits for a byte on stream 2"));
    bench.press("Terminal");
    until(&mut bench, "the output is shown", |bench| bench.sees("Script output: hello\n"));
    bench.choose("To stream", "2");
    bench.enter("Input for the script", "123");
    bench.pass_ms(500);
    assert!(bench.sees("Script output: hello\ngot 123\n"));
    bench.choose("Shows", "stream 2");
    assert!(bench.sees("Script output: got 123\n"));
    bench.press("Output in hex");
    bench.pass_ms(100);
    assert!(bench.sees_part("67 6f 74 20 31 32 33 0d"));
    bench.press("Hex");
    bench.enter("Input for the script", "4x");
    bench.pass_ms(100);
    assert!(bench.sees_part("is not bytes in hex"));
    bench.choose("Line end", "CR LF");
    bench.press("Clear terminal");
    assert!(bench.sees("Script output: "));
}

#[test]
fn a_frozen_world_holds_motors_and_readings_and_the_link_stays() {
    let mut bench = bench(PROGRAM);
    bench.press("Freeze world too");
    bench.model().mcl.front_mut().breakpoints.toggle(8);
    start(&mut bench);
    until(&mut bench, "it stops", |bench| bench.model().front.debug.is_paused());
    assert!(bench.sees("The world stands still."));
    let at = bench.truth().axes;
    bench.pass_ms(5_000);
    assert_eq!(bench.truth().axes, at);
    assert!(bench.model().is_connected(), "the link is answered");
    bench.press("Freeze world too");
    bench.pass_ms(300);
    assert!(bench.truth().axes[0].truth.motor_radians > at[0].truth.motor_radians + 0.5);
    assert!(bench.sees("The motors go on as they were told."));
}

#[test]
fn a_frozen_world_is_not_left_behind_on_other_screens() {
    let mut bench = bench("main\npower 0,8192,0\npause 10\ngoto main\n");
    bench.press("Freeze world too");
    bench.model().mcl.front_mut().breakpoints.toggle(1);
    bench.pass_ms(300);
    // Command 248 by somebody else, as autorun or a pin would start it: this window is not armed.
    let mut start = vec![0x80, 248];
    start.extend(brushwork_mcp_wire::crc::crc16_xmodem(&start).to_be_bytes());
    bench.line.with(|bus| {
        bus.receive(StreamIndex::Uart0, &start);
        bus.advance(bus.now() + Duration::from_millis(2));
        assert_eq!(bus.take_output(StreamIndex::Uart0), Some(vec![0xFF]));
    });
    until(&mut bench, "it stops", |bench| bench.model().front.debug.is_paused());
    let at = bench.line.with(|bus| bus.controllers_mut()[0].debug(Vec::new(), &Wanted::default()).now);
    bench.press("PWM Settings");
    bench.pass_ms(1_000);
    let now = bench.line.with(|bus| bus.controllers_mut()[0].debug(Vec::new(), &Wanted::default()).now);
    assert!(now > at + Duration::from_millis(900), "{now:?} after {at:?}");
    bench.press("MCL Editor");
    bench.pass_ms(300);
    assert!(bench.model().front.debug.is_paused() && bench.sees("The world stands still."));
}

#[test]
fn the_pace_of_time_is_chosen_and_marked_in_the_graph() {
    let mut bench = paused(PROGRAM);
    bench.choose("Time", "×10");
    bench.pass_ms(100);
    assert_eq!(bench.model().front.debug.pace, Some(brushwork_plant::server::Pace::TEN));
    let marks = bench.model().front.graph.live.track.marks.clone();
    assert!(marks.iter().any(|mark| mark.text == "time ×10"));
}

#[test]
fn another_text_than_the_one_that_runs_is_told_and_values_come_back_with_it() {
    let mut bench = paused(PROGRAM);
    bench.model().mcl.open_new("end\n");
    bench.pass_ms(300);
    assert!(bench.sees("rounds is 0"), "the text that runs is still open");
    let other = bench_with("main\npause 10\ngoto main\n", Bench::new());
    let mut other = other;
    other.model().mcl.front_mut().edit(
        brushwork_gui::mcl::buffer::Kind::Typing,
        [(0..0, "x var byte\nx = 1\n".to_owned())],
        |_| brushwork_gui::mcl::caret::Caret::default(),
    );
    start(&mut other);
    until(&mut other, "it runs", |bench| bench.model().front.debug.is_running());
    until(&mut other, "it is told", |bench| {
        bench.sees_part("not the text in front: open its text, or download this one (F5).")
    });
}

#[test]
fn a_fault_is_shown_in_red_at_its_line() {
    let mut bench = bench("d var byte\nputs 0,[dec 1/d]\nend\n");
    start(&mut bench);
    until(&mut bench, "it fails", |bench| {
        bench.sees_part("The script has failed at line 2: a division by zero.")
    });
    until(&mut bench, "its line is marked", |bench| halted(bench) == Some(2));
}

#[test]
fn every_button_of_the_debugger_has_its_place_in_the_menu() {
    let bench = paused(PROGRAM);
    let mut bench = bench;
    bench.press("Debug");
    for title in [
        "Run or Continue",
        "Pause Script",
        "Step Into",
        "Step Over",
        "Step Out",
        "Run to Cursor",
        "Set or Remove Breakpoint",
        "Remove All Breakpoints",
    ] {
        let items = bench.harness.get_all_by_label(title);
        assert!(items.into_iter().any(|node| node.accesskit_node().role() == Role::MenuItem), "{title}");
    }
}
