//! The manual's home guide: what each step does and how it stands.

use brushwork_link::device::{ArmScope, Request};
use brushwork_link::settings::SettingValue;
use egui::{Button, Grid, Label, RichText, Role, Ui, WidgetInfo};

use crate::command::Command;
use crate::family_action::Host;
use crate::model::{ConnectionId, IndicatorState, Model};
use crate::screens::drive::pace_ui;
use crate::suprmotr::messages::HomeMessage;
use crate::suprmotr::model::home::{Home, Standing, Step, Trouble};
use crate::widgets::Numeric;

const MARK: egui::Vec2 = egui::vec2(16.0, 18.0);

pub fn home_ui(ui: &mut Ui, model: &mut Model) {
    let armed = model.front.link.arming.is_armed_for(ArmScope::Position);
    let is_free = !model.front.is_guided();
    // What it puts back has to be known.
    let velocity = match model.front.settings.unit().and_then(|unit| unit.confirmed("motion.velocity")) {
        Some(SettingValue::Int(velocity)) => Some(velocity),
        Some(_) | None => None,
    };
    let home = &mut model.front.suprmotr_mut().home;
    ui.horizontal_wrapped(|ui| {
        let is_running = home.is_running();
        ui.add_enabled_ui(!is_running, |ui| {
            let range = 1.0..=1_000_000.0;
            let quick = Numeric { name: "Velocity to the limit", unit: "counts/s", range: range.clone(), decimals: 0, step: 500.0, width: 124.0 };
            pace_ui(ui, "To the limit", "DV of the way to the negative limit switch", &quick, &mut home.quick);
            let slow = Numeric { name: "Velocity off the limit", unit: "counts/s", range, decimals: 0, step: 50.0, width: 124.0 };
            pace_ui(ui, "Off it", "DV of the way off the switch: the slower, the more exact", &slow, &mut home.slow);
        });
        let can = armed && is_free && !is_running && velocity.is_some();
        let response = ui.add_enabled(can, Button::new("Find home"));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, can, "Find home"));
        let hint = match (armed, velocity) {
            (false, _) => "Arm first: the axis goes to its negative limit switch",
            (true, None) => "The velocity of moves, which is put back at the end, is not read yet",
            (true, Some(_)) => "Goes to the negative limit switch, off it again, and makes that place 0. Keep clear; Esc stops",
        };
        if response.on_hover_text(hint).on_disabled_hover_text(hint).clicked()
            && let Some(velocity) = velocity
        {
            home.begin(velocity);
        }
        ui.weak("At the end this place is 0, all positions mean something else, and the screen is disarmed.");
    });
    steps_ui(ui, home);
    if let Some(trouble) = &home.trouble {
        IndicatorState::Error.line_ui(ui, &trouble_text(trouble));
    } else if home.is_done() {
        IndicatorState::Ok.line_ui(ui, "Home: this place is 0.");
    }
}

/// Sends what is due, whether its screen is open or not: leaving it stops the axis and puts the velocity of moves back.
pub fn look_after_home(host: &mut dyn Host, id: ConnectionId) {
    let is_front = host.model().front.id() == id;
    let Some(connection) = host.model().connection_mut(id).filter(|connection| connection.is_connected())
    else {
        return;
    };
    match connection.suprmotr_mut().home.take_order() {
        // With a backup of the settings before the first change.
        Some(Command::Transact { id: number, command, values }) if is_front => {
            host.transact(number, command, values);
        }
        Some(Command::Transact { id: number, command, values }) => {
            if !host.request_of(id, Request::Transact { id: number, command, values })
                && let Some(connection) = host.model().connection_mut(id)
            {
                connection.suprmotr_mut().home.not_sent();
            }
        }
        Some(_) | None => {}
    }
}

fn steps_ui(ui: &mut Ui, home: &Home) {
    Grid::new("home").num_columns(4).spacing([18.0, 3.0]).show(ui, |ui| {
        for (index, step) in Step::ALL.into_iter().enumerate() {
            let (state, word) = match home.standing(step) {
                Standing::Waits => (IndicatorState::NotApplicable, "waits"),
                Standing::Runs => (IndicatorState::Active, "runs"),
                Standing::Done => (IndicatorState::Ok, "done"),
            };
            ui.horizontal(|ui| {
                let response = state.ui(ui, MARK, 5.0);
                let text = text_of(step, home);
                let spoken = HomeMessage::Step { text: text.clone(), state: word }.to_string();
                response.widget_info(|| WidgetInfo::labeled(Role::Status, true, &spoken));
                ui.add(Label::new(RichText::new(text).small()).selectable(false));
            });
            if index % 3 == 2 {
                ui.end_row();
            }
        }
    });
}

fn text_of(step: Step, home: &Home) -> String {
    match step {
        Step::Quick => HomeMessage::Velocity { counts_per_s: home.quick }.to_string(),
        Step::ToLimit => "FE1: to the negative limit switch".to_owned(),
        Step::Slow => HomeMessage::Velocity { counts_per_s: home.slow }.to_string(),
        Step::OffLimit => "FE4: off it again".to_owned(),
        Step::PutBack => "DV: your velocity again".to_owned(),
        Step::Zero => "DH: this place is 0".to_owned(),
    }
}

fn trouble_text(trouble: &Trouble) -> String {
    match trouble {
        Trouble::NoLimit => "The search ended without the negative limit switch: nothing was made 0. See whether it is wired, and whether the limits act (LN).".to_owned(),
        Trouble::StillOn => "The negative limit switch is on still: nothing was made 0.".to_owned(),
        Trouble::Stopped => "Stopped: nothing was made 0, and the velocity of moves is put back.".to_owned(),
        Trouble::Refused(why) => HomeMessage::Refused { why: why.clone() }.to_string(),
    }
}
