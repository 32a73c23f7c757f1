//! The live graph's state: what was sampled, what is shown and how.

use std::cell::RefCell;

use super::history::{DEFAULT_ROWS, History};
use super::memo::Memo;
use super::scale::Scale;
use super::trace::{Columns, Trace, View};

/// Stretches of time the graph can show, in seconds.
pub const SPANS_S: [f64; 6] = [5.0, 10.0, 30.0, 60.0, 600.0, 3600.0];

/// A pause in the samples of more than this many usual intervals is lost data.
const LOST_INTERVALS: f64 = 5.0;

/// What a channel is, fixed for the life of a graph.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelInfo {
    pub label: &'static str,
    pub unit: &'static str,
    /// Digits after the point of its readout.
    pub decimals: usize,
    pub scale: Scale,
    /// Whether it is shown at first.
    pub shown: bool,
}

/// How one channel is shown.
#[derive(Clone, Debug)]
pub struct ChannelView {
    pub info: ChannelInfo,
    pub shown: bool,
    pub scale: Scale,
    /// The newest value read.
    pub latest: Option<f64>,
    /// Nothing before this time is drawn.
    cleared_at_s: f64,
}

/// The graph's state.
#[derive(Clone, Debug)]
pub struct LiveGraph {
    history: History,
    memos: RefCell<Vec<Memo>>,
    pub channels: Vec<ChannelView>,
    /// The channel whose scale is written at the side.
    pub selected: usize,
    pub span_s: f64,
    /// The right edge while the picture is held; recording goes on.
    held_at_s: Option<f64>,
    usual_interval_s: f64,
}

impl LiveGraph {
    /// An empty graph for samples that come about every `interval_s`.
    pub fn new(channels: Vec<ChannelInfo>, interval_s: f64) -> Self {
        let history = History::new(channels.len(), DEFAULT_ROWS);
        let view = |info: ChannelInfo| ChannelView {
            shown: info.shown,
            scale: info.scale,
            latest: None,
            cleared_at_s: f64::NEG_INFINITY,
            info,
        };
        let channels: Vec<_> = channels.into_iter().map(view).collect();
        let selected = channels.iter().position(|channel| channel.shown).unwrap_or(0);
        let memos = RefCell::new(vec![Memo::default(); channels.len()]);
        Self {
            history,
            memos,
            channels,
            selected,
            span_s: 10.0,
            held_at_s: None,
            usual_interval_s: interval_s,
        }
    }

    /// Adds a sample; NaN is a channel that was not read.
    pub fn push(&mut self, time_s: f64, values: &[f64]) {
        if let Some(last) = self.history.last_time_s() {
            let pause_s = time_s - last;
            if pause_s > LOST_INTERVALS * self.usual_interval_s {
                self.history.push_gap(last + self.usual_interval_s);
            }
        }
        self.history.push(time_s, values);
        for (channel, value) in self.channels.iter_mut().zip(values).filter(|(_, value)| value.is_finite()) {
            channel.latest = Some(*value);
            channel.scale.include(*value);
        }
    }

    /// Samples now come about every `interval_s`.
    pub fn set_interval(&mut self, interval_s: f64) {
        self.usual_interval_s = interval_s;
    }

    /// Marks lost data at the end, so that what comes next is not joined to what was.
    pub fn push_gap(&mut self) {
        if let Some(last) = self.history.last_time_s() {
            self.history.push_gap(last);
        }
        self.channels.iter_mut().for_each(|channel| channel.latest = None);
    }

    pub fn history(&self) -> &History {
        &self.history
    }

    /// Memory held for what was sampled, in bytes.
    pub fn bytes(&self) -> usize {
        self.history.bytes() + self.memos.borrow().iter().map(Memo::bytes).sum::<usize>()
    }

    pub fn is_held(&self) -> bool {
        self.held_at_s.is_some()
    }

    /// Holds the picture, or follows the newest sample again.
    pub fn hold(&mut self, hold: bool) {
        self.held_at_s = if hold { self.history.last_time_s() } else { None };
    }

    /// The time at the right edge.
    pub fn end_s(&self) -> f64 {
        self.held_at_s.or(self.history.last_time_s()).unwrap_or(0.0)
    }

    pub fn view(&self, columns: usize) -> View {
        let end_s = self.end_s();
        View { start_s: end_s - self.span_s, end_s, columns }
    }

    /// Stops drawing what a channel has shown so far.
    pub fn clear(&mut self, channel: usize) {
        let now = self.history.last_time_s().unwrap_or(f64::NEG_INFINITY);
        if let Some(channel) = self.channels.get_mut(channel) {
            channel.cleared_at_s = now;
        }
    }

    pub fn clear_all(&mut self) {
        (0..self.channels.len()).for_each(|channel| self.clear(channel));
    }

    /// Sets a channel's scale to what of it is in view; without anything in view, to where it began.
    pub fn fit(&mut self, channel: usize) {
        let view = self.view(1);
        let drawn_from_s = view.start_s.max(self.channels[channel].cleared_at_s.next_up());
        let rows = self.history.row_at(drawn_from_s)..self.history.row_at(view.end_s.next_up());
        let seen = self.history.channel(channel).extrema(rows.start..rows.end.max(rows.start));
        let channel = &mut self.channels[channel];
        let least_division = 10f64.powi(-(channel.info.decimals as i32));
        channel.scale = match seen.is_empty() {
            true => channel.info.scale,
            false => Scale::fitting(seen.min, seen.max, least_division),
        };
    }

    pub fn fit_shown(&mut self) {
        for index in 0..self.channels.len() {
            if self.channels[index].shown {
                self.fit(index);
            }
        }
    }

    /// The lines of a channel, with times from the right edge (negative) and heights from 0 to 1.
    pub fn lines(&self, channel: usize, columns: &Columns) -> Vec<Vec<[f64; 2]>> {
        let end_s = self.end_s();
        let view = &self.channels[channel];
        let memo = &mut self.memos.borrow_mut()[channel];
        memo.make_room(columns.count());
        let mut trace = Trace::remembering(&self.history, channel, columns, memo);
        for line in &mut trace.lines {
            line.retain(|point| point[0] > view.cleared_at_s);
            for point in line.iter_mut() {
                *point = [point[0] - end_s, view.scale.part(point[1])];
            }
        }
        trace.lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph() -> LiveGraph {
        let info = ChannelInfo {
            label: "M1 PWM",
            unit: "%",
            decimals: 1,
            scale: Scale::around_zero(100.0),
            shown: true,
        };
        LiveGraph::new(vec![info], 0.1)
    }

    fn filled() -> LiveGraph {
        let mut graph = graph();
        for tick in 0..50 {
            graph.push(f64::from(tick) * 0.1, &[f64::from(tick)]);
        }
        graph
    }

    fn points(graph: &LiveGraph) -> Vec<[f64; 2]> {
        let columns = Columns::new(graph.history(), &graph.view(1000));
        graph.lines(0, &columns).concat()
    }

    #[test]
    fn the_newest_sample_lies_at_the_right_edge() {
        let points = points(&filled());
        assert_eq!(points.len(), 50);
        assert_eq!(points[49], [0.0, Scale::around_zero(100.0).part(49.0)]);
    }

    #[test]
    fn a_held_picture_stays_while_recording_goes_on() {
        let mut graph = filled();
        graph.hold(true);
        let before = points(&graph);
        graph.push(5.0, &[99.0]);
        assert_eq!(points(&graph)[..50], before[..]);
        graph.hold(false);
        assert_eq!(points(&graph)[50][0], 0.0);
    }

    #[test]
    fn clearing_hides_the_past_and_shows_what_comes() {
        let mut graph = filled();
        graph.clear(0);
        assert!(points(&graph).is_empty());
        graph.push(5.0, &[1.0]);
        assert_eq!(points(&graph).len(), 1);
    }

    #[test]
    fn a_pause_in_the_samples_breaks_the_line() {
        let mut graph = filled();
        graph.push(7.0, &[1.0]);
        let columns = Columns::new(graph.history(), &graph.view(1000));
        assert_eq!(graph.lines(0, &columns).len(), 2);
    }

    #[test]
    fn fitting_takes_the_scale_from_what_is_in_view() {
        let mut graph = filled();
        graph.fit(0);
        let scale = graph.channels[0].scale;
        assert!(scale.low <= 0.0 && scale.high >= 49.0 && scale.high <= 80.0, "{scale:?}");
        graph.clear(0);
        graph.push(5.0, &[f64::NAN]);
        graph.fit(0);
        assert_eq!(graph.channels[0].scale, Scale::around_zero(100.0));
    }
}
