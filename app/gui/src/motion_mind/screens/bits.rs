//! The bits of FUNCTION, FUNCTION2 and STATUS, each with its name and what it means when it is set.

use brushwork_link::settings::SettingValue;
use brushwork_motion_mind_wire::{Bit, FUNCTION_BITS, FUNCTION2_BITS, Register, STATUS_BITS};
use egui::{Button, Label, RichText, Role, Ui, WidgetInfo, vec2};

use crate::messages::ButtonMessage;
use crate::model::{Connection, IndicatorState};
use crate::motion_mind::messages::RegisterMessage;
use crate::motion_mind::model::registers::bit_key;

/// The bits of a register, where it has named ones.
pub fn bits_of(register: &Register) -> &'static [Bit] {
    match register.name {
        "FUNCTION" => FUNCTION_BITS,
        "FUNCTION2" => FUNCTION2_BITS,
        "STATUS" => STATUS_BITS,
        _ => &[],
    }
}

pub fn has_bits(register: &Register) -> bool {
    !bits_of(register).is_empty()
}

/// The word that bits make; none where one of them is not known.
pub fn word_of(register: &Register, is_set: impl Fn(&str) -> Option<bool>) -> Option<u16> {
    bits_of(register).iter().try_fold(0, |word, bit| {
        let set = is_set(bit.name)?;
        Some(if set { word | bit.mask() } else { word })
    })
}

impl Connection {
    /// A register of bits as it is wanted: the edits, or else what the unit has.
    pub fn word_wanted(&self, register: &Register) -> Option<u16> {
        if !register.is_writable() {
            return self.register(register.name).and_then(|word| u16::try_from(word).ok());
        }
        let unit = self.settings.unit()?;
        word_of(register, |bit| Some(unit.wanted(&bit_key(register.name, bit))? == SettingValue::Bool(true)))
    }
}

pub fn bits_ui(ui: &mut Ui, connection: &mut Connection, register: &'static Register) {
    ui.spacing_mut().item_spacing.y = 2.0;
    for bit in bits_of(register) {
        if register.is_writable() {
            setting_ui(ui, connection, register, bit);
        } else {
            measured_ui(ui, connection, register, bit);
        }
        let means = Label::new(
            RichText::new(RegisterMessage::BitSet { means: bit.set_means }.to_string()).small().weak(),
        );
        ui.indent(bit.number, |ui| ui.add(means.wrap()));
        ui.add_space(3.0);
    }
}

/// A box for a bit that can be written, with what the unit has where that is another.
fn setting_ui(ui: &mut Ui, connection: &mut Connection, register: &Register, bit: &Bit) {
    let Some(unit) = connection.settings.unit_mut() else { return };
    let key = bit_key(register.name, bit.name);
    let Some(row) = unit.table().row(&key).cloned() else { return };
    let wanted = unit.wanted(&key) == Some(SettingValue::Bool(true));
    let is_known = unit.wanted(&key).is_some();
    let locked = unit.locked(&row);
    ui.horizontal(|ui| {
        let mut set = wanted;
        let title = format!("{} {}", bit.number, bit.name);
        let response = ui.add_enabled(is_known && locked.is_none(), egui::Checkbox::new(&mut set, title));
        let spoken = format!("{} {}", register.name, bit.name);
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, is_known, wanted, &spoken));
        if response.changed() {
            unit.set(&key, SettingValue::Bool(set));
        }
        if unit.is_edited(&key) {
            IndicatorState::Warning.ui(ui, vec2(14.0, 14.0), 5.0);
            let revert = ui.add(Button::new("Revert").small());
            let name = ButtonMessage::Revert { title: spoken.to_string() }.to_string();
            revert.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            if revert.on_hover_text("Back to what the unit has").clicked() {
                unit.revert(&key);
            }
        }
    });
}

fn measured_ui(ui: &mut Ui, connection: &Connection, register: &Register, bit: &Bit) {
    let set = connection.register(register.name).map(|word| word & i64::from(bit.mask()) != 0);
    let (state, word) = match set {
        None => (IndicatorState::Unknown, "not known"),
        Some(true) => (IndicatorState::Active, "set"),
        Some(false) => (IndicatorState::Ok, "clear"),
    };
    ui.horizontal(|ui| {
        state.ui(ui, vec2(16.0, 16.0), 5.0);
        let text = ui.label(format!("{} {}: {word}", bit.number, bit.name));
        text.widget_info(|| {
            WidgetInfo::labeled(Role::Label, true, format!("{} {}: {word}", register.name, bit.name))
        });
    });
}
