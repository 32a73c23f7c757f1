//! The screens that drive a Motion Mind, and what stands in their place when its mode does not let this program drive it
//! (Motion Mind manual, chapter 4).

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Button, Label, RichText, Ui};

use crate::command::{Command, Commands};
use crate::model::{Model, Screen};
use crate::motion_mind::messages::MindMessage;
use crate::motion_mind::model::Driven;
use crate::motion_mind::model::drive::{LOOPS_PER_S, VELOCITY_RANGE};
use crate::screens::drive::{Output, drive_ui, motor_ui, on_release_ui, options_ui, pace_ui};
use crate::screens::graph_place::graph_place_ui;
use crate::screens::title_ui;
use crate::widgets::{Numeric, Setpoint};

const fn output(scope: ArmScope, word: &'static str, channel: Channel, unit: &'static str) -> Output {
    Output { scope, word, channels: [channel; 2], unit, digits: 9, unit_letters: 7, width: 204.0 }
}

const DUTY: Output = output(ArmScope::Pwm, "output", Channel::M1_PWM, "%");
const VELOCITY: Output = output(ArmScope::Velocity, "measured", Channel::M1_VELOCITY, "counts/s");
const POSITION: Output = output(ArmScope::Position, "measured", Channel::M1_POSITION, "counts");

pub fn duty_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let head = (
        "Duty",
        "Mode 3, serial open loop. The unit changes the duty by VELOCITYLIMIT in each TIMER.",
        ArmScope::Pwm,
    );
    drive_ui(ui, model, head, commands, |ui, model| {
        let held = motor_ui(ui, model, Motor::M1, &DUTY, |ui, model| {
            let slider =
                Setpoint { name: "Motor duty", unit: "%", range: -100.0..=100.0, decimals: 1, step: 0.1 };
            let mut duty = model.front.pwm.setpoints.values[0];
            let moved = slider.ui(ui, &mut duty);
            if ui.is_enabled() {
                model.front.pwm.setpoints.hold(Motor::M1, moved.held);
                if moved.changed {
                    model.front.pwm.set_duty(Motor::M1, duty);
                }
            }
        });
        model.front.pwm.jog(Motor::M1, held);
        options_ui(ui, |ui| {
            on_release_ui(ui, &mut model.front.pwm.setpoints);
            ui.separator();
            let jog = number("Jog duty", "%", 0.0..=100.0, 1.0);
            pace_ui(ui, "Jog", "The duty while a jog button is held", &jog, &mut model.front.pwm.jog_percent);
            ui.weak("For velocity and positions set the switches to mode 4.");
        });
    });
}

pub fn velocity_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let head = (
        "Velocity",
        "Mode 4, serial PID: the unit holds a velocity in whole counts per loop of 5 ms.",
        ArmScope::Velocity,
    );
    drive_ui(ui, model, head, commands, |ui, model| {
        let held = motor_ui(ui, model, Motor::M1, &VELOCITY, |ui, model| {
            let top = model.front.mind().reach.top_counts_per_loop;
            let slider =
                Setpoint { name: "Motor velocity", unit: "", range: -top..=top, decimals: 0, step: 1.0 };
            let mut asked = model.front.velocity.setpoints.values[0];
            let moved = slider.ui(ui, &mut asked);
            if ui.is_enabled() {
                model.front.velocity.setpoints.hold(Motor::M1, moved.held);
                if moved.changed {
                    model.front.ask_velocity(asked);
                }
            }
        });
        model.front.jog_velocity(held);
        options_ui(ui, |ui| {
            on_release_ui(ui, &mut model.front.velocity.setpoints);
            ui.separator();
            let reach = &mut model.front.mind_mut().reach;
            let jog = number("Jog velocity", "counts/loop", VELOCITY_RANGE, 1.0);
            pace_ui(
                ui,
                "Jog",
                "The velocity while a jog button is held",
                &jog,
                &mut reach.jog_counts_per_loop,
            );
            let top = number("Slider end", "counts/loop", VELOCITY_RANGE, 1.0);
            pace_ui(
                ui,
                "Slider to",
                "How far the slider goes either way",
                &top,
                &mut reach.top_counts_per_loop,
            );
            let asked = model.front.velocity.setpoints.values[0];
            let text = MindMessage::Asked { per_loop: asked, per_s: asked * LOOPS_PER_S }.to_string();
            ui.weak(text);
        });
    });
}

pub fn position_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let note = match model.front.mode() {
        Some(5) => "Mode 5, analog PID with ADSERIAL: the unit goes to a count of its feedback and holds it.",
        _ if model.front.has_bit("FUNCTION2", "PULSEFB") => {
            "Mode 4, serial PID with pulse feedback: 0.217 µs for each count."
        }
        _ => "Mode 4, serial PID: the unit goes to a count of the encoder and holds it.",
    };
    drive_ui(ui, model, ("Position", note, ArmScope::Position), commands, position_controls_ui);
}

fn position_controls_ui(ui: &mut Ui, model: &mut Model) {
    // No velocity can be commanded on this screen, so its jog buttons step.
    let held = motor_ui(ui, model, Motor::M1, &POSITION, |ui, model| {
        let connection = &mut model.front;
        let (low, high) = connection.mind_travel();
        let seen = connection.seen(Motor::M1).counts;
        connection.position.setpoints.show(Motor::M1, seen);
        let slider = Setpoint { name: "Motor position", unit: "", range: low..=high, decimals: 0, step: 1.0 };
        let shown = connection.position.setpoints.values[0].clamp(low, high);
        let mut counts = shown;
        let moved = slider.ui(ui, &mut counts);
        if ui.is_enabled() {
            connection.position.setpoints.hold(Motor::M1, moved.held);
            if counts != shown {
                connection.ask_position(counts);
            }
        }
    });
    if let Some(Some(direction)) = model.front.position.setpoints.jog(Motor::M1, held) {
        step(model, direction.sign());
    }
    options_ui(ui, |ui| {
        on_release_ui(ui, &mut model.front.position.setpoints);
        ui.separator();
        let reach = &mut model.front.mind_mut().reach;
        let size = number("Step size", "counts", 1.0..=10_000_000.0, 10.0);
        pace_ui(ui, "Step", "What a step moves", &size, &mut reach.step_counts);
        steps_ui(ui, model);
        ui.separator();
        let span = number("Slider span", "counts", 10.0..=100_000_000.0, 100.0);
        let reach = &mut model.front.mind_mut().reach;
        pace_ui(ui, "Slider ±", "Where no virtual limit acts", &span, &mut reach.span_counts);
    });
}

/// The two buttons that move by one step.
fn steps_ui(ui: &mut Ui, model: &mut Model) {
    let armed = model.front.link.arming.is_armed_for(ArmScope::Position) && !model.front.is_guided();
    for (text, name, sign) in [("− Step", "Step backward", -1.0), ("Step +", "Step forward", 1.0)] {
        let response = ui.add_enabled(armed, Button::new(text));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, armed, name));
        if response.clicked() {
            step(model, sign);
        }
    }
}

/// Asks for a step, whose response the assistant records.
fn step(model: &mut Model, sign: f64) {
    let connection = &mut model.front;
    let seen = connection.seen(Motor::M1).counts;
    connection.ask_step(sign * connection.mind().reach.step_counts);
    let target = connection.position.setpoints.values[0];
    connection.mind_mut().steps.begin(seen, target);
}

fn number<'a>(name: &'a str, unit: &'a str, range: std::ops::RangeInclusive<f64>, step: f64) -> Numeric<'a> {
    Numeric { name, unit, range, decimals: 0, step, width: 108.0 }
}

/// What moves the motor in a mode that is not driven from here, and which mode to set.
pub fn motion_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    debug_assert_eq!(model.front.driven(), Driven::Nothing);
    title_ui(ui, "Motion", "What moves this motor, and how to move it from here.");
    let (what, how) = mode_text(model.front.mode());
    ui.add(Label::new(RichText::new(what).strong()).wrap());
    ui.add(Label::new(how).wrap());
    ui.horizontal_wrapped(|ui| {
        if model.front.mode() == Some(5) && ui.button("Show ADSERIAL").clicked() {
            model.front.mind_mut().register = 3;
            commands.push(Command::Show(Screen::GeneralSettings));
        }
        if ui.button("Show the inputs").clicked() {
            commands.push(Command::Show(Screen::Inputs));
        }
    });
    ui.add_space(6.0);
    graph_place_ui(ui, model, commands);
}

/// What a mode does, and what to do to drive from here. Switches 2 to 4 are the mode's bits, "off" being 1.
fn mode_text(mode: Option<u8>) -> (&'static str, &'static str) {
    const SET: &str = "To drive from here, switch the power off, set SW1 to mode 3 for a duty (MODE2 on, MODE1 off, MODE0 off) or to \
                       mode 4 for velocity and position (MODE2 off, MODE1 on, MODE0 on), and switch it on again.";
    match mode {
        None => ("The mode of this unit has not been read yet.", "It is read with the registers."),
        Some(0) => ("Mode 0, R/C: the pulses of a radio receiver move the motor.", SET),
        Some(1) => ("Mode 1, analog: the voltage at J4 P4 moves the motor.", SET),
        Some(2) => ("Mode 2, buttons: BTN_UP and BTN_DN change the motor's speed.", SET),
        Some(5) => (
            "Mode 5, analog PID: the voltage at J4 P4 is the position that is asked for.",
            "To give the position from here, set the bit ADSERIAL of FUNCTION on the Registers screen and write it.",
        ),
        Some(6) => (
            "Mode 6, factory restore: nothing moves the motor. Both limit inputs at ground bring back the factory's values.",
            SET,
        ),
        Some(_) => ("Mode 7, factory test: not for use.", SET),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_that_is_not_driven_says_what_moves_the_motor_and_what_to_set() {
        for mode in [0, 1, 2, 5, 6, 7] {
            let (what, how) = mode_text(Some(mode));
            assert!(what.contains(&format!("Mode {mode}")), "{what}");
            assert!(how.contains("here"), "{how}");
        }
    }
}
