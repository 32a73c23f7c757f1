//! The resistance of the winding as a run measured it, offered as a setting; or why it was not told and what would.

use brushwork_tuning::winding::{Winding, WindingUnknown};
use egui::{Button, Label, RichText, Ui};

use super::which::Loop;
use crate::model::loop_settings::RESISTANCE;
use crate::model::{Model, UnitSettings};
use crate::tune::messages::RunMessage;

/// Offers the measured resistance, and says what setting it does.
pub fn winding_ui(ui: &mut Ui, model: &mut Model, which: Loop, winding: &Winding) {
    let motor = model.front.tune.motor(which);
    ui.horizontal_wrapped(|ui| {
        let text = RunMessage::Resistance { ohms: winding.ohms, interval: winding.interval_ohms }.to_string();
        ui.label(text).on_hover_text("Of the winding, its leads and the bridge, with its 95 % interval");
        let is_free =
            !model.front.is_guided() && model.front.settings.unit().is_some_and(UnitSettings::is_known);
        let enter = ui.add_enabled(is_free, Button::new("Enter as R").small());
        let hint =
            "Puts it into the field R under Velocity loop. It is sent with the other edits of that table.";
        if enter.on_hover_text(hint).clicked()
            && let Some(unit) = model.front.settings.unit_mut()
        {
            unit.edit(motor, RESISTANCE, winding.ohms);
            model.front.loops.note_edit();
        }
    });
    let warning = "With L and R both other than 0, duty commands become current (torque) commands. L cannot be measured this way.";
    weak_ui(ui, warning);
}

/// Says why there is none.
pub fn unknown_ui(ui: &mut Ui, why: WindingUnknown) {
    weak_ui(ui, &RunMessage::NoResistance { why: why.sentence() }.to_string());
}

fn weak_ui(ui: &mut Ui, text: &str) {
    ui.add(Label::new(RichText::new(text).small().weak()).wrap());
}
