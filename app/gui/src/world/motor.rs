//! One motor of the simulated world: its load, its faults, its limit switches, and the truth about it.

use brushwork_plant::world::{SwitchKind, WorldAction, WorldView};
use brushwork_values::Motor;
use egui::{Checkbox, Ui};

use super::{Actions, figures_ui, number, row_ui, toggle_ui};
use crate::messages::NameMessage;
use crate::model::world::WorldPanel;
use crate::widgets::{fixed_label_ui, heading_ui};
use crate::world::messages::WorldMessage;

pub fn motor_ui(ui: &mut Ui, motor: Motor, view: &WorldView, panel: &mut WorldPanel, actions: &mut Actions) {
    ui.separator();
    ui.push_id(motor.index(), |ui| {
        heading_ui(ui, &NameMessage::Motor { number: motor.index() + 1 }.to_string());
        truth_ui(ui, motor, view);
        fields_ui(ui, motor, panel, actions);
        faults_ui(ui, motor, view, actions);
        switches_ui(ui, motor, view, actions);
    });
}

fn truth_ui(ui: &mut Ui, motor: Motor, view: &WorldView) {
    let axis = &view.axes[motor.index()];
    let turns_per_minute = axis.truth.load_radians_per_second * 60.0 / std::f64::consts::TAU;
    let turns = axis.truth.load_radians / std::f64::consts::TAU;
    figures_ui(ui, &WorldMessage::Axis { rpm: turns_per_minute, turns, amps: axis.truth.amps }.to_string());
}

fn fields_ui(ui: &mut Ui, motor: Motor, panel: &mut WorldPanel, actions: &mut Actions) {
    let index = motor.index();
    let name = WorldMessage::LoadTorque { motor }.to_string();
    let load = number(("Load torque", &name), "N·m", -200.0..=200.0, 3);
    if row_ui(ui, &load, &mut panel.load_newton_metres[index]) {
        actions.push(WorldAction::SetLoadTorque { motor, newton_metres: panel.load_newton_metres[index] });
    }
    let name = WorldMessage::EncoderNoise { motor }.to_string();
    let noise = number(("Encoder noise", &name), "counts", 0.0..=1000.0, 1);
    if row_ui(ui, &noise, &mut panel.encoder_noise_counts[index]) {
        actions.push(WorldAction::SetEncoderNoise { motor, counts: panel.encoder_noise_counts[index] });
    }
}

fn faults_ui(ui: &mut Ui, motor: Motor, view: &WorldView, actions: &mut Actions) {
    let truth = &view.axes[motor.index()].truth;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 10.0;
        if toggle_ui(ui, "Encoder reversed", truth.encoder_reversed) {
            actions.push(WorldAction::ReverseEncoder { motor, on: !truth.encoder_reversed });
        }
        if toggle_ui(ui, "Encoder lost", truth.encoder_lost) {
            actions.push(WorldAction::LoseEncoder { motor, on: !truth.encoder_lost });
        }
        if toggle_ui(ui, "Shaft locked", truth.shaft_locked) {
            actions.push(WorldAction::LockShaft { motor, on: !truth.shaft_locked });
        }
        if toggle_ui(ui, "Lead off", truth.lead_open) {
            actions.push(WorldAction::OpenLead { motor, on: !truth.lead_open });
        }
        if toggle_ui(ui, "Leads swapped", truth.leads_reversed) {
            actions.push(WorldAction::ReverseLeads { motor, on: !truth.leads_reversed });
        }
    });
}

fn switches_ui(ui: &mut Ui, motor: Motor, view: &WorldView, actions: &mut Actions) {
    fixed_label_ui(ui, "Switches held closed", 150.0);
    ui.horizontal(|ui| {
        for (kind, closed) in SwitchKind::ALL.into_iter().zip(view.axes[motor.index()].switches_closed) {
            let wired = view.wiring.switch(motor, kind).is_some();
            let mut now = closed;
            let response = ui.add_enabled(wired, Checkbox::new(&mut now, name(kind)));
            let response = response.on_disabled_hover_text(
                "Not wired. Choose it for a pin below, and give that pin a limit or home mode in the settings.",
            );
            if response.changed() {
                actions.push(WorldAction::HoldSwitch { motor, switch: kind, closed: now });
            }
        }
    });
}

pub fn name(kind: SwitchKind) -> &'static str {
    match kind {
        SwitchKind::Forward => "forward",
        SwitchKind::Backward => "backward",
        SwitchKind::Home => "home",
    }
}
