//! A report in words and figures.

use brushwork_core::tune::law::Report;
use brushwork_core::tune::words::{RULE_HEAD, experiments, rules};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::law::Law;
use brushwork_tuning::load_change::{HEADS, LoadChange};
use brushwork_tuning::promise::Promise;
use brushwork_tuning::registers::RegisterTable as _;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::stability::StabilityMargins;
use brushwork_tuning::tune::{Identification, Method};
use brushwork_tuning::whatif::frequency_response;
use serde_json::{Value, json};

use crate::{Exit, Output, OutputError};

/// The exit code of a verdict.
pub fn exit_of(report: &Report) -> Exit {
    match report.verdict {
        Verdict::Tuned => Exit::Done,
        Verdict::TunedWithWarnings => Exit::TunedWithWarnings,
        Verdict::Refused => {
            let cause = report.causes.first();
            if matches!(cause, Some(Cause::AnsweredLate { .. })) {
                Exit::TooLate
            } else if cause == Some(&Cause::LinkLost) {
                Exit::NoLink
            } else {
                Exit::Refused
            }
        }
    }
}

/// The report without its raw record.
pub fn summary(report: &Report) -> Value {
    let mut value = serde_json::to_value(report).unwrap_or_else(|_| json!({}));
    if let Some(fields) = value.as_object_mut() {
        fields.remove("record");
        if let Some(promise) = report.promise() {
            fields.insert("promise".to_owned(), json!(promise));
        }
        if let Some(trajectory) = report.trajectory() {
            fields.insert("trajectory".to_owned(), json!(trajectory));
        }
        if let Some(stood) = LoadChange::of_run(report) {
            fields.insert("load_change".to_owned(), json!(stood));
        }
    }
    value
}

/// Prints verdict, model, prediction and gains.
pub fn print(report: &Report, out: &mut Output) -> Result<(), OutputError> {
    let verdict = match report.verdict {
        Verdict::Tuned => "TUNED",
        Verdict::TunedWithWarnings => "TUNED WITH WARNINGS",
        Verdict::Refused => "REFUSED",
    };
    out.line(format!("{verdict} after {:.1} s", report.seconds.1))?;
    for cause in &report.causes {
        out.line(format!("  {}", cause.sentence()))?;
    }
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut row = |what: &str, value: String, range: String| rows.push(vec![what.to_owned(), value, range]);
    if let Some(qpps) = report.qpps {
        let interval =
            report.free.map_or_else(String::new, |free| format!("+- {:.2} %", 100.0 * free.interval));
        row("QPPS", format!("{qpps:.0} counts/s"), interval);
    }
    if let Some(fit) = &report.fit {
        let share = |sd: f64| format!("+- {:.1} %", 200.0 * sd);
        row("gain", format!("{:.0} counts/s", fit.model.gain_counts_per_s), share(fit.sd_ln_gain));
        let tau = fit.time_constant();
        row("time constant", format!("{:.1} ms", 1e3 * tau.seconds), share(tau.sd_ln));
        let friction = format!("{:.1} % duty", 100.0 * fit.model.coulomb_duty);
        row("friction", friction, format!("+- {:.1} % duty", 200.0 * fit.sd_coulomb));
    }
    if let Some(winding) = &report.winding {
        row(
            "resistance R",
            format!("{:.3} ohm", winding.ohms),
            format!("+- {:.3} ohm", winding.interval_ohms),
        );
    }
    if let Some(slack) = &report.backlash {
        let value = if slack.counts > 0.0 {
            format!("at least {:.1} counts", slack.counts)
        } else {
            "none seen".into()
        };
        row("backlash at reversals", value, format!("+- {:.1} counts", slack.interval_counts));
    }
    if let Some(lag) = &report.lag {
        let range = format!("{:.1} to {:.1} ms", 1e3 * lag.interval_s.0, 1e3 * lag.interval_s.1);
        row(
            "lag of the loop",
            format!("{:.1} ms", 1e3 * lag.lag.total_s(report.request.law.tick_s())),
            range,
        );
    }
    for [name, value, doubt] in experiments(report) {
        row(&name, value, doubt.replace('±', "+-"));
    }
    // A loop that acts on the duty directly has another ultimate point.
    let has_velocity = matches!(report.request.method, Method::Velocity | Method::Piv);
    let is_by_rule = report.request.identification != Identification::Fit;
    if let Some(seen) = report.classic.filter(|_| has_velocity && is_by_rule) {
        row("Ku of the velocity loop", format!("{:.3e} duty/(counts/s)", seen.ultimate_gain), String::new());
        row("Tu of the velocity loop", format!("{:.1} ms", 1e3 * seen.ultimate_period_s), String::new());
    }
    if let Some(design) = &report.design {
        if let Some(task) = &report.task {
            let margins = StabilityMargins::of(&frequency_response(task, &design.gains));
            for (name, value, _) in margins.rows().into_iter().take(5) {
                row(name, value, String::new());
            }
        }
        let promise = report.promise();
        let range = |of: fn(&Promise) -> String| promise.as_ref().map_or_else(String::new, of);
        let ms = range(|promise| format!("{:.2} to {:.2}", promise.ms.0, promise.ms.1));
        row("sensitivity Ms", format!("{:.2}", design.ms), ms);
        row("predicted overshoot", format!("{:.0} %", 100.0 * design.score.overshoot), String::new());
        let settling = range(|promise| {
            format!("{:.0} to {:.0} ms", 1e3 * promise.settling_s.0, 1e3 * promise.settling_s.1)
        });
        row("predicted settling", format!("{:.0} ms", 1e3 * design.score.settling_s), settling);
        let measured =
            report.measured.map_or_else(String::new, |m| format!("measured {:.1} %", 100.0 * m.duty_rms));
        row("duty noise", format!("{:.1} %", 100.0 * design.noise_duty), measured);
    }
    if let Some(trajectory) = report.trajectory() {
        row(
            "trajectory",
            format!("{:.0} counts/s", trajectory.speed_counts_per_s),
            format!("{:.0} counts/s² both ways", trajectory.accel_counts_per_s2),
        );
    }
    let stood = LoadChange::of_run(report);
    for (name, value, what) in stood.iter().flat_map(LoadChange::rows) {
        row(name, value, what);
    }
    if let Some(given) = report.qpps.and_then(|qpps| report.proposed.feed_forward(qpps)) {
        row(
            "feed-forward",
            format!("{:.0} % of a speed's duty", 100.0 * given.share.min(1.0)),
            String::new(),
        );
    }
    out.table(&["", "", ""], &rows)?;
    if let Some(stood) = stood {
        let rows: Vec<Vec<String>> = stood.changed.iter().map(|changed| changed.cells().to_vec()).collect();
        out.table(&HEADS, &rows)?;
    }
    print_gains(report, out)?;
    let rules: Vec<Vec<String>> = rules(report).into_iter().map(|row| row.to_vec()).collect();
    if rules.is_empty() { Ok(()) } else { out.table(&RULE_HEAD, &rules) }
}

fn print_gains(report: &Report, out: &mut Output) -> Result<(), OutputError> {
    let Some(before) = report.before else { return Ok(()) };
    if let Some(winding) = report.winding.filter(|_| report.verdict != Verdict::Refused) {
        out.line(format!(
            "Measured R {:.3} ohm. It is not set: with L and R both other than 0, duty commands become current commands (settings \
             motor*.resistance_ohms and motor*.inductance_henries).",
            winding.ohms
        ))?;
    }
    if let Some(why) = report.winding_unknown {
        out.line(format!("R of the winding was not reported: {}", why.sentence()))?;
    }
    let rows = report.request.law.rows(&before.held, &report.proposed);
    let rows: Vec<Vec<String>> = rows.into_iter().map(|row| row.to_vec()).collect();
    if rows.is_empty() { Ok(()) } else { out.table(&["gain", "current", "proposed", "on the wire"], &rows) }
}
