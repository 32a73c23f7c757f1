//! One input pin (MCP manual 1.9.8 to 1.9.12): its mode, what the signal is now, the signal graph, and its settings.
//!
//! Where there is room the graph stands beside the settings, else above them.

use brushwork_link::device::PinSignal;
use brushwork_link::settings::Row;
use brushwork_mcp_client::settings::{Behind, PinMode};
use brushwork_mcp_wire::packet_serial::scale;
use egui::{
    Align, Button, ComboBox, Label, Layout, RichText, Role, ScrollArea, Sense, Ui, UiBuilder, WidgetInfo,
    vec2,
};

use super::calibrate::calibrate_ui;
use super::signal_graph::signal_graph_ui;
use crate::command::{Command, Commands};
use crate::mcp::messages::SignalMessage;
use crate::messages::PinMessage;
use crate::model::{GeneralView, Section, UnitSettings};
use crate::screens::general::rows::{self, Columns};
use crate::widgets::readout::Readout;

/// Room that the scroll bar may take.
const BAR_WIDTH: f32 = 14.0;
/// The least room for settings beside the graph.
const LIST_WIDTH: f32 = 452.0;
const GRAPH_WIDTH: f32 = 290.0;
const GRAPH_HEIGHT: f32 = 210.0;
/// Room that the live figures take.
const STATUS_WIDTH: f32 = 290.0;

pub fn pin_ui(
    ui: &mut Ui,
    general: &mut GeneralView<'_>,
    pin: usize,
    signal: Option<PinSignal>,
    height: f32,
    commands: &mut Commands,
) {
    let width = ui.available_width();
    let is_wide = width - BAR_WIDTH >= LIST_WIDTH + GRAPH_WIDTH;
    let area = vec2(width, height);
    ui.allocate_ui_with_layout(area, Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(height);
        head_ui(ui, general, pin, commands);
        let scroll = ScrollArea::vertical().id_salt(("pin", pin)).auto_shrink(false);
        scroll.show(ui, |ui| {
            if general.calibration.as_ref().is_some_and(|run| run.pin == pin) {
                // The graph of the open range says nothing.
                return calibrate_ui(ui, general);
            }
            if is_wide {
                let left = width - BAR_WIDTH - GRAPH_WIDTH - ui.spacing().item_spacing.x;
                ui.horizontal_top(|ui| {
                    ui.allocate_ui_with_layout(vec2(left, 0.0), Layout::top_down(Align::Min), |ui| {
                        ui.set_width(left);
                        settings_ui(ui, general, pin, signal, left);
                    });
                    ui.vertical(|ui| {
                        ui.set_width(GRAPH_WIDTH);
                        picture_ui(ui, general, pin, signal, GRAPH_WIDTH);
                        status_ui(ui, general, pin, signal);
                    });
                });
            } else {
                let graph_width = (width - BAR_WIDTH - STATUS_WIDTH).clamp(160.0, GRAPH_WIDTH);
                ui.horizontal_top(|ui| {
                    ui.vertical(|ui| {
                        ui.set_width(graph_width);
                        picture_ui(ui, general, pin, signal, graph_width);
                    });
                    ui.vertical(|ui| status_ui(ui, general, pin, signal));
                });
                settings_ui(ui, general, pin, signal, width - BAR_WIDTH);
            }
        });
    });
}

/// The pin's name, its mode, and what can be done with it.
fn head_ui(ui: &mut Ui, general: &mut GeneralView<'_>, pin: usize, commands: &mut Commands) {
    let is_busy = general.is_busy();
    let mut action = None;
    ui.horizontal(|ui| {
        ui.set_min_height(ui.spacing().interact_size.y);
        let Some(unit) = general.unit_mut() else { return };
        let name = unit.table().subject().pin_name(pin - 1);
        ui.strong(&name);
        ui.add_space(8.0);
        ui.weak("Mode");
        mode_ui(ui, unit, pin, &name);
        let mode = unit.pin_mode_on_controller(pin);
        let is_edited = unit.pin_mode(pin) != mode;
        let why_not = match mode {
            None | Some(PinMode::None) => Some("The pin measures nothing yet. Write its mode first."),
            _ if is_edited => Some("Write the new mode first."),
            _ if is_busy => Some("Something else is being done with the settings."),
            _ => None,
        };
        let response = ui.add_enabled(why_not.is_none(), Button::new("Calibrate…"));
        let spoken = SignalMessage::Calibrate { pin: name.to_string() }.to_string();
        response.widget_info(|| WidgetInfo::labeled(Role::Button, why_not.is_none(), &spoken));
        let note = why_not.unwrap_or(
            "Finds minimum, center and maximum by moving the input. Meanwhile it commands nothing and triggers nothing.",
        );
        if response.on_hover_text(note).on_disabled_hover_text(note).clicked() {
            action = Some(pin);
        }
        if ui.button("Recipes…").on_hover_text("Switches, sticks and encoders at this pin, with their wiring").clicked() {
            general.recipes.answers.pin = pin;
            general.turn_to(Section::Recipes);
            return;
        }
        if is_edited {
            let hint = "Write the mode to see the live signal.";
            ui.add(Label::new(RichText::new(hint).small().weak()).truncate());
        }
    });
    if let Some(action) = action.and_then(|pin| general.calibrate(pin)) {
        commands.push(Command::Settings(action));
    }
}

fn mode_ui(ui: &mut Ui, unit: &mut UnitSettings, pin: usize, name: &str) {
    let current = unit.pin_mode(pin);
    let shown = current.map_or("not known", PinMode::label);
    let list = ComboBox::from_id_salt(("mode", pin)).width(110.0).selected_text(shown);
    let opened = list.show_ui(ui, |ui| {
        for (mode, why_not) in unit.pin_modes(pin) {
            let button = Button::selectable(current == Some(mode), mode.label());
            let response = ui.add_enabled(why_not.is_none(), button);
            let response = match why_not {
                Some(why_not) => response.on_disabled_hover_text(why_not),
                None => response.on_hover_text("Puts the pin's other settings back to their defaults"),
            };
            if response.clicked() {
                unit.set_pin_mode(pin, mode);
            }
        }
    });
    let spoken = SignalMessage::Mode { pin: name.to_string() }.to_string();
    ui.ctx().accesskit_node_builder(opened.response.id, |node| node.set_label(spoken));
}

fn picture_ui(ui: &mut Ui, general: &mut GeneralView<'_>, pin: usize, signal: Option<PinSignal>, width: f32) {
    let idle = general.calibration.is_none();
    let Some(unit) = general.unit_mut() else { return };
    if matches!(unit.pin_mode(pin), None | Some(PinMode::None)) {
        let hint = "This pin measures nothing. Choose a mode to see its signal graph.";
        // As high as the graph, so that nothing moves when a mode is chosen.
        let (rect, _) = ui.allocate_exact_size(vec2(width, GRAPH_HEIGHT), Sense::hover());
        let place = UiBuilder::new().max_rect(rect.shrink(20.0)).layout(Layout::top_down(Align::Min));
        ui.new_child(place).add(Label::new(RichText::new(hint).weak()).wrap());
        return;
    }
    ui.add_enabled_ui(idle, |ui| signal_graph_ui(ui, unit, pin, signal, vec2(width, GRAPH_HEIGHT)));
}

/// What the controller makes of the input now (MCP manual 1.9.12).
fn status_ui(ui: &mut Ui, general: &GeneralView<'_>, pin: usize, signal: Option<PinSignal>) {
    let Some(unit) = general.unit() else { return };
    let mode = unit.pin_mode_on_controller(pin).filter(|mode| *mode != PinMode::None);
    let signal = signal.filter(|_| mode.is_some());
    let unit_name = mode.map_or("", PinMode::unit);
    let per_s = if unit_name.is_empty() { "/s".to_owned() } else { format!("{unit_name}/s") };
    let behind =
        signal.and_then(|signal| unit.reading(pin, signal)).filter(|_| general.calibration.is_none());
    let percent = |raw: i32| format!("{:.1}", f64::from(raw) / scale::FULL_DUTY_RAW as f64 * 100.0);
    let lines = [
        ("Input", behind.map(reading_text), unit_name),
        ("Position", signal.map(|signal| signal.position.to_string()), unit_name),
        ("Percent", signal.map(|signal| percent(signal.percent)), "%"),
        ("Command", signal.map(|signal| signal.command.to_string()), ""),
        ("Instantaneous speed", signal.map(|signal| signal.speed.to_string()), &per_s),
        ("Average speed", signal.map(|signal| signal.average_speed.to_string()), &per_s),
    ];
    for (label, value, unit) in lines {
        ui.horizontal(|ui| {
            crate::widgets::label::fixed_label_ui(ui, label, 130.0);
            let spoken = SignalMessage::Signal { what: label.to_lowercase() }.to_string();
            let readout = Readout { label: &spoken, unit, digits: 9, unit_letters: 7 };
            readout.ui(ui, value.as_deref());
        });
    }
}

fn reading_text(behind: Behind) -> String {
    match behind {
        Behind::Reading(reading) => reading.to_string(),
        Behind::Deadband => "at rest".to_owned(),
        Behind::LowEnd => PinMessage::LowEnd.to_string(),
        Behind::HighEnd => PinMessage::HighEnd.to_string(),
    }
}

/// The settings of the pin.
fn settings_ui(
    ui: &mut Ui,
    general: &mut GeneralView<'_>,
    pin: usize,
    signal: Option<PinSignal>,
    width: f32,
) {
    let keys: Vec<String> = general.shown().into_iter().filter(|key| !is_mode(key)).collect();
    let columns = Columns::with_extra(width, ui.spacing().item_spacing.x);
    rows::header_ui(ui, columns);
    ui.spacing_mut().item_spacing.y = 0.0;
    rows::list_ui(ui, general, &keys, columns, &mut |ui, unit, row| extra_ui(ui, unit, row, pin, signal));
}

/// The rows that the mode list stands for.
fn is_mode(key: &str) -> bool {
    key.ends_with(".type") || key.ends_with(".digital")
}

/// What stands beside some fields: Set, and Match Input.
fn extra_ui(ui: &mut Ui, unit: &mut UnitSettings, row: &Row, pin: usize, signal: Option<PinSignal>) {
    let enabled = unit.locked(row).is_none();
    match row.pattern {
        "pin.{n}.min" | "pin.{n}.center" | "pin.{n}.max" => {
            let reading = signal.and_then(|signal| unit.reading(pin, signal));
            let (value, note) = set_from(reading);
            let response = ui.add_enabled(enabled && value.is_some(), Button::new("Set").small());
            let spoken = SignalMessage::SetFromLive { title: row.title() }.to_string();
            response.widget_info(|| WidgetInfo::labeled(Role::Button, value.is_some(), &spoken));
            if response.on_hover_text(note).on_disabled_hover_text(note).clicked()
                && let Some(value) = value
            {
                unit.set_number(&row.key, value);
            }
        }
        "pin.{n}.min_output" => {
            let response = ui.add_enabled(enabled, Button::new("Match").small());
            let spoken = "Match Input";
            response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, spoken));
            let note = "Match Input: makes the command range as wide as the input range around its center";
            if response.on_hover_text(note).clicked() {
                unit.match_input(pin);
            }
        }
        _ => {}
    }
}

/// The reading to take over, and what to say of it.
fn set_from(behind: Option<Behind>) -> (Option<f64>, &'static str) {
    match behind {
        Some(Behind::Reading(reading)) => (Some(reading), "Takes the input as it stands now"),
        Some(Behind::Deadband) => (
            None,
            "Within the deadband the controller does not tell where the input stands. Calibrate instead.",
        ),
        Some(Behind::LowEnd | Behind::HighEnd) => {
            (None, "Beyond its range the controller does not tell where the input stands. Calibrate instead.")
        }
        None => (None, "No live signal yet. Write the pin's mode first."),
    }
}
