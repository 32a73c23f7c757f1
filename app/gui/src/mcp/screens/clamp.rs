//! The voltage clamp test (MCP manual 1.7.5): what it does, within what, how far it is, what it found.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Button, Grid, Label, Layout, ProgressBar, RichText, Role, ScrollArea, Ui, WidgetInfo, vec2};

use crate::command::{Command, Commands, GuidedAction};
use crate::family::Family;
use crate::mcp::messages::McpScreenMessage;
use crate::model::{GeneralView, Gravity, IndicatorState, LinkView};
use crate::screens::drive::{arm_ui, notices_ui};
use crate::screens::general::sheet_parts::indicator_ui;
use crate::widgets::numeric::Numeric;
use crate::widgets::with_time_left;
use brushwork_core::motion::clamp::Step;

const WHAT_IT_DOES: &str = "Runs the motor up to 25 % and slows it down quickly, then 5 % more each time up to 100 %, while \
    the main battery's voltage is watched. It stops where the voltage reaches the \
    limit, or where the controller has to brake the motor by itself. The motor must be free to turn \
    at full speed. MCP manual 1.7.5.";

pub fn clamp_ui(
    ui: &mut Ui,
    general: &mut GeneralView<'_>,
    (link, family): (&LinkView, &dyn Family),
    height: f32,
    commands: &mut Commands,
) {
    let size = vec2(ui.available_width(), height);
    ui.allocate_ui_with_layout(size, Layout::top_down(egui::Align::Min), |ui| {
        ui.set_min_height(height);
        ScrollArea::vertical().id_salt("clamp test").auto_shrink(false).show(ui, |ui| {
            ui.set_max_width(ui.available_width() - 12.0);
            ui.label(RichText::new("Voltage clamp test").size(16.0).strong());
            ui.add(Label::new(RichText::new(WHAT_IT_DOES).weak()).wrap());
            outputs_ui(ui, general);
            arm_ui(ui, ArmScope::ClampTest, link, family, commands);
            notices_ui(ui, link);
            ui.add_space(2.0);
            ui.add_enabled_ui(!general.clamp.job.is_running(), |ui| task_ui(ui, general));
            run_ui(ui, general, link, commands);
            if let Some(verdict) = &general.clamp.verdict {
                let state = match verdict.gravity {
                    Gravity::Note => IndicatorState::Ok,
                    Gravity::Warning => IndicatorState::Warning,
                    Gravity::Error => IndicatorState::Error,
                };
                indicator_ui(ui, state, &verdict.sentence);
            }
            steps_ui(ui, &general.clamp.steps);
        });
    });
}

/// Which outputs clamp; without one the test shows what happens without.
fn outputs_ui(ui: &mut Ui, general: &GeneralView<'_>) {
    let outputs = general.clamping_outputs();
    if outputs.is_empty() {
        let text =
            "No output has the action Over voltage, so nothing clamps the voltage but what is wired outside.";
        indicator_ui(ui, IndicatorState::Warning, text);
    } else {
        let names: Vec<String> = outputs.iter().map(|number| format!("DOUT{number}")).collect();
        indicator_ui(
            ui,
            IndicatorState::Ok,
            &McpScreenMessage::Clamps { outputs: names.join(", ") }.to_string(),
        );
    }
}

fn task_ui(ui: &mut Ui, general: &mut GeneralView<'_>) {
    let limit = general.clamp.limit(general.unit());
    let test = &mut general.clamp;
    ui.horizontal_wrapped(|ui| {
        for motor in Motor::BOTH {
            let radio = ui.radio_value(&mut test.motor, motor, motor.to_string());
            let name = McpScreenMessage::ClampTest { motor }.to_string();
            ui.ctx().accesskit_node_builder(radio.id, |node| node.set_label(name));
        }
        ui.separator();
        let mut volts = limit;
        ui.label("Limit");
        let field = Numeric::new("Clamp test limit", "V", 6.0..=90.0, (1, 0.5, 70.0));
        if field
            .ui(ui, &mut volts)
            .on_hover_text("The test stops where the main battery reaches it")
            .changed()
        {
            test.limit_volts = Some(volts);
        }
        ui.label("Slow down");
        let field = Numeric::new("Clamp test deceleration", "%/s", 20.0..=2000.0, (0, 10.0, 80.0));
        field.ui(ui, &mut test.down_percent_per_s).on_hover_text(
            "How fast the duty comes down. Much faster brakes the motor in itself and gives less back",
        );
        ui.label("Run for");
        let field = Numeric::new("Clamp test hold", "s", 0.2..=10.0, (1, 0.1, 60.0));
        field
            .ui(ui, &mut test.hold_s)
            .on_hover_text("How long the motor runs at each speed before it is slowed");
    });
}

fn run_ui(ui: &mut Ui, general: &GeneralView<'_>, link: &LinkView, commands: &mut Commands) {
    ui.horizontal(|ui| {
        ui.set_min_height(30.0);
        if let Some((fraction, text)) = general.clamp.job.progress() {
            let cancel = ui.add(Button::new("Cancel").min_size(vec2(90.0, 28.0)));
            cancel.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Cancel clamp test"));
            if cancel.clicked() {
                commands.push(Command::Guided(GuidedAction::Cancel));
            }
            let volts = link.readings.get(Channel::MAIN_BATTERY).unwrap_or(f64::NAN);
            let text = with_time_left(ui, "clamp test", fraction, text);
            let bar = ProgressBar::new(fraction).desired_width(ui.available_width());
            let response =
                ui.add(bar.text(McpScreenMessage::WithBattery { text: text.clone(), volts }.to_string()));
            let spoken = McpScreenMessage::ClampProgress { text }.to_string();
            response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &spoken));
            return;
        }
        let armed = link.arming.is_armed_for(ArmScope::ClampTest) && !general.is_busy();
        let start = ui.add_enabled(armed, Button::new("Start clamp test").min_size(vec2(140.0, 28.0)));
        if start.on_disabled_hover_text("Arm this page first").clicked() {
            commands.push(Command::ClampTest);
        }
    });
}

fn steps_ui(ui: &mut Ui, steps: &[Step]) {
    if steps.is_empty() {
        return;
    }
    Grid::new("clamp steps").num_columns(5).spacing([28.0, 3.0]).show(ui, |ui| {
        for title in ["From", "Running", "Highest", "Rise", "Over-voltage"] {
            ui.weak(title);
        }
        ui.end_row();
        for step in steps {
            let rise = step.peak_volts - step.before_volts;
            let texts = [
                format!("{:.0} %", step.duty * 100.0),
                format!("{:.1} V", step.before_volts),
                format!("{:.1} V", step.peak_volts),
                format!("{rise:+.1} V{}", if step.is_over { ", limit" } else { "" }),
                format!("{:.0} ms{}", step.high_s * 1000.0, if step.is_braked() { ", braked" } else { "" }),
            ];
            for text in &texts {
                ui.label(RichText::new(text).text_style(crate::theme::figures()));
            }
            ui.end_row();
        }
    });
}
