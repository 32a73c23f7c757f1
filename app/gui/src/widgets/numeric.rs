//! A field for an exact number with its unit. What is typed counts when Enter is pressed or the field is left.

use std::ops::RangeInclusive;

use egui::{DragValue, Response, Ui};

/// What may be typed and how it is shown.
#[derive(Clone, Debug)]
pub struct Numeric<'a> {
    /// The accessible name.
    pub name: &'a str,
    pub unit: &'a str,
    pub range: RangeInclusive<f64>,
    /// Digits after the point.
    pub decimals: usize,
    /// Change per arrow key.
    pub step: f64,
    pub width: f32,
}

impl<'a> Numeric<'a> {
    /// A field with its name, unit and range; what it shows and how wide it is.
    pub const fn new(
        name: &'a str,
        unit: &'a str,
        range: RangeInclusive<f64>,
        (decimals, step, width): (usize, f64, f32),
    ) -> Self {
        Self { name, unit, range, decimals, step, width }
    }

    /// Changes `value` in place; [`Response::changed`] tells whether it did.
    pub fn ui(&self, ui: &mut Ui, value: &mut f64) -> Response {
        let height = ui.spacing().interact_size.y;
        let field = DragValue::new(value)
            .range(self.range.clone())
            .fixed_decimals(self.decimals)
            .speed(self.step)
            .min_size(egui::vec2(self.width, height))
            .update_while_editing(false);
        let field = if self.unit.is_empty() { field } else { field.suffix(format!(" {}", self.unit)) };
        let response = ui.add(field);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(self.name));
        response
    }
}
