//! The drawer between the sliders and the graph: its tabs, and what the open one shows.

use egui::{Frame, Margin, Stroke, Ui};

use super::direction::direction_ui;
use super::face;
use super::generator::generator_ui;
use super::loops::loops_ui;
use super::qpps::qpps_ui;
use crate::command::Commands;
use crate::model::loop_settings::{POSITION, PWM, VELOCITY};
use crate::model::{Column, Model, Screen, Tab};
use crate::theme::Palette;
use crate::tune::by_hand::by_hand_ui;

/// Whether guided tuning has the screen.
pub fn is_tuning(model: &Model) -> bool {
    model.front.open_tab(model.screen) == Some(Tab::Tune)
}

/// The tabs, in a row of the screen's head.
pub fn tabs_ui(ui: &mut Ui, model: &mut Model) {
    let screen = model.screen;
    for tab in model.front.family().tabs(screen) {
        let is_open = model.front.open_tab(screen) == Some(*tab);
        let label = ui.selectable_label(is_open, title(model, screen, *tab));
        let hint = if is_open { "Closes it and leaves its room to the graph" } else { "Opens it below" };
        if label.on_hover_text(hint).clicked() {
            model.front.drawers.press(screen, *tab);
        }
    }
}

/// What the open tab shows, below the sliders.
pub fn drawer_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let screen = model.screen;
    let Some(tab) = model.front.open_tab(screen).filter(|tab| *tab != Tab::Tune) else { return };
    let outline = Stroke::new(1.0, Palette::of(ui).line);
    Frame::new().stroke(outline).corner_radius(4.0).inner_margin(Margin::symmetric(10, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        match tab {
            Tab::Settings | Tab::VelocityLoop => loops_ui(ui, model, columns(screen, tab), commands),
            Tab::Direction => direction_ui(ui, model, commands),
            Tab::Generator => generator_ui(ui, model, commands),
            Tab::Qpps => qpps_ui(ui, model, commands),
            Tab::ByHand => by_hand_ui(ui, model, commands),
            Tab::Steps => face::of(model.front.family()).steps_ui(ui, model, commands),
            Tab::Gains | Tab::Home => face::of(model.front.family()).tab_ui(ui, model, tab, commands),
            Tab::Tune => {}
        }
    });
}

/// The title, with a star while edits behind it wait to be applied.
fn title(model: &Model, screen: Screen, tab: Tab) -> String {
    let has_edits =
        matches!(tab, Tab::Settings | Tab::VelocityLoop) && has_loop_edits(model, columns(screen, tab));
    format!("{}{}", tab.title(screen), if has_edits { " *" } else { "" })
}

fn has_loop_edits(model: &Model, columns: &[Column]) -> bool {
    model.front.settings.unit().is_some_and(|unit| !unit.loop_edits(columns).is_empty())
}

const fn columns(screen: Screen, tab: Tab) -> &'static [Column] {
    match (screen, tab) {
        (Screen::Pwm, _) => PWM,
        (Screen::Position, Tab::Settings) => POSITION,
        _ => VELOCITY,
    }
}
