//! What the graph costs per frame, against plain plot lines of the same data. `brushwork bench window` prints it.
//!
//! Both are drawn into the same window without a display: layout, tessellation and all, but no pixels. Time is the
//! caller's clock, read around each frame.

use std::time::Duration;

use egui::{Context, Pos2, RawInput, Rect, vec2};
use egui_plot::{Line, Plot, PlotPoint, PlotPoints};
use serde::Serialize;

use crate::FAMILIES;
use brushwork_gui::graph::{LiveGraph, plot};
use brushwork_gui::model::channels::graph_channels;
use brushwork_gui::theme;

/// Samples of an hour at 100 Hz.
const ROWS: u32 = 360_000;
const INTERVAL_S: f64 = 0.01;
/// The time that [`hour`] fills.
pub const SPAN_S: f64 = 3600.0;

/// What one way of looking at the data costs in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Pair {
    /// Median time of a frame with the graph.
    pub graph_ms: f64,
    /// Median time of a frame with plain plot lines of the same samples.
    pub plain_ms: f64,
}

impl Pair {
    /// How much of the plain lines' time the graph takes.
    pub fn ratio(&self) -> f64 {
        self.graph_ms / self.plain_ms
    }
}

/// The figures of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GraphCost {
    pub channels: usize,
    pub samples_per_channel: u64,
    /// Memory the samples take.
    pub stored_megabytes: f64,
    /// All of the samples in view, with new ones in each frame.
    pub follow: Pair,
    /// Half of them in view, another half in each frame.
    pub pan: Pair,
    /// More and less of them in view, in turn.
    pub zoom: Pair,
}

/// A stretch of time to look at.
type Window = (f64, f64);

/// Draws an hour of sixteen channels at 100 Hz, as the graph does and as plain lines, `frames` times each: following,
/// panned and zoomed.
///
/// `now` reads a clock.
pub fn graph_cost(frames: usize, mut now: impl FnMut() -> Duration) -> GraphCost {
    const CHANNELS: usize = 16;
    let mut graph = hour(CHANNELS, 0.0);
    let stored_megabytes = graph.bytes() as f64 / 1e6;
    let lines: Vec<Vec<PlotPoint>> = (0..CHANNELS).map(|channel| plain_line(&graph, channel)).collect();
    let mut looked_at = |at: fn(usize) -> Window, follow: bool| {
        let plain_ms = median_ms(frames, &mut now, |ui, frame| plain_ui(ui, &lines, at(frame)));
        // Each frame brings the samples of a tenth of a second, as in the window.
        let graph_ms = median_ms(frames, &mut now, |ui, frame| {
            let mut next_s = graph.live.newest_s();
            for _ in 0..10 {
                next_s += INTERVAL_S;
                graph.push(next_s, &[next_s.fract() * 100.0; CHANNELS]);
            }
            let (start_s, end_s) = at(frame);
            if !follow {
                graph.live.look_at(start_s, end_s);
            }
            plot::plot_ui(ui, &mut graph);
        });
        Pair { graph_ms, plain_ms }
    };
    let follow = looked_at(|_| (0.0, SPAN_S), true);
    let pan = looked_at(panned, false);
    let zoom = looked_at(zoomed, false);
    let samples_per_channel = u64::from(ROWS);
    GraphCost { channels: CHANNELS, samples_per_channel, stored_megabytes, follow, pan, zoom }
}

/// Half an hour, moved by some seconds per frame to the end and back.
fn panned(frame: usize) -> Window {
    let way_s = SPAN_S / 2.0;
    let moved_s = (frame as f64 * 17.3) % (2.0 * way_s);
    let start_s = if moved_s <= way_s { moved_s } else { 2.0 * way_s - moved_s };
    (start_s, start_s + way_s)
}

/// An hour down to five minutes and back, a twentieth per frame, about a place off the middle.
fn zoomed(frame: usize) -> Window {
    let steps = frame % 98;
    let closer = if steps < 49 { steps } else { 98 - steps };
    let span_s = SPAN_S * 0.95f64.powi(closer as i32);
    let start_s = 1500.0 * (1.0 - span_s / SPAN_S);
    (start_s, start_s + span_s)
}

fn plain_ui(ui: &mut egui::Ui, lines: &[Vec<PlotPoint>], (start_s, end_s): Window) {
    Plot::new("plain").show(ui, |plot| {
        plot.set_plot_bounds_x(start_s..=end_s);
        for (index, points) in lines.iter().enumerate() {
            plot.line(Line::new(format!("channel {index}"), PlotPoints::Borrowed(points)));
        }
    });
}

/// An hour from `start_s` on: noise on slow waves, so that no two columns are alike. All channels are shown.
pub fn hour(channels: usize, start_s: f64) -> LiveGraph {
    let mut infos = graph_channels(FAMILIES[0].window.channels());
    infos.truncate(channels);
    infos.iter_mut().for_each(|info| info.shown = true);
    let mut graph = LiveGraph::new(infos, INTERVAL_S);
    graph.live.set_span_s(SPAN_S);
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
    let history = &graph.live.track.history;
    let point = |row| PlotPoint::new(history.time_s(row), history.channel(channel).value(row));
    history.rows().map(point).collect()
}

/// The median time of a frame: one pass of egui and its tessellation.
fn median_ms(
    frames: usize,
    now: &mut impl FnMut() -> Duration,
    mut draw: impl FnMut(&mut egui::Ui, usize),
) -> f64 {
    let ctx = Context::default();
    theme::install(&ctx);
    let screen = Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 800.0));
    let mut times: Vec<Duration> = Vec::new();
    // The first two frames lay out the axes.
    for frame in 0..frames + 2 {
        let input = RawInput { screen_rect: Some(screen), ..RawInput::default() };
        let began = now();
        let mut output = ctx.run_ui(input, |ui| draw(ui, frame));
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
        for pair in [cost.follow, cost.pan, cost.zoom] {
            assert!(pair.ratio().is_finite() && pair.ratio() > 0.0, "{cost:?}");
        }
    }
}
