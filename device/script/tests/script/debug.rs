//! The debugger in front of small programs: where it stops, what it shows, what it lets change.

use crate::support::TestHost;
use brushwork_script::debug::{
    Breakpoint, Debugger, Reason, Request, Show, StepKind, StopCause, View, Wanted, code_id,
};
use brushwork_script::mcl::{Names, words};
use brushwork_script::vm::{Machine, State};
use std::sync::Arc;
use std::time::Duration;

/// A script under a debugger.
struct Bench {
    names: Names,
    machine: Machine,
    host: TestHost,
    debugger: Debugger,
    wanted: Wanted,
}

impl Bench {
    /// A program that is about to run its first line.
    fn new(text: &str) -> Self {
        let names = Names::of(text).expect("the program compiles");
        let machine = Machine::new(names.program().clone());
        let wanted = Wanted { code: code_id(names.program()), ..Wanted::default() };
        let mut bench =
            Self { names, machine, host: TestHost::default(), debugger: Debugger::default(), wanted };
        bench.ask(Request::Attach(true));
        bench.ask(Request::StopAtEntry(true));
        bench.debugger.started(&bench.machine);
        bench
    }

    fn ask(&mut self, request: Request) {
        self.debugger.ask(request, Some(&mut self.machine), &mut self.host);
    }

    /// Runs until it stands or 10,000 instructions are through; pauses are jumped over.
    fn go(&mut self, request: Request) -> View {
        self.ask(request);
        for _ in 0..100 {
            let state = self.debugger.run(&mut self.machine, &mut self.host, 100).clone();
            if let State::Pausing { until } = state
                && !self.debugger.is_paused()
            {
                self.host.now = until;
            }
        }
        self.view()
    }

    fn step(&mut self, kind: StepKind) -> u32 {
        self.go(Request::Step(kind)).line
    }

    fn view(&mut self) -> View {
        self.debugger.view(Some(&mut self.machine), &mut self.host, &self.wanted)
    }

    fn watch(&mut self, text: &str) -> String {
        self.wanted.watches = Arc::new(vec![self.names.watch(text)]);
        match self.view().watches.remove(0) {
            Ok(value) => value.text(Show::Decimal),
            Err(why) => why,
        }
    }

    fn set(&mut self, place: &str, value: &str) -> Result<String, String> {
        let setting = self.names.setting(place, value)?;
        self.ask(Request::Set { id: 7, setting });
        let (id, answer) = self.view().answer.expect("an answer");
        assert_eq!(id, 7);
        answer
    }

    fn breakpoints(&mut self, lines: &[u32]) {
        self.ask(Request::Breakpoints(lines.iter().map(|line| Breakpoint::at(*line)).collect()));
    }
}

/// Lines are counted from 1, here beside each.
const CALLS: &str = "\
i var byte
total var long

for i = 1 to 3
gosub add[total,i],total
puts 0,[dec total,13]
next
end

a var long
b var byte
add [a,b]
gosub nothing
return a+b
nothing
return
";

#[test]
fn a_script_stops_before_its_first_line_with_code() {
    let mut bench = Bench::new(CALLS);
    let view = bench.view();
    assert_eq!((view.line, view.is_paused, view.executed), (4, true, 0));
    assert_eq!(view.sentence(), "Paused before the first line that does something, line 4.");
}

#[test]
fn stepping_into_goes_through_subroutines_line_by_line() {
    let mut bench = Bench::new(CALLS);
    let lines: Vec<u32> = (0..8).map(|_| bench.step(StepKind::Into)).collect();
    // FOR, GOSUB, the label takes its arguments, GOSUB, RETURN, RETURN, PUTS, NEXT.
    assert_eq!(lines, [5, 12, 13, 16, 14, 6, 7, 5]);
    assert_eq!(bench.view().sentence(), "Paused at line 5: one line was run.");
}

#[test]
fn stepping_over_runs_a_subroutine_and_stepping_out_leaves_it() {
    let mut bench = Bench::new(CALLS);
    assert_eq!(bench.step(StepKind::Over), 5);
    assert_eq!(bench.step(StepKind::Over), 6);
    bench.breakpoints(&[16]);
    assert_eq!(bench.go(Request::Continue).line, 16);
    assert_eq!(bench.step(StepKind::Out), 14);
    assert_eq!(bench.step(StepKind::Out), 6);
    assert_eq!(bench.view().reason, Reason::Step(StepKind::Out));
}

#[test]
fn the_call_stack_tells_what_each_subroutine_was_given() {
    let mut bench = Bench::new(CALLS);
    bench.breakpoints(&[16]);
    bench.go(Request::Continue);
    bench.go(Request::Continue);
    let view = bench.view();
    assert_eq!(view.frames.iter().map(|frame| frame.line).collect::<Vec<_>>(), [16, 13, 5]);
    let arguments = view.frames[1].arguments.as_ref().unwrap();
    // The second round: total is 1, i is 2.
    assert_eq!(arguments.iter().map(|argument| argument.value).collect::<Vec<_>>(), [1, 2]);
    let named: Vec<&str> = arguments
        .iter()
        .filter_map(|argument| {
            let variables = &bench.machine.program().variables;
            variables.iter().find(|one| Some(one.memory.first) == argument.cell).map(|one| one.name.as_str())
        })
        .collect();
    assert_eq!(named, ["a", "b"]);
}

#[test]
fn a_breakpoint_moves_to_the_next_line_with_code_and_counts() {
    let mut bench = Bench::new(CALLS);
    bench.breakpoints(&[9]);
    assert_eq!(bench.view().breakpoints[0].line, Some(12));
    let view = bench.go(Request::Continue);
    assert_eq!(view.sentence(), "Paused at the breakpoint on line 12, reached for the first time.");
    bench.go(Request::Continue);
    let view = bench.go(Request::Continue);
    assert_eq!(view.sentence(), "Paused at the breakpoint on line 12, reached 3 times.");
    let view = bench.go(Request::Continue);
    assert_eq!(view.sentence(), "The script has ended: END was reached at line 8.");
    bench.breakpoints(&[40]);
    assert_eq!(bench.view().breakpoints[0].line, None);
}

#[test]
fn a_breakpoint_can_wait_for_a_condition_or_a_time() {
    let mut bench = Bench::new(CALLS);
    let condition = Some(bench.names.watch("i = 2 and total > 0").unwrap());
    bench.ask(Request::Breakpoints(vec![Breakpoint { condition, ..Breakpoint::at(6) }]));
    let view = bench.go(Request::Continue);
    assert_eq!(
        view.sentence(),
        "Paused at the breakpoint on line 6 (i = 2 and total > 0), reached for the first time."
    );
    assert_eq!(bench.watch("i"), "2");

    let mut bench = Bench::new(CALLS);
    bench.ask(Request::Breakpoints(vec![Breakpoint { from_hit: 3, ..Breakpoint::at(6) }]));
    bench.go(Request::Continue);
    assert_eq!(bench.watch("i"), "3");

    let mut bench = Bench::new(CALLS);
    let condition = Some(bench.names.watch("1/(i-1)").unwrap());
    bench.ask(Request::Breakpoints(vec![Breakpoint { condition, ..Breakpoint::at(6) }]));
    let view = bench.go(Request::Continue);
    assert!(view.sentence().contains("cannot be worked out") && view.sentence().contains("division by zero"));
    let off = Breakpoint { enabled: false, ..Breakpoint::at(6) };
    bench.ask(Request::Breakpoints(vec![off]));
    assert_eq!(bench.go(Request::Continue).reason, Reason::Ended);
}

#[test]
fn running_to_a_line_stops_there_once_and_breakpoints_on_the_way_count() {
    let mut bench = Bench::new(CALLS);
    let view = bench.go(Request::RunTo(7));
    assert_eq!((view.line, view.reason), (7, Reason::Cursor));
    bench.breakpoints(&[6]);
    assert!(matches!(bench.go(Request::RunTo(7)).reason, Reason::Breakpoint { line: 6, .. }));
}

#[test]
fn a_loop_of_one_line_is_stepped_round_by_round() {
    let mut bench = Bench::new("again\ngoto again\n");
    for _ in 0..3 {
        assert_eq!(bench.step(StepKind::Into), 2);
    }
    assert_eq!(bench.view().counts[2], 3);
    bench.ask(Request::Continue);
    bench.debugger.run(&mut bench.machine, &mut bench.host, 100);
    bench.ask(Request::Pause);
    bench.debugger.run(&mut bench.machine, &mut bench.host, 100);
    assert_eq!(bench.view().sentence(), "Paused at line 2, because Pause was asked for.");
}

#[test]
fn lines_are_counted_from_the_start_or_from_a_reset() {
    let mut bench = Bench::new(CALLS);
    let view = bench.go(Request::Continue);
    let counted: Vec<u64> = [4, 5, 6, 7, 8, 12, 13, 14, 16].map(|line| view.counts[line]).to_vec();
    assert_eq!(counted, [1, 3, 3, 3, 1, 3, 3, 3, 3]);
    bench.ask(Request::ClearCounts);
    assert!(bench.view().counts.iter().all(|count| *count == 0));
}

#[test]
fn a_pause_and_a_wait_for_input_say_what_they_wait_for() {
    let mut bench = Bench::new("v var byte\npause 500\ngets 2,[v]\nputs 0,[v]\nend\n");
    bench.breakpoints(&[3]);
    bench.host.now = Duration::from_millis(1000);
    bench.ask(Request::Continue);
    bench.debugger.run(&mut bench.machine, &mut bench.host, 10);
    bench.host.now = Duration::from_millis(1200);
    let view = bench.view();
    assert_eq!(view.sentence(), "The script runs: PAUSE at line 2 waits until 1.500 s, 0.300 s more.");
    bench.ask(Request::Pause);
    let view = bench.view();
    assert!(view.is_paused);
    assert!(view.sentence().starts_with("Paused because Pause was asked for: PAUSE at line 2"));
    // The world went on: the time of the pause is over, and the line after it has its breakpoint.
    bench.host.now = Duration::from_millis(3000);
    assert!(matches!(bench.go(Request::Continue).reason, Reason::Breakpoint { line: 3, .. }));
    let view = bench.go(Request::Continue);
    assert_eq!(view.sentence(), "The script runs: GETS at line 3 waits for a byte on stream 2.");
    assert_eq!(view.counts[3], 1, "waiting is no running");
    let view = bench.go(Request::Give { stream: 2, bytes: b"Q".to_vec() });
    assert_eq!(view.reason, Reason::Ended);
    assert_eq!(bench.host.sent[&0], b"Q");
}

#[test]
fn the_terminal_keeps_what_each_stream_was_sent() {
    let mut bench = Bench::new("puts 0,[\"ab\"]\nputs 1,[\"c\"]\nputs 0,[\"d\"]\nend\n");
    let view = bench.go(Request::Continue);
    let chunks: Vec<_> = view.output.iter().map(|chunk| (chunk.stream, &chunk.bytes[..])).collect();
    assert_eq!(chunks, [(0, &b"ab"[..]), (1, b"c"), (0, b"d")]);
    bench.wanted.output_from = 3;
    assert_eq!(bench.view().output.len(), 1);
    bench.wanted.output_from = view.output_count;
    assert!(bench.view().output.is_empty());
}

const NAMES: &str = "\
half con 50
text var byte(4)
low var text(1).nib0
w var word
s var sbyte
f var float
first ByteTable 3,5,7
text = \"abcd\"
w = 0x1234
s = -3
f = 1.5
done
goto done
";

#[test]
fn whatever_the_program_could_say_can_be_watched() {
    let mut bench = Bench::new(NAMES);
    bench.go(Request::RunTo(13));
    for (expression, value) in [
        ("w", "4660"),
        ("W.highbyte", "18"),
        ("s", "-3"),
        ("f", "1.5"),
        ("f * 2.0", "3.0"),
        ("text", "[97, 98, 99, 100]"),
        ("text(w // 4)", "97"),
        ("low", "2"),
        ("first(1) + half", "55"),
        ("w dig 2", "6"),
        ("s < 0 and w > 5", "1"),
        ("MOTORENCPOS(1)", "0"),
    ] {
        assert_eq!(bench.watch(expression), value, "{expression}");
    }
    assert!(bench.watch("nothing").starts_with("`nothing` is not defined."));
    assert_eq!(bench.watch("w +"), "A value should stand here, but there is the end of the line.");
    assert!(bench.watch("text(w)").contains("outside"), "{}", bench.watch("text(w)"));
    assert!(bench.names.watch("").is_err() && bench.names.watch("w\nend").is_err());
}

#[test]
fn a_variable_is_set_while_the_script_stands_if_the_value_fits() {
    let mut bench = Bench::new(NAMES);
    bench.go(Request::RunTo(13));
    assert_eq!(bench.set("w", "65535"), Ok("w is 65535 now.".to_owned()));
    assert_eq!(bench.watch("w"), "65535");
    assert_eq!(
        bench.set("w", "65536"),
        Err("65536 does not fit `w`, a Word: it goes from 0 to 65535.".to_owned())
    );
    assert_eq!(bench.set("s", "-128"), Ok("s is -128 now.".to_owned()));
    assert_eq!(bench.set("s", "0xff"), Ok("s is -1 now.".to_owned()));
    assert_eq!(bench.set("w", "1.5"), Err("`w` is a Word and takes whole numbers, not 1.5.".to_owned()));
    assert_eq!(bench.set("f", "2"), Ok("f is 2.0 now.".to_owned()));
    assert_eq!(bench.set("text(1)", "\"x\""), Ok("text(1) is 120 now.".to_owned()));
    assert_eq!(bench.watch("text(1)"), "120");
    assert_eq!(bench.set("low", "15"), Ok("low is 15 now.".to_owned()));
    assert_eq!(bench.watch("text(1)"), "127");
    assert_eq!(bench.set("w.bit0", "0"), Ok("w.bit0 is 0 now.".to_owned()));
    assert!(bench.set("text(9)", "1").is_err());
    assert!(bench.set("text", "1").unwrap_err().contains("set one element"));
    assert!(bench.set("half", "1").unwrap_err().contains("constant"));
    assert!(bench.set("first(0)", "1").unwrap_err().contains("cannot be set"));
    assert_eq!(bench.set("SYSMINMBAT", "120"), Ok("SYSMINMBAT is 120 now.".to_owned()));
    let (id, _) = words::register("SYSMINMBAT").unwrap();
    assert_eq!(bench.host.registers[&(id.0, 0)], 120);
    assert_eq!(bench.set("SYSTICK", "1"), Err("SYSTICK can only be read.".to_owned()));
    let executed = bench.machine.executed();
    bench.ask(Request::Continue);
    bench.debugger.run(&mut bench.machine, &mut bench.host, 10);
    assert!(bench.set("w", "1").unwrap_err().contains("pause it first"));
    assert_eq!(bench.machine.executed(), executed + 10, "looking costs the program nothing");
}

#[test]
fn registers_are_read_with_all_their_elements() {
    let mut bench = Bench::new("done\ngoto done\n");
    let (id, _) = words::register("MOTORPWM").unwrap();
    bench.host.registers.insert((id.0, 1), 0xFFFF);
    bench.wanted.registers = Arc::new(vec![id]);
    let view = bench.view();
    assert_eq!(view.registers[0].cells, [0, u32::MAX], "signed words have their sign spread");
}

#[test]
fn faults_and_stops_from_outside_are_named() {
    let mut bench = Bench::new("d var byte\nputs 0,[dec 1/d]\nend\n");
    let view = bench.go(Request::Continue);
    assert_eq!(view.sentence(), "The script has failed at line 2: a division by zero.");
    assert!(!view.is_running);

    let mut bench = Bench::new("again\ngoto again\n");
    bench.debugger.stopped(StopCause::Command);
    assert!(bench.view().sentence().contains("command 249"));
    bench.debugger.stopped(StopCause::PinAction(Some(2)));
    assert!(bench.view().sentence().contains("input pin 3"));
    assert!(!bench.view().is_paused);
}

#[test]
fn the_world_is_held_only_while_paused_and_wished() {
    let mut bench = Bench::new("again\ngoto again\n");
    assert!(!bench.debugger.holds_world());
    bench.ask(Request::FreezeWorld(true));
    assert!(bench.debugger.holds_world());
    bench.ask(Request::Continue);
    assert!(!bench.debugger.holds_world());
    bench.ask(Request::Pause);
    bench.debugger.run(&mut bench.machine, &mut bench.host, 10);
    assert!(bench.debugger.holds_world());
    bench.ask(Request::Attach(false));
    assert!(!bench.debugger.holds_world(), "nobody is left to let it go on");
}

#[test]
fn a_debugger_that_comes_late_sees_the_script_that_runs() {
    let names = Names::of(CALLS).unwrap();
    let (mut machine, mut host) = (Machine::new(names.program().clone()), TestHost::default());
    let mut debugger = Debugger::default();
    debugger.started(&machine);
    debugger.run(&mut machine, &mut host, 12);
    debugger.ask(Request::Breakpoints(vec![Breakpoint::at(6)]), Some(&mut machine), &mut host);
    debugger.ask(Request::Attach(true), Some(&mut machine), &mut host);
    debugger.run(&mut machine, &mut host, 1_000);
    let view = debugger.view(Some(&mut machine), &mut host, &Wanted::default());
    assert!(matches!(view.reason, Reason::Breakpoint { line: 6, hits: 1, .. }), "{:?}", view.reason);
}
