//! The trigger: finds the moment a signal passes a level, or a command was sent, and holds the picture there.
//!
//! What was sampled is always kept; a trigger only decides which part of it is in view. The crossing lies between two
//! readings, where the straight line between them passes the level. Nothing is found across lost data.

use super::track::Track;

/// When the picture is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriggerMode {
    /// The graph follows the newest sample.
    #[default]
    Off,
    /// Like normal; follows the newest sample when nothing happens for a while.
    Auto,
    /// Shows the last time it happened, until it happens again.
    Normal,
    /// Shows the first time it happens and keeps that.
    Single,
}

impl TriggerMode {
    pub const ALL: [Self; 4] = [Self::Off, Self::Auto, Self::Normal, Self::Single];

    pub const fn word(self) -> &'static str {
        match self {
            Self::Off => "Off",
            Self::Auto => "Auto",
            Self::Normal => "Normal",
            Self::Single => "Single",
        }
    }
}

/// Which way the level is passed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Edge {
    #[default]
    Rising,
    Falling,
    Either,
}

impl Edge {
    pub const ALL: [Self; 3] = [Self::Rising, Self::Falling, Self::Either];

    pub const fn word(self) -> &'static str {
        match self {
            Self::Rising => "Rising",
            Self::Falling => "Falling",
            Self::Either => "Either",
        }
    }
}

/// What is waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriggerSource {
    Channel(usize),
    /// A command that moves a motor.
    Command,
}

/// What is waited for, and where it lies in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriggerSettings {
    pub source: TriggerSource,
    pub level: f64,
    pub edge: Edge,
    /// How far the signal has to go back behind the level before it counts again.
    pub hysteresis: f64,
    /// Part of the picture before the trigger, 0 to 1.
    pub pre: f64,
}

/// Looks at one reading after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Watcher {
    last: Option<(f64, f64)>,
    was_below: bool,
    was_above: bool,
}

impl Watcher {
    /// The time of a crossing between the reading before and this one.
    pub fn feed(&mut self, settings: &TriggerSettings, time_s: f64, value: f64) -> Option<f64> {
        let TriggerSettings { level, edge, hysteresis, .. } = *settings;
        let rises = self.was_below && value >= level;
        let falls = self.was_above && value <= level;
        if value >= level {
            self.was_below = false;
        }
        if value <= level {
            self.was_above = false;
        }
        self.was_below |= value < level - hysteresis;
        self.was_above |= value > level + hysteresis;
        let last = self.last.replace((time_s, value));
        let wanted = (rises && edge != Edge::Falling) || (falls && edge != Edge::Rising);
        let (last_s, last_value) = last.filter(|_| wanted)?;
        Some(last_s + (time_s - last_s) * ((level - last_value) / (value - last_value)).clamp(0.0, 1.0))
    }

    /// Data was lost.
    pub fn lost(&mut self) {
        *self = Self::default();
    }
}

/// The trigger of a live graph.
#[derive(Clone, Debug)]
pub struct Trigger {
    mode: TriggerMode,
    settings: TriggerSettings,
    watcher: Watcher,
    shot_s: Option<f64>,
    spent: bool,
}

impl Trigger {
    pub fn new(source: TriggerSource) -> Self {
        let settings = TriggerSettings { source, level: 0.0, edge: Edge::Rising, hysteresis: 0.0, pre: 0.2 };
        let watcher = Watcher::default();
        Self { mode: TriggerMode::Off, settings, watcher, shot_s: None, spent: false }
    }

    pub fn mode(&self) -> TriggerMode {
        self.mode
    }

    /// Also arms again.
    pub fn set_mode(&mut self, mode: TriggerMode) {
        self.mode = mode;
        self.rearm();
        if mode == TriggerMode::Off {
            self.shot_s = None;
        }
    }

    pub fn settings(&self) -> &TriggerSettings {
        &self.settings
    }

    pub fn set(&mut self, settings: TriggerSettings) {
        if settings != self.settings {
            if settings.source != self.settings.source {
                self.watcher.lost();
            }
            self.settings = settings;
        }
    }

    /// Waits for the next time.
    pub fn rearm(&mut self) {
        self.spent = false;
    }

    /// A single shot was taken.
    pub fn is_spent(&self) -> bool {
        self.spent && self.mode == TriggerMode::Single
    }

    /// A reading of the channel that is watched.
    pub fn feed(&mut self, time_s: f64, value: f64, span_s: f64) {
        if let Some(at_s) = self.watcher.feed(&self.settings, time_s, value) {
            self.happened(at_s, span_s);
        }
    }

    /// A motor was told to move.
    pub fn command(&mut self, at_s: f64, span_s: f64) {
        if self.settings.source == TriggerSource::Command {
            self.happened(at_s, span_s);
        }
    }

    pub fn lost(&mut self) {
        self.watcher.lost();
    }

    /// Takes the picture, unless the one before is not full yet.
    fn happened(&mut self, at_s: f64, span_s: f64) {
        let full_s = self.shot_s.map_or(f64::NEG_INFINITY, |shot_s| self.full_at_s(shot_s, span_s));
        if self.mode == TriggerMode::Off || self.spent || at_s < full_s {
            return;
        }
        self.shot_s = Some(at_s);
        self.spent = self.mode == TriggerMode::Single;
    }

    fn full_at_s(&self, shot_s: f64, span_s: f64) -> f64 {
        shot_s + (1.0 - self.settings.pre) * span_s
    }

    /// The moment the picture is held at, if it is.
    pub fn shown_s(&self, newest_s: f64, span_s: f64) -> Option<f64> {
        self.shot_s.filter(|shot_s| match self.mode {
            TriggerMode::Off => false,
            TriggerMode::Auto => newest_s <= self.full_at_s(*shot_s, span_s) + span_s,
            TriggerMode::Normal | TriggerMode::Single => true,
        })
    }
}

/// The first time after `from_s` that a channel passes the trigger's level.
pub fn first_crossing_s(
    track: &Track,
    channel: usize,
    settings: &TriggerSettings,
    from_s: f64,
) -> Option<f64> {
    let mut watcher = Watcher::default();
    for reading in track.readings(channel) {
        match reading {
            None => watcher.lost(),
            Some((time_s, value)) => {
                if let Some(at_s) = watcher.feed(settings, time_s, value).filter(|at_s| *at_s > from_s) {
                    return Some(at_s);
                }
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn settings(level: f64, edge: Edge, hysteresis: f64) -> TriggerSettings {
        TriggerSettings { source: TriggerSource::Channel(0), level, edge, hysteresis, pre: 0.2 }
    }

    fn crossings(settings: &TriggerSettings, values: &[f64]) -> Vec<f64> {
        let mut watcher = Watcher::default();
        let fed = values.iter().enumerate().filter_map(|(i, value)| watcher.feed(settings, i as f64, *value));
        fed.collect()
    }

    #[test]
    fn a_step_is_found_where_the_line_passes_the_level() {
        let step = [0.0, 0.0, 10.0, 10.0, 0.0];
        assert_eq!(crossings(&settings(5.0, Edge::Rising, 0.0), &step), [1.5]);
        assert_eq!(crossings(&settings(2.5, Edge::Falling, 0.0), &step), [3.75]);
        assert_eq!(crossings(&settings(5.0, Edge::Either, 0.0), &step), [1.5, 3.5]);
        assert_eq!(crossings(&settings(11.0, Edge::Either, 0.0), &step), [0.0; 0]);
    }

    #[test]
    fn a_signal_that_begins_on_the_other_side_or_only_touches_does_not_count_twice() {
        assert_eq!(crossings(&settings(0.0, Edge::Rising, 0.0), &[5.0, 6.0, -1.0, 0.0, 0.0, 1.0]), [3.0]);
        assert_eq!(crossings(&settings(0.0, Edge::Falling, 0.0), &[1.0, 0.0, 0.0, -1.0]), [1.0]);
    }

    #[test]
    fn noise_on_a_slow_slope_counts_once_with_hysteresis() {
        let noisy: Vec<f64> =
            (0..200).map(|i| f64::from(i) * 0.1 + if i % 2 == 0 { 0.4 } else { -0.4 }).collect();
        assert!(crossings(&settings(10.0, Edge::Rising, 0.0), &noisy).len() > 1);
        assert_eq!(crossings(&settings(10.0, Edge::Rising, 1.0), &noisy).len(), 1);
    }

    #[test]
    fn nothing_is_found_across_lost_data() {
        let settings = settings(5.0, Edge::Rising, 0.0);
        let mut watcher = Watcher::default();
        assert_eq!(watcher.feed(&settings, 0.0, 0.0), None);
        watcher.lost();
        assert_eq!(watcher.feed(&settings, 1.0, 10.0), None);
    }

    proptest! {
        #![proptest_config(proptest::test_runner::Config {
            rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED),
            failure_persistence: None,
            ..proptest::test_runner::Config::default()
        })]

        #[test]
        fn without_hysteresis_every_pair_of_readings_on_either_side_is_a_crossing(
            values in prop::collection::vec(prop_oneof![Just(-1.0), Just(1.0), -2.0..2.0f64], 1..200),
        ) {
            let found = crossings(&settings(0.5, Edge::Rising, 0.0), &values);
            let pairs = values.windows(2).enumerate().filter(|(_, pair)| pair[0] < 0.5 && pair[1] >= 0.5);
            let wanted: Vec<usize> = pairs.map(|(i, _)| i).collect();
            prop_assert_eq!(found.len(), wanted.len());
            for (at_s, index) in found.iter().zip(wanted) {
                prop_assert!((index as f64..=index as f64 + 1.0).contains(at_s));
            }
        }
    }

    /// One rise through 0 each second for ten seconds, in 100 readings a second.
    fn run(trigger: &mut Trigger, from: u32, to: u32, span_s: f64) {
        for tick in from..to {
            let time_s = f64::from(tick) * 0.01;
            trigger.feed(time_s, -(std::f64::consts::TAU * time_s).cos(), span_s);
        }
    }

    #[test]
    fn single_keeps_the_first_time_until_it_is_armed_again() {
        let mut trigger = Trigger::new(TriggerSource::Channel(0));
        trigger.set_mode(TriggerMode::Single);
        run(&mut trigger, 0, 500, 0.5);
        let shown = trigger.shown_s(5.0, 0.5).unwrap();
        assert!((shown - 0.25).abs() < 1e-3, "{shown}");
        assert!(trigger.is_spent());
        trigger.rearm();
        run(&mut trigger, 500, 700, 0.5);
        assert!((trigger.shown_s(7.0, 0.5).unwrap() - 5.25).abs() < 1e-3);
    }

    #[test]
    fn normal_takes_the_next_time_only_when_the_picture_is_full() {
        let mut trigger = Trigger::new(TriggerSource::Channel(0));
        trigger.set_mode(TriggerMode::Normal);
        run(&mut trigger, 0, 220, 2.0);
        // At 0.25 s; the picture reaches 1.6 s further, so 1.25 s does not count.
        assert!((trigger.shown_s(2.2, 2.0).unwrap() - 0.25).abs() < 1e-3);
        run(&mut trigger, 220, 300, 2.0);
        assert!((trigger.shown_s(3.0, 2.0).unwrap() - 2.25).abs() < 1e-3);
        assert!(trigger.shown_s(900.0, 2.0).is_some());
    }

    #[test]
    fn auto_follows_again_when_nothing_happens() {
        let mut trigger = Trigger::new(TriggerSource::Channel(0));
        trigger.set_mode(TriggerMode::Auto);
        run(&mut trigger, 0, 100, 1.0);
        assert!(trigger.shown_s(1.0, 1.0).is_some());
        assert!(trigger.shown_s(3.0, 1.0).is_none());
    }

    #[test]
    fn a_command_triggers_where_that_is_the_source() {
        let mut trigger = Trigger::new(TriggerSource::Command);
        trigger.set_mode(TriggerMode::Normal);
        trigger.command(4.0, 1.0);
        assert_eq!(trigger.shown_s(5.0, 1.0), Some(4.0));
        trigger.set(TriggerSettings { source: TriggerSource::Channel(3), ..*trigger.settings() });
        trigger.command(8.0, 1.0);
        assert_eq!(trigger.shown_s(9.0, 1.0), Some(4.0));
        trigger.set_mode(TriggerMode::Off);
        assert_eq!(trigger.shown_s(9.0, 1.0), None);
    }
}
