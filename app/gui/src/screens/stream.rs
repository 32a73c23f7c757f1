//! Asks which of the controller's streams the port goes to.

use brushwork_link::transport::Stream;
use egui::{ComboBox, Ui};

use crate::command::{Command, Commands};

/// Asked for when the port does not tell by its name which of the controller's streams it is; `rest` ends the sentence.
pub fn stream_ui(ui: &mut Ui, rest: &str, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let label = ui.label("This port goes to the controller's");
        let combo = ComboBox::from_id_salt("stream").selected_text("choose …");
        let response = combo.show_ui(ui, |ui| {
            for stream in Stream::ALL {
                if ui.selectable_label(false, stream.label()).clicked() {
                    commands.push(Command::SetStream(stream));
                }
            }
        });
        response.response.labelled_by(label.id);
        ui.label(rest);
    });
}
