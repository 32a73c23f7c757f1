//! The bytes that wait to be sent.

use brushwork_values::hex;
use egui::{Label, RichText, ScrollArea, Ui};

use crate::messages::TrafficMessage;
use crate::model::Model;
use crate::model::traffic::pending::pending;
use crate::theme::Palette;

pub fn pending_ui(ui: &mut Ui, model: &Model) {
    let (packets, refusals) = pending(&model.front, model.screen);
    let palette = Palette::of(ui);
    ScrollArea::vertical().id_salt("pending").auto_shrink([false, false]).show(ui, |ui| {
        for refusal in &refusals {
            ui.label(RichText::new(TrafficMessage::NotWritten { refusal: refusal.clone() }.to_string()).color(palette.error));
        }
        if packets.is_empty() && refusals.is_empty() {
            let hint = "Nothing waits to be sent. Settings that were changed and not written yet are shown here as the packets \
                        that will write them; on a screen that drives, what its sliders stand for.";
            ui.weak(hint);
        }
        for packet in &packets {
            ui.label(format!("{}: {}", packet.title, packet.text));
            ui.add(Label::new(RichText::new(hex(&packet.bytes)).monospace().weak()).wrap());
        }
    });
}
