//! What a run read off, in rows for people: the same on the command line and on the page.

use super::law::{AnyLaw, Report};
use brushwork_tuning::alternatives::{Alternative, Rule, alternatives};
use brushwork_tuning::model::{Gains, Pid};

type Row = [String; 3];

fn row(name: &str, value: String, doubt: String) -> Row {
    [name.to_owned(), value, doubt]
}

fn percent((value, doubt): (f64, f64)) -> String {
    format!("± {:.1} %", 100.0 * doubt / value.abs())
}

fn duties((low, high): (f64, f64)) -> String {
    format!("{:.0} and {:.0} % duty", 100.0 * low, 100.0 * high)
}

/// What a step, a relay or the controller's own test read off: name, value, and its interval or what belongs to it.
#[must_use]
pub fn experiments(report: &Report) -> Vec<Row> {
    let mut rows = Vec::new();
    if let Some(step) = &report.step {
        rows.push(row("step", duties(step.duties), String::new()));
        let (gain, _) = step.gain_counts_per_s;
        rows.push(row("gain of the step", format!("{gain:.0} counts/s"), percent(step.gain_counts_per_s)));
    }
    if let Some(steps) = report.window.and_then(|window| window.step_duties) {
        rows.push(row("steps to and fro", duties(steps), String::new()));
    }
    if let Some(relay) = &report.relay {
        rows.push(row("relay", duties(relay.duties), format!("about {:.0} counts/s", relay.set_speed)));
        let noise = format!("noise {:.0} counts/s", relay.noise);
        rows.push(row("hysteresis", format!("{:.0} counts/s", relay.hysteresis), noise));
        rows.push(row("limit cycle", format!("{:.1} ms", 1e3 * relay.period_s.0), percent(relay.period_s)));
        let gain = relay.cycle_gain();
        rows.push(row("gain for the cycle", format!("{:.3e} duty/(counts/s)", gain.0), percent(gain)));
        let at_zero = format!("{:.0} counts/s", relay.static_gain.0);
        rows.push(row("gain at 0 Hz", at_zero, percent(relay.static_gain)));
    }
    if let Some(relay) = &report.position_relay {
        let about = format!("about {:.0} counts from the start", relay.set_counts);
        rows.push(row("relay", duties(relay.duties), about));
        let noise = format!("noise {:.1} counts", relay.noise_counts);
        rows.push(row("hysteresis", format!("{:.1} counts", relay.hysteresis_counts), noise));
        rows.push(row("limit cycle", format!("{:.1} ms", 1e3 * relay.period_s.0), percent(relay.period_s)));
        let amplitude = format!("{:.1} counts", relay.amplitude_counts.0);
        rows.push(row("its amplitude", amplitude, percent(relay.amplitude_counts)));
        let gain = relay.cycle_gain();
        rows.push(row("gain for the cycle", format!("{:.3e} duty/count", gain.0), percent(gain)));
    }
    if let Some(test) = &report.own_test {
        let about = format!("about {:.0} counts/s", test.set_speed);
        rows.push(row("controller's own test", duties(test.duties), about));
        let hysteresis = format!("hysteresis {:.0} counts/s", test.hysteresis);
        rows.push(row("its oscillation", format!("{:.0} counts/s", test.amplitude), hysteresis));
        rows.push(row("its period", format!("{:.1} ms", 1e3 * test.period_s), String::new()));
    }
    if let Some(test) = &report.own_position_test {
        let about = format!("about {:.0} counts from the start", test.set_counts);
        rows.push(row("controller's own test", duties(test.duties), about));
        let hysteresis = format!("hysteresis {:.0} counts", test.hysteresis_counts);
        rows.push(row("its oscillation", format!("{:.0} counts", test.amplitude_counts), hysteresis));
        rows.push(row("its period", format!("{:.1} ms", 1e3 * test.period_s), String::new()));
    }
    rows
}

/// Head of [`rules`].
pub const RULE_HEAD: [&str; 5] = ["rule", "gains", "Ms", "overshoot", "settling"];

/// What the textbook rules would set, with what they promise on the run's model.
#[must_use]
pub fn rules(report: &Report) -> Vec<[String; 5]> {
    let own = Rule::of(report.request.identification, report.request.method);
    let of_rule = |found: &Alternative<AnyLaw>| {
        let of = |text: String| if found.is_stable { text } else { "unstable".to_owned() };
        let name = found.rule.name();
        [
            if found.rule == own { format!("{name} (of this method)") } else { name.to_owned() },
            gains_text(&found.design.gains),
            of(format!("{:.2}", found.design.ms)),
            of(format!("{:.0} %", 100.0 * found.design.score.overshoot)),
            of(format!("{:.0} ms", 1e3 * found.design.score.settling_s)),
        ]
    };
    alternatives(report).iter().map(of_rule).collect()
}

/// Gains in a line: those that are there.
#[must_use]
pub fn gains_text(gains: &Gains) -> String {
    let mut parts = Vec::new();
    let mut of = |loop_name: &str, pid: Pid| {
        let named = [("P", pid.p), ("I", pid.i), ("D", pid.d)].into_iter().filter(|(_, gain)| *gain != 0.0);
        let text: Vec<String> = named.map(|(name, gain)| format!("{name} {}", figure(gain))).collect();
        if !text.is_empty() {
            parts.push(format!("{loop_name} {}", text.join(", ")));
        }
    };
    of("velocity", gains.velocity);
    of("position", gains.position.unwrap_or_default());
    parts.join("; ")
}

/// Four figures, which is more than any rule is worth.
fn figure(gain: f64) -> String {
    let decimals = (3 - gain.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{gain:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_told_loop_by_loop_without_what_is_not_there() {
        let velocity = Pid { p: 2.106_23, i: 12.345_6, d: 0.0 };
        let alone = Gains { velocity, ..Gains::default() };
        assert_eq!(gains_text(&alone), "velocity P 2.106, I 12.35");
        let over = Gains { position: Some(Pid { p: 8.0, i: 0.0, d: 0.0 }), ..alone };
        assert_eq!(gains_text(&over), "velocity P 2.106, I 12.35; position P 8.000");
        let direct = Gains { position: Some(Pid { p: 1_234.5, i: 0.0, d: 0.25 }), ..Gains::default() };
        assert_eq!(gains_text(&direct), "position P 1234, D 0.2500");
    }
}
