//! What is done with the macro file in the editor and the macros on the board: stored, read back, compared, run.

use brushwork_link::device::{ArmScope, Request};
use brushwork_script::language::Language;
use brushwork_suprmotr_macros::MACROS;
use egui::{Button, ComboBox, Context, Label, RichText, Role, Ui, WidgetInfo};

use super::super::model::board::{Board, Job, Outcome};
use crate::family_action::Host;
use crate::frame::FRAME_INTERVAL;
use crate::model::{ConnectionId, Model};
use crate::suprmotr::messages::MacrosMessage;
use crate::theme::Palette;
use crate::widgets::choice_ui;

/// As a file of macros is called that was never saved.
const UNTITLED: &str = "board.macros";
/// What a new one begins with.
const NEW: &str = "# Macros of a SuprMotr. A macro has 15 commands at most; macro 0 runs at power-up.\n\nmacro home = 1\n    GH, WS 100\n";

/// Draws what stands behind the arm switch of the editor.
pub fn run_ui(ui: &mut Ui, model: &mut Model) {
    let is_armed = model.front.link.arming.is_armed_for(ArmScope::Script);
    let is_linked = model.is_connected();
    let document = model.mcl.front();
    let is_file = document.language() == Language::Brought(&MACROS);
    if !is_file && button_ui(ui, "New macros", ("New macro file", "Begins a file of macros"), true) {
        model.mcl.open_named(UNTITLED, NEW);
        return;
    }
    let (id, revision, text) = (document.id(), document.text.revision(), || document.text.text());
    let board = &mut model.front.suprmotr_mut().board;
    let is_free = is_linked && !board.is_busy();
    let read = ("Read macros from the board", "Lists the macros of the board (TM) and opens them as a file");
    if button_ui(ui, "Read", read, is_free) {
        board.begin(Job::Read);
    }
    if is_file {
        let checked = board.checked(id, revision, text);
        let is_right = checked.is_right();
        let names: Vec<(u8, String)> =
            checked.macros.iter().map(|known| (known.number, known.name.clone())).collect();
        store_ui(ui, board, (is_right, is_free), &names);
        call_ui(ui, board, (is_right && is_free, is_armed), &names);
        simulated_ui(ui, board, is_right && !names.is_empty());
    }
    state_ui(ui, board, is_linked, is_armed);
    // The command that has just begun is marked as where a program halts.
    let at = board.steps().and_then(|(_, at)| at);
    let document = model.mcl.front_mut();
    let line = at.map(|at| document.text.line_of(at));
    if is_file {
        document.show_halt(line);
    }
}

fn store_ui(ui: &mut Ui, board: &mut Board, (is_right, is_free): (bool, bool), names: &[(u8, String)]) {
    let has_autostart = names.iter().any(|(number, _)| *number == 0);
    if has_autostart {
        let hint = "Macro 0 runs by itself at each power-up and reset, and may move the motor at once. Tick this to store it";
        ui.checkbox(&mut board.accepts_autostart, "Autostart").on_hover_text(hint);
    }
    let can = is_free && is_right && !names.is_empty() && (!has_autostart || board.accepts_autostart);
    let why = match (is_right, has_autostart && !board.accepts_autostart) {
        (false, _) => "The file has errors: see Problems",
        (true, true) => "Macro 0 runs at each power-up: tick Autostart to store it",
        (true, false) => "Stores the macros of the file (MD) and reads each back; it runs none",
    };
    if button_ui(ui, "Store", ("Store macros on the board", why), can) {
        board.begin(Job::Store);
    }
    let compare = ("Compare macros with the board", "Tells what the board and the file have otherwise");
    if button_ui(ui, "Compare", compare, is_free && is_right) {
        board.begin(Job::Compare);
    }
}

fn call_ui(ui: &mut Ui, board: &mut Board, (can, is_armed): (bool, bool), names: &[(u8, String)]) {
    let Some(first) = names.first() else { return };
    if !names.iter().any(|(number, _)| *number == board.chosen) {
        board.chosen = first.0;
    }
    let title = |number: u8| {
        let named = names.iter().find(|(known, _)| *known == number);
        let name = named.map(|(_, name)| name.clone()).unwrap_or_default();
        MacrosMessage::Entry { number, name }.to_string()
    };
    let list = ComboBox::from_id_salt("macro to run").width(110.0);
    choice_ui(ui, list, "Macro to run", &mut board.chosen, names.iter().map(|(number, _)| *number), title);
    let hint = if is_armed {
        "Calls the macro of this number as the board has it (MC). Keep clear; Esc stops"
    } else {
        "Arm first: a macro can move the motor"
    };
    if button_ui(ui, "Run", ("Run macro", hint), can && is_armed) {
        board.begin(Job::Run(board.chosen));
    }
}

/// A macro command by command on a simulated board: nothing goes over the wire.
fn simulated_ui(ui: &mut Ui, board: &mut Board, is_right: bool) {
    let hint = "Carries out one command of the chosen macro on a simulated board of this window, and marks the next one";
    let is_stepping = board.steps().is_some();
    if button_ui(ui, "Step", ("Step through the macro in the simulator", hint), is_right) {
        match is_stepping && board.can_step() {
            true => board.step(),
            false => board.begin_steps(board.chosen),
        }
    }
    let end = (
        "End the simulated steps",
        "The next step begins the macro again, on a board as it comes from the factory",
    );
    if is_stepping && button_ui(ui, "End", end, true) {
        board.end_steps();
    }
}

fn state_ui(ui: &mut Ui, board: &Board, is_linked: bool, is_armed: bool) {
    let text = match board.progress() {
        Some(progress) => progress,
        None if board.steps().is_some() => board.steps().map(|(told, _)| told.to_owned()).unwrap_or_default(),
        None if !is_linked => "Not connected. Macros can be written and checked.".to_owned(),
        None if is_armed => "Run calls what the board has, not what stands here.".to_owned(),
        None => "Nothing here runs a macro but Run, when armed.".to_owned(),
    };
    let palette = Palette::of(ui);
    let color = if is_armed { palette.text } else { palette.weak_text };
    ui.add(Label::new(RichText::new(&text).color(color)).truncate()).on_hover_text(text);
}

fn button_ui(ui: &mut Ui, text: &str, (name, hint): (&str, &str), can: bool) -> bool {
    let response = ui.add_enabled(can, Button::new(text));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, can, name));
    response.on_hover_text(hint).on_disabled_hover_text(hint).clicked()
}

/// Goes on with what is under way with the macros of a board, in front or not.
pub fn look_after_macros(host: &mut dyn Host, id: ConnectionId, ctx: &Context) {
    let Some(connection) = host.model().connection_mut(id) else { return };
    let identity = connection.link.identity().cloned();
    let is_linked = connection.is_connected();
    let board = &mut connection.suprmotr_mut().board;
    let request: Option<Request> = identity.filter(|_| is_linked).and_then(|unit| board.next(&unit));
    let outcome = board.take_outcome();
    if board.is_busy() {
        ctx.request_repaint_after(FRAME_INTERVAL);
    }
    if let Some(request) = request
        && !host.request_of(id, request)
        && let Some(connection) = host.model().connection_mut(id)
    {
        connection.suprmotr_mut().board.not_sent();
    }
    match outcome {
        None => {}
        Some(Outcome::Done(text)) => host.model().messages.note(MacrosMessage::Said { text }),
        Some(Outcome::Failed(text)) => host.model().messages.fail(MacrosMessage::Said { text }),
        Some(Outcome::File(file, text)) => {
            host.model().mcl.open_named(UNTITLED, &file);
            host.model().messages.note(MacrosMessage::Said { text });
        }
    }
}
