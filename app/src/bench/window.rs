//! The window with an hour of 16 channels at 100 Hz: what the graph costs in a frame, against plain lines of the same data.

use std::time::{Duration, Instant};

use super::figure::{Figure, Target};
use super::graph::{SPAN_S, graph_cost, hour};
use super::headless::Headless;
use super::spread::{median, percentile};
use super::{Effort, editor};
use brushwork_gui::App;
use brushwork_gui::model::screen::Screen;
use brushwork_gui::opener::real_parts;

/// Lines that the whole window draws.
const SHOWN: usize = 16;
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
    figures.extend(editor::measure(effort)?);
    Ok(figures)
}

fn graph_figures(effort: Effort) -> Vec<Figure> {
    let cost = graph_cost(effort.frames, processor_time);
    let figure = |name, value, unit, decimals| Figure::new("window", name, value, unit, decimals);
    let part = |name: &'static str, ratio: f64| {
        figure(name, ratio, "", 4)
            .target(Target::AtMost(REQUIRED_PART))
            .note(format!("{:.0} times less", 1.0 / ratio))
    };
    let data = format!("{} samples of each of {} channels", cost.samples_per_channel, cost.channels);
    vec![
        figure("graph part of a frame", cost.follow.graph_ms, "ms", 2)
            .note("1280x800, tessellation included"),
        figure("plain egui_plot lines", cost.follow.plain_ms, "ms", 1).note("the same data in the same run"),
        part("graph over plain lines", cost.follow.ratio()),
        figure("graph while panned", cost.pan.graph_ms, "ms", 2)
            .note("half an hour in view, moved in each frame"),
        figure("plain lines while panned", cost.pan.plain_ms, "ms", 1).note("the same stretches of time"),
        part("pan over plain lines", cost.pan.ratio()),
        figure("graph while zoomed", cost.zoom.graph_ms, "ms", 2).note("an hour to five minutes and back"),
        figure("plain lines while zoomed", cost.zoom.plain_ms, "ms", 1).note("the same stretches of time"),
        part("zoom over plain lines", cost.zoom.ratio()),
        figure("memory of the history", cost.stored_megabytes, "MB", 1)
            .target(Target::AtMost(REQUIRED_MEGABYTES))
            .note(data),
    ]
}

/// What this thread has had of a processor, so that other programs on the machine do not count.
#[cfg(unix)]
pub fn processor_time() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    // The time of a thread is never below zero.
    Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default()
}

/// The time that passes, where nothing better is known.
#[cfg(not(unix))]
pub fn processor_time() -> Duration {
    use std::sync::OnceLock;
    static EPOCH: OnceLock<Instant> = OnceLock::new();
    EPOCH.get_or_init(Instant::now).elapsed()
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
    let mut graph = hour(app.model.front.graph.live.channels.len(), now_s - SPAN_S);
    graph.live.channels.iter_mut().enumerate().for_each(|(index, channel)| channel.shown = index < SHOWN);
    app.model.front.graph = graph;
    app.model.screen = Screen::Pwm;
    let mut times_ms = Vec::new();
    for turn in 0..WARM_UP + effort.frames {
        let took = headless.frame(Vec::new(), |ui| app.contents(ui));
        if turn >= WARM_UP {
            times_ms.push(in_ms(took));
        }
    }
    let note = format!(
        "connected, {} with {SHOWN} lines of an hour, without painting; p99 {:.2} ms",
        Screen::Pwm.title(),
        percentile(&times_ms, 0.99)
    );
    Ok(Figure::new("window", "whole window, a frame", median(&times_ms), "ms", 2).note(note))
}

fn in_ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
