//! Where the virtual limits of a Motion Mind stand during a run: a little ahead of the motor, so that it stops by itself when the host
//! is no longer there.

/// How long the motor may run on at its present speed, and at the commanded speed, s.
const AHEAD_S: f64 = 0.4;
const AHEAD_AS_COMMANDED_S: f64 = 0.18;
/// The least room, and that of a motor of which nothing is known yet, counts.
const LEAST_COUNTS: f64 = 250.0;
const FIRST_COUNTS: f64 = 2_000.0;
/// A duty that moves any motor, and how long one is watched under it before its speed is taken as known, s.
const CLEAR_DUTY: f64 = 0.19;
const KNOWN_AFTER_S: f64 = 0.06;
/// A motor commanded to less than what it ran at before may be so much faster than in proportion: friction takes its share.
const IN_PROPORTION: f64 = 1.3;
/// Share of the room below which the fence is moved.
const MOVED_BELOW: f64 = 0.5;
/// Multiple of the room from which on the fence is drawn in.
const FAR: f64 = 1.5;
/// A fence that was run into stands so much farther away from then on, up to so much.
const WIDER: f64 = 1.6;
const WIDEST: f64 = 5.0;

/// The fence.
#[derive(Clone, Debug, Default)]
pub(super) struct Fence {
    /// Where VNLIMIT and VPLIMIT are; `None` before they were written.
    pub low: Option<i32>,
    pub high: Option<i32>,
    /// Between which counts the motor is to stay.
    pub travel: Option<(i64, i64)>,
    last: Option<(f64, i32)>,
    speed: f64,
    /// The highest speed seen, and the highest duty commanded.
    top: f64,
    top_duty: f64,
    /// The commanded speed, as far as that is known, counts/s.
    commanded: f64,
    /// How much wider it stands than it should have to; 0 for not.
    wider: f64,
    /// When the first clear drive was seen to begin, s.
    began_s: Option<f64>,
    is_clear: bool,
    /// The direction that was commanded last.
    heading: f64,
    /// Where a loop was sent, counts: it stops there by itself, and a fence before it would be its goal instead.
    target: Option<f64>,
}

impl Fence {
    /// A position was read.
    pub(super) fn see(&mut self, t: f64, counts: i32) {
        if let Some((before, was)) = self.last
            && t > before
        {
            self.speed = f64::from(counts.wrapping_sub(was)) / (t - before);
            self.top = self.top.max(self.speed.abs());
        }
        if self.is_clear {
            self.began_s.get_or_insert(t);
        }
        self.last = Some((t, counts));
    }

    /// Where the motor was last seen, counts.
    pub(super) fn position(&self) -> f64 {
        self.last.map_or(0.0, |(_, counts)| f64::from(counts))
    }

    /// A duty is about to be given.
    pub(super) fn drive(&mut self, duty: f64) {
        self.is_clear |= duty.abs() > CLEAR_DUTY;
        let share = IN_PROPORTION * duty.abs() / self.top_duty.max(1e-3);
        // A duty higher than any before gives a speed higher than any before.
        self.commanded = self.top * if duty.abs() > self.top_duty { share } else { share.min(1.0) };
        self.top_duty = self.top_duty.max(duty.abs());
        self.target = None;
        if duty != 0.0 {
            self.heading = duty.signum();
        }
    }

    /// A loop is about to be given a speed, counts/s.
    pub(super) fn head_at(&mut self, speed: f64) {
        self.head(speed);
        self.target = None;
        self.commanded = (IN_PROPORTION * speed.abs()).min(self.top);
    }

    /// A loop is about to be sent to a place, counts.
    pub(super) fn head_for(&mut self, target: f64) {
        self.head(target - self.position());
        self.target = Some(target);
    }

    /// A loop is about to be commanded to go in a direction: the sign says which.
    fn head(&mut self, direction: f64) {
        self.is_clear = true;
        self.commanded = self.top;
        if direction != 0.0 {
            self.heading = direction.signum();
        }
    }

    /// The motor was stopped by it.
    pub(super) fn was_hit(&mut self) {
        self.wider = (self.wider.max(1.0) * WIDER).min(WIDEST);
    }

    /// Whether an end of the travel is what stands there, counted up or down.
    pub(super) fn is_travel(&self, up: bool) -> bool {
        self.travel.is_some_and(|(low, high)| {
            let (fence, end) = if up { (self.high, high) } else { (self.low, low) };
            fence.is_some_and(|fence| i64::from(fence) == end)
        })
    }

    /// Where either side has to be written now: where it is too near, and where it is far on the side that the motor heads for.
    pub(super) fn due(&self) -> (Option<i32>, Option<i32>) {
        let Some((t, counts)) = self.last else { return (None, None) };
        let room = self.room(t);
        let position = f64::from(counts);
        let (lowest, highest) =
            self.travel.map_or((f64::from(i32::MIN), f64::from(i32::MAX)), |(l, h)| (l as f64, h as f64));
        let beyond = |side: f64| match self.target {
            Some(target) if (target - position) * side > 0.0 => target,
            Some(_) | None => position,
        };
        let due = |fence: Option<i32>, wanted: f64, side: f64| {
            // The cast saturates.
            let wanted = wanted as i32;
            let Some(fence) = fence else { return Some(wanted) };
            let distance = (f64::from(fence) - beyond(side)) * side;
            let is_far = distance > FAR * room && self.heading * side > 0.0;
            (fence != wanted && (distance < MOVED_BELOW * room || is_far)).then_some(wanted)
        };
        let low = due(self.low, (beyond(-1.0) - room).max(lowest), -1.0);
        (low, due(self.high, (beyond(1.0) + room).min(highest), 1.0))
    }

    fn room(&self, t: f64) -> f64 {
        let is_known = self.began_s.is_some_and(|began| t - began > KNOWN_AFTER_S);
        let least = if is_known { LEAST_COUNTS } else { FIRST_COUNTS };
        (AHEAD_S * self.speed.abs()).max(AHEAD_AS_COMMANDED_S * self.commanded).max(least)
            * self.wider.max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fence whose sides are written whenever they are due, around a motor at a steady speed.
    fn follow(fence: &mut Fence, from: f64, to: f64, speed: f64) -> usize {
        let mut writes = 0;
        let mut t = from;
        while t < to {
            fence.see(t, (speed * t) as i32);
            let (low, high) = fence.due();
            writes += usize::from(low.is_some()) + usize::from(high.is_some());
            fence.low = low.or(fence.low);
            fence.high = high.or(fence.high);
            t += 0.015;
        }
        writes
    }

    #[test]
    fn a_running_motor_never_comes_to_the_fence_and_is_never_far_from_it() {
        let mut fence = Fence::default();
        fence.drive(1.0);
        follow(&mut fence, 0.0, 0.5, 20_000.0);
        for n in 0..100 {
            let from = 0.5 + 0.015 * f64::from(n);
            follow(&mut fence, from, from + 0.01, 20_000.0);
            let left = f64::from(fence.high.unwrap()) - 20_000.0 * from;
            assert!((0.18 * 20_000.0..=0.41 * 20_000.0).contains(&left), "{left} counts left");
        }
    }

    #[test]
    fn it_is_moved_rarely() {
        let mut fence = Fence::default();
        fence.drive(1.0);
        follow(&mut fence, 0.0, 0.5, 20_000.0);
        let writes = follow(&mut fence, 0.5, 2.5, 20_000.0);
        assert!((4..=12).contains(&writes), "{writes} writes in two seconds");
    }

    #[test]
    fn it_stands_beyond_the_place_that_a_loop_was_sent_to() {
        let mut fence = Fence::default();
        fence.see(0.0, 0);
        fence.head_for(9_000.0);
        let (low, high) = fence.due();
        assert!(high.is_some_and(|high| high > 9_000) && low.is_some_and(|low| low < 0), "{low:?} {high:?}");
        (fence.low, fence.high) = (low, high);
        assert_eq!(fence.due(), (None, None));
        fence.head_for(-3_000.0);
        let (low, high) = fence.due();
        assert!(low.is_some_and(|low| low < -3_000), "{low:?} {high:?}");
        (fence.low, fence.high) = (low.or(fence.low), high.or(fence.high));
        fence.drive(0.2);
        assert!(fence.due().1.is_some_and(|high| high < 9_000), "a duty has no end: it is drawn in again");
    }

    #[test]
    fn it_stays_inside_the_travel() {
        let mut fence = Fence { travel: Some((-500, 900)), ..Fence::default() };
        fence.see(0.0, 0);
        assert_eq!(fence.due(), (Some(-500), Some(900)));
    }
}
