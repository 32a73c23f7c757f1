//! `brushwork bench tuning`: the tuner and every textbook rule, side by side on the same records.

use brushwork_tuning_bench::faults::FaultRow;
use brushwork_tuning_bench::table::{Row, Table};
use brushwork_tuning_bench::ways::WayRow;

use super::arguments::{BenchArgs, Scale};
use super::sensitivity;
use brushwork_cli::Exit;
use brushwork_cli::interrupt::Interrupt;
use brushwork_cli::new_file::NewFile;
use brushwork_cli::output::{Output, OutputError, say};

const HEADS: [&str; 13] = [
    "task",
    "method",
    "accept %",
    "good %",
    "J med",
    "J p95",
    "unstable %",
    "Ms p95",
    "Ms inertia p95",
    "overshoot p95 %",
    "no warning %",
    "Ms > 1.8, no warning %",
    "s",
];
const FAULT_HEADS: [&str; 8] =
    ["fault", "runs", "off in time %", "named %", "off med s", "off max s", "deadline s", "peak current %"];

const WAY_HEADS: [&str; 9] =
    ["by", "loop", "", "found %", "no warning %", "accept %", "Ms > 2 %", "Ms > 1.8, no warning %", "s"];

/// Runs the benchmark, or writes its optima.
pub fn run(args: &BenchArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    if args.plants == 0 {
        say("A benchmark needs at least one motor: use --plants 200.");
        return Exit::Usage;
    }
    if let Some(Err(why)) = args.scale.as_ref().map(Scale::apply) {
        say(format!("{why}."));
        return Exit::Usage;
    }
    if !args.sensitivity.is_empty() {
        return sensitivity::run(args, out, interrupt);
    }
    let (_, judge) = args.family;
    if args.faults {
        let rows = (judge.faults)(args.seed, args.plants);
        let printed = if args.json { out.json(&rows) } else { print_faults(&rows, out) };
        return printed.map_or_else(Exit::from, |()| Exit::Done);
    }
    if args.ways {
        let rows = (judge.ways)(args.seed, args.plants);
        let printed = if args.json { out.json(&rows) } else { print_ways(&rows, out) };
        return printed.map_or_else(Exit::from, |()| Exit::Done);
    }
    // The optima take an hour.
    let mut file = args.write_oracle.as_deref().map(|path| NewFile::new(path, args.replace));
    if let Some(Err(error)) = file.as_ref().map(NewFile::check) {
        return error.into();
    }
    if let Some(file) = &mut file {
        let text = (judge.optima)(args.seed, args.plants).unwrap_or_default();
        return file.write(text.as_bytes()).map_or_else(Exit::from, |()| Exit::Done);
    }
    let table = (judge.table)(args.seed, args.plants, !args.quick);
    let printed = if args.json { out.json(&table) } else { print(&table, out) };
    printed.map_or_else(Exit::from, |()| Exit::Done)
}

fn print(table: &Table, out: &mut Output) -> Result<(), OutputError> {
    let mut rows = Vec::new();
    for task in ["velocity", "pd", "pid", "piv"] {
        rows.extend(table.tasks.get(task).into_iter().flatten().map(|row| cells(task, row)));
    }
    for task in ["pd", "pid", "piv"] {
        let name = format!("{task}, absolute");
        rows.extend(table.absolute.get(task).into_iter().flatten().map(|row| cells(&name, row)));
    }
    out.table(&HEADS, &rows)?;
    print_rejects(table, out)?;
    out.line("")?;
    let found = serde_json::to_value(table.identification).unwrap_or_default();
    let found: Vec<Vec<String>> = found
        .as_object()
        .into_iter()
        .flatten()
        .map(|(name, value)| vec![name.replace('_', " "), value.to_string()])
        .collect();
    out.table(&["identification", ""], &found)?;
    if table.faults.is_empty() {
        return Ok(());
    }
    out.line("")?;
    print_faults(&table.faults, out)
}

/// What our own methods did not get accepted, the largest groups first.
fn print_rejects(table: &Table, out: &mut Output) -> Result<(), OutputError> {
    let mut groups: Vec<(&str, &String, usize)> = Vec::new();
    for (task, rows) in &table.tasks {
        let ours = rows.iter().filter(|row| row.method == "brushwork");
        groups.extend(ours.flat_map(|row| &row.rejects).map(|(group, count)| (*task, group, *count)));
    }
    groups.sort_by_key(|(_, _, count)| std::cmp::Reverse(*count));
    let rows: Vec<Vec<String>> = groups
        .iter()
        .map(|(task, group, count)| vec![(*task).to_owned(), (*group).clone(), count.to_string()])
        .collect();
    out.line("")?;
    out.table(&["task", "not accepted", "runs"], &rows)
}

fn print_faults(rows: &[FaultRow], out: &mut Output) -> Result<(), OutputError> {
    let cells = |row: &FaultRow| {
        vec![
            row.fault.to_owned(),
            row.plants.to_string(),
            row.off_in_time.to_string(),
            row.named.to_string(),
            row.off_median_s.to_string(),
            row.off_max_s.to_string(),
            row.deadline_s.to_string(),
            row.peak_current_max.to_string(),
        ]
    };
    out.table(&FAULT_HEADS, &rows.iter().map(cells).collect::<Vec<_>>())
}

fn print_ways(rows: &[WayRow], out: &mut Output) -> Result<(), OutputError> {
    let cells = |row: &WayRow| {
        let figures =
            [row.found, row.unwarned, row.accepted, row.beyond, row.overpromised, row.seconds_median];
        let mut cells = vec![
            format!("{:?}", row.identification).to_lowercase(),
            format!("{:?}", row.method).to_lowercase(),
            if row.in_travel { "in a travel" } else { "freely" }.to_owned(),
        ];
        cells.extend(figures.iter().map(ToString::to_string));
        cells
    };
    out.table(&WAY_HEADS, &rows.iter().map(cells).collect::<Vec<_>>())
}

fn cells(task: &str, row: &Row) -> Vec<String> {
    let figures = [
        Some(row.accept),
        Some(row.good),
        Some(row.j_median),
        Some(row.j_p95),
        Some(row.unstable),
        Some(row.ms_p95),
        Some(row.ms_varied_p95),
        Some(row.overshoot_p95),
        row.unwarned,
        row.overpromised,
        Some(row.seconds_median),
    ];
    let mut cells = vec![task.to_owned(), row.method.clone()];
    cells.extend(
        figures.iter().map(|figure| figure.map_or_else(|| "-".to_owned(), |known| known.to_string())),
    );
    cells
}
