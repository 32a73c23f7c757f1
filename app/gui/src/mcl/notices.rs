//! Bars above the text for what has to be decided: unsaved text of an earlier time, a file that another program has written.

use egui::{Frame, Label, Margin, Stroke, Ui, vec2};

use super::document::OnDisk;
use super::editor::Editor;
use super::wish::MclWish;
use crate::model::lamp::LampState;
use crate::theme::Palette;

pub fn notices_ui(ui: &mut Ui, editor: &Editor, wishes: &mut Vec<MclWish>) {
    if !editor.left.is_empty() {
        let programs: Vec<&str> =
            editor.left.iter().flat_map(|left| &left.programs).map(|kept| kept.title.as_str()).collect();
        let text = format!("Unsaved text from an earlier time was found: {}.", programs.join(", "));
        let choices = [
            ("Restore", MclWish::SettleLeft { restore: true }),
            ("Discard", MclWish::SettleLeft { restore: false }),
        ];
        bar_ui(ui, &text, &choices, wishes);
    }
    let (front, id) = (editor.front(), editor.front().id());
    match front.on_disk {
        OnDisk::Same => {}
        OnDisk::Changed => {
            let text =
                format!("{} was changed by another program, and there is unsaved text here.", front.title());
            let choices = [
                ("Load the file", MclWish::SettleChange { id, load: true }),
                ("Keep this text", MclWish::SettleChange { id, load: false }),
            ];
            bar_ui(ui, &text, &choices, wishes);
        }
        OnDisk::Gone => {
            let text = format!("The file of {} is gone. Save writes it again.", front.title());
            bar_ui(ui, &text, &[("Keep this text", MclWish::SettleChange { id, load: false })], wishes);
        }
    }
}

fn bar_ui(ui: &mut Ui, text: &str, choices: &[(&str, MclWish)], wishes: &mut Vec<MclWish>) {
    let palette = Palette::of(ui);
    let frame = Frame::new().stroke(Stroke::new(1.0, palette.warning)).corner_radius(4.0);
    frame.inner_margin(Margin::symmetric(8, 3)).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(16.0, 16.0), egui::Sense::hover());
            LampState::Warning.paint(ui, rect.center(), 5.0);
            ui.add(Label::new(text).wrap());
            for (reads, wish) in choices {
                if ui.button(*reads).clicked() {
                    wishes.push(*wish);
                }
            }
        });
    });
    ui.add_space(2.0);
}
