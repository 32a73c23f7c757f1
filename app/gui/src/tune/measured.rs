//! Figures of what a loop did in a stretch: overshoot and settling of its steps, as measured and as predicted for the same commands.

use brushwork_core::tune::law::Trace;
use brushwork_tuning::experiment_guard::Input;
use brushwork_tuning::trace::Stretch;

/// Band of a settled speed, as a share of the step; that of a position, and the counts that are rounding.
const SPEED_BAND: f64 = 0.05;
const PLACE_BAND: f64 = 0.02;
const ROUNDING_COUNTS: f64 = 3.0;
/// Values of a speed to either side of one that have to leave the band with it, on the whole: a count is up to a tick old when it is read, and a single one that is makes
/// two speeds wrong, which a motor that settled does not.
const BESIDE: usize = 2;

/// What the steps of a stretch amount to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Beyond the setpoint, over the step; the median of the steps.
    pub overshoot: f64,
    /// s; the median of the steps that settled, none where most did not before the next one.
    pub settling_s: Option<f64>,
}

struct Step {
    from_s: f64,
    to_s: f64,
    before: f64,
    goal: f64,
}

/// The steps of the setpoint in a stretch. That from rest to the first speed is none: it saturates.
fn steps(trace: &Trace, stretch: &Stretch) -> Vec<Step> {
    let inside = trace.drives.iter().filter(|drive| drive.t >= stretch.from_s && drive.t <= stretch.to_s);
    let goals: Vec<(f64, f64)> = inside
        .filter_map(|drive| match drive.input {
            Input::Speed(speed) if !stretch.is_position => Some((drive.t, speed)),
            Input::Position(counts, _) if stretch.is_position => Some((drive.t, counts)),
            Input::Duty(_) | Input::Speed(_) | Input::Position(..) => None,
        })
        .collect();
    let start = trace.points.iter().rev().find(|point| point.t <= stretch.from_s).map(|point| point.counts);
    let mut before = start.filter(|_| stretch.is_position);
    let mut steps = Vec::new();
    for (index, (from_s, goal)) in goals.iter().copied().enumerate() {
        let to_s = goals.get(index + 1).map_or(stretch.to_s, |next| next.0);
        if let Some(before) = before.filter(|before| *before != goal) {
            steps.push(Step { from_s, to_s, before, goal });
        }
        before = Some(goal);
    }
    steps
}

/// The figures of `values` (time, speed or position) in the stretch. `rounding` is what the resolution alone can do to a value.
pub fn figures(trace: &Trace, stretch: &Stretch, values: &[(f64, f64)], rounding: f64) -> Option<Figures> {
    let (mut overs, mut settled) = (Vec::new(), Vec::new());
    for step in steps(trace, stretch) {
        let way = step.goal - step.before;
        let inside: Vec<(f64, f64)> =
            values.iter().filter(|(t, _)| *t > step.from_s && *t < step.to_s).copied().collect();
        if inside.len() < 4 || way.abs() < 4.0 * rounding {
            continue;
        }
        let over = inside.iter().map(|(_, value)| (value - step.goal) * way.signum()).fold(0.0, f64::max);
        overs.push((over - rounding).max(0.0) / way.abs());
        let band = if stretch.is_position {
            (PLACE_BAND * way.abs()).max(ROUNDING_COUNTS)
        } else {
            SPEED_BAND * way.abs() + rounding
        };
        let beside = if stretch.is_position { 0 } else { BESIDE };
        let last_outside =
            (0..inside.len()).rposition(|n| (about(&inside, n, beside) - step.goal).abs() > band);
        settled.push(match last_outside {
            None => 0.0,
            Some(index) => inside.get(index + 1).map_or(f64::INFINITY, |(t, _)| t - step.from_s),
        });
    }
    let overshoot = median(overs)?;
    Some(Figures { overshoot, settling_s: median(settled).filter(|s| s.is_finite()) })
}

/// The median of a value and so many to either side of it.
fn about(values: &[(f64, f64)], index: usize, beside: usize) -> f64 {
    let to = values.len().min(index + beside + 1);
    let around = values.get(index.saturating_sub(beside)..to).unwrap_or_default();
    median(around.iter().map(|(_, value)| *value).collect()).unwrap_or_default()
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_tuning::axis::EncoderClass;
    use brushwork_tuning::experiment_guard::Drive;

    #[test]
    fn a_count_that_was_old_when_it_was_read_does_not_make_a_settled_speed_unsettled() {
        let mut trace = Trace::new(0, EncoderClass::Quadrature);
        for (t, speed) in [(0.0, 1000.0), (1.0, 2000.0)] {
            trace.drives.push(Drive { t, input: Input::Speed(speed) });
        }
        let stretch = Stretch { from_s: 0.0, to_s: 2.0, is_position: false };
        let settled_after = |outside: &[i32]| {
            let value = |n: i32| match n {
                0..100 => 1000.0,
                100..130 => 2200.0,
                _ if outside.contains(&n) => 2400.0,
                _ => 2000.0,
            };
            let values: Vec<(f64, f64)> = (0..200).map(|n| (f64::from(n) * 0.01, value(n))).collect();
            figures(&trace, &stretch, &values, 0.0).unwrap().settling_s.unwrap()
        };
        assert!((settled_after(&[]) - 0.3).abs() < 0.011);
        assert!((settled_after(&[160, 161]) - 0.3).abs() < 0.011, "one old count");
        assert!(settled_after(&[160, 161, 162, 163]) > 0.6, "a speed that does leave its band");
    }

    #[test]
    fn the_median_of_the_steps_counts_and_the_first_from_rest_does_not() {
        let mut trace = Trace::new(0, EncoderClass::Quadrature);
        for (t, speed) in [(0.0, 1000.0), (1.0, 2000.0), (2.0, 1000.0), (3.0, 2000.0)] {
            trace.drives.push(Drive { t, input: Input::Speed(speed) });
        }
        let stretch = Stretch { from_s: 0.0, to_s: 4.0, is_position: false };
        // From rest it overshoots wildly; each step overshoots by 20 % and settles after 0.3 s.
        let value = |t: f64| {
            let goal = if (t as i64) % 2 == 0 { 1000.0 } else { 2000.0 };
            let sign = if goal > 1500.0 { 1.0 } else { -1.0 };
            match t {
                t if t < 1.0 => (t, 9000.0),
                t if t.fract() < 0.3 => (t, goal + sign * 200.0),
                t => (t, goal),
            }
        };
        let values: Vec<(f64, f64)> = (0..400).map(|n| value(f64::from(n) * 0.01)).collect();
        let found = figures(&trace, &stretch, &values, 0.0).unwrap();
        assert!((found.overshoot - 0.2).abs() < 1e-9, "{found:?}");
        assert!((found.settling_s.unwrap() - 0.3).abs() < 0.011, "{found:?}");
    }
}
