//! Events, waits and pointers of the machine, in programs of a few instructions.

use crate::support::TestHost;
use brushwork_script::arithmetic::Type;
use brushwork_script::board::Board;
use brushwork_script::debug::{Debugger, Reason, Request, StepKind};
use brushwork_script::image::{self, ImageError};
use brushwork_script::mcl::ast::Binary;
use brushwork_script::mcl::types::VarType;
use brushwork_script::op::{Cell, Op};
use brushwork_script::program::{Program, limits};
use brushwork_script::vm::{FaultKind, Machine, State};
use std::sync::Arc;
use std::time::Duration;

const A: Cell = Cell { kind: VarType::Byte, at: 0 };
const B: Cell = Cell { kind: VarType::Byte, at: 8 };

fn add_to(cell: Cell, value: u32) -> [Op; 4] {
    [Op::Load(cell), Op::Push(value), Op::Binary(Binary::Add, Type::Unsigned), Op::Store(cell)]
}

/// Sixteen bytes of variables, an instruction to a line.
fn program(ops: impl IntoIterator<Item = Op>) -> Program {
    let ops: Vec<Op> = ops.into_iter().collect();
    let lines = (1..=ops.len() as u32).collect();
    Program { ops, lines, ram_bytes: 16, data: b"TX123456".to_vec(), ..Program::default() }
}

fn machine(ops: impl IntoIterator<Item = Op>) -> Machine {
    let program = program(ops);
    assert_eq!(image::decode(&image::encode(&program)).as_ref(), Ok(&program));
    Machine::new(Arc::new(program))
}

/// Handlers of events 1 and 2 at 10 and 15, which count in A and B; from 4 on the program does nothing.
fn two_handlers() -> Vec<Op> {
    let mut ops = vec![Op::Handle(2, 15), Op::Handle(1, 10), Op::Events(true), Op::Nop, Op::Nop];
    ops.extend([Op::Jump(4), Op::Nop, Op::Nop, Op::Nop, Op::Nop]);
    ops.extend(add_to(A, 1));
    ops.push(Op::Return(None));
    ops.extend([Op::Push(128), Op::Wait(128)]);
    ops.extend(add_to(B, 1));
    ops.push(Op::Return(None));
    ops
}

fn counts(machine: &Machine) -> [u32; 2] {
    [machine.memory().load(A), machine.memory().load(B)]
}

#[test]
fn an_event_calls_its_handler_once_before_the_next_instruction() {
    let (mut machine, mut host) = (machine(two_handlers()), TestHost::default());
    machine.run(&mut host, 4);
    let at = machine.at();
    machine.raise(1);
    machine.raise(1);
    machine.run(&mut host, 1);
    assert!(machine.is_in_handler());
    assert_eq!(machine.at(), 11);
    machine.run(&mut host, 4);
    assert_eq!((machine.at(), counts(&machine)), (at, [1, 0]));
    machine.run(&mut host, 100);
    assert_eq!(counts(&machine), [1, 0]);
}

#[test]
fn of_two_events_the_lower_number_comes_first_and_handlers_do_not_nest() {
    let (mut machine, mut host) = (machine(two_handlers()), TestHost::default());
    machine.run(&mut host, 4);
    machine.raise(2);
    machine.run(&mut host, 2);
    // It waits inside the handler of event 2: event 1 has to wait too.
    assert_eq!(machine.state(), &State::Pausing { until: Duration::from_secs(1) });
    machine.raise(1);
    machine.raise(2);
    machine.run(&mut host, 100);
    assert_eq!(counts(&machine), [0, 0]);
    host.now = Duration::from_secs(1);
    machine.run(&mut host, 5);
    assert_eq!((counts(&machine), machine.at()), ([0, 1], 10));
    machine.run(&mut host, 5);
    assert_eq!((counts(&machine), machine.at()), ([1, 1], 15));
}

#[test]
fn an_event_without_handler_is_lost_and_one_that_is_not_let_in_is_kept() {
    let mut ops = two_handlers();
    ops[2] = Op::Nop;
    ops[6] = Op::Events(true);
    let (mut machine, mut host) = (machine(ops), TestHost::default());
    machine.raise(1);
    machine.run(&mut host, 3);
    machine.raise(1);
    machine.run(&mut host, 50);
    assert_eq!(counts(&machine), [0, 0]);
    // A machine whose events are let in only later runs the handler then.
    let mut ops = two_handlers();
    (ops[2], ops[3], ops[4]) = (Op::Nop, Op::Nop, Op::Events(true));
    let mut machine = Machine::new(Arc::new(program(ops)));
    machine.run(&mut host, 3);
    machine.raise(1);
    machine.run(&mut host, 2);
    assert_eq!(machine.at(), 10);
}

#[test]
fn a_handler_leaves_the_stack_and_the_last_result_as_they_were() {
    // The program takes the result of a subroutine after an event whose handler calls another.
    let ops = [
        Op::Handle(0, 7),
        Op::Events(true),
        Op::Push(9),
        Op::Gosub(10, 0),
        Op::Result(Type::Unsigned),
        Op::Store(A),
        Op::End,
        Op::Gosub(12, 0),
        Op::Drop,
        Op::Return(None),
        Op::Push(5),
        Op::Return(Some(Type::Unsigned)),
        Op::Push(6),
        Op::Return(Some(Type::Unsigned)),
    ];
    let mut ops = ops.to_vec();
    ops[8] = Op::Result(Type::Unsigned);
    let (mut machine, mut host) = (machine(ops), TestHost::default());
    machine.run(&mut host, 6);
    machine.raise(0);
    assert_eq!(machine.run(&mut host, 100), &State::Ended);
    assert_eq!(machine.memory().load(A), 5);
}

#[test]
fn a_wait_of_ticks_ends_to_the_nanosecond() {
    let (mut machine, mut host) = (machine([Op::Push(500), Op::Wait(128), Op::End]), TestHost::default());
    assert_eq!(machine.run(&mut host, 10), &State::Pausing { until: Duration::from_nanos(3_906_250_000) });
    // One that begins between two ticks ends with a tick too, so that loops keep in step with the clock.
    let mut later = self::machine([Op::Push(1), Op::Wait(128), Op::End]);
    host.now = Duration::from_millis(10);
    assert_eq!(later.run(&mut host, 10), &State::Pausing { until: Duration::from_nanos(15_625_000) });
}

#[test]
fn pointers_run_across_variables_and_not_out_of_memory() {
    let mut ops = vec![Op::Fill(0, 0, 8), Op::Push(3), Op::LoadByte, Op::Store(B)];
    ops.extend([Op::Push(0), Op::Send(8), Op::Push(8), Op::Receive(8), Op::Push(9), Op::Send(8), Op::End]);
    let (mut machine, mut host) = (machine(ops), TestHost::default());
    host.received = vec![1, 2, 3];
    machine.run(&mut host, 100);
    assert_eq!(host.frames, [b"T2123456"]);
    assert_eq!(machine.memory().bytes()[8..], [1, 2, 3, 0, 0, 0, 0, 0]);
    let State::Faulted(fault) = machine.state() else { panic!("{:?}", machine.state()) };
    assert_eq!((fault.line, fault.kind), (10, FaultKind::OutsideMemory { address: 16, bytes: 16 }));
}

#[test]
fn a_subroutine_puts_back_the_memory_that_it_keeps() {
    // Factorial of 5 with its argument in memory: A is what it is given, B the result.
    let ops = [
        Op::Push(5),
        Op::Gosub(4, 1),
        Op::Result(Type::Unsigned),
        Op::End,
        Op::Keep(0, 1),
        Op::Store(A),
        Op::Load(A),
        Op::JumpIfZero(15),
        Op::Load(A),
        Op::Push(1),
        Op::Binary(Binary::Subtract, Type::Unsigned),
        Op::Gosub(4, 1),
        Op::Result(Type::Unsigned),
        Op::Load(A),
        Op::Jump(17),
        Op::Push(1),
        Op::Return(Some(Type::Unsigned)),
        Op::Binary(Binary::Multiply, Type::Unsigned),
        Op::Return(Some(Type::Unsigned)),
    ];
    let mut all = ops.to_vec();
    all[3] = Op::Store(B);
    all.insert(4, Op::End);
    let moved = |op: Op| match op {
        Op::Gosub(to, count) => Op::Gosub(to + 1, count),
        Op::Jump(to) => Op::Jump(to + 1),
        Op::JumpIfZero(to) => Op::JumpIfZero(to + 1),
        other => other,
    };
    let (mut machine, mut host) = (machine(all.into_iter().map(moved)), TestHost::default());
    assert_eq!(machine.run(&mut host, 1_000), &State::Ended);
    assert_eq!(counts(&machine), [0, 120]);
}

#[test]
fn commands_of_the_board_are_handed_over_with_their_arguments() {
    for command in Board::ALL {
        let count = command.arguments();
        let mut ops: Vec<Op> = (1..=count as u32).map(Op::Push).collect();
        ops.extend([Op::Board(command), Op::Store(A), Op::End]);
        let (mut machine, mut host) = (machine(ops), TestHost::default());
        let ended = machine.run(&mut host, 100) == &State::Ended;
        // What gives nothing leaves nothing to store.
        assert_eq!(ended, command.gives(), "{command:?}");
        assert_eq!(host.board, [(Duration::ZERO, command, (1..=count as u32).collect())]);
        assert_eq!(counts(&machine)[0], if ended { 42 } else { 0 });
    }
}

#[test]
fn images_whose_instructions_reach_outside_are_refused() {
    for op in [
        Op::Handle(limits::EVENTS, 0),
        Op::Handle(0, 2),
        Op::Wait(0),
        Op::Send(257),
        Op::Receive(257),
        Op::Fill(9, 0, 8),
        Op::Fill(0, 1, 8),
        Op::Keep(16, 1),
    ] {
        let refused = image::decode(&image::encode(&program([op, Op::End])));
        assert!(matches!(refused, Err(ImageError::Malformed(_))), "{op:?}: {refused:?}");
    }
}

#[test]
fn what_subroutines_keep_is_bounded() {
    let program = Program { ram_bytes: 32 * 1024, ..program([Op::Keep(0, 32 * 1024), Op::Gosub(0, 0)]) };
    let (mut machine, mut host) = (Machine::new(Arc::new(program)), TestHost::default());
    let State::Faulted(fault) = machine.run(&mut host, 100).clone() else { panic!() };
    assert_eq!(fault.kind, FaultKind::StackFull);
}

#[test]
fn the_debugger_stops_at_debug_and_at_the_first_line_of_a_handler() {
    let mut ops = two_handlers();
    ops[4] = Op::Board(Board::Debug);
    let mut machine = machine(ops);
    let mut host = TestHost::default();
    let mut debugger = Debugger::default();
    // While nobody debugs, Debug is passed over.
    debugger.run(&mut machine, &mut host, 20);
    assert!(!debugger.is_paused() && host.board.len() > 2);
    debugger.ask(Request::Attach(true), Some(&mut machine), &mut host);
    debugger.run(&mut machine, &mut host, 20);
    let reason = debugger.view(Some(&mut machine), &mut host, &Default::default()).reason;
    assert_eq!((debugger.is_paused(), reason, machine.at()), (true, Reason::Statement(5), 4));
    machine.raise(1);
    debugger.ask(Request::Step(StepKind::Into), Some(&mut machine), &mut host);
    debugger.run(&mut machine, &mut host, 20);
    assert_eq!((debugger.is_paused(), machine.line(), machine.is_in_handler()), (true, 11, true));
    debugger.ask(Request::Step(StepKind::Out), Some(&mut machine), &mut host);
    debugger.run(&mut machine, &mut host, 20);
    assert_eq!((machine.line(), counts(&machine)), (5, [1, 0]));
}
