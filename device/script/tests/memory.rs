//! How much memory the worst programs take, byte by byte: what compiler, index and formatter hold at once at most, and what is printed.
//!
//! They have 50 kB, and those that take the most 1 MB too: `BRUSHWORK_MCL_LONG=n` so many of them (1000 is all), `BRUSHWORK_SEED=n` takes
//! other random ones.

#[path = "script/support/mod.rs"]
mod support;

use brushwork_script::mcl::compile;
use brushwork_script::mcl::format::format;
use brushwork_script::mcl::index::Index;
use brushwork_script::text::Lines;
use peak_alloc::PeakAlloc;
use support::mutation::number;
use support::worst::{Worst, worst};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Bytes of memory for each byte of a program.
const MOST_TIMES: f64 = 200.0;

/// What `run` holds at most beyond what is held before it.
fn peak<T>(run: impl FnOnce() -> T) -> usize {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    drop(run());
    MEMORY.peak_usage() - before
}

/// Compiles, and renders what there is to say.
fn check(text: &str) -> String {
    let lines = Lines::of(text);
    compile(text).diagnostics.iter().map(|said| said.render("x", text, &lines)).collect()
}

// One test alone: others at the same time would be counted too.
#[test]
fn the_worst_programs_take_at_most_200_times_their_length() {
    let seed = number("BRUSHWORK_SEED", 1);
    let longer = number("BRUSHWORK_MCL_LONG", 3) as usize;
    println!("seed {seed}, {longer} long programs");
    // Tables that are made once are not counted.
    let _ = (check("a = b\n"), Index::of("a = b\n"), format("a = b\n"));
    let measure = |programs: Vec<Worst>| -> Vec<(f64, String)> {
        let mut all = Vec::new();
        for Worst { name, text } in programs {
            let peaks = [peak(|| check(&text)), peak(|| Index::of(&text)), peak(|| format(&text))];
            let times = peaks.map(|peak| peak as f64 / text.len() as f64);
            assert!(times.iter().all(|times| *times < MOST_TIMES), "{}: {times:?}", name.escape_debug());
            all.push((times.into_iter().fold(0.0, f64::max), name));
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("{:.0} times at most, by {}", all[0].0, all[0].1.escape_debug());
        all
    };
    let short = measure(worst(50_000, seed, |_| true));
    let most: Vec<&str> = short[..longer.min(short.len())].iter().map(|(_, name)| name.as_str()).collect();
    measure(worst(1_000_000, seed, |name| most.contains(&name)));
}
