//! The list of settings: name, field, what the controller has, the default, revert.

use brushwork_link::settings::Row;
use egui::{Align, Button, Label, Layout, Rect, RichText, Role, ScrollArea, Sense, Ui, WidgetInfo, vec2};

use super::{editor, help};
use crate::messages::ButtonMessage;
use crate::model::{GeneralView, IndicatorState, Section, UnitSettings};
use crate::screens::face::Face;
use crate::screens::messages::SettingMessage;
use crate::theme::Palette;
use crate::widgets::{NO_VALUE, heading_ui};

pub const HEIGHT: f32 = 28.0;
pub const MARK_WIDTH: f32 = 14.0;
const FIELD_WIDTH: f32 = 184.0;
const VALUE_WIDTH: f32 = 110.0;
const REVERT_WIDTH: f32 = 62.0;
const EXTRA_WIDTH: f32 = 46.0;
/// Room a name needs at least; columns are left out for it, the default first.
const NAME_WIDTH: f32 = 140.0;

/// Which columns there is room for.
#[derive(Clone, Copy)]
pub struct Columns {
    name: f32,
    /// Room beside the field for what belongs to it.
    extra: f32,
    controller: bool,
    default: bool,
}

/// Draws what stands beside the field of a row.
pub type Extra<'a> = &'a mut dyn FnMut(&mut Ui, &mut UnitSettings, &Row);

impl Columns {
    pub fn fit(width: f32, gap: f32) -> Self {
        Self::with(width, gap, 0.0)
    }

    /// With room for a small button beside each field.
    pub fn with_extra(width: f32, gap: f32) -> Self {
        Self::with(width, gap, EXTRA_WIDTH)
    }

    fn with(width: f32, gap: f32, extra: f32) -> Self {
        let extra_gap = if extra > 0.0 { gap } else { 0.0 };
        let fixed = MARK_WIDTH + FIELD_WIDTH + extra + extra_gap + REVERT_WIDTH + 4.0 * gap;
        let with = |values: f32| width - fixed - values * (VALUE_WIDTH + gap);
        let controller = with(1.0) >= NAME_WIDTH;
        let default = with(2.0) >= NAME_WIDTH;
        let values = f32::from(u8::from(controller) + u8::from(default));
        Self { name: with(values).clamp(80.0, 320.0), extra, controller, default }
    }
}

/// Room that the scroll bar may take.
const BAR_WIDTH: f32 = 14.0;

pub fn rows_ui(ui: &mut Ui, general: &mut GeneralView<'_>, face: &dyn Face, height: f32) {
    let shown = general.shown();
    let is_filtered = general.is_filtered();
    let gap = ui.spacing().item_spacing.x;
    let columns = Columns::fit(ui.available_width() - BAR_WIDTH, gap);
    let header_height = ui.spacing().interact_size.y;
    header_ui(ui, columns);
    let list_height = (height - header_height - ui.spacing().item_spacing.y).max(HEIGHT);
    ui.allocate_ui_with_layout(vec2(ui.available_width(), list_height), Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(list_height);
        let salt = ("settings", format!("{:?}", general.section), is_filtered);
        ScrollArea::vertical().id_salt(salt).auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            if shown.is_empty() {
                ui.label("No setting of this controller fits.");
            }
            if !is_filtered {
                face.around_rows_ui(ui, general, true);
            }
            list_ui(ui, general, &shown, columns, &mut |_, _, _| {});
            if !is_filtered {
                face.around_rows_ui(ui, general, false);
            }
        });
    });
}

/// The rows one below the other, under their sections where several are shown.
pub fn list_ui(
    ui: &mut Ui,
    general: &mut GeneralView<'_>,
    shown: &[String],
    columns: Columns,
    extra: Extra<'_>,
) {
    let is_filtered = general.is_filtered();
    let open = general.section;
    let sought = general.sought.take();
    let mut explained = None;
    let Some(unit) = general.unit_mut() else { return };
    let mut section = None;
    for key in shown {
        let Some(row) = unit.table().row(key).cloned() else { continue };
        if is_filtered && section.replace(Section::of(&row)) != Some(Section::of(&row)) {
            section_heading_ui(ui, &row);
        }
        // Among its like a pin or a port needs no name.
        let is_one = !is_filtered && Section::of(&row) == open && matches!(open, Section::One(..));
        // The key as identity: rows come and go with the filter.
        if ui.push_id(key, |ui| row_ui(ui, unit, &row, columns, is_one, extra)).inner {
            explained = Some(key.clone());
        }
        if sought.as_deref() == Some(key) {
            ui.scroll_to_cursor(None);
        }
    }
    if explained.is_some() {
        general.explained = explained;
    }
}

fn section_heading_ui(ui: &mut Ui, row: &Row) {
    ui.add_space(6.0);
    let name = match (Section::of(row), &row.instance) {
        (Section::One(..), Some(instance)) => instance.name.as_str(),
        _ => row.group.label(),
    };
    heading_ui(ui, name);
}

pub fn header_ui(ui: &mut Ui, columns: Columns) {
    ui.horizontal(|ui| {
        ui.set_min_height(ui.spacing().interact_size.y);
        ui.allocate_space(vec2(MARK_WIDTH, 1.0));
        let mut titles = vec![("Setting", columns.name), ("Wanted", FIELD_WIDTH)];
        titles.extend((columns.extra > 0.0).then_some(("", columns.extra)));
        titles.extend(columns.controller.then_some(("On the controller", VALUE_WIDTH)));
        titles.extend(columns.default.then_some(("Default", VALUE_WIDTH)));
        for (title, width) in titles {
            crate::widgets::label::fixed_label_ui(ui, title, width);
        }
    });
}

/// Draws a row; true when it is the one to explain.
fn row_ui(
    ui: &mut Ui,
    unit: &mut UnitSettings,
    row: &Row,
    columns: Columns,
    is_one: bool,
    extra: Extra<'_>,
) -> bool {
    let locked = unit.locked(row);
    let width = ui.available_width();
    let response =
        ui.allocate_ui_with_layout(vec2(width, HEIGHT), Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_height(HEIGHT);
            mark_ui(ui, unit, row);
            let title = if is_one { row.label.to_owned() } else { row.title() };
            let name = text_ui(ui, &title, &title, columns.name, locked.is_some());
            // Pressed by the other button alone, and never by the keyboard: the explanation below has the same.
            let name = ui.interact(name, ui.scope_id().with("name"), Sense::CLICK);
            name.context_menu(|ui| help::copies_ui(ui, unit, row));
            let field = ui.allocate_ui_with_layout(
                vec2(FIELD_WIDTH, HEIGHT),
                Layout::left_to_right(Align::Center),
                |ui| {
                    ui.set_min_width(FIELD_WIDTH);
                    ui.add_enabled_ui(locked.is_none(), |ui| editor::editor_ui(ui, unit, row)).inner
                },
            );
            if columns.extra > 0.0 {
                let place = vec2(columns.extra, HEIGHT);
                ui.allocate_ui_with_layout(place, Layout::left_to_right(Align::Center), |ui| {
                    ui.set_min_width(columns.extra);
                    extra(ui, unit, row);
                });
            }
            if columns.controller {
                let text = unit.on_controller(&row.key).map(|value| row.format(value));
                let text = text.unwrap_or_else(|| NO_VALUE.to_owned());
                let spoken =
                    SettingMessage::OnController { title: row.title(), value: text.clone() }.to_string();
                text_ui(ui, &text, &spoken, VALUE_WIDTH, true);
            }
            if columns.default {
                let text = row.format(row.default);
                let spoken =
                    SettingMessage::DefaultIs { title: row.title(), value: text.clone() }.to_string();
                text_ui(ui, &text, &spoken, VALUE_WIDTH, true);
            }
            match locked {
                Some(reason) if !unit.is_edited(&row.key) => locked_ui(ui, row, reason),
                _ => revert_ui(ui, unit, row),
            }
            field.inner
        });
    response.inner || ui.rect_contains_pointer(response.response.rect)
}

/// A dot before what was changed, a cross before what went wrong.
fn mark_ui(ui: &mut Ui, unit: &UnitSettings, row: &Row) {
    let (rect, response) = ui.allocate_exact_size(vec2(MARK_WIDTH, HEIGHT), Sense::hover());
    let (state, spoken) = match unit.trouble(&row.key) {
        Some(trouble) => (IndicatorState::Error, format!("{}: {trouble}", row.title())),
        None if unit.is_edited(&row.key) => {
            (IndicatorState::Warning, SettingMessage::IsChanged { title: row.title() }.to_string())
        }
        None => return,
    };
    state.paint(ui, rect.center(), 5.0);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    response.on_hover_text(spoken);
}

/// Text in a place of fixed width; what does not fit is cut off and shown by a pointer over it.
fn text_ui(ui: &mut Ui, text: &str, spoken: &str, width: f32, is_weak: bool) -> Rect {
    let color = if is_weak { Palette::of(ui).weak_text } else { Palette::of(ui).text };
    ui.allocate_ui_with_layout(vec2(width, HEIGHT), Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(width);
        let label = Label::new(RichText::new(text).color(color)).selectable(false).truncate();
        let response = ui.add(label);
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, spoken));
    })
    .response
    .rect
}

fn locked_ui(ui: &mut Ui, row: &Row, reason: &str) {
    let (rect, response) = ui.allocate_exact_size(vec2(REVERT_WIDTH, HEIGHT), Sense::hover());
    let font = egui::TextStyle::Small.resolve(ui.style());
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, "locked", font, Palette::of(ui).weak_text);
    let spoken = SettingMessage::IsLocked { title: row.title(), reason: reason.to_string() }.to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    response.on_hover_text(reason);
}

fn revert_ui(ui: &mut Ui, unit: &mut UnitSettings, row: &Row) {
    if !unit.is_edited(&row.key) {
        ui.allocate_space(vec2(REVERT_WIDTH, HEIGHT));
        return;
    }
    let name = ButtonMessage::Revert { title: row.title() }.to_string();
    let response = ui.add_sized(vec2(REVERT_WIDTH, HEIGHT - 6.0), Button::new("Revert").small());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    if response.on_hover_text("Back to what the controller has").clicked() {
        unit.revert(&row.key);
    }
}
