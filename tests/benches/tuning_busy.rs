//! Tuning on a computer that is busy with other things: what becomes of run after run, each of its own process.
//!
//! `cargo bench -p brushwork-tests --bench tuning_busy -- [--runs 100] [--busy 6] [--connect sim:mcp266]`. A run may find gains, or say that this
//! computer was too late; it ends with 1 where one says anything else, since the simulated motor is sound, or where fewer than 95 % find gains.
#![expect(clippy::print_stdout, reason = "the table is what the benchmark is for")]

use std::collections::BTreeMap;
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use brushwork_tests::program::{Child, Program};

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");
/// Asks this program to do nothing but keep a processor busy.
const SPIN: &str = "--spin";
/// No run is longer: its own limit, and that of the jobs around it, several times.
const LONGEST: Duration = Duration::from_secs(900);
/// Share of runs that are to find gains.
const TUNED: f64 = 0.95;
/// Exit codes of a run with gains, and of one for which this computer was too late.
const WITH_GAINS: [i32; 2] = [0, 8];
const TOO_LATE: i32 = 11;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    if words.iter().any(|word| word == SPIN) {
        spin();
    }
    let of = |name: &str| words.iter().position(|word| word == name).and_then(|at| words.get(at + 1));
    let count = |name: &str, usual: u32| of(name).map_or(usual, |text| text.parse().expect("a number"));
    let (runs, busy) = (count("--runs", 100), count("--busy", 6));
    let target = of("--connect").map_or("sim:mcp266", String::as_str);
    let own = std::env::current_exe().expect("this program has a path");
    let _busy: Vec<Child> = (0..busy)
        .map(|_| {
            let mut command = Command::new(&own);
            command.arg(SPIN);
            Child::spawn(&command, [Stdio::null(), Stdio::null(), Stdio::null()])
        })
        .collect();
    let (mut ends, mut tuned, mut wrong) = (BTreeMap::<(i32, String), u32>::new(), 0, 0);
    let (mut marked, mut again) = (0, 0);
    let begun = Instant::now();
    for _ in 0..runs {
        let arguments = ["tune", "velocity", "--connect", target, "--dry-run"];
        let ending = Program::start(BRUSHWORK, &arguments).finish(LONGEST);
        let code = ending.status.code().unwrap_or(-1);
        tuned += u32::from(WITH_GAINS.contains(&code));
        wrong += u32::from(!WITH_GAINS.contains(&code) && code != TOO_LATE);
        marked += u32::from(ending.stdout.iter().any(|line| line.contains("were taken while this computer")));
        again += u32::from(ending.stderr.iter().any(|line| line.starts_with("This computer answered late")));
        // The verdict without its seconds, and the first thing that it says.
        let verdict = ending.stdout.first().and_then(|line| line.split(" after").next()).unwrap_or("");
        let why = ending.stdout.get(1).filter(|line| line.starts_with("  ") && !line.trim().is_empty());
        let why = why.or(ending.stderr.last().filter(|_| verdict.is_empty()));
        let why: String = why.map_or("", |line| line.trim()).chars().take(90).collect();
        *ends.entry((code, format!("{verdict} {why}"))).or_default() += 1;
    }
    println!(
        "{runs} runs against {target} beside {busy} busy processes, {:.1} s each",
        begun.elapsed().as_secs_f64() / f64::from(runs.max(1))
    );
    for ((code, said), count) in &ends {
        println!("{count:>4}  exit {code:<3}  {said}");
    }
    println!(
        "{tuned} of {runs} found gains, {marked} of them with the mark of lateness; {again} did something again"
    );
    println!("{wrong} of {runs} named something else than this computer");
    ExitCode::from(u8::from(wrong > 0 || f64::from(tuned) < TUNED * f64::from(runs)))
}

/// Keeps a processor busy until somebody ends it.
fn spin() -> ! {
    let mut number = 1_u64;
    loop {
        number = std::hint::black_box(number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
    }
}
