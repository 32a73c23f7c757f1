use brushwork_tuning_bench::faults::rows_of;
use brushwork_tuning_bench::population::population;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let seed: u64 = args[1].parse().unwrap();
    let n: usize = args[2].parse().unwrap();
    let names: Vec<&str> = args[3..].iter().map(String::as_str).collect();
    let plants = match std::env::var("PLANT") { Ok(p) => vec![brushwork_tuning_bench::population::specimen(seed, p.parse().unwrap())], _ => population(seed, n) };
    for row in rows_of(&plants, &names) {
        println!("{} n={} in_time={} named={} med={} max={} peak={} {:?}", row.fault, row.plants, row.off_in_time, row.named, row.off_median_s, row.off_max_s, row.peak_current_max, row.causes);
        for m in row.misses.iter().take(14) { println!("    {m:?}"); }
    }
}
