//! The worst programs, on a small stack: compiler, index, formatter and listing end with a program or with an error that has a place.
//!
//! `BRUSHWORK_MCL_BYTES=n` takes programs of n bytes (the default is small), `BRUSHWORK_SEED=n` other random ones.

use crate::support::TestHost;
use crate::support::mutation::number;
use crate::support::worst::{Worst, worst};
use brushwork_script::diagnostic::MOST_TOLD;
use brushwork_script::disassembly::disassemble;
use brushwork_script::mcl::format::format;
use brushwork_script::mcl::index::{Index, classes, syntax_at};
use brushwork_script::mcl::{LONGEST_TEXT, Names, codes, compile, too_long};
use brushwork_script::text::Lines;
use brushwork_script::vm::Machine;
use brushwork_script::{image, vm};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Half of what the smallest main thread has (Windows: 1 MiB), a quarter of a thread of the standard library's.
const STACK_BYTES: usize = 512 * 1024;

/// What a program is put through.
fn through(Worst { name, text }: &Worst) {
    let compiled = compile(text);
    let lines = Lines::of(text);
    for said in &compiled.diagnostics {
        assert!(codes::ALL.iter().any(|(code, _)| *code == said.code), "{name}");
        assert!(said.span.start <= said.span.end && said.span.end as usize <= text.len(), "{name}");
        let placed = said.placed(text, &lines);
        assert!(placed.place.line >= 1 && placed.place.column >= 1, "{name}");
        let page = said.render("x", text, &lines);
        assert!(page.len() < 4_000, "{name}: {} bytes for one line", page.len());
    }
    // All that are listed, and of errors and warnings each how many more there are.
    assert!(compiled.diagnostics.len() <= 2 * (MOST_TOLD + 1), "{name}");
    let is_wrong = compiled.diagnostics.iter().any(|said| said.code.starts_with('E'));
    assert_eq!(compiled.program.is_none(), is_wrong, "{name}");
    if let Some(program) = compiled.program {
        assert!(image::decode(&image::encode(&program)).is_ok_and(|read| read == program), "{name}");
        assert!(!disassemble(&program, Some(text)).is_empty(), "{name}");
        let mut machine = Machine::new(Arc::new(program));
        let mut host = TestHost::default();
        let state = machine.run(&mut host, 1_000).clone();
        assert!(state != vm::State::Ready || machine.executed() > 0, "{name}");
    }
    let index = Index::of(text);
    assert_eq!(index.diagnostics, compiled.diagnostics, "{name}");
    let middle = text.floor_char_boundary(text.len() / 2);
    let _ = index.completions(text, middle);
    let _: (_, _, _) =
        (index.symbol_at(middle as u32), index.block_at(middle as u32), index.rename(middle as u32, "other"));
    let first = text.lines().max_by_key(|line| line.len()).unwrap_or("");
    assert!(classes(first).iter().all(|(range, _)| range.end <= first.len()), "{name}");
    let _ = syntax_at(first, first.len());
    let formatted = format(text);
    assert!(formatted.len() <= text.len() * 50 + 10, "{name}");
}

/// Time that this thread has worked; on a busy computer others do not count.
#[cfg(unix)]
fn worked() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

#[cfg(not(unix))]
fn worked() -> Duration {
    static START: std::sync::LazyLock<Instant> = std::sync::LazyLock::new(Instant::now);
    START.elapsed()
}

/// What a program of 20 kB may take to go through everything, and each more. It takes a tenth; what goes with the square takes longer.
const MOST_TIME: Duration = Duration::from_millis(500);

/// Runs on a thread with a stack of so many bytes.
fn on_stack<T: Send + 'static>(bytes: usize, run: impl FnOnce() -> T + Send + 'static) -> T {
    let thread = std::thread::Builder::new().stack_size(bytes).spawn(run).expect("a thread");
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

#[test]
fn the_worst_programs_end_with_a_program_or_an_error_that_has_a_place() {
    let (seed, bytes) = (number("BRUSHWORK_SEED", 1), number("BRUSHWORK_MCL_BYTES", 20_000));
    println!("seed {seed}, {bytes} bytes");
    on_stack(STACK_BYTES, move || {
        for program in worst(bytes as usize, seed, |_| true) {
            let began = worked();
            through(&program);
            let took = worked() - began;
            println!("{:>6} ms  {}", took.as_millis(), program.name.escape_debug());
            assert!(
                took < MOST_TIME.mul_f64((bytes as f64 / 20_000.0).max(1.0)),
                "{}: {took:?}",
                program.name
            );
        }
    });
}

#[test]
fn a_long_sum_compiles_and_a_longer_one_is_refused_where_it_does_not_fit() {
    on_stack(STACK_BYTES, || {
        let sum = |terms: usize| {
            format!("x var long\nx = 1\nx = x{}\nputs 0,[dec x]\nend\n", "+x".repeat(terms - 1))
        };
        assert_eq!(crate::support::output(&sum(40_000)), "40000");
        let found = compile(&sum(140_000)).diagnostics;
        let [only] = &found[..] else { panic!("{found:?}") };
        assert_eq!((only.code, Lines::of(&sum(140_000)).line_of(only.span.start)), (codes::TOO_LARGE, 3));
        assert_eq!(only.message, "The program has 280010 instructions; 262144 are allowed.");
    });
}

#[test]
fn a_text_that_is_too_long_is_refused_where_the_bound_is() {
    let text = "end\n".repeat(LONGEST_TEXT / 4);
    assert!(too_long(&text).is_none());
    let text = format!("{text}é\n");
    let compiled = compile(&text);
    let [only] = &compiled.diagnostics[..] else { panic!("{:?}", compiled.diagnostics) };
    assert_eq!((only.code, only.span.start as usize), (codes::TOO_LARGE, LONGEST_TEXT));
    assert!(compiled.program.is_none() && Names::of(&text).is_none());
    assert_eq!(Index::of(&text).diagnostics, compiled.diagnostics);
    assert_eq!(format(&text), text);
}

#[test]
fn of_too_many_statements_or_names_the_first_too_many_is_named() {
    let place_of = |text: &str, start: u32| Lines::of(text).line_of(start) as usize;
    let text = "end\n".repeat(400_000);
    let reported = compile(&text).diagnostics;
    let places: Vec<usize> = reported.iter().map(|said| place_of(&text, said.span.start)).collect();
    // One instruction too many, and one statement more than there can be instructions and names.
    assert_eq!(places, [256 * 1024 + 1, (256 + 64) * 1024 + 1]);
    assert!(reported.iter().all(|said| said.code == codes::TOO_LARGE));
    let text: String = (0..70_000).map(|number| format!("v{number} con 1\n")).collect();
    let reported = compile(&text).diagnostics;
    assert_eq!(reported[0].message, "The program has 70000 names; 65536 are allowed.");
    assert_eq!((reported.len(), place_of(&text, reported[0].span.start)), (1, 65_537));
}

#[test]
fn of_many_errors_the_first_are_listed_and_the_last_says_how_many_more_there_are() {
    let text = "#if 0\n?????\n#endif\n".to_owned() + &"?\n".repeat(1_000) + &"goto nowhere\n".repeat(3);
    let reported = compile(&text).diagnostics;
    assert_eq!(reported.len(), MOST_TOLD + 1);
    let lines = Lines::of(&text);
    assert!((0..MOST_TOLD).all(|at| lines.line_of(reported[at].span.start) as usize == at + 4));
    let last = &reported[MOST_TOLD];
    assert_eq!(
        (last.code, last.message.as_str()),
        (codes::MORE_ERRORS, "There are 903 more errors than the 100 that are listed.")
    );
    assert_eq!(lines.line_of(last.span.start) as usize, MOST_TOLD + 4);
}

#[test]
fn an_expression_of_the_debugger_is_bounded_too() {
    on_stack(STACK_BYTES, || {
        let mut names = Names::of("x var long\nt var long(4)\nx = t(0)\nend\n").expect("a program");
        assert!(names.watch(&format!("x{}", "+x".repeat(2_000))).is_ok());
        for text in
            ["(".repeat(4_000), "-".repeat(4_000) + "x", "t(".repeat(2_000), "not ".repeat(1_000) + "x"]
        {
            let said = names.watch(&text).expect_err("it is too deep");
            assert!(said.contains("more than 100 levels deep"), "{said}");
        }
        assert!(names.watch(&"x+".repeat(3_000)).is_err());
    });
}

#[test]
fn images_made_to_be_slow_are_answered_at_once() {
    use brushwork_script::op::{Array, Cell, Op};
    use brushwork_script::program::{Program, Variable, limits};
    let memory = Array {
        first: Cell { kind: brushwork_script::mcl::types::VarType::Bit, at: 9 },
        stride: 1,
        length: 1,
    };
    let program = Program {
        // Each BRANCH claims a table of all that follows it.
        ops: vec![Op::Branch(u32::MAX); 100_000]
            .into_iter()
            .chain(vec![Op::Load(memory.first); 100_000])
            .collect(),
        lines: vec![1; 200_000],
        ram_bytes: 2,
        variables: vec![Variable { name: "v".into(), memory, is_array: false }; limits::NAMES],
        labels: (0..limits::NAMES as u32).map(|at| ("l".to_owned(), at)).collect(),
        ..Program::default()
    };
    let program = image::decode(&image::encode(&program)).expect("an image");
    let began = Instant::now();
    let page = disassemble(&program, None);
    assert!(page.contains("load               Bit 1.1 ; v\n"));
    let mut machine = Machine::new(Arc::new(program));
    let _ = machine.run(&mut TestHost::default(), 10_000);
    // Some milliseconds; what went through every pair took minutes.
    assert!(began.elapsed().as_secs() < 20, "{:?}", began.elapsed());
}
