//! The head of an exported picture: what it is of, when, and which line is which.

use std::time::SystemTime;

use egui::{Align2, Color32, Rect, pos2};

use super::draw::color_of;
use super::{Element, Layer, axes};
use crate::graph::live::LiveGraph;
use crate::graph::messages::PlotMessage;
use crate::graph::scale::DIVISIONS;
use crate::theme::Palette;

const ROW: f32 = 17.0;
const ENTRY_WIDTH: f32 = 232.0;
const MARGIN: f32 = 10.0;

/// What stands above the picture.
#[derive(Clone, Debug)]
pub struct Legend {
    pub title: String,
    entries: Vec<(Color32, String)>,
}

impl Legend {
    /// Of what is looked at; `newest` is the wall's time of the newest sample.
    pub fn of(graph: &LiveGraph, palette: &Palette, newest: SystemTime) -> Self {
        let sheet = graph.sheet();
        let (start_s, end_s) = sheet.window();
        let division = axes::division_s(end_s - start_s, 800.0);
        let of = match &graph.opened {
            Some(opened) => opened.name.clone(),
            None => format!("{} {}", graph.files.device, humantime::format_rfc3339_seconds(newest)),
        };
        let title =
            PlotMessage::Title { of: of.trim().to_string(), span: axes::span_text(division) }.to_string();
        let mut shown = sheet.shown();
        shown.sort_unstable();
        let entry = |channel: usize| {
            let view = &sheet.channels[channel];
            let per_division = (view.scale.high - view.scale.low) / DIVISIONS as f64;
            let text = format!("{} {}  {per_division} {}/div", channel + 1, view.info.label, view.info.unit);
            (color_of(sheet, palette, channel), text)
        };
        Self { title, entries: shown.into_iter().map(entry).collect() }
    }
}

/// How much room it takes above a picture of that width.
pub fn height(legend: &Legend, width: f32) -> f32 {
    let rows = legend.entries.len().div_ceil(per_row(width));
    MARGIN + ROW * (1 + rows) as f32 + 4.0
}

fn per_row(width: f32) -> usize {
    ((width - 2.0 * MARGIN) / ENTRY_WIDTH).floor().max(1.0) as usize
}

/// Drawn into the top of `whole`.
pub fn layer(legend: &Legend, palette: &Palette, whole: Rect) -> Layer {
    let words = |at, text: &str, size, color| Element::Text {
        at,
        anchor: Align2::LEFT_CENTER,
        text: text.to_owned(),
        size,
        color,
        figures: false,
    };
    let top = whole.top() + MARGIN + ROW * 0.5;
    let mut elements = vec![words(pos2(whole.left() + MARGIN, top), &legend.title, 13.0, palette.text)];
    for (place, (color, text)) in legend.entries.iter().enumerate() {
        let (row, column) = (place / per_row(whole.width()), place % per_row(whole.width()));
        let x = whole.left() + MARGIN + column as f32 * ENTRY_WIDTH;
        let y = top + ROW * (row + 1) as f32;
        elements.push(Element::Line {
            points: vec![pos2(x, y), pos2(x + 18.0, y)],
            color: *color,
            width: 2.5,
        });
        elements.push(words(pos2(x + 24.0, y), text, 11.0, palette.text));
    }
    Layer { clip: whole, elements }
}
