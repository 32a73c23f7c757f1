//! The graph of one link: what its samples look like, earlier runs beneath them, and a recording that is looked at
//! instead, while sampling goes on.

use super::files::{GraphFiles, Stopping};
use super::history::DEFAULT_ROWS;
use super::rate::Rate;
use super::runs::{Align, Run};
use super::series::GAP;
use super::track::ChannelInfo;
use super::{Mark, MarkKind, Sheet, Track, TriggerMode, TriggerSource};
use crate::graph::messages::GraphBarMessage;
use brushwork_link::{FamilyRef, Message};

/// A channel that was read in each of this many samples and then in as many not has lost data.
const MISSED_SAMPLES: u64 = 20;

/// The graph of one link.
#[derive(Debug)]
pub struct LiveGraph {
    pub live: Sheet,
    /// A recording that is looked at.
    pub opened: Option<Opened>,
    /// Earlier runs, drawn beneath.
    pub runs: Vec<Run>,
    pub align: Align,
    pub rate: Rate,
    /// The graph takes the whole screen.
    pub large: bool,
    /// The graph stands in a window of its own.
    pub detached: bool,
    /// The channels of the legend that stands in the plot while the list beside it is folded away.
    pub legend: Option<Vec<usize>>,
    /// The family of the unit, by which its screens are called.
    pub family: Option<FamilyRef>,
    /// Input pins of the unit, for the list.
    pub pins: usize,
    /// Folders, names, dialogs, and what is being read and written.
    pub files: GraphFiles,
    /// The plot's size when it was drawn last, for pictures of it.
    pub last_plot_size: egui::Vec2,
    /// The sequence number that the next sample should have.
    pub(super) next_sequence: Option<u64>,
    /// Samples since each channel was read, and how many of those is usual.
    silent: Vec<Silence>,
}

/// A recording from a file.
#[derive(Debug)]
pub struct Opened {
    pub name: String,
    pub sheet: Sheet,
    /// When it was made, if the file tells.
    pub began: Option<std::time::SystemTime>,
    /// What the reader should know of it: rows left out, damage.
    pub note: Option<Message>,
    /// So many of its oldest rows did not fit in memory.
    pub left_out: u64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Silence {
    samples: u64,
    usual: u64,
}

impl LiveGraph {
    /// An empty graph for samples that come about every `interval_s`.
    pub fn new(channels: Vec<ChannelInfo>, interval_s: f64) -> Self {
        let silent = vec![Silence::default(); channels.len()];
        Self {
            live: Sheet::new(Track::new(channels, DEFAULT_ROWS)),
            opened: None,
            runs: Vec::new(),
            align: Align::default(),
            rate: Rate::new(interval_s),
            large: false,
            detached: false,
            legend: None,
            family: None,
            pins: 0,
            files: GraphFiles::default(),
            last_plot_size: egui::vec2(800.0, 400.0),
            next_sequence: None,
            silent,
        }
    }

    /// Turns to the channels of another family's controller.
    pub fn set_channels(&mut self, channels: Vec<ChannelInfo>) {
        self.end_recording(Stopping::OtherChannels);
        self.legend = None;
        self.silent = vec![Silence::default(); channels.len()];
        self.live.set_channels(channels);
    }

    /// What is looked at: the recording if one is open, else the live samples.
    pub fn sheet(&self) -> &Sheet {
        self.opened.as_ref().map_or(&self.live, |opened| &opened.sheet)
    }

    pub fn sheet_mut(&mut self) -> &mut Sheet {
        self.opened.as_mut().map_or(&mut self.live, |opened| &mut opened.sheet)
    }

    /// Adds a sample that was read all at once; NaN is a channel that was not read.
    pub fn push(&mut self, time_s: f64, values: &[f64]) {
        self.push_read(time_s, values, |_| time_s);
    }

    /// Adds a sample that was complete at `time_s`; `read_s` tells when each channel was read.
    pub fn push_read(&mut self, time_s: f64, values: &[f64], read_s: impl Fn(usize) -> f64) {
        let last_s = self.live.track.history.last_time_s();
        if self.rate.take(time_s)
            && let Some(last_s) = last_s
        {
            self.gap_at(last_s);
        }
        self.break_silent_channels(values);
        self.live.track.push(time_s, values, &read_s);
        let (span_s, source) = (self.live.span_s(), self.live.trigger.settings().source);
        for (index, (channel, value)) in self.live.channels.iter_mut().zip(values).enumerate() {
            if !value.is_finite() {
                continue;
            }
            channel.latest = Some(*value);
            if channel.grows {
                channel.scale.include(*value);
            }
            if source == TriggerSource::Channel(index) {
                self.live.trigger.feed(read_s(index), *value, span_s);
            }
        }
    }

    /// A channel that is read again after it was missing from many samples is not joined to what was.
    fn break_silent_channels(&mut self, values: &[f64]) {
        let mut broken = Vec::new();
        for (silence, value) in self.silent.iter_mut().zip(values) {
            silence.samples += 1;
            let back = value.is_finite();
            let lost = back && silence.usual > 0 && silence.samples > silence.usual * 5 + MISSED_SAMPLES;
            broken.push(if lost { GAP } else { f64::NAN });
            if back {
                silence.usual = if lost { silence.usual } else { silence.samples };
                silence.samples = 0;
            }
        }
        if let Some(last_s) = self.live.track.history.last_time_s()
            && broken.iter().any(|value| super::series::is_gap(*value))
        {
            self.live.track.push(last_s, &broken, |_| last_s);
        }
    }

    /// Marks lost data at the end, so that what comes next is not joined to what was.
    pub fn push_gap(&mut self) {
        if let Some(last_s) = self.live.track.history.last_time_s() {
            self.gap_at(last_s);
        }
        self.rate.restart();
        self.next_sequence = None;
        self.live.channels.iter_mut().for_each(|channel| channel.latest = None);
        self.silent.fill(Silence::default());
    }

    /// Samples were thrown away before the next one.
    pub fn lost(&mut self, samples: u64) {
        self.rate.lose(samples);
        if let Some(last_s) = self.live.track.history.last_time_s() {
            self.gap_at(last_s);
        }
    }

    fn gap_at(&mut self, time_s: f64) {
        self.live.track.history.push_gap(time_s);
        self.record_gap(time_s);
        self.live.trigger.lost();
    }

    /// Leaves a mark at a time of the link's clock.
    pub fn mark(&mut self, at_s: f64, kind: MarkKind, text: impl Into<String>) {
        if kind == MarkKind::Drive {
            let span_s = self.live.span_s();
            self.live.trigger.command(at_s, span_s);
        }
        let mark = Mark { at_s, kind, text: text.into() };
        self.record_mark(&mark);
        self.live.track.marks.push(mark);
    }

    /// Whether an input pin is shown or triggered on, which are read on request only.
    pub fn wants_pins(&self) -> bool {
        let source = self.live.trigger.settings().source;
        let triggered = |index: usize| {
            source == TriggerSource::Channel(index) && self.live.trigger.mode() != TriggerMode::Off
        };
        let mut channels = self.live.channels.iter().enumerate().filter(|(_, channel)| channel.info.is_pin);
        channels.any(|(index, channel)| channel.shown || triggered(index))
    }

    /// Keeps what is in view as a run beneath, to compare what comes with it.
    pub fn keep_run(&mut self) {
        let sheet = self.sheet();
        let (start_s, end_s) = sheet.window();
        let track = sheet.track.cut(start_s, end_s);
        if !track.history.is_empty() {
            let number = self.runs.len() + 1;
            self.runs.push(Run::new(GraphBarMessage::KeptRun { number }.to_string(), track));
        }
    }

    /// Memory held for what was sampled, in bytes.
    pub fn bytes(&self) -> usize {
        let opened = self.opened.as_ref().map_or(0, |opened| opened.sheet.bytes());
        let runs = self.runs.iter().map(|run| run.track.history.bytes()).sum::<usize>();
        self.live.bytes() + opened + runs
    }
}

#[cfg(test)]
mod tests {
    use super::super::scale::Scale;
    use super::super::trace::Columns;
    use super::super::trigger::TriggerSettings;
    use super::*;

    fn graph() -> LiveGraph {
        let info = |key: &str| ChannelInfo {
            key: key.to_owned(),
            label: key.to_owned(),
            unit: "%".to_owned(),
            decimals: 1,
            scale: Scale::around_zero(100.0),
            shown: true,
            is_pin: false,
        };
        LiveGraph::new(vec![info("one"), info("two")], 0.1)
    }

    fn filled() -> LiveGraph {
        let mut graph = graph();
        for tick in 0..50 {
            graph.push(f64::from(tick) * 0.1, &[f64::from(tick), 1.0]);
        }
        graph
    }

    fn lines(graph: &LiveGraph, channel: usize) -> Vec<Vec<[f64; 2]>> {
        let columns = Columns::new(&graph.live.track.history, &graph.live.view(1000));
        graph.live.lines(channel, &columns)
    }

    #[test]
    fn a_held_picture_stays_while_sampling_goes_on() {
        let mut graph = filled();
        graph.live.hold();
        let before = lines(&graph, 0);
        graph.push(5.0, &[99.0, 1.0]);
        assert_eq!(lines(&graph, 0)[0][..50], before[0][..50]);
        graph.live.follow();
        assert_eq!(lines(&graph, 0)[0][50], [5.0, 99.0]);
    }

    #[test]
    fn a_late_sample_and_a_lost_one_break_the_line_and_are_counted() {
        let mut graph = filled();
        graph.push(7.0, &[1.0, 1.0]);
        assert_eq!((lines(&graph, 0).len(), graph.rate.late), (2, 1));
        graph.lost(3);
        graph.push(7.1, &[1.0, 1.0]);
        assert_eq!((lines(&graph, 0).len(), graph.rate.lost), (3, 3));
    }

    #[test]
    fn a_channel_that_was_not_read_for_long_is_not_joined_to_what_it_was() {
        let mut graph = filled();
        for tick in 50..90 {
            graph.push(f64::from(tick) * 0.1, &[0.0, f64::NAN]);
        }
        graph.push(9.0, &[0.0, 1.0]);
        assert_eq!((lines(&graph, 0).len(), lines(&graph, 1).len()), (1, 2));
    }

    #[test]
    fn a_scale_set_by_hand_does_not_grow() {
        let mut graph = filled();
        graph.live.set_scale(0, Scale::around_zero(10.0));
        graph.push(5.0, &[400.0, 400.0]);
        assert_eq!(graph.live.channels[0].scale, Scale::around_zero(10.0));
        assert_eq!(graph.live.channels[1].scale, Scale::around_zero(500.0));
    }

    #[test]
    fn a_picture_with_a_trigger_stands_at_it() {
        let mut graph = graph();
        let settings = *graph.live.trigger.settings();
        graph.live.trigger.set(TriggerSettings { level: 10.5, pre: 0.1, ..settings });
        graph.live.trigger.set_mode(TriggerMode::Normal);
        for tick in 0..50 {
            graph.push(f64::from(tick) * 0.1, &[f64::from(tick), 1.0]);
        }
        let (start_s, end_s) = graph.live.window();
        assert!((start_s - 0.05).abs() < 1e-9 && (end_s - 10.05).abs() < 1e-9, "{start_s} {end_s}");
        assert!((graph.live.origin_s() - 1.05).abs() < 1e-9);
    }

    #[test]
    fn a_run_is_laid_on_the_present_picture_by_start_command_or_trigger() {
        let mut graph = filled();
        graph.mark(2.0, MarkKind::Drive, "duty");
        graph.keep_run();
        let settings = *graph.live.trigger.settings();
        graph.live.trigger.set(TriggerSettings { level: 30.5, ..settings });
        for tick in 0..60 {
            graph.push(20.0 + f64::from(tick) * 0.1, &[f64::from(tick), 1.0]);
        }
        graph.mark(22.5, MarkKind::Drive, "duty");
        let offset = |align| graph.runs[0].offset_s(&graph.live, align);
        assert!((offset(Align::Command) - 20.5).abs() < 1e-9);
        let (start_s, _) = graph.live.window();
        assert!((offset(Align::Start) - start_s).abs() < 1e-9);
        assert!(
            (offset(Align::Trigger) - (start_s - 3.05)).abs() < 1e-9,
            "no trigger in view: the left edge"
        );
    }
}
