//! A list that unfolds, to choose one of several.

use egui::{ComboBox, Response, Ui, WidgetText};

/// Lets one of `choices` be chosen; `list` says how wide, `name` what a screen reader
/// reads. The response is that of the folded list.
pub fn choice_ui<T: Copy + PartialEq, S: Into<WidgetText>>(
    ui: &mut Ui,
    list: ComboBox,
    name: &str,
    value: &mut T,
    choices: impl IntoIterator<Item = T>,
    text: impl Fn(T) -> S,
) -> Response {
    let unfolded = list.selected_text(text(*value)).show_ui(ui, |ui| {
        for choice in choices {
            ui.selectable_value(value, choice, text(choice));
        }
    });
    ui.ctx().accesskit_node_builder(unfolded.response.id, |node| node.set_label(name));
    unfolded.response
}
