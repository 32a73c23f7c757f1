//! Two cursors on the time axis, and what a channel does between them.
//!
//! While the graph follows the newest sample a cursor keeps its place on the screen, so that figures run along; while
//! it is held a cursor keeps its place in time.

use super::history::History;

/// A cursor's place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// Part of the width, from the left.
    Screen(f64),
    /// A time of the track.
    Time(f64),
}

/// Both cursors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursors {
    pub on: bool,
    /// The one that keys move: 0 is A, 1 is B.
    pub active: usize,
    places: [Place; 2],
}

impl Default for Cursors {
    fn default() -> Self {
        Self { on: false, active: 0, places: [Place::Screen(0.25), Place::Screen(0.75)] }
    }
}

impl Cursors {
    pub const NAMES: [&'static str; 2] = ["A", "B"];

    /// The time a cursor stands at, in the picture from `start_s` to `end_s`.
    pub fn at_s(&self, which: usize, (start_s, end_s): (f64, f64)) -> f64 {
        match self.places[which & 1] {
            Place::Screen(part) => start_s + part * (end_s - start_s),
            Place::Time(time_s) => time_s,
        }
    }

    /// Moves a cursor to a time. While the graph follows, it stays inside the picture.
    pub fn set(&mut self, which: usize, time_s: f64, (start_s, end_s): (f64, f64), follows: bool) {
        self.active = which & 1;
        self.places[which & 1] = match follows {
            true => Place::Screen(((time_s - start_s) / (end_s - start_s)).clamp(0.0, 1.0)),
            false => Place::Time(time_s),
        };
    }

    /// From now on the graph is held, or follows again; the cursors stay where they are seen.
    pub fn turn(&mut self, picture: (f64, f64), follows: bool) {
        let active = self.active;
        for which in 0..2 {
            self.set(which, self.at_s(which, picture), picture, follows);
        }
        self.active = active;
    }

    /// Brings both back into the picture.
    pub fn gather(&mut self, (start_s, end_s): (f64, f64), follows: bool) {
        let active = self.active;
        for (which, part) in [0.25, 0.75].into_iter().enumerate() {
            self.set(which, start_s + part * (end_s - start_s), (start_s, end_s), follows);
        }
        self.active = active;
    }
}

/// What a channel does at and between the cursors. A figure that cannot be told is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    pub a: Option<f64>,
    pub b: Option<f64>,
    pub delta: Option<f64>,
    /// Readings between the cursors.
    pub count: u64,
    pub mean: Option<f64>,
    pub min: Option<f64>,
    pub max: Option<f64>,
    pub deviation: Option<f64>,
    pub slope_per_s: Option<f64>,
}

impl Measure {
    /// Of a channel, with cursor A at `a_s` and B at `b_s`, in either order. Readings before `from_s` do not count.
    pub fn of(history: &History, channel: usize, [a_s, b_s]: [f64; 2], from_s: f64) -> Self {
        let at = |time_s: f64| (time_s >= from_s).then(|| history.value_at(channel, time_s)).flatten();
        let (a, b) = (at(a_s), at(b_s));
        let (extrema, moments) = history.summary(channel, a_s.min(b_s).max(from_s), a_s.max(b_s));
        let seen = !extrema.is_empty();
        Self {
            a,
            b,
            delta: a.zip(b).map(|(a, b)| b - a),
            count: moments.count(),
            mean: moments.mean(),
            min: seen.then_some(extrema.min),
            max: seen.then_some(extrema.max),
            deviation: moments.deviation(),
            slope_per_s: moments.slope_per_s(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_between_the_cursors_is_measured_as_it_is() {
        let mut history = History::new(1, 1000);
        for tick in 0..100 {
            history.push(f64::from(tick) * 0.1, &[f64::from(tick) * 2.0]);
        }
        let measure = Measure::of(&history, 0, [1.0, 3.05], f64::NEG_INFINITY);
        assert_eq!((measure.a, measure.b, measure.delta), (Some(20.0), Some(60.0), Some(40.0)));
        assert_eq!((measure.count, measure.min, measure.max), (21, Some(20.0), Some(60.0)));
        assert!((measure.mean.unwrap() - 40.0).abs() < 1e-9);
        assert!((measure.slope_per_s.unwrap() - 20.0).abs() < 1e-9);
        // Sum of squares of -20, -18 ... 20 over 21.
        assert!((measure.deviation.unwrap() - (3080.0f64 / 21.0).sqrt()).abs() < 1e-9);
        let turned = Measure::of(&history, 0, [3.05, 1.0], f64::NEG_INFINITY);
        assert_eq!((turned.delta, turned.mean), (Some(-40.0), measure.mean));
    }

    #[test]
    fn where_nothing_was_read_nothing_is_told() {
        let mut history = History::new(1, 1000);
        history.push(5.0, &[1.0]);
        assert_eq!(Measure::of(&history, 0, [0.0, 4.0], f64::NEG_INFINITY), Measure::default());
        assert_eq!(Measure::of(&history, 0, [0.0, 6.0], 5.5).count, 0);
    }

    #[test]
    fn a_cursor_keeps_its_place_on_a_picture_that_moves_and_its_time_on_one_that_is_held() {
        let mut cursors = Cursors::default();
        cursors.set(0, 92.0, (90.0, 100.0), true);
        assert!((cursors.at_s(0, (95.0, 105.0)) - 97.0).abs() < 1e-9);
        cursors.turn((95.0, 105.0), false);
        assert!((cursors.at_s(0, (0.0, 10.0)) - 97.0).abs() < 1e-9);
        cursors.turn((200.0, 210.0), true);
        assert_eq!(cursors.at_s(0, (200.0, 210.0)), 200.0, "out of sight it comes back to the edge");
        cursors.gather((0.0, 8.0), false);
        assert_eq!((cursors.at_s(0, (0.0, 8.0)), cursors.at_s(1, (0.0, 8.0))), (2.0, 6.0));
    }
}
