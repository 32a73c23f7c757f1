//! The head of the screen: what is written and saved, what can be done, what is searched for, what runs.

use egui::{Button, Label, ProgressBar, RichText, Role, Ui, WidgetInfo, vec2};

use crate::command::{Command, Commands};
use crate::family::{Ability, Family, SettingsWords};
use crate::focus;
use crate::messages::SpokenMessage;
use crate::model::settings::{Running, Saved};
use crate::model::{GeneralView, IndicatorState, SettingsAction, Sheet, UnitSettings};
use crate::screens::messages::SettingMessage;
use crate::widgets::text_field::text_field_ui;
use crate::widgets::with_time_left;

const SEARCH_WIDTH: f32 = 190.0;
/// So that a count in a button moves nothing.
const BUTTON_WIDTH: f32 = 84.0;

pub fn head_ui(ui: &mut Ui, general: &mut GeneralView<'_>, family: &dyn Family, commands: &mut Commands) {
    marks_ui(ui, family.words(), general.unit());
    buttons_ui(ui, general, family);
    filter_ui(ui, general, family.words(), commands);
}

/// The title and the two marks: what differs from the controller, and whether it would survive a power cycle.
fn marks_ui(ui: &mut Ui, words: &SettingsWords, unit: Option<&UnitSettings>) {
    ui.horizontal(|ui| {
        focus::heading_ui(ui, words.title);
        let Some(unit) = unit else { return };
        let (state, text) = edits_mark(unit);
        mark_ui(ui, state, "Edits", &text);
        let (state, text) = saved_mark(unit);
        mark_ui(ui, state, "EEPROM", &text);
    });
}

fn edits_mark(unit: &UnitSettings) -> (IndicatorState, String) {
    match unit.changes().len() {
        _ if !unit.is_read() => (IndicatorState::Unknown, "not read yet".to_owned()),
        0 => (IndicatorState::Ok, "none".to_owned()),
        count => (IndicatorState::Warning, SettingMessage::NotWritten { count }.to_string()),
    }
}

fn saved_mark(unit: &UnitSettings) -> (IndicatorState, String) {
    match unit.saved() {
        Saved::Yes => (IndicatorState::Ok, "saved".to_owned()),
        Saved::Differs(count) => (IndicatorState::Warning, SettingMessage::NotSaved { count }.to_string()),
        Saved::NotKnown { written: 0 } => (IndicatorState::Unknown, "not known".to_owned()),
        Saved::NotKnown { written } => {
            (IndicatorState::Warning, SettingMessage::WrittenNotSaved { written }.to_string())
        }
    }
}

fn mark_ui(ui: &mut Ui, state: IndicatorState, title: &str, text: &str) {
    ui.add_space(6.0);
    state.ui(ui, vec2(14.0, 14.0), 6.0);
    let spoken = format!("{title}: {text}");
    let response = ui.add(Label::new(&spoken).selectable(false));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    response.on_hover_text(match title {
        "EEPROM" => {
            "What the controller will work with after a power cycle, as last known: \
             it is known after a save, or after loading it"
        }
        _ => "What is wanted here and the controller does not have yet",
    });
}

fn buttons_ui(ui: &mut Ui, general: &mut GeneralView<'_>, family: &dyn Family) {
    let words = family.words();
    let Some(unit) = general.unit() else { return };
    let idle = !general.is_busy();
    let edits = unit.edits().len();
    // What is still being typed becomes an edit as soon as its field is left, which a click on the button does.
    let has_edits = edits > 0 || (unit.has_typed() && unit.refused().is_empty());
    let write = if edits == 0 { "Write…".to_owned() } else { SettingMessage::Write { edits }.to_string() };
    let buttons = [
        ("Read…", "Read settings", idle, "Reads the controller's settings again", Sheet::Read),
        (
            write.as_str(),
            "Write settings",
            idle && has_edits,
            "Shows what will be written, old and new",
            Sheet::Write,
        ),
        (words.save, "Save to EEPROM", idle, "Keeps the settings over a power cycle", Sheet::Save),
        (words.defaults, "Default settings", idle, "Restores the factory settings", Sheet::Defaults),
        (
            "Open profile…",
            "Open profile",
            true,
            "Reads a file, shown beside the controller",
            Sheet::OpenProfile,
        ),
        ("Save profile…", "Save profile", true, "Keeps the settings in a file", Sheet::SaveProfile),
        (
            "Compare…",
            "Compare settings",
            true,
            "Any two of controller, EEPROM, profile, defaults and backup side by side",
            Sheet::Compare,
        ),
        ("Backups…", "Backups", true, "What was there before each write, save and restore", Sheet::Backups),
    ];
    let copy = family.lacks(Ability::SecondMotor).is_none().then_some((
        "Copy motor…",
        "Copy motor",
        true,
        "One motor's settings for the other one",
        Sheet::CopyMotor,
    ));
    let unfinished = general.settings.has_unfinished().then_some((
        "Unfinished…",
        "Unfinished",
        true,
        "What was cut short on this controller, setting by setting",
        Sheet::Unfinished,
    ));
    let mut wanted = None;
    ui.horizontal_wrapped(|ui| {
        for (text, name, enabled, note, sheet) in buttons.into_iter().chain(copy).chain(unfinished) {
            let is_open = general.sheet.as_ref() == Some(&sheet);
            let response = ui.add_enabled(
                enabled,
                Button::selectable(is_open, text).frame_when_inactive(true).min_size(vec2(BUTTON_WIDTH, 0.0)),
            );
            response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
            if response.on_hover_text(note).clicked() {
                wanted = Some(sheet);
            }
        }
    });
    if let Some(sheet) = wanted {
        general.open(sheet);
    }
}

/// One line, always as high: the search, and what runs or what is shown.
fn filter_ui(ui: &mut Ui, general: &mut GeneralView<'_>, words: &SettingsWords, commands: &mut Commands) {
    ui.horizontal(|ui| {
        ui.set_min_height(ui.spacing().interact_size.y);
        let mut is_new = false;
        ui.allocate_ui(vec2(SEARCH_WIDTH, ui.spacing().interact_size.y), |ui| {
            let search = text_field_ui(ui, &mut general.search, "Search settings", "Search");
            is_new |= search.changed();
            if std::mem::take(&mut general.wants_search) {
                search.request_focus();
            }
        });
        is_new |= ui.checkbox(&mut general.only_changed, "Only changed").changed();
        // What is looked for is in the list, which a sheet would stand in place of.
        if is_new {
            general.close_sheet();
        }
        let has_edits = general.unit().is_some_and(|unit| !unit.edits().is_empty() || unit.has_typed());
        if ui.add_enabled(has_edits, Button::new("Revert all")).clicked()
            && let Some(unit) = general.unit_mut()
        {
            unit.revert_all();
        }
        for (text, again, spoken, hint) in [
            ("Undo", false, SettingMessage::Undo, SettingMessage::UndoLast),
            ("Redo", true, SettingMessage::Redo, SettingMessage::RedoLast),
        ] {
            let can =
                general.unit().is_some_and(|unit| if again { unit.can_redo() } else { unit.can_undo() });
            let response = ui.add_enabled(can, Button::new(text));
            response.widget_info(|| WidgetInfo::labeled(Role::Button, can, spoken.to_string()));
            if response.on_hover_text(hint.to_string()).clicked() {
                commands.push(Command::StepSettings { again });
            }
        }
        match general.settings.running() {
            Some(running) => running_ui(ui, running, commands),
            None => idle_ui(ui, general, words.many),
        }
    });
}

fn idle_ui(ui: &mut Ui, general: &GeneralView<'_>, many: &'static str) {
    let Some(unit) = general.unit() else { return };
    let all = unit.table().rows().len();
    let text = if general.is_filtered() {
        SettingMessage::ShownOf { shown: general.shown().len(), all, many }.to_string()
    } else {
        format!("{all} {many}")
    };
    ui.add(Label::new(RichText::new(text).weak()).truncate());
}

fn running_ui(ui: &mut Ui, running: &Running, commands: &mut Commands) {
    let cancel = ui.add_enabled(!running.is_cancelled, Button::new("Cancel"));
    if cancel.on_hover_text("Ends it after the command that is on the wire").clicked() {
        commands.push(Command::Settings(SettingsAction::Cancel));
    }
    let text = if running.text.is_empty() { running.name().to_string() } else { running.text.clone() };
    let fraction = running.fraction.unwrap_or(0.0);
    let text = with_time_left(ui, "settings", fraction, &text);
    let bar = ProgressBar::new(fraction).desired_width(ui.available_width());
    let response = ui.add(bar.text(text.as_str()));
    let spoken = SpokenMessage::Progress { what: running.name().to_string(), text: text.clone() }.to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &spoken));
}
