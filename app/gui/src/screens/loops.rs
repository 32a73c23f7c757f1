//! The settings of the control loops: a row for each motor, read when the screen opens, applied to RAM by a button.

use brushwork_link::settings::{Kind, SettingValue};
use brushwork_values::Motor;
use egui::{Button, Grid, RichText, Ui, vec2};

use crate::command::{Command, Commands};
use crate::messages::NameMessage;
use crate::model::loop_settings::{LoopView, number};
use crate::model::{Column, Model, UnitSettings};
use crate::screens::messages::{ScreenMessage, SettingMessage};
use crate::theme::Palette;
use crate::widgets::{NO_VALUE, Numeric};
use brushwork_core::settings::counted;

/// Where no row says otherwise.
const GREATEST: f64 = u32::MAX as f64;

pub fn loops_ui(ui: &mut Ui, model: &mut Model, columns: &'static [Column], commands: &mut Commands) {
    let palette = Palette::of(ui);
    let is_free = !model.front.is_guided();
    let is_busy = model.front.settings.is_busy();
    let motors = model.front.motors();
    let loops = &mut model.front.loops;
    let Some(unit) = model.front.settings.unit_mut() else { return };
    let mut is_edited = false;
    Grid::new(("loops", columns[0].key)).spacing(vec2(8.0, 4.0)).show(ui, |ui| {
        ui.label("");
        for column in columns {
            ui.label(RichText::new(column.label).small().weak());
        }
        ui.end_row();
        for motor in motors {
            is_edited |= motor_row_ui(ui, unit, *motor, columns);
            ui.end_row();
        }
    });
    if is_edited {
        loops.note_edit();
    }
    ui.add_space(2.0);
    ui.horizontal_wrapped(|ui| buttons_ui(ui, (loops, unit, motors), columns, (is_free, is_busy), commands));
    for motor in torque_controlled(unit, columns) {
        let text = ScreenMessage::BecomesTorque { number: motor.index() + 1 }.to_string();
        ui.label(RichText::new(text).color(palette.warning));
    }
    if is_free && !is_busy && unit.is_known() && loops.wants_applying() {
        commands.push(Command::ApplyLoops(columns));
    }
}

/// Told where L and R stand.
fn torque_controlled(unit: &UnitSettings, columns: &[Column]) -> Vec<Motor> {
    let has_inductance = columns.iter().any(|column| column.key == "inductance_henries");
    if has_inductance { unit.torque_controlled() } else { Vec::new() }
}

/// True where something was edited.
fn motor_row_ui(ui: &mut Ui, unit: &mut UnitSettings, motor: Motor, columns: &[Column]) -> bool {
    ui.label(NameMessage::Motor { number: motor.index() + 1 }.to_string());
    // Each field is drawn, whichever is edited.
    let mut is_edited = false;
    for column in columns {
        is_edited |= field_ui(ui, unit, motor, column);
    }
    is_edited
}

fn field_ui(ui: &mut Ui, unit: &mut UnitSettings, motor: Motor, column: &Column) -> bool {
    let Some(value) = unit.shown(motor, column) else {
        ui.label(NO_VALUE).on_hover_text("Not read, or not a setting of this controller");
        return false;
    };
    let Some((row, mut shown)) = unit.row(motor, column).zip(number(value)) else {
        return false;
    };
    let name = format!("{motor} {}", row.label);
    let help = row.help;
    let range = row.range.min.max(-GREATEST)..=row.range.max.min(GREATEST);
    let decimals = decimals_of(&row.format_bare(value), row.kind, value);
    let edited = unit.is_edited(&row.key);
    let response = ui
        .scope(|ui| {
            if edited {
                ui.visuals_mut().override_text_color = Some(Palette::of(ui).accent);
            }
            let field =
                Numeric { name: &name, unit: "", range, decimals, step: column.step, width: column.width };
            field.ui(ui, &mut shown)
        })
        .inner;
    let is_changed = response.on_hover_text(help).changed();
    if is_changed {
        unit.edit(motor, column.key, shown);
    }
    is_changed
}

/// As many decimals as the value has, so that leaving a field does not round it.
fn decimals_of(text: &str, kind: Kind, value: SettingValue) -> usize {
    match (kind, value) {
        (Kind::Int, _) | (_, SettingValue::Int(_)) => 0,
        _ => text.split_once('.').map_or(0, |(_, decimals)| decimals.len()),
    }
}

fn buttons_ui(
    ui: &mut Ui,
    (loops, unit, motors): (&mut LoopView, &mut UnitSettings, &[Motor]),
    columns: &'static [Column],
    (is_free, is_busy): (bool, bool),
    commands: &mut Commands,
) {
    let edits = unit.loop_edits(columns).len();
    let is_ready = is_free && unit.is_known() && !is_busy;
    let apply = ui.add_enabled(is_ready && edits > 0, Button::new("Apply to RAM"));
    if apply.on_hover_text("Writes the changes to the controller and reads them back").clicked() {
        commands.push(Command::ApplyLoops(columns));
    }
    let at_once = ui.checkbox(&mut loops.at_once, "At once");
    at_once.on_hover_text("Applies each change as soon as it is entered, so that its effect can be watched");
    let revert = ui.add_enabled(edits > 0, Button::new("Revert"));
    if revert.on_hover_text("Drops the changes that were not applied").clicked() {
        unit.revert_loops(columns);
    }
    let read = ui.add_enabled(is_free && !is_busy, Button::new("Read again"));
    if read.on_hover_text("Reads the settings from the controller; changes here stay").clicked() {
        commands.push(Command::ReadLoops);
    }
    ui.separator();
    let copies = [(Motor::M1, "Copy M1 to M2"), (Motor::M2, "Copy M2 to M1")];
    for (from, label) in copies.into_iter().filter(|_| motors.len() > 1) {
        if ui.add_enabled(is_ready, Button::new(label)).clicked() {
            unit.copy_from(from, columns);
            loops.note_edit();
        }
    }
    let state = match edits {
        _ if is_busy => "Asking the controller …".to_owned(),
        _ if !unit.is_known() => "Not read yet.".to_owned(),
        0 => "As the controller holds them.".to_owned(),
        _ => SettingMessage::NotApplied { settings: counted(edits) }.to_string(),
    };
    ui.label(RichText::new(state).small().weak());
}
