//! A live figure with its unit, as wide as its widest value, so that nothing beside it moves.

use egui::{Align2, Response, Role, Sense, TextStyle, Ui, Vec2, WidgetInfo, pos2, vec2};

use crate::messages::SpokenMessage;
use crate::theme::{self, Palette};

/// One figure: what it is, how wide, in what unit.
#[derive(Clone, Copy, Debug)]
pub struct Readout<'a> {
    pub label: &'a str,
    pub unit: &'a str,
    /// Room for the figure, in digits.
    pub digits: usize,
    /// Room for the unit, in letters; readouts below each other have the same.
    pub unit_letters: usize,
}

/// Shown where no value is known.
pub const NO_VALUE: &str = "–";

impl Readout<'_> {
    /// The room it takes, whatever its value.
    pub fn size(&self, ui: &Ui) -> Vec2 {
        let small = TextStyle::Small.resolve(ui.style());
        let letter = ui.fonts_mut(|fonts| fonts.glyph_width(&small, 'm'));
        let unit_width = if self.unit_letters == 0 { 0.0 } else { letter * self.unit_letters as f32 + 4.0 };
        vec2(self.figure_width(ui) + unit_width, ui.spacing().interact_size.y)
    }

    fn figure_width(&self, ui: &Ui) -> f32 {
        let figures = theme::figures().resolve(ui.style());
        ui.fonts_mut(|fonts| fonts.glyph_width(&figures, '0')) * self.digits as f32
    }

    /// `None` is drawn as a dash.
    pub fn ui(&self, ui: &mut Ui, value: Option<&str>) -> Response {
        let palette = Palette::of(ui);
        let figures = theme::figures().resolve(ui.style());
        let small = TextStyle::Small.resolve(ui.style());
        let (size, figure_width) = (self.size(ui), self.figure_width(ui));
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, self.spoken(value)));
        let base = rect.center().y;
        let figure_right = rect.left() + figure_width;
        let painter = ui.painter();
        let (text, color) = value.map_or((NO_VALUE, palette.weak_text), |value| (value, palette.text));
        painter.text(pos2(figure_right, base), Align2::RIGHT_CENTER, text, figures, color);
        painter.text(
            pos2(figure_right + 4.0, base + 1.0),
            Align2::LEFT_CENTER,
            self.unit,
            small,
            palette.weak_text,
        );
        response
    }

    fn spoken(&self, value: Option<&str>) -> String {
        match value {
            Some(value) if self.unit.is_empty() => format!("{}: {value}", self.label),
            Some(value) => format!("{}: {value} {}", self.label, self.unit),
            None => SpokenMessage::NoValue { name: self.label.to_string() }.to_string(),
        }
    }
}
