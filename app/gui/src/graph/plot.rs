//! The plot in the window: egui_plot draws axes, grid and lines, and scrolls and zooms; handles and marks lie over it.
//!
//! Time is the plot's horizontal axis. Each channel has a scale of its own, so that the plot's height is only 0 to 1 and
//! the selected channel's figures stand at the side.
//!
//! Dragging the plot scrolls, dragging it with the second button zooms into a box, dragging the time axis zooms. The wheel zooms
//! time about the pointer, with Shift it scrolls, with Ctrl it changes the selected channel's scale. Cursors, zero marks, earlier runs, the
//! trigger's level and its place are dragged by their handles. With keyboard focus the plot is moved by keys ([`KEYS`]).

use std::ops::RangeInclusive;
use std::rc::Rc;

use egui::{
    Color32, CursorIcon, Event, EventFilter, FontId, Id, Key, Modifiers, PointerButton, Pos2, Rangef, Rect,
    Response, Role, Sense, Shape, Stroke, TextStyle, Ui, UiBuilder, Vec2, WidgetInfo, vec2,
};
use egui_plot::{
    AxisHints, Corner, GridInput, GridMark, HLine, ItemId, Legend, LegendGrouping, Plot, PlotBounds,
    PlotGeometry, PlotItem, PlotItemBase, PlotMemory, PlotPoint, PlotResponse, PlotTransform,
};

use super::action::GraphAction;
use super::picture::draw::{self, Curve, Scene};
use super::picture::frame::{AXIS_WIDTH, FLAGS, Frame, GUTTER, RIGHT, TIMES};
use super::picture::{self, axes, paint};
use super::runs::Run;
use super::{Cursors, LiveGraph, Scale, Sheet, TriggerMode};
use crate::graph::messages::PlotMessage;
use crate::theme::Palette;

/// What the keys do while the plot has focus.
pub const KEYS: &str = "With the plot selected (Tab or a click): left and right arrows scroll or move the cursor, with Shift further, \
    up and down move the channel's zero, with Shift its scale, + − zoom, Home oldest, End live, P pause, C cursors, X other \
    cursor, F fit, A whole history, M mark, T arm the trigger, N next trigger, and the keys for Copy put the picture on the clipboard";

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
    /// An earlier run, by its place.
    Run(usize),
    Axis,
    Time,
}

/// Size of the figures at the axes.
const FIGURE: f32 = 11.0;

/// Fills what is left of `ui`.
pub fn plot_ui(ui: &mut Ui, graph: &mut LiveGraph) -> Response {
    let size = ui.available_size().max(Vec2::splat(60.0));
    // What is around the plot belongs to the handles; within it the plot takes the pointer.
    let (outer, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    graph.last_plot_size = outer.size();
    keys_ui(ui, graph, &response);
    let frame = Frame::new(outer, graph.sheet().window());
    scale_wheel_ui(ui, graph, &response, &frame);
    let (shown, curves) = lines_ui(ui, graph, &response, &frame);
    look_at(graph, &frame, shown.transform.bounds());
    take_legend(ui, graph, plot_id(&response));
    drag_ui(ui, graph, [&response, &shown.response], &frame);
    let (start_s, end_s) = graph.sheet().window();
    let plot = *shown.transform.frame();
    over_ui(ui, graph, &response, &Frame { outer, plot, start_s, end_s }, &curves);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, spoken(graph)));
    response
}

fn scene<'a>(ui: &Ui, graph: &'a LiveGraph, frame: Frame) -> Scene<'a> {
    Scene {
        sheet: graph.sheet(),
        runs: &graph.runs,
        align: graph.align,
        palette: Palette::of(ui),
        frame,
        pixels_per_point: ui.pixels_per_point(),
        is_recording: graph.opened.is_some(),
    }
}

/// Axes, grid and lines. What the pointer asks of time and height is in the bounds of what comes back.
fn lines_ui(
    ui: &mut Ui,
    graph: &LiveGraph,
    response: &Response,
    frame: &Frame,
) -> (PlotResponse<()>, Vec<Rc<Curve>>) {
    let scene = scene(ui, graph, *frame);
    let (sheet, palette, curves) = (scene.sheet, scene.palette, scene.curves());
    let (times, heights) = (scene.times(), scene.heights());
    let is_handle_held = gripped(ui, graph, response, frame).is_some_and(|grip| grip != Grip::Time);
    let mut plot = plot(palette, &times, &heights)
        .id(plot_id(response))
        .allow_drag([!is_handle_held, false])
        .allow_boxed_zoom(!is_handle_held);
    if let Some(listed) = &graph.legend {
        let hidden = listed.iter().filter(|channel| !sheet.channels[**channel].shown);
        let legend = Legend::default()
            .position(Corner::LeftTop)
            .text_style(TextStyle::Small)
            .follow_insertion_order(true)
            .grouping(LegendGrouping::ById)
            .hidden_items(hidden.map(|channel| line_id(*channel)));
        plot = plot.legend(legend);
    }
    let outer = frame.outer;
    let place = Rect::from_min_max(outer.min + vec2(0.0, FLAGS), outer.max - vec2(RIGHT, 0.0));
    let closer = wheel_zoom(ui, response, frame);
    // A picture that follows keeps its newest sample in view.
    let about_s = closer.filter(|_| sheet.is_held()).map_or(frame.end_s, |(_, at_s)| at_s);
    let mut inside = ui.new_child(UiBuilder::new().max_rect(place));
    inside.visuals_mut().extreme_bg_color = palette.ground;
    inside.visuals_mut().widgets.noninteractive.bg_stroke = Stroke::NONE;
    let shown = plot.show(&mut inside, |plot| {
        plot.set_plot_bounds(PlotBounds::from_min_max([frame.start_s, 0.0], [frame.end_s, 1.0]));
        if let Some((closer, _)) = closer {
            plot.zoom_bounds(vec2(closer, 1.0), PlotPoint::new(about_s, 0.5));
        }
        if let Some((part, color)) = scene.zero_line() {
            plot.hline(HLine::new("", part).color(color).width(1.0).allow_hover(false));
        }
        for curve in &curves {
            plot.add(Drawn::line(sheet, Rc::clone(curve), outer));
        }
        for channel in graph.legend.iter().flatten().filter(|channel| !sheet.channels[**channel].shown) {
            plot.add(Drawn::hidden(sheet, palette, *channel));
        }
    });
    (shown, curves)
}

fn plot_id(response: &Response) -> Id {
    response.id.with("plot")
}

/// An empty plot with the grid of the graph, on which nothing moves in height.
fn plot<'a>(palette: &Palette, times: &'a [Ruled], heights: &'a [Ruled]) -> Plot<'a> {
    let hints = |hints: AxisHints<'a>, color| {
        let font = FontId::proportional(FIGURE);
        hints.tick_label_font(font).tick_label_color(color).label_spacing(Rangef::new(0.0, 1.0))
    };
    Plot::new("graph")
        // The graph as a whole takes the keyboard.
        .sense(Sense::CLICK | Sense::DRAG)
        .show_x(false)
        .show_y(false)
        .allow_zoom(false)
        .allow_scroll([true, false])
        .allow_axis_zoom_drag([true, false])
        .allow_double_click_reset(false)
        .min_size(vec2(20.0, 20.0))
        .grid_spacing(Rangef::new(1.0, 2.0))
        .grid_color(palette.line.gamma_multiply(0.75))
        .x_grid_spacer(|input| marks_of(times, &input))
        .y_grid_spacer(|input| marks_of(heights, &input))
        .custom_x_axes(vec![hints(
            AxisHints::new_x().min_thickness(TIMES).formatter(|mark, _| figure_of(times, mark)),
            palette.weak_text,
        )])
        // The nearer one is the strip of the zero marks.
        .custom_y_axes(vec![
            AxisHints::new_y().min_thickness(GUTTER).formatter(|_, _| String::new()),
            hints(
                AxisHints::new_y().min_thickness(AXIS_WIDTH).formatter(|mark, _| figure_of(heights, mark)),
                palette.text,
            ),
        ])
}

/// A line of the grid, and its figure.
type Ruled = (f64, Option<String>);

/// Marks with a figure have the room up to the next one that has one.
fn marks_of(ruled: &[Ruled], input: &GridInput) -> Vec<GridMark> {
    let written: Vec<f64> =
        ruled.iter().filter(|(_, figure)| figure.is_some()).map(|(value, _)| *value).collect();
    let between = |values: &[f64]| values.first_chunk().map(|[a, b]| b - a);
    let all: Vec<f64> = ruled.iter().map(|(value, _)| *value).collect();
    let whole = input.bounds.1 - input.bounds.0;
    let apart = between(&all).unwrap_or(whole);
    let far_apart = between(&written).unwrap_or(whole);
    let step_size = |figure: &Option<String>| if figure.is_some() { far_apart } else { apart };
    ruled.iter().map(|(value, figure)| GridMark { value: *value, step_size: step_size(figure) }).collect()
}

fn figure_of(ruled: &[Ruled], mark: GridMark) -> String {
    let at = ruled.iter().find(|(value, _)| *value == mark.value);
    at.and_then(|(_, figure)| figure.clone()).unwrap_or_default()
}

/// The plot's name for a channel's line.
fn line_id(channel: usize) -> ItemId {
    ItemId::new(("channel", channel))
}

/// A line as the plot draws it: of our own history, thinned to at most two points per column of pixels.
struct Drawn {
    base: PlotItemBase,
    id: ItemId,
    color: Color32,
    /// Nothing for a channel that only has a row in the legend.
    curve: Option<Rc<Curve>>,
    outer: Rect,
}

impl Drawn {
    fn line(sheet: &Sheet, curve: Rc<Curve>, outer: Rect) -> Self {
        let (name, id) = match curve.run {
            // An earlier run has its number beside it and no row in the legend.
            Some(run) => (String::new(), ItemId::new(("run", run, curve.channel))),
            None => (sheet.channels[curve.channel].info.label.clone(), line_id(curve.channel)),
        };
        Self { base: PlotItemBase::new(name), id, color: curve.color, curve: Some(curve), outer }
    }

    fn hidden(sheet: &Sheet, palette: &Palette, channel: usize) -> Self {
        let base = PlotItemBase::new(sheet.channels[channel].info.label.clone());
        let color = draw::color_of(sheet, palette, channel);
        Self { base, id: line_id(channel), color, curve: None, outer: Rect::NOTHING }
    }
}

impl PlotItem for Drawn {
    fn shapes(&self, ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        let Some(curve) = &self.curve else { return };
        let elements = curve.elements(&Frame::of(self.outer, transform));
        shapes.extend(elements.into_iter().map(|element| picture::shape(ui.ctx(), element)));
    }

    fn initialize(&mut self, _x_range: RangeInclusive<f64>) {}

    fn color(&self) -> Color32 {
        self.color
    }

    fn allow_hover(&self) -> bool {
        false
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        PlotGeometry::None
    }

    fn bounds(&self) -> PlotBounds {
        PlotBounds::NOTHING
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }

    fn id(&self) -> ItemId {
        self.id
    }
}

/// What lies over the lines.
fn over_ui(ui: &Ui, graph: &LiveGraph, response: &Response, frame: &Frame, curves: &[Rc<Curve>]) {
    let scene = scene(ui, graph, *frame);
    paint(&ui.painter().with_clip_rect(frame.outer), scene.over(curves));
    for (place, (rect, _, text)) in scene.run_rows().into_iter().enumerate() {
        let row = ui.interact(rect, response.id.with(("run row", place)), Sense::hover());
        row.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
    }
    if response.has_focus() {
        let ring = Stroke::new(2.0, scene.palette.accent);
        ui.painter().rect_stroke(frame.plot, 0.0, ring, egui::StrokeKind::Outside);
    }
    notice_ui(ui, graph, frame);
    pointer_ui(ui, graph, response, frame);
}

/// Takes over where the plot was dragged and zoomed to.
fn look_at(graph: &mut LiveGraph, frame: &Frame, asked: &PlotBounds) {
    let ([from_s, low], [to_s, high]) = (asked.min(), asked.max());
    let sheet = graph.sheet_mut();
    if (low, high) != (0.0, 1.0) {
        // A box: every line is magnified alike, so that they stay where they are to each other.
        for channel in sheet.shown() {
            let scale = sheet.channels[channel].scale;
            sheet.set_scale(channel, Scale { low: scale.value(low), high: scale.value(high) });
        }
        return sheet.look_at(from_s, to_s);
    }
    let (was_s, is_s) = (frame.end_s - frame.start_s, to_s - from_s);
    if (is_s / was_s - 1.0).abs() > 1e-9 {
        // About the moment that stays where it is.
        sheet.zoom(is_s / was_s, Some((from_s - frame.start_s) / (was_s - is_s)));
    } else if (from_s - frame.start_s).abs() > was_s * 1e-9 {
        sheet.pan(from_s - frame.start_s);
    }
}

/// A row of the legend shows and hides its channel.
fn take_legend(ui: &Ui, graph: &mut LiveGraph, plot: Id) {
    let Some(listed) = graph.legend.clone() else { return };
    let Some(memory) = PlotMemory::load(ui.ctx(), plot) else { return };
    let sheet = graph.sheet_mut();
    for channel in listed {
        sheet.channels[channel].shown = !memory.hidden_items.contains(&line_id(channel));
    }
}

/// In the picture itself: that it is held, that it is a recording, that there is nothing yet.
fn notice_ui(ui: &Ui, graph: &LiveGraph, frame: &Frame) {
    let palette = Palette::of(ui);
    let sheet = graph.sheet();
    let text = if let Some(opened) = &graph.opened {
        match opened.left_out {
            0 => PlotMessage::Opened { name: opened.name.clone() }.to_string(),
            rows => PlotMessage::OpenedInPart { name: opened.name.clone(), rows }.to_string(),
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
    let at = frame.plot.left_bottom() + vec2(6.0, -8.0);
    let font = picture::font(11.0, false);
    let galley = ui.painter().layout_no_wrap(text, font, palette.ground);
    let place = Rect::from_min_size(at - vec2(0.0, galley.size().y), galley.size()).expand2(vec2(5.0, 2.0));
    ui.painter().rect_filled(place, 3.0, palette.weak_text);
    ui.painter().galley(place.min + vec2(5.0, 2.0), galley, palette.ground);
}

/// Time and value at the pointer, and the words of a flag under it.
fn pointer_ui(ui: &Ui, graph: &LiveGraph, response: &Response, frame: &Frame) {
    let Some(at) = pointer(ui, response) else { return };
    let sheet = graph.sheet();
    if let Some(mark) = mark_at(sheet, frame, at) {
        response.clone().on_hover_text_at_pointer(&mark);
        return;
    }
    ui.ctx().set_cursor_icon(match grip_at(graph, frame, at) {
        Some(Grip::Cursor(_) | Grip::TriggerPlace | Grip::Run(_)) => CursorIcon::ResizeHorizontal,
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
    let place = frame.plot.right_top() + vec2(-6.0, 4.0);
    let font = picture::font(11.0, true);
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
    let runs = graph.runs.iter().enumerate().rev().filter(|(_, run)| run.shown);
    let is_at = |run: &(usize, &Run)| draw::run_handle(frame, sheet, *run, graph.align).contains(at);
    if let Some((run, _)) = runs.into_iter().find(is_at) {
        return Some(Grip::Run(run));
    }
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

/// Where the pointer is, if over the graph.
fn pointer(ui: &Ui, response: &Response) -> Option<Pos2> {
    response.contains_pointer().then(|| ui.input(|input| input.pointer.hover_pos())).flatten()
}

/// What the pointer holds, from the moment that it is pressed.
fn gripped(ui: &Ui, graph: &LiveGraph, response: &Response, frame: &Frame) -> Option<Grip> {
    let (is_down, origin) = ui.input(|input| (input.pointer.any_down(), input.pointer.press_origin()));
    let held = ui.data(|data| data.get_temp::<Option<Grip>>(response.id.with("grip"))).flatten();
    held.or_else(|| grip_at(graph, frame, origin?)).filter(|_| is_down)
}

/// Drags the handles, within the plot and around it.
fn drag_ui(ui: &Ui, graph: &mut LiveGraph, [outer, plot]: [&Response; 2], frame: &Frame) {
    let key = outer.id.with("grip");
    let primary = PointerButton::Primary;
    let either = |is: fn(&Response) -> bool| is(outer) || is(plot);
    let at = outer.interact_pointer_pos().or(plot.interact_pointer_pos());
    if either(Response::clicked) || either(Response::drag_started) {
        outer.request_focus();
    }
    if either(|response| response.drag_started_by(PointerButton::Primary)) {
        let from = ui.input(|input| input.pointer.press_origin()).or(at);
        let grip = from.and_then(|at| grip_at(graph, frame, at));
        ui.data_mut(|data| data.insert_temp(key, grip));
        match grip {
            Some(Grip::Zero(channel)) => graph.sheet_mut().selected = channel,
            Some(Grip::Cursor(which)) => graph.sheet_mut().cursors.active = which,
            Some(Grip::Level | Grip::TriggerPlace | Grip::Run(_) | Grip::Axis | Grip::Time) | None => {}
        }
    }
    let held = ui.data(|data| data.get_temp::<Option<Grip>>(key)).flatten();
    if (outer.dragged_by(primary) || plot.dragged_by(primary))
        && let (Some(grip), Some(at)) = (held, at)
    {
        pull(graph, grip, at, outer.drag_delta() + plot.drag_delta(), frame);
    }
    if either(Response::drag_stopped) {
        ui.data_mut(|data| data.remove::<Option<Grip>>(key));
    }
    if either(Response::clicked)
        && let Some(Grip::Zero(channel)) = at.and_then(|at| grip_at(graph, frame, at))
    {
        graph.sheet_mut().selected = channel;
    }
}

/// Moves what is held to where the pointer is.
fn pull(graph: &mut LiveGraph, grip: Grip, at: Pos2, by: Vec2, frame: &Frame) {
    if let Grip::Run(run) = grip {
        let by_s = f64::from(by.x / frame.plot.width()) * (frame.end_s - frame.start_s);
        if let Some(run) = graph.runs.get_mut(run) {
            run.shift_s += by_s;
        }
        return;
    }
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
        // The plot scrolls by itself; a run has moved.
        Grip::Time | Grip::Run(_) => {}
    }
}

/// The wheel with Ctrl, or over the figures at the side, changes the selected channel's scale.
fn scale_wheel_ui(ui: &Ui, graph: &mut LiveGraph, response: &Response, frame: &Frame) {
    let Some(at) = pointer(ui, response) else { return };
    let zoom = f64::from(ui.input(egui::InputState::zoom_delta));
    let wheel = if at.x < frame.plot.left() { f64::from(wheel(ui)) } else { 1.0 };
    let wider = 1.0 / (wheel * zoom);
    let sheet = graph.sheet_mut();
    let selected = sheet.selected;
    if (wider - 1.0).abs() > 1e-4
        && let Some(scale) = sheet.channels.get(selected).map(|channel| channel.scale)
    {
        sheet.set_scale(selected, scale.zoomed(wider, frame.part(at.y).clamp(0.0, 1.0)));
    }
}

/// How much closer the wheel asks to look at time, and at which moment it stands.
fn wheel_zoom(ui: &Ui, response: &Response, frame: &Frame) -> Option<(f32, f64)> {
    let at = pointer(ui, response).filter(|at| at.x >= frame.plot.left())?;
    Some((wheel(ui), frame.time_s(at.x))).filter(|(closer, _)| *closer != 1.0)
}

/// How much the wheel magnifies.
fn wheel(ui: &Ui) -> f32 {
    (ui.input(egui::InputState::smooth_scroll_delta).y / POINTS_PER_DOUBLING).exp2()
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
    if ui.input(|input| input.events.contains(&Event::Copy)) {
        graph.act(GraphAction::CopyPicture);
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
        Some(opened) => PlotMessage::OfRecording { name: opened.name.clone(), span, shown }.to_string(),
        None if sheet.is_held() => PlotMessage::Paused { span, shown }.to_string(),
        None if sheet.shot_s().is_some() => PlotMessage::AtTrigger { span, shown }.to_string(),
        None => PlotMessage::Live { span, shown }.to_string(),
    };
    let (start_s, end_s) = sheet.window();
    if let Some(mark) = sheet.track.marks.between(start_s, end_s).next_back() {
        text += &PlotMessage::LastMark { mark: mark.text.clone() }.to_string();
    }
    let beneath: Vec<&str> = graph.runs.iter().filter(|run| run.shown).map(|run| run.name.as_str()).collect();
    if !beneath.is_empty() {
        text += &PlotMessage::Beneath { runs: beneath.join(", ") }.to_string();
    }
    if sheet.cursors.on {
        text += &PlotMessage::Cursor { name: Cursors::NAMES[sheet.cursors.active] }.to_string();
    }
    text
}

/// Width of the axis, for those who want to line up with the plot.
pub const LEFT: f32 = AXIS_WIDTH;
