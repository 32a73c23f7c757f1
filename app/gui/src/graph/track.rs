//! Samples with what they are of, and the marks that go with them: what a live graph gathers and a recording holds.

use super::history::History;
use super::marks::Marks;
use super::scale::Scale;
use super::series::is_gap;

/// What a channel is, fixed for the life of a track.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelInfo {
    /// Name in files; the same channel of another track has the same.
    pub key: String,
    pub label: String,
    pub unit: String,
    /// Digits after the point of its readout.
    pub decimals: usize,
    pub scale: Scale,
    /// Whether it is shown at first.
    pub shown: bool,
    /// An input pin: listed apart, since most controllers have many that carry nothing.
    pub is_pin: bool,
}

/// Samples of several channels on one time axis.
#[derive(Clone, Debug)]
pub struct Track {
    pub channels: Vec<ChannelInfo>,
    pub history: History,
    pub marks: Marks,
    /// The time of the first sample ever, kept or not.
    pub began_s: Option<f64>,
}

impl Track {
    /// An empty track that keeps at least `rows` rows.
    pub fn new(channels: Vec<ChannelInfo>, rows: u64) -> Self {
        let history = History::new(channels.len(), rows);
        Self { channels, history, marks: Marks::default(), began_s: None }
    }

    pub fn push(&mut self, time_s: f64, values: &[f64], read_s: impl Fn(usize) -> f64) {
        self.began_s.get_or_insert(time_s);
        self.history.push_read(time_s, values, read_s);
    }

    /// A copy of what lies between two times.
    pub fn cut(&self, from_s: f64, to_s: f64) -> Self {
        let rows = self.history.row_at(from_s)..self.history.row_at(to_s.next_up());
        let mut cut = Self::new(self.channels.clone(), rows.end.saturating_sub(rows.start));
        for row in rows {
            let values: Vec<f64> =
                (0..self.channels.len()).map(|channel| self.history.channel(channel).value(row)).collect();
            cut.push(self.history.time_s(row), &values, |channel| self.history.read_s(channel, row));
        }
        self.marks.between(from_s, to_s).for_each(|mark| cut.marks.push(mark.clone()));
        cut
    }

    pub fn channel_of_key(&self, key: &str) -> Option<usize> {
        self.channels.iter().position(|channel| channel.key == key)
    }

    /// The readings of a channel in order, each with its own time; none where data was lost.
    pub fn readings(&self, channel: usize) -> impl Iterator<Item = Option<(f64, f64)>> {
        let series = self.history.channel(channel);
        self.history.rows().filter_map(move |row| match series.value(row) {
            value if is_gap(value) => Some(None),
            value if value.is_nan() => None,
            value => Some(Some((self.history.read_s(channel, row), value))),
        })
    }
}
