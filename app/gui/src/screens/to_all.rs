//! One profile for every unit: who gets it, what changes on each, and what became of it.

use brushwork_core::settings::for_all::Share;
use brushwork_core::words::capital;
use brushwork_link::Message;
use egui::{Button, Checkbox, CollapsingHeader, Context, Grid, Label, ProgressBar, Rect, Ui, vec2};

use super::dialog::{dialog_ui, said_ui, weak_ui};
use crate::command::{Command, Commands};
use crate::messages::ToAllMessage;
use crate::model::to_all::{State, Target, ToAll, ToAllAction};
use crate::model::{Gravity, IndicatorState, Model};
use crate::widgets::with_time_left;

/// Draws the window, if it is open, within `room`.
pub fn to_all_ui(ctx: &Context, model: &mut Model, commands: &mut Commands, room: Rect) {
    if model.to_all.open {
        let size = vec2(720.0, 600.0);
        let of = model.to_all.job().and_then(|(id, _)| model.connection(id));
        let progress = of.and_then(|connection| connection.errand.progress());
        let progress = progress.map(|(share, text)| (share, capital(text)));
        let title = ("One profile for all units", model.to_all.is_running());
        let open = dialog_ui(ctx, title, (room, size), |ui| {
            contents_ui(ui, &mut model.to_all, progress.as_ref(), commands);
        });
        // What goes on goes on; the window can be opened again.
        model.to_all.open = open;
    }
}

/// How far the work with one unit is, and what it does.
type Progress<'p> = Option<&'p (f32, String)>;

fn contents_ui(ui: &mut Ui, to_all: &mut ToAll, progress: Progress<'_>, commands: &mut Commands) {
    weak_ui(
        ui,
        "Each unit keeps its own address. What changes on each is shown first; nothing is written where one that is ticked cannot take it. \
         Backups are made first.",
    );
    if let Some(name) = to_all.profile() {
        ui.add(Label::new(name.to_owned()).truncate());
    }
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let count = to_all.ready();
        let text = match &count {
            Ok(1) => Message::from(ToAllMessage::WriteToOne).to_string(),
            Ok(count) => Message::from(ToAllMessage::WriteTo { count: *count }).to_string(),
            Err(_) => "Write".to_owned(),
        };
        let size = vec2(140.0, 30.0);
        let write = ui.add_enabled(count.is_ok(), Button::new(text).min_size(size));
        let write = match &count {
            Ok(_) => write,
            Err(why) => write.on_disabled_hover_text(why.to_string()),
        };
        if write.clicked() {
            commands.push(Command::ToAll(ToAllAction::Write));
        }
        let (text, action) = match to_all.is_running() {
            true => ("Cancel", ToAllAction::Cancel),
            false => ("Compare again", ToAllAction::Read),
        };
        if ui.add(Button::new(text).min_size(vec2(110.0, 30.0))).clicked() {
            commands.push(Command::ToAll(action));
        }
        ui.add_enabled(
            !to_all.is_running(),
            Checkbox::new(&mut to_all.saves, "Save all settings of each to EEPROM too"),
        );
    });
    said_ui(ui, to_all.ended.as_ref());
    let (current, is_running) = (to_all.current(), to_all.is_running());
    for (index, target) in to_all.units.iter_mut().enumerate() {
        ui.add_space(6.0);
        ui.push_id((target.connection, target.identity.address), |ui| {
            let progress = progress.filter(|_| current == Some(index));
            target_ui(ui, target, progress, is_running);
        });
    }
}

fn target_ui(ui: &mut Ui, target: &mut Target, progress: Progress<'_>, is_running: bool) {
    let name = target.name();
    ui.horizontal(|ui| {
        ui.add_enabled(!is_running, Checkbox::new(&mut target.chosen, name));
    });
    if let Some((share, text)) = progress {
        let text = with_time_left(ui, "to all units", *share, text);
        ui.add(ProgressBar::new(*share).desired_height(14.0).text(text));
    }
    ui.indent("unit", |ui| match &target.state {
        State::Waiting if target.chosen => drop(ui.weak("waits to be compared")),
        State::Waiting => drop(ui.weak("not compared")),
        State::Shown(share) => share_ui(ui, share),
        State::Refused(reasons) => {
            for reason in reasons {
                line_ui(ui, IndicatorState::Error, &reason.to_string());
            }
        }
        State::Done(gravity, text) => {
            let state = match gravity {
                Gravity::Note => IndicatorState::Ok,
                Gravity::Warning => IndicatorState::Warning,
                Gravity::Error => IndicatorState::Error,
            };
            line_ui(ui, state, &text.to_string());
        }
    });
}

fn line_ui(ui: &mut Ui, state: IndicatorState, text: &str) {
    ui.horizontal_top(|ui| {
        state.ui(ui, vec2(18.0, 18.0), 6.0);
        ui.add(Label::new(text).wrap());
    });
}

fn share_ui(ui: &mut Ui, share: &Share) {
    let text: Message = match share.differences.len() {
        0 => ToAllMessage::Same.into(),
        1 => ToAllMessage::Differs.into(),
        count => ToAllMessage::Differ { count }.into(),
    };
    if share.differences.is_empty() {
        line_ui(ui, IndicatorState::Ok, &text.to_string());
    } else {
        CollapsingHeader::new(text.to_string()).default_open(true).show(ui, |ui| differences_ui(ui, share));
    }
    for note in &share.notes {
        weak_ui(ui, &note.to_string());
    }
    for warning in &share.warnings {
        line_ui(ui, IndicatorState::Warning, &warning.to_string());
    }
}

fn differences_ui(ui: &mut Ui, share: &Share) {
    Grid::new("changes").num_columns(4).spacing([14.0, 2.0]).show(ui, |ui| {
        for difference in &share.differences {
            let Some(row) = share.table.row(&difference.key) else { continue };
            let [old, new] = row.format_both([difference.left, difference.right]);
            ui.label(row.title());
            ui.weak(old);
            ui.label("->");
            let described = difference.describe(row);
            let new = ui.strong(new);
            new.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &described));
            ui.end_row();
        }
    });
}
