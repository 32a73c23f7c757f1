//! Bars above the text for what has to be decided: unsaved text of an earlier time, a file that another program has written.

use egui::{Frame, Label, Margin, Stroke, Ui, vec2};

use super::document::OnDisk;
use super::{Editor, MclAction};
use crate::mcl::messages::PanelMessage;
use crate::model::indicator::IndicatorState;
use crate::theme::Palette;

pub fn notices_ui(ui: &mut Ui, editor: &Editor, actions: &mut Vec<MclAction>) {
    if !editor.left.is_empty() {
        let programs: Vec<&str> =
            editor.left.iter().flat_map(|left| &left.programs).map(|kept| kept.title.as_str()).collect();
        let text = PanelMessage::UnsavedFound { programs: programs.join(", ") }.to_string();
        let choices = [
            ("Restore", MclAction::SettleLeft { restore: true }),
            ("Discard", MclAction::SettleLeft { restore: false }),
        ];
        bar_ui(ui, &text, &choices, actions);
    }
    let (front, id) = (editor.front(), editor.front().id());
    match front.on_disk {
        OnDisk::Same => {}
        OnDisk::Changed => {
            let text = PanelMessage::ChangedAndUnsaved { title: front.title().to_string() }.to_string();
            let choices = [
                ("Load the file", MclAction::SettleChange { id, load: true }),
                ("Keep this text", MclAction::SettleChange { id, load: false }),
            ];
            bar_ui(ui, &text, &choices, actions);
        }
        OnDisk::Gone => {
            let text = PanelMessage::Gone { title: front.title().to_string() }.to_string();
            bar_ui(ui, &text, &[("Keep this text", MclAction::SettleChange { id, load: false })], actions);
        }
    }
}

fn bar_ui(ui: &mut Ui, text: &str, choices: &[(&str, MclAction)], actions: &mut Vec<MclAction>) {
    let palette = Palette::of(ui);
    let frame = Frame::new().stroke(Stroke::new(1.0, palette.warning)).corner_radius(4.0);
    frame.inner_margin(Margin::symmetric(8, 3)).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            IndicatorState::Warning.ui(ui, vec2(16.0, 16.0), 5.0);
            ui.add(Label::new(text).wrap());
            for (reads, action) in choices {
                if ui.button(*reads).clicked() {
                    actions.push(*action);
                }
            }
        });
    });
    ui.add_space(2.0);
}
