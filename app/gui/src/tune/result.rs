//! What a run has found: its verdict, the gains as current, proposed and change, what they promise, and the runs so far.

use brushwork_core::tune::law::{AnyRegisters, Report};
use brushwork_core::tune::words::gains_text;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use egui::{Button, Grid, Label, RichText, Ui, vec2};

use super::files::files_ui;
use super::winding::{unknown_ui, winding_ui};
use super::{FIGURES, Figures, Loop, Run, TuneAction, figure_ui, likely};
use crate::command::{Command, Commands};
use crate::family::Ability;
use crate::model::{IndicatorState, Model, Sheet};
use crate::theme::Palette;
use crate::tune::messages::RunMessage;
use crate::widgets::numeric::Numeric;
use brushwork_tuning::registers::{Form, RegisterField, RegisterTable as _};

pub fn result_ui(ui: &mut Ui, model: &mut Model, which: Loop, commands: &mut Commands) {
    let motor = model.front.tune.motor(which);
    let with_position = model
        .front
        .tune
        .front(which)
        .run()
        .is_some_and(|run| run.report.proposed.raw("position.p").is_some());
    let held = model.front.held_gains(motor, with_position);
    if let Some(run) = model.front.tune.front_mut(which).run_mut() {
        run.look_at_held(held);
    }
    if model.front.tune.front(which).run().is_none() {
        empty_ui(ui, model, which);
        return files_ui(ui, &mut model.front.tune, which, commands);
    }
    super::refusal::cleared_ui(ui, model, commands);
    let Some(run) = model.front.tune.front(which).run() else { return };
    if run.is_refused() {
        super::refusal::refusal_ui(ui, model, which, commands);
    } else {
        verdict_ui(ui, run);
        acts_ui(ui, model, which, commands);
        ui.spacing_mut().interact_size.y = 20.0;
        figures_ui(ui, model, which);
        super::pace::pace_ui(ui, model, which);
        gains_ui(ui, model, which, held);
        rules_ui(ui, model, which);
        if let Some(run) = model.front.tune.front(which).run() {
            super::stood::stood_ui(ui, run, which);
        }
        model_ui(ui, model, which);
    }
    super::runs::runs_ui(ui, model, which);
    files_ui(ui, &mut model.front.tune, which, commands);
}

fn empty_ui(ui: &mut Ui, model: &Model, which: Loop) {
    let _palette = Palette::of(ui);
    let has_piv = model.front.family().methods(which).contains(&Method::Piv);
    let has_duty = model.front.family().lacks(Ability::Duty).is_none();
    let text = match which {
        Loop::Position if !has_duty => {
            "Not tuned yet.\n\n1. Choose the method. PID holds against a load; PD is the simplest.\n2. Say how far the axis may go: if it \
             has end stops, choose Within and give its travel.\n3. Arm this screen and press Tune."
        }
        Loop::Position if !has_piv => {
            "Not tuned yet.\n\n1. Choose the method. PID holds against a load; PD is the simplest.\n2. Say how far the axis may go: if it \
             has end stops, choose Within and give its travel.\n3. Arm this screen and press Tune.\n\nThere is one set of registers: gains for positions are \
             those of velocities too. Tune last what you use."
        }
        Loop::Velocity => {
            "Not tuned yet.\n\n1. Let the motor turn freely: lift the wheels, unhitch the load.\n2. Arm this screen and press Tune.\n\
             3. Look at what is proposed, move the level, and apply what you like."
        }
        Loop::Position => {
            "Not tuned yet.\n\n1. Choose the method. PIV holds best; PD is the simplest.\n2. Say how far the axis may go: if it has end \
             stops, choose Within and give its travel.\n3. Arm this screen and press Tune."
        }
    };
    ui.add_space(6.0);
    ui.add(Label::new(RichText::new(text).weak()).wrap());
    ui.add_space(6.0);
}

fn verdict_ui(ui: &mut Ui, run: &Run) {
    let report = &run.report;
    let (state, word) = match report.verdict {
        Verdict::Tuned => (IndicatorState::Ok, "Tuned"),
        Verdict::TunedWithWarnings => (IndicatorState::Warning, "Tuned with warnings"),
        Verdict::Refused => (IndicatorState::Error, "Refused"),
    };
    state.line_ui(
        ui,
        &RunMessage::Ended { verdict: word, number: run.number, seconds: report.seconds.1 }.to_string(),
    );
    for cause in &report.causes {
        IndicatorState::Warning.line_ui(ui, &cause.sentence());
    }
}

fn model_ui(ui: &mut Ui, model: &mut Model, which: Loop) {
    let Some(report) = model.front.tune.front(which).run().map(|run| &run.report) else { return };
    let (text, winding, unknown) = (model_text(report), report.winding, report.winding_unknown);
    let covered = feed_forward_text(model.front.tune.front(which).run());
    for text in text.into_iter().chain(covered) {
        ui.add_space(4.0);
        ui.add(Label::new(RichText::new(text).small().weak()).wrap());
    }
    match (winding, unknown) {
        (Some(winding), _) => winding_ui(ui, model, which, &winding),
        (None, Some(why)) => unknown_ui(ui, why),
        (None, None) => {}
    }
}

/// How much of a speed's duty the feed-forward gives: a register may be too small for all of it on most motors.
fn feed_forward_text(run: Option<&Run>) -> Option<String> {
    let run = run?;
    let given = run.shown.as_ref()?.registers.feed_forward(run.report.qpps?)?;
    let percent = 100.0 * given.share.min(1.0);
    let (register, raw) = (given.register, given.raw);
    let said = if percent < 99.5 {
        RunMessage::FeedForwardInPart { register, raw, percent }
    } else {
        RunMessage::FeedForward { register, raw, percent }
    };
    Some(said.to_string())
}

/// What was found of the motor, in one line.
fn model_text(report: &Report) -> Option<String> {
    let fit = report.fit?;
    let tau = fit.time_constant();
    let mut text = RunMessage::Model {
        qpps: report.qpps?,
        gain_interval_percent: 100.0 * report.free.map_or(2.0 * fit.sd_ln_gain, |free| free.interval),
        time_constant_ms: 1e3 * tau.seconds,
        time_interval_percent: 200.0 * tau.sd_ln,
        friction_percent: 100.0 * fit.model.coulomb_duty,
        friction_interval_percent: 200.0 * fit.sd_coulomb,
    }
    .to_string();
    if let Some(lag) = &report.lag {
        let (low, high) = (1e3 * lag.interval_s.0, 1e3 * lag.interval_s.1);
        text += &RunMessage::Lag { low, high }.to_string();
    }
    if let Some(slack) = report.backlash {
        text += &if slack.counts > 0.0 {
            RunMessage::Backlash { counts: slack.counts, interval: slack.interval_counts }.to_string()
        } else {
            ", no backlash seen".to_owned()
        };
    }
    Some(text)
}

/// Gains: current, proposed (to be edited), change.
fn gains_ui(ui: &mut Ui, model: &mut Model, which: Loop, held: Option<AnyRegisters>) {
    let tuning = &mut model.front.tune;
    let motor = tuning.motor(which);
    let Some(run) = tuning.front_mut(which).run_mut() else { return };
    let Some(mut wanted) = run.shown.as_ref().map(|shown| shown.registers) else { return };
    let before = wanted;
    ui.add_space(4.0);
    Grid::new("tune gains").striped(true).num_columns(4).spacing(vec2(12.0, 2.0)).show(ui, |ui| {
        heads_ui(ui, "", [("current", 84.0), ("proposed", 96.0), ("change", 72.0)]);
        ui.end_row();
        for field in AnyRegisters::fields() {
            let Some(value) = wanted.value(field) else { continue };
            let current = held.and_then(|held| held.value(field));
            if !field.is_modelled() && current == Some(value) {
                continue;
            }
            let label = ui.label(field.label);
            if !field.hint.is_empty() {
                label.on_hover_text(field.hint);
            }
            figure_ui(ui, &current.map_or_else(|| "–".to_owned(), |value| field.text(value)), 84.0);
            if let Some(value) =
                entry_ui(ui, field, &RunMessage::Proposed { motor, field: field.label }.to_string(), value)
            {
                wanted.set_value(field, value);
            }
            figure_ui(ui, &change_text(field, current, wanted.value(field)), 72.0);
            ui.end_row();
        }
    });
    if wanted != before {
        run.consider(wanted);
    }
}

/// Textbook rules on the same model, each to be considered, tried and applied like the run's own gains.
fn rules_ui(ui: &mut Ui, model: &mut Model, which: Loop) {
    let Some(run) = model.front.tune.front_mut(which).run_mut() else { return };
    if run.rules.is_empty() {
        return;
    }
    let shown = run.shown.as_ref().map(|shown| shown.registers);
    let mut wanted = None;
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.label("Rules").on_hover_text(
            "Gains of textbook rules on this run's model; nothing is sent until they are applied or verified",
        );
        for found in &run.rules {
            let is_shown = shown.is_some_and(|shown| shown.same_gains(&found.registers));
            let hint = if found.is_stable {
                RunMessage::Rule {
                    gains: gains_text(&found.design.gains),
                    ms: found.design.ms,
                    overshoot_percent: 100.0 * found.design.score.overshoot,
                }
                .to_string()
            } else {
                "Unstable on the model".to_owned()
            };
            if ui.selectable_label(is_shown, found.rule.name()).on_hover_text(hint).clicked() {
                wanted = Some(found.registers);
            }
        }
    });
    if let Some(registers) = wanted {
        run.consider(registers);
    }
}

/// The proposed value, to be changed by hand; the new one where it was.
fn entry_ui(ui: &mut Ui, field: &RegisterField, name: &str, value: f64) -> Option<f64> {
    const HINT: &str = "Edit it to see what it would do; nothing is sent until you apply it";
    if !field.is_modelled() {
        figure_ui(ui, &field.text(value), 96.0)
            .on_hover_text("The loop needs it so; the model has no other form");
        return None;
    }
    if field.form == Form::Switch {
        let mut set = value != 0.0;
        let size = vec2(96.0, ui.spacing().interact_size.y);
        let layout = egui::Layout::right_to_left(egui::Align::Center);
        let switch = ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_width(96.0);
            ui.checkbox(&mut set, field.text(value))
        });
        let switch = switch.inner.on_hover_text(HINT);
        ui.ctx().accesskit_node_builder(switch.id, |node| node.set_label(name));
        return switch.changed().then_some(f64::from(u8::from(set)));
    }
    let range = field.range.0..=field.range.1;
    let entry = Numeric { name, unit: "", range, decimals: field.decimals, step: field.step, width: 96.0 };
    let mut value = value;
    entry.ui(ui, &mut value).on_hover_text(HINT).changed().then_some(value)
}

fn change_text(field: &RegisterField, current: Option<f64>, wanted: Option<f64>) -> String {
    let (Some(current), Some(wanted)) = (current, wanted) else { return "–".to_owned() };
    if field.text(current) == field.text(wanted) {
        "same".to_owned()
    } else if field.form == Form::Switch {
        "changed".to_owned()
    } else if current == 0.0 || field.unit == "counts" || matches!(field.label, "PIDSCALAR" | "DEADBAND") {
        let change = wanted - current;
        // The ends of an axis without stops are longer than the column.
        if change.abs() < 1e6 {
            format!("{change:+.*}", field.decimals.min(2))
        } else {
            format!("{change:+.1e}")
        }
    } else {
        let percent = 100.0 * (wanted / current - 1.0);
        if percent.abs() < 1000.0 {
            format!("{percent:+.0} %")
        } else {
            format!("× {:.0}", wanted / current)
        }
    }
}

/// Words above columns of figures, at their right as those are.
fn heads_ui(ui: &mut Ui, first: &str, others: [(&str, f32); 3]) {
    let word = |text: &str| Label::new(RichText::new(text).small().weak());
    ui.add(word(first));
    for (text, width) in others {
        let size = vec2(width, 14.0);
        ui.allocate_ui_with_layout(size, egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.set_min_width(width);
            ui.add(word(text));
        });
    }
}

fn acts_ui(ui: &mut Ui, model: &mut Model, which: Loop, commands: &mut Commands) {
    let is_armed = model.front.link.arming.is_armed_for(which.scope());
    let is_free = !model.front.is_guided() && !model.front.settings.is_busy() && model.front.is_connected();
    let panel = model.front.tune.front_mut(which);
    let can_undo = panel.undo.is_some();
    let Some(run) = panel.run_mut() else { return };
    let has_gains = run.shown.is_some();
    let differs = match (run.looked_at, &run.shown) {
        (Some(held), Some(shown)) => !held.same_gains(&shown.registers),
        _ => true,
    };
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        let apply = ui.add_enabled(is_free && has_gains && differs, Button::new("Apply (RAM)"));
        if apply
            .on_hover_text("Writes the proposed gains into the controller's RAM and reads them back")
            .clicked()
        {
            commands.push(Command::Tune(TuneAction::Apply));
        }
        let verify = ui.add_enabled(is_free && is_armed && has_gains, Button::new("Verify"));
        let verify = verify.on_disabled_hover_text("Arm this screen first");
        if verify
            .on_hover_text("Moves the motor with the proposed gains and compares it with the prediction")
            .clicked()
        {
            commands.push(Command::Tune(TuneAction::Verify));
        }
        let save = ui.add_enabled(is_free, Button::new("Save…"));
        if save.on_hover_text("Shows what is not in EEPROM yet and saves it there").clicked() {
            commands.push(Command::OpenSheet(Sheet::Save));
        }
        let undo = ui.add_enabled(is_free && can_undo, Button::new("Undo"));
        if undo.on_hover_text("Writes back what RAM held before the gains were applied").clicked() {
            commands.push(Command::Tune(TuneAction::Undo));
        }
        let reset = ui.add_enabled(!run.is_as_proposed(), Button::new("As proposed"));
        if reset.on_hover_text("Back to the gains and the level of the run").clicked() {
            run.reset();
        }
    });
    if !run.is_as_proposed() {
        let text = RunMessage::Considered { level: run.level }.to_string();
        ui.label(RichText::new(text).small().color(Palette::of(ui).accent));
    }
    match run.verified {
        Some(Ok(())) => IndicatorState::Ok.line_ui(ui, "Verified: the machine behaves as predicted."),
        Some(Err(cause)) => IndicatorState::Warning.line_ui(ui, &cause.sentence()),
        None => {}
    }
}

/// What the gains promise, and what was measured.
fn figures_ui(ui: &mut Ui, model: &Model, which: Loop) {
    let Some(run) = model.front.tune.front(which).run() else { return };
    let Some(shown) = &run.shown else { return };
    ui.add_space(4.0);
    Grid::new("tune figures").striped(true).num_columns(4).spacing(vec2(12.0, 2.0)).show(ui, |ui| {
        heads_ui(ui, "predicted", [("current", 84.0), ("proposed", 96.0), ("measured", 72.0)]);
        ui.end_row();
        for (name, hint, figure) in FIGURES {
            ui.label(name).on_hover_text(hint);
            figure_ui(ui, &run.current().map_or_else(|| "–".to_owned(), figure), 84.0);
            let proposed = figure_ui(ui, &figure(shown), 96.0);
            if let Some(likely) = likely(shown, name) {
                proposed.on_hover_text(likely);
            }
            let (measured, promised) = measured(run, name);
            let response = figure_ui(ui, &measured, 72.0);
            if let Some(promised) = promised {
                response.on_hover_text(RunMessage::Promised { promised }.to_string());
            }
            ui.end_row();
        }
    });
    if !shown.forecast.is_stable {
        IndicatorState::Error
            .line_ui(ui, "Unstable on the model: the motor would oscillate ever more. Lower the gains.");
    } else if shown.forecast.ms > 2.0 {
        IndicatorState::Warning.line_ui(ui, "Ms above 2: a little more load or lag could make it oscillate.");
    }
    super::limits::limits_ui(ui, run);
}

/// A figure as measured, and what the model gives for the same moves.
fn measured(run: &Run, name: &str) -> (String, Option<String>) {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let time = |figures: &Figures| {
        figures.settling_s.map_or_else(|| "never".to_owned(), |s| format!("{:.0} ms", 1e3 * s))
    };
    let Some(tried) = &run.tried else { return ("–".to_owned(), None) };
    let (measured, promised) = match name {
        "Overshoot" => {
            let of = |figures: Option<Figures>| figures.map(|figures| percent(figures.overshoot));
            (of(tried.figures), of(tried.promised))
        }
        "Settling" => (tried.figures.as_ref().map(time), tried.promised.as_ref().map(time)),
        "Duty noise" => (tried.duty_rms.map(|rms| format!("{:.2} %", 100.0 * rms)), None),
        _ => (None, None),
    };
    (measured.unwrap_or_else(|| "–".to_owned()), promised)
}
