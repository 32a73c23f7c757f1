//! What the graph costs per frame, against plain plot lines of the same data. `brushwork bench window` prints it.
//!
//! Both are drawn into the same window without a display: layout, tessellation and all, but no pixels. Time is the
//! caller's clock, read around each frame.

use std::time::Duration;

use egui::{Context, Pos2, RawInput, Rect, vec2};
use egui_plot::{Line, Plot, PlotPoint, PlotPoints};
use serde::Serialize;

use super::graph::{LiveGraph, plot};
use super::model::graph_channels;
use super::theme;

/// Samples of an hour at 100 Hz.
const ROWS: u32 = 360_000;
const INTERVAL_S: f64 = 0.01;
/// The time that [`hour`] fills.
pub const SPAN_S: f64 = 3600.0;

/// The figures of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GraphCost {
    pub channels: usize,
    pub samples_per_channel: u64,
    /// Memory the samples take.
    pub stored_megabytes: f64,
    /// Median time of a frame with the graph, all of the samples in view.
    pub graph_ms: f64,
    /// Median time of a frame with plain plot lines of the same samples.
    pub plain_ms: f64,
    /// How much of the plain lines' time the graph takes.
    pub ratio: f64,
}

/// Draws an hour of sixteen channels at 100 Hz, as the graph does and as plain lines, `frames` times each.
///
/// `now` reads a clock.
pub fn graph_cost(frames: usize, mut now: impl FnMut() -> Duration) -> GraphCost {
    const CHANNELS: usize = 16;
    let mut graph = hour(CHANNELS, 0.0);
    let lines: Vec<Vec<PlotPoint>> = (0..CHANNELS).map(|channel| plain_line(&graph, channel)).collect();
    // Each frame brings the samples of a tenth of a second, as in the window.
    let mut row = ROWS;
    let graph_ms = median_ms(frames, &mut now, |ui| {
        for _ in 0..10 {
            graph.push(f64::from(row) * INTERVAL_S, &[f64::from(row % 100); CHANNELS]);
            row += 1;
        }
        plot::plot_ui(ui, &graph);
    });
    let plain_ms = median_ms(frames, &mut now, |ui| {
        Plot::new("plain").show(ui, |plot| {
            for (index, points) in lines.iter().enumerate() {
                plot.line(Line::new(format!("channel {index}"), PlotPoints::Borrowed(points)));
            }
        });
    });
    GraphCost {
        channels: CHANNELS,
        samples_per_channel: u64::from(ROWS),
        stored_megabytes: graph.bytes() as f64 / 1e6,
        graph_ms,
        plain_ms,
        ratio: graph_ms / plain_ms,
    }
}

/// An hour from `start_s` on: noise on slow waves, so that no two columns are alike. All channels are shown.
pub fn hour(channels: usize, start_s: f64) -> LiveGraph {
    let mut infos = graph_channels();
    infos.truncate(channels);
    infos.iter_mut().for_each(|info| info.shown = true);
    let mut graph = LiveGraph::new(infos, INTERVAL_S);
    graph.span_s = SPAN_S;
    let mut noise: u32 = 1;
    let mut values = vec![0.0; channels];
    for row in 0..ROWS {
        let time_s = f64::from(row) * INTERVAL_S;
        for (channel, value) in values.iter_mut().enumerate() {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let wave = (time_s * 0.01 * (channel + 1) as f64).sin();
            *value = 50.0 * wave + f64::from(noise >> 16) / 65_536.0 * 10.0;
        }
        graph.push(start_s + time_s, &values);
    }
    graph
}

fn plain_line(graph: &LiveGraph, channel: usize) -> Vec<PlotPoint> {
    let history = graph.history();
    let point = |row| PlotPoint::new(history.time_s(row), history.channel(channel).value(row));
    history.rows().map(point).collect()
}

/// The median time of a frame: one pass of egui and its tessellation.
fn median_ms(frames: usize, now: &mut impl FnMut() -> Duration, mut draw: impl FnMut(&mut egui::Ui)) -> f64 {
    let ctx = Context::default();
    theme::install(&ctx);
    let screen = Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 800.0));
    let mut times: Vec<Duration> = Vec::new();
    // The first two frames lay out the axes.
    for frame in 0..frames + 2 {
        let input = RawInput { screen_rect: Some(screen), ..RawInput::default() };
        let began = now();
        let mut output = ctx.run_ui(input, &mut draw);
        let shapes = std::mem::take(&mut output.shapes);
        std::hint::black_box(ctx.tessellate(shapes, output.pixels_per_point));
        let took = now().saturating_sub(began);
        output.textures_delta.clear();
        if frame >= 2 {
            times.push(took);
        }
    }
    times.sort_unstable();
    times.get(times.len() / 2).map_or(0.0, |time| time.as_secs_f64() * 1000.0)
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;

    #[test]
    fn an_hour_of_sixteen_channels_is_kept_within_a_hundred_megabytes() {
        let epoch = Instant::now();
        let cost = graph_cost(1, || epoch.elapsed());
        assert!(cost.stored_megabytes < 100.0, "{cost:?}");
        assert!(cost.ratio.is_finite() && cost.ratio > 0.0, "{cost:?}");
    }
}
