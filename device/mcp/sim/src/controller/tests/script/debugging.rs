//! A script under the debugger inside the controller: what goes on while it is paused, and what stands still when that is asked for.

use super::super::support::Bench;
use super::{USB_TO_SCRIPTS, ms, start_bytes};
use brushwork_mcp_wire::packet_serial::{Generation, commands, name};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::ScriptRun;
use brushwork_plant::world::WorldAction;
use brushwork_script::debug::{Breakpoint, Reason, Request, StepKind, StopCause, View, Wanted};
use brushwork_values::Motor;

const DRIVER: &str = "\
rounds var long
power 0,16384,0
main
rounds = rounds+1
pause 10
goto main
";

/// A debugged script that was started over packet serial.
fn debugged(text: &str, requests: Vec<Request>) -> Bench {
    let mut bench = Bench::new(Generation::Gen2);
    bench.install(text);
    bench.wait(ms(10));
    ask(&mut bench, Request::Attach(true));
    requests.into_iter().for_each(|request| drop(ask(&mut bench, request)));
    bench.ask(commands::START_SCRIPT, &[]);
    bench
}

fn look(bench: &mut Bench) -> View {
    bench.bus.controllers_mut()[0].debug(Vec::new(), &Wanted::default())
}

fn ask(bench: &mut Bench, request: Request) -> View {
    bench.bus.controllers_mut()[0].debug(vec![request], &Wanted::default())
}

fn position(bench: &Bench) -> f64 {
    bench.unit().world().truth(Motor::M1).motor_radians
}

#[test]
fn a_paused_script_does_not_pause_the_world() {
    let mut bench = debugged(DRIVER, vec![Request::Breakpoints(vec![Breakpoint::at(4)])]);
    bench.wait_talking(ms(200));
    let view = look(&mut bench);
    assert!(view.is_paused && matches!(view.reason, Reason::Breakpoint { line: 4, hits: 1, .. }), "{view:?}");
    let before = position(&bench);
    bench.wait_talking(ms(200));
    assert!(position(&bench) > before + 1.0, "the motor goes on");
    assert_eq!(look(&mut bench).executed, view.executed, "the script does not");
    assert_eq!(bench.script(), ScriptRun::Running { line: 4 }, "for its controller it runs");
    assert!(bench.unit().view().script.is_some_and(|script| script.is_paused), "and panels are told");
}

#[test]
fn a_frozen_world_stands_in_mid_motion_and_answers_and_goes_on_where_it_stood() {
    let breakpoints = Request::Breakpoints(vec![Breakpoint { from_hit: 30, ..Breakpoint::at(4) }]);
    let mut bench = debugged(DRIVER, vec![breakpoints, Request::FreezeWorld(true)]);
    bench.wait_talking(ms(1_000));
    let view = look(&mut bench);
    assert!(view.is_paused && view.world_frozen, "{view:?}");
    let (at, status) = (position(&bench), bench.unit().view());
    // Longer than any time-out of the controller, with nobody talking.
    bench.wait(ms(20_000));
    assert_eq!(position(&bench), at);
    assert_eq!(bench.unit().view().axes, status.axes);
    assert_eq!(look(&mut bench).now, view.now, "its clock stands too");
    let battery = bench.read(commands::READ_MAIN_BATTERY, name::MAIN_BATTERY);
    assert!(battery > 100, "it answers: {battery}");
    ask(&mut bench, Request::Breakpoints(Vec::new()));
    ask(&mut bench, Request::Continue);
    bench.wait_talking(ms(100));
    assert!(position(&bench) > at + 0.5, "it goes on");
    let now = look(&mut bench).now;
    assert!(now > view.now + ms(90) && now < view.now + ms(200), "{now:?} after {:?}", view.now);
}

#[test]
fn the_motor_of_a_paused_script_goes_on_even_if_no_client_says_a_word() {
    let mut bench = debugged(DRIVER, vec![Request::Breakpoints(vec![Breakpoint::at(4)])]);
    bench.wait(ms(3_000));
    let (before, paused) = (position(&bench), look(&mut bench).is_paused);
    bench.wait(ms(200));
    assert!(paused && position(&bench) > before + 0.5, "no time-out is for it");
}

#[test]
fn stopping_a_paused_script_lets_the_world_go_on_and_says_so() {
    let breakpoints = Request::Breakpoints(vec![Breakpoint::at(4)]);
    let mut bench = debugged(DRIVER, vec![breakpoints, Request::FreezeWorld(true)]);
    bench.wait(ms(100));
    assert!(look(&mut bench).world_frozen);
    bench.ask(commands::STOP_SCRIPT, &[]);
    let view = look(&mut bench);
    assert_eq!(view.reason, Reason::Stopped(StopCause::Command));
    assert!(!view.is_paused && !view.is_running && !view.world_frozen);
    let at = look(&mut bench).now;
    bench.wait(ms(100));
    assert_eq!(look(&mut bench).now, at + ms(100));
    bench.ask(commands::START_SCRIPT, &[]);
    bench.wait(ms(20));
    assert!(
        matches!(look(&mut bench).reason, Reason::Breakpoint { hits: 1, .. }),
        "hits count from the start"
    );
}

#[test]
fn a_debugged_script_sends_the_same_at_the_same_times_as_a_free_one() {
    let program = "main\nputs 0,[dec SYSUSTICK,32]\npause 3\nif SYSTICK < 200 then main\nend\n";
    let said = |attach: bool| {
        let mut bench = Bench::new(Generation::Gen2);
        bench.install(program);
        bench.wait(ms(10));
        if attach {
            ask(&mut bench, Request::Attach(true));
        }
        bench.ask(commands::SET_STREAM, &USB_TO_SCRIPTS);
        bench.bus.receive(StreamIndex::Uart0, &start_bytes());
        bench.wait(ms(300));
        (bench.said(StreamIndex::Usb), look(&mut bench).executed)
    };
    let (free, debugged) = (said(false), said(true));
    assert!(free.0.len() > 100);
    assert_eq!(free, debugged);
}

#[test]
fn bytes_that_are_typed_in_the_debugger_wake_a_script_that_listens() {
    let mut bench = debugged("v var long\ngets 3,[dec v]\nputs 0,[dec v*2]\nend\n", Vec::new());
    bench.wait(ms(50));
    assert_eq!(look(&mut bench).sentence(), "The script runs: GETS at line 2 waits for a byte on stream 3.");
    ask(&mut bench, Request::Give { stream: 3, bytes: b"21\r".to_vec() });
    bench.wait(ms(50));
    let view = look(&mut bench);
    assert_eq!((view.reason, &view.output[0].bytes[..]), (Reason::Ended, &b"42"[..]));
}

#[test]
fn steps_lead_through_a_pause_in_the_controllers_time() {
    let mut bench = debugged(DRIVER, vec![Request::StopAtEntry(true)]);
    let mut lines = Vec::new();
    for _ in 0..5 {
        bench.wait(ms(20));
        lines.push(look(&mut bench).line);
        ask(&mut bench, Request::Step(StepKind::Over));
    }
    // The label has no code; the pause takes its 10 ms.
    assert_eq!(lines, [2, 4, 5, 6, 4]);
}

#[test]
fn breakpoints_outlive_a_power_cycle_and_the_loss_is_named() {
    let mut bench = debugged(DRIVER, vec![Request::Breakpoints(vec![Breakpoint::at(4)])]);
    bench.wait(ms(50));
    bench.apply(&WorldAction::Power { on: false });
    bench.wait(ms(50));
    let view = look(&mut bench);
    assert_eq!((view.reason, view.code), (Reason::Stopped(StopCause::PowerLost), 0));
    bench.apply(&WorldAction::Power { on: true });
    bench.wait(ms(50));
    bench.ask(commands::START_SCRIPT, &[]);
    bench.wait(ms(50));
    assert!(matches!(look(&mut bench).reason, Reason::Breakpoint { line: 4, .. }));
}

#[test]
fn a_new_image_ends_a_paused_script() {
    let mut bench = debugged(DRIVER, vec![Request::Breakpoints(vec![Breakpoint::at(4)])]);
    bench.wait(ms(50));
    bench.install("end\n");
    let view = look(&mut bench);
    assert_eq!((view.reason, view.is_paused), (Reason::Stopped(StopCause::NewImage), false));
    bench.ask(commands::START_SCRIPT, &[]);
    bench.wait(ms(50));
    assert_eq!(look(&mut bench).reason, Reason::Ended);
}

#[test]
fn a_machine_that_hurries_wants_real_time_where_a_debugged_script_stands_or_has_ended() {
    let mut bench =
        debugged(DRIVER, vec![Request::Breakpoints(vec![Breakpoint { from_hit: 5, ..Breakpoint::at(4) }])]);
    assert!(!bench.bus.wants_real_time());
    bench.wait(ms(500));
    assert!(bench.bus.wants_real_time());
    ask(&mut bench, Request::Continue);
    ask(&mut bench, Request::Breakpoints(Vec::new()));
    assert!(!bench.bus.wants_real_time());
    bench.ask(commands::STOP_SCRIPT, &[]);
    assert!(bench.bus.wants_real_time());
    ask(&mut bench, Request::Attach(false));
    assert!(!bench.bus.wants_real_time(), "nobody looks");
}
