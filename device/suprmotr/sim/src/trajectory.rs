//! The trapezoid in time that a move follows (SuprMotr manual, commands DV, DA, MA, MR).
//!
//! A move is planned once, from where the dynamic target is and how fast it goes, and is then a function of time. That makes its end exact, however long a tick
//! is. What DV and DA become meanwhile holds for later moves.

use std::time::Duration;

/// Most pieces of a move: turn back, slow down or speed up, cruise, slow down.
const PIECES: usize = 4;

/// Times are sums of rounded ones.
const ROUNDING_S: f64 = 1e-9;

/// A stretch of constant acceleration.
#[derive(Clone, Copy, Debug, Default)]
struct Piece {
    duration_s: f64,
    counts_per_s_squared: f64,
}

/// Where a move is and how fast it goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// In counts.
    pub counts: f64,
    /// In counts per second.
    pub counts_per_s: f64,
}

/// How fast a move may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// DV.
    pub counts_per_s: f64,
    /// DA.
    pub counts_per_s_squared: f64,
}

/// A move from one rest to another, or none.
#[derive(Clone, Debug)]
pub struct Trajectory {
    start: Point,
    pieces: [Piece; PIECES],
    used: usize,
    elapsed: Duration,
    end_counts: f64,
    /// A move that never begins, since its pace is 0.
    is_stuck: bool,
}

impl Trajectory {
    /// At rest.
    pub fn at(counts: f64) -> Self {
        Self {
            start: Point { counts, counts_per_s: 0.0 },
            pieces: [Piece::default(); PIECES],
            used: 0,
            elapsed: Duration::ZERO,
            end_counts: counts,
            is_stuck: false,
        }
    }

    /// From a point to rest at another place. A pace of 0 stands still for ever.
    pub fn to(from: Point, end_counts: f64, pace: Pace) -> Self {
        let mut plan = Self { start: from, end_counts, ..Self::at(from.counts) };
        let acceleration = pace.counts_per_s_squared;
        if acceleration <= 0.0 || pace.counts_per_s <= 0.0 {
            plan.start.counts_per_s = 0.0;
            plan.is_stuck = plan.distance(plan.start) != 0.0;
            return plan;
        }
        let mut at = from;
        let distance = plan.distance(at);
        let stopping = at.counts_per_s * at.counts_per_s / (2.0 * acceleration);
        if at.counts_per_s * distance < 0.0 || stopping > distance.abs() {
            at = plan.change_speed(at, 0.0, acceleration);
        }
        let distance = plan.distance(at);
        if distance == 0.0 {
            return plan;
        }
        let (way, speed) = (distance.signum(), at.counts_per_s.abs());
        let highest = (acceleration * distance.abs() + speed * speed / 2.0).sqrt();
        let cruise = highest.min(pace.counts_per_s);
        at = plan.change_speed(at, way * cruise, acceleration);
        let braking = cruise * cruise / (2.0 * acceleration);
        let left = (plan.distance(at).abs() - braking).max(0.0);
        at = plan.add(at, Piece { duration_s: left / cruise, counts_per_s_squared: 0.0 });
        plan.change_speed(at, 0.0, acceleration);
        plan
    }

    /// From a point to rest as soon as the acceleration lets it.
    pub fn to_rest(from: Point, counts_per_s_squared: f64) -> Self {
        let mut plan = Self { start: from, ..Self::at(from.counts) };
        if counts_per_s_squared > 0.0 {
            plan.end_counts = plan.change_speed(from, 0.0, counts_per_s_squared).counts;
        }
        // Whole counts can be told as a target.
        plan.end_counts = plan.end_counts.round();
        plan
    }

    /// Time goes on.
    pub fn advance(&mut self, by: Duration) {
        if !self.is_complete() && !self.is_stuck {
            self.elapsed += by;
        }
    }

    /// Where it is now.
    pub fn point(&self) -> Point {
        if self.is_complete() {
            return Point { counts: self.end_counts, counts_per_s: 0.0 };
        }
        let mut left_s = self.elapsed.as_secs_f64();
        let mut at = self.start;
        for piece in &self.pieces[..self.used] {
            if left_s < piece.duration_s {
                return after(at, Piece { duration_s: left_s, ..*piece });
            }
            left_s -= piece.duration_s;
            at = after(at, *piece);
        }
        at
    }

    /// Where it ends, in counts.
    pub fn end_counts(&self) -> f64 {
        self.end_counts
    }

    /// Whether it has ended.
    pub fn is_complete(&self) -> bool {
        !self.is_stuck && self.elapsed.as_secs_f64() + ROUNDING_S >= self.duration_s()
    }

    /// Whether it slows down for its end.
    pub fn is_slowing(&self) -> bool {
        let last_s = self.pieces[..self.used].last().map_or(0.0, |piece| piece.duration_s);
        let slows_at_s = self.duration_s() - last_s;
        !self.is_complete() && !self.is_stuck && self.elapsed.as_secs_f64() + ROUNDING_S >= slows_at_s
    }

    /// The same move told from another zero.
    pub fn shift(&mut self, counts: f64) {
        self.start.counts += counts;
        self.end_counts += counts;
    }

    fn duration_s(&self) -> f64 {
        self.pieces[..self.used].iter().map(|piece| piece.duration_s).sum()
    }

    fn distance(&self, at: Point) -> f64 {
        self.end_counts - at.counts
    }

    fn change_speed(&mut self, at: Point, counts_per_s: f64, acceleration: f64) -> Point {
        let change = counts_per_s - at.counts_per_s;
        let piece = Piece {
            duration_s: change.abs() / acceleration,
            counts_per_s_squared: acceleration.copysign(change),
        };
        Point { counts_per_s, ..self.add(at, piece) }
    }

    fn add(&mut self, at: Point, piece: Piece) -> Point {
        if piece.duration_s > 0.0
            && let Some(place) = self.pieces.get_mut(self.used)
        {
            *place = piece;
            self.used += 1;
        }
        after(at, piece)
    }
}

fn after(at: Point, Piece { duration_s, counts_per_s_squared }: Piece) -> Point {
    let gained = counts_per_s_squared * duration_s;
    Point {
        counts: at.counts + (at.counts_per_s + gained / 2.0) * duration_s,
        counts_per_s: at.counts_per_s + gained,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACTORY: Pace = Pace { counts_per_s: 20_000.0, counts_per_s_squared: 200_000.0 };

    fn rest(counts: f64) -> Point {
        Point { counts, counts_per_s: 0.0 }
    }

    fn run(mut plan: Trajectory) -> (Duration, Point) {
        let mut took = Duration::ZERO;
        while !plan.is_complete() {
            plan.advance(Duration::from_micros(100));
            took += Duration::from_micros(100);
            assert!(took < Duration::from_secs(100), "it never ends");
        }
        (took, plan.point())
    }

    /// 5000 counts at 20,000 counts/s and 200,000 counts/s^2: 0.1 s and 1000 counts up, as much down, 3000 counts in 0.15 s between.
    #[test]
    fn a_long_move_is_a_trapezoid() {
        let mut plan = Trajectory::to(rest(0.0), 5_000.0, FACTORY);
        for (at_ms, counts, counts_per_s) in [
            (50, 250.0, 10_000.0),
            (100, 1_000.0, 20_000.0),
            (175, 2_500.0, 20_000.0),
            (250, 4_000.0, 20_000.0),
            (300, 4_750.0, 10_000.0),
        ] {
            plan.advance(Duration::from_millis(at_ms) - plan.elapsed);
            let point = plan.point();
            assert!((point.counts - counts).abs() < 1e-6, "{at_ms} ms: {point:?}");
            assert!((point.counts_per_s - counts_per_s).abs() < 1e-6, "{at_ms} ms: {point:?}");
            assert_eq!(plan.is_slowing(), at_ms >= 250, "{at_ms} ms");
        }
        assert_eq!(
            run(Trajectory::to(rest(0.0), 5_000.0, FACTORY)),
            (Duration::from_millis(350), rest(5_000.0))
        );
        assert_eq!(run(Trajectory::to(rest(5_000.0), 0.0, FACTORY)), (Duration::from_millis(350), rest(0.0)));
    }

    /// 500 counts are too few to reach DV: half of them upwards in sqrt(500 / 200,000) = 0.05 s, half downwards.
    #[test]
    fn a_short_move_is_a_triangle() {
        assert_eq!(
            run(Trajectory::to(rest(0.0), -500.0, FACTORY)),
            (Duration::from_millis(100), rest(-500.0))
        );
        let mut plan = Trajectory::to(rest(0.0), -500.0, FACTORY);
        plan.advance(Duration::from_millis(50));
        assert!((plan.point().counts_per_s + 10_000.0).abs() < 1e-6);
    }

    /// At 20,000 counts/s, 1000 counts are needed to stop; a target 400 ahead is passed and come back to: 0.1 s, then 600 counts back as
    /// a triangle of 2 sqrt(600 / 200,000) = 0.10954 s.
    #[test]
    fn a_target_that_is_too_near_is_come_back_to() {
        let flying = Point { counts: 0.0, counts_per_s: 20_000.0 };
        let (took, end) = run(Trajectory::to(flying, 400.0, FACTORY));
        assert_eq!((took, end), (Duration::from_micros(209_600), rest(400.0)));
        let (took, end) = run(Trajectory::to(flying, -1_000.0, FACTORY));
        // 0.1 s to 1000, then 2000 counts back: 0.1 s up, 0.1 s down, nothing between.
        assert_eq!((took, end), (Duration::from_millis(300), rest(-1_000.0)));
    }

    /// Faster than the new DV: 0.05 s down to 10,000 counts/s over 750 counts, 0.05 s and 250 counts for the stop, 1000 counts between in 0.1 s.
    #[test]
    fn a_move_in_flight_takes_on_a_lower_speed() {
        let flying = Point { counts: 0.0, counts_per_s: 20_000.0 };
        let slow = Pace { counts_per_s: 10_000.0, ..FACTORY };
        assert_eq!(run(Trajectory::to(flying, 2_000.0, slow)), (Duration::from_millis(200), rest(2_000.0)));
    }

    #[test]
    fn a_stop_takes_the_speed_over_the_acceleration() {
        let flying = Point { counts: 100.0, counts_per_s: -10_000.0 };
        assert_eq!(run(Trajectory::to_rest(flying, 200_000.0)), (Duration::from_millis(50), rest(-150.0)));
        assert_eq!(run(Trajectory::to_rest(rest(7.0), 200_000.0)), (Duration::ZERO, rest(7.0)));
    }

    #[test]
    fn without_a_pace_nothing_moves_and_nothing_ends() {
        for pace in [Pace { counts_per_s: 0.0, ..FACTORY }, Pace { counts_per_s_squared: 0.0, ..FACTORY }] {
            let mut plan = Trajectory::to(rest(3.0), 10.0, pace);
            plan.advance(Duration::from_secs(10));
            assert_eq!((plan.point(), plan.is_complete()), (rest(3.0), false));
            assert!(Trajectory::to(rest(3.0), 3.0, pace).is_complete());
        }
    }

    #[test]
    fn a_move_told_from_another_zero_is_the_same_move() {
        let mut plan = Trajectory::to(rest(0.0), 5_000.0, FACTORY);
        plan.advance(Duration::from_millis(175));
        plan.shift(-2_500.0);
        assert!(plan.point().counts.abs() < 1e-6 && plan.end_counts() == 2_500.0);
    }
}
