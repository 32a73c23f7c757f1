//! The row of monitored parameters (MCP manual 1.2.2), in blocks that wrap when the window is narrow.

use brushwork_values::Motor;
use egui::{Label, Role, Ui, WidgetInfo, vec2};

use crate::command::{Command, Commands};
use crate::family::{Figure, Figures};
use crate::language::{said, word};
use crate::model::Model;
use crate::shell::messages::ShellMessage;
use crate::widgets::{NO_VALUE, Readout, fixed_label_ui};

const GAP: f32 = 4.0;
const ZERO_WIDTH: f32 = 42.0;
const ROW_HEIGHT: f32 = 24.0;
const IDENTITY_WIDTH: f32 = 152.0;

pub fn top_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    ui.spacing_mut().item_spacing = vec2(7.0, 4.0);
    // Rows are made by hand, since a wrapping layout does not know how wide a block will be.
    let blocks = model.front.family().figures();
    let widths: Vec<f32> = blocks.iter().map(|block| block.width(ui)).collect();
    let (room, gap) = (ui.available_width(), ui.spacing().item_spacing.x);
    let mut start = 0;
    while start < widths.len() {
        let end = row_end(&widths, start, room, gap);
        let used: f32 = widths[start..end].iter().map(|width| width + gap).sum();
        ui.horizontal(|ui| {
            for block in &blocks[start..end] {
                block_ui(ui, block, model, commands);
            }
            // Who the controller is stands in the device list too, so it takes no row of its own.
            if end == widths.len() && used + IDENTITY_WIDTH <= room {
                identity_ui(ui, model);
            }
        });
        start = end;
    }
}

/// How many blocks from `start` on stand side by side: at least one.
fn row_end(widths: &[f32], start: usize, available: f32, gap: f32) -> usize {
    let mut used = widths[start];
    let mut end = start + 1;
    while end < widths.len() && used + gap + widths[end] <= available {
        used += gap + widths[end];
        end += 1;
    }
    end
}

impl Figures {
    fn readout<'a>(&self, figure: &Figure, label: &'a str) -> Readout<'a> {
        Readout { label, unit: figure.unit, digits: self.digits, unit_letters: self.unit_letters }
    }

    fn width(&self, ui: &Ui) -> f32 {
        let zero = if self.zero { GAP + ZERO_WIDTH } else { 0.0 };
        let readout = self.rows.first().map_or(0.0, |figure| self.readout(figure, "").size(ui).x);
        self.label_width + GAP + readout + zero
    }
}

fn block_ui(ui: &mut Ui, block: &Figures, model: &Model, commands: &mut Commands) {
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing = vec2(GAP, 2.0);
        let motors = model.front.motors();
        let is_there = |figure: &&Figure| figure.channel.motor.is_none_or(|motor| motors.contains(&motor));
        for figure in block.rows.iter().filter(is_there) {
            ui.horizontal(|ui| {
                let label = word("figure", figure.label);
                fixed_label_ui(ui, &label, block.label_width);
                let value = model.front.link.readings.text(figure.channel);
                block.readout(figure, &label).ui(ui, value.as_deref());
                if block.zero {
                    zero_ui(ui, figure.motor, model.is_connected(), commands);
                }
            });
        }
    });
}

fn zero_ui(ui: &mut Ui, motor: Motor, connected: bool, commands: &mut Commands) {
    ui.add_enabled_ui(connected, |ui| {
        let response =
            ui.add_sized(vec2(ZERO_WIDTH, ROW_HEIGHT - 2.0), egui::Button::new(word("bar", "Zero")).small());
        let name = said(&ShellMessage::ZeroEncoder { motor });
        response.widget_info(|| WidgetInfo::labeled(Role::Button, connected, &name));
        if response.on_hover_text(said(&ShellMessage::SetsToZero { number: motor.index() + 1 })).clicked() {
            commands.push(Command::ZeroEncoder(motor));
        }
    });
}

fn identity_ui(ui: &mut Ui, model: &Model) {
    let identity = model.front.link.identity();
    let title = identity.map(|identity| match identity.simulated {
        true => format!("{} ({})", identity.title(), word("bar", "simulated")),
        false => identity.title().to_owned(),
    });
    let version = identity.map(|identity| match identity.firmware.as_str() {
        "" => word("bar", "not reported"),
        version => match model.front.family().generation_number(identity) {
            Some(generation) => said(&ShellMessage::Version { version: version.to_string(), generation }),
            None => identity.generation.to_string(),
        },
    });
    // The last block takes what is left of its row.
    let width = ui.available_width().clamp(IDENTITY_WIDTH, 2.0 * IDENTITY_WIDTH);
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing = vec2(GAP, 2.0);
        for (label, value) in [(word("bar", "Model"), title), (word("bar", "Version"), version)] {
            ui.horizontal(|ui| {
                ui.set_width(width);
                fixed_label_ui(ui, &label, 48.0);
                let spoken = format!("{label}: {}", value.clone().unwrap_or_else(|| word("bar", "no value")));
                let text = ui.add(Label::new(value.as_deref().unwrap_or(NO_VALUE)).truncate());
                text.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
            });
        }
    });
}
