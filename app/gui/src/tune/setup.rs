//! What is set before a run: which motor, how stiff, by which method, and how far the axis may go.

use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::tune::{Identification, Method};
use brushwork_values::Motor;
use egui::{Button, ComboBox, Label, RichText, Ui};

use super::level::level_ui;
use super::model::{Setting, TuneAction};
use super::which::Loop;
use crate::command::{Command, Commands};
use crate::family::Ability;
use crate::focus::{self, Region, region_ui};
use crate::messages::NameMessage;
use crate::model::Model;
use crate::theme::Palette;
use crate::tune::messages::RunMessage;
use crate::widgets::numeric::Numeric;

/// From these widths on both motors stand in one row, with words beside their sliders, and all options in another.
const BOTH_IN_A_ROW: f32 = 720.0;
const WITH_WORDS: f32 = 960.0;
const OPTIONS_IN_A_ROW: [f32; 2] = [860.0, 1070.0];
/// What the choice of an encoder takes of that.
const ENCODER_WIDTH: f32 = 190.0;
/// Room for the ends of a travel.
const TRAVEL_WIDTH: f32 = 270.0;

const WHAT_IT_DOES: &str = "Checks the wiring with little duty, measures the motor, designs gains for the level, and tries them. \
    Nothing stays in the controller until you apply it.";

const WHAT_IT_DOES_BY_MOVES: &str = "Moves the axis to and fro under known gains, measures the loop, designs gains for the level, and tries them. \
    Nothing stays in the controller until you apply it.";

pub fn setup_ui(ui: &mut Ui, model: &mut Model, which: Loop, commands: &mut Commands) {
    let _palette = Palette::of(ui);
    let is_armed = model.front.link.arming.is_armed_for(which.scope());
    let is_free = !model.front.is_guided();
    let can_start = is_armed && is_free;
    let is_wide = ui.available_width() >= WITH_WORDS;
    let motors = model.front.motors();
    // What a run lacks yet is where the keyboard comes to.
    let front = model.front.tune.motor(which);
    if !model.front.tune.panel(which, front).setting.lacks_travel() {
        region_ui(ui, Region::Controls);
    }
    if ui.available_width() >= BOTH_IN_A_ROW {
        ui.horizontal(|ui| {
            for motor in motors {
                motor_row_ui(ui, model, (which, *motor), (can_start, is_wide), commands);
                ui.add_space(10.0);
            }
        });
    } else {
        for motor in motors {
            ui.horizontal(|ui| motor_row_ui(ui, model, (which, *motor), (can_start, is_wide), commands));
        }
    }
    options_ui(ui, model, which);
    let has_duty = model.front.family().lacks(Ability::Duty).is_none();
    let hint = if is_armed {
        if has_duty { WHAT_IT_DOES } else { WHAT_IT_DOES_BY_MOVES }
    } else {
        "Arm this screen to tune. Looking at results and trying gains on the model needs no arming."
    };
    ui.add(Label::new(RichText::new(hint).small().weak()).wrap());
}

fn motor_row_ui(
    ui: &mut Ui,
    model: &mut Model,
    (which, motor): (Loop, Motor),
    (can_start, is_wide): (bool, bool),
    commands: &mut Commands,
) {
    let is_front = model.front.tune.motor(which) == motor;
    let look = ui.selectable_label(is_front, NameMessage::Motor { number: motor.index() + 1 }.to_string());
    if look.on_hover_text("Shows its results below").clicked() {
        model.front.tune.look_at(which, motor);
    }
    let lacks_travel = model.front.tune.panel(which, motor).setting.lacks_travel();
    let tune =
        ui.add_enabled(can_start && !lacks_travel, Button::new(RunMessage::Tune { motor }.to_string()));
    let tune = tune.on_disabled_hover_text(if lacks_travel {
        "Say first how far the axis may go: Turns freely, or Within"
    } else {
        "Arm this screen first"
    });
    if is_front && can_start && std::mem::take(&mut model.front.tune.wants_start) {
        tune.request_focus();
    }
    if tune.on_hover_text("Moves the motor, at up to the highest duty").clicked() {
        commands.push(Command::Tune(TuneAction::Start(motor)));
    }
    let panel = model.front.tune.panel_mut(which, motor);
    let mut level = panel.level();
    ui.label("Level");
    if is_wide {
        ui.label(RichText::new("soft").small().weak());
    }
    let hint = "How stiff the loop is made. After a run it redraws what the gains of another level would do, without moving anything.";
    if level_ui(
        ui,
        &RunMessage::LevelOf { motor }.to_string(),
        hint,
        if is_wide { 136.0 } else { 104.0 },
        &mut level,
    ) {
        panel.setting.level = level;
        if let Some(run) = panel.run_mut() {
            run.set_level(level);
        }
        model.front.tune.look_at(which, motor);
    }
    if is_wide {
        ui.label(RichText::new("stiff").small().weak());
    }
}

fn options_ui(ui: &mut Ui, model: &mut Model, which: Loop) {
    let motor = model.front.tune.motor(which);
    let travel = model.front.travels()[motor.index()];
    let family = model.front.family();
    let methods = family.methods(which);
    let has_encoders = family.lacks(Ability::AbsoluteEncoders).is_none();
    let has_duty = family.lacks(Ability::Duty).is_none();
    let is_simulated = model.front.link.identity().is_some_and(|identity| identity.simulated);
    let setting = &mut model.front.tune.panel_mut(which, motor).setting;
    let travel_width = if setting.turns_freely { 0.0 } else { TRAVEL_WIDTH };
    let encoder_width = if has_encoders { 0.0 } else { ENCODER_WIDTH };
    let is_wide = ui.available_width() >= OPTIONS_IN_A_ROW[which as usize] + travel_width - encoder_width;
    let lacked_travel = setting.lacks_travel();
    ui.horizontal(|ui| {
        ui.strong(NameMessage::MotorHead { number: motor.index() + 1 }.to_string());
        methods_ui(ui, setting, methods);
        if lacked_travel {
            region_ui(ui, Region::Controls);
        }
        // A velocity loop has no use for position limits, which may be left over.
        travel_ui(ui, setting, travel.filter(|_| which == Loop::Position));
        if is_wide {
            ui.separator();
            limits_ui(ui, setting, has_duty, has_encoders);
        }
    });
    if !is_wide {
        ui.horizontal(|ui| limits_ui(ui, setting, has_duty, has_encoders));
    }
    if has_duty {
        let no_own_test = family
            .lacks(Ability::OwnTest)
            .or_else(|| (!is_simulated).then_some(NOT_ON_REAL_ONES))
            .or_else(|| match setting.method {
                Method::Velocity => (!setting.turns_freely).then_some(ONLY_FREELY),
                Method::Piv => Some(NOT_FOR_PIV),
                Method::Pd | Method::Pid => None,
            });
        ui.horizontal(|ui| identification_ui(ui, setting, no_own_test));
    }
    let is_said = lacked_travel && !setting.lacks_travel();
    model.front.tune.wants_start |= is_said && focus::shows_ring(ui.ctx());
}

/// Why a controller is not asked to test its loop itself.
const NOT_ON_REAL_ONES: &str = "Simulated controllers only: no manual says how a controller's own test drives the motor and how it ends, and with wrong wiring it can lock \
                                the controller up (MCP manual 2.4.5).";

/// What the relay of a speed does, and that of a position or in a travel.
const RELAY_ABOUT_SPEED: &str = "Astrom and Hagglund's relay about the speed of a duty, until the motor goes round in a limit cycle; gains by the rule of Tyreus and Luyben";
const RELAY_ABOUT_PLACE: &str = "Astrom and Hagglund's relay about where the axis stands, until it goes to and fro in a limit cycle; gains by the rule of Tyreus and Luyben, of a \
                                 PD loop by that of Ziegler and Nichols";
/// The same of a speed in a travel, and of PIV.
const ONLY_FREELY: &str =
    "The controller's own test of a speed turns the motor on and on: it is for a motor that may turn freely.";
const NOT_FOR_PIV: &str =
    "The controller's own test of a position gives gains of a PD or PID loop. Choose one of these.";

/// What the controller's own test of a speed does, and that of a position.
const OWN_ABOUT_SPEED: &str = "The controller's own relay test (commands 84, 85, 88 and 89) about the speed of a duty, beside a fitted model; gains by the rule of Tyreus and Luyben. How \
                               a real one does it is not public: the simulated one does what a textbook's relay does";
const OWN_ABOUT_PLACE: &str = "The controller's own relay test (commands 86 to 89) about where the axis stands, beside a fitted model; gains by the rule of Tyreus and Luyben, of a PD loop \
                               by that of Ziegler and Nichols. How a real one does it is not public: the simulated one does what a textbook's relay does";

/// How the motor is identified; `no_own_test` says why the controller's own test is not to be had, if so.
fn identification_ui(ui: &mut Ui, setting: &mut Setting, no_own_test: Option<&str>) {
    ui.label("Identify");
    let is_about_place = setting.method != Method::Velocity || !setting.turns_freely;
    for (identification, name, hint) in [
        (
            Identification::Fit,
            "By fit",
            "Several motions up to full duty, a model fitted to them, and gains searched for on it",
        ),
        (
            Identification::Step,
            "By step",
            "One step about a duty and never more, in a travel several to and fro; gains by the rule SIMC",
        ),
        (
            Identification::Relay,
            "By relay",
            if is_about_place { RELAY_ABOUT_PLACE } else { RELAY_ABOUT_SPEED },
        ),
    ] {
        ui.radio_value(&mut setting.identification, identification, name).on_hover_text(hint);
    }
    ui.add_enabled_ui(no_own_test.is_none(), |ui| {
        ui.radio_value(&mut setting.identification, Identification::Controller, "By controller")
            .on_hover_text(if setting.method == Method::Velocity { OWN_ABOUT_SPEED } else { OWN_ABOUT_PLACE })
            .on_disabled_hover_text(no_own_test.unwrap_or_default());
    });
    let has_duty_about = match setting.identification {
        Identification::Fit => false,
        Identification::Relay => !is_about_place,
        Identification::Step => true,
        Identification::Controller => setting.method == Method::Velocity,
    };
    if has_duty_about {
        ui.label("about");
        let duty = Numeric {
            name: "About duty",
            unit: "%",
            range: 10.0..=90.0,
            decimals: 0,
            step: 5.0,
            width: 62.0,
        };
        duty.ui(ui, &mut setting.about_percent)
            .on_hover_text("The duty that the step, the relay or the controller's own test lies about");
    }
}

/// The ways to tune a loop, where there is a choice.
fn methods_ui(ui: &mut Ui, setting: &mut Setting, methods: &[Method]) {
    if methods.len() < 2 {
        return;
    }
    ui.label("Method");
    for method in methods {
        let (name, hint) = match method {
            Method::Velocity => ("Velocity", "The speed loop"),
            Method::Pd => ("PD", "Proportional and differential, straight on the duty"),
            Method::Pid => ("PID", "With an integral, which is bounded and needs a deadzone"),
            Method::Piv => ("PIV", "Position P over the velocity loop: both are tuned"),
        };
        ui.radio_value(&mut setting.method, *method, name).on_hover_text(hint);
    }
    ui.separator();
}

fn limits_ui(ui: &mut Ui, setting: &mut Setting, has_duty: bool, has_encoders: bool) {
    if has_duty {
        highest_ui(ui, setting);
        ui.separator();
    }
    let tries = ui.checkbox(&mut setting.tries, "Try the gains");
    tries.on_hover_text(
        "Tries them on the machine at the end of the run and lowers them if it is rougher than predicted",
    );
    if has_encoders {
        encoder_ui(ui, setting);
    }
}

/// The highest duty and current of a run.
fn highest_ui(ui: &mut Ui, setting: &mut Setting) {
    ui.label("Duty up to");
    let duty =
        Numeric { name: "Highest duty", unit: "%", range: 20.0..=100.0, decimals: 0, step: 5.0, width: 62.0 };
    duty.ui(ui, &mut setting.max_duty_percent).on_hover_text("The run never gives more");
    ui.label("Current up to");
    let amps = Numeric::new("Highest current", "A", 0.0..=200.0, (1, 0.5, 70.0));
    amps.ui(ui, &mut setting.max_amps)
        .on_hover_text("The run ends above it; 0 leaves it to the controller's own limit");
}

fn travel_ui(ui: &mut Ui, setting: &mut Setting, held: Option<(f64, f64)>) {
    let (word, hint) = match setting.encoder {
        EncoderClass::Quadrature => {
            ("Turns freely", "The motor may run at full speed in both directions for some seconds")
        }
        EncoderClass::Absolute | EncoderClass::AbsoluteWrapping => {
            ("Its whole range", "The axis stays between 40 and 4055 counts, and within the position limits")
        }
    };
    let is_free = setting.turns_freely && !setting.lacks_travel();
    let free = ui.radio(is_free, word).on_hover_text(hint);
    if free.clicked() {
        (setting.turns_freely, setting.is_travel_chosen) = (true, true);
    }
    let bound = ui.radio_value(&mut setting.turns_freely, false, "Within");
    if bound.on_hover_text("The axis stays between two counts and never runs at full speed").clicked() {
        setting.is_travel_chosen = true;
        setting.travel = held.unwrap_or(setting.travel);
    }
    if !setting.turns_freely {
        let field =
            |name| Numeric { name, unit: "", range: -2e9..=2e9, decimals: 0, step: 100.0, width: 88.0 };
        let before = setting.travel;
        field("Travel low").ui(ui, &mut setting.travel.0);
        ui.label("to");
        field("Travel high").ui(ui, &mut setting.travel.1);
        setting.is_travel_chosen |= setting.travel != before;
        ui.label("counts");
    }
}

fn encoder_ui(ui: &mut Ui, setting: &mut Setting) {
    let label = ui.label("Encoder");
    let word = |class| match class {
        EncoderClass::Quadrature => "quadrature",
        EncoderClass::Absolute => "absolute",
        EncoderClass::AbsoluteWrapping => "absolute, wraps",
    };
    let combo =
        ComboBox::from_id_salt("tune encoder").selected_text(word(setting.encoder)).show_ui(ui, |ui| {
            for class in [EncoderClass::Quadrature, EncoderClass::Absolute, EncoderClass::AbsoluteWrapping] {
                let choice = ui.selectable_value(&mut setting.encoder, class, word(class));
                setting.is_encoder_chosen |= choice.clicked();
            }
        });
    let hint = if setting.is_encoder_chosen {
        "Chosen here. An absolute encoder gives 0 to 4095; one that wraps goes on from 4095 to 0."
    } else {
        "As the controller's settings say. No setting says whether an absolute encoder wraps, going on from 4095 to 0: choose that here."
    };
    combo.response.labelled_by(label.id).on_hover_text(hint);
}
