//! The panel: the toolbar and the reason above, three columns below.

use egui::{Label, RichText, ScrollArea, Ui};

use super::needs::why_not;
use super::{stack, toolbar, values, watches};
use crate::command::Commands;
use crate::debugger::state::NO_NAMES;
use crate::model::Model;
use crate::theme::Palette;

/// Draws the debugger.
pub fn debug_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if let Some(why) = why_not(model) {
        ui.add_space(6.0);
        ui.add(Label::new(why.as_ref()).wrap());
        return;
    }
    ui.add_space(4.0);
    toolbar::toolbar_ui(ui, model, commands);
    toolbar::reason_ui(ui, model);
    let debug = &model.front.debug;
    let has_script = debug.view.as_ref().is_some_and(|view| view.code != 0);
    if has_script && debug.loaded().is_none() {
        ui.add(Label::new(RichText::new(NO_NAMES).color(Palette::of(ui).warning)).wrap());
    }
    ui.separator();
    let height = ui.available_height().max(60.0);
    ui.spacing_mut().item_spacing.y = 3.0;
    ui.columns_const(|[left, middle, right]| {
        let column = |ui: &mut Ui, id: &str, content: &mut dyn FnMut(&mut Ui)| {
            ScrollArea::vertical()
                .id_salt(id)
                .auto_shrink(false)
                .max_height(height)
                .show(ui, |ui| content(ui));
        };
        column(left, "debug values", &mut |ui| values::values_ui(ui, &mut model.front.debug));
        column(middle, "debug watches", &mut |ui| watches::watches_ui(ui, &mut model.front.debug, commands));
        column(right, "debug stack", &mut |ui| stack::stack_ui(ui, &mut model.front.debug, commands));
    });
}
