//! What is seen while files are held over the window.

use egui::{Align2, Area, Context, CornerRadius, Frame, Id, Margin, Order, RichText, Stroke, vec2};

use crate::language::{said, word};
use crate::shell::messages::ShellMessage;
use crate::theme::Palette;

const WIDTH: f32 = 460.0;

/// Says that files can be dropped, while some are held over the window.
pub fn drop_ui(ctx: &Context) {
    let count = ctx.input(|input| input.raw.hovered_files.len());
    if count == 0 {
        return;
    }
    let what = if count == 1 { word("bar", "the file") } else { said(&ShellMessage::TheFiles { count }) };
    let area = Area::new(Id::unique("files held over the window")).order(Order::Tooltip).interactable(false);
    area.anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0)).show(ctx, |ui| {
        let palette = Palette::of(ui);
        let frame = Frame::new().fill(palette.raised).stroke(Stroke::new(2.0, palette.accent));
        frame.corner_radius(CornerRadius::same(6)).inner_margin(Margin::same(18)).show(ui, |ui| {
            ui.set_width(WIDTH);
            ui.vertical_centered(|ui| {
                ui.label(RichText::new(said(&ShellMessage::DropToOpen { what })).size(18.0).strong());
                ui.label(word("bar", "Profile, backup, recording, tuning report, script or firmware image"));
            });
        });
    });
}
