//! A motor and its gains from a record: `cargo run -p brushwork-tuning --example identify -- record.csv`.
//!
//! The record has the columns `time_s,duty,counts`. A line with a duty (-1 to 1) is a command, a line with counts is a poll. Without an
//! argument it takes one that it brings along, made by the example `record` of `brushwork-mcp-sim`.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_tuning::design::{Goal, Task, USUAL_OVERSHOOT, design_velocity};
use brushwork_tuning::experiment_guard::{Drive, Input, Point};
use brushwork_tuning::fit::{Fit, fit};
use brushwork_tuning::model::Lag;
use brushwork_tuning::open_loop_record::OpenLoopRecord;
use brushwork_tuning::plain_law::PlainLaw;
use brushwork_tuning::whatif::forecast;
use std::error::Error;

const BROUGHT_ALONG: &str = include_str!("steps.csv");

/// Soft, as the program does it by default, and stiff.
const LEVELS: [f64; 3] = [20.0, 50.0, 80.0];
/// The lag of the firmware's loop where nobody measured it. Assumed: a filter of one tick and a tick of delay at 300 Hz.
const USUAL_LAG: Lag = Lag { filter_s: 0.004, delay_ticks: 1.0 };

fn main() -> Result<(), Box<dyn Error>> {
    let text = match std::env::args().nth(1) {
        Some(path) => std::fs::read_to_string(path)?,
        None => BROUGHT_ALONG.to_owned(),
    };
    let (points, drives) = read(&text)?;
    let found = identify(&points, &drives)?;
    let model = found.model;
    println!(
        "speed per duty   {:.0} counts/s (+-{:.1} %)",
        model.gain_counts_per_s,
        200.0 * found.sd_ln_gain
    );
    println!("time constant    {:.1} ms (+-{:.1} %)", 1e3 * model.tau_s, 200.0 * found.sd_ln_tau);
    println!("dry friction     {:.1} % duty", 100.0 * model.coulomb_duty);
    println!("load             {:.1} % duty", 100.0 * model.load_duty);
    println!("QPPS             {:.0} counts/s", model.steady_speed(1.0));
    println!("chi-square       {:.2} (1 or less where the model explains the record)", found.chi_square);
    println!();
    println!("level  P        I        overshoot  settles  Ms");
    for level in LEVELS {
        gains_of_level(&found, level);
    }
    Ok(())
}

/// The polls and the commands of a record. Counts are taken from the first one on.
fn read(text: &str) -> Result<(Vec<Point>, Vec<Drive>), Box<dyn Error>> {
    let (mut points, mut drives) = (Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty()) {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let &[time, duty, counts] = cells.as_slice() else {
            return Err(format!("line {}: three columns are expected, time_s,duty,counts", number + 1).into());
        };
        let t: f64 = time.parse()?;
        if !duty.is_empty() {
            drives.push(Drive { t, input: Input::Duty(duty.parse()?) });
        }
        if !counts.is_empty() {
            let counts = counts.parse()?;
            points.push(Point { t, counts, duty: None, amps: None, volts: None, limited: false });
        }
    }
    let origin = points.first().map_or(0.0, |point| point.counts);
    points.iter_mut().for_each(|point| point.counts -= origin);
    Ok((points, drives))
}

fn identify(points: &[Point], drives: &[Drive]) -> Result<Fit, Box<dyn Error>> {
    let end_s = points.last().map_or(0.0, |point| point.t);
    let from_s = points.first().map_or(0.0, |point| point.t);
    let record = OpenLoopRecord::new(points, drives, from_s, end_s, None);
    // The fastest tenth of a second is a start value that is near enough.
    let speeds = points.windows(11).filter_map(|run| {
        let (first, last) = (run.first()?, run.last()?);
        Some((last.counts - first.counts).abs() / (last.t - first.t))
    });
    let top = speeds.fold(1.0, f64::max);
    fit(&record, top, 0.05, None, 1.0).ok_or_else(|| "a record needs at least twelve polls".into())
}

/// A row of the table.
fn gains_of_level(found: &Fit, level: f64) {
    let law = PlainLaw::default();
    let task = Task {
        plant: found.model,
        law,
        lag: USUAL_LAG,
        worst_lag: USUAL_LAG,
        qpps: found.model.steady_speed(1.0),
        goal: Goal::of_level(level),
        noise_factor: 1.0,
        backlash_counts: 0.0,
        least_integral_s: 0.0,
        most_overshoot: USUAL_OVERSHOOT,
        most_speed_gain: None,
        sd_coulomb_duty: 0.0,
    };
    let Some(design) = design_velocity(&task) else {
        println!("{level:5}  no gains keep this level's bounds: is the encoder too coarse?");
        return;
    };
    let gains = design.gains.velocity;
    let promised = forecast(&task, &design.gains);
    println!(
        "{level:5}  {:<7.3}  {:<7.2}  {:6.1} %   {:6}   {:.2}",
        gains.p,
        gains.i,
        100.0 * promised.overshoot,
        promised.settling_s.map_or("never".to_owned(), |s| format!("{:.0} ms", 1e3 * s)),
        promised.ms
    );
}
