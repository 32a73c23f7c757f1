//! The window's code without a window: frames of a size, with keys, timed.

use std::time::{Duration, Instant};

use egui::{Context, Event, FullOutput, Key, Modifiers, Pos2, RawInput, Rect, Ui, vec2};

/// The size at which everything is measured.
const SIZE: egui::Vec2 = vec2(1280.0, 800.0);

/// A context that draws into nothing.
pub struct Headless {
    /// What the frames are drawn with.
    pub ctx: Context,
    started: Instant,
}

impl Headless {
    /// A context of 1280 by 800 points, a pixel each.
    pub fn new() -> Self {
        Self { ctx: Context::default(), started: Instant::now() }
    }

    /// Draws a frame that heard `events`, and turns it into triangles. Returns how long that took.
    pub fn frame(&self, events: Vec<Event>, draw: impl FnMut(&mut Ui)) -> Duration {
        let begun = Instant::now();
        let mut output = self.run(events, draw);
        let shapes = std::mem::take(&mut output.shapes);
        let triangles = self.ctx.tessellate(shapes, output.pixels_per_point);
        let took = begun.elapsed();
        drop(triangles);
        output.textures_delta.clear();
        took
    }

    /// Draws a frame as far as shapes.
    pub fn shapes(&self, events: Vec<Event>, draw: impl FnMut(&mut Ui)) {
        self.run(events, draw).textures_delta.clear();
    }

    fn run(&self, events: Vec<Event>, draw: impl FnMut(&mut Ui)) -> FullOutput {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, SIZE)),
            time: Some(self.started.elapsed().as_secs_f64()),
            events,
            ..RawInput::default()
        };
        self.ctx.run_ui(input, draw)
    }
}

/// A key going down or up.
pub fn key_event(key: Key, pressed: bool) -> Event {
    Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE }
}
