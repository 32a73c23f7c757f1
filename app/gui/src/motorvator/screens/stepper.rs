//! The stepper of the half that is selected: moves, how it is configured, and the guided search for its smallest waits.

use brushwork_link::device::ArmScope;
use brushwork_link::settings::SettingValue;
use brushwork_motorvator_client::{Half, MOTORVATOR, MotorvatorFacts, STEPPER_KEYS};
use brushwork_motorvator_wire::host::StepperConfig;
use egui::{Button, Label, RichText, Role, Ui, WidgetInfo};

use crate::command::Commands;
use crate::family_action::Host;
use crate::model::{ConnectionId, Model};
use crate::motorvator::messages::BoardMessage;
use crate::motorvator::model::search::Stage;
use crate::motorvator::model::stepper::{Phase, Stepper};
use crate::screens::drive::{drive_ui, options_ui, pace_ui};
use crate::screens::{not_connected_text, nothing_ui};
use crate::widgets::Numeric;

/// What the settings say of the stepper is read anew after it was configured here, and the fields show what was read.
pub fn look_after_stepper(host: &mut dyn Host, id: ConnectionId) {
    let Some(connection) = host.model().connection_mut(id) else { return };
    if connection.family().family() != MOTORVATOR {
        return;
    }
    if connection.motorvator_mut().stepper.take_configured() {
        connection.settings.doubt();
    }
    let on_board = connection.settings.unit().and_then(|unit| {
        let [least, most, hold] = STEPPER_KEYS.map(|key| match unit.confirmed(key) {
            Some(SettingValue::Int(value)) => u8::try_from(value).ok(),
            Some(_) | None => None,
        });
        Some(StepperConfig { least: least?, most: most?, hold_percent: hold? })
    });
    connection.motorvator_mut().stepper.follow(on_board);
}

/// Draws the screen, and has the board told what is due.
pub fn stepper_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let Some(identity) = model.front.link.identity() else {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    };
    let half = MotorvatorFacts::of(identity).map_or(Half::First, |facts| facts.half);
    let note = match half {
        Half::First => {
            "Stepper 1 takes motors A and B. The board counts its steps and does not see where it stands."
        }
        Half::Second => {
            "Stepper 2 takes motors C and D. The board counts its steps and does not see where it stands."
        }
    };
    let mut asked = Vec::new();
    drive_ui(ui, model, ("Stepper", note, ArmScope::Position), commands, |ui, model| {
        let armed = model.front.link.arming.is_armed_for(ArmScope::Position);
        let stepper = &mut model.front.motorvator_mut().stepper;
        move_ui(ui, stepper, armed);
        config_ui(ui, stepper, half, armed);
        search_ui(ui, stepper, half, armed);
        if let Some(trouble) = &stepper.trouble {
            ui.add(Label::new(RichText::new(trouble).color(ui.visuals().error_fg_color)).wrap());
        }
        asked.extend(stepper.take_order());
    });
    commands.extend(asked);
}

fn move_ui(ui: &mut Ui, stepper: &mut Stepper, armed: bool) {
    let is_free = armed && stepper.is_idle();
    options_ui(ui, |ui| {
        let steps = number("Steps", "", 1.0..=65_535.0, 10.0);
        pace_ui(ui, "Steps", "How far a move goes, and a trial of the search", &steps, &mut stepper.steps);
        if button_ui(ui, "Backward", "Move backward", is_free) {
            stepper.begin_move(false);
        }
        if button_ui(ui, "Forward", "Move forward", is_free) {
            stepper.begin_move(true);
        }
        if matches!(stepper.phase, Phase::Working { .. }) {
            ui.spinner();
        }
    });
}

fn config_ui(ui: &mut Ui, stepper: &mut Stepper, half: Half, armed: bool) {
    options_ui(ui, |ui| {
        let wait = |name| number(name, "", 1.0..=255.0, 1.0);
        pace_ui(
            ui,
            "MinWait",
            "Between steps at the highest speed, in 1/1024 s (assumed)",
            &wait("MinWait"),
            &mut stepper.min_wait,
        );
        pace_ui(
            ui,
            "MaxWait",
            "Between steps when a move begins and ends",
            &wait("MaxWait"),
            &mut stepper.max_wait,
        );
        let hold = number("HoldCurrent", "%", 0.0..=100.0, 5.0);
        pace_ui(ui, "Hold", "Part of full power while it stands", &hold, &mut stepper.hold_percent);
        if button_ui(ui, "Configure", "Configure the stepper", armed && stepper.is_idle()) {
            stepper.configure();
        }
        ui.separator();
        let line = stepper.config().statement(half.number());
        ui.add(Label::new(RichText::new(&line).monospace()).selectable(true));
        if button_ui(ui, "Copy", "Copy the ConfigStepper line", true) {
            ui.ctx().copy_text(line);
        }
    });
}

fn search_ui(ui: &mut Ui, stepper: &mut Stepper, half: Half, armed: bool) {
    ui.horizontal_wrapped(|ui| {
        let Some(search) = stepper.search else {
            if button_ui(ui, "Find the smallest waits…", "Find the smallest waits", armed && stepper.is_idle()) {
                stepper.try_next();
            }
            ui.weak("Put a mark on the shaft. Each trial moves there, and slowly back; you say whether the mark has come back.");
            return;
        };
        let config = search.config().statement(half.number());
        let text = match (search.stage, &stepper.phase) {
            (Stage::Found, _) => BoardMessage::Found { config }.to_string(),
            (Stage::Hopeless, _) => {
                "It loses steps at the slowest speed too. See whether it gets power, and whether its coils are wired right.".to_owned()
            }
            (Stage::Start | Stage::Top, Phase::Asks) => {
                BoardMessage::TrialOver { trial: search.trials + 1, config }.to_string()
            }
            (Stage::Start | Stage::Top, Phase::Idle | Phase::Working { .. }) => {
                BoardMessage::Trial { trial: search.trials + 1, config }.to_string()
            }
        };
        ui.label(text);
        if stepper.phase == Phase::Asks {
            if button_ui(ui, "It came back", "The mark came back", armed) {
                stepper.judge(false);
            }
            if button_ui(ui, "It lost steps", "The stepper lost steps", armed) {
                stepper.judge(true);
            }
        }
        let end = if search.is_trying() { "Cancel" } else { "Close" };
        if button_ui(ui, end, "End the search", true) {
            let has_tried = search.is_trying() && armed;
            stepper.give_up();
            // The board has what the last trial went back with.
            if has_tried {
                stepper.configure();
            }
        }
    });
}

fn button_ui(ui: &mut Ui, text: &str, name: &str, enabled: bool) -> bool {
    let response = ui.add_enabled(enabled, Button::new(text));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    response.clicked()
}

fn number<'a>(name: &'a str, unit: &'a str, range: std::ops::RangeInclusive<f64>, step: f64) -> Numeric<'a> {
    Numeric { name, unit, range, decimals: 0, step, width: 84.0 }
}
