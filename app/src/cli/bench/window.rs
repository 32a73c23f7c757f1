//! The window with an hour of 16 channels at 100 Hz: what the graph costs in a frame, against plain lines of the same data.

use std::time::{Duration, Instant};

use egui_plot::{Line, Plot, PlotPoint, PlotPoints};

use super::Effort;
use super::figure::{Figure, Target};
use super::headless::Headless;
use super::spread::{median, percentile};
use crate::gui::App;
use crate::gui::graph::{LiveGraph, plot};
use crate::gui::model::graph_channels;
use crate::gui::model::screen::Screen;
use crate::gui::opener::real_parts;
use crate::gui::theme;

const CHANNELS: usize = 16;
const ROWS: u32 = 360_000;
const INTERVAL_S: f64 = 0.01;
const SPAN_S: f64 = 3600.0;
/// Part of the time of plain lines that the graph may take.
const REQUIRED_PART: f64 = 0.05;
const REQUIRED_MEGABYTES: f64 = 100.0;
/// Frames before the first that counts.
const WARM_UP: usize = 3;
const CONNECT_LIMIT: Duration = Duration::from_secs(10);

/// Graph against plain lines, memory, and the whole window.
pub fn measure(effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = graph_figures(effort);
    figures.push(window_figure(effort)?);
    Ok(figures)
}

fn graph_figures(effort: Effort) -> Vec<Figure> {
    let mut graph = full_graph(CHANNELS, 0.0);
    let lines = plain_lines(&graph);
    let headless = Headless::new();
    theme::install(&headless.ctx);
    let (mut ours_ms, mut plain_ms) = (Vec::new(), Vec::new());
    let mut row = ROWS;
    // Both by turns, so that whatever else the machine does falls on both.
    for turn in 0..WARM_UP + effort.frames.div_ceil(10) {
        let plain = headless.frame(Vec::new(), |ui| plain_ui(ui, &lines));
        let ours = (0..10).map(|_| {
            row += 1;
            headless.frame(Vec::new(), |ui| {
                graph.push(f64::from(row) * INTERVAL_S, &values(row, CHANNELS));
                plot::plot_ui(ui, &graph);
            })
        });
        let ours: Vec<f64> = ours.map(in_ms).collect();
        if turn >= WARM_UP {
            ours_ms.extend(ours);
            plain_ms.push(in_ms(plain));
        }
    }
    let (ours, plain) = (median(&ours_ms), median(&plain_ms));
    let megabytes = graph.history().bytes() as f64 / 1e6;
    let figure = |name, value, unit, decimals| Figure::new("window", name, value, unit, decimals);
    let note = format!("1280x800, tessellation included, p99 {:.2} ms", percentile(&ours_ms, 0.99));
    vec![
        figure("graph part of a frame", ours, "ms", 2).note(note),
        figure("plain egui_plot lines", plain, "ms", 1).note(format!("{} frames", plain_ms.len())),
        figure("graph over plain lines", ours / plain, "", 4)
            .target(Target::AtMost(REQUIRED_PART))
            .note(format!("{:.0} times less", plain / ours)),
        figure("memory of the history", megabytes, "MB", 1)
            .target(Target::AtMost(REQUIRED_MEGABYTES))
            .note("an hour of 16 channels at 100 Hz"),
    ]
}

/// The whole window, connected to a simulated controller, on the screen with the graph.
fn window_figure(effort: Effort) -> Result<Figure, String> {
    let headless = Headless::new();
    let mut app = App::new(&headless.ctx, real_parts(&headless.ctx));
    app.open("sim:mcp266");
    let deadline = Instant::now() + CONNECT_LIMIT;
    while !app.model.is_connected() {
        if Instant::now() > deadline {
            return Err("the window did not connect to its simulated controller".to_owned());
        }
        headless.shapes(Vec::new(), |ui| app.contents(ui));
        std::thread::sleep(Duration::from_millis(20));
    }
    let now_s = app.device().map_or(0.0, |device| device.now().as_secs_f64());
    app.model.graph = full_graph(app.model.graph.channels.len(), now_s - SPAN_S);
    app.model.screen = Screen::Pwm;
    let mut times_ms = Vec::new();
    for turn in 0..WARM_UP + effort.frames {
        let took = headless.frame(Vec::new(), |ui| app.contents(ui));
        if turn >= WARM_UP {
            times_ms.push(in_ms(took));
        }
    }
    let note = format!(
        "connected, {} with {CHANNELS} lines of an hour, without painting; p99 {:.2} ms",
        Screen::Pwm.title(),
        percentile(&times_ms, 0.99)
    );
    Ok(Figure::new("window", "whole window, a frame", median(&times_ms), "ms", 2).note(note))
}

/// A graph of an hour that begins at `start_s`; the first 16 channels are shown.
fn full_graph(channels: usize, start_s: f64) -> LiveGraph {
    let mut infos: Vec<_> = graph_channels().into_iter().take(channels).collect();
    infos.iter_mut().enumerate().for_each(|(index, info)| info.shown = index < CHANNELS);
    let mut graph = LiveGraph::new(infos, INTERVAL_S);
    for row in 0..=ROWS {
        graph.push(start_s + f64::from(row) * INTERVAL_S, &values(row, channels));
    }
    graph.span_s = SPAN_S;
    graph
}

/// The same data as plain lines would keep them.
fn plain_lines(graph: &LiveGraph) -> Vec<Vec<PlotPoint>> {
    let line = |channel| {
        let points =
            (0..=ROWS).map(|row| PlotPoint::new(f64::from(row) * INTERVAL_S, values(row, CHANNELS)[channel]));
        points.collect()
    };
    (0..graph.channels.len()).map(line).collect()
}

fn plain_ui(ui: &mut egui::Ui, lines: &[Vec<PlotPoint>]) {
    Plot::new("plain lines").show(ui, |plot| {
        for (index, points) in lines.iter().enumerate() {
            plot.line(Line::new(format!("channel {index}"), PlotPoints::Borrowed(points)));
        }
    });
}

/// A slow wave, a quick one and noise, another for each channel, at most about 100.
fn values(row: u32, channels: usize) -> Vec<f64> {
    let time_s = f64::from(row) * INTERVAL_S;
    let value = |channel: usize| {
        let channel = channel as f64;
        let noise = f64::from(row.wrapping_mul(2_654_435_761).rotate_left(7) % 1000) / 100.0;
        60.0 * (time_s / (100.0 + channel)).sin() + 25.0 * (time_s * (1.0 + 0.1 * channel)).sin() + noise
    };
    (0..channels).map(value).collect()
}

fn in_ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
