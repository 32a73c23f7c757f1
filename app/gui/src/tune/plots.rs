//! The pictures of tuning: what goes on, what was measured over what was predicted, steps, load steps, and the loop over frequency.

use brushwork_core::tune::law::Trace;
use brushwork_tuning::experiment_guard::{Drive, Input};
use brushwork_tuning::trace::{Predicted, Stretch};
use brushwork_tuning::whatif::{LoopPoint, Reply};
use egui::{Color32, Ui, vec2};

use super::chart::{Axis, Line, Look, chart_ui};
use super::looked_at::{Kind, View};
use super::model::Panel;
use super::run::{Run, SPEED_OVER_S, Shown};
use super::which::Loop;
use crate::messages::NameMessage;
use crate::theme::Palette;
use crate::tune::messages::ChartMessage;

/// Below this the open loop has no phase to speak of, dB.
const LEAST_GAIN_DB: f64 = -60.0;
/// The time that a live picture shows at least, s, and the steps in which it grows.
const LIVE_S: f64 = 6.0;
/// Share of the height that the duty gets.
const DUTY_SHARE: f32 = 0.3;
/// Least height of a picture that has the duty under it.
const ROOM_FOR_DUTY: f32 = 180.0;

/// The picture of a run that goes on.
pub fn live_ui(ui: &mut Ui, trace: &Trace, which: Loop, has_duty: bool) {
    let end_s = (trace.end_s() / 3.0).ceil() * 3.0;
    record_ui(
        ui,
        trace,
        (which, has_duty),
        end_s.max(LIVE_S),
        "The motor is about to turn a little, to check its wiring.",
    );
}

/// The record of a run from its start to `end_s`.
fn record_ui(ui: &mut Ui, trace: &Trace, (which, has_duty): (Loop, bool), end_s: f64, empty: &str) {
    let palette = Palette::of(ui);
    let x = Axis::new("time", "s", 0.0, end_s);
    let room = ui.available_size();
    let shares = match (has_duty, room.y < ROOM_FOR_DUTY) {
        // A controller that takes no duty tells neither that nor a current.
        (false, _) => [1.0, 0.0, 0.0],
        (true, true) => [0.6, 0.0, 0.4],
        (true, false) => [0.5, 0.25, 0.25],
    };
    let heights = shares.map(|share: f32| (room.y - 16.0) * share);
    let mut main = match which {
        Loop::Velocity => vec![line("speed", trace.speeds(SPEED_OVER_S), palette.traces[2], Look::Solid)],
        Loop::Position => vec![line("position", places(trace, None), palette.traces[3], Look::Solid)],
    };
    let (name, unit) = if which == Loop::Velocity { ("speed", "counts/s") } else { ("position", "counts") };
    // The scale is that of what the motor did: the law probe commands speeds that no motor reaches.
    let y = around(name, unit, &main);
    let whole = Stretch { from_s: 0.0, to_s: trace.end_s(), is_position: which == Loop::Position };
    if main.iter().any(|line| !line.points.is_empty()) {
        main.insert(0, line("setpoint", setpoints(trace, &whole), palette.traces[0], Look::Dashed));
    }
    let label = ChartMessage::Live { name }.to_string();
    chart_ui(ui, &label, (x, y), &main, empty, vec2(room.x, heights[0]));
    let duty = [line("duty", duties(trace, None), palette.traces[1], Look::Solid)];
    let y = Axis::new("duty", "%", -110.0, 110.0);
    chart_ui(ui, "Live duty of the run", (x, y), &duty, "", vec2(room.x, heights[1]));
    let amps = trace.points.iter().filter_map(|point| point.amps.map(|amps| (point.t, amps)));
    let current = [line("current", amps.collect(), palette.traces[4], Look::Solid)];
    let y = Axis::around("current", "A", current[0].points.iter().map(|p| p[1]).chain([0.0, 0.5]));
    chart_ui(ui, "Live current of the run", (x, y), &current, "", vec2(room.x, heights[2]));
}

/// The picture of a result, with what chooses it.
pub fn result_ui(ui: &mut Ui, panel: &Panel, view: &mut View, which: Loop, has_duty: bool) {
    if panel.run().is_some_and(Run::is_refused) {
        ui.strong("What was seen");
    } else {
        kinds_ui(ui, view);
    }
    let Some(run) = panel.run() else {
        let empty = "Nothing tuned yet: predictions and measurements of a run are drawn here.";
        let size = ui.available_size();
        let axes = (Axis::new("time", "s", 0.0, 1.0), Axis::new("", which.unit(), 0.0, 1.0));
        return chart_ui(ui, "Result of a run", axes, &[], empty, size);
    };
    if let Some(seen) = &run.seen {
        let empty = "Nothing was measured: it was refused before the motor was driven.";
        return record_ui(ui, seen, (which, has_duty), (1.05 * seen.end_s()).max(0.5), empty);
    }
    match view.kind {
        Kind::Measured => measured_ui(ui, run, which, has_duty),
        Kind::Step => replies_ui(ui, panel, run, (which, has_duty), false),
        Kind::Load => replies_ui(ui, panel, run, (which, has_duty), true),
        Kind::Bode => bode_ui(ui, panel, run),
        Kind::Nyquist => nyquist_ui(ui, panel, run),
        Kind::Sensitivity => sensitivity_ui(ui, panel, run),
    }
}

fn kinds_ui(ui: &mut Ui, view: &mut View) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        for kind in Kind::ALL {
            let label = ui.selectable_label(view.kind == kind, kind.title());
            if label.on_hover_text(kind.hint()).clicked() {
                view.kind = kind;
            }
        }
    });
}

/// What was tried on the machine, over what the model predicts for the same commands: with the gains that were tried, and with those
/// that are considered where they are others.
fn measured_ui(ui: &mut Ui, run: &Run, which: Loop, has_duty: bool) {
    let palette = Palette::of(ui);
    let size = ui.available_size();
    let Some(tried) = run.tried.as_ref() else {
        let axes = (Axis::new("time", "s", 0.0, 1.0), Axis::new("", which.unit(), 0.0, 1.0));
        let empty = "No gains were tried on the machine in this run. Verify tries the proposed ones.";
        return chart_ui(ui, "Measured response", axes, &[], empty, size);
    };
    let (trace, stretch) = (&tried.trace, &tried.stretch);
    let from_s = stretch.from_s;
    let (name, unit) = if stretch.is_position { ("position", "counts") } else { ("speed", "counts/s") };
    let color = if stretch.is_position { palette.traces[3] } else { palette.traces[2] };
    let (mut main, mut duty) = (Vec::new(), Vec::new());
    let mut predict = |course: &[Predicted], name: &str, look: Look| {
        let value = |p: &Predicted| if stretch.is_position { p.counts } else { p.speed };
        let values = course.iter().map(|p| (p.t - from_s, value(p)));
        main.push(line(name, values.collect(), palette.accent, look));
        let duties = course.iter().map(|p| (p.t - from_s, 100.0 * p.duty));
        duty.push(line(name, duties.collect(), palette.accent, look));
    };
    predict(&tried.predicted, "predicted", Look::Under);
    predict(&tried.considered, "with the gains considered", Look::Dashed);
    main.push(line("setpoint", shifted(setpoints(trace, stretch), from_s), palette.traces[0], Look::Dashed));
    let values = if stretch.is_position { places(trace, Some(stretch)) } else { speeds(trace, stretch) };
    main.push(line("measured", shifted(values, from_s), color, Look::Solid));
    let duties = shifted(duties(trace, Some(stretch)), from_s);
    duty.push(line("measured", duties, palette.traces[1], Look::Solid));
    let x = Axis::new("time", "s", 0.0, (stretch.to_s - from_s).max(0.1));
    let [upper, lower] = heights(size.y, has_duty);
    let label = ChartMessage::Measured { name }.to_string();
    chart_ui(ui, &label, (x, around(name, unit, &main)), &main, "", vec2(size.x, upper));
    let label = "Measured duty over the predicted one";
    chart_ui(ui, label, (x, around("duty", "%", &duty)), &duty, "", vec2(size.x, lower));
}

/// Steps or load steps on the model: the considered gains, the present ones, and earlier runs.
fn replies_ui(ui: &mut Ui, panel: &Panel, run: &Run, (which, has_duty): (Loop, bool), load: bool) {
    let palette = Palette::of(ui);
    let size = ui.available_size();
    let picked = |shown: &Shown| -> Vec<Reply> {
        if load { shown.forecast.after_load.clone() } else { shown.forecast.after_step.clone() }
    };
    let (mut main, mut duty) = (Vec::new(), Vec::new());
    for (name, shown, color, look) in lines_of(panel, run, palette) {
        let replies = picked(shown);
        main.push(line(&name, replies.iter().map(|r| (r.t, r.value)).collect(), color, look));
        duty.push(line("", replies.iter().map(|r| (r.t, 100.0 * r.duty)).collect(), color, look));
    }
    let x_end = main.iter().filter_map(|line| line.points.last().map(|p| p[0])).fold(0.1, f64::max);
    let x = Axis::new("time", "s", 0.0, x_end);
    let [upper, lower] = heights(size.y, has_duty);
    let name = if which == Loop::Velocity { "speed" } else { "position" };
    let label = if load {
        ChartMessage::LoadStep { name }.to_string()
    } else {
        ChartMessage::Step { name }.to_string()
    };
    let empty = "There is no model yet: tune first.";
    let y = around(name, which.unit(), &main);
    if let Some(shown) = &run.shown {
        main.insert(0, level(palette, x, shown.forecast.step.1, "setpoint"));
    }
    chart_ui(ui, &label, (x, y), &main, empty, vec2(size.x, upper));
    chart_ui(ui, "Predicted duty", (x, around("duty", "%", &duty)), &duty, "", vec2(size.x, lower));
}

fn bode_ui(ui: &mut Ui, panel: &Panel, run: &Run) {
    let palette = Palette::of(ui);
    let size = ui.available_size();
    let (mut gain, mut phase) = (Vec::new(), Vec::new());
    let mut top_hz: f64 = 1.0;
    for (name, shown, color, look) in lines_of(panel, run, palette) {
        top_hz = shown.frequency.last().map_or(top_hz, |point| point.hz.max(top_hz));
        gain.push(line(&name, over_frequency(shown, LoopPoint::gain_db), color, look));
        phase.push(line("", unwrapped_phase(shown), color, look));
    }
    let x = Axis::new("frequency", "Hz", (top_hz * 2e-4).max(0.01), top_hz).log();
    let half = vec2(size.x, (size.y - 6.0) / 2.0);
    gain.insert(0, level(palette, x, 0.0, "0 dB"));
    phase.insert(0, level(palette, x, -180.0, "-180°"));
    let y = Axis::new("gain", "dB", LEAST_GAIN_DB, 60.0);
    let empty = "There is no model yet: tune first.";
    chart_ui(ui, "Bode gain of the open loop", (x, y), &gain, empty, half);
    let y = Axis::new("phase", "degrees", -270.0, 0.0);
    chart_ui(ui, "Bode phase of the open loop", (x, y), &phase, "", half);
}

fn nyquist_ui(ui: &mut Ui, panel: &Panel, run: &Run) {
    let palette = Palette::of(ui);
    let goal = run.task().map_or(1.6, |task| task.goal.ms);
    // The curve keeps out of the circle about -1 with the radius 1 / Ms.
    let mut lines =
        vec![circle(palette, goal.recip(), &format!("Ms {goal:.2}")), circle(palette, 0.02, "-1")];
    lines.extend(lines_of(panel, run, palette).map(|(name, shown, color, look)| {
        let points = shown.frequency.iter().map(|point| point.open);
        line(&name, points.filter(|open| open.0.hypot(open.1) < 60.0).collect(), color, look)
    }));
    let axes = (Axis::new("real", "", -2.2, 0.8), Axis::new("imaginary", "", -1.6, 1.0));
    let (name, empty) = ("Nyquist plot with the Ms circle", "There is no model yet: tune first.");
    chart_ui(ui, name, axes, &lines, empty, ui.available_size());
}

fn sensitivity_ui(ui: &mut Ui, panel: &Panel, run: &Run) {
    let palette = Palette::of(ui);
    let mut lines: Vec<Line> = lines_of(panel, run, palette)
        .map(|(name, shown, color, look)| {
            line(&name, over_frequency(shown, LoopPoint::sensitivity), color, look)
        })
        .collect();
    let top_hz = lines.iter().filter_map(|line| line.points.last().map(|p| p[0])).fold(1.0, f64::max);
    let goal = run.task().map_or(1.6, |task| task.goal.ms);
    let word = ChartMessage::Goal { goal }.to_string();
    let top = lines.iter().flat_map(|line| &line.points).map(|p| p[1]).fold(goal, f64::max).min(6.0);
    let x = Axis::new("frequency", "Hz", (top_hz * 2e-4).max(0.01), top_hz).log();
    let y = Axis::new("sensitivity |S|", "", 0.0, (1.15 * top).max(1.8));
    let empty = "There is no model yet: tune first.";
    lines.splice(0..0, [level(palette, x, goal, &word), level(palette, x, 1.0, "")]);
    chart_ui(ui, "Sensitivity over frequency", (x, y), &lines, empty, ui.available_size());
}

/// Whose gains are drawn: earlier runs first, so that they lie below; then the present ones, then those that are considered.
fn lines_of<'a>(
    panel: &'a Panel,
    run: &'a Run,
    palette: &'a Palette,
) -> impl Iterator<Item = (String, &'a Shown, Color32, Look)> {
    let others = panel.runs.iter().filter(move |other| other.number != run.number && other.is_overlaid);
    let earlier = others.filter_map(|other| {
        let color = other.color(palette);
        Some((
            NameMessage::RunLine { number: other.number }.to_string(),
            other.shown.as_ref()?,
            color,
            Look::Dots,
        ))
    });
    let current = run.current().map(|shown| ("current".to_owned(), shown, palette.weak_text, Look::Dashed));
    let shown = run.shown.as_ref().map(|shown| ("proposed".to_owned(), shown, palette.accent, Look::Solid));
    earlier.chain(current).chain(shown)
}

fn over_frequency(shown: &Shown, value: impl Fn(&LoopPoint) -> f64) -> Vec<(f64, f64)> {
    shown.frequency.iter().map(|point| (point.hz, value(point))).collect()
}

/// Phase without jumps, degrees.
fn unwrapped_phase(shown: &Shown) -> Vec<(f64, f64)> {
    let mut before: Option<f64> = None;
    let mut phases = Vec::with_capacity(shown.frequency.len());
    // Next to nothing has no phase: at half the tick's rate the loop is real.
    for point in shown.frequency.iter().filter(|point| point.gain_db() > LEAST_GAIN_DB) {
        let mut phase = point.phase_deg();
        if phase > 0.0 && before.is_none() {
            phase -= 360.0;
        }
        if let Some(before) = before {
            phase -= 360.0 * ((phase - before) / 360.0).round();
        }
        before = Some(phase);
        phases.push((point.hz, phase));
    }
    phases
}

/// Heights of a picture and of the duty under it, which goes where there is no room for both, or where the controller takes none.
fn heights(height: f32, has_duty: bool) -> [f32; 2] {
    if height < ROOM_FOR_DUTY || !has_duty {
        return [height, 0.0];
    }
    let lower = (height * DUTY_SHARE).max(70.0);
    [height - lower - 6.0, lower]
}

fn line(name: &str, points: Vec<(f64, f64)>, color: Color32, look: Look) -> Line {
    let points = points.into_iter().map(|(x, y)| [x, y]).collect();
    Line { name: name.to_owned(), points, color, look }
}

fn around(name: &'static str, unit: &'static str, lines: &[Line]) -> Axis {
    Axis::around(name, unit, lines.iter().flat_map(|line| &line.points).map(|point| point[1]))
}

/// A line across.
fn level(palette: &Palette, x: Axis, value: f64, word: &str) -> Line {
    line(word, vec![(x.low, value), (x.high, value)], palette.warning, Look::Mark)
}

/// A circle about -1.
fn circle(palette: &Palette, radius: f64, word: &str) -> Line {
    let around = (0..=72).map(|n| (f64::from(n) * std::f64::consts::TAU / 72.0).sin_cos());
    let points = around.map(|(sin, cos)| (radius * sin - 1.0, radius * cos));
    line(word, points.collect(), palette.warning, Look::Mark)
}

fn shifted(points: Vec<(f64, f64)>, from_s: f64) -> Vec<(f64, f64)> {
    points.into_iter().map(|(t, value)| (t - from_s, value)).collect()
}

fn inside(t: f64, stretch: Option<&Stretch>) -> bool {
    stretch.is_none_or(|stretch| t >= stretch.from_s && t <= stretch.to_s)
}

fn speeds(trace: &Trace, stretch: &Stretch) -> Vec<(f64, f64)> {
    trace.speeds(SPEED_OVER_S).into_iter().filter(|(t, _)| inside(*t, Some(stretch))).collect()
}

fn places(trace: &Trace, stretch: Option<&Stretch>) -> Vec<(f64, f64)> {
    let within = trace.points.iter().filter(|point| inside(point.t, stretch));
    within.map(|point| (point.t, point.counts)).collect()
}

/// Duty in percent as it was read; where it was not, as it was commanded.
fn duties(trace: &Trace, stretch: Option<&Stretch>) -> Vec<(f64, f64)> {
    let read = trace.points.iter().filter(|point| inside(point.t, stretch));
    let mut duties: Vec<(f64, f64)> =
        read.filter_map(|point| point.duty.map(|duty| (point.t, 100.0 * duty))).collect();
    let mut before = 0.0;
    for Drive { t, input } in &trace.drives {
        if let Input::Duty(duty) = input
            && inside(*t, stretch)
        {
            duties.push((t - 1e-4, 100.0 * before));
            duties.push((*t, 100.0 * duty));
            before = *duty;
        }
    }
    duties.sort_by(|a, b| a.0.total_cmp(&b.0));
    duties
}

/// What the loop was told, as a staircase.
fn setpoints(trace: &Trace, stretch: &Stretch) -> Vec<(f64, f64)> {
    let mut stairs: Vec<(f64, f64)> = Vec::new();
    for drive in trace.drives.iter().filter(|drive| inside(drive.t, Some(stretch))) {
        let value = match (drive.input, stretch.is_position) {
            (Input::Speed(speed), false) => speed,
            (Input::Position(counts, _), true) => counts,
            // A duty ends the line; the next setpoint begins another.
            _ => f64::NAN,
        };
        if let Some(&(_, before)) = stairs.last() {
            stairs.push((drive.t, before));
        }
        stairs.push((drive.t, value));
    }
    if let Some(&(_, last)) = stairs.last() {
        stairs.push((stretch.to_s, last));
    }
    stairs
}
