//! The call stack and the breakpoints.

use brushwork_script::debug::{Frame, one};
use egui::{DragValue, Label, RichText, Ui};

use super::action::DebugAction;
use super::state::Debugging;
use super::watches::remove_ui;
use crate::command::{Command, Commands};
use crate::debugger::messages::DebuggerMessage;
use crate::keys::as_written;
use crate::messages::NameMessage;
use crate::theme::Palette;
use crate::widgets::{heading_ui, text_field_ui};

pub fn stack_ui(ui: &mut Ui, debug: &mut Debugging, commands: &mut Commands) {
    heading_ui(ui, "Call stack");
    let frames = debug.view.as_ref().map(|view| view.frames.clone()).unwrap_or_default();
    if frames.is_empty() {
        ui.weak("No script has been started.");
    }
    for frame in &frames {
        let text = frame_text(debug, frame);
        let link = ui.add(egui::Button::new(RichText::new(&text).monospace()).frame(false).truncate());
        if link.on_hover_text("Shows the line").clicked() {
            commands.push(Command::Debug(DebugAction::ShowLine(frame.line)));
        }
    }
    ui.add_space(6.0);
    breakpoints_ui(ui, debug, commands);
}

/// "add a = 1, b = 2: line 12".
fn frame_text(debug: &Debugging, frame: &Frame) -> String {
    let line = frame.line;
    let Some(program) = debug.program() else { return DebuggerMessage::AtLine { line }.to_string() };
    let Some(arguments) = frame.arguments.as_ref().filter(|_| frame.entered_at > 0) else {
        let name = label_at(debug, frame.entered_at).unwrap_or("main program");
        let name = if frame.entered_at == 0 { "main program" } else { name };
        return DebuggerMessage::In { name: name.to_string(), line }.to_string();
    };
    let given = arguments.iter().map(|argument| {
        let Some(cell) = argument.cell else { return argument.value.to_string() };
        let variable = program.variables.iter().find(|variable| variable.memory.first == cell);
        let name = variable.map_or("?", |variable| variable.name.as_str());
        format!("{name} = {}", one(cell.kind, cell.kind.keep(argument.value), debug.show))
    });
    let given = given.collect::<Vec<_>>().join(", ");
    let name = label_at(debug, frame.entered_at).unwrap_or("subroutine");
    let name = if given.is_empty() { name.to_owned() } else { format!("{name} {given}") };
    DebuggerMessage::In { name, line }.to_string()
}

fn label_at(debug: &Debugging, at: u32) -> Option<&str> {
    let labels = &debug.program()?.labels;
    labels.iter().find(|(_, label)| *label == at).map(|(name, _)| name.as_str())
}

fn breakpoints_ui(ui: &mut Ui, debug: &mut Debugging, commands: &mut Commands) {
    ui.horizontal(|ui| {
        heading_ui(ui, "Breakpoints");
        if !debug.breakpoints.is_empty() && ui.small_button("Clear all").clicked() {
            commands.push(Command::Debug(DebugAction::ClearBreakpoints));
        }
    });
    if debug.breakpoints.is_empty() {
        ui.weak(as_written(ui.ctx(), "Click left of a line number, or press Ctrl+F8."));
    }
    let states = debug.view.as_ref().map(|view| view.breakpoints.clone()).unwrap_or_default();
    let mut gone = None;
    for (line, terms) in &mut debug.breakpoints {
        let state = states.iter().find(|state| state.wanted.line == *line);
        ui.horizontal(|ui| {
            if remove_ui(ui, &DebuggerMessage::RemoveBreakpoint { line: *line }.to_string()) {
                gone = Some(*line);
            }
            let mut on = !terms.disabled;
            if ui.checkbox(&mut on, NameMessage::Line { line: *line }.to_string()).changed() {
                terms.disabled = !on;
            }
            let reported = match state {
                Some(state) if state.line.is_none() => "no code from here on".to_owned(),
                Some(state) if state.line != Some(*line) => {
                    DebuggerMessage::Moved { line: state.line.unwrap_or_default(), hits: state.hits }
                        .to_string()
                }
                Some(state) => format!("{} ×", state.hits),
                None => String::new(),
            };
            if ui
                .add(Label::new(RichText::new(reported).weak()).sense(egui::Sense::click()).truncate())
                .clicked()
            {
                commands.push(Command::Debug(DebugAction::ShowLine(*line)));
            }
        });
        ui.horizontal(|ui| {
            ui.add_space(22.0);
            let from = DragValue::new(&mut terms.from_hit).range(1..=1_000_000).prefix("from hit ");
            let response = ui.add(from).on_hover_text("It stops from this time on that it is reached");
            let name = DebuggerMessage::FirstHit { line: *line }.to_string();
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
            let name = DebuggerMessage::Condition { line: *line }.to_string();
            text_field_ui(ui, &mut terms.condition, &name, "if, e.g. i > 3");
        });
        if let Some(why) = &terms.wrong {
            ui.add(Label::new(RichText::new(why).color(Palette::of(ui).error)).wrap());
        }
    }
    if let Some(line) = gone {
        commands.push(Command::Debug(DebugAction::RemoveBreakpoint(line)));
    }
}
