//! The arm switch and what the script does: starting a script can move motors, so it needs arming like any other motion.

use brushwork_link::device::ArmScope;
use brushwork_plant::world::ScriptRun;
use brushwork_script::language::Language;
use egui::{Label, ProgressBar, RichText, Ui};

use crate::command::{Command, Commands};
use crate::debugger::DebugAction;
use crate::family::Ability;
use crate::keys::as_written;
use crate::model::messages::ScriptStateMessage;
use crate::model::{Arming, IndicatorState, Model};
use crate::screens::face;
use crate::screens::stream::stream_ui;
use crate::theme::Palette;
use crate::widgets::arm_switch::arm_switch_ui;
use crate::widgets::with_time_left;

/// The switch with a line of what can happen, or how far a download is.
pub fn runbar_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.debug.takes_mecc {
        return board_ui(ui, model, commands);
    }
    let link = &model.front.link;
    let armed = link.arming.is_armed_for(ArmScope::Script);
    let waiting = matches!(link.arming, Arming::Asked(_));
    ui.add_enabled_ui(model.is_connected(), |ui| {
        if arm_switch_ui(ui, armed, waiting).clicked() {
            commands.push(if armed { Command::Disarm } else { Command::Arm(ArmScope::Script) });
        }
    });
    if face::of(model.front.family()).run_ui(ui, model, commands) {
        return;
    }
    if let Some((fraction, text)) = model.front.script.job.progress() {
        ui.add(ProgressBar::new(fraction).desired_width(120.0));
        if ui.button("Cancel download").clicked() {
            commands.push(Command::CancelDownload);
        }
        ui.add(Label::new(with_time_left(ui, "download", fraction, text)).truncate());
        return;
    }
    let palette = Palette::of(ui);
    let text = reported(model, armed);
    let color = if armed { palette.text } else { palette.weak_text };
    ui.add(Label::new(RichText::new(&text).color(color)).truncate()).on_hover_text(text);
}

/// A simulated board whose programs are put into its memory past the wire: nothing is armed for that.
fn board_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    if model.mcl.front().language() == Language::Mecc {
        let hint = "Puts the program in front into the simulated board's memory and starts it (Ctrl+F5)";
        if ui.button("Run Program").on_hover_text(as_written(ui.ctx(), hint)).clicked() {
            commands.push(Command::Debug(DebugAction::Run));
        }
    }
    let hint = "Lets the board run the program again through which the window drives it";
    if ui.button("Run Host Library").on_hover_text(hint).clicked() {
        commands.push(Command::RunLibrary);
    }
    let text = match running(model) {
        text if text.is_empty() => {
            "The board runs what is put into its memory here, beside its line.".to_owned()
        }
        text => text,
    };
    ui.add(Label::new(RichText::new(&text).weak()).truncate()).on_hover_text(text);
}

/// What stands in the way of arming, and what to mind while armed.
pub fn reasons_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let link = &model.front.link;
    let has_streams = model.front.family().lacks(Ability::Streams).is_none();
    if model.is_connected() && link.stream.is_none() && has_streams {
        stream_ui(ui, "port.", commands);
    }
    for refusal in &link.refusals {
        IndicatorState::Error.line_ui(ui, &refusal.to_string());
    }
    if link.arming.is_armed_for(ArmScope::Script) {
        link.warnings.iter().for_each(|warning| IndicatorState::Warning.line_ui(ui, warning));
    }
}

/// What the script does, as far as that is known, and what can happen.
fn reported(model: &Model, armed: bool) -> String {
    let front = &model.front;
    if !model.is_connected() {
        return "Not connected. Programs can be written and checked; running them needs a controller."
            .to_owned();
    }
    let runs = running(model);
    let can = match (armed, &front.script.on_board) {
        (true, _) => "Start Script runs the program, which can move motors. Keep clear; Esc stops.",
        (false, None) => "Download sends the program in front to the controller; it does not start it.",
        (false, Some(_)) => "Arm to start the script: it can move motors.",
    };
    format!("{runs}{can}")
}

/// What the script does, as a sentence and a space; nothing where nobody knows.
fn running(model: &Model) -> String {
    let front = &model.front;
    let view = front.worlds.as_ref().and_then(|views| views.get(front.world_unit)?.script.clone());
    match view.map(|view| view.run) {
        Some(ScriptRun::Running { line }) if front.script_is_paused() => {
            ScriptStateMessage::Held { line }.to_string()
        }
        Some(ScriptRun::Running { line }) => ScriptStateMessage::Runs { line }.to_string(),
        Some(ScriptRun::Ended { line }) => ScriptStateMessage::Ended { line }.to_string(),
        Some(ScriptRun::Faulted { line, what }) => ScriptStateMessage::BrokeOff { line, what }.to_string(),
        Some(_) => String::new(),
        None if front.watch.script_runs == Some(true) => "A script was started. ".to_owned(),
        None => String::new(),
    }
}
