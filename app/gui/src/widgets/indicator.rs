//! A status indicator: colour, shape and word, so that no one of the three has to be seen.

use std::f32::consts::{PI, TAU};
use std::fmt::Display;

use egui::{
    Align2, Color32, FontId, Label, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, TextStyle,
    Ui, Vec2, WidgetInfo, pos2, vec2,
};

use crate::language::word;
use crate::model::indicator::IndicatorState;
use crate::theme::{self, Palette};
use crate::widgets::elided;

impl IndicatorState {
    pub const fn color(self, palette: &Palette) -> Color32 {
        match self {
            Self::Unknown | Self::NotApplicable => palette.weak_text,
            Self::Ok => palette.ok,
            Self::Active => palette.accent,
            Self::Warning => palette.warning,
            Self::Error => palette.error,
        }
    }

    /// Draws it in the middle of a place of its own.
    pub fn ui(self, ui: &mut Ui, size: Vec2, radius: f32) -> Response {
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        self.paint(ui, rect.center(), radius);
        response
    }

    /// A line of text with it in front.
    pub fn line_ui(self, ui: &mut Ui, text: &(impl Display + ?Sized)) {
        ui.horizontal(|ui| {
            self.ui(ui, vec2(18.0, 18.0), 6.0);
            ui.add(Label::new(text.to_string()).wrap());
        });
    }

    /// A ring, a dash, a disc, a square, a triangle or a crossed octagon.
    pub fn paint(self, ui: &Ui, center: Pos2, radius: f32) {
        let palette = Palette::of(ui);
        let color = self.color(palette);
        let painter = ui.painter();
        let mark = Stroke::new((radius * 0.3).max(1.3), palette.ground);
        match self {
            Self::Unknown => {
                painter.circle_stroke(center, radius - 1.0, Stroke::new(1.2, color));
            }
            Self::NotApplicable => {
                painter.hline(
                    center.x - radius * 0.7..=center.x + radius * 0.7,
                    center.y,
                    Stroke::new(1.5, color),
                );
            }
            Self::Ok => {
                painter.circle_filled(center, radius, color);
            }
            Self::Active => {
                let square = Rect::from_center_size(center, Vec2::splat(radius * 1.7));
                painter.rect_filled(square, 2.0, color);
            }
            Self::Warning => {
                painter.add(polygon(center + vec2(0.0, radius * 0.25), radius * 1.25, 3, -PI / 2.0, color));
                painter.vline(center.x, center.y - radius * 0.45..=center.y + radius * 0.25, mark);
                painter.circle_filled(center + vec2(0.0, radius * 0.6), mark.width * 0.5, mark.color);
            }
            Self::Error => {
                painter.add(polygon(center, radius * 1.15, 8, PI / 8.0, color));
                let arm = radius * 0.45;
                painter.line_segment([center - Vec2::splat(arm), center + Vec2::splat(arm)], mark);
                painter.line_segment([center + vec2(-arm, arm), center + vec2(arm, -arm)], mark);
            }
        }
    }
}

fn polygon(center: Pos2, radius: f32, corners: u8, start: f32, color: Color32) -> Shape {
    let corner = |index| {
        let angle = start + TAU * f32::from(index) / f32::from(corners);
        center + radius * vec2(angle.cos(), angle.sin())
    };
    Shape::convex_polygon((0..corners).map(corner).collect(), color, Stroke::NONE)
}

/// A small indicator with its abbreviation below, for the bottom of the window.
pub fn abbreviated_ui(
    ui: &mut Ui,
    size: Vec2,
    abbreviation: &str,
    name: &str,
    state: IndicatorState,
) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| {
        WidgetInfo::labeled(Role::Status, true, format!("{abbreviation}: {}", word("state", state.word())))
    });
    let palette = Palette::of(ui);
    let alarming = state >= IndicatorState::Active;
    let outline = if alarming { state.color(palette) } else { palette.line };
    ui.painter().rect(rect, 4.0, palette.raised, Stroke::new(1.0, outline), StrokeKind::Inside);
    state.paint(ui, pos2(rect.center().x, rect.top() + rect.height() * 0.32), 5.0);
    let color = if alarming { palette.text } else { palette.weak_text };
    let font = TextStyle::Small.resolve(ui.style());
    ui.painter().text(
        pos2(rect.center().x, rect.bottom() - 3.0),
        Align2::CENTER_BOTTOM,
        abbreviation,
        font,
        color,
    );
    response.on_hover_text(format!("{name}: {}", word("state", state.word())))
}

/// Room for "since 10:00:00".
const SINCE_WIDTH: f32 = 92.0;

/// An indicator in full: shape, name, word and since when on one line.
pub fn full_ui(
    ui: &mut Ui,
    abbreviation: &str,
    name: &str,
    state: IndicatorState,
    since: Option<&str>,
) -> Response {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 30.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Status, true, format!("{name}: {}", state.word())));
    if let Some(since) = since {
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(since));
    }
    let alarming = state >= IndicatorState::Active;
    let outline = if alarming { state.color(palette) } else { palette.line };
    ui.painter().rect(rect, 4.0, palette.raised, Stroke::new(1.0, outline), StrokeKind::Inside);
    state.paint(ui, pos2(rect.left() + 18.0, rect.center().y), 7.0);
    let body = TextStyle::Body.resolve(ui.style());
    let small = TextStyle::Small.resolve(ui.style());
    let y = rect.center().y;
    let painter = ui.painter().with_clip_rect(rect);
    if let Some(since) = since {
        let figures = FontId::new(small.size, theme::figures().resolve(ui.style()).family);
        painter.text(pos2(rect.right() - 10.0, y), Align2::RIGHT_CENTER, since, figures, palette.weak_text);
    }
    let word_at = pos2(rect.right() - 12.0 - since.map_or(0.0, |_| SINCE_WIDTH), y);
    let word = painter.text(word_at, Align2::RIGHT_CENTER, state.word(), body.clone(), state.color(palette));
    let left = pos2(rect.left() + 36.0, y);
    painter.text(left, Align2::LEFT_CENTER, abbreviation, small, palette.weak_text);
    // A name that has no room ends before the word.
    let at = left + vec2(46.0, 0.0);
    let is_whole =
        elided(&painter, (at, Align2::LEFT_CENTER), (name, body, palette.text), word.left() - 6.0 - at.x);
    if is_whole { response } else { response.on_hover_text(name) }
}
