//! A screen above and its graph below, with a bar between them that is dragged, or moved by keys. Where it was left is remembered for each
//! screen; where it never was moved the graph has all that the screen leaves.

use egui::{
    CursorIcon, EventFilter, Id, Key, Rect, Response, Role, ScrollArea, Sense, Stroke, Ui, UiBuilder,
    WidgetInfo, pos2, vec2,
};

use super::graph_place::graph_place_ui;
use crate::command::Commands;
use crate::model::{Model, Screen};
use crate::screens::messages::ScreenMessage;
use crate::theme::Palette;

/// Part of the window's height that a graph has at first, in a window of the usual size.
pub const GRAPH_PART: f32 = 0.45;
/// In a small window the screen scrolls rather than give the graph less.
const LEAST_GRAPH_HEIGHT: f32 = 176.0;
/// The least of a screen that is left above its graph.
const LEAST_ABOVE: f32 = 40.0;
/// The least of a long screen that is worth to be seen at first.
const LEAST_LONG: f32 = 150.0;
const BAR_HEIGHT: f32 = 8.0;
/// Room for the line that says that the graph is elsewhere.
const DETACHED_HEIGHT: f32 = 40.0;
/// Between the two clicks of a double click.
const DOUBLE_CLICK_S: f64 = 0.6;
/// What an arrow key moves the bar by.
const KEY_STEP: f32 = 0.02;

/// Room for a screen and its graph.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    screen: Screen,
    /// Where the graph ends.
    bottom: f32,
    /// Height of both together.
    height: f32,
    /// How high the graph is at first, where it does not have all that the screen leaves.
    at_first: Option<f32>,
}

impl Split {
    /// Shares what is left of a room below what `ui` has drawn already.
    pub fn of(ui: &Ui, screen: Screen, bottom: f32) -> Self {
        let least = LEAST_ABOVE + BAR_HEIGHT + LEAST_GRAPH_HEIGHT;
        Self { screen, bottom, height: (bottom - ui.cursor().top()).max(least), at_first: None }
    }

    /// The same for a screen that is longer than the window: it scrolls above a graph that has its part of the window from the first.
    pub fn of_long(ui: &Ui, screen: Screen, bottom: f32) -> Self {
        let split = Self::of(ui, screen, bottom);
        let wanted = GRAPH_PART * ui.ctx().content_rect().height();
        let graph = wanted + BAR_HEIGHT;
        // A small window is shared in halves.
        let graph = if split.height - graph < LEAST_LONG { split.height * 0.5 } else { graph };
        Self { at_first: Some(graph), ..split }
    }

    /// How high the graph is, where that does not follow from the screen.
    fn graph_height(&self, model: &Model) -> Option<f32> {
        let most = self.height - LEAST_ABOVE - BAR_HEIGHT;
        let moved = model.layout.graph_part(self.screen).map(|part| part * self.height);
        Some(moved.or(self.at_first)?.clamp(LEAST_GRAPH_HEIGHT.min(most), most))
    }

    /// Draws what stands above the graph: as high as it is, or as the bar leaves it.
    pub fn above_ui(&self, ui: &mut Ui, model: &mut Model, contents: impl FnOnce(&mut Ui, &mut Model)) {
        let height = match model.front.graph.detached {
            false => self.graph_height(model).map(|graph| self.height - graph - BAR_HEIGHT),
            true => self.at_first.map(|_| self.height - DETACHED_HEIGHT),
        };
        let Some(height) = height.map(|height| height - ui.spacing().item_spacing.y) else {
            return contents(ui, model);
        };
        let size = vec2(ui.available_width(), height);
        let (place, _) = ui.allocate_exact_size(size, Sense::hover());
        let mut inside = ui.new_child(UiBuilder::new().max_rect(place));
        let area = ScrollArea::vertical().id_salt(("above the graph", self.screen as usize));
        area.auto_shrink(false).show(&mut inside, |ui| contents(ui, model));
    }

    /// Draws the bar and the graph in what is left.
    pub fn graph_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
        let least = if model.front.graph.detached {
            DETACHED_HEIGHT
        } else {
            bar_ui(ui, self, model);
            LEAST_GRAPH_HEIGHT
        };
        let height = (self.bottom - ui.cursor().top()).max(least);
        // A place of exact size: what does not fit into it cannot make the screen scroll.
        let (place, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        let layout = egui::Layout::top_down(egui::Align::Min);
        let mut inside = ui.new_child(UiBuilder::new().max_rect(place).layout(layout));
        graph_place_ui(&mut inside, model, commands);
    }
}

/// The bar: dragged, or moved by the arrow keys; a double click gives the graph what the screen leaves.
fn bar_ui(ui: &mut Ui, split: &Split, model: &mut Model) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let size = vec2(ui.available_width(), BAR_HEIGHT);
    let (_, place) = ui.allocate_space(size);
    // A name of its own: what stands above changes with the first pixel that it is moved by, and a hand or the keyboard has to keep it.
    let id = Id::unique(("bar above the graph", split.screen as usize));
    let response = ui.interact(place, id, Sense::click_and_drag());
    let part = (split.bottom - place.bottom()) / split.height;
    let response = response.on_hover_cursor(CursorIcon::ResizeVertical);
    response.widget_info(|| {
        let percent = ScreenMessage::GraphHeight { percent: part * 100.0 }.to_string();
        WidgetInfo::labeled(Role::Splitter, true, percent)
    });
    let moved = moved_by_keys(ui, &response) * KEY_STEP;
    let least = (LEAST_GRAPH_HEIGHT / split.height).min(1.0);
    let most = (1.0 - (LEAST_ABOVE + BAR_HEIGHT) / split.height).max(least);
    let is_reset = response.has_focus() && ui.input(|input| input.key_pressed(Key::Home));
    if is_reset || is_double_click(ui, &response) {
        model.layout.set_graph_part(split.screen, None);
    } else if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        let wanted = (split.bottom - pointer.y - BAR_HEIGHT * 0.5) / split.height;
        model.layout.set_graph_part(split.screen, Some(wanted.clamp(least, most)));
    } else if moved != 0.0 {
        model.layout.set_graph_part(split.screen, Some((part + moved).clamp(least, most)));
    }
    paint(ui, place, &response);
    response.on_hover_text(
        "Drag, or move by the arrow keys; a double click or Home brings back the usual height",
    );
}

/// Whether the bar is clicked for the second time. A window that is drawn ten times a second sees a click late: it is given more time than a
/// button.
fn is_double_click(ui: &Ui, response: &Response) -> bool {
    if !response.clicked() {
        return false;
    }
    let (now_s, key) = (ui.input(|input| input.time), response.id.with("clicked"));
    let before = ui.data(|data| data.get_temp::<f64>(key));
    let is_second = before.is_some_and(|before| now_s - before <= DOUBLE_CLICK_S);
    ui.data_mut(|data| data.insert_temp(key, if is_second { f64::NEG_INFINITY } else { now_s }));
    is_second
}

/// How often up was pressed, less how often down was.
fn moved_by_keys(ui: &Ui, response: &Response) -> f32 {
    if !response.has_focus() {
        return 0.0;
    }
    let arrows = EventFilter { vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    let times = |key| ui.input(|input| input.num_presses(key)) as f32;
    times(Key::ArrowUp) - times(Key::ArrowDown)
}

fn paint(ui: &Ui, place: Rect, response: &Response) {
    let palette = Palette::of(ui);
    let is_lit = response.hovered() || response.dragged() || response.has_focus();
    let color = match response.has_focus() {
        true => palette.accent,
        false if is_lit => palette.weak_text,
        false => palette.line,
    };
    let y = place.center().y;
    let painter = ui.painter();
    painter.hline(place.x_range(), y, Stroke::new(1.0, palette.line));
    let middle = place.center().x;
    let grip = Rect::from_min_max(pos2(middle - 22.0, y - 2.0), pos2(middle + 22.0, y + 2.0));
    painter.rect_filled(grip, 2.0, color);
}
