//! The field of one setting: a box, a list, or an exact number.

use brushwork_link::settings::{Kind, Row, SettingValue};
use brushwork_mcp_client::model_of;
use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_values::Code;
use egui::text::{CCursor, CCursorRange};
use egui::{ComboBox, Id, Key, Response, RichText, Stroke, TextEdit, Ui, vec2};

use crate::model::settings::UnitSettings;
use crate::theme;
use crate::theme::Palette;

const NUMBER_WIDTH: f32 = 112.0;
const LIST_WIDTH: f32 = 164.0;

/// Draws the field; true when it has the keyboard.
pub fn editor_ui(ui: &mut Ui, unit: &mut UnitSettings, row: &Row) -> bool {
    let response = match (row.kind, unit.wanted(&row.key)) {
        (Kind::Int, value) if row.pattern == ENCODER_PIN => {
            let choices = encoder_pins(unit);
            let named: Vec<_> = choices.iter().map(|(value, name)| (*value, name.as_str())).collect();
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

/// The row that names a motor's encoder by the number of its pin.
const ENCODER_PIN: &str = "motor{n}.encoder.pin";

/// None, and every pin that can be an encoder, by the numbers that we assume for them.
fn encoder_pins(unit: &UnitSettings) -> Vec<(SettingValue, String)> {
    let subject = unit.table().subject();
    let is_able = |index: &usize| {
        let pin = model_of(subject).and_then(|model| model.pins.get(*index));
        pin.is_none_or(|pin| pin.is_analog() || pin.is_pulse() || pin.encoder_channel().is_some())
    };
    let pins = (0..subject.pins)
        .filter(is_able)
        .map(|index| (index as i64, format!("{index}: {}", subject.pin_name(index))));
    let none = (ENCODER_PIN_NONE, "None".to_owned());
    std::iter::once(none).chain(pins).map(|(number, name)| (SettingValue::Int(number), name)).collect()
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
    let id = Id::unique(format!("number of {}", row.key));
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
        ui.label(RichText::new(symbol).small().color(palette.weak_text));
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
