//! How long work takes yet, told by how fast it has gone.

use std::fmt::Debug;
use std::hash::Hash;

use egui::{Id, Ui};

use crate::messages::SpokenMessage;

/// Before so much time and so much of the work there is nothing to tell by.
const LEAST_S: f64 = 1.0;
const LEAST_PART: f64 = 0.02;

/// Work that was not seen for so long is other work.
const UNSEEN_S: f64 = 1.0;

/// How fast work goes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pace {
    began_s: f64,
    from: f64,
    seen_s: f64,
    last: f64,
}

impl Pace {
    fn beginning(now_s: f64, part: f64) -> Self {
        Self { began_s: now_s, from: part, seen_s: now_s, last: part }
    }

    /// It is so far now: what is left of it, in seconds, once that can be told.
    fn left_s(&mut self, now_s: f64, part: f64) -> Option<f64> {
        if part < self.last || now_s - self.seen_s > UNSEEN_S {
            *self = Self::beginning(now_s, part);
        }
        (self.seen_s, self.last) = (now_s, part);
        let (passed_s, done) = (now_s - self.began_s, part - self.from);
        (passed_s >= LEAST_S && done >= LEAST_PART).then(|| (1.0 - part).max(0.0) * passed_s / done)
    }
}

/// What a bar says of work that is at `fraction` of 1: `text`, and how long the rest takes. `work` tells it from other work that is shown.
pub fn with_time_left(ui: &Ui, work: impl Hash + Debug, fraction: f32, text: &str) -> String {
    let now_s = ui.input(|input| input.time);
    let (id, part) = (Id::unique(("time left", Id::unique(work))), f64::from(fraction));
    let left_s = ui.data_mut(|data| {
        let pace = data.get_temp_mut_or_insert_with(id, || Pace::beginning(now_s, part));
        pace.left_s(now_s, part)
    });
    match left_s {
        None => text.to_owned(),
        Some(seconds) if seconds < 1.0 => SpokenMessage::MomentLeft { text: text.to_owned() }.to_string(),
        Some(seconds) => SpokenMessage::TimeLeft { text: text.to_owned(), seconds }.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_goes_evenly_takes_as_long_again_as_its_second_half() {
        let mut pace = Pace::beginning(10.0, 0.0);
        assert_eq!(pace.left_s(10.5, 0.1), None, "nothing can be told of its first second");
        assert_eq!(pace.left_s(11.0, 0.2), Some(4.0));
        let left_s = pace.left_s(12.0, 0.4).unwrap();
        assert!((left_s - 3.0).abs() < 1e-9, "{left_s}");
        assert_eq!(pace.left_s(12.9, 1.0), Some(0.0));
    }

    #[test]
    fn other_work_is_judged_by_itself() {
        let mut pace = Pace::beginning(0.0, 0.0);
        for tenth in 1..=20 {
            pace.left_s(f64::from(tenth) * 0.1, f64::from(tenth) * 0.04);
        }
        assert_eq!(pace.left_s(2.1, 0.0), None, "it begins again");
        assert_eq!(pace.left_s(9.0, 0.5), None, "it was not seen for a while");
        assert_eq!(pace.left_s(9.9, 0.51), None, "too little was done");
    }
}
