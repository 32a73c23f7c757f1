//! Where the virtual limits of a Motion Mind stand during a run: a little ahead of the motor, so that it stops by itself when the host
//! is no longer there.

/// How long the motor may run on at its present speed, and at the highest it has shown, s.
const AHEAD_S: f64 = 0.45;
const AHEAD_AT_TOP_S: f64 = 0.25;
/// The least room, counts.
const LEAST_COUNTS: f64 = 400.0;
/// The room of the first drive at a higher duty, as a multiple of what the probe moved the motor by, and its bounds, counts.
const PER_PROBE: f64 = 300.0;
const FIRST_COUNTS: (f64, f64) = (2_000.0, 100_000.0);
/// A duty that is still a probe.
const PROBE_DUTY: f64 = 0.42;
/// How long the first drive counts as new, s.
const NEW_S: f64 = 0.3;
/// Share of the room below which the fence is moved.
const MOVED_BELOW: f64 = 0.5;
/// Multiple of the room from which on the fence is drawn in.
const FAR: f64 = 2.5;

/// The fence.
#[derive(Clone, Debug, Default)]
pub(super) struct Fence {
    /// Where VNLIMIT and VPLIMIT are; `None` before they were written.
    pub low: Option<i32>,
    pub high: Option<i32>,
    /// Between which counts the motor is to stay.
    pub travel: Option<(i64, i64)>,
    first: Option<i32>,
    last: Option<(f64, i32)>,
    speed: f64,
    top: f64,
    probed: f64,
    /// When the first drive beyond the probe was seen to begin, s.
    began_s: Option<f64>,
    is_beyond_probe: bool,
    /// The way that was commanded last.
    heading: f64,
}

impl Fence {
    /// A place was read.
    pub(super) fn see(&mut self, t: f64, counts: i32) {
        let first = *self.first.get_or_insert(counts);
        if let Some((before, was)) = self.last
            && t > before
        {
            self.speed = f64::from(counts.wrapping_sub(was)) / (t - before);
            self.top = self.top.max(self.speed.abs());
        }
        if self.is_beyond_probe {
            self.began_s.get_or_insert(t);
        } else {
            self.probed = self.probed.max(f64::from(counts.wrapping_sub(first)).abs());
        }
        self.last = Some((t, counts));
    }

    /// Where the motor was last seen, counts.
    pub(super) fn place(&self) -> f64 {
        self.last.map_or(0.0, |(_, counts)| f64::from(counts))
    }

    /// A duty is about to be given.
    pub(super) fn drive(&mut self, duty: f64) {
        self.is_beyond_probe |= duty.abs() > PROBE_DUTY;
        if duty != 0.0 {
            self.heading = duty.signum();
        }
    }

    /// A loop is about to be told something.
    pub(super) fn head(&mut self, way: f64) {
        self.is_beyond_probe = true;
        if way != 0.0 {
            self.heading = way.signum();
        }
    }

    /// Where either side has to be written now: where it is too near, and where it is far on the side that the motor heads for.
    pub(super) fn due(&self) -> (Option<i32>, Option<i32>) {
        let Some((t, counts)) = self.last else { return (None, None) };
        let room = self.room(t);
        let place = f64::from(counts);
        let (lowest, highest) =
            self.travel.map_or((f64::from(i32::MIN), f64::from(i32::MAX)), |(l, h)| (l as f64, h as f64));
        let due = |fence: Option<i32>, wanted: f64, side: f64| {
            // The cast saturates.
            let wanted = wanted as i32;
            let Some(fence) = fence else { return Some(wanted) };
            let distance = (f64::from(fence) - place) * side;
            let is_far = distance > FAR * room && self.heading * side > 0.0;
            (fence != wanted && (distance < MOVED_BELOW * room || is_far)).then_some(wanted)
        };
        let low = due(self.low, (place - room).max(lowest), -1.0);
        (low, due(self.high, (place + room).min(highest), 1.0))
    }

    fn room(&self, t: f64) -> f64 {
        let is_new = self.is_beyond_probe && self.began_s.is_none_or(|began| t - began < NEW_S);
        if is_new || !self.is_beyond_probe {
            return (PER_PROBE * self.probed).clamp(FIRST_COUNTS.0, FIRST_COUNTS.1);
        }
        (AHEAD_S * self.speed.abs()).max(AHEAD_AT_TOP_S * self.top).max(LEAST_COUNTS)
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
            assert!((0.2 * 20_000.0..=0.46 * 20_000.0).contains(&left), "{left} counts left");
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
    fn it_stays_inside_the_travel() {
        let mut fence = Fence { travel: Some((-500, 900)), ..Fence::default() };
        fence.see(0.0, 0);
        assert_eq!(fence.due(), (Some(-500), Some(900)));
    }
}
