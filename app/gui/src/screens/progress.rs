//! How far a job that moves motors is.

use egui::{Label, ProgressBar, Ui};

use crate::command::{Command, Commands, GuidedAction};
use crate::widgets::with_time_left;

/// How far a job is, with the button that ends it.
pub fn progress_ui(ui: &mut Ui, progress: Option<(f32, &str)>, commands: &mut Commands) {
    let (fraction, text) = progress.unwrap_or((0.0, "Another job moves the motors"));
    ui.add(ProgressBar::new(fraction).desired_width(180.0));
    if ui.button("Cancel").on_hover_text("Stops the motors").clicked() {
        commands.push(Command::Guided(GuidedAction::Cancel));
    }
    ui.add(Label::new(with_time_left(ui, "guided", fraction, text)).truncate());
}
