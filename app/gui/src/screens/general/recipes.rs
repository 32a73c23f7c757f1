//! Recipes: what people want of a controller, each with its wiring, how its input stands now, what comes of it, and the settings that it makes
//! edits of. They are written like any other.

use brushwork_link::settings::SettingsTable;
use egui::{Align, Button, ComboBox, Label, Layout, RichText, ScrollArea, Ui, vec2};

use super::help;
use super::rows::{self, Columns};
use super::sheet_parts::{indicator_ui, text_ui};
use super::wiring::{self, wiring_ui};
use crate::command::Commands;
use crate::family::recipe::{Answers, Ask, Goal, Live, Recipe, Recipes, Told};
use crate::messages::NameMessage;
use crate::model::{Connection, GeneralView, IndicatorState, UnitSettings};
use crate::screens::messages::SettingMessage;
use crate::screens::status::path;
use crate::widgets::NO_VALUE;

/// Room that the scroll bar may take.
const BAR_WIDTH: f32 = 14.0;
/// What is said where a family has no words of its own for what it cannot do.
const WITHOUT: &str = "This controller, with the firmware that it has, has no setting for it.";
/// Text beside the wiring, where there is room for both.
const TEXT_WIDTH: f32 = 300.0;
/// Room for what is asked, before its list.
const ASK_WIDTH: f32 = 110.0;
const LIST_WIDTH: f32 = 170.0;

pub fn recipes_ui(
    ui: &mut Ui,
    front: &mut Connection,
    recipes: &'static dyn Recipes,
    height: f32,
    commands: &mut Commands,
) {
    let size = vec2(ui.available_width(), height);
    ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(height);
        let Some(unit) = front.settings.unit() else { return };
        let offered = recipes.of(unit.table());
        let first = offered.iter().find(|(_, recipe)| recipe.is_some()).or(offered.first());
        let Some((first, _)) = first else { return };
        let mut job = front.general.recipes.job.unwrap_or(*first);
        if jobs_ui(ui, &mut job, &offered) {
            front.general.recipes.job = Some(job);
            front.general.recipes.answers.one = 0;
        }
        ui.add_space(4.0);
        let salt = ("recipe", job.title());
        ScrollArea::vertical().id_salt(salt).auto_shrink(false).show(ui, |ui| {
            ui.label(RichText::new(job.title()).size(16.0).strong());
            match offered.iter().find(|(of, _)| *of == job).and_then(|(_, recipe)| *recipe) {
                Some(recipe) => recipe_ui(ui, front, recipes, recipe, commands),
                None => {
                    text_ui(ui, recipes.without(job).unwrap_or(WITHOUT));
                    goes_on_ui(ui, front, recipes, job, commands);
                }
            }
        });
    });
}

/// What can be chosen; what this controller cannot do is there, and says so. True where another was.
fn jobs_ui(ui: &mut Ui, current: &mut Goal, offered: &[(Goal, Option<&'static Recipe>)]) -> bool {
    let mut is_new = false;
    ui.horizontal_wrapped(|ui| {
        for (job, recipe) in offered {
            let text = RichText::new(job.title());
            let text = if recipe.is_some() { text } else { text.weak() };
            let button = Button::selectable(*current == *job, text).frame_when_inactive(true);
            if ui.add(button).clicked() {
                *current = *job;
                is_new = true;
            }
        }
    });
    is_new
}

/// The way to the screen on which it goes on.
fn goes_on_ui(ui: &mut Ui, front: &Connection, recipes: &dyn Recipes, job: Goal, commands: &mut Commands) {
    if let Some(place) = recipes.goes_on(job) {
        ui.add_space(4.0);
        if ui.button(path::place_text(front, place)).clicked() {
            commands.push(path::place_command(front, place));
        }
    }
}

fn recipe_ui(
    ui: &mut Ui,
    front: &mut Connection,
    recipes: &'static dyn Recipes,
    recipe: &'static Recipe,
    commands: &mut Commands,
) {
    let width = ui.available_width() - BAR_WIDTH;
    let wiring_width = wiring::SIZE.x;
    let is_wide = width >= TEXT_WIDTH + wiring_width;
    complete(front, recipes, recipe);
    let answers = front.general.recipes.answers.clone();
    let name = terminal_names(front, recipes, recipe, &answers);
    if is_wide {
        ui.horizontal_top(|ui| {
            let left = width - wiring_width - ui.spacing().item_spacing.x;
            ui.allocate_ui_with_layout(vec2(left, 0.0), Layout::top_down(Align::Min), |ui| {
                ui.set_width(left);
                ask_ui(ui, front, recipes, recipe);
                goes_on_ui(ui, front, recipes, recipe.job, commands);
            });
            wiring_ui(ui, &recipe.wiring, &name);
        });
    } else {
        ask_ui(ui, front, recipes, recipe);
        goes_on_ui(ui, front, recipes, recipe.job, commands);
        wiring_ui(ui, &recipe.wiring, &name);
    }
    consequences_ui(ui, front, recipes, recipe);
    settings_ui(ui, front, recipes, recipe, width);
}

/// Chooses what was not chosen yet: the first pin that is free, or else the first that can do it.
fn complete(front: &mut Connection, recipes: &dyn Recipes, recipe: &Recipe) {
    let Some(unit) = front.settings.unit() else { return };
    let Some(wanted) = recipe.pin_use() else { return };
    let able = recipes.able_pins(unit.table(), wanted);
    let answers = &mut front.general.recipes.answers;
    if !able.contains(&answers.pin) {
        let group = brushwork_link::settings::Group::PINS;
        let is_free = |pin: &&usize| unit.function(group, **pin).is_none_or(|function| function == "None");
        answers.pin = able.iter().find(is_free).or(able.first()).copied().unwrap_or_default();
    }
    answers.motor = answers.motor.min(recipes.motors(unit.table()));
}

/// What is done, what is asked, how it stands, and the button that makes it edits.
fn ask_ui(ui: &mut Ui, front: &mut Connection, recipes: &'static dyn Recipes, recipe: &'static Recipe) {
    let answers = front.general.recipes.answers.clone();
    text_ui(ui, &recipe.fill(recipe.text, &answers, &|_, _| None));
    ui.add_space(4.0);
    if let Some(unit) = front.settings.unit() {
        let answers = &mut front.general.recipes.answers;
        for ask in recipe.asks {
            ui.horizontal_wrapped(|ui| one_ask_ui(ui, *ask, answers, unit.table(), recipes));
        }
    }
    live_ui(ui, front, recipes, recipe.live);
    if recipe.sets.is_empty() {
        return;
    }
    let answers = front.general.recipes.answers.clone();
    let Some(unit) = front.settings.unit_mut() else { return };
    let encoder_pin = |motor, phase| recipes.encoder_pin(unit.table(), motor, phase);
    let wanted = recipe.settings(unit.table(), &answers, &encoder_pin).unwrap_or_default();
    let lock = wanted.iter().find_map(|(key, value)| {
        let row = unit.table().row(key)?;
        unit.locked(row).filter(|_| unit.wanted(key) != Some(*value) && !unit.is_writable(row))
    });
    let is_done = wanted.iter().all(|(key, value)| unit.wanted(key) == Some(*value));
    let can = lock.is_none() && !is_done && unit.is_read();
    ui.add_space(4.0);
    let is_held = wanted.iter().all(|(key, value)| unit.on_controller(key) == Some(*value));
    let title = match (is_done, is_held) {
        (true, true) => "It is set so",
        (true, false) => "Wanted so, not written yet",
        (false, _) => "Make these the wanted settings",
    };
    let button = ui.add_enabled(can, Button::new(title));
    let hint = "They become edits below, and count once they are written";
    if button.on_hover_text(hint).clicked() {
        if let Some(wanted) = recipe.pin_use() {
            let used = unit.look(|looked| recipes.pin_use(looked, answers.pin, wanted));
            unit.set_all(&used);
        }
        for (key, value) in wanted {
            unit.set(&key, value);
        }
    }
    if let Some(why) = lock {
        indicator_ui(ui, IndicatorState::Warning, why);
    }
}

fn one_ask_ui(ui: &mut Ui, ask: Ask, answers: &mut Answers, table: &SettingsTable, recipes: &dyn Recipes) {
    let word = |ui: &mut Ui, text: &str| crate::widgets::label::fixed_label_ui(ui, text, ASK_WIDTH);
    match ask {
        Ask::Motor => {
            word(ui, "Motor");
            for motor in 1..=recipes.motors(table) {
                if ui
                    .radio(answers.motor() == motor, NameMessage::Motor { number: motor }.to_string())
                    .clicked()
                {
                    answers.motor = motor;
                }
            }
        }
        Ask::Pin(wanted) => {
            word(ui, "Pin");
            let name = |pin: usize| table.subject().pin_name(pin.max(1) - 1);
            let list = ComboBox::from_id_salt("pin of the recipe").width(LIST_WIDTH);
            let shown = list.selected_text(name(answers.pin)).show_ui(ui, |ui| {
                for pin in recipes.able_pins(table, wanted) {
                    ui.selectable_value(&mut answers.pin, pin, name(pin));
                }
            });
            ui.ctx().accesskit_node_builder(shown.response.id, |node| node.set_label("Pin of the recipe"));
        }
        Ask::Contact => {
            word(ui, "Contact");
            ui.radio_value(&mut answers.pulls_up, false, "Closes to ground");
            ui.radio_value(&mut answers.pulls_up, true, "Closes to 5 V");
        }
        Ask::One(_, choices) => {
            word(ui, "Which");
            answers.one = answers.one.min(choices.len().saturating_sub(1));
            for (place, (text, _)) in choices.iter().enumerate() {
                ui.radio_value(&mut answers.one, place, *text);
            }
        }
    }
}

/// How things stand on the controller now, where it tells.
fn live_ui(ui: &mut Ui, front: &Connection, recipes: &dyn Recipes, live: Live) {
    match live {
        Live::Nothing => {}
        Live::Pin => {
            let pin = front.general.recipes.answers.pin;
            let signal = front.link.readings.signal(pin);
            let state = front
                .settings
                .unit()
                .and_then(|unit| unit.look(|looked| recipes.pin_state(looked, pin, signal)));
            if let Some(state) = state {
                indicator_ui(ui, IndicatorState::Active, &state);
            }
        }
        Live::Channels(channels) => {
            let of = |channel: &brushwork_link::Channel| {
                let value = front.link.readings.text(*channel).unwrap_or_else(|| NO_VALUE.to_owned());
                format!("{}: {value} {}", channel.label, channel.unit)
            };
            let all: Vec<String> = channels.iter().map(of).collect();
            indicator_ui(
                ui,
                IndicatorState::Active,
                &SettingMessage::Readings { readings: all.join(", ").trim_end().to_string() }.to_string(),
            );
        }
        Live::All(all) => {
            for live in all {
                live_ui(ui, front, recipes, *live);
            }
        }
        Live::Board => {
            let told = front.link.identity().and_then(|identity| front.family().unit_row(identity));
            if let Some((title, value)) = told {
                let row = SettingMessage::BoardNow { title, value }.to_string();
                indicator_ui(ui, IndicatorState::Active, &row);
            }
        }
        Live::Indicators(names) => {
            for info in front.family().indicators().iter().filter(|info| names.contains(&info.short)) {
                let state = front.link.indicators.named(info.short);
                let word = if state == IndicatorState::Ok { "not active" } else { state.word() };
                indicator_ui(
                    ui,
                    state,
                    &SettingMessage::IndicatorNow { title: info.title, state: word }.to_string(),
                );
            }
        }
    }
}

/// What comes of it: what always holds, and what the edits will do as things stand now.
fn consequences_ui(ui: &mut Ui, front: &Connection, recipes: &dyn Recipes, recipe: &Recipe) {
    ui.add_space(4.0);
    ui.add(Label::new(RichText::new(recipe.consequence).weak()).wrap());
    for (state, text) in consequences(front, recipes) {
        indicator_ui(ui, state, &text);
    }
}

/// What the edits will do as soon as they are written.
pub fn consequences(
    front: &Connection,
    recipes: &dyn Recipes,
) -> Vec<(IndicatorState, brushwork_link::Message)> {
    let signal = |pin| front.link.readings.signal(pin);
    let reading = |channel| front.link.readings.get(channel);
    let status = front.link.status.as_ref().map(|report| report.word);
    let told = Told { identity: front.link.identity(), signal: &signal, reading: &reading, status };
    let unit = front.settings.unit();
    unit.map(|unit| unit.look(|looked| recipes.consequences(looked, &told))).unwrap_or_default()
}

/// The settings themselves, as they stand in the lists.
fn settings_ui(ui: &mut Ui, front: &mut Connection, recipes: &dyn Recipes, recipe: &Recipe, width: f32) {
    let answers = front.general.recipes.answers.clone();
    let Some(table) = front.settings.unit().map(UnitSettings::table) else { return };
    let encoder_pin = |motor, phase| recipes.encoder_pin(table, motor, phase);
    let keys = recipe.keys(table, &answers, &encoder_pin);
    if keys.is_empty() {
        return;
    }
    ui.add_space(6.0);
    let columns = Columns::fit(width, ui.spacing().item_spacing.x);
    rows::header_ui(ui, columns);
    let general = &mut GeneralView::new(&mut front.settings, &mut front.general);
    let mut all = None;
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        rows::list_ui(ui, general, &keys, columns, &mut |_, _, _| {});
    });
    ui.add_space(4.0);
    if let Some(key) = keys.first()
        && ui
            .button("All settings of this part")
            .on_hover_text("Goes to where the first of them stands")
            .clicked()
    {
        all = Some(key.clone());
    }
    // What is explained stands below, where it moves nothing.
    let explained = general.explained.clone().filter(|key| keys.contains(key));
    if let Some((unit, row)) =
        general.unit().and_then(|unit| Some((unit, unit.table().row(explained.as_deref()?)?)))
    {
        ui.add_space(4.0);
        help::row_ui(ui, unit, row);
    }
    if let Some(key) = all {
        general.go_to(&key);
    }
}

/// The names of the controller's terminals, as the wiring has them.
fn terminal_names(
    front: &Connection,
    recipes: &dyn Recipes,
    recipe: &Recipe,
    answers: &Answers,
) -> impl Fn(&str) -> String + use<> {
    let table = front.settings.unit().map(UnitSettings::table);
    let names: Vec<(String, String)> = recipe
        .wiring
        .wires
        .iter()
        .filter_map(|(_, terminal)| {
            let table = table?;
            let common = if answers.pulls_up { "5V" } else { "GND" };
            let pin = table.subject().pin_name(answers.pin.max(1) - 1);
            let text = terminal.replace("{common}", common).replace("{pin}", &pin);
            let encoder_pin = |motor, phase| recipes.encoder_pin(table, motor, phase);
            let text = recipe.fill(&text, answers, &encoder_pin);
            let is_claw = matches!(text.as_str(), "s4" | "s5");
            Some(((*terminal).to_owned(), if is_claw { text.to_uppercase() } else { text }))
        })
        .collect();
    move |terminal: &str| {
        let found = names.iter().find(|(of, _)| of == terminal);
        found.map_or_else(|| terminal.to_owned(), |(_, name)| name.clone())
    }
}
