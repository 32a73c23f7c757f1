//! Tunes plants under laws of all kinds: `cargo run --release -p brushwork-tuning-bench --example laws -- SEED PLANTS velocity|pd|pid|piv`. Lines that
//! begin with `!` promise more than is so.
#![expect(clippy::print_stdout, reason = "a tool talks to the terminal")]

use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_tuning_bench::mcp::laws::{law_row, law_runs};
use brushwork_tuning_bench::unit::Unit as _;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |n: usize, usual: u64| words.get(n).and_then(|text| text.parse().ok()).unwrap_or(usual);
    let wanted = words.get(2).map_or("velocity", String::as_str);
    let Some((_, method)) = ControlLaw::TASKS.iter().find(|(name, _)| *name == wanted) else {
        println!("no method {wanted}");
        return;
    };
    let runs = law_runs(number(0, 904), number(1, 24) as usize, *method);
    for run in &runs {
        println!("{} {}", if run.promises_too_much() { "!" } else { " " }, run.line());
    }
    println!("{:?}", law_row(&runs));
}
