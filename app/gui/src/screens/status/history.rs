//! What happened since the connection: counts first, then every event, the newest on top.

use egui::{Align, Label, Layout, RichText, Role, ScrollArea, Ui, WidgetInfo, vec2};

use crate::model::history::{Entry, History, clock_text};
use crate::screens::messages::StatusMessage;
use crate::theme::{self};
use crate::widgets::heading::heading_ui;

/// The list is at least this high, however small the window.
pub const LEAST_HEIGHT: f32 = 300.0;

const ROW_HEIGHT: f32 = 20.0;
const TIME_WIDTH: f32 = 84.0;

pub fn history_ui(ui: &mut Ui, history: &mut History, height: f32) {
    let bottom = ui.cursor().top() + height;
    let mut clear = false;
    ui.horizontal(|ui| {
        heading_ui(ui, "Event history");
        let connected = match history.connected_for() {
            Some(time) => StatusMessage::ConnectedFor { time: clock_text(time) }.to_string(),
            None => "the link has ended".to_owned(),
        };
        ui.weak(connected);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let response = ui.add_enabled(!history.is_empty(), egui::Button::new("Clear history"));
            clear = response
                .on_hover_text("Forgets the list and its counts; indicators keep their times")
                .clicked();
        });
    });
    counts_ui(ui, history);
    if history.is_empty() {
        let hint = "Nothing has happened since the list was cleared. Conditions that come and go, stops, disarmings and losses \
                    are listed here.";
        ui.weak(hint);
    }
    let list_height = (bottom - ui.cursor().top() - 4.0).max(4.0 * ROW_HEIGHT);
    ui.spacing_mut().item_spacing.y = 2.0;
    let list = ScrollArea::vertical().id_salt("history").max_height(list_height).auto_shrink([false, true]);
    list.show_rows(ui, ROW_HEIGHT, history.len(), |ui, rows| {
        for index in rows {
            if let Some(entry) = history.from_newest(index) {
                ui.push_id(entry.number, |ui| entry_ui(ui, entry));
            }
        }
    });
    if clear {
        history.clear();
    }
}

fn counts_ui(ui: &mut Ui, history: &History) {
    if history.counts().next().is_none() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for (state, name, count) in history.counts() {
            state.ui(ui, vec2(14.0, ROW_HEIGHT), 5.0);
            ui.label(format!("{name} ×{count}"));
            ui.add_space(6.0);
        }
        if history.dropped > 0 {
            ui.label(match history.dropped {
                1 => StatusMessage::OneNoLongerListed.to_string(),
                count => StatusMessage::NoLongerListed { count }.to_string(),
            });
        }
    });
}

fn entry_ui(ui: &mut Ui, entry: &Entry) {
    ui.horizontal(|ui| {
        ui.set_height(ROW_HEIGHT);
        let time = clock_text(entry.at);
        let font = theme::figures().resolve(ui.style());
        ui.allocate_ui_with_layout(
            vec2(TIME_WIDTH, ROW_HEIGHT),
            Layout::right_to_left(Align::Center),
            |ui| {
                ui.label(RichText::new(&time).font(font).weak());
            },
        );
        entry.kind.state().ui(ui, vec2(18.0, ROW_HEIGHT), 5.0);
        let unit = if entry.place.is_empty() { String::new() } else { format!("{}  ", entry.place) };
        let spoken = format!("{time} {unit}{}", entry.text);
        let text = ui.add(Label::new(format!("{unit}{}", entry.text)).truncate());
        text.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
        text.on_hover_text(&entry.text);
    });
}
