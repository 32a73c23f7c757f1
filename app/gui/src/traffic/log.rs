//! The list of transactions: only rows in sight are laid out.

use crate::messages::{TrafficMessage, WindowStatusMessage};
use std::path::PathBuf;

use egui::{
    Align2, ComboBox, FontId, Label, RichText, Role, ScrollArea, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2,
};

use crate::command::Commands;
use crate::family::Family;
use crate::files::{FileAction, FileAnswer, FileDialog, FileKind};
use crate::model::traffic::{Filter, Log, Outcome, Traffic, Transaction};
use crate::model::{IndicatorState, Model};
use crate::theme::{self, Palette};
use crate::widgets::{choice_ui, text_field_ui};

const ROW_HEIGHT: f32 = 18.0;
const TIME_WIDTH: f32 = 92.0;
const DURATION_WIDTH: f32 = 78.0;
/// Share of the rest that the words get; the bytes get what is left.
const WORDS_SHARE: f32 = 0.58;

/// What is done with the list, at the right of the panel's head.
pub fn head_ui(ui: &mut Ui, model: &mut Model, _commands: &mut Commands) {
    let traffic = &mut model.front.traffic;
    let has_any = traffic.log.shown_len() > 0;
    if ui.add_enabled(!traffic.log.is_empty(), egui::Button::new("Clear log")).clicked() {
        traffic.log.clear();
    }
    if ui
        .add_enabled(has_any, egui::Button::new("Save log…"))
        .on_hover_text("What the filter lets through")
        .clicked()
    {
        traffic.saving = Some(traffic.saving.take().unwrap_or_else(|| "traffic.txt".to_owned()));
    }
    if ui
        .add_enabled(has_any, egui::Button::new("Copy log"))
        .on_hover_text("What the filter lets through")
        .clicked()
    {
        ui.ctx().copy_text(traffic.log.to_text());
        let count = traffic.log.shown_len();
        model.messages.note(WindowStatusMessage::Copied { count });
    }
    let paused = model.front.traffic.log.paused;
    let pause = if paused { "Record again" } else { "Pause log" };
    if ui.button(pause).on_hover_text("Stops and continues the recording; the link goes on").clicked() {
        model.front.traffic.log.set_paused(!paused);
    }
}

pub fn log_ui(ui: &mut Ui, model: &mut Model, _commands: &mut Commands) {
    saving_ui(ui, model);
    let connected = model.front.is_connected();
    let family = model.front.family();
    let traffic = &mut model.front.traffic;
    filter_ui(ui, &mut traffic.log, family);
    summary_ui(ui, &traffic.log);
    if traffic.log.shown_len() == 0 {
        let hint = hint(traffic, connected);
        ui.weak(hint);
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    let list = ScrollArea::vertical().id_salt("traffic").auto_shrink([false, false]).stick_to_bottom(true);
    list.show_rows(ui, ROW_HEIGHT, traffic.log.shown_len(), |ui, rows| {
        for index in rows {
            if let Some(transaction) = traffic.log.shown(index) {
                row_ui(ui, transaction);
            }
        }
    });
}

fn hint(traffic: &Traffic, connected: bool) -> &'static str {
    match (traffic.log.is_empty(), traffic.log.paused, connected) {
        (false, ..) => "Nothing passes the filter.",
        (true, true, _) => "Paused. Press Record again to go on.",
        (true, false, true) => "Nothing has gone over the wire since the panel was opened.",
        (true, false, false) => {
            "Not connected. What goes over the wire is listed here, with times and bytes."
        }
    }
}

fn filter_ui(ui: &mut Ui, log: &mut Log, family: &dyn Family) {
    let mut filter: Filter = log.filter().clone();
    ui.horizontal(|ui| {
        ui.scope(|ui| {
            ui.set_max_width((ui.available_width() * 0.4).clamp(120.0, 340.0));
            text_field_ui(ui, &mut filter.text, "Filter traffic", "Filter: words or bytes, as 80 18");
        });
        let text = |command: Option<u8>| match command {
            None => "All commands".to_owned(),
            Some(number) => format!("{number} {}", family.command_title(number)),
        };
        let each = std::iter::once_with(|| log.commands()).flatten().map(Some);
        let list = ComboBox::from_id_salt("traffic command").width(190.0);
        choice_ui(ui, list, "Command", &mut filter.command, std::iter::once(None).chain(each), text);
        ui.checkbox(&mut filter.only_failures, "Only failures");
    });
    log.set_filter(filter);
}

fn summary_ui(ui: &mut Ui, log: &Log) {
    let mut text = TrafficMessage::Shown { shown: log.shown_len(), all: log.len() }.to_string();
    match log.dropped {
        0 => {}
        1 => text += &TrafficMessage::OneDropped.to_string(),
        dropped => text += &TrafficMessage::Dropped { dropped }.to_string(),
    }
    match log.missed {
        0 if !log.paused => {}
        1 => text += &TrafficMessage::OneMissed.to_string(),
        missed => text += &TrafficMessage::Missed { missed }.to_string(),
    }
    ui.label(RichText::new(text).small().weak());
}

/// The name of the file to save to, while one is asked for.
fn saving_ui(ui: &mut Ui, model: &mut Model) {
    let traffic = &mut model.front.traffic;
    let Some(mut name) = traffic.saving.take() else { return };
    let mut keep = true;
    if let Some(dialog) = &traffic.dialog {
        match dialog.answer() {
            FileAnswer::Chosen(path) => {
                name = path.display().to_string();
                traffic.asked_about = Some(name.clone());
                traffic.dialog = None;
            }
            FileAnswer::None => traffic.dialog = None,
            FileAnswer::Waiting => {}
        }
    }
    ui.horizontal(|ui| {
        ui.scope(|ui| {
            ui.set_max_width((ui.available_width() - 220.0).max(120.0));
            text_field_ui(ui, &mut name, "File for the traffic", "Path of the file");
        });
        if ui.button("Browse…").clicked() {
            let kind = FileKind { title: "Text".to_owned(), extension: "txt".to_owned() };
            traffic.dialog = Some(FileDialog::ask(FileAction::Save { name: "traffic.txt".to_owned() }, kind));
        }
        if ui.add_enabled(!name.trim().is_empty(), egui::Button::new("Save traffic")).clicked() {
            match traffic.save(&PathBuf::from(name.trim())) {
                Ok(said) => {
                    model.messages.note(said);
                    keep = false;
                }
                Err(said) => model.messages.fail(said),
            }
        }
        if ui.button("Cancel").clicked() {
            keep = false;
        }
    });
    model.front.traffic.saving = keep.then_some(name);
}

fn row_ui(ui: &mut Ui, transaction: &Transaction) {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::hover());
    let words = transaction.words();
    let spoken = format!("{}: {words}", transaction.outcome.word());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let small = TextStyle::Small.resolve(ui.style());
    let figures = FontId::new(small.size, theme::figures().resolve(ui.style()).family);
    let y = rect.center().y;
    let painter = ui.painter().with_clip_rect(rect);
    let right = |x: f32, text: String| {
        painter.text(pos2(x, y), Align2::RIGHT_CENTER, text, figures.clone(), palette.weak_text);
    };
    right(rect.left() + TIME_WIDTH, format!("{:.4} s", transaction.at.as_secs_f64()));
    if let Some(duration) = transaction.duration {
        right(
            rect.left() + TIME_WIDTH + DURATION_WIDTH,
            format!("{:.2} ms", duration.as_secs_f64() * 1000.0),
        );
    }
    let state = state_of(transaction.outcome);
    let left = rect.left() + TIME_WIDTH + DURATION_WIDTH + 24.0;
    state.paint(ui, pos2(left - 12.0, y), 4.0);
    let middle = left + (rect.right() - left) * WORDS_SHARE;
    let color = if transaction.outcome.is_failure() { palette.error } else { palette.text };
    let words_at = painter.with_clip_rect(rect.with_max_x(middle - 8.0));
    words_at.text(pos2(left, y), Align2::LEFT_CENTER, &words, small, color);
    painter.text(pos2(middle, y), Align2::LEFT_CENTER, transaction.packets(), figures, palette.weak_text);
    response.on_hover_ui(|ui| {
        ui.add(Label::new(&words).wrap());
        ui.add(Label::new(RichText::new(transaction.packets()).monospace()).wrap());
    });
}

const fn state_of(outcome: Outcome) -> IndicatorState {
    match outcome {
        Outcome::Waiting | Outcome::NotRecorded => IndicatorState::Unknown,
        Outcome::Good => IndicatorState::Ok,
        Outcome::NoAnswer | Outcome::Damaged => IndicatorState::Error,
        Outcome::Unasked => IndicatorState::Warning,
    }
}
