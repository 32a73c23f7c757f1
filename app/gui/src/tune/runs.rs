//! The runs so far: which is looked at, which are drawn beneath it and in what colour, their gains and figures.

use egui::{Align, Color32, Grid, Label, Layout, RichText, Sense, Ui, vec2};

use super::{FIGURES, Loop, Run, figure_ui};
use crate::messages::NameMessage;
use crate::model::Model;
use crate::theme::Palette;
use crate::tune::messages::RunMessage;
use brushwork_core::tune::law::AnyRegisters;
use brushwork_tuning::registers::RegisterTable as _;

impl Run {
    /// Of its line beneath other runs.
    pub fn color(&self, palette: &Palette) -> Color32 {
        palette.traces[(5 + self.number) % palette.traces.len()]
    }
}

/// Heads and widths of the columns of figures, which fit beside the picture.
const COLUMNS: [(&str, f32); 7] = [
    ("level", 26.0),
    ("P", 42.0),
    ("I", 42.0),
    ("D", 42.0),
    ("over %", 38.0),
    ("settle ms", 48.0),
    ("Ms", 34.0),
];
/// Widths of what stands before them.
const NAME_WIDTH: f32 = 46.0;
const MARK_WIDTH: f32 = 14.0;
const GAP: f32 = 4.0;
const HEIGHT: f32 = 20.0;

pub fn runs_ui(ui: &mut Ui, model: &mut Model, which: Loop) {
    let palette = Palette::of(ui);
    let panel = model.front.tune.front_mut(which);
    if panel.runs.len() < 2 {
        return;
    }
    ui.add_space(6.0);
    ui.strong("Runs so far");
    let mut chosen = panel.chosen;
    Grid::new("tune runs").striped(true).spacing(vec2(GAP, 2.0)).show(ui, |ui| {
        heads_ui(ui);
        for (index, run) in panel.runs.iter_mut().enumerate() {
            let name = ui.add_sized(
                vec2(NAME_WIDTH, HEIGHT),
                egui::Button::selectable(
                    index == chosen,
                    NameMessage::Run { number: run.number }.to_string(),
                ),
            );
            if name.on_hover_text(described(run)).clicked() {
                chosen = index;
            }
            overlay_ui(ui, run, index == chosen, palette);
            run_row_ui(ui, run);
            ui.end_row();
        }
    });
    panel.chosen = chosen;
}

fn heads_ui(ui: &mut Ui) {
    let word = |text: &str| Label::new(RichText::new(text).small().weak());
    ui.add(word("run"));
    ui.add(word("drawn"));
    for (head, width) in COLUMNS {
        let size = vec2(width, 14.0);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            ui.set_min_width(width);
            ui.add(word(head));
        });
    }
    ui.end_row();
}

/// The box that draws a run beneath the one that is looked at, with the colour of its line.
fn overlay_ui(ui: &mut Ui, run: &mut Run, is_chosen: bool, palette: &Palette) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        let drawn = ui.add_enabled(!is_chosen && run.shown.is_some(), egui::Checkbox::without_text(&mut run.is_overlaid));
        ui.ctx().accesskit_node_builder(drawn.id, |node| node.set_label(RunMessage::Draw { number: run.number }.to_string()));
        drawn.on_hover_text("Draws what it promises beneath the run that is looked at: step, load, Bode, Nyquist, sensitivity");
        let (place, _) = ui.allocate_exact_size(vec2(MARK_WIDTH, HEIGHT), Sense::hover());
        if run.is_overlaid && !is_chosen && run.shown.is_some() {
            let color = run.color(palette);
            for n in 0..3 {
                let x = place.left() + 2.0 + 5.0 * n as f32;
                ui.painter().circle_filled(egui::pos2(x, place.center().y), 1.6, color);
            }
        }
    });
}

fn run_row_ui(ui: &mut Ui, run: &Run) {
    let Some(shown) = &run.shown else {
        ui.label(run.report.causes.first().map_or("no gains", |_| "refused"));
        return;
    };
    let mut cells = vec![format!("{:.0}", run.level)];
    // The first three that there are: P, I and D of the outer loop.
    let terms = AnyRegisters::fields()
        .into_iter()
        .filter(|field| field.is_term() && shown.registers.raw(field.key).is_some())
        .take(3);
    cells.extend(terms.map(|field| {
        let value = shown.registers.value(field).unwrap_or_default();
        short(value, field.decimals)
    }));
    cells.extend([FIGURES[0], FIGURES[1], FIGURES[3]].map(|(_, _, figure)| figure(shown)));
    for (text, (_, width)) in cells.iter().zip(COLUMNS) {
        // The unit stands in the head.
        let figure = text.trim_end_matches(" %").trim_end_matches(" ms");
        figure_ui(ui, figure, width).on_hover_text(text);
    }
}

/// Four digits or so.
fn short(value: f64, decimals: usize) -> String {
    let most = if value.abs() >= 100.0 {
        0
    } else if value.abs() >= 10.0 {
        1
    } else {
        2
    };
    format!("{value:.*}", decimals.min(most))
}

/// What a pointer over its name tells.
fn described(run: &Run) -> String {
    let report = &run.report;
    let mut text = RunMessage::Level { level: run.level, seconds: report.seconds.1 }.to_string();
    if let Some(cause) = report.causes.first() {
        text = format!("{text}\n{}", cause.sentence());
    }
    if run.shown.is_some() && !run.is_as_proposed() {
        text += "\nWith gains that were considered after the run.";
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_fit_into_their_column() {
        let texts = [(0.13968, 4), (2.64, 4), (26.41, 3), (684.41, 3), (12_345.6, 3), (3.0, 0)];
        let reported = texts.map(|(value, decimals)| short(value, decimals));
        assert_eq!(reported, ["0.14", "2.64", "26.4", "684", "12346", "3"]);
    }
}
