//! The switches on the board of a simulated controller that has some.

use brushwork_plant::world::{BoardSwitches, WorldAction, WorldView};
use egui::{ComboBox, Label, RichText, Ui};

use super::{Actions, LABEL_WIDTH, toggle_ui};
use crate::widgets::{choice_ui, fixed_label_ui, heading_ui};

const MODES: [&str; 8] =
    ["R/C", "Analog", "Buttons", "Serial", "Serial PID", "Analog PID", "Factory restore", "Factory test"];

pub fn switches_ui(ui: &mut Ui, view: &WorldView, actions: &mut Actions) {
    let Some(before) = view.board_switches else { return };
    ui.separator();
    heading_ui(ui, "Switches of the board");
    let mut now = before;
    mode_ui(ui, &mut now);
    for (text, on) in [
        ("19,200 baud (5 off)", &mut now.is_fast),
        ("Text protocol (6)", &mut now.is_text),
        ("Encoder lines, not edges (7)", &mut now.counts_lines),
    ] {
        if toggle_ui(ui, text, *on) {
            *on = !*on;
        }
    }
    let note = "Read at power-up: switch the power off and on, then connect again.";
    ui.add(Label::new(RichText::new(note).small().weak()).wrap());
    if now != before {
        actions.push(WorldAction::SetBoardSwitches { switches: now });
    }
}

fn mode_ui(ui: &mut Ui, switches: &mut BoardSwitches) {
    let text = |mode: u8| format!("{mode} {}", MODES[usize::from(mode & 7)]);
    ui.horizontal(|ui| {
        fixed_label_ui(ui, "Mode (2 to 4)", LABEL_WIDTH);
        let list = ComboBox::from_id_salt("board mode").width(120.0);
        choice_ui(ui, list, "Mode switches", &mut switches.mode, 0..8, text);
    });
}
