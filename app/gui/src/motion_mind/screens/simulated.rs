//! How the switches of a simulated Motion Mind stand, and how many share its bus.

use egui::{ComboBox, Ui};

use crate::model::simulated::Simulated;
use crate::widgets::choice_ui;

/// The switches: they are read at its power-up, so that another choice is another unit.
pub fn switches_ui(ui: &mut Ui, simulated: &mut Simulated) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let text = |mode: u8| format!("{mode} {}", MODES[usize::from(mode).min(MODES.len() - 1)]);
        let list = ComboBox::from_id_salt("mode").width(104.0).truncate();
        choice_ui(ui, list, "Mode", &mut simulated.mode, 0..=7, text)
            .on_hover_text("What moves the motor: switches 2 to 4 of the board");
        let text = |is_text: bool| if is_text { "ASCII" } else { "Binary" };
        let list = ComboBox::from_id_salt("protocol").width(60.0);
        choice_ui(ui, list, "Protocol", &mut simulated.is_text, [false, true], text)
            .on_hover_text("Switch 6 of the board");
    });
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let number = |ui: &mut Ui, label: &str, name: &str, value: &mut u8, range| {
            ui.label(label);
            let field = ui.add(egui::DragValue::new(value).range(range).speed(0.2));
            ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(name));
        };
        number(ui, "Address", "Unit address", &mut simulated.address, 1..=98);
        number(ui, "Units", "Units on the bus", &mut simulated.units, 1..=MOST_UNITS);
    });
}

/// Short names of the modes, by number.
const MODES: [&str; 8] =
    ["R/C", "Analog", "Buttons", "Serial", "Serial PID", "Analog PID", "Factory restore", "Factory test"];

/// Most of them on one simulated bus.
const MOST_UNITS: u8 = 4;
