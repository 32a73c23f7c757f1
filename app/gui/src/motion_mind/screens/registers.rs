//! All 32 registers: what is wanted, what the unit works with, what its EEPROM holds, with an editor for the bits.
//!
//! The rows that can be written are rows of the settings table, so that writing, storing, profiles, comparisons and backups
//! are those of every family. What the unit measures stands among them and is read again and again.

use brushwork_link::settings::{Difference, Row, SettingValue, diff};
use brushwork_motion_mind_wire::{REGISTERS, Register};
use egui::{
    Align, Button, Frame, Label, Layout, Margin, RichText, Role, ScrollArea, Sense, Stroke, Ui, UiBuilder,
    WidgetInfo, vec2,
};

use super::bits::{bits_ui, has_bits};
use crate::command::Commands;
use crate::model::{Connection, IndicatorState, Model, Section, UnitSettings};
use crate::motion_mind::messages::RegisterMessage;
use crate::motion_mind::model::registers::{in_unit, key};
use crate::motion_mind::recipes::MindRecipes;
use crate::screens::general::{editor, framed_ui, recipes};
use crate::theme::{self, Palette};
use crate::widgets::{NO_VALUE, fixed_label_ui};
use brushwork_core::words::capital;

const HEIGHT: f32 = 27.0;
const MARK_WIDTH: f32 = 16.0;
const NUMBER_WIDTH: f32 = 20.0;
const NAME_WIDTH: f32 = 132.0;
const WANTED_WIDTH: f32 = 150.0;
const VALUE_WIDTH: f32 = 94.0;
const GAP: f32 = 6.0;
/// All columns, with a scroll bar.
const TABLE_WIDTH: f32 =
    MARK_WIDTH + NUMBER_WIDTH + NAME_WIDTH + WANTED_WIDTH + 2.0 * VALUE_WIDTH + 5.0 * GAP + 10.0;
/// The share of the screen that the explanation takes, and its least and greatest width.
const PANEL_SHARE: f32 = 0.34;
const PANEL_WIDTH: (f32, f32) = (208.0, 460.0);

pub fn registers_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    framed_ui(ui, model, commands, |ui, model, commands| {
        if parts_ui(ui, &mut model.front) {
            let room = ui.available_height();
            return recipes::recipes_ui(ui, &mut model.front, &MindRecipes, room, commands);
        }
        let room = ui.available_rect_before_wrap();
        let beside = room.width() - TABLE_WIDTH;
        let width = (room.width() * PANEL_SHARE).min(beside).clamp(PANEL_WIDTH.0, PANEL_WIDTH.1);
        let (table, panel) = room.split_left_right_at_x(room.right() - width);
        let layout = Layout::top_down(Align::Min);
        ui.scope_builder(
            UiBuilder::new().max_rect(table.with_max_x(table.right() - 8.0)).layout(layout),
            |ui| {
                table_ui(ui, &mut model.front);
            },
        );
        ui.scope_builder(UiBuilder::new().max_rect(panel).layout(layout), |ui| {
            panel_ui(ui, &mut model.front);
        });
    });
}

/// All registers, or recipes. True where recipes are looked at.
fn parts_ui(ui: &mut Ui, connection: &mut Connection) -> bool {
    let general = &mut connection.general_view();
    let shows_recipes = general.section == Section::Recipes && !general.is_filtered();
    let (mut registers, mut recipes) = (false, false);
    ui.horizontal(|ui| {
        registers = ui.add(Button::selectable(!shows_recipes, "All registers")).clicked();
        recipes = ui.add(Button::selectable(shows_recipes, "Recipes")).clicked();
    });
    if registers && shows_recipes {
        general.turn_to(Section::default());
    }
    if recipes {
        general.turn_to(Section::Recipes);
    }
    shows_recipes
}

/// What is typed into the search field, against name, help and number.
fn is_shown(connection: &Connection, register: &Register) -> bool {
    let general = &connection.general;
    if !general.is_filtered() {
        return true;
    }
    let Some(unit) = connection.settings.unit() else { return true };
    let own = key(register);
    let of_it = |row: &str| row == own || row.starts_with(&format!("{}.", register.name.to_lowercase()));
    let edited = || unit.edits().iter().any(|(edited, _)| of_it(edited));
    let text = format!("{} {} {}", register.number, register.name, register.help).to_lowercase();
    let bits = || general.shown_of(unit).iter().any(|row| of_it(row));
    let found = general.search.split_whitespace().all(|word| text.contains(&word.to_lowercase())) || bits();
    found && (!general.only_changed || edited())
}

fn table_ui(ui: &mut Ui, connection: &mut Connection) {
    ui.spacing_mut().item_spacing.x = GAP;
    ui.horizontal(|ui| {
        ui.allocate_space(vec2(MARK_WIDTH, 1.0));
        let titles = [("#", NUMBER_WIDTH), ("Register", NAME_WIDTH), ("Wanted", WANTED_WIDTH)];
        for (title, width) in titles.into_iter().chain([("RAM", VALUE_WIDTH), ("EEPROM", VALUE_WIDTH)]) {
            fixed_label_ui(ui, title, width);
        }
    });
    let mut chosen = None;
    ScrollArea::both().id_salt("registers").auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for register in REGISTERS.iter().filter(|register| is_shown(connection, register)).collect::<Vec<_>>()
        {
            let is_chosen = connection.mind().register == register.number;
            if ui.push_id(register.number, |ui| row_ui(ui, connection, register, is_chosen)).inner {
                chosen = Some(register.number);
            }
        }
    });
    if let Some(chosen) = chosen {
        connection.mind_mut().register = chosen;
    }
}

/// Draws a register; true when it is the one to explain.
fn row_ui(ui: &mut Ui, connection: &mut Connection, register: &'static Register, is_chosen: bool) -> bool {
    let _palette = Palette::of(ui);
    let mut wants = false;
    let size = vec2(ui.available_width(), HEIGHT);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_height(HEIGHT);
        mark_ui(ui, connection, register);
        figure_ui(ui, &register.number.to_string(), "", NUMBER_WIDTH, true);
        let place = vec2(NAME_WIDTH, HEIGHT - 5.0);
        let name = ui
            .allocate_ui_with_layout(place, Layout::top_down_justified(Align::Min), |ui| {
                ui.add(Button::selectable(is_chosen, register.name).truncate())
            })
            .inner;
        let spoken = RegisterMessage::Named { name: register.name }.to_string();
        name.widget_info(|| WidgetInfo::selected(Role::Button, true, is_chosen, &spoken));
        wants |= name.on_hover_text(register.help).clicked();
        ui.allocate_ui_with_layout(vec2(WANTED_WIDTH, HEIGHT), Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(WANTED_WIDTH);
            wants |= wanted_ui(ui, connection, register);
        });
        let (ram, eeprom) = (ram_text(connection, register), eeprom_text(connection, register));
        let value = |ui: &mut Ui, copy: &'static str, text: &str, weak| {
            let spoken =
                RegisterMessage::In { name: register.name, copy, value: text.to_owned() }.to_string();
            figure_ui(ui, text, &spoken, VALUE_WIDTH, weak);
        };
        value(ui, "RAM", &ram, false);
        if register.is_writable() {
            value(ui, "EEPROM", &eeprom, true);
        } else {
            let reported = connection.mind().live.get(register).and_then(|raw| in_unit(register, raw));
            let reported = reported.unwrap_or_default();
            let text = Label::new(RichText::new(&reported).small().weak()).truncate();
            ui.add_sized(vec2(VALUE_WIDTH, HEIGHT), text);
        }
    });
    wants
}

/// The field, the way to the bits, or that it is measured.
fn wanted_ui(ui: &mut Ui, connection: &mut Connection, register: &'static Register) -> bool {
    if has_bits(register) {
        let is_chosen = connection.mind().register == register.number;
        let word = connection.word_wanted(register);
        let shown = word.map_or_else(|| "Bits".to_owned(), |word| RegisterMessage::Bits { word }.to_string());
        let response = ui.add(Button::selectable(is_chosen, shown).frame_when_inactive(true));
        let spoken = RegisterMessage::BitsOf { name: register.name }.to_string();
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_chosen, &spoken));
        return response.clicked();
    }
    let Some(unit) = connection.settings.unit_mut() else { return false };
    let Some(row) = unit.table().row(&key(register)).cloned() else {
        ui.label(RichText::new(if register.is_writable() { "" } else { "measured" }).small().weak());
        return false;
    };
    let locked = unit.locked(&row).is_some();
    ui.add_enabled_ui(!locked, |ui| editor::editor_ui(ui, unit, &row)).inner
}

/// Trouble first, then edits, then what a power cycle would change.
fn mark_ui(ui: &mut Ui, connection: &Connection, register: &Register) {
    let (rect, response) = ui.allocate_exact_size(vec2(MARK_WIDTH, HEIGHT), Sense::hover());
    let Some((state, spoken)) = mark(connection, register) else { return };
    state.paint(ui, rect.center(), 5.0);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    response.on_hover_text(spoken);
}

fn mark(connection: &Connection, register: &Register) -> Option<(IndicatorState, String)> {
    let unit = connection.settings.unit()?;
    let rows: Vec<&Row> = rows_of(unit, register).collect();
    let trouble = rows.iter().find_map(|row| unit.trouble(&row.key));
    if let Some(trouble) = trouble {
        return Some((IndicatorState::Error, format!("{}: {trouble}", register.name)));
    }
    if rows.iter().any(|row| unit.is_edited(&row.key)) {
        return Some((
            IndicatorState::Warning,
            RegisterMessage::IsChanged { name: register.name }.to_string(),
        ));
    }
    let eeprom = unit.eeprom()?;
    let differs = rows.iter().any(|row| {
        let (ram, kept) = (unit.on_controller(&row.key), eeprom.get(&row.key));
        ram.is_some() && kept.is_some() && ram != kept
    });
    differs.then(|| (IndicatorState::Active, RegisterMessage::Differs { name: register.name }.to_string()))
}

/// The rows of the settings table that a register is made of: one, or one for each bit.
pub fn rows_of<'a>(unit: &'a UnitSettings, register: &Register) -> impl Iterator<Item = &'a Row> {
    let (own, bits) = (key(register), format!("{}.", register.name.to_lowercase()));
    unit.table().rows().iter().filter(move |row| row.key == own || row.key.starts_with(&bits))
}

fn ram_text(connection: &Connection, register: &Register) -> String {
    if has_bits(register) {
        return connection
            .register(register.name)
            .map_or_else(|| NO_VALUE.to_owned(), |word| format!("0x{word:04X}"));
    }
    let of_settings = connection.settings.unit().and_then(|unit| {
        let row = unit.table().row(&key(register))?;
        Some(row.format_bare(unit.on_controller(&row.key)?))
    });
    let live = || connection.mind().live.get(register).map(|raw| raw.to_string());
    of_settings.or_else(live).unwrap_or_else(|| NO_VALUE.to_owned())
}

/// What the EEPROM holds, as proven in this session; else as it was known last, in brackets.
fn eeprom_text(connection: &Connection, register: &Register) -> String {
    let text = || {
        let unit = connection.settings.unit()?;
        if has_bits(register) {
            let image =
                unit.eeprom().or_else(|| connection.settings.known_eeprom().map(|known| &known.settings))?;
            let word = super::bits::word_of(register, |bit| {
                let key = crate::motion_mind::model::registers::bit_key(register.name, bit);
                Some(image.get(&key)? == SettingValue::Bool(true))
            })?;
            return Some(if unit.eeprom().is_some() {
                format!("0x{word:04X}")
            } else {
                format!("(0x{word:04X})")
            });
        }
        let row = unit.table().row(&key(register))?;
        match unit.eeprom().and_then(|image| image.get(&row.key)) {
            Some(value) => Some(row.format_bare(value)),
            None => Some(format!(
                "({})",
                row.format_bare(connection.settings.known_eeprom()?.settings.get(&row.key)?)
            )),
        }
    };
    text().unwrap_or_else(|| NO_VALUE.to_owned())
}

/// A figure at the right of a place of fixed width.
fn figure_ui(ui: &mut Ui, text: &str, spoken: &str, width: f32, is_weak: bool) {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::hover());
    if !spoken.is_empty() {
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, spoken));
    }
    let font = theme::figures().resolve(ui.style());
    let font = egui::FontId::new(font.size.min(13.0), font.family);
    let color = if is_weak { palette.weak_text } else { palette.text };
    let painter = ui.painter().with_clip_rect(rect);
    painter.text(rect.right_center() - vec2(4.0, 0.0), egui::Align2::RIGHT_CENTER, text, font, color);
}

/// The register that is chosen: what it is, and its bits.
fn panel_ui(ui: &mut Ui, connection: &mut Connection) {
    let palette = Palette::of(ui);
    let Some(register) = REGISTERS.get(usize::from(connection.mind().register)) else { return };
    let frame = Frame::new().stroke(Stroke::new(1.0, palette.line)).corner_radius(4.0);
    frame.inner_margin(Margin::symmetric(10, 8)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.set_height(ui.available_height() - 2.0);
        ui.strong(RegisterMessage::Head { name: register.name, number: register.number }.to_string());
        ScrollArea::vertical().id_salt(("register", register.number)).auto_shrink(false).show(ui, |ui| {
            about_ui(ui, connection, register);
            if has_bits(register) {
                ui.add_space(4.0);
                bits_ui(ui, connection, register);
            }
            unsaved_ui(ui, connection, register);
        });
    });
}

fn about_ui(ui: &mut Ui, connection: &Connection, register: &Register) {
    let palette = Palette::of(ui);
    let help = capital(register.help);
    ui.add(Label::new(format!("{help}.")).wrap());
    let Some(unit) = connection.settings.unit() else { return };
    for row in rows_of(unit, register) {
        if let Some(trouble) = unit.trouble(&row.key) {
            ui.add(Label::new(RichText::new(trouble.to_string()).color(palette.error)).wrap());
        }
        if let Some(reason) = unit.locked(row).filter(|_| row.key == key(register) && register.is_writable())
        {
            ui.add(Label::new(RichText::new(reason).color(palette.warning)).wrap());
        }
    }
    ui.add(Label::new(RichText::new(facts(register)).weak()).wrap());
    let raw = connection.register(register.name);
    if let Some(text) = raw.and_then(|raw| in_unit(register, raw)) {
        ui.add(Label::new(RegisterMessage::Now { text }.to_string()).wrap());
    }
}

/// Range, default, width and who may write it.
fn facts(register: &Register) -> String {
    let mut text =
        if register.is_writable() { String::new() } else { "The unit alone changes it. ".to_owned() };
    if !has_bits(register) {
        text +=
            &RegisterMessage::From { min: *register.range.start(), max: *register.range.end() }.to_string();
        let step = in_unit(register, 1).filter(|_| register.scale < 1.0 && register.name != "THERMISTOR");
        text += &step.map_or(". ".to_owned(), |step| RegisterMessage::OneIs { step }.to_string());
    }
    if let Some(default) = register.default {
        text += &format!("{} ", RegisterMessage::Factory { value: default });
    }
    text + &width_text(register.kind.bytes())
}

pub fn width_text(bytes: usize) -> String {
    match bytes {
        1 => RegisterMessage::OneByte.to_string(),
        bytes => RegisterMessage::Bytes { bytes }.to_string(),
    }
}

/// What a power cycle would change of it.
fn unsaved_ui(ui: &mut Ui, connection: &Connection, register: &Register) {
    let Some(unit) = connection.settings.unit() else { return };
    let (Some(eeprom), Some(ram)) = (unit.eeprom(), unit.ram()) else { return };
    let of_it: Vec<&str> = rows_of(unit, register).map(|row| row.key.as_str()).collect();
    let both =
        |each: &Difference| each.left.is_some() && each.right.is_some() && of_it.contains(&each.key.as_str());
    for difference in diff(unit.table(), eeprom, ram).into_iter().filter(both) {
        if let Some(row) = unit.table().row(&difference.key) {
            let text = RegisterMessage::Unsaved { difference: difference.describe(row) }.to_string();
            ui.add(Label::new(RichText::new(text).color(Palette::of(ui).accent)).wrap());
        }
    }
}
