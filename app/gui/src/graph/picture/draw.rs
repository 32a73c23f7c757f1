//! What the graph looks like. Lines, grid and figures are told as numbers, which a plot of the toolkit draws in the window
//! and [`Scene::picture`] in a file; what lies over them ([`Scene::over`]) is drawn alike in both.

use std::rc::Rc;

use egui::{Align2, Color32, Pos2, Rect, Vec2, pos2, vec2};

use super::axes::{self, Zero};
use super::frame::{FLAGS, Frame, GUTTER};
use super::{Element, Layer, Picture, line_of};
use crate::graph::messages::PlotMessage;
use crate::graph::runs::{Align, Run};
use crate::graph::scale::{DIVISIONS, Scale};
use crate::graph::trace::{Columns, Trace, View};
use crate::graph::{Cursors, Mark, MarkKind, Sheet, TriggerMode, TriggerSource};
use crate::messages::NameMessage;
use crate::theme::Palette;

/// Room for one figure of the vertical axis.
const LABEL_HEIGHT: f32 = 17.0;
/// Overflow arrows and flags of one kind are not nearer to each other than this.
const SPACING: f32 = 26.0;
const SMALL: f32 = 11.0;
/// Height of a row of the legend of earlier runs, and of a handle.
const RUN_ROW: f32 = 16.0;
const HANDLE: Vec2 = vec2(38.0, 14.0);

/// What is drawn, and how.
pub struct Scene<'a> {
    pub sheet: &'a Sheet,
    pub runs: &'a [Run],
    pub align: Align,
    pub palette: &'a Palette,
    pub frame: Frame,
    pub pixels_per_point: f32,
    /// Whether the picture is of a recording rather than of what comes in.
    pub is_recording: bool,
}

/// The colour of a channel's line.
pub fn color_of(sheet: &Sheet, palette: &Palette, channel: usize) -> Color32 {
    let chosen = sheet.channels.get(channel).and_then(|channel| channel.color);
    palette.traces[chosen.unwrap_or(channel) % palette.traces.len()]
}

/// What the times are counted from.
pub fn zero_of(sheet: &Sheet, is_recording: bool) -> Zero {
    match (sheet.shot_s(), sheet.is_held() || is_recording) {
        (Some(_), _) => Zero::Trigger,
        (None, true) => Zero::Began,
        (None, false) => Zero::Now,
    }
}

/// The time that the axis calls zero.
pub fn zero_s(sheet: &Sheet, is_recording: bool) -> f64 {
    match zero_of(sheet, is_recording) {
        Zero::Trigger => sheet.shot_s().unwrap_or_default(),
        Zero::Began => sheet.track.began_s.unwrap_or(0.0),
        Zero::Now => sheet.newest_s(),
    }
}

/// The handle by which a run is dragged in time: near the bottom of the plot, where what it is aligned by stands, each above the one before.
pub fn run_handle(frame: &Frame, sheet: &Sheet, (number, run): (usize, &Run), align: Align) -> Rect {
    let plot = frame.plot;
    let half = HANDLE.x * 0.5;
    let x = frame.x(run.stands_at_s(sheet, align));
    let x = x.clamp(plot.left() + half, (plot.right() - half).max(plot.left() + half));
    let y = plot.bottom() - 28.0 - HANDLE.y * (number as f32 + 0.5) - 2.0 * number as f32;
    Rect::from_center_size(pos2(x, y), HANDLE)
}

/// The line of a channel, of now or of an earlier run.
#[derive(Clone, Debug)]
pub struct Curve {
    pub channel: usize,
    /// Place of the run it belongs to.
    pub run: Option<usize>,
    pub color: Color32,
    pub scale: Scale,
    /// Unbroken stretches of points, each a time and a value.
    pub lines: Vec<Vec<[f64; 2]>>,
    is_selected: bool,
}

impl Curve {
    /// Its shapes in a plot that lies in `frame`.
    pub fn elements(&self, frame: &Frame) -> Vec<Element> {
        let mut elements = Vec::new();
        for points in &self.lines {
            let points = frame.place(points, |value| self.scale.part(value));
            match points.as_slice() {
                _ if self.run.is_some() => dashed(&mut elements, &points, self.color),
                [only] => elements.push(Element::Box {
                    rect: Rect::from_center_size(*only, Vec2::splat(3.0)),
                    color: self.color,
                }),
                _ => elements.extend(line_of(points, self.color, if self.is_selected { 2.0 } else { 1.2 })),
            }
        }
        elements
    }
}

impl Scene<'_> {
    /// Everything, for a file.
    pub fn picture(&self) -> Picture {
        let Frame { outer, plot, .. } = self.frame;
        let curves = self.curves();
        let mut around = Vec::new();
        let mut inside = vec![Element::Box { rect: plot, color: self.palette.ground }];
        self.time_axis(&mut inside, &mut around);
        self.value_axis(&mut inside, &mut around);
        inside.extend(curves.iter().flat_map(|curve| curve.elements(&self.frame)));
        // Lines at the very top and bottom are drawn whole.
        let mut picture =
            vec![Layer { clip: plot.expand(1.0), elements: inside }, Layer { clip: outer, elements: around }];
        picture.extend(self.over(&curves));
        picture
    }

    /// What lies over the lines: marks, arrows where a line leaves the picture, trigger, cursors, zeros.
    pub fn over(&self, curves: &[Rc<Curve>]) -> Picture {
        let Frame { outer, plot, .. } = self.frame;
        let (mut inside, mut around) = (Vec::new(), Vec::new());
        self.axis_name(&mut around);
        self.marks(&mut inside, &mut around);
        let mut arrows = Vec::new();
        for curve in curves {
            if let Some(run) = curve.run {
                self.run_number(run, curve, &mut inside);
                continue;
            }
            if curve.is_selected {
                self.lost(&mut inside, &curve.lines);
            }
            for points in &curve.lines {
                let points = self.frame.place(points, |value| curve.scale.part(value));
                self.overflow(&points, curve.color, &mut arrows);
            }
        }
        inside.extend(arrows);
        self.runs_legend(&mut inside);
        self.trigger(&mut inside, &mut around);
        self.cursors(&mut inside);
        self.zero_marks(&mut around);
        vec![Layer { clip: plot.expand(1.0), elements: inside }, Layer { clip: outer, elements: around }]
    }

    /// The lines of all shown channels, those of earlier runs first and fainter, the selected one last.
    pub fn curves(&self) -> Vec<Rc<Curve>> {
        let Frame { start_s, end_s, .. } = self.frame;
        let mut curves = Vec::new();
        for (number, run) in self.runs.iter().enumerate().filter(|(_, run)| run.shown) {
            let offset_s = run.offset_s(self.sheet, self.align);
            let view = View { start_s: start_s - offset_s, end_s: end_s - offset_s, columns: self.columns() };
            let columns = Columns::new(&run.track.history, &view);
            let mut memos = run.memos.borrow_mut();
            for channel in self.sheet.shown() {
                let shown = &self.sheet.channels[channel];
                let Some(own) = run.track.channel_of_key(&shown.info.key) else { continue };
                memos[own].make_room(columns.count());
                let mut trace = Trace::remembering(&run.track.history, own, &columns, &mut memos[own]);
                trace.lines.iter_mut().flatten().for_each(|point| point[0] += offset_s);
                let color = self.run_color(number, channel);
                let (lines, scale) = (trace.lines, shown.scale);
                curves.push(Rc::new(Curve {
                    channel,
                    run: Some(number),
                    color,
                    scale,
                    lines,
                    is_selected: false,
                }));
            }
        }
        let columns = Columns::new(&self.sheet.track.history, &self.sheet.view(self.columns()));
        curves.extend(self.sheet.shown().into_iter().map(|channel| {
            Rc::new(Curve {
                channel,
                run: None,
                color: color_of(self.sheet, self.palette, channel),
                scale: self.sheet.channels[channel].scale,
                lines: self.sheet.lines(channel, &columns),
                is_selected: channel == self.sheet.selected,
            })
        }));
        curves
    }

    /// The lines of the grid in time, each with its figure where there is room for one.
    pub fn times(&self) -> Vec<(f64, Option<String>)> {
        let Frame { plot, start_s, end_s, .. } = self.frame;
        let zero = zero_of(self.sheet, self.is_recording);
        let zero_s = zero_s(self.sheet, self.is_recording);
        let division_s = axes::division_s(end_s - start_s, plot.width());
        let every = axes::label_every(division_s, end_s - start_s, plot.width());
        let first = ((start_s - zero_s) / division_s - 1e-6).ceil() as i64;
        let last = ((end_s - zero_s) / division_s + 1e-6).floor() as i64;
        let figure = |index: i64| {
            (index.rem_euclid(every) == 0).then(|| axes::label(index as f64 * division_s, division_s, zero))
        };
        (first..=last).map(|index| (zero_s + index as f64 * division_s, figure(index))).collect()
    }

    /// The lines of the grid in height, as parts of it, with the selected channel's figures where there is room.
    pub fn heights(&self) -> Vec<(f64, Option<String>)> {
        let every = (DIVISIONS as f32 * LABEL_HEIGHT / self.frame.plot.height()).ceil().max(1.0) as usize;
        let selected = self.sheet.channels.get(self.sheet.selected);
        let figure = |division: usize, part: f64| {
            let scale = selected.filter(|_| division.is_multiple_of(every))?.scale;
            Some(format!("{:.1$}", scale.value(part) + 0.0, scale.decimals()))
        };
        let part_of = |division: usize| division as f64 / DIVISIONS as f64;
        (0..=DIVISIONS).map(|division| (part_of(division), figure(division, part_of(division)))).collect()
    }

    /// Where the selected channel is zero, as a part of the height, and the colour of the line there.
    pub fn zero_line(&self) -> Option<(f64, Color32)> {
        let channel = self.sheet.channels.get(self.sheet.selected)?;
        let color = color_of(self.sheet, self.palette, self.sheet.selected);
        Some((channel.scale.part(0.0), color.gamma_multiply(0.45)))
    }

    fn time_axis(&self, inside: &mut Vec<Element>, around: &mut Vec<Element>) {
        let plot = self.frame.plot;
        for (time_s, figure) in self.times() {
            let x = self.frame.x(time_s);
            inside.push(self.grid_line(pos2(x, plot.top()), pos2(x, plot.bottom())));
            if let Some(text) = figure {
                let half = text.chars().count() as f32 * 3.1;
                let x = x.clamp(plot.left() - GUTTER, self.frame.outer.right() - half);
                let at = pos2(x, plot.bottom() + 3.0);
                around.push(self.words(at, Align2::CENTER_TOP, text, self.palette.weak_text));
            }
        }
    }

    fn value_axis(&self, inside: &mut Vec<Element>, around: &mut Vec<Element>) {
        let plot = self.frame.plot;
        for (part, figure) in self.heights() {
            let y = self.frame.y(part);
            inside.push(self.grid_line(pos2(plot.left(), y), pos2(plot.right(), y)));
            if let Some(text) = figure {
                let at = pos2(plot.left() - GUTTER - 3.0, y);
                around.push(self.words(at, Align2::RIGHT_CENTER, text, self.palette.text));
            }
        }
        if let Some((part, color)) = self.zero_line() {
            let y = self.frame.y(part);
            inside.push(line(pos2(plot.left(), y), pos2(plot.right(), y), color, 1.0));
        }
    }

    /// What the figures at the side are of.
    fn axis_name(&self, around: &mut Vec<Element>) {
        let Some(channel) = self.sheet.channels.get(self.sheet.selected) else { return };
        let text = match channel.info.unit.as_str() {
            "" => channel.info.label.clone(),
            unit => format!("{} {unit}", short(&channel.info.label)),
        };
        let at = pos2(self.frame.outer.left(), self.frame.outer.top() + FLAGS * 0.5 - 4.0);
        let color = color_of(self.sheet, self.palette, self.sheet.selected);
        around.push(self.words(at, Align2::LEFT_CENTER, text, color));
    }

    /// The colour of a run's line: one that no channel of the picture has, a little fainter.
    pub fn run_color(&self, run: usize, channel: usize) -> Color32 {
        let taken = |channel: &usize| {
            let chosen = self.sheet.channels[*channel].color.unwrap_or(*channel);
            chosen % self.palette.traces.len()
        };
        let mut shown = self.sheet.shown();
        shown.sort_unstable();
        let taken_places: Vec<usize> = shown.iter().map(taken).collect();
        let free: Vec<usize> =
            (0..self.palette.traces.len()).filter(|place| !taken_places.contains(place)).collect();
        let place = shown.iter().position(|other| *other == channel).unwrap_or(0);
        let color = match free.get((run * shown.len() + place) % free.len().max(1)) {
            Some(place) => self.palette.traces[*place],
            None => color_of(self.sheet, self.palette, channel),
        };
        color.lerp_to_gamma(self.palette.ground, 0.2)
    }

    /// Which line of an earlier run is which: its colour and its words.
    pub fn run_entries(&self) -> Vec<(Color32, String)> {
        let mut shown = self.sheet.shown();
        shown.sort_unstable();
        let runs = self.runs.iter().enumerate().filter(|(_, run)| run.shown);
        runs.flat_map(|(number, run)| {
            let there = shown.iter().filter(|channel| {
                run.track.channel_of_key(&self.sheet.channels[**channel].info.key).is_some()
            });
            let entry = |channel: &usize| {
                let label = self.sheet.channels[*channel].info.label.clone();
                let words = PlotMessage::RunLine { number: number + 1, name: run.name.clone(), label };
                (self.run_color(number, *channel), words.to_string())
            };
            there.map(entry).collect::<Vec<_>>()
        })
        .collect()
    }

    /// Where the rows of the legend of earlier runs stand, from the top right corner down; as many as there is room for.
    pub fn run_rows(&self) -> Vec<(Rect, Color32, String)> {
        let plot = self.frame.plot;
        let most = ((plot.height() - 2.0 * RUN_ROW) / RUN_ROW).max(0.0) as usize;
        let entries: Vec<_> = self.run_entries().into_iter().take(most).collect();
        let longest = entries.iter().map(|(_, text)| text.chars().count()).max().unwrap_or(0);
        let width = (longest as f32 * 5.6 + 30.0).min(plot.width() * 0.6);
        let row = |(place, (color, text)): (usize, (Color32, String))| {
            let top = plot.top() + 20.0 + place as f32 * RUN_ROW;
            let rect = Rect::from_min_max(
                pos2(plot.right() - 6.0 - width, top),
                pos2(plot.right() - 6.0, top + RUN_ROW),
            );
            (rect, color, text)
        };
        entries.into_iter().enumerate().map(row).collect()
    }

    /// The legend of earlier runs, and the handle of each by which it is dragged.
    fn runs_legend(&self, inside: &mut Vec<Element>) {
        for (rect, color, text) in self.run_rows() {
            inside.push(Element::Box { rect, color: self.palette.panel.gamma_multiply(0.85) });
            let y = rect.center().y;
            let points = [pos2(rect.left() + 4.0, y), pos2(rect.left() + 20.0, y)];
            inside.push(Element::Dashes { points, color, width: 2.0 });
            let at = pos2(rect.left() + 25.0, y);
            inside.push(self.words(at, Align2::LEFT_CENTER, text, self.palette.text));
        }
        for (number, run) in self.runs.iter().enumerate().filter(|(_, run)| run.shown) {
            let handle = run_handle(&self.frame, self.sheet, (number, run), self.align);
            let middle = handle.center();
            inside.push(Element::Polygon {
                points: vec![
                    pos2(handle.left(), middle.y),
                    pos2(handle.left() + 5.0, handle.top()),
                    pos2(handle.right() - 5.0, handle.top()),
                    pos2(handle.right(), middle.y),
                    pos2(handle.right() - 5.0, handle.bottom()),
                    pos2(handle.left() + 5.0, handle.bottom()),
                ],
                color: self.palette.weak_text,
            });
            inside.push(Element::Text {
                at: middle,
                anchor: Align2::CENTER_CENTER,
                text: NameMessage::RunLine { number: number + 1 }.to_string(),
                size: 9.5,
                color: self.palette.ground,
                figures: false,
            });
        }
    }

    /// The number of a run, beside the first of its points in view.
    fn run_number(&self, run: usize, curve: &Curve, inside: &mut Vec<Element>) {
        for points in &curve.lines {
            let points = self.frame.place(points, |value| curve.scale.part(value));
            if let Some(at) = points.iter().find(|at| at.x >= self.frame.plot.left()) {
                inside.push(Element::Text {
                    at: *at + vec2(4.0, -4.0),
                    anchor: Align2::LEFT_BOTTOM,
                    text: NameMessage::RunLine { number: run + 1 }.to_string(),
                    size: 9.5,
                    color: curve.color,
                    figures: false,
                });
            }
        }
    }

    /// A bar at the bottom where the selected channel has lost data.
    fn lost(&self, inside: &mut Vec<Element>, lines: &[Vec<[f64; 2]>]) {
        for pair in lines.windows(2) {
            if let (Some(before), Some(after)) = (pair[0].last(), pair[1].first()) {
                let (left, right) =
                    (self.frame.x(before[0]), self.frame.x(after[0]).max(self.frame.x(before[0]) + 2.0));
                let bottom = self.frame.plot.bottom();
                let rect = Rect::from_min_max(pos2(left, bottom - 4.0), pos2(right, bottom));
                inside.push(Element::Box { rect, color: self.palette.warning });
            }
        }
    }

    /// Arrows where a line lies above or below the picture.
    fn overflow(&self, points: &[Pos2], color: Color32, arrows: &mut Vec<Element>) {
        let plot = self.frame.plot;
        let mut last = [f32::NEG_INFINITY; 2];
        for point in points.iter().filter(|point| point.x >= plot.left() && point.x <= plot.right()) {
            let side = match point.y {
                y if y < plot.top() - 1.0 => 0,
                y if y > plot.bottom() + 1.0 => 1,
                _ => continue,
            };
            if point.x - last[side] < SPACING {
                continue;
            }
            last[side] = point.x;
            let (edge, inward) =
                if side == 0 { (plot.top() + 1.0, 1.0) } else { (plot.bottom() - 1.0, -1.0) };
            let points = vec![
                pos2(point.x, edge),
                pos2(point.x + 5.0, edge + 8.0 * inward),
                pos2(point.x - 5.0, edge + 8.0 * inward),
            ];
            arrows.push(Element::Polygon { points, color });
        }
    }

    /// A numbered mark at each shown channel's zero; at the edge and pointing outwards when that is out of the picture.
    fn zero_marks(&self, around: &mut Vec<Element>) {
        for channel in self.sheet.shown() {
            let color = color_of(self.sheet, self.palette, channel);
            let place = zero_mark(&self.frame, self.sheet, channel);
            around.push(Element::Polygon { points: place.to_vec(), color });
            let at = pos2((place[0].x + place[2].x) * 0.5 - 1.0, (place[0].y + place[4].y) * 0.5);
            let text = (channel + 1).to_string();
            let size = 9.0;
            around.push(Element::Text {
                at,
                anchor: Align2::CENTER_CENTER,
                text,
                size,
                color: self.palette.ground,
                figures: false,
            });
        }
    }

    /// A flag for each mark in view, and a line where there is room.
    fn marks(&self, inside: &mut Vec<Element>, around: &mut Vec<Element>) {
        let mut last: Option<(MarkKind, f32)> = None;
        for mark in self.sheet.track.marks.between(self.frame.start_s, self.frame.end_s) {
            let x = self.frame.x(mark.at_s);
            let color = mark_color(self.palette, mark.kind);
            let crowded = last.is_some_and(|(kind, at)| kind == mark.kind && x - at < 7.0);
            if !crowded {
                let points = [pos2(x, self.frame.plot.top()), pos2(x, self.frame.plot.bottom())];
                inside.push(Element::Dashes { points, color: color.gamma_multiply(0.7), width: 1.0 });
                last = Some((mark.kind, x));
            }
            around.push(Element::Polygon { points: flag(&self.frame, mark).to_vec(), color });
        }
    }

    fn trigger(&self, inside: &mut Vec<Element>, around: &mut Vec<Element>) {
        let settings = self.sheet.trigger.settings();
        if self.sheet.trigger.mode() == TriggerMode::Off {
            return;
        }
        let plot = self.frame.plot;
        let color = match settings.source {
            TriggerSource::Channel(channel) => color_of(self.sheet, self.palette, channel),
            TriggerSource::Command => mark_color(self.palette, MarkKind::Drive),
        };
        if let Some(y) = level_y(&self.frame, self.sheet) {
            inside.push(Element::Dashes {
                points: [pos2(plot.left(), y), pos2(plot.right(), y)],
                color,
                width: 1.0,
            });
            let points = vec![
                pos2(plot.right() + 1.0, y),
                pos2(plot.right() + 8.0, y - 6.0),
                pos2(plot.right() + 15.0, y - 6.0),
                pos2(plot.right() + 15.0, y + 6.0),
                pos2(plot.right() + 8.0, y + 6.0),
            ];
            around.push(Element::Polygon { points, color });
            around.push(Element::Text {
                at: pos2(plot.right() + 11.0, y),
                anchor: Align2::CENTER_CENTER,
                text: "T".to_owned(),
                size: 9.0,
                color: self.palette.ground,
                figures: false,
            });
        }
        let x = trigger_x(&self.frame, self.sheet);
        let top = plot.top();
        if let Some(x) = x {
            inside.push(Element::Dashes {
                points: [pos2(x, top), pos2(x, plot.bottom())],
                color,
                width: 1.0,
            });
            let points = vec![
                pos2(x, top),
                pos2(x - 6.0, top - 7.0),
                pos2(x - 6.0, top - 12.0),
                pos2(x + 6.0, top - 12.0),
                pos2(x + 6.0, top - 7.0),
            ];
            around.push(Element::Polygon { points, color });
        }
    }

    fn cursors(&self, inside: &mut Vec<Element>) {
        if !self.sheet.cursors.on {
            return;
        }
        let plot = self.frame.plot;
        for (which, name) in Cursors::NAMES.into_iter().enumerate() {
            let x = self.frame.x(self.sheet.cursor_s(which)).clamp(plot.left(), plot.right());
            let active = self.sheet.cursors.active == which;
            let color = self.palette.accent;
            inside.push(line(
                pos2(x, plot.top()),
                pos2(x, plot.bottom()),
                color,
                if active { 2.0 } else { 1.0 },
            ));
            let rect = Rect::from_center_size(pos2(x, plot.top() + 9.0), vec2(14.0, 14.0));
            let rect = rect.translate(vec2(
                (plot.left() - rect.left()).max(0.0) + (plot.right() - rect.right()).min(0.0),
                0.0,
            ));
            inside.push(Element::Box { rect, color });
            inside.push(Element::Text {
                at: rect.center(),
                anchor: Align2::CENTER_CENTER,
                text: name.to_owned(),
                size: SMALL,
                color: self.palette.ground,
                figures: false,
            });
        }
    }

    fn columns(&self) -> usize {
        (self.frame.plot.width() * self.pixels_per_point).clamp(16.0, 8192.0) as usize
    }

    fn grid_line(&self, from: Pos2, to: Pos2) -> Element {
        line(from, to, self.palette.line.gamma_multiply(0.75), 1.0)
    }

    fn words(&self, at: Pos2, anchor: Align2, text: String, color: Color32) -> Element {
        Element::Text { at, anchor, text, size: SMALL, color, figures: false }
    }
}

fn line(from: Pos2, to: Pos2, color: Color32, width: f32) -> Element {
    Element::Line { points: vec![from, to], color, width }
}

/// A long line is drawn whole: dashes shorter than its own bends would only be noise.
fn dashed(inside: &mut Vec<Element>, points: &[Pos2], color: Color32) {
    if points.len() > 240 || points.len() < 2 {
        inside.extend(line_of(points.to_vec(), color, 1.0));
        return;
    }
    inside.extend(points.windows(2).map(|pair| Element::Dashes {
        points: [pair[0], pair[1]],
        color,
        width: 1.2,
    }));
}

/// The pentagon of a zero mark: two corners at the left, then top right, tip, bottom right.
pub fn zero_mark(frame: &Frame, sheet: &Sheet, channel: usize) -> [Pos2; 5] {
    let plot = frame.plot;
    let wanted =
        sheet.channels.get(channel).map_or(plot.center().y, |c| frame.y(c.scale.part(0.0).clamp(-9.0, 9.0)));
    let y = wanted.clamp(plot.top(), plot.bottom());
    let tip_y = y + (wanted - y).clamp(-5.0, 5.0);
    let (left, right) = (plot.left() - GUTTER + 1.0, plot.left() - 5.0);
    [
        pos2(left, y - 5.5),
        pos2(right, y - 5.5),
        pos2(plot.left(), tip_y),
        pos2(right, y + 5.5),
        pos2(left, y + 5.5),
    ]
}

/// Where the trigger's level lies, if it is of a channel.
pub fn level_y(frame: &Frame, sheet: &Sheet) -> Option<f32> {
    let TriggerSource::Channel(channel) = sheet.trigger.settings().source else { return None };
    let part = sheet.channels.get(channel)?.scale.part(sheet.trigger.settings().level);
    Some(frame.y(part).clamp(frame.plot.top(), frame.plot.bottom()))
}

/// Where the trigger lies in time: at the shot in view, or where the next one will be.
pub fn trigger_x(frame: &Frame, sheet: &Sheet) -> Option<f32> {
    let at = match (sheet.shot_s(), sheet.is_held()) {
        (Some(shot_s), _) => frame.x(shot_s),
        (None, true) => return None,
        (None, false) => frame.plot.left() + sheet.trigger.settings().pre as f32 * frame.plot.width(),
    };
    (frame.plot.left()..=frame.plot.right()).contains(&at).then_some(at)
}

/// The triangle of a mark's flag, with its foot on the plot's upper edge.
pub fn flag(frame: &Frame, mark: &Mark) -> [Pos2; 3] {
    let (x, top) = (frame.x(mark.at_s), frame.plot.top());
    match mark.kind {
        MarkKind::Stop => [pos2(x, top), pos2(x - 5.0, top - 9.0), pos2(x + 5.0, top - 9.0)],
        MarkKind::Drive | MarkKind::Arm | MarkKind::Setting | MarkKind::Note => {
            [pos2(x, top), pos2(x, top - 10.0), pos2(x + 8.0, top - 6.0)]
        }
    }
}

pub fn mark_color(palette: &Palette, kind: MarkKind) -> Color32 {
    match kind {
        MarkKind::Drive => palette.accent,
        MarkKind::Stop => palette.error,
        MarkKind::Arm => palette.warning,
        MarkKind::Setting => palette.ok,
        MarkKind::Note => palette.text,
    }
}

/// A label's name without the motor's: there is little room.
fn short(label: &str) -> &str {
    if label.chars().count() > 9 { label.split_once(' ').map_or(label, |(_, rest)| rest) } else { label }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::track::{ChannelInfo, Track};

    /// Ten seconds of one channel within the scale of -1 to 1, drawn into 600 by 300 points.
    fn drawn(value: impl Fn(f64) -> f64) -> (Frame, Picture) {
        let info = ChannelInfo {
            key: "x".to_owned(),
            label: "X".to_owned(),
            unit: "A".to_owned(),
            decimals: 1,
            scale: Scale::around_zero(1.0),
            shown: true,
            is_pin: false,
        };
        let mut track = Track::new(vec![info], 2000);
        for row in 0..=1000 {
            let time_s = f64::from(row) * 0.01;
            track.push(time_s, &[value(time_s)], |_| time_s);
        }
        let sheet = Sheet::new(track);
        let frame = Frame::new(Rect::from_min_max(pos2(0.0, 0.0), pos2(600.0, 300.0)), sheet.window());
        let scene = Scene {
            sheet: &sheet,
            runs: &[],
            align: Align::Start,
            palette: Palette::of_theme(egui::Theme::Dark),
            frame,
            pixels_per_point: 1.0,
            is_recording: false,
        };
        (frame, scene.picture())
    }

    /// The tips of the triangles at the upper and at the lower edge of the plot.
    fn arrows(frame: &Frame, picture: &Picture) -> [Vec<Pos2>; 2] {
        let mut found = [Vec::new(), Vec::new()];
        for element in &picture[2].elements {
            let Element::Polygon { points, .. } = element else { continue };
            let up = points[1].y > points[0].y;
            let edge = if up { frame.plot.top() + 1.0 } else { frame.plot.bottom() - 1.0 };
            assert_eq!(points[0].y, edge, "the tip points out of the picture: {points:?}");
            found[usize::from(!up)].push(points[0]);
        }
        found
    }

    #[test]
    fn an_arrow_points_to_where_a_line_leaves_the_picture() {
        let (frame, picture) = drawn(|time_s| if (4.0..4.2).contains(&time_s) { 7.0 } else { 0.5 });
        let [above, below] = arrows(&frame, &picture);
        assert_eq!((above.len(), below.len()), (1, 0));
        assert!((above[0].x - frame.x(4.0)).abs() < 3.0, "{above:?}");

        let (frame, picture) = drawn(|time_s| if time_s < 5.0 { -3.0 } else { 0.0 });
        let [above, below] = arrows(&frame, &picture);
        assert!(above.is_empty() && below.len() > 4, "{below:?}");
        assert!(below.iter().all(|tip| tip.x <= frame.x(5.1)), "{below:?}");
        assert!(
            below.windows(2).all(|pair| pair[1].x - pair[0].x >= SPACING),
            "not a row of spikes: {below:?}"
        );
    }

    #[test]
    fn a_line_inside_the_picture_has_no_arrow_and_one_spike_alone_has_one() {
        let (frame, picture) = drawn(f64::sin);
        assert_eq!(arrows(&frame, &picture), [Vec::new(), Vec::new()]);
        let (frame, picture) = drawn(|time_s| if (time_s - 6.0).abs() < 0.005 { -9.0 } else { 0.1 });
        let [above, below] = arrows(&frame, &picture);
        assert_eq!((above.len(), below.len()), (0, 1));
    }
}
