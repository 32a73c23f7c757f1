//! The open programs, a tab each.

use egui::{
    Align2, Key, Rect, Response, Role, ScrollArea, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2,
};

use super::{Document, Editor, MclAction};
use crate::mcl::messages::PanelMessage;
use crate::messages::ButtonMessage;
use crate::theme::Palette;

const HEIGHT: f32 = 28.0;
const CLOSE_WIDTH: f32 = 22.0;

pub fn tabs_ui(ui: &mut Ui, editor: &Editor, actions: &mut Vec<MclAction>) {
    ScrollArea::horizontal().id_salt("mcl tabs").min_scrolled_width(80.0).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let front = editor.front().id();
            for document in editor.documents() {
                tab_ui(ui, document, document.id() == front, actions);
            }
        });
    });
}

fn tab_ui(ui: &mut Ui, document: &Document, in_front: bool, actions: &mut Vec<MclAction>) {
    let palette = Palette::of(ui);
    let (title, modified) = (document.title(), document.text.is_modified());
    let font = TextStyle::Body.resolve(ui.style());
    let width =
        ui.fonts_mut(|fonts| fonts.layout_no_wrap(title.clone(), font.clone(), palette.text).size().x);
    let (rect, response) = ui.allocate_exact_size(vec2(width + 40.0 + CLOSE_WIDTH, HEIGHT), Sense::click());
    let state = if modified { ", not saved" } else { "" };
    let spoken = PanelMessage::Tab { title: title.to_string(), state }.to_string();
    response.widget_info(|| WidgetInfo::selected(Role::Tab, true, in_front, &spoken));
    let fill = if in_front { palette.ground } else { palette.panel };
    let ring =
        if response.has_focus() { Stroke::new(2.0, palette.accent) } else { Stroke::new(1.0, palette.line) };
    ui.painter().rect(rect, 3.0, fill, ring, egui::StrokeKind::Inside);
    if in_front {
        ui.painter().hline(rect.x_range().shrink(2.0), rect.top() + 1.0, Stroke::new(2.0, palette.accent));
    }
    let color = if in_front { palette.text } else { palette.weak_text };
    ui.painter().text(pos2(rect.left() + 20.0, rect.center().y), Align2::LEFT_CENTER, &title, font, color);
    if modified {
        ui.painter().circle_filled(pos2(rect.left() + 11.0, rect.center().y), 3.5, palette.warning);
    }
    let closed = close_ui(ui, rect, document, &title, actions);
    if !closed && response.clicked() {
        actions.push(MclAction::Front(document.id()));
    }
    if response.middle_clicked() || response.has_focus() && ui.input(|input| input.key_pressed(Key::Delete)) {
        actions.push(MclAction::Close(document.id()));
    }
    hover_ui(response, document);
}

fn hover_ui(response: Response, document: &Document) {
    let path = document.path.as_ref().map(|path| path.display().to_string());
    let state = if document.text.is_modified() { "\nNot saved" } else { "" };
    response.on_hover_text(format!("{}{state}", path.unwrap_or_else(|| "Not in a file yet".to_owned())));
}

fn close_ui(ui: &Ui, tab: Rect, document: &Document, title: &str, actions: &mut Vec<MclAction>) -> bool {
    let palette = Palette::of(ui);
    let at = Rect::from_center_size(pos2(tab.right() - 12.0, tab.center().y), vec2(17.0, 17.0));
    let response = ui.interact(at, ui.scope_id().with(("close", document.id())), Sense::click());
    let name = ButtonMessage::Close { title: title.to_string() }.to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(at, 3.0, palette.raised);
    }
    let font = TextStyle::Button.resolve(ui.style());
    ui.painter().text(at.center(), Align2::CENTER_CENTER, "×", font, palette.weak_text);
    let clicked = response.clicked();
    response.on_hover_text(name);
    if clicked {
        actions.push(MclAction::Close(document.id()));
    }
    clicked
}
