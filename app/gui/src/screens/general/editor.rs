//! The field of one setting: a box, a list, or an exact number.

use brushwork_link::settings::{Kind, Row, SettingValue};
use brushwork_values::Code;
use egui::text::{CCursor, CCursorRange};
use egui::{ComboBox, Id, Key, Response, RichText, Stroke, TextEdit, Ui, vec2};

use crate::family;
use crate::model::settings::UnitSettings;
use crate::theme::{self, Palette};

const NUMBER_WIDTH: f32 = 112.0;
const LIST_WIDTH: f32 = 164.0;

/// Draws the field; true when it has the keyboard.
pub fn editor_ui(ui: &mut Ui, unit: &mut UnitSettings, row: &Row) -> bool {
    let subject = *unit.table().subject();
    let own = family::of(subject.family()).choices(row, &subject, &|key| unit.wanted(key));
    let response = match (row.kind, unit.wanted(&row.key)) {
        (_, value) if own.is_some() => {
            let named: Vec<_> = own.iter().flatten().map(|(value, name)| (*value, name.as_str())).collect();
            list_ui(ui, unit, row, value, &named)
        }
        (Kind::Bool, Some(SettingValue::Bool(on))) => box_ui(ui, unit, row, on),
        (Kind::Bool, value) => list_ui(ui, unit, row, value, &[(NO, "no"), (YES, "yes")]),
        (Kind::Choice(codes), value) => list_ui(ui, unit, row, value, &choices(row, codes)),
        (Kind::Int | Kind::Fixed { .. }, _) => number_ui(ui, unit, row),
    };
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(row.title()));
    if response.gained_focus() && !ui.input(|input| input.pointer.any_pressed()) {
        response.scroll_to_me(None);
    }
    response.has_focus()
}

const NO: SettingValue = SettingValue::Bool(false);
const YES: SettingValue = SettingValue::Bool(true);

fn choices(row: &Row, codes: &'static [Code]) -> Vec<(SettingValue, &'static str)> {
    let label = |code: &Code| match (row.key.as_str(), code.key) {
        ("stream.rs232.type", "disabled") => "Disabled: CANopen",
        ("stream.ttl1.type", "disabled") => "Disabled: I2C master",
        _ => code.label,
    };
    codes.iter().map(|code| (SettingValue::Choice(code.key), label(code))).collect()
}

fn box_ui(ui: &mut Ui, unit: &mut UnitSettings, row: &Row, on: bool) -> Response {
    let mut wanted = on;
    let response = ui.checkbox(&mut wanted, if on { "yes" } else { "no" });
    if response.changed() {
        unit.set(&row.key, SettingValue::Bool(wanted));
    }
    response
}

fn list_ui(
    ui: &mut Ui,
    unit: &mut UnitSettings,
    row: &Row,
    value: Option<SettingValue>,
    choices: &[(SettingValue, &str)],
) -> Response {
    let named = choices.iter().find(|(choice, _)| value == Some(*choice)).map(|(_, name)| (*name).to_owned());
    let shown =
        named.unwrap_or_else(|| value.map_or_else(|| "not known".to_owned(), |value| row.format(value)));
    let list = ComboBox::from_id_salt(&row.key).width(LIST_WIDTH).selected_text(shown).truncate();
    let opened = list.show_ui(ui, |ui| {
        for (choice, label) in choices {
            if ui.selectable_label(value == Some(*choice), *label).clicked() {
                unit.set(&row.key, *choice);
            }
        }
    });
    opened.response
}

/// What is typed counts when Enter is pressed or the field is left, with or without its unit. Esc puts it back.
fn number_ui(ui: &mut Ui, unit: &mut UnitSettings, row: &Row) -> Response {
    let palette = Palette::of(ui);
    let mut text = unit.text(row);
    let id = Id::unique(("number", &row.key));
    let response = ui
        .scope(|ui| {
            if unit.trouble(&row.key).is_some() {
                ui.visuals_mut().widgets.inactive.bg_stroke = Stroke::new(1.5, palette.error);
            }
            let field = TextEdit::singleline(&mut text)
                .id(id)
                .font(theme::figures())
                .hint_text("not known")
                .align(egui::Align2::RIGHT_CENTER)
                .min_size(vec2(NUMBER_WIDTH, 0.0))
                .desired_width(NUMBER_WIDTH - 8.0);
            ui.add(field)
        })
        .inner;
    let symbol = row.unit.symbol();
    if !symbol.is_empty() {
        ui.label(RichText::new(symbol).small().weak());
    }
    if response.gained_focus() {
        select_all(ui, &response, text.chars().count());
    }
    if response.changed() {
        unit.type_in(&row.key, text);
    }
    if response.lost_focus() {
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            unit.drop_typing(&row.key);
        } else {
            unit.finish_typing(&row.key);
        }
    }
    response
}

/// The first key that is typed replaces what stands there.
fn select_all(ui: &Ui, response: &Response, letters: usize) {
    if let Some(mut state) = TextEdit::load_state(ui.ctx(), response.id) {
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(letters));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), response.id);
    }
}
