//! A run as one page for people: what was found, which gains, what they promise, with plots. It needs nothing beside it: styles and plots are in it.

use super::words::{RULE_HEAD, experiments, rules};
use std::fmt::Write as _;

use brushwork_tuning::law::Law as _;
use brushwork_tuning::load_change::{Changed, HEADS, LoadChange};
use brushwork_tuning::promise::Promise;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::stability::StabilityMargins;
use brushwork_tuning::tune::Identification;
use brushwork_tuning::whatif::{LoopPoint, forecast, frequency_response};

use super::law::{Report, Trace};

/// Size of a plot, and the room for its figures, pixels.
const SIZE: (f64, f64) = (680.0, 240.0);
const MARGIN: (f64, f64) = (64.0, 28.0);
/// Grid lines to a side, about.
const LINES: f64 = 5.0;
/// Colours of curves.
const COLOURS: [&str; 4] = ["#1f6feb", "#d1495b", "#2e8b57", "#8a6d3b"];
/// Curves have no more points than that.
const MOST_POINTS: usize = 1_500;
/// Speeds are taken over so long, s.
const SPEED_OVER_S: f64 = 0.02;

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;max-width:46em;margin:2em auto;padding:0 1em;color:#1a1a1a}\
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.8em}table{border-collapse:collapse;margin:.6em 0}\
td,th{padding:.2em .9em .2em 0;text-align:left;vertical-align:top}td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}\
tr{border-bottom:1px solid #ddd}.weak{color:#666}figure{margin:1em 0}figcaption span{margin-left:1.2em}svg{max-width:100%;height:auto}svg text{font:11px system-ui,sans-serif;fill:#444}";

/// Head of a column of words.
const WHAT: &str = "what it is";

/// One curve: its name and its points.
struct Curve {
    name: &'static str,
    points: Vec<(f64, f64)>,
}

/// A plot: its title, axes and curves.
struct Plot {
    title: &'static str,
    across: &'static str,
    up: &'static str,
    is_logarithmic: bool,
    /// The part that is shown of the vertical axis, where not all of it is.
    limits: Option<(f64, f64)>,
    curves: Vec<Curve>,
}

/// The page of a run.
#[must_use]
pub fn page(report: &Report) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Tuning report</title><style>{STYLE}</style></head><body>\n"
    );
    let verdict = match report.verdict {
        Verdict::Tuned => "Tuned",
        Verdict::TunedWithWarnings => "Tuned with warnings",
        Verdict::Refused => "Refused",
    };
    let method = match report.request.identification {
        Identification::Fit => "a fitted model",
        Identification::Step => "a step",
        Identification::Relay => "a relay",
        Identification::Controller => "the controller's own relay test",
    };
    // Writing into a string cannot fail, here and below.
    let _ = writeln!(
        page,
        "<h1>{verdict}: motor {}, by {method}</h1><p class=\"weak\">{:.1} s, level {:.0}</p>",
        report.request.guard.motor + 1,
        report.seconds.1,
        report.request.level
    );
    if !report.causes.is_empty() {
        page.push_str("<ul>");
        for cause in &report.causes {
            let _ = write!(page, "<li>{}</li>", escaped(&cause.sentence()));
        }
        page.push_str("</ul>\n");
    }
    motor(&mut page, report);
    gains(&mut page, report);
    promised(&mut page, report);
    record(&mut page, report);
    page.push_str("</body></html>\n");
    page
}

fn motor(page: &mut String, report: &Report) {
    let mut rows: Vec<[String; 3]> = Vec::new();
    let mut row = |name: &str, value: String, doubt: String| rows.push([name.to_owned(), value, doubt]);
    if let Some(qpps) = report.qpps {
        row("Speed at full duty (QPPS)", format!("{qpps:.0} counts/s"), String::new());
    }
    if let Some(fit) = &report.fit {
        let share = |sd: f64| format!("± {:.1} %", 200.0 * sd);
        row("Speed per duty", format!("{:.0} counts/s", fit.model.gain_counts_per_s), share(fit.sd_ln_gain));
        let tau = fit.time_constant();
        row("Time constant", format!("{:.1} ms", 1e3 * tau.seconds), share(tau.sd_ln));
        let friction = format!("{:.1} % duty", 100.0 * fit.model.coulomb_duty);
        row("Friction", friction, format!("± {:.1} % duty", 200.0 * fit.sd_coulomb));
    }
    if let Some(lag) = &report.lag {
        let total_s = lag.lag.total_s(report.request.law.tick_s());
        let (low, high) = (1e3 * lag.interval_s.0, 1e3 * lag.interval_s.1);
        row("Lag of the loop", format!("{:.1} ms", 1e3 * total_s), format!("{low:.1} to {high:.1} ms"));
    }
    rows.extend(experiments(report));
    if let Some(winding) = &report.winding {
        let interval = format!("± {:.3} ohm", winding.interval_ohms);
        rows.push(["Resistance R".to_owned(), format!("{:.3} ohm", winding.ohms), interval]);
    }
    table(page, "The motor", &["", "value", "interval"], &rows);
}

fn gains(page: &mut String, report: &Report) {
    let Some(before) = report.before else { return };
    let rows: Vec<Vec<String>> =
        report.request.law.rows(&before.held, &report.proposed).into_iter().map(|row| row.to_vec()).collect();
    table(page, "Gains", &["", "before", "proposed", "on the wire"], &rows);
}

/// The ranges of what they promise.
fn likely(report: &Report) -> Vec<[String; 3]> {
    let Some(Promise { ms, settling_s }) = report.promise() else { return Vec::new() };
    let row =
        |name: &str, range: String| [name.to_owned(), range, "by what is known of motor and lag".to_owned()];
    vec![
        row("sensitivity Ms, likely", format!("{:.2} to {:.2}", ms.0, ms.1)),
        row("settling, likely", format!("{:.0} to {:.0} ms", 1e3 * settling_s.0, 1e3 * settling_s.1)),
    ]
}

/// What the proposed gains promise on the model, and what the rules would.
fn promised(page: &mut String, report: &Report) {
    let (Some(task), Some(design)) = (report.task, report.design) else { return };
    let frequency = frequency_response(&task, &design.gains);
    let margins = StabilityMargins::of(&frequency);
    let ahead = forecast(&task, &design.gains);
    let mut rows: Vec<[String; 3]> =
        margins.rows().map(|(name, value, what)| [name.to_owned(), value, what.to_owned()]).to_vec();
    rows.push([
        "overshoot".into(),
        format!("{:.0} %", 100.0 * ahead.overshoot),
        "of a step, on the model".into(),
    ]);
    let settling = ahead.settling_s.map_or_else(|| "never".to_owned(), |s| format!("{:.0} ms", 1e3 * s));
    rows.push(["settling".into(), settling, "until a step stays within 5 % (position: 2 %)".into()]);
    rows.extend(likely(report));
    rows.push([
        "duty noise".into(),
        format!("{:.1} %", 100.0 * design.noise_duty),
        "from the rounding of counts".into(),
    ]);
    if let Some(trajectory) = report.trajectory() {
        rows.push([
            "trajectory, speed".into(),
            format!("{:.0} counts/s", trajectory.speed_counts_per_s),
            "the motor follows it with duty to spare".into(),
        ]);
        rows.push([
            "trajectory, acceleration".into(),
            format!("{:.0} counts/s²", trajectory.accel_counts_per_s2),
            "up and down".into(),
        ]);
    }
    table(page, "The loop with these gains", &["", "value", WHAT], &rows);
    load_change(page, report);
    table(page, "Rules on the same model", &RULE_HEAD, &rules(report));
    let replies =
        |of: &[brushwork_tuning::whatif::Reply]| of.iter().map(|reply| (reply.t, reply.value)).collect();
    let up = if design.gains.position.is_some() { "counts" } else { "counts/s" };
    let plot = |title, across, up, is_logarithmic, curves| Plot {
        title,
        across,
        up,
        is_logarithmic,
        limits: None,
        curves,
    };
    svg(
        page,
        &plot(
            "Step response on the model",
            "s",
            up,
            false,
            vec![
                Curve { name: "after a step", points: replies(&ahead.after_step) },
                Curve { name: "after a load of 15 %", points: replies(&ahead.after_load) },
            ],
        ),
    );
    let over_hz =
        |of: &dyn Fn(&LoopPoint) -> f64| frequency.iter().map(|point| (point.hz, of(point))).collect();
    svg(
        page,
        &plot(
            "Gain of the open loop",
            "Hz",
            "dB",
            true,
            vec![Curve { name: "gain", points: over_hz(&LoopPoint::gain_db) }],
        ),
    );
    svg(
        page,
        &plot(
            "Phase of the open loop",
            "Hz",
            "deg",
            true,
            vec![Curve { name: "phase", points: unwrapped(over_hz(&LoopPoint::phase_deg)) }],
        ),
    );
    svg(
        page,
        &plot(
            "Sensitivity",
            "Hz",
            "",
            true,
            vec![Curve { name: "|S|", points: over_hz(&LoopPoint::sensitivity) }],
        ),
    );
    let nyquist = frequency
        .iter()
        .map(|point| point.open)
        .filter(|(re, im)| re.abs() < 4.0 && im.abs() < 4.0)
        .collect();
    // A mark for the point -1, round the loop's curve.
    let critical = vec![(-1.03, 0.0), (-0.97, 0.0), (-1.0, 0.0), (-1.0, -0.06), (-1.0, 0.06)];
    let curves =
        vec![Curve { name: "open loop", points: nyquist }, Curve { name: "point -1", points: critical }];
    svg(
        page,
        &Plot { limits: Some((-3.0, 1.0)), ..plot("Nyquist", "real part", "imaginary part", false, curves) },
    );
}

/// What change of its load the loop stands.
fn load_change(page: &mut String, report: &Report) {
    let Some(stood) = LoadChange::of_run(report) else { return };
    let rows: Vec<[String; 3]> =
        stood.rows().into_iter().map(|(name, value, what)| [name.to_owned(), value, what]).collect();
    table(page, "What change of load it stands", &["", "value", WHAT], &rows);
    let rows: Vec<[String; 5]> = stood.changed.iter().map(Changed::cells).collect();
    let mut heads = HEADS;
    heads[0] = "";
    table(page, "The same step under other loads", &heads, &rows);
}

/// Degrees without the jumps of a whole turn.
fn unwrapped(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut last: Option<f64> = None;
    for (_, degrees) in &mut points {
        if let Some(last) = last {
            *degrees -= 360.0 * ((*degrees - last) / 360.0).round();
        }
        last = degrees.is_finite().then_some(*degrees).or(last);
    }
    points
}

/// The run as it was measured.
fn record(page: &mut String, report: &Report) {
    let trace = Trace::of(report.request.guard.motor, &report.record);
    let speeds = Curve { name: "speed", points: trace.speeds(SPEED_OVER_S) };
    if speeds.points.len() < 2 {
        return;
    }
    page.push_str("<h2>The run as it was measured</h2>\n");
    let counts = trace.points.iter().map(|point| (point.t, point.counts)).collect();
    for (title, up, curve) in
        [("Speed", "counts/s", speeds), ("Position", "counts", Curve { name: "position", points: counts })]
    {
        svg(page, &Plot { title, across: "s", up, is_logarithmic: false, limits: None, curves: vec![curve] });
    }
}

fn table<R: AsRef<[String]>>(page: &mut String, title: &str, heads: &[&str], rows: &[R]) {
    if rows.is_empty() {
        return;
    }
    let _ = write!(page, "<h2>{title}</h2>\n<table><tr>");
    // Words stand at the left, figures at the right.
    let class = |column: usize| match heads.get(column) {
        Some(&("" | WHAT)) | None => "",
        Some(_) => " class=\"n\"",
    };
    for (column, head) in heads.iter().enumerate() {
        let _ = write!(page, "<th{}>{}</th>", class(column), escaped(head));
    }
    page.push_str("</tr>\n");
    for row in rows {
        page.push_str("<tr>");
        for (column, cell) in row.as_ref().iter().enumerate() {
            let _ = write!(page, "<td{}>{}</td>", class(column), escaped(cell));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</table>\n");
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Draws a plot. One without two points to a curve is left out.
fn svg(page: &mut String, plot: &Plot) {
    let x_of = |x: f64| if plot.is_logarithmic { x.log10() } else { x };
    let all = || {
        plot.curves
            .iter()
            .flat_map(|curve| &curve.points)
            .filter(|(x, y)| x_of(*x).is_finite() && y.is_finite())
    };
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let across = range(&mut all().map(|(x, _)| x_of(*x)));
    let up = plot.limits.unwrap_or_else(|| range(&mut all().map(|(_, y)| *y)));
    if !across.0.is_finite() || across.1 <= across.0 || !up.0.is_finite() {
        return;
    }
    let up = if up.1 > up.0 { up } else { (up.0 - 1.0, up.1 + 1.0) };
    let (width, height) = (SIZE.0 - MARGIN.0, SIZE.1 - MARGIN.1);
    let place = |x: f64, y: f64| {
        (
            MARGIN.0 + width * (x - across.0) / (across.1 - across.0),
            height - height * (y - up.0) / (up.1 - up.0),
        )
    };
    let _ = write!(
        page,
        "<figure><figcaption>{}{}</figcaption><svg viewBox=\"0 -6 {} {}\" role=\"img\" aria-label=\"{}\">",
        plot.title,
        captions(plot),
        SIZE.0,
        SIZE.1 + 12.0,
        plot.title
    );
    for value in marks(up) {
        let (_, y) = place(across.0, value);
        let _ = write!(
            page,
            "<line x1=\"{:.1}\" x2=\"{:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#e4e4e4\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            MARGIN.0,
            SIZE.0,
            MARGIN.0 - 6.0,
            y + 4.0,
            figure(value)
        );
    }
    for value in marks(across) {
        let (x, _) = place(value, up.0);
        let shown = if plot.is_logarithmic { 10f64.powf(value) } else { value };
        let _ = write!(
            page,
            "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"0\" y2=\"{height:.1}\" stroke=\"#e4e4e4\"/><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            height + 15.0,
            figure(shown)
        );
    }
    let _ = write!(
        page,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
        SIZE.0,
        SIZE.1 + 2.0,
        plot.across
    );
    for (number, curve) in plot.curves.iter().enumerate() {
        let colour = COLOURS[number % COLOURS.len()];
        let step = (curve.points.len() / MOST_POINTS).max(1);
        let mut path = String::new();
        for (x, y) in curve.points.iter().step_by(step) {
            let at = x_of(*x);
            if !at.is_finite() || !y.is_finite() {
                continue;
            }
            let (x, y) = place(at, y.clamp(up.0, up.1));
            let _ = write!(path, "{x:.1},{y:.1} ");
        }
        let _ = write!(
            page,
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" points=\"{path}\"/>"
        );
    }
    page.push_str("</svg></figure>\n");
}

/// What stands beside a plot's title: its unit, and the names of several curves in their colours.
fn captions(plot: &Plot) -> String {
    let mut text = if plot.up.is_empty() { String::new() } else { format!(", {}", plot.up) };
    for (curve, colour) in plot.curves.iter().zip(COLOURS).filter(|_| plot.curves.len() > 1) {
        let _ = write!(text, "<span style=\"color:{colour}\">&#9644; {}</span>", curve.name);
    }
    text
}

/// Round values within a range.
fn marks((low, high): (f64, f64)) -> Vec<f64> {
    let rough = (high - low) / LINES;
    let unit = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|times| times * unit)
        .find(|step| *step >= rough)
        .unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    (first..).map(|n| n as f64 * step).take_while(|value| *value <= high + 1e-9 * step).collect()
}

fn figure(value: f64) -> String {
    let digits = if value.abs() >= 100.0 || value == 0.0 {
        0
    } else if value.abs() >= 10.0 {
        1
    } else {
        3
    };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_within_their_range() {
        assert_eq!(marks((0.0, 1.0)), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0].map(|x: f64| (x / 0.2).round() * 0.2));
        assert!(marks((-37.0, 12.0)).iter().all(|mark| mark % 10.0 == 0.0));
        assert_eq!([figure(0.25), figure(1200.0), figure(12.5), figure(0.0)], ["0.25", "1200", "12.5", "0"]);
    }

    #[test]
    fn a_phase_that_goes_round_is_drawn_without_a_jump() {
        let wrapped =
            vec![(1.0, -90.0), (2.0, -170.0), (3.0, 170.0), (4.0, 80.0), (5.0, -10.0), (6.0, f64::NAN)];
        let degrees: Vec<f64> = unwrapped(wrapped).into_iter().take(5).map(|(_, degrees)| degrees).collect();
        assert_eq!(degrees, [-90.0, -170.0, -190.0, -280.0, -370.0]);
    }

    #[test]
    fn what_a_sentence_says_is_no_markup() {
        assert_eq!(escaped("a < b & c"), "a &lt; b &amp; c");
    }

    #[test]
    fn a_plot_without_points_is_left_out() {
        let mut page = String::new();
        let plot = |points| Plot {
            title: "t",
            across: "s",
            up: "",
            is_logarithmic: true,
            limits: None,
            curves: vec![Curve { name: "c", points }],
        };
        svg(&mut page, &plot(vec![(1.0, f64::NAN)]));
        assert_eq!(page, "");
        svg(&mut page, &plot(vec![(1.0, 2.0), (10.0, 3.0)]));
        assert!(page.starts_with("<figure>") && page.contains("polyline"));
    }
}
