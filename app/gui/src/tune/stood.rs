//! What change of its load the loop stands with the gains that are considered, on the model of the run.

use brushwork_tuning::load_change::{HEADS, LoadChange};
use egui::{Grid, Label, RichText, Ui, vec2};

use super::run::Run;
use super::{Loop, figure_ui};
use crate::tune::messages::RunMessage;

const HINT: &str = "The identified model with another inertia, under the gains that are considered. Springs and play are not in the model.";
const HELD: &str =
    "At the top speed of the trajectory above, with full duty. A heavier load slows the motor down.";
/// Widths of the columns of figures.
const WIDTHS: [f32; 4] = [44.0, 88.0, 72.0, 72.0];

pub fn stood_ui(ui: &mut Ui, run: &Run, which: Loop) {
    let Some(stood) = run.shown.as_ref().and_then(|shown| shown.stood(&run.report)) else { return };
    let text_ui = |ui: &mut Ui, said: &RunMessage, hint: &str| {
        ui.add(Label::new(RichText::new(said.to_string()).small()).wrap()).on_hover_text(hint);
    };
    let stable = stood.stable.text();
    let inertia = match stood.calm {
        Some(calm) => RunMessage::Inertia { calm: calm.text(), stable },
        None => RunMessage::InertiaStable { stable },
    };
    text_ui(ui, &inertia, HINT);
    if let Some(held) = stood.held {
        let (stall_percent, duty_percent) = (100.0 * held.share_of_stall, 100.0 * held.duty);
        let speed = held.speed_counts_per_s;
        let said = if held.offset == 0.0 {
            RunMessage::Held { stall_percent, duty_percent, speed }
        } else {
            let (behind, unit) = (held.offset, which.unit());
            RunMessage::HeldWithOffset { stall_percent, duty_percent, speed, behind, unit }
        };
        text_ui(ui, &said, HELD);
    }
    ui.collapsing("Other loads", |ui| table_ui(ui, stood)).header_response.on_hover_text(
        "The same step with another inertia, with other friction and against a steady load, on the model",
    );
}

fn table_ui(ui: &mut Ui, stood: &LoadChange) {
    Grid::new("tune other loads").striped(true).num_columns(5).spacing(vec2(8.0, 2.0)).show(ui, |ui| {
        ui.label("");
        for (head, width) in HEADS[1..].iter().zip(WIDTHS) {
            figure_ui(ui, head, width);
        }
        ui.end_row();
        for changed in &stood.changed {
            let [name, figures @ ..] = changed.cells();
            ui.label(name);
            for (figure, width) in figures.iter().zip(WIDTHS) {
                figure_ui(ui, figure, width);
            }
            ui.end_row();
        }
    });
}
