//! Where the settings are: wanted here, in the controller's RAM, in its EEPROM, in the open profile.

use brushwork_link::settings::{Difference, diff};
use egui::{Align2, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, WidgetInfo, pos2, vec2};

use crate::command::{Command, Commands};
use crate::language::{said, word};
use crate::model::{IndicatorState, Model, Saved, Screen};
use crate::shell::messages::BarMarkMessage;
use crate::theme::Palette;

pub const WIDTH: f32 = 206.0;
const HEIGHT: f32 = 36.0;

/// One indicator with two lines; pressing it goes to the settings.
pub fn marks_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let (state, first, second) = mark(model);
    let (first, second) = (said(&first), said(&second));
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, HEIGHT), Sense::click());
    let spoken = said(&BarMarkMessage::Settings { first: first.clone(), second: second.clone() });
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &spoken));
    let outline = match (response.has_focus(), response.hovered()) {
        (true, _) => Stroke::new(2.0, palette.accent),
        (false, true) => Stroke::new(1.0, palette.weak_text),
        (false, false) => Stroke::new(1.0, palette.line),
    };
    ui.painter().rect(rect, 4.0, palette.raised, outline, StrokeKind::Inside);
    state.paint(ui, pos2(rect.left() + 14.0, rect.center().y), 6.0);
    let small = TextStyle::Small.resolve(ui.style());
    let painter = ui.painter().with_clip_rect(rect.shrink(4.0));
    let left = rect.left() + 28.0;
    painter.text(pos2(left, rect.top() + 4.0), Align2::LEFT_TOP, &first, small.clone(), palette.text);
    painter.text(pos2(left, rect.bottom() - 4.0), Align2::LEFT_BOTTOM, &second, small, palette.weak_text);
    let help = word(
        "bar",
        "Edits that are not written, RAM that is not saved to EEPROM, and the open profile. The EEPROM is known \
                once it was saved or loaded from here. Press to see them.",
    );
    if response.on_hover_text(format!("{spoken}\n{help}")).clicked() {
        commands.push(Command::Show(Screen::GeneralSettings));
    }
}

/// The gravest state, then RAM and EEPROM, then edits and profile.
fn mark(model: &Model) -> (IndicatorState, BarMarkMessage, BarMarkMessage) {
    let settings = &model.front.settings;
    let Some(unit) = settings.unit().filter(|unit| unit.is_read() && model.is_connected()) else {
        let text = match (model.is_connected(), settings.running().is_some()) {
            (false, _) => BarMarkMessage::NoController,
            (true, true) => BarMarkMessage::Reading,
            (true, false) => BarMarkMessage::NotRead,
        };
        return (IndicatorState::Unknown, text, profile(model));
    };
    let (state, first) = match unit.saved() {
        Saved::Yes => (IndicatorState::Ok, BarMarkMessage::Saved),
        Saved::Differs(count) => (IndicatorState::Warning, BarMarkMessage::NotInEeprom { count }),
        Saved::NotKnown { written: 0 } => as_known_before(model),
        Saved::NotKnown { written } => (IndicatorState::Warning, BarMarkMessage::Written { written }),
    };
    match unit.changes().len() {
        0 => (state, first, profile(model)),
        1 => (IndicatorState::Warning, first, BarMarkMessage::OneEdit),
        edits => (IndicatorState::Warning, first, BarMarkMessage::Edits { edits }),
    }
}

/// RAM against what the EEPROM was proven to hold last, in an earlier session.
fn as_known_before(model: &Model) -> (IndicatorState, BarMarkMessage) {
    let settings = &model.front.settings;
    let differing = settings.known_eeprom().zip(settings.unit()).and_then(|(known, unit)| {
        let both = |each: &Difference| each.left.is_some() && each.right.is_some();
        Some(diff(unit.table(), &known.settings, unit.ram()?).into_iter().filter(both).count())
    });
    match differing {
        Some(0) => (IndicatorState::Ok, BarMarkMessage::AsSaved),
        Some(count) => (IndicatorState::Warning, BarMarkMessage::NotAsSaved { count }),
        None => (IndicatorState::Unknown, BarMarkMessage::NotKnown),
    }
}

/// How the open profile differs from the controller.
fn profile(model: &Model) -> BarMarkMessage {
    let Some(opened) = &model.front.general.profiles.opened else { return BarMarkMessage::NoProfile };
    let differing = model.front.settings.unit().and_then(|unit| {
        let differences = diff(unit.table(), unit.ram()?, &opened.profile.settings);
        Some(differences.iter().filter(|difference| difference.right.is_some()).count())
    });
    match differing {
        Some(0) => BarMarkMessage::ProfileAsRam,
        Some(1) => BarMarkMessage::OneProfileDiffers,
        Some(count) => BarMarkMessage::ProfileDiffers { count },
        None => BarMarkMessage::ProfileNotCompared,
    }
}
