//! The row of buttons above the plot, and the line of text under it.

use std::time::Duration;

use brushwork_link::device::PollRate;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{ComboBox, PopupCloseBehavior, Response, RichText, ScrollArea, Ui};

use super::action::GraphAction;
use super::files::OpenAs;
use super::icons::{Icon, ROOM, icon_button_ui, put_icon};
use super::live::LiveGraph;
use super::picture::axes;
use super::plot::KEYS;
use super::runs::Align;
use super::sheet::SPANS_S;
use super::trigger::{Edge, TriggerMode, TriggerSettings, TriggerSource};
use crate::command::{Command, Commands};
use crate::graph::messages::GraphBarMessage;
use crate::theme::Palette;
use crate::widgets::{Numeric, choice_ui, text_field_ui};

/// Width of what opens under a button.
const MENU_WIDTH: f32 = 330.0;

/// Width from which every button has room for its words in one row.
const ALL_IN_WORDS: f32 = 840.0;

/// The buttons; `ui` lays them out side by side.
pub fn toolbar_ui(ui: &mut Ui, graph: &mut LiveGraph, poll: PollRate, commands: &mut Commands) {
    ui.spacing_mut().item_spacing.x = 4.0;
    ui.spacing_mut().button_padding.x = 6.0;
    let is_narrow = ui.available_width() < ALL_IN_WORDS;
    follow_ui(ui, graph);
    ui.separator();
    time_ui(ui, graph);
    ui.separator();
    button_ui(
        ui,
        graph,
        "Fit all",
        "Fits the scale of every shown channel to what is in view (F)",
        GraphAction::FitAll,
    );
    let on = graph.sheet().cursors.on;
    let cursors = icon_button_ui(ui, Icon::Cursors, "Cursors", "Cursors", on, 0.0);
    if cursors.on_hover_text("Two cursors with values and statistics between them (C)").clicked() {
        graph.act(GraphAction::ToggleCursors);
    }
    trigger_ui(ui, graph);
    record_ui(ui, graph, is_narrow);
    menu(ui, Icon::Menu, "More", |ui| more_ui(ui, graph));
    rate_ui(ui, poll, commands);
    place_ui(ui, graph);
}

/// How much of the window the graph has: one click for the whole screen, one for a window of its own.
fn place_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    if !graph.detached {
        let (icon, hint) = match graph.large {
            true => (Icon::Small, "Gives the screen its room again"),
            false => (Icon::Large, "Gives the graph the whole screen; the arm switch stays"),
        };
        let large = icon_button_ui(ui, icon, "", "Large graph", graph.large, 0.0);
        if large.on_hover_text(hint).clicked() {
            graph.act(GraphAction::ToggleLarge);
        }
    }
    let hint = match graph.detached {
        true => "Puts the graph back into its screen",
        false => "Puts the graph into a window of its own, which stays whatever the screen",
    };
    let title = GraphAction::ToggleDetached.title();
    if icon_button_ui(ui, Icon::Window, "", title, graph.detached, 0.0).on_hover_text(hint).clicked() {
        graph.act(GraphAction::ToggleDetached);
    }
}

/// What is going on, in one line that is always there.
pub fn status_ui(ui: &mut Ui, graph: &LiveGraph, poll: PollRate) {
    let palette = Palette::of(ui);
    ui.horizontal(|ui| {
        ui.set_min_height(16.0);
        let text = rate_text(graph, poll);
        ui.label(RichText::new(text).small().weak());
        let rest = [
            graph.sheet().trigger_state().map(str::to_owned),
            graph.files.recording_text().map(|text| GraphBarMessage::RecordingTo { what: text }.to_string()),
            graph.files.loading_text(),
        ];
        for text in rest.into_iter().flatten() {
            ui.label(RichText::new("·").small().weak());
            ui.add(egui::Label::new(RichText::new(text).small().color(palette.text)).truncate());
        }
    });
}

/// The rate that was asked for, the one that is reached, and what was late or lost.
fn rate_text(graph: &LiveGraph, poll: PollRate) -> String {
    let asked = match poll {
        PollRate::Off => "not read".to_owned(),
        PollRate::Every(time) => GraphBarMessage::Asked { hz: 1.0 / time.as_secs_f64() }.to_string(),
        PollRate::Fastest => "as fast as it goes".to_owned(),
    };
    let reached = graph.rate.reached_hz().map_or_else(|| "–".to_owned(), |hz| format!("{hz:.1}"));
    let mut text = GraphBarMessage::Rate { reached, asked }.to_string();
    for (count, word) in [(graph.rate.late, "late"), (graph.rate.lost, "lost")] {
        if count > 0 {
            text += &format!(" · {count} {word}");
        }
    }
    text
}

fn button_ui(ui: &mut Ui, graph: &mut LiveGraph, text: &str, hint: &str, action: GraphAction) -> Response {
    let response = ui.button(text).on_hover_text(hint);
    if response.clicked() {
        graph.act(action);
    }
    response
}

fn follow_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    let away = graph.sheet().is_held() || graph.opened.is_some();
    let (icon, text, hint, action) = match away {
        true => {
            (Icon::Play, "Back to live", "Follows the newest sample again (End)", GraphAction::BackToLive)
        }
        false => {
            let hint = "Holds the picture; sampling and recording go on (P)";
            (Icon::Pause, "Pause", hint, GraphAction::TogglePause)
        }
    };
    let response = icon_button_ui(ui, icon, text, text, away, 104.0);
    if response.on_hover_text(hint).clicked() {
        graph.act(action);
    }
}

fn time_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    let minus = button_ui(ui, graph, "−", "Shows more time (−, or the wheel)", GraphAction::ZoomOut);
    ui.ctx().accesskit_node_builder(minus.id, |node| node.set_label("Zoom out"));
    let mut span_s = graph.sheet().span_s();
    let list = ComboBox::from_id_salt("span").width(66.0).height(480.0);
    let response = choice_ui(ui, list, "Time in view", &mut span_s, SPANS_S, axes::span_text);
    if span_s != graph.sheet().span_s() {
        graph.sheet_mut().set_span_s(span_s);
    }
    response.on_hover_text("How much time is in view; 10 s has divisions of one second");
    let plus = button_ui(ui, graph, "+", "Shows less time (+, or the wheel)", GraphAction::ZoomIn);
    ui.ctx().accesskit_node_builder(plus.id, |node| node.set_label("Zoom in"));
}

/// A button that opens a small panel, which stays open while it is used.
fn menu(ui: &mut Ui, icon: Icon, label: &str, contents: impl FnOnce(&mut Ui)) {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let (response, _) = MenuButton::new(format!("{ROOM}{label}")).config(config).ui(ui, |ui| {
        ui.set_width(MENU_WIDTH);
        let height = (ui.ctx().content_rect().height() * 0.7).max(200.0);
        ScrollArea::vertical().max_height(height).show(ui, contents);
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(label));
    put_icon(ui, &response, icon);
}

fn trigger_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    let mode = graph.sheet().trigger.mode();
    menu(ui, Icon::Trigger, &GraphBarMessage::TriggerMode { mode: mode.word() }.to_string(), |ui| {
        ui.horizontal(|ui| {
            for each in TriggerMode::ALL {
                let hint = match each {
                    TriggerMode::Off => "The graph follows the newest sample",
                    TriggerMode::Auto => "Shows each time it happens; follows when nothing happens",
                    TriggerMode::Normal => "Shows the last time it happened",
                    TriggerMode::Single => "Shows the first time it happens and keeps that",
                };
                if ui.selectable_label(mode == each, each.word()).on_hover_text(hint).clicked() {
                    graph.act(GraphAction::Trigger(each));
                }
            }
        });
        trigger_settings_ui(ui, graph);
        ui.horizontal(|ui| {
            let again = "Waits for the next time (T)";
            button_ui(ui, graph, "Arm again", again, GraphAction::RearmTrigger);
            let next = "Goes to the next time in what was sampled already (N)";
            button_ui(ui, graph, "Find next", next, GraphAction::NextTrigger);
        });
        ui.label(graph.sheet().trigger_state().unwrap_or("The trigger is off"));
    });
}

fn trigger_settings_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    let sheet = graph.sheet_mut();
    let mut settings = *sheet.trigger.settings();
    let selected = sheet.selected;
    let label_of =
        |channel: usize| sheet.channels.get(channel).map_or_else(String::new, |c| c.info.label.clone());
    let (watched, decimals) = match settings.source {
        TriggerSource::Channel(channel) => {
            (channel, sheet.channels.get(channel).map_or(1, |c| c.info.decimals))
        }
        TriggerSource::Command => (selected, 1),
    };
    let unit = sheet.channels.get(watched).map_or_else(String::new, |c| c.info.unit.clone());
    ui.horizontal_wrapped(|ui| {
        ui.label("On");
        let on_channel = matches!(settings.source, TriggerSource::Channel(_));
        if ui.selectable_label(on_channel, label_of(watched)).clicked() {
            settings.source = TriggerSource::Channel(watched);
        }
        if watched != selected
            && ui
                .selectable_label(
                    false,
                    GraphBarMessage::Use { channel: label_of(selected).to_string() }.to_string(),
                )
                .clicked()
        {
            settings.source = TriggerSource::Channel(selected);
        }
        let command = ui.selectable_label(!on_channel, "A drive command");
        if command.on_hover_text("Whenever a motor is told to move").clicked() {
            settings.source = TriggerSource::Command;
        }
    });
    let is_channel = matches!(settings.source, TriggerSource::Channel(_));
    ui.add_enabled_ui(is_channel, |ui| {
        ui.horizontal(|ui| {
            for edge in Edge::ALL {
                ui.selectable_value(&mut settings.edge, edge, edge.word());
            }
        });
        let any = f64::NEG_INFINITY..=f64::INFINITY;
        let step = sheet.channels.get(watched).map_or(1.0, |channel| channel.scale.division() / 10.0);
        numeric_ui(ui, "Level", &unit, any, decimals, step, &mut settings.level);
        numeric_ui(ui, "Hysteresis", &unit, 0.0..=f64::INFINITY, decimals, step, &mut settings.hysteresis);
    });
    let mut percent = settings.pre * 100.0;
    numeric_ui(ui, "Before the trigger", "%", 0.0..=100.0, 0, 1.0, &mut percent);
    sheet.trigger.set(TriggerSettings { pre: percent / 100.0, ..settings });
}

fn numeric_ui(
    ui: &mut Ui,
    label: &str,
    unit: &str,
    range: std::ops::RangeInclusive<f64>,
    decimals: usize,
    step: f64,
    value: &mut f64,
) {
    ui.horizontal(|ui| {
        crate::widgets::label::fixed_label_ui(ui, label, 120.0);
        Numeric::new(
            &GraphBarMessage::TriggerField { field: label.to_lowercase() }.to_string(),
            unit,
            range,
            (decimals, step, 110.0),
        )
        .ui(ui, value);
    });
}

fn record_ui(ui: &mut Ui, graph: &mut LiveGraph, is_narrow: bool) {
    let recording = graph.files.is_recording();
    let (icon, text, hint, action) = match recording {
        true => (Icon::Stop, "Stop rec.", "Ends the recording", GraphAction::StopRecording),
        false => {
            let hint = "Records every reading to a new CSV file; More has a compact form";
            (Icon::Record, "Record", hint, GraphAction::RecordCsv)
        }
    };
    let (text, width) = if is_narrow { ("", 0.0) } else { (text, 92.0) };
    let response = icon_button_ui(ui, icon, text, action.title(), recording, width);
    if response.on_hover_text(hint).clicked() {
        graph.act(action);
    }
}

fn more_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    use GraphAction as A;
    // Where there are runs, they are what is compared, and are not looked for.
    if !graph.runs.is_empty() {
        runs_ui(ui, graph);
        ui.separator();
    }
    heading_ui(ui, "View");
    ui.horizontal_wrapped(|ui| {
        for (text, action) in [
            ("Whole history", A::ShowAll),
            ("Oldest", A::Oldest),
            ("Clear all", A::ClearAll),
            ("Show cleared", A::RestoreCleared),
            ("Mark now", A::AddNote),
        ] {
            button_ui(ui, graph, text, action.title(), action);
        }
        let list = if graph.legend.is_some() { "Show list" } else { "Fold list" };
        button_ui(ui, graph, list, "The list of channels, or a small legend in the plot", A::ToggleList);
    });
    ui.separator();
    heading_ui(ui, "Record and export");
    ui.horizontal(|ui| {
        ui.label("Folder");
        if ui.button("Choose…").on_hover_text("Chooses the folder for recordings and exports").clicked() {
            graph.files.choose_folder();
        }
        text_field_ui(ui, &mut graph.files.folder, "Folder for recordings", "Folder");
    });
    ui.add_enabled_ui(!graph.files.is_recording(), |ui| {
        ui.horizontal(|ui| {
            button_ui(
                ui,
                graph,
                "Record CSV",
                "Every reading with the times of its request and reply",
                A::RecordCsv,
            );
            button_ui(
                ui,
                graph,
                "Record compact",
                "The same in about a tenth of the space",
                A::RecordCompact,
            );
        });
    });
    ui.horizontal(|ui| {
        ui.label("In view as");
        button_ui(ui, graph, "CSV", A::ExportCsv.title(), A::ExportCsv);
        button_ui(ui, graph, "PNG", A::ExportPng.title(), A::ExportPng);
        button_ui(ui, graph, "SVG", A::ExportSvg.title(), A::ExportSvg);
        let hint = "Puts the picture on the clipboard, as the keys for Copy do in the plot";
        button_ui(ui, graph, "Copy picture", hint, A::CopyPicture);
    });
    let hint = "The last hour of all channels, with commands, stops and other events, as a CSV that can be opened again; after a disconnect too";
    button_ui(ui, graph, "Save the whole history", hint, A::SaveHistory);
    ui.separator();
    open_ui(ui, graph);
    ui.separator();
    if graph.runs.is_empty() {
        runs_ui(ui, graph);
        ui.separator();
    }
    ui.collapsing("Marks", |ui| marks_ui(ui, graph));
    ui.collapsing("Keys", |ui| ui.label(KEYS));
}

/// The newest marks; a click brings one into view.
fn marks_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    const MOST: usize = 40;
    let sheet = graph.sheet_mut();
    let began_s = sheet.track.began_s.unwrap_or(0.0);
    let newest: Vec<(f64, String)> = sheet
        .track
        .marks
        .iter()
        .rev()
        .take(MOST)
        .map(|mark| {
            let at = axes::duration_text((mark.at_s - began_s).max(0.0), 0.01);
            (mark.at_s, format!("{at}  {}: {}", mark.kind.word(), mark.text))
        })
        .collect();
    if newest.is_empty() {
        ui.label("No mark yet. Commands, stops and arming leave one.");
    }
    for (at_s, text) in newest {
        if ui.selectable_label(false, RichText::new(text).small()).clicked() {
            let span_s = sheet.span_s();
            sheet.look_at(at_s - span_s * 0.2, at_s + span_s * 0.8);
        }
    }
}

fn heading_ui(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).small().weak());
}

fn open_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    heading_ui(ui, "Open a recording");
    ui.horizontal(|ui| {
        ui.radio_value(&mut graph.files.open_as, OpenAs::Recording, "To look at");
        ui.radio_value(&mut graph.files.open_as, OpenAs::Run, "As a run beneath, to compare");
    });
    ui.horizontal(|ui| {
        let hint = "One recording, or several at once: the others are laid over the first";
        if ui.button("Choose files…").on_hover_text(hint).clicked() {
            graph.files.choose_recording();
        }
        if ui.button("Open file").on_hover_text("Opens the file whose path stands beside").clicked() {
            graph.files.open_typed();
        }
        text_field_ui(ui, &mut graph.files.open_path, "Recording file", "Path of a .csv or .bwr file");
    });
    if let Some(text) = graph.files.loading_text() {
        ui.horizontal(|ui| {
            ui.label(text);
            if ui.button("Cancel").clicked() {
                graph.files.give_up_loading();
            }
        });
    }
    if let Some(opened) = &graph.opened {
        ui.label(GraphBarMessage::LookingAt { name: opened.name.clone() }.to_string());
        if ui.button("Close recording").clicked() {
            graph.close_recording();
        }
    }
}

fn runs_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    heading_ui(ui, "Earlier runs, drawn beneath");
    let hint = "Keeps what is in view, to compare with what comes";
    button_ui(ui, graph, "Keep what is in view", hint, GraphAction::KeepRun);
    if graph.runs.is_empty() {
        return;
    }
    ui.horizontal(|ui| {
        ui.label("Aligned by");
        for align in Align::ALL {
            ui.selectable_value(&mut graph.align, align, align.word());
        }
    });
    let mut gone = None;
    for (number, run) in graph.runs.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            ui.checkbox(&mut run.shown, format!("{}: {}", number + 1, run.name));
            let name = GraphBarMessage::Shift { number: number + 1 }.to_string();
            ui.label("shift")
                .on_hover_text("Later by so much; its numbered handle in the graph can be dragged too");
            let any = f64::NEG_INFINITY..=f64::INFINITY;
            Numeric { name: &name, unit: "s", range: any, decimals: 3, step: 0.01, width: 80.0 }
                .ui(ui, &mut run.shift_s);
            if ui.button("Remove").clicked() {
                gone = Some(number);
            }
        });
    }
    if let Some(gone) = gone {
        graph.runs.remove(gone);
    }
}

/// How often the signals are read.
fn rate_ui(ui: &mut Ui, poll: PollRate, commands: &mut Commands) {
    let rates = [500, 100, 50, 20, 10, 5, 2, 1].map(|every| PollRate::Every(Duration::from_millis(every)));
    let mut chosen = poll;
    let list = ComboBox::from_id_salt("rate").width(104.0);
    let response =
        choice_ui(ui, list, "Sampling", &mut chosen, rates.into_iter().chain([PollRate::Fastest]), poll_text);
    if chosen != poll {
        commands.push(Command::Poll(chosen));
    }
    response.on_hover_text("How often the signals are read");
}

fn poll_text(poll: PollRate) -> String {
    match poll {
        PollRate::Off => "not read".to_owned(),
        PollRate::Every(time) => GraphBarMessage::Every { milliseconds: time.as_millis() }.to_string(),
        PollRate::Fastest => "as fast as it goes".to_owned(),
    }
}
