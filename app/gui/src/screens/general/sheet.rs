//! What each act will do, shown before it is done; and what did not go as wanted, after.

use brushwork_link::Message;
use brushwork_link::settings::{Difference, Plan, diff};
use brushwork_link::transport::Stream;
use brushwork_values::hex;
use egui::{Button, CollapsingHeader, RichText, ScrollArea, Ui, vec2};

use super::sheet_parts::{Act, Offer, differences_ui, indicator_ui, text_ui, title_ui};
use super::{compare, kept, profile};
use crate::command::{Command, Commands};
use crate::family::SettingsWords;
use crate::keys::top_layer;
use crate::model::{GeneralView, IndicatorState, Saved, SettingsAction, Sheet, Take, UnitSettings};
use crate::screens::messages::SettingMessage;
use brushwork_core::keep::WearLevel;

/// Room for the buttons below the text.
const BUTTONS_HEIGHT: f32 = 44.0;

/// What is known of a write before it: the port that this end is wired to, and what the edits will do at once.
type Writing<'w> = (Option<Stream>, &'w [(IndicatorState, Message)]);

pub fn sheet_ui(
    ui: &mut Ui,
    general: &mut GeneralView<'_>,
    writing: Writing<'_>,
    words: &SettingsWords,
    commands: &mut Commands,
) {
    general.follow_dialog();
    let Some(sheet) = general.sheet.clone() else { return };
    let height = (ui.available_height() - BUTTONS_HEIGHT).max(60.0);
    let offers = ui.scope(|ui| {
        // The buttons stand below what is said, and at the bottom only where that is long.
        let area = ScrollArea::vertical().id_salt(format!("{sheet:?}")).auto_shrink([false, true]);
        let area = area.max_height(height);
        area.show(ui, |ui| content_ui(ui, general, &sheet, writing, words)).inner
    });
    buttons_ui(ui, general, &offers.inner, commands);
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn content_ui(
    ui: &mut Ui,
    general: &mut GeneralView<'_>,
    sheet: &Sheet,
    writing: Writing<'_>,
    words: &SettingsWords,
) -> Vec<Offer> {
    match sheet {
        Sheet::OpenProfile => return profile::open_ui(ui, general),
        Sheet::SaveProfile => return profile::save_ui(ui, general),
        Sheet::Upgrade => return profile::upgrade_ui(ui, general),
        Sheet::Compare => return compare::compare_ui(ui, general),
        Sheet::Backups => return kept::backups_ui(ui, general),
        Sheet::CopyMotor => return kept::copy_motor_ui(ui, general),
        Sheet::Unfinished => return kept::unfinished_ui(ui, general),
        Sheet::Save => return save_ui(ui, general, words),
        Sheet::Read | Sheet::Write | Sheet::Defaults | Sheet::Report { .. } => {}
    }
    let Some(unit) = general.unit() else { return Vec::new() };
    match sheet {
        Sheet::Read => read_ui(ui, unit, words),
        Sheet::Write => write_ui(ui, unit, writing),
        Sheet::Defaults => defaults_ui(ui, unit, words),
        Sheet::Report { title, sentences } => report_ui(ui, &title.to_string(), sentences),
        _ => Vec::new(),
    }
}

fn buttons_ui(ui: &mut Ui, general: &mut GeneralView<'_>, offers: &[Offer], commands: &mut Commands) {
    let focus = std::mem::take(&mut general.sheet_is_new);
    let mut chosen = None;
    let mut close = false;
    ui.horizontal(|ui| {
        for (index, (text, act, enabled)) in offers.iter().enumerate() {
            let response = ui.add_enabled(*enabled, Button::new(*text).min_size(vec2(120.0, 30.0)));
            if focus && index == 0 && *enabled {
                response.request_focus();
            }
            if response.clicked() {
                chosen = Some(*act);
            }
        }
        let back = ui.add(Button::new("Back").min_size(vec2(90.0, 30.0)));
        if focus && !offers.first().is_some_and(|(_, _, enabled)| *enabled) {
            back.request_focus();
        }
        let is_on_top = top_layer(ui.ctx()).is_none();
        close = back.clicked() || (is_on_top && ui.input(|input| input.key_pressed(egui::Key::Escape)));
    });
    match chosen {
        Some(Act::FamilyAction(action)) => commands.push(Command::Settings(action)),
        Some(Act::OpenProfile { mending }) => general.open_profile(mending),
        Some(Act::SaveProfile) => general.save_profile(),
        Some(Act::TakeOverAll) => {
            general.take_over(&Take::All);
            close = true;
        }
        Some(Act::ToAll) => commands.push(Command::OpenToAll),
        Some(Act::UseUpgraded) => general.use_upgraded(),
        Some(Act::CopyMotor) => {
            general.copy_motor();
            close = true;
        }
        Some(Act::Settle(how)) => general.settle(how),
        None => {}
    }
    if close && !focus {
        general.close_sheet();
    }
}

fn read_ui(ui: &mut Ui, unit: &UnitSettings, words: &SettingsWords) -> Vec<Offer> {
    title_ui(ui, "Read settings");
    text_ui(ui, "Read asks the controller for every setting it works with now. Nothing on it changes.");
    text_ui(ui, words.reload_text);
    if !unit.unsaved().is_empty() {
        text_ui(ui, "These come back (works with now -> in EEPROM, as last known):");
        differences_ui(ui, unit, unit.unsaved().iter().map(swapped));
    }
    if !unit.edits().is_empty() {
        text_ui(ui, "Your changes that are not written stay on this screen either way.");
    }
    vec![
        ("Read", Act::FamilyAction(SettingsAction::Read), true),
        ("Load from EEPROM", Act::FamilyAction(SettingsAction::Reload), true),
    ]
}

fn swapped(difference: &Difference) -> Difference {
    Difference { key: difference.key.clone(), left: difference.right, right: difference.left }
}

fn write_ui(ui: &mut Ui, unit: &UnitSettings, (stream, will): Writing<'_>) -> Vec<Offer> {
    let changes = unit.changes();
    title_ui(ui, "Write settings");
    text_ui(
        ui,
        "Writes these to what the controller works with (RAM) and reads them back. A power cycle brings the old \
         ones back until they are saved to EEPROM. A backup is made first.",
    );
    differences_ui(ui, unit, changes.iter().cloned());
    for (state, what) in will {
        indicator_ui(ui, *state, what);
    }
    for refusal in unit.refused() {
        indicator_ui(
            ui,
            IndicatorState::Warning,
            &SettingMessage::Refused { refusal: refusal.to_string() }.to_string(),
        );
    }
    let can_be_written = match unit.plan(stream) {
        Ok(plan) => {
            for warning in &plan.warnings {
                indicator_ui(ui, IndicatorState::Warning, warning);
            }
            bytes_ui(ui, unit, &plan);
            true
        }
        Err(refusals) => {
            for refusal in &refusals {
                indicator_ui(ui, IndicatorState::Error, &refusal.sentence);
            }
            false
        }
    };
    vec![(
        "Write to controller",
        Act::FamilyAction(SettingsAction::Write),
        can_be_written && !changes.is_empty(),
    )]
}

/// The packets of a plan, for who wants to see them before they are sent.
fn bytes_ui(ui: &mut Ui, unit: &UnitSettings, plan: &Plan) {
    let address = unit.unit_address;
    let generation = unit.table().subject().generation;
    CollapsingHeader::new("Show the bytes").show(ui, |ui| {
        for step in &plan.steps {
            let bytes =
                step.bytes(address, generation).map_or_else(|why| why.to_string(), |bytes| hex(&bytes));
            ui.label(format!("{}: {}", step.title(), step.words(address, generation)));
            ui.label(RichText::new(bytes).monospace().weak());
        }
        match plan.hidden.len() {
            0 => {}
            1 => drop(ui.label(SettingMessage::OneHidden.to_string())),
            count => drop(ui.label(SettingMessage::Hidden { count }.to_string())),
        }
    });
}

fn save_ui(ui: &mut Ui, general: &GeneralView<'_>, words: &SettingsWords) -> Vec<Offer> {
    let Some(unit) = general.unit() else { return Vec::new() };
    title_ui(ui, "Save to EEPROM");
    text_ui(ui, words.save_text);
    if let Some(warning) = words.save_warning {
        indicator_ui(ui, IndicatorState::Warning, warning);
    }
    match (unit.saved(), general.settings.known_eeprom().zip(unit.ram())) {
        (Saved::Yes, _) => text_ui(ui, "As far as known its EEPROM holds the same already."),
        (Saved::Differs(_), _) => {
            text_ui(ui, "These are saved (in EEPROM, as last known -> works with now):");
            differences_ui(ui, unit, unit.unsaved().into_iter());
        }
        (Saved::NotKnown { .. }, Some((known, ram))) => {
            text_ui(ui, &SettingMessage::SavedSince { date: known.date_text() }.to_string());
            let both = |each: &Difference| each.left.is_some() && each.right.is_some();
            differences_ui(ui, unit, diff(unit.table(), &known.settings, ram).into_iter().filter(both));
        }
        (Saved::NotKnown { .. }, None) => {
            text_ui(ui, "What its EEPROM holds now is not known, so what changes there cannot be listed.");
        }
    }
    if !unit.edits().is_empty() {
        let text =
            "Changes on this screen that are not written are not saved. Write them first to keep them.";
        indicator_ui(ui, IndicatorState::Warning, text);
    }
    match general.settings.wear() {
        Ok((wear, limits)) => {
            let state = match wear.level() {
                WearLevel::Fine => IndicatorState::Ok,
                WearLevel::Half => IndicatorState::Warning,
                WearLevel::Worn => IndicatorState::Error,
            };
            indicator_ui(ui, state, &format!("{} {limits}", wear.sentence()));
        }
        Err(fault) => indicator_ui(ui, IndicatorState::Warning, fault),
    }
    vec![(words.save_now, Act::FamilyAction(SettingsAction::Save), true)]
}

fn defaults_ui(ui: &mut Ui, unit: &UnitSettings, words: &SettingsWords) -> Vec<Offer> {
    let changes = unit.changes_to_defaults();
    title_ui(ui, "Default settings");
    text_ui(ui, words.defaults_text);
    if let Some(warning) = words.defaults_warning {
        indicator_ui(ui, IndicatorState::Warning, warning);
    }
    if changes.is_empty() {
        text_ui(ui, "As far as known it has its defaults already.");
    } else {
        text_ui(ui, "As far as the defaults are known this changes (works with now -> default):");
        differences_ui(ui, unit, changes.into_iter());
    }
    if !unit.edits().is_empty() {
        text_ui(ui, "Your changes that are not written stay on this screen.");
    }
    vec![(words.defaults_now, Act::FamilyAction(SettingsAction::RestoreDefaults), true)]
}

fn report_ui(ui: &mut Ui, title: &str, sentences: &[Message]) -> Vec<Offer> {
    title_ui(ui, title);
    for sentence in sentences {
        indicator_ui(ui, IndicatorState::Error, sentence);
    }
    Vec::new()
}
