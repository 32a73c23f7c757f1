//! The link of the benchmark to a simulated controller in virtual time, with latency, jitter and loss.

use crate::population::{Draw, LinkParams};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_tuning::axis::AxisError;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::time::Duration;

/// A duty that moves each of the motors.
const CLEAR_DUTY: f64 = 0.25;
/// Pause by which one drive is told from the next: longer than a loop that passes through nought takes, shorter than a stretch of a run that is begun anew.
const OFF: Duration = Duration::from_millis(200);
/// Spread of the latency about its mean.
const LATENCY_SPREAD: (f64, f64) = (0.8, 1.6);

/// A wait that ends so much too late is the host's, as the program's link counts it.
const LATE_WAKE: Duration = Duration::from_millis(2);

/// Something that happens to the machine in mid-run.
#[derive(Clone, Debug)]
pub struct Event {
    /// When.
    pub at: Duration,
    /// What.
    pub action: WorldAction,
}

/// What the bench notes past the wire.
#[derive(Clone, Copy, Debug, Default)]
pub struct Truth {
    /// Highest motor current, A.
    pub peak_amps: f64,
    /// When the bridge last drove the motor.
    pub last_driven: Duration,
    /// The longest drive since the last thing that happened to the machine.
    pub drive: Drive,
    /// The same from when the duty was one that moves each of the motors: a loop at rest shows nothing.
    pub clear_drive: Drive,
    /// Farthest the motor shaft was from where it started, rad.
    pub farthest_radians: f64,
    /// When the output shaft first came to where an end stop is.
    pub stop_hit_at: Option<Duration>,
}

/// The longest that a bridge drove its motor without a pause.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drive {
    /// When the present one began.
    since: Option<Duration>,
    /// The longest.
    pub longest: Duration,
}

impl Drive {
    /// Looks at a bridge that drove last then, and whether what it does now begins a drive.
    fn see(&mut self, now: Duration, last_driven: Duration, begins: bool) {
        if now > last_driven + OFF {
            self.since = None;
        }
        if begins {
            self.since.get_or_insert(now);
        }
        if let Some(since) = self.since {
            self.longest = self.longest.max(last_driven.saturating_sub(since));
        }
    }
}

/// A link to a simulated controller.
#[derive(Debug)]
pub struct SimulatedLine<M> {
    pub(crate) unit: M,
    params: LinkParams,
    draw: ChaCha8Rng,
    pub(crate) now: Duration,
    events: Vec<Event>,
    /// What was noted.
    pub truth: Truth,
    /// Every request that was sent, as it went over the wire.
    pub sent: Vec<Vec<u8>>,
    /// From when on every exchange fails as stopped.
    pub stop_at: Option<Duration>,
    /// From when on nothing answers.
    pub dead_at: Option<Duration>,
    /// Where the end stops are, on either side.
    pub end_stop_radians: Option<f64>,
    /// A busy host: the share of replies that it reads late, and by how much at the most, s.
    pub late_reads: Option<(f64, f64)>,
    /// A host without a processor for a while: from when on and for how long, the latest first.
    pub stalls: Vec<(Duration, Duration)>,
    /// A line that holds all bytes back for a while, so that they are given up: from when on and for how long.
    pub held_back: Option<(Duration, Duration)>,
    /// A line with jitter: the share of replies that are on their way for longer, and by how much at the most, s.
    pub line_jitter: Option<(f64, f64)>,
    /// Whether the unit passes for a real one.
    pub passes_for_real: bool,
    /// Time that the host took since it was asked.
    pub stolen: Duration,
}

/// What a line needs of a simulated unit.
pub trait Bench {
    /// Its time.
    fn time(&self) -> Duration;
    /// Moves its time on.
    fn pass(&mut self, to: Duration);
    /// Its world.
    fn look(&self) -> WorldView;
    /// Does something to its world.
    fn undergo(&mut self, action: &WorldAction);
}

impl<M: Bench> SimulatedLine<M> {
    /// A link to `unit`, from its present time on.
    #[must_use]
    pub fn new(unit: M, params: LinkParams) -> Self {
        let now = unit.time();
        let draw = ChaCha8Rng::seed_from_u64(params.seed);
        Self {
            unit,
            params,
            draw,
            now,
            events: Vec::new(),
            truth: Truth::default(),
            sent: Vec::new(),
            stop_at: None,
            dead_at: None,
            end_stop_radians: None,
            late_reads: None,
            stalls: Vec::new(),
            held_back: None,
            line_jitter: None,
            passes_for_real: false,
            stolen: Duration::ZERO,
        }
    }

    /// Lets things happen at their times.
    pub fn schedule(&mut self, mut events: Vec<Event>) {
        events.sort_by_key(|event| std::cmp::Reverse(event.at));
        self.events = events;
    }

    /// The controller, to look at.
    #[must_use]
    pub fn unit(&self) -> &M {
        &self.unit
    }

    /// Lets time pass without a word.
    pub fn idle(&mut self, time: Duration) {
        self.advance(self.now + time);
    }

    pub(crate) fn advance(&mut self, to: Duration) {
        const LOOK: Duration = Duration::from_millis(5);
        while self.now < to {
            let mut next = (self.now + LOOK).min(to);
            if let Some(event) = self.events.last() {
                next = next.min(event.at.max(self.now));
            }
            self.unit.pass(next);
            self.now = next;
            while self.events.last().is_some_and(|event| event.at <= self.now) {
                if let Some(event) = self.events.pop() {
                    self.unit.undergo(&event.action);
                    (self.truth.drive, self.truth.clear_drive) = (Drive::default(), Drive::default());
                }
            }
            self.note();
        }
    }

    fn note(&mut self) {
        let view = self.unit.look();
        let axis = &view.axes[0];
        self.truth.peak_amps = self.truth.peak_amps.max(axis.truth.amps.abs());
        // A current limit that softens the braking gives a duty too, but against the current: that drives nothing.
        // Without any current, as with a lead off, the duty alone counts.
        let (duty, amps) = (axis.output.duty(), axis.truth.amps);
        let drives = duty * amps > 0.0 || (duty != 0.0 && amps == 0.0);
        if drives {
            self.truth.last_driven = self.now;
        }
        let last_driven = self.truth.last_driven;
        self.truth.drive.see(self.now, last_driven, drives);
        self.truth.clear_drive.see(self.now, last_driven, drives && duty.abs() > CLEAR_DUTY);
        self.truth.farthest_radians = self.truth.farthest_radians.max(axis.truth.motor_radians.abs());
        if let Some(stop) = self.end_stop_radians
            && axis.truth.load_radians.abs() >= 0.999 * stop
            && self.truth.stop_hit_at.is_none()
        {
            self.truth.stop_hit_at = Some(self.now);
        }
    }

    pub(crate) fn usual_latency_s(&self) -> f64 {
        self.params.latency_s
    }

    pub(crate) fn latency(&mut self) -> Duration {
        let mut draw = Draw(self.draw.clone());
        let mut seconds = self.params.latency_s * draw.between(LATENCY_SPREAD);
        if let Some((share, longest_s)) = self.line_jitter
            && draw.uniform() < share
        {
            seconds += draw.between((0.0, longest_s));
        }
        self.draw = draw.0;
        Duration::from_secs_f64(seconds)
    }

    /// Lets the host go without a processor where that is due: it neither sends nor reads meanwhile.
    fn stall(&mut self) {
        if let Some((_, long)) = self.stalls.pop_if(|(at, _)| *at <= self.now) {
            self.hold_up(long);
        }
    }

    /// The host does nothing for a while, and sees that on its clock where it is no matter of a timer.
    fn hold_up(&mut self, long: Duration) {
        self.advance(self.now + long);
        if long >= LATE_WAKE {
            self.stolen += long;
        }
    }

    pub(crate) fn take_stolen(&mut self) -> Duration {
        std::mem::take(&mut self.stolen)
    }

    pub(crate) fn read_late(&mut self) {
        self.stall();
        let Some((share, longest_s)) = self.late_reads else { return };
        let mut draw = Draw(self.draw.clone());
        let late_s = if draw.uniform() < share { draw.between((0.0, longest_s)) } else { 0.0 };
        self.draw = draw.0;
        self.hold_up(Duration::from_secs_f64(late_s));
    }

    pub(crate) fn is_lost(&mut self) -> bool {
        let mut draw = Draw(self.draw.clone());
        let lost = draw.uniform() < self.params.loss;
        self.draw = draw.0;
        let is_held = |(from, long): (Duration, Duration)| (from..from + long).contains(&self.now);
        lost || self.held_back.is_some_and(is_held)
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.stop_at.is_some_and(|at| self.now >= at)
    }

    pub(crate) fn is_dead(&self) -> bool {
        self.dead_at.is_some_and(|at| self.now >= at)
    }

    /// Waits until a time, somewhat late.
    pub(crate) fn wait(&mut self, time: Duration) -> Result<(), AxisError> {
        let mut draw = Draw(self.draw.clone());
        let late = Duration::from_secs_f64((draw.normal() * self.params.jitter_s).abs());
        self.draw = draw.0;
        self.advance(time + late);
        self.stall();
        if self.is_stopped() { Err(AxisError::Stopped) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The longest drive that looks every 10 ms see, ms, of a bridge that drives from then to then.
    fn longest_ms(drives: &[(u64, u64)]) -> u128 {
        let (mut drive, mut last_driven) = (Drive::default(), Duration::ZERO);
        for now_ms in (10..2_000).step_by(10) {
            let now = Duration::from_millis(now_ms);
            let is_driven = drives.iter().any(|(from, to)| (*from..=*to).contains(&now_ms));
            last_driven = if is_driven { now } else { last_driven };
            drive.see(now, last_driven, is_driven);
        }
        drive.longest.as_millis()
    }

    #[test]
    fn a_pause_of_a_loop_is_part_of_a_drive_and_a_stretch_begun_anew_is_a_drive_of_its_own() {
        assert_eq!(longest_ms(&[(100, 250), (700, 800)]), 150);
        assert_eq!(longest_ms(&[(100, 250), (400, 800)]), 700, "a loop passed through nought");
        assert_eq!(longest_ms(&[]), 0);
    }
}
