//! A track and how it is looked at: which stretch of time, which channels, each with its own scale; cursors, trigger.
//!
//! The picture follows the newest sample, or stands where a trigger or a person holds it. Nothing here stops
//! sampling.

use std::cell::RefCell;

use super::cursors::{Cursors, Measure};
use super::memo::Memo;
use super::scale::Scale;
use super::trace::{Columns, Trace, View};
use super::track::{ChannelInfo, Track};
use super::trigger::{Trigger, TriggerMode, TriggerSettings, TriggerSource, first_crossing_s};

/// Stretches of time that zooming steps through, in seconds. Ten seconds have Ion Studio's divisions of one second.
pub const SPANS_S: [f64; 17] =
    [0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0];

/// The shortest and longest stretch of time that can be looked at.
const SPAN_RANGE_S: (f64, f64) = (0.002, 100_000.0);

/// How one channel is shown.
#[derive(Clone, Debug)]
pub struct ChannelView {
    pub info: ChannelInfo,
    pub shown: bool,
    pub scale: Scale,
    /// Whether the scale grows by itself when a value does not fit.
    pub grows: bool,
    /// Place of its colour among the theme's, chosen by hand; else its own place.
    pub color: Option<usize>,
    /// The newest value read.
    pub latest: Option<f64>,
    /// Nothing before this time is drawn.
    pub cleared_at_s: f64,
}

impl ChannelView {
    pub fn new(info: ChannelInfo) -> Self {
        Self {
            shown: info.shown,
            scale: info.scale,
            grows: true,
            color: None,
            latest: None,
            cleared_at_s: f64::NEG_INFINITY,
            info,
        }
    }

    /// A value of this channel with its unit.
    pub fn text(&self, value: Option<f64>) -> String {
        let Some(value) = value else { return "–".to_owned() };
        let decimals = self.info.decimals;
        let factor = 10f64.powi(decimals as i32);
        let value = (value * factor).round() / factor + 0.0;
        format!("{value:.decimals$} {}", self.info.unit).trim_end().to_owned()
    }
}

/// A track and how it is looked at.
#[derive(Debug)]
pub struct Sheet {
    pub track: Track,
    pub channels: Vec<ChannelView>,
    /// The channel whose scale is written at the side, and that keys and the wheel change.
    pub selected: usize,
    pub trigger: Trigger,
    pub cursors: Cursors,
    /// Where it begins, if it is a whole recording and not what comes in: earlier runs are laid on that, wherever the picture stands.
    pub whole_from_s: Option<f64>,
    span_s: f64,
    held_end_s: Option<f64>,
    memos: RefCell<Vec<Memo>>,
}

impl Sheet {
    pub fn new(track: Track) -> Self {
        let channels: Vec<_> = track.channels.iter().cloned().map(ChannelView::new).collect();
        let selected = channels.iter().position(|channel| channel.shown).unwrap_or(0);
        Self {
            memos: RefCell::new(vec![Memo::default(); channels.len()]),
            track,
            channels,
            selected,
            trigger: Trigger::new(TriggerSource::Channel(selected)),
            cursors: Cursors::default(),
            whole_from_s: None,
            span_s: 10.0,
            held_end_s: None,
        }
    }

    // ---- the stretch of time in view ----

    pub fn newest_s(&self) -> f64 {
        self.track.history.last_time_s().unwrap_or(0.0)
    }

    pub fn span_s(&self) -> f64 {
        self.span_s
    }

    /// The left and the right edge.
    pub fn window(&self) -> (f64, f64) {
        if let Some(end_s) = self.held_end_s {
            return (end_s - self.span_s, end_s);
        }
        if let Some(shot_s) = self.shot_s() {
            let start_s = shot_s - self.trigger.settings().pre * self.span_s;
            return (start_s, start_s + self.span_s);
        }
        (self.newest_s() - self.span_s, self.newest_s())
    }

    /// The moment of the trigger that the picture stands at.
    pub fn shot_s(&self) -> Option<f64> {
        self.trigger.shown_s(self.newest_s(), self.span_s)
    }

    pub fn view(&self, columns: usize) -> View {
        let (start_s, end_s) = self.window();
        View { start_s, end_s, columns }
    }

    /// The time that the axis calls zero: the newest sample, the trigger, or the first sample of all.
    pub fn origin_s(&self) -> f64 {
        if self.is_held() {
            return self.shot_s().unwrap_or(self.track.began_s.unwrap_or(0.0));
        }
        self.shot_s().unwrap_or(self.newest_s())
    }

    pub fn is_held(&self) -> bool {
        self.held_end_s.is_some()
    }

    /// Holds the picture; sampling goes on.
    pub fn hold(&mut self) {
        if self.held_end_s.is_none() {
            let picture = self.window();
            self.cursors.turn(picture, false);
            self.held_end_s = Some(picture.1);
        }
    }

    /// Follows the newest sample again, or the trigger.
    pub fn follow(&mut self) {
        if self.held_end_s.take().is_some() {
            let picture = self.window();
            self.cursors.turn(picture, true);
        }
    }

    pub fn set_span_s(&mut self, span_s: f64) {
        let middle = self.is_held().then_some(0.5);
        self.zoom(span_s / self.span_s, middle);
    }

    /// Looks at `factor` times as much time. What is at part `about` of the width stays there, if the picture is held.
    pub fn zoom(&mut self, factor: f64, about: Option<f64>) {
        let (start_s, end_s) = self.window();
        let span_s = (self.span_s * factor).clamp(SPAN_RANGE_S.0, SPAN_RANGE_S.1);
        if !span_s.is_finite() {
            return;
        }
        if self.is_held() {
            let about = about.unwrap_or(0.5).clamp(0.0, 1.0);
            let fixed_s = start_s + about * (end_s - start_s);
            self.held_end_s = Some(fixed_s + (1.0 - about) * span_s);
        }
        self.span_s = span_s;
        self.keep_near_samples();
    }

    /// The next longer or shorter stretch of [`SPANS_S`].
    pub fn zoom_step(&mut self, closer: bool) {
        let now = self.span_s;
        let next = match closer {
            true => SPANS_S.into_iter().rev().find(|span| *span < now * 0.999),
            false => SPANS_S.into_iter().find(|span| *span > now * 1.001),
        };
        if let Some(next) = next {
            self.set_span_s(next);
        }
    }

    /// Moves the picture by time, later for a positive one; holds it.
    pub fn pan(&mut self, by_s: f64) {
        self.hold();
        self.held_end_s = self.held_end_s.map(|end_s| end_s + by_s);
        self.keep_near_samples();
    }

    /// Shows exactly this stretch, held.
    pub fn look_at(&mut self, start_s: f64, end_s: f64) {
        self.hold();
        self.span_s = (end_s - start_s).clamp(SPAN_RANGE_S.0, SPAN_RANGE_S.1);
        self.held_end_s = Some(start_s + self.span_s);
    }

    /// Shows everything that is kept.
    pub fn look_at_all(&mut self) {
        if let (Some(first_s), Some(last_s)) =
            (self.track.history.first_time_s(), self.track.history.last_time_s())
        {
            let margin_s = (last_s - first_s).max(0.01) * 0.01;
            self.look_at(first_s - margin_s, last_s + margin_s);
        }
    }

    /// To the oldest sample that is kept.
    pub fn look_at_oldest(&mut self) {
        let first_s = self.track.history.first_time_s().unwrap_or(0.0);
        self.look_at(first_s, first_s + self.span_s);
    }

    /// To the next moment that the trigger's condition is met after the one in view.
    pub fn look_for_trigger(&mut self) -> bool {
        let TriggerSource::Channel(channel) = self.trigger.settings().source else { return false };
        let (start_s, end_s) = self.window();
        let settings = *self.trigger.settings();
        let here_s = start_s + settings.pre * (end_s - start_s) + 1e-6;
        let Some(at_s) = first_crossing_s(&self.track, channel, &settings, here_s) else { return false };
        let start_s = at_s - settings.pre * self.span_s;
        self.look_at(start_s, start_s + self.span_s);
        true
    }

    /// Some of what is kept stays in view.
    fn keep_near_samples(&mut self) {
        let Some(end_s) = self.held_end_s else { return };
        let (first_s, last_s) = (self.track.history.first_time_s().unwrap_or(0.0), self.newest_s());
        let edge_s = self.span_s * 0.05;
        self.held_end_s = Some(end_s.clamp(first_s + edge_s, last_s + self.span_s - edge_s));
    }

    // ---- cursors ----

    pub fn cursor_s(&self, which: usize) -> f64 {
        self.cursors.at_s(which, self.window())
    }

    pub fn set_cursor(&mut self, which: usize, time_s: f64) {
        self.cursors.set(which, time_s, self.window(), !self.is_held());
    }

    /// Moves the active cursor by a part of the width.
    pub fn step_cursor(&mut self, by: f64) {
        let which = self.cursors.active;
        self.set_cursor(which, self.cursor_s(which) + by * self.span_s);
    }

    /// Shows or hides the cursors; where neither is in view, both come back into it.
    pub fn show_cursors(&mut self, on: bool) {
        self.cursors.on = on;
        let (start_s, end_s) = self.window();
        let in_view = |which| (start_s..=end_s).contains(&self.cursor_s(which));
        if on && !(in_view(0) || in_view(1)) {
            self.cursors.gather((start_s, end_s), !self.is_held());
        }
    }

    pub fn measure(&self, channel: usize) -> Measure {
        let at_s = [self.cursor_s(0), self.cursor_s(1)];
        let from_s = self.channels[channel].cleared_at_s.next_up();
        Measure::of(&self.track.history, channel, at_s, from_s)
    }

    // ---- channels ----

    /// Turns to other channels. Those that were there before keep their samples and how they are shown.
    pub fn set_channels(&mut self, channels: Vec<ChannelInfo>) {
        let before: Vec<Option<usize>> =
            channels.iter().map(|info| self.track.channel_of_key(&info.key)).collect();
        let now = |old: usize| before.iter().position(|kept| *kept == Some(old)).unwrap_or(0);
        self.selected = now(self.selected);
        let trigger = *self.trigger.settings();
        if let TriggerSource::Channel(channel) = trigger.source {
            self.trigger.set(TriggerSettings { source: TriggerSource::Channel(now(channel)), ..trigger });
        }
        let view = |(info, old): (&ChannelInfo, &Option<usize>)| {
            old.map_or_else(|| ChannelView::new(info.clone()), |old| self.channels[old].clone())
        };
        self.channels = channels.iter().zip(&before).map(view).collect();
        self.memos = RefCell::new(vec![Memo::default(); channels.len()]);
        self.track.history.take_channels(&before);
        self.track.channels = channels;
    }

    /// Stops drawing what a channel has shown so far.
    pub fn clear(&mut self, channel: usize) {
        let now_s = self.track.history.last_time_s().unwrap_or(f64::NEG_INFINITY);
        if let Some(channel) = self.channels.get_mut(channel) {
            channel.cleared_at_s = now_s;
        }
    }

    pub fn clear_all(&mut self) {
        (0..self.channels.len()).for_each(|channel| self.clear(channel));
    }

    /// Draws what was cleared again.
    pub fn restore_cleared(&mut self) {
        self.channels.iter_mut().for_each(|channel| channel.cleared_at_s = f64::NEG_INFINITY);
    }

    /// Sets a channel's scale to what of it is in view; without anything in view, to where it began.
    pub fn fit(&mut self, channel: usize) {
        let (start_s, end_s) = self.window();
        let from_s = start_s.max(self.channels[channel].cleared_at_s.next_up());
        let (seen, _) = self.track.history.summary(channel, from_s, end_s);
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

    /// Sets a channel's scale by hand: it does not grow by itself any more.
    pub fn set_scale(&mut self, channel: usize, scale: Scale) {
        if let Some(channel) = self.channels.get_mut(channel).filter(|_| scale.is_sound()) {
            channel.scale = scale;
            channel.grows = false;
        }
    }

    /// Shown channels, the selected one last, so that it is drawn on top.
    pub fn shown(&self) -> Vec<usize> {
        let others = (0..self.channels.len()).filter(|index| *index != self.selected);
        others
            .chain([self.selected])
            .filter(|index| self.channels.get(*index).is_some_and(|c| c.shown))
            .collect()
    }

    /// The unbroken lines of a channel, each point a time and a value.
    pub fn lines(&self, channel: usize, columns: &Columns) -> Vec<Vec<[f64; 2]>> {
        let memo = &mut self.memos.borrow_mut()[channel];
        memo.make_room(columns.count());
        let mut trace = Trace::remembering(&self.track.history, channel, columns, memo);
        let cleared_at_s = self.channels[channel].cleared_at_s;
        if cleared_at_s > f64::NEG_INFINITY {
            trace.lines.iter_mut().for_each(|line| line.retain(|point| point[0] > cleared_at_s));
        }
        trace.lines
    }

    /// A trigger that is off watches the channel that is selected, once it is switched on.
    pub fn watch_selected(&mut self) {
        let settings = *self.trigger.settings();
        let watches_channel = matches!(settings.source, TriggerSource::Channel(_));
        if self.trigger.mode() == TriggerMode::Off && watches_channel {
            self.trigger.set(TriggerSettings { source: TriggerSource::Channel(self.selected), ..settings });
        }
    }

    /// What the trigger has to say.
    pub fn trigger_state(&self) -> Option<&'static str> {
        match (self.trigger.mode(), self.shot_s()) {
            (TriggerMode::Off, _) => None,
            _ if self.trigger.is_spent() => Some("Triggered: single shot taken"),
            (_, Some(_)) => Some("Triggered"),
            (_, None) => Some("Waiting for the trigger"),
        }
    }

    /// Memory held for what was sampled, in bytes.
    pub fn bytes(&self) -> usize {
        self.track.history.bytes() + self.memos.borrow().iter().map(Memo::bytes).sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn filled() -> Sheet {
        let info = ChannelInfo {
            key: "m1_pwm".to_owned(),
            label: "M1 PWM".to_owned(),
            unit: "%".to_owned(),
            decimals: 1,
            scale: Scale::around_zero(100.0),
            shown: true,
            is_pin: false,
        };
        let mut sheet = Sheet::new(Track::new(vec![info], 4000));
        for tick in 0..1000 {
            sheet.track.push(f64::from(tick) * 0.1, &[f64::from(tick % 50)], |_| f64::from(tick) * 0.1);
        }
        sheet
    }

    #[test]
    fn the_picture_follows_is_held_and_comes_back() {
        let mut sheet = filled();
        assert_eq!(sheet.window(), (sheet.newest_s() - 10.0, sheet.newest_s()));
        sheet.pan(-50.0);
        let held = sheet.window();
        sheet.track.push(200.0, &[1.0], |_| 200.0);
        assert_eq!(sheet.window(), held);
        sheet.follow();
        assert_eq!(sheet.window(), (190.0, 200.0));
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer_and_following_keeps_the_newest() {
        let mut sheet = filled();
        sheet.zoom(0.5, Some(0.2));
        assert_eq!(sheet.window(), (sheet.newest_s() - 5.0, sheet.newest_s()));
        sheet.look_at(40.0, 60.0);
        sheet.zoom(0.5, Some(0.25));
        assert_eq!(sheet.window(), (42.5, 52.5));
        sheet.zoom_step(false);
        assert_eq!(sheet.span_s(), 20.0);
        sheet.zoom_step(true);
        assert_eq!(sheet.span_s(), 10.0);
    }

    #[test]
    fn clearing_hides_the_past_and_restoring_brings_it_back() {
        let mut sheet = filled();
        let points = |sheet: &Sheet| {
            let columns = Columns::new(&sheet.track.history, &sheet.view(1000));
            sheet.lines(0, &columns).concat().len()
        };
        let before = points(&sheet);
        sheet.clear(0);
        assert_eq!(points(&sheet), 0);
        sheet.restore_cleared();
        assert_eq!(points(&sheet), before);
    }

    #[test]
    fn fitting_takes_the_scale_from_what_is_in_view() {
        let mut sheet = filled();
        sheet.fit(0);
        let scale = sheet.channels[0].scale;
        assert!(scale.low <= 0.0 && scale.high >= 49.0 && scale.high <= 80.0, "{scale:?}");
        sheet.clear(0);
        sheet.fit(0);
        assert_eq!(sheet.channels[0].scale, Scale::around_zero(100.0));
    }

    #[test]
    fn the_next_trigger_is_looked_for_in_what_was_sampled() {
        let mut sheet = filled();
        let settings = *sheet.trigger.settings();
        sheet.trigger.set(TriggerSettings { level: 25.0, ..settings });
        sheet.look_at_oldest();
        assert!(sheet.look_for_trigger());
        let (start_s, _) = sheet.window();
        assert!((start_s + 2.0 - 2.5).abs() < 1e-6, "{start_s}");
        assert!(sheet.look_for_trigger());
        assert!((sheet.window().0 + 2.0 - 7.5).abs() < 1e-6);
    }

    proptest! {
        #![proptest_config(proptest::test_runner::Config {
            rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED),
            failure_persistence: None,
            ..proptest::test_runner::Config::default()
        })]

        #[test]
        fn wherever_it_is_moved_some_of_the_samples_stay_in_view(
            moves in prop::collection::vec((0u8..3, -1e4..1e4f64), 1..60),
        ) {
            let mut sheet = filled();
            for (kind, by) in moves {
                match kind {
                    0 => sheet.pan(by),
                    1 => sheet.zoom((by / 2000.0).exp(), Some(0.3)),
                    _ => sheet.zoom_step(by > 0.0),
                }
                let (start_s, end_s) = sheet.window();
                prop_assert!(start_s < end_s);
                prop_assert!(start_s < 99.9 && end_s > 0.0, "{start_s} to {end_s}");
            }
        }
    }
}
