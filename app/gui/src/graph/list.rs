//! The list of channels beside the graph: which are shown, their newest values, and the selected one's scale.

use egui::containers::menu::MenuButton;
use egui::{
    Align2, CollapsingHeader, Response, Role, ScrollArea, Sense, Stroke, StrokeKind, TextStyle, Ui,
    WidgetInfo, pos2, vec2,
};

use super::action::GraphAction;
use super::picture::draw::color_of;
use super::{LiveGraph, Sheet};
use crate::graph::messages::GraphBarMessage;
use crate::messages::ButtonMessage;
use crate::theme::{self, Palette};
use crate::widgets::readout::NO_VALUE;

const ROW_HEIGHT: f32 = 20.0;
const SWATCH: f32 = 14.0;
/// Room for the selected channel's scale under the list.
const FOOTER: f32 = 66.0;

/// The channels, one per row.
pub fn channels_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    ScrollArea::vertical().max_height((ui.available_height() - FOOTER).max(ROW_HEIGHT)).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let known = if graph.opened.is_some() { usize::MAX } else { graph.pins };
        let sheet = graph.sheet_mut();
        let (pins, others): (Vec<usize>, Vec<usize>) =
            (0..sheet.channels.len()).partition(|index| sheet.channels[*index].info.is_pin);
        others.into_iter().for_each(|index| row_ui(ui, sheet, index));
        if known > 0 && !pins.is_empty() {
            CollapsingHeader::new("Input pins").show_unindented(ui, |ui| {
                pins.into_iter().take(known).for_each(|index| row_ui(ui, sheet, index));
            });
        }
    });
    ui.separator();
    selected_ui(ui, graph);
}

fn row_ui(ui: &mut Ui, sheet: &mut Sheet, index: usize) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if swatch_ui(ui, sheet, index).clicked() {
            let channel = &mut sheet.channels[index];
            channel.shown = !channel.shown;
            if channel.shown {
                sheet.selected = index;
            }
        }
        if name_ui(ui, sheet, index).clicked() {
            sheet.selected = index;
        }
    });
}

/// A box in the channel's colour: filled when it is shown.
fn swatch_ui(ui: &mut Ui, sheet: &Sheet, index: usize) -> Response {
    let palette = Palette::of(ui);
    let channel = &sheet.channels[index];
    let (rect, response) = ui.allocate_exact_size(vec2(SWATCH + 8.0, ROW_HEIGHT), Sense::click());
    let label = ButtonMessage::Show { what: channel.info.label.clone() }.to_string();
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, channel.shown, &label));
    let square = egui::Rect::from_center_size(rect.center(), vec2(SWATCH, SWATCH));
    let color = color_of(sheet, palette, index);
    let fill = if channel.shown { color } else { palette.panel };
    ui.painter().rect(square, 3.0, fill, Stroke::new(1.0, color), StrokeKind::Inside);
    if channel.shown {
        let mark = Stroke::new(2.0, palette.ground);
        let (middle, left) = (square.center() + vec2(-1.0, 3.0), square.left_center() + vec2(3.0, 0.5));
        ui.painter().line_segment([left, middle], mark);
        ui.painter().line_segment([middle, square.right_top() + vec2(-3.0, 4.0)], mark);
    }
    if response.has_focus() || response.hovered() {
        let ring = Stroke::new(2.0, if response.has_focus() { palette.accent } else { palette.weak_text });
        ui.painter().rect_stroke(square.expand(2.0), 4.0, ring, StrokeKind::Inside);
    }
    response
}

/// Number, name and newest value; a click selects the channel.
fn name_ui(ui: &mut Ui, sheet: &Sheet, index: usize) -> Response {
    let palette = Palette::of(ui);
    let channel = &sheet.channels[index];
    let selected = sheet.selected == index;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::click());
    let value = channel.latest.map(|value| format!("{:.1$}", value + 0.0, channel.info.decimals));
    let spoken =
        format!("{}: {} {}", channel.info.label, value.as_deref().unwrap_or("no value"), channel.info.unit);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, spoken.trim_end()));
    if selected || response.hovered() || response.has_focus() {
        let fill = if selected { palette.raised } else { palette.panel };
        let ring = Stroke::new(1.0, if response.has_focus() { palette.accent } else { palette.line });
        ui.painter().rect(rect.shrink(1.0), 3.0, fill, ring, StrokeKind::Inside);
    }
    let y = rect.center().y;
    let (body, small) = (TextStyle::Body.resolve(ui.style()), TextStyle::Small.resolve(ui.style()));
    let figures = egui::FontId::new(12.5, theme::figures().resolve(ui.style()).family);
    let color = if channel.shown { palette.text } else { palette.weak_text };
    let painter = ui.painter().with_clip_rect(rect);
    let number = (index + 1).to_string();
    painter.text(
        pos2(rect.left() + 17.0, y + 1.0),
        Align2::RIGHT_CENTER,
        number,
        small.clone(),
        palette.weak_text,
    );
    painter.text(pos2(rect.left() + 22.0, y), Align2::LEFT_CENTER, &channel.info.label, body, color);
    let unit_left = rect.right() - 46.0;
    let value = value.as_deref().unwrap_or(NO_VALUE);
    painter.text(pos2(unit_left - 3.0, y), Align2::RIGHT_CENTER, value, figures, color);
    painter.text(pos2(unit_left, y + 1.0), Align2::LEFT_CENTER, &channel.info.unit, small, palette.weak_text);
    response.on_hover_text("Click to write this channel's scale at the side of the graph")
}

/// The selected channel's scale, and what can be done with it.
fn selected_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    ui.spacing_mut().item_spacing.x = 4.0;
    ui.spacing_mut().button_padding.x = 7.0;
    let sheet = graph.sheet_mut();
    let selected = sheet.selected;
    let Some(channel) = sheet.channels.get(selected) else { return };
    let decimals = channel.scale.decimals();
    let (low, high) = (channel.scale.low + 0.0, channel.scale.high + 0.0);
    let text = GraphBarMessage::Scale {
        label: channel.info.label.clone(),
        low: format!("{low:.decimals$}"),
        high: format!("{high:.decimals$}"),
        unit: channel.info.unit.clone(),
    }
    .to_string();
    ui.horizontal(|ui| {
        color_ui(ui, sheet, selected);
        ui.add(egui::Label::new(egui::RichText::new(text).small()).truncate());
    });
    let mut wanted = None;
    ui.horizontal(|ui| {
        let mut button = |ui: &mut Ui, text: &str, label: &str, hint: &str, action: GraphAction| {
            let response = ui.button(text);
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(label));
            if response.on_hover_text(hint).clicked() {
                wanted = Some(action);
            }
        };
        let fit = "Fits this channel's scale to what is in view";
        button(ui, "Fit", "Fit scale", fit, GraphAction::FitSelected);
        button(
            ui,
            "−",
            "More units per division",
            "More units per division (Shift and down, or Ctrl and wheel)",
            GraphAction::ScaleWider,
        );
        button(
            ui,
            "+",
            "Fewer units per division",
            "Fewer units per division (Shift and up, or Ctrl and wheel)",
            GraphAction::ScaleCloser,
        );
        let grows = ui.checkbox(&mut sheet.channels[selected].grows, "Grow");
        grows.on_hover_text("The scale grows by itself when a value does not fit");
        if ui.button("Clear").on_hover_text("Clears this channel's line").clicked() {
            sheet.clear(selected);
        }
    });
    if let Some(action) = wanted {
        graph.act(action);
    }
}

/// The colour of a channel's line, chosen among the theme's, which differ from each other on light and dark ground.
fn color_ui(ui: &mut Ui, sheet: &mut Sheet, channel: usize) {
    let palette = Palette::of(ui);
    let (response, _) = MenuButton::new("      ").ui(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
        for row in 0..4 {
            ui.horizontal(|ui| {
                for place in row * 6..row * 6 + 6 {
                    let name = GraphBarMessage::Colour { number: place + 1 }.to_string();
                    if dot_ui(ui, palette.traces[place], &name).clicked() {
                        sheet.channels[channel].color = Some(place);
                        ui.close();
                    }
                }
            });
        }
    });
    ui.painter().rect_filled(response.rect.shrink(4.0), 3.0, color_of(sheet, palette, channel));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Colour of the selected channel"));
}

fn dot_ui(ui: &mut Ui, color: egui::Color32, name: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(22.0, 22.0), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let lit = response.hovered() || response.has_focus();
    let ring = Stroke::new(2.0, if lit { Palette::of(ui).accent } else { color });
    ui.painter().rect(rect.shrink(1.0), 3.0, color, ring, StrokeKind::Inside);
    response
}
