//! Draws the sheet: the small window in which the editor asks for a path, a line, a name, or whether to save.

use egui::{Align2, Context, Key, Modifiers, Rect, Ui, Window, vec2};

use super::saving::{mcl_files, pdf_files};
use super::sheet::PathField;
use super::{Editor, MclAction, Sheet};
use crate::files::FileKind;
use crate::mcl::messages::PanelMessage;
use crate::widgets::text_field::text_field_ui;

const WIDTH: f32 = 460.0;

/// Draws it within `room`, if there is one.
pub fn ask_ui(ctx: &Context, editor: &mut Editor, room: Rect, actions: &mut Vec<MclAction>) {
    let is_new = std::mem::take(&mut editor.sheet_is_new);
    let titles: Vec<String> = match &editor.sheet {
        Some(Sheet::Close { ids }) => {
            ids.iter().filter_map(|id| editor.document(*id)).map(super::Document::title).collect()
        }
        _ => Vec::new(),
    };
    let Some(sheet) = &mut editor.sheet else { return };
    let window = Window::new(title(sheet)).collapsible(false).resizable(false).constrain_to(room);
    let window = window.pivot(Align2::CENTER_TOP).default_pos(room.center_top() + vec2(0.0, 40.0));
    window.show(ctx, |ui| {
        ui.set_width(WIDTH.min(room.width() - 40.0));
        sheet_ui(ui, sheet, &titles, is_new, actions);
    });
    ctx.input_mut(|input| {
        if input.key_pressed(Key::Escape) {
            actions.push(MclAction::DismissSheet);
        } else if input.consume_key(Modifiers::NONE, Key::Enter) {
            actions.push(MclAction::AcceptSheet);
        }
    });
}

fn title(sheet: &Sheet) -> &'static str {
    match sheet {
        Sheet::Open(_) => "Open a program",
        Sheet::SaveAs { .. } => "Save the program as",
        Sheet::Print { .. } => "Print the program",
        Sheet::Image(_) => "Download the maker's image file",
        Sheet::GoToLine(_) => "Go to line",
        Sheet::Rename(_) => "Rename",
        Sheet::Close { .. } => "Save before closing?",
    }
}

fn sheet_ui(ui: &mut Ui, sheet: &mut Sheet, titles: &[String], is_new: bool, actions: &mut Vec<MclAction>) {
    let accept = match sheet {
        Sheet::Open(field) => {
            path_ui(ui, field, (false, mcl_files()), is_new);
            "Open"
        }
        Sheet::SaveAs { field, .. } => {
            path_ui(ui, field, (true, mcl_files()), is_new);
            "Save"
        }
        Sheet::Print { field, printer, spooler, .. } => {
            print_ui(ui, printer, spooler.is_some(), actions);
            path_ui(ui, field, (true, pdf_files()), is_new);
            "Print to the file"
        }
        Sheet::Image(field) => {
            ui.label(IMAGE);
            let kind = FileKind { title: "Compiled script".to_owned(), extension: "bin,mcb,img".to_owned() };
            path_ui(ui, field, (false, kind), is_new);
            "Download"
        }
        Sheet::GoToLine(text) => {
            focus(&text_field_ui(ui, text, "Line number", "Line number"), is_new);
            "Go"
        }
        Sheet::Rename(text) => {
            focus(&text_field_ui(ui, text, "New name", "New name"), is_new);
            "Rename"
        }
        Sheet::Close { .. } => {
            ui.label(PanelMessage::Unsaved { titles: titles.join(", ") }.to_string());
            "Save and close"
        }
    };
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        let button = ui.button(accept);
        if is_new && matches!(sheet, Sheet::Close { .. }) {
            button.request_focus();
        }
        if button.clicked() {
            actions.push(MclAction::AcceptSheet);
        }
        if matches!(sheet, Sheet::Close { .. }) && ui.button("Close without saving").clicked() {
            actions.push(MclAction::CloseUnsaved);
        }
        if ui.button("Cancel").clicked() {
            actions.push(MclAction::DismissSheet);
        }
    });
}

/// To a printer, where the system has a command for it.
fn print_ui(ui: &mut Ui, printer: &mut String, can_print: bool, actions: &mut Vec<MclAction>) {
    ui.label("Pages with colours, line numbers and a head with name and page.");
    ui.add_space(4.0);
    if !can_print {
        ui.label(
            "This system has no print command (lp or lpr): print to a PDF file, and that with any viewer.",
        );
        return;
    }
    let name = text_field_ui(ui, printer, "Printer", "Printer: the one the system takes by itself");
    let is_entered = name.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if ui.button("Send to the printer").clicked() || is_entered {
        actions.push(MclAction::SendToPrinter);
    }
    ui.add_space(8.0);
    ui.label("Or to a PDF file:");
}

const IMAGE: &str = "A real controller runs byte code of its maker's compiler, whose form is not public, so Brushwork cannot \
                     compile for it. It can download an image file that the maker's program has compiled.";

fn path_ui(ui: &mut Ui, field: &mut PathField, (saves, kind): (bool, FileKind), is_new: bool) {
    focus(&text_field_ui(ui, &mut field.text, "Path", "Path of the file"), is_new);
    if ui.add_enabled(!field.is_waiting(), egui::Button::new("Browse…")).clicked() {
        field.browse(saves, kind);
    }
}

fn focus(response: &egui::Response, is_new: bool) {
    if is_new {
        response.request_focus();
    }
}
