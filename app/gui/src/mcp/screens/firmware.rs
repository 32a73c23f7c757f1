//! The firmware window: what is installed and known, an update from a file with its risks, and what became of it.

use brushwork_link::device::Identity;
use brushwork_mcp_client::layout_of;
use brushwork_mcp_wire::models::{self, MODELS};
use brushwork_mcp_wire::packet_serial::known::{generation_text, quirks};
use egui::{
    Align, Button, ComboBox, Context, Grid, Layout, ProgressBar, Rect, RichText, ScrollArea, Ui, Window, vec2,
};

use crate::command::{Command, Commands};
use crate::keys::escape_closes;
use crate::mcp::messages::{DownloadMessage, McpScreenMessage};
use crate::mcp::model::firmware::{Firmware, FirmwareAction, LISTED, Stage};
use crate::model::{Model, Sheet};
use crate::theme::Palette;
use crate::widgets::{choice_ui, heading_ui, text_field_ui, with_time_left};
use brushwork_core::update::Compared;
use brushwork_core::words::capital;

/// Draws the window, if it is open, within `room`.
pub fn firmware_ui(ctx: &Context, model: &mut Model, commands: &mut Commands, room: Rect) {
    if !model.front.mcp().firmware.open {
        return;
    }
    let mut open = true;
    let size = vec2(760.0, 680.0).min(room.size() - vec2(24.0, 60.0));
    let shown = Window::new("Firmware")
        .open(&mut open)
        .collapsible(false)
        .default_size(size)
        .default_pos(room.center() - size / 2.0)
        .min_size(vec2(420.0, 260.0))
        .constrain_to(room)
        .show(ctx, |ui| {
            ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| contents_ui(ui, model, commands));
        });
    // The window can be put away while an update runs; the update goes on.
    let closes = escape_closes(ctx, shown.as_ref()) && !model.front.mcp().firmware.stage.is_running();
    model.front.mcp_mut().firmware.open = open && !closes;
}

fn contents_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let identity = model.front.link.identity().cloned();
    match &identity {
        Some(identity) => installed_ui(ui, identity),
        None => drop(ui.weak(
            "No controller is connected. Connect one to see its firmware, or resume an update that broke.",
        )),
    }
    ui.add_space(8.0);
    heading_ui(ui, "Update from a file");
    match &model.front.mcp().firmware.stage {
        Stage::Idle => {
            let simulated = identity.as_ref().map_or_else(
                || model.front.target.as_deref().is_some_and(|target| target.starts_with("sim:")),
                |identity| identity.simulated,
            );
            ask_ui(ui, &mut model.front.mcp_mut().firmware, identity.as_ref(), simulated, commands);
        }
        Stage::Done(sent) => {
            done_ui(ui, &sent.sentence(), &model.front.mcp().firmware, identity.is_some(), commands);
        }
        Stage::Failed(sentence) => {
            ui.label(RichText::new(sentence.to_string()).color(Palette::of(ui).error));
            if ui.button("Back").clicked() {
                commands.push(Command::own(FirmwareAction::Dismiss));
            }
        }
        running @ (Stage::BackingUp { .. } | Stage::Entering { .. } | Stage::Sending { .. }) => {
            running_ui(ui, running, commands);
        }
    }
}

/// What is installed, and the table of what is known about it.
fn installed_ui(ui: &mut Ui, identity: &Identity) {
    heading_ui(ui, "Installed");
    ui.strong(identity.version_text.trim());
    ui.label(format!(
        "{}. {}",
        capital(&identity.generation.to_string()),
        generation_text(layout_of(identity.generation))
    ));
    ui.add_space(8.0);
    heading_ui(ui, "What is known about it");
    let family = models::identify(&identity.version_text).map(|model| model.family);
    Grid::new("known firmware").num_columns(2).striped(true).spacing(vec2(12.0, 4.0)).show(ui, |ui| {
        for quirk in quirks(family, layout_of(identity.generation), &identity.firmware) {
            ui.strong(quirk.topic);
            let text = ui.add(egui::Label::new(quirk.text).wrap());
            text.on_hover_text(McpScreenMessage::From { source: quirk.source }.to_string());
            ui.end_row();
        }
    });
}

fn ask_ui(
    ui: &mut Ui,
    firmware: &mut Firmware,
    identity: Option<&Identity>,
    simulated: bool,
    commands: &mut Commands,
) {
    ui.weak("No firmware image is published. An update needs a file that you have.");
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button("Choose…").clicked() {
                commands.push(Command::own(FirmwareAction::Browse));
            }
            text_field_ui(ui, &mut firmware.path, "Firmware file", "Path of the image");
        });
    });
    if identity.is_none() {
        resumed_ui(ui, firmware);
    }
    ui.add_space(4.0);
    for risk in firmware.risks(simulated) {
        ui.horizontal_top(|ui| {
            ui.label("•");
            ui.add(egui::Label::new(risk).wrap());
        });
    }
    ui.add_space(4.0);
    ui.checkbox(&mut firmware.accepted, "I have read this and accept that the controller can become useless");
    let why_not = if firmware.path.trim().is_empty() {
        Some("Choose a file first.")
    } else if identity.is_none() && firmware.resumed_model.is_none() {
        Some("Connect a controller, or choose the model that waits in its loader.")
    } else if !firmware.accepted {
        Some("Read and accept the risks first.")
    } else {
        None
    };
    let title = if identity.is_none() { "Resume the update" } else { "Update the firmware" };
    let button = ui.add_enabled(why_not.is_none(), Button::new(title));
    if button.clicked() {
        commands.push(Command::own(FirmwareAction::Update));
    }
    if let Some(why) = why_not {
        button.on_disabled_hover_text(why);
        ui.weak(why);
    }
}

/// Which model waits in its loader: it cannot tell.
fn resumed_ui(ui: &mut Ui, firmware: &mut Firmware) {
    ui.horizontal(|ui| {
        ui.label("Waits in its loader:");
        let list = ComboBox::from_id_salt("resumed model");
        let models = std::iter::once(None).chain(MODELS.iter().map(Some));
        let named = |model: Option<&models::Model>| model.map_or("none", |model| model.name);
        choice_ui(ui, list, "Model in its loader", &mut firmware.resumed_model, models, named);
    });
}

fn running_ui(ui: &mut Ui, stage: &Stage, commands: &mut Commands) {
    let (text, share) = stage.reported();
    ui.strong(share.map_or_else(|| text.clone(), |share| with_time_left(ui, "firmware", share, &text)));
    let bar = ProgressBar::new(share.unwrap_or(0.0)).desired_height(18.0);
    ui.add(if share.is_some() { bar.show_percentage() } else { bar });
    let harmless = stage.can_be_cancelled();
    let cancel = ui.add_enabled(harmless, Button::new("Cancel the update"));
    if cancel.clicked() {
        commands.push(Command::own(FirmwareAction::Cancel));
    }
    if !harmless {
        ui.weak("It cannot be cancelled now: the controller would be left without firmware.");
    }
}

fn done_ui(ui: &mut Ui, text: &str, firmware: &Firmware, connected: bool, commands: &mut Commands) {
    match firmware.verdict() {
        Some(verdict) if verdict.is_good() => drop(ui.strong(verdict.sentence().to_string())),
        Some(verdict) => drop(ui.label(RichText::new(verdict.sentence().to_string()).color(Palette::of(ui).error))),
        None if firmware.is_awaited() => {
            ui.strong("The image was sent. Waiting for the controller: whether the update is good shows when it answers.");
        }
        None => drop(ui.label(
            RichText::new(
                "The image was sent, and the controller did not come back: it is not known whether the update is good. Switch it off and \
                 on, then connect. If it does not answer, resume the update.",
            )
            .color(Palette::of(ui).error),
        )),
    }
    ui.weak(text);
    if let Some(backup) = firmware.backup() {
        ui.weak(DownloadMessage::SettingsKept { backup: backup.to_string() }.to_string());
    }
    match firmware.compared() {
        None if connected && firmware.backup().is_some() => {
            ui.weak("Comparing the settings with the backup.");
        }
        None => {}
        Some(compared) if compared.differences.is_empty() => drop(ui.label(compared.sentence().to_string())),
        Some(compared) => differences_ui(ui, compared, commands),
    }
    if ui.button("Back").clicked() {
        commands.push(Command::own(FirmwareAction::Dismiss));
    }
}

fn differences_ui(ui: &mut Ui, compared: &Compared, commands: &mut Commands) {
    let count = compared.differences.len();
    ui.label(RichText::new(compared.sentence().to_string()).color(Palette::of(ui).warning));
    for line in compared.differences.iter().take(LISTED) {
        ui.label(line);
    }
    if count > LISTED {
        ui.weak(McpScreenMessage::AndMore { count: count - LISTED }.to_string());
    }
    if ui.button("Restore from the backup…").clicked() {
        commands.push(Command::OpenSheet(Sheet::Backups));
    }
}
