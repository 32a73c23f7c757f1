//! Where the keyboard is: the regions of the window that F6 goes through, and where it goes when the screen changes.
//!
//! A region marks its place as it is drawn. The keyboard goes to the first thing in it that takes it; a screen begins with its heading, which
//! presses nothing, so that Enter after a change of screen does nothing unwanted.

use egui::{
    Context, Event, FocusDirection, Id, Order, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind,
    TextStyle, Ui, WidgetInfo, vec2,
};

use crate::theme::Palette;

/// A part of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    Devices,
    /// The heading of the open screen, and its tabs.
    Screen,
    /// What is set or driven on it.
    Controls,
    /// What a tuning run has found.
    Result,
    Graph,
    World,
    Traffic,
    Message,
    /// A window above the screen that was opened last.
    Dialog,
}

impl Region {
    /// In the order of F6.
    pub const ALL: [Self; 9] = [
        Self::Devices,
        Self::Screen,
        Self::Controls,
        Self::Result,
        Self::Graph,
        Self::World,
        Self::Traffic,
        Self::Message,
        Self::Dialog,
    ];
}

/// Frames in which a wish stays that no region takes.
const PATIENCE: u64 = 4;

#[derive(Clone, Debug, Default)]
struct Focus {
    /// Where each region began in its last frame, and that frame.
    places: [Option<(Pos2, u64)>; Region::ALL.len()],
    /// Where the keyboard is to go, and since which frame.
    wanted: Option<(Region, u64)>,
    /// The pointer was used last, and not the keyboard.
    by_pointer: bool,
}

fn id() -> Id {
    Id::unique("regions of the window")
}

fn frame(ctx: &Context) -> u64 {
    ctx.cumulative_frame_nr()
}

fn with<R>(ctx: &Context, act: impl FnOnce(&mut Focus) -> R) -> R {
    ctx.data_mut(|data| act(data.get_temp_mut_or_default::<Focus>(id())))
}

/// Takes note of what is used, once a frame: where a screen was opened by the pointer, nothing has to show where the keyboard is.
pub fn note_input(ctx: &Context) {
    let (keys, pointer) = ctx.input(|input| {
        let is_key = |event: &Event| matches!(event, Event::Key { pressed: true, .. });
        (input.events.iter().any(is_key), input.pointer.any_pressed() || input.pointer.any_released())
    });
    with(ctx, |focus| focus.by_pointer = if keys { false } else { pointer || focus.by_pointer });
}

/// Whether the heading shows that the keyboard is there.
pub fn shows_ring(ctx: &Context) -> bool {
    with(ctx, |focus| !focus.by_pointer)
}

/// The keyboard goes to a region as soon as it is drawn.
pub fn want(ctx: &Context, region: Region) {
    let now = frame(ctx);
    with(ctx, |focus| focus.wanted = Some((region, now)));
    ctx.request_repaint();
}

/// The keyboard goes to the next region that is there, or to the one before.
pub fn go_on(ctx: &Context, forward: bool) {
    let now = frame(ctx);
    let focused = ctx.memory(egui::Memory::focused).and_then(|id| ctx.read_response(id));
    let there = with(ctx, |focus| focus.places).map(|place| place.filter(|(_, at)| at + 2 >= now));
    let current = focused.and_then(|response| match response.layer_id.order {
        Order::Background => region_at(&there, response.rect.center()),
        Order::Middle | Order::Foreground | Order::Tooltip | Order::Debug => Some(Region::Dialog),
    });
    let places: Vec<Region> =
        Region::ALL.into_iter().filter(|region| there[*region as usize].is_some()).collect();
    let Some(first) = places.iter().find(|region| **region == Region::Screen).or(places.first()) else {
        return;
    };
    let at = current.and_then(|current| places.iter().position(|region| *region == current));
    let count = places.len();
    let next = at.map_or(*first, |at| places[if forward { at + 1 } else { at + count - 1 } % count]);
    want(ctx, next);
}

/// The region that begins last above and left of a point.
fn region_at(places: &[Option<(Pos2, u64)>; Region::ALL.len()], point: Pos2) -> Option<Region> {
    let begins = |region: &Region| places[*region as usize].map(|(place, _)| place);
    let is_before =
        |region: &Region| begins(region).is_some_and(|at| at.x <= point.x + 1.0 && at.y <= point.y + 1.0);
    // What is above all of them is found by its layer.
    let found = Region::ALL.into_iter().filter(|region| *region != Region::Dialog).filter(is_before);
    // Columns first: what begins furthest to the right holds the point.
    found.max_by(|one, other| {
        let of = |region: &Region| begins(region).map_or((0.0, 0.0), |at| (at.x.round(), at.y));
        let ((ax, ay), (bx, by)) = (of(one), of(other));
        let column = if (ax - bx).abs() < COLUMN { std::cmp::Ordering::Equal } else { ax.total_cmp(&bx) };
        column.then(ay.total_cmp(&by))
    })
}

/// Less than this apart, two regions stand in one column.
const COLUMN: f32 = 40.0;

/// Marks where a region begins. Where the keyboard is wanted there, what comes next takes it.
pub fn region_ui(ui: &Ui, region: Region) {
    if begin(ui, region) {
        let anchor = Id::unique(("begin of region", region as usize));
        ui.memory_mut(|memory| {
            memory.request_focus(anchor);
            memory.move_focus(FocusDirection::Next);
        });
        let place = Rect::from_min_size(ui.cursor().min, vec2(1.0, 1.0));
        ui.interact(place, anchor, Sense::focusable_noninteractive());
    }
}

/// Notes the place; true where the keyboard is wanted here, which is then seen to.
fn begin(ui: &Ui, region: Region) -> bool {
    let (ctx, place) = (ui.ctx(), ui.cursor().min);
    let now = frame(ctx);
    with(ctx, |focus| {
        focus.places[region as usize] = Some((place, now));
        let wanted = focus.wanted.filter(|(_, since)| now <= since + PATIENCE);
        let is_wanted = wanted.is_some_and(|(wanted, _)| wanted == region);
        focus.wanted = wanted.filter(|_| !is_wanted);
        is_wanted
    })
}

/// The heading of a screen. It takes the keyboard when its screen is opened, and at no other time.
pub fn heading_ui(ui: &mut Ui, title: &str) -> Response {
    let is_wanted = begin(ui, Region::Screen);
    let id = Id::unique("heading of the screen");
    if is_wanted {
        ui.memory_mut(|memory| memory.request_focus(id));
    }
    let has_focus = ui.memory(|memory| memory.has_focus(id));
    let font = TextStyle::Heading.resolve(ui.style());
    let palette = Palette::of(ui);
    let text = ui.painter().layout_no_wrap(title.to_owned(), font, palette.text);
    let (_, place) = ui.allocate_space(text.size());
    let sense = if has_focus { Sense::focusable_noninteractive() } else { Sense::hover() };
    let response = ui.interact(place, id, sense);
    response.widget_info(|| WidgetInfo::labeled(Role::Heading, true, title));
    ui.painter().galley(place.min, text, palette.text);
    if has_focus && shows_ring(ui.ctx()) {
        let ring = Stroke::new(1.0, palette.accent);
        ui.painter().rect_stroke(place.expand(3.0), 3.0, ring, StrokeKind::Outside);
    }
    response
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn a_point_is_in_the_region_that_begins_last_above_it_in_its_column() {
        let mut places = [None; Region::ALL.len()];
        for (region, at) in [
            (Region::Devices, pos2(10.0, 40.0)),
            (Region::Screen, pos2(230.0, 110.0)),
            (Region::Controls, pos2(230.0, 200.0)),
            (Region::Graph, pos2(230.0, 330.0)),
            (Region::World, pos2(990.0, 110.0)),
            (Region::Message, pos2(230.0, 700.0)),
        ] {
            places[region as usize] = Some((at, 1));
        }
        let found = |x: f32, y: f32| region_at(&places, pos2(x, y));
        assert_eq!(found(100.0, 500.0), Some(Region::Devices));
        assert_eq!(found(400.0, 120.0), Some(Region::Screen));
        assert_eq!(found(400.0, 300.0), Some(Region::Controls));
        assert_eq!(found(900.0, 600.0), Some(Region::Graph));
        assert_eq!(found(1100.0, 600.0), Some(Region::World));
        assert_eq!(found(500.0, 710.0), Some(Region::Message));
        assert_eq!(found(2.0, 2.0), None);
    }
}
