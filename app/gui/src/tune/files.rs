//! Reports on the disk: the same files that `brushwork tune --report` writes and `brushwork tune replay` reads.

use std::path::{Path, PathBuf};

use brushwork_core::tune::law::Report;
use egui::{Button, Ui, vec2};

use super::{Asked, Loop, TuneAction, Tuning};
use crate::command::{Command, Commands};
use crate::files::{FileAction, FileAnswer, FileDialog, FileKind};
use crate::frame::FRAME_INTERVAL;
use crate::widgets::text_field::text_field_ui;

/// Which loop a report is of.
pub fn loop_of(report: &Report) -> Loop {
    match report.request.method {
        brushwork_tuning::tune::Method::Velocity => Loop::Velocity,
        brushwork_tuning::tune::Method::Pd
        | brushwork_tuning::tune::Method::Pid
        | brushwork_tuning::tune::Method::Piv => Loop::Position,
    }
}

/// The row that saves and opens.
pub fn files_ui(ui: &mut Ui, tuning: &mut Tuning, which: Loop, commands: &mut Commands) {
    answer(tuning, commands);
    ui.horizontal_wrapped(|ui| {
        ui.label("Report");
        let width = (ui.available_width() - 12.0).clamp(120.0, 240.0);
        ui.allocate_ui(vec2(width, ui.spacing().interact_size.y), |ui| {
            text_field_ui(ui, &mut tuning.path, "Report file", "Path of a .json or .html file");
        });
        let path = tuning.path.trim().to_owned();
        let has_run = tuning.front(which).run().is_some();
        let save = ui.add_enabled(has_run, Button::new("Save report"));
        let hint = "The run with its raw record, as `brushwork tune --report` writes it; as one page with plots where the name ends in .html; without a path it asks for one";
        if save.on_hover_text(hint).clicked() {
            if path.is_empty() {
                let name = format!("tuning-{}.json", tuning.motor(which));
                ask(tuning, FileAction::Save { name });
            } else {
                let path = with_extension(&path);
                commands.push(Command::Tune(TuneAction::SaveReport { path, replaces: false }));
            }
        }
        let open = ui.button("Open report");
        if open.on_hover_text("Shows a saved run here; without a path it asks for one").clicked() {
            if path.is_empty() {
                ask(tuning, FileAction::Open);
            } else {
                commands.push(Command::Tune(TuneAction::OpenReport(path.into())));
            }
        }
    });
    if tuning.dialog.is_some() {
        ui.request_repaint_after(FRAME_INTERVAL);
    }
}

fn with_extension(path: &str) -> PathBuf {
    if Path::new(path).extension().is_some() { path.into() } else { format!("{path}.json").into() }
}

fn ask(tuning: &mut Tuning, action: FileAction) {
    let saves = matches!(action, FileAction::Save { .. });
    let kind = FileKind { title: "Tuning report".to_owned(), extension: "json".to_owned() };
    tuning.dialog = Some(Asked { dialog: FileDialog::ask(action, kind), saves });
}

fn answer(tuning: &mut Tuning, commands: &mut Commands) {
    let Some(asked) = &tuning.dialog else { return };
    match asked.dialog.answer() {
        FileAnswer::Waiting => {}
        FileAnswer::None => tuning.dialog = None,
        FileAnswer::Chosen(path) => {
            let action = if asked.saves {
                TuneAction::SaveReport { path, replaces: true }
            } else {
                TuneAction::OpenReport(path)
            };
            commands.push(Command::Tune(action));
            tuning.dialog = None;
        }
    }
}
