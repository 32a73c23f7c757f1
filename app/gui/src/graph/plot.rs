//! The plot in the window: draws the picture and takes the mouse and the keys.
//!
//! Dragging the plot scrolls; the wheel zooms time about the pointer, with Shift it scrolls, with Ctrl it changes the
//! selected channel's scale. Cursors, zero marks, the trigger's level and its place are dragged by their handles. With
//! keyboard focus the plot is moved by keys ([`KEYS`]).

use egui::{
    CursorIcon, EventFilter, Key, Modifiers, Pos2, Rect, Response, Role, Sense, Ui, Vec2, WidgetInfo,
};

use super::action::GraphAction;
use super::picture::draw::{self, Scene};
use super::picture::frame::{AXIS_WIDTH, Frame};
use super::picture::{axes, paint};
use super::{Cursors, LiveGraph, Sheet, TriggerMode};
use crate::theme::Palette;

/// What the keys do while the plot has focus.
pub const KEYS: &str = "With the plot selected (Tab or a click): left and right arrows scroll or move the cursor, with Shift further, \
    up and down move the channel's zero, with Shift its scale, + − zoom, Home oldest, End live, P pause, C cursors, X other \
    cursor, F fit, A whole history, M mark, T arm the trigger, N next trigger";

/// How near the pointer has to be to a handle.
const REACH: f32 = 7.0;

/// Wheel turns per doubling.
const POINTS_PER_DOUBLING: f32 = 120.0;

/// What is being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Grip {
    Cursor(usize),
    Zero(usize),
    Level,
    TriggerPlace,
    Axis,
    Time,
}

/// Fills what is left of `ui`.
pub fn plot_ui(ui: &mut Ui, graph: &mut LiveGraph) -> Response {
    let size = ui.available_size().max(Vec2::splat(60.0));
    let (outer, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    graph.last_plot_size = outer.size();
    let frame = Frame::new(outer, graph.sheet().window());
    keys_ui(ui, graph, &response);
    wheel_ui(ui, graph, &response, &frame);
    drag_ui(ui, graph, &response, &frame);
    draw_ui(ui, graph, &response, outer);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, spoken(graph)));
    response
}

fn draw_ui(ui: &Ui, graph: &LiveGraph, response: &Response, outer: Rect) {
    let sheet = graph.sheet();
    let frame = Frame::new(outer, sheet.window());
    let palette = Palette::of(ui);
    let pixels_per_point = ui.pixels_per_point();
    let is_recording = graph.opened.is_some();
    let scene = Scene {
        sheet,
        runs: &graph.runs,
        align: graph.align,
        palette,
        frame,
        pixels_per_point,
        is_recording,
    };
    paint(&ui.painter().with_clip_rect(outer), scene.picture());
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, palette.accent);
        ui.painter().rect_stroke(frame.plot, 0.0, ring, egui::StrokeKind::Outside);
    }
    notice_ui(ui, graph, &frame);
    pointer_ui(ui, graph, response, &frame);
}

/// In the picture itself: that it is held, that it is a recording, that there is nothing yet.
fn notice_ui(ui: &Ui, graph: &LiveGraph, frame: &Frame) {
    let palette = Palette::of(ui);
    let sheet = graph.sheet();
    let text = if let Some(opened) = &graph.opened {
        match opened.left_out {
            0 => format!("RECORDING  {}", opened.name),
            rows => format!("RECORDING  {} · its oldest {rows} rows are left out", opened.name),
        }
    } else if sheet.track.history.is_empty() {
        "No sample yet".to_owned()
    } else if sheet.is_held() {
        "PAUSED · sampling goes on".to_owned()
    } else if sheet.shown().is_empty() {
        "No channel is shown: tick one in the list".to_owned()
    } else {
        return;
    };
    let at = frame.plot.left_bottom() + egui::vec2(6.0, -8.0);
    let font = super::picture::font(11.0, false);
    let galley = ui.painter().layout_no_wrap(text, font, palette.ground);
    let place = Rect::from_min_size(at - egui::vec2(0.0, galley.size().y), galley.size())
        .expand2(egui::vec2(5.0, 2.0));
    ui.painter().rect_filled(place, 3.0, palette.weak_text);
    ui.painter().galley(place.min + egui::vec2(5.0, 2.0), galley, palette.ground);
}

/// Time and value at the pointer, and the words of a flag under it.
fn pointer_ui(ui: &Ui, graph: &LiveGraph, response: &Response, frame: &Frame) {
    let Some(at) = response.hover_pos() else { return };
    let sheet = graph.sheet();
    if let Some(mark) = mark_at(sheet, frame, at) {
        response.clone().on_hover_text_at_pointer(&mark);
        return;
    }
    ui.ctx().set_cursor_icon(match grip_at(graph, frame, at) {
        Some(Grip::Cursor(_) | Grip::TriggerPlace) => CursorIcon::ResizeHorizontal,
        Some(Grip::Zero(_) | Grip::Level | Grip::Axis) => CursorIcon::ResizeVertical,
        Some(Grip::Time) => CursorIcon::Grab,
        None => CursorIcon::Default,
    });
    if !frame.plot.contains(at) {
        return;
    }
    let palette = Palette::of(ui);
    let time_s = frame.time_s(at.x);
    let from_zero_s = time_s - draw::zero_s(sheet, graph.opened.is_some());
    let step_s = (frame.end_s - frame.start_s) / f64::from(frame.plot.width());
    let mut text = axes::label(from_zero_s, step_s.min(0.5), draw::zero_of(sheet, graph.opened.is_some()));
    if let Some(channel) = sheet.channels.get(sheet.selected).filter(|channel| channel.shown) {
        let value = sheet.track.history.value_at(sheet.selected, time_s);
        text += &format!("   {} {}", channel.info.label, channel.text(value));
    }
    let place = frame.plot.right_top() + egui::vec2(-6.0, 4.0);
    let font = super::picture::font(11.0, true);
    ui.painter().text(place, egui::Align2::RIGHT_TOP, text, font, palette.text);
}

fn mark_at(sheet: &Sheet, frame: &Frame, at: Pos2) -> Option<String> {
    if at.y > frame.plot.top() + 2.0 || at.y < frame.outer.top() {
        return None;
    }
    let near = |mark: &&super::marks::Mark| (frame.x(mark.at_s) + 3.0 - at.x).abs() <= REACH;
    let mark = sheet.track.marks.between(frame.start_s - 1.0, frame.end_s).rev().find(near)?;
    Some(format!("{}: {}", mark.kind.word(), mark.text))
}

/// What lies under the pointer. Handles go before the plot behind them.
fn grip_at(graph: &LiveGraph, frame: &Frame, at: Pos2) -> Option<Grip> {
    let sheet = graph.sheet();
    let plot = frame.plot;
    if sheet.cursors.on && plot.contains(at) {
        let distance =
            |which: usize| (frame.x(sheet.cursor_s(which)).clamp(plot.left(), plot.right()) - at.x).abs();
        let nearest = if distance(0) <= distance(1) { 0 } else { 1 };
        if distance(nearest) <= REACH {
            return Some(Grip::Cursor(nearest));
        }
    }
    if sheet.trigger.mode() != TriggerMode::Off {
        let level = draw::level_y(frame, sheet).is_some_and(|y| (y - at.y).abs() <= REACH);
        if level && at.x > plot.right() {
            return Some(Grip::Level);
        }
        let place = draw::trigger_x(frame, sheet).is_some_and(|x| (x - at.x).abs() <= REACH);
        if place && at.y < plot.top() && !sheet.is_held() {
            return Some(Grip::TriggerPlace);
        }
    }
    if at.x < plot.left() && at.x > plot.left() - 16.0 {
        // The selected channel's mark lies on top.
        let touched = |channel: &usize| {
            let mark = draw::zero_mark(frame, sheet, *channel);
            at.y >= mark[0].y - 2.0 && at.y <= mark[4].y + 2.0
        };
        return sheet.shown().into_iter().rev().find(touched).map(Grip::Zero);
    }
    if at.x < plot.left() { Some(Grip::Axis) } else { plot.contains(at).then_some(Grip::Time) }
}

fn drag_ui(ui: &Ui, graph: &mut LiveGraph, response: &Response, frame: &Frame) {
    let key = response.id.with("grip");
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if response.drag_started() {
        let from = ui.input(|input| input.pointer.press_origin()).or(response.interact_pointer_pos());
        let grip = from.and_then(|at| grip_at(graph, frame, at));
        ui.data_mut(|data| data.insert_temp(key, grip));
        match grip {
            Some(Grip::Zero(channel)) => graph.sheet_mut().selected = channel,
            Some(Grip::Cursor(which)) => graph.sheet_mut().cursors.active = which,
            _ => {}
        }
    }
    if response.dragged()
        && let (Some(Some(grip)), Some(at)) =
            (ui.data(|data| data.get_temp::<Option<Grip>>(key)), response.interact_pointer_pos())
    {
        pull(graph, grip, at, response.drag_delta(), frame);
    }
    if response.clicked()
        && let Some(Grip::Zero(channel)) =
            response.interact_pointer_pos().and_then(|at| grip_at(graph, frame, at))
    {
        graph.sheet_mut().selected = channel;
    }
}

/// Moves what is held to where the pointer is.
fn pull(graph: &mut LiveGraph, grip: Grip, at: Pos2, by: Vec2, frame: &Frame) {
    let sheet = graph.sheet_mut();
    let up = f64::from(-by.y / frame.plot.height());
    match grip {
        Grip::Cursor(which) => {
            let x = at.x.clamp(frame.plot.left(), frame.plot.right());
            sheet.set_cursor(which, frame.time_s(x));
        }
        Grip::Zero(channel) => {
            if let Some(scale) = sheet.channels.get(channel).map(|channel| channel.scale) {
                sheet.set_scale(channel, scale.shifted(0.0, up));
            }
        }
        Grip::Axis => {
            let selected = sheet.selected;
            if let Some(scale) = sheet.channels.get(selected).map(|channel| channel.scale) {
                sheet.set_scale(selected, scale.shifted(0.0, up));
            }
        }
        Grip::Level => {
            let mut settings = *sheet.trigger.settings();
            if let super::trigger::TriggerSource::Channel(channel) = settings.source
                && let Some(channel) = sheet.channels.get(channel)
            {
                settings.level = channel.scale.value(frame.part(at.y).clamp(0.0, 1.0));
                sheet.trigger.set(settings);
            }
        }
        Grip::TriggerPlace => {
            let part = f64::from((at.x - frame.plot.left()) / frame.plot.width()).clamp(0.0, 1.0);
            let settings = *sheet.trigger.settings();
            sheet.trigger.set(super::trigger::TriggerSettings { pre: part, ..settings });
        }
        Grip::Time if by.x != 0.0 => {
            sheet.pan(-f64::from(by.x / frame.plot.width()) * (frame.end_s - frame.start_s));
        }
        Grip::Time => {}
    }
}

fn wheel_ui(ui: &Ui, graph: &mut LiveGraph, response: &Response, frame: &Frame) {
    let Some(at) = response.hover_pos() else { return };
    let (scroll, zoom) = ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
    let sheet = graph.sheet_mut();
    let over_axis = at.x < frame.plot.left();
    let wheel = f64::from(-scroll.y / POINTS_PER_DOUBLING).exp2();
    let vertical = if over_axis { wheel / f64::from(zoom) } else { 1.0 / f64::from(zoom) };
    if (vertical - 1.0).abs() > 1e-4 {
        let selected = sheet.selected;
        if let Some(scale) = sheet.channels.get(selected).map(|channel| channel.scale) {
            sheet.set_scale(selected, scale.zoomed(vertical, frame.part(at.y).clamp(0.0, 1.0)));
        }
    }
    if scroll.x != 0.0 {
        sheet.pan(-f64::from(scroll.x / frame.plot.width()) * (frame.end_s - frame.start_s));
    }
    if scroll.y != 0.0 && !over_axis {
        let part = f64::from((at.x - frame.plot.left()) / frame.plot.width());
        sheet.zoom(wheel, Some(part));
    }
}

fn keys_ui(ui: &Ui, graph: &mut LiveGraph, response: &Response) {
    if !response.has_focus() {
        return;
    }
    let arrows = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    for (key, times, action) in pressed(ui, graph.sheet().cursors.on) {
        let _ = key;
        (0..times).for_each(|_| graph.act(action));
    }
}

/// What the keys that were pressed ask for, and how often.
fn pressed(ui: &Ui, cursors: bool) -> Vec<(Key, usize, GraphAction)> {
    use GraphAction as A;
    let (left, right) = if cursors { (A::CursorLeft, A::CursorRight) } else { (A::Earlier, A::Later) };
    let far = if cursors { 10 } else { 5 };
    let (none, shift, control) = (Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND);
    let table = [
        (control, Key::ArrowLeft, 1, A::Earlier),
        (control, Key::ArrowRight, 1, A::Later),
        (shift, Key::ArrowLeft, far, left),
        (shift, Key::ArrowRight, far, right),
        (none, Key::ArrowLeft, 1, left),
        (none, Key::ArrowRight, 1, right),
        (shift, Key::ArrowUp, 1, A::ScaleCloser),
        (shift, Key::ArrowDown, 1, A::ScaleWider),
        (none, Key::ArrowUp, 1, A::ZeroUp),
        (none, Key::ArrowDown, 1, A::ZeroDown),
        (none, Key::PageUp, 9, A::Earlier),
        (none, Key::PageDown, 9, A::Later),
        (none, Key::Home, 1, A::Oldest),
        (none, Key::End, 1, A::BackToLive),
        (none, Key::Plus, 1, A::ZoomIn),
        (shift, Key::Plus, 1, A::ZoomIn),
        (none, Key::Equals, 1, A::ZoomIn),
        (none, Key::Minus, 1, A::ZoomOut),
        (none, Key::P, 1, A::TogglePause),
        (none, Key::C, 1, A::ToggleCursors),
        (none, Key::X, 1, A::OtherCursor),
        (none, Key::F, 1, A::FitAll),
        (none, Key::A, 1, A::ShowAll),
        (none, Key::M, 1, A::AddNote),
        (none, Key::T, 1, A::RearmTrigger),
        (none, Key::N, 1, A::NextTrigger),
    ];
    let taken = |modifiers, key| ui.input_mut(|input| input.count_and_consume_key(modifiers, key));
    table
        .into_iter()
        .map(|(modifiers, key, steps, action)| (key, steps * taken(modifiers, key), action))
        .filter(|(_, times, _)| *times > 0)
        .collect()
}

/// The plot in words.
fn spoken(graph: &LiveGraph) -> String {
    let sheet = graph.sheet();
    let shown: Vec<_> = sheet
        .channels
        .iter()
        .filter(|channel| channel.shown)
        .map(|channel| channel.info.label.as_str())
        .collect();
    let shown = if shown.is_empty() { "no channel".to_owned() } else { shown.join(", ") };
    let span = axes::span_text(sheet.span_s());
    let mut text = match &graph.opened {
        Some(opened) => format!("Graph of the recording {}, {span}: {shown}", opened.name),
        None if sheet.is_held() => format!("Graph, paused, of {span}: {shown}"),
        None if sheet.shot_s().is_some() => format!("Graph of {span} at the trigger: {shown}"),
        None => format!("Live graph of the last {span}: {shown}"),
    };
    let (start_s, end_s) = sheet.window();
    if let Some(mark) = sheet.track.marks.between(start_s, end_s).next_back() {
        text += &format!(". Last mark: {}", mark.text);
    }
    if sheet.cursors.on {
        text += &format!(". Cursor {} is moved by the arrow keys", Cursors::NAMES[sheet.cursors.active]);
    }
    text
}

/// Width of the axis, for those who want to line up with the plot.
pub const LEFT: f32 = AXIS_WIDTH;
