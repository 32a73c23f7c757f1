//! What sheets are made of: texts, indicators, differences, and the buttons that they offer.

use brushwork_link::settings::Difference;
use egui::{Grid, Label, RichText, Ui, vec2};
use std::fmt::Display;

use crate::model::{IndicatorState, SettingsAction, Settle, UnitSettings};

/// What a button of a sheet does.
#[derive(Clone, Copy, Debug)]
pub enum Act {
    FamilyAction(SettingsAction),
    OpenProfile {
        mending: bool,
    },
    SaveProfile,
    TakeOverAll,
    /// Opens the window that gives the open profile to every unit.
    ToAll,
    UseUpgraded,
    CopyMotor,
    Settle(Settle),
}

/// A button: its text, what it does, whether it can be pressed.
pub type Offer = (&'static str, Act, bool);

pub fn title_ui(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).size(16.0).strong());
}

pub fn text_ui(ui: &mut Ui, text: &str) {
    ui.add(Label::new(text).wrap());
}

pub fn indicator_ui(ui: &mut Ui, state: IndicatorState, text: &(impl Display + ?Sized)) {
    ui.horizontal_top(|ui| {
        state.ui(ui, vec2(18.0, 18.0), 6.0);
        ui.add(Label::new(text.to_string()).wrap());
    });
}

/// Old and new of each setting, with units.
pub fn differences_ui(ui: &mut Ui, unit: &UnitSettings, differences: impl Iterator<Item = Difference>) {
    Grid::new("differences").num_columns(4).spacing([16.0, 3.0]).show(ui, |ui| {
        for difference in differences {
            let Some(row) = unit.table().row(&difference.key) else { continue };
            let text =
                |value: Option<_>| value.map_or_else(|| "not known".to_owned(), |value| row.format(value));
            ui.label(row.title());
            ui.weak(text(difference.left));
            ui.label("->");
            let new = ui.strong(text(difference.right));
            new.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, difference.describe(row)));
            ui.end_row();
        }
    });
}
