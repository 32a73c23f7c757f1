//! The panel for a simulated controller's world: what a person could do to the machine on the bench.

use brushwork_plant::world::{UnitFault, WorldAction, WorldView};
use egui::{RichText, Role, Ui, WidgetInfo};

use super::command::{Command, Commands};
use super::family::Ability;
use super::model::Model;
use super::model::world::WorldPanel;
use crate::widgets::{Numeric, fixed_label_ui, heading_ui};
use crate::world::messages::WorldMessage;

mod buses;
pub mod messages;
mod motor;
mod pins;
mod switches;

pub fn world_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let Some(views) = model.front.worlds.clone() else { return };
    let Some(view) = views.get(model.front.world_unit) else { return };
    model.front.world.sync(view);
    let (family, motors) = (model.front.family(), model.front.motors());
    let panel = &mut model.front.world;
    let mut actions = Vec::new();
    ui.spacing_mut().item_spacing.y = 4.0;
    ui.label(RichText::new("Simulated world").heading());
    let note = "What you could do to a real machine by hand. None of it goes over the wire.";
    ui.label(RichText::new(note).small().weak());
    unit_ui(ui, view, family.lacks(Ability::EmergencyStop).is_none(), &mut actions);
    if let Some(shown) = &view.display {
        display_ui(ui, shown);
    }
    supply_ui(ui, view, panel, family.lacks(Ability::LogicBattery).is_none(), &mut actions);
    if family.lacks(Ability::BridgeFaults).is_none() {
        electronics_ui(ui, view, &mut actions);
    }
    for motor in motors {
        motor::motor_ui(ui, *motor, view, panel, &mut actions);
    }
    pins::pins_ui(ui, view, (family, motors), &mut actions);
    switches::switches_ui(ui, view, &mut actions);
    if family.lacks(Ability::Buses).is_none() {
        buses::buses_ui(ui, view, &mut actions);
    }
    commands.extend(actions.into_iter().map(Command::World));
}

type Actions = Vec<WorldAction>;

const LABEL_WIDTH: f32 = 100.0;

fn unit_ui(ui: &mut Ui, view: &WorldView, has_estop: bool, actions: &mut Actions) {
    ui.horizontal_wrapped(|ui| {
        if toggle_ui(ui, "Power", view.powered) {
            actions.push(WorldAction::Power { on: !view.powered });
        }
        let (text, unplugged) = if view.plugged { ("Unplug cable", true) } else { ("Plug cable in", false) };
        if ui.button(text).clicked() {
            actions.push(WorldAction::Unplug { unplugged });
        }
        if has_estop && toggle_ui(ui, "E-stop pressed", view.estop_pressed) {
            actions.push(WorldAction::EStop { pressed: !view.estop_pressed });
        }
    });
}

/// What the board shows by itself, whatever program runs on it.
fn display_ui(ui: &mut Ui, shown: &str) {
    ui.separator();
    heading_ui(ui, "Display");
    let spoken = WorldMessage::Shows { text: shown.to_owned() }.to_string();
    let response = ui.label(RichText::new(shown).monospace().size(30.0));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
}

/// Faults of the controller's own electronics.
fn electronics_ui(ui: &mut Ui, view: &WorldView, actions: &mut Actions) {
    ui.separator();
    heading_ui(ui, "Inside the controller");
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 10.0;
        for fault in UnitFault::ALL {
            let on = view.unit_faults.has(fault);
            if toggle_ui(ui, fault.title(), on) {
                actions.push(WorldAction::SetUnitFault { fault, on: !on });
            }
        }
    });
}

fn supply_ui(ui: &mut Ui, view: &WorldView, panel: &mut WorldPanel, has_logic: bool, actions: &mut Actions) {
    ui.separator();
    heading_ui(ui, "Supply");
    let volts = number(("Main battery", "Battery voltage"), "V", 0.0..=80.0, 1);
    if row_ui(ui, &volts, &mut panel.battery_volts) {
        actions.push(WorldAction::SetBatteryVolts { volts: panel.battery_volts });
    }
    let ohms = number(("Its resistance", "Battery resistance"), "Ω", 0.0..=5.0, 3);
    if row_ui(ui, &ohms, &mut panel.battery_ohms) {
        actions.push(WorldAction::SetBatteryOhms { ohms: panel.battery_ohms });
    }
    let logic = number(("Logic battery", "Logic voltage"), "V", 0.0..=40.0, 1);
    if has_logic && row_ui(ui, &logic, &mut panel.logic_volts) {
        actions.push(WorldAction::SetLogicVolts { volts: panel.logic_volts });
    }
    let sinks = view.battery_sinks;
    if toggle_ui(ui, "Battery takes current back", sinks) {
        actions.push(WorldAction::SetBatterySinks { can_sink: !sinks });
    }
    let mut held = panel.held_celsius.is_some();
    if ui.checkbox(&mut held, "Hold the board's temperature").changed() {
        panel.held_celsius = held.then_some(view.board_celsius[0].round());
        actions.push(WorldAction::SetBoardCelsius { celsius: panel.held_celsius });
    }
    if let Some(mut celsius) = panel.held_celsius {
        let field = number(("At", "Board temperature"), "°C", -40.0..=150.0, 1);
        if row_ui(ui, &field, &mut celsius) {
            panel.held_celsius = Some(celsius);
            actions.push(WorldAction::SetBoardCelsius { celsius: Some(celsius) });
        }
    }
    figures_ui(ui, &WorldMessage::Bridge { volts: view.bus_volts, amps: view.battery_amps }.to_string());
}

/// Figures that change by themselves, in digits of one width.
fn figures_ui(ui: &mut Ui, text: &str) {
    ui.add(egui::Label::new(RichText::new(text).monospace().size(11.5).weak()).truncate());
}

/// A check box of what is so; true when it was clicked.
fn toggle_ui(ui: &mut Ui, text: &str, mut on: bool) -> bool {
    ui.checkbox(&mut on, text).changed()
}

/// A labelled number field: what is read at its left, and its full name.
struct Field<'a> {
    label: &'a str,
    numeric: Numeric<'a>,
}

fn number<'a>(
    (label, name): (&'a str, &'a str),
    unit: &'a str,
    range: std::ops::RangeInclusive<f64>,
    decimals: usize,
) -> Field<'a> {
    let step = 10f64.powi(-(decimals as i32));
    Field { label, numeric: Numeric { name, unit, range, decimals, step, width: 96.0 } }
}

fn row_ui(ui: &mut Ui, field: &Field<'_>, value: &mut f64) -> bool {
    ui.horizontal(|ui| {
        fixed_label_ui(ui, field.label, LABEL_WIDTH);
        field.numeric.ui(ui, value).changed()
    })
    .inner
}
