//! The input pins of the simulated world: what is connected to each.

use brushwork_plant::world::{PinSignal, SwitchKind, WorldAction, WorldView};
use brushwork_values::Motor;
use egui::{ComboBox, Ui};

use super::motor::name;
use super::{Actions, number};
use crate::family::Family;
use crate::messages::NameMessage;
use crate::widgets::{fixed_label_ui, heading_ui};
use crate::world::messages::WorldMessage;

pub fn pins_ui(
    ui: &mut Ui,
    view: &WorldView,
    (family, motors): (&dyn Family, &[Motor]),
    actions: &mut Actions,
) {
    let names = family.world_pins();
    ui.separator();
    heading_ui(ui, "Input pins");
    for (pin, signal) in view.pins.iter().enumerate() {
        let label = names
            .get(pin)
            .map_or_else(|| NameMessage::Pin { number: pin + 1 }.to_string(), |name| (*name).to_owned());
        ui.push_id(pin, |ui| {
            ui.horizontal(|ui| {
                fixed_label_ui(ui, &label, if names.is_empty() { 44.0 } else { 84.0 });
                pin_ui(ui, (pin, &label), *signal, view, motors, actions);
            })
        });
    }
}

fn pin_ui(
    ui: &mut Ui,
    (pin, label): (usize, &str),
    signal: PinSignal,
    view: &WorldView,
    motors: &[Motor],
    actions: &mut Actions,
) {
    let wired = wired_to(view, pin);
    let text = wired.clone().unwrap_or_else(|| kind_text(signal).to_owned());
    let combo = ComboBox::from_id_salt("kind").width(112.0).selected_text(text);
    let response = combo.show_ui(ui, |ui| choices_ui(ui, pin, view, motors, actions));
    ui.ctx().accesskit_node_builder(response.response.id, |node| {
        node.set_label(WorldMessage::ConnectedTo { pin: label.to_string() }.to_string());
    });
    if wired.is_none() {
        value_ui(ui, pin, label, signal, actions);
    }
}

/// Everything that can be put on a pin.
fn choices_ui(ui: &mut Ui, pin: usize, view: &WorldView, motors: &[Motor], actions: &mut Actions) {
    let signals =
        [PinSignal::Open, PinSignal::Volts { volts: 2.5 }, PinSignal::Pulse { microseconds: 1500.0 }];
    // A controller of one motor has its encoder on pins of its own.
    let encoders =
        motors.iter().filter(|_| motors.len() > 1).map(|motor| PinSignal::Encoder { motor: *motor });
    for signal in signals.into_iter().chain(encoders) {
        if ui.selectable_label(false, kind_text(signal)).clicked() {
            unwire(pin, view, actions);
            actions.push(WorldAction::SetPin { pin, signal });
        }
    }
    for motor in motors.iter().copied() {
        for switch in SwitchKind::ALL {
            if ui.selectable_label(false, switch_text(motor, switch)).clicked() {
                unwire(pin, view, actions);
                actions.push(WorldAction::SetPin { pin, signal: PinSignal::Open });
                actions.push(WorldAction::WireSwitch {
                    motor,
                    switch,
                    pin: Some(pin),
                    trips_at_radians: None,
                });
            }
        }
    }
}

/// Takes away the switch that hangs on a pin, so that something else can.
fn unwire(pin: usize, view: &WorldView, actions: &mut Actions) {
    let on_pin = view.wiring.switches.iter().filter(|switch| switch.pin == pin);
    actions.extend(on_pin.map(|wired| WorldAction::WireSwitch {
        motor: wired.motor,
        switch: wired.switch,
        pin: None,
        trips_at_radians: None,
    }));
}

fn value_ui(ui: &mut Ui, pin: usize, label: &str, signal: PinSignal, actions: &mut Actions) {
    let (mut value, unit, range, decimals) = match signal {
        PinSignal::Volts { volts } => (volts, "V", 0.0..=15.0, 2),
        PinSignal::Pulse { microseconds } => (microseconds, "µs", 500.0..=2500.0, 0),
        PinSignal::Open | PinSignal::Encoder { .. } => return,
    };
    let name = WorldMessage::ValueOf { pin: label.to_string() }.to_string();
    let field = number(("", &name), unit, range, decimals);
    if field.numeric.ui(ui, &mut value).changed() {
        let signal = match signal {
            PinSignal::Volts { .. } => PinSignal::Volts { volts: value },
            PinSignal::Open | PinSignal::Pulse { .. } | PinSignal::Encoder { .. } => {
                PinSignal::Pulse { microseconds: value }
            }
        };
        actions.push(WorldAction::SetPin { pin, signal });
    }
}

/// What hangs on a pin for good.
fn wired_to(view: &WorldView, pin: usize) -> Option<String> {
    if view.wiring.estop_pin == Some(pin) {
        return Some("E-stop button".to_owned());
    }
    let switch = view.wiring.switches.iter().find(|switch| switch.pin == pin)?;
    Some(switch_text(switch.motor, switch.switch))
}

fn switch_text(motor: Motor, switch: SwitchKind) -> String {
    WorldMessage::Switch { motor, kind: name(switch) }.to_string()
}

const fn kind_text(signal: PinSignal) -> &'static str {
    match signal {
        PinSignal::Open => "nothing",
        PinSignal::Volts { .. } => "a voltage",
        PinSignal::Pulse { .. } => "pulses",
        PinSignal::Encoder { motor: Motor::M1 } => "encoder 1",
        PinSignal::Encoder { motor: Motor::M2 } => "encoder 2",
    }
}
