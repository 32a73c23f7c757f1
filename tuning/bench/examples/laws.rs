//! Tunes plants under laws of all kinds: `cargo run --release -p brushwork-tuning-bench --example laws -- SEED PLANTS`. Lines that begin
//! with `!` promise more than is so.
#![expect(clippy::print_stdout, reason = "a tool talks to the terminal")]

use brushwork_tuning_bench::mcp::laws::{law_row, law_runs};

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|text| text.parse().ok());
    let (seed, plants) = (numbers.next().unwrap_or(904), numbers.next().unwrap_or(24));
    let runs = law_runs(seed, plants as usize);
    for run in &runs {
        println!("{} {}", if run.promises_too_much() { "!" } else { " " }, run.line());
    }
    println!("{:?}", law_row(&runs));
}
