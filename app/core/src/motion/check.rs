//! Whether motors do what they were told: what was commanded and confirmed, against what is measured from then on.
//!
//! Judges the device thread's events and sends nothing. A late computer, a slow line and lost replies make fewer readings, never wrong
//! ones: each finding needs a number of readings that were asked for after the command, over a time of their own. A ramp that still
//! runs, a firmware that does not tell a signal, a motor without an encoder and a limit that the unit reports are no faults. A cause
//! is named where nothing else would look the same; otherwise all that is left is named.

use brushwork_link::Message;
use std::time::Duration;

use crate::messages::{CommandedMessage, MotionMessage, NoOutputMessage, StandsMessage};
use brushwork_link::device::{Channel, Drive, DriveCommand, Event, Role, Sample, StatusReport};
use brushwork_values::Motor;

/// Readings that a finding needs at least, all of them saying the same.
const LEAST_READINGS: u32 = 5;
/// How long they have to say it: a bridge begins within a few ms, and a loop's output is never exactly nothing for so long.
const NO_OUTPUT_FOR: Duration = Duration::from_millis(600);
/// The same of counts that stand still. A flywheel of 5 s makes 70 counts in that time at the least output that is judged.
const STANDS_FOR: Duration = Duration::from_millis(800);
/// The same where the firmware does not tell the output, so that more has to be ruled out.
const STANDS_UNSEEN_FOR: Duration = Duration::from_secs(3);
/// An output below this is none, %. Half of the smallest step that the coarsest firmware tells (1 of 1023).
const NOTHING_PERCENT: f64 = 0.05;
/// Below it a motor may stand for friction alone, %: that is told, and is no fault.
const FRICTION_PERCENT: f64 = 10.0;
/// A loop that gives more than this and moves nothing is past the friction of any machine that it can drive, %.
const LOOP_PERCENT: f64 = 30.0;
/// Counts that an encoder's own noise may make.
const NOISE_COUNTS: f64 = 4.0;
/// Counts after which an encoder is known to count.
const ALIVE_COUNTS: f64 = 20.0;
/// A current below this is none, A: the mean of several readings of what is read with ±0.02 A, or in steps of 0.02 A.
const NO_CURRENT_AMPS: f64 = 0.03;
/// A position move is on its way while more than this share of it is left, and more than these counts.
const LEFT_SHARE: f64 = 0.2;
const LEFT_COUNTS: f64 = 40.0;
/// A ramp has begun in earnest after this share of it.
const RAMP_SHARE: f64 = 0.1;
/// Reversals of an output beyond this make a limit cycle, %...
const SWING_PERCENT: f64 = 25.0;
/// ...where so many of them come within this time, or within so many readings on a slow line. Settling after a move takes two or three.
const REVERSALS: usize = 8;
const REVERSALS_WITHIN: Duration = Duration::from_secs(4);
const REVERSALS_READINGS: u64 = 24;
/// What a unit that has started anew makes of its counts: nearly nothing, from at least this many.
const COUNTS_BEFORE: f64 = 100.0;

/// What is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The unit gives the motor nothing.
    NoOutput,
    /// The unit has started anew and has forgotten its command.
    StartedAnew,
    /// The motor gets its output and stands.
    Stall,
    /// The loop drives the motor to and fro.
    LimitCycle,
    /// The output may be too small for the friction, or no encoder counts: no fault.
    Stands,
}

/// A motor that does not do what it was told.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Which.
    pub motor: Motor,
    /// What it does.
    pub kind: Kind,
    /// The same for a person, with what to do.
    pub sentence: Message,
}

impl Finding {
    /// Whether the motion is not what was commanded; otherwise it is only to be known.
    pub fn is_fault(&self) -> bool {
        self.kind != Kind::Stands
    }
}

/// Compares what one link's selected unit is told with what it measures.
#[derive(Debug, Default)]
pub struct MotionCheck {
    /// The unit that is selected or was driven last; before that, whoever answers.
    address: Option<u8>,
    axes: [Axis; 2],
    status: Option<StatusReport>,
    /// A job judges its motion itself.
    in_job: bool,
}

#[derive(Debug, Default)]
struct Axis {
    watch: Option<Watch>,
    position: Option<f64>,
    /// Where its encoder was read first.
    first: Option<f64>,
    /// Its encoder counts.
    is_alive: bool,
    /// The duty that was told last.
    duty: f64,
}

/// A command and what was read since.
#[derive(Debug)]
struct Watch {
    command: DriveCommand,
    sent_at: Duration,
    /// The change of duty that it asks for.
    duty_change: f64,
    from: Option<f64>,
    nothing: Run,
    standing: Run,
    /// The position at which it stands.
    stands_at: f64,
    has_restarted: bool,
    /// The last output beyond the swing, and when its sign changed: reading and time.
    swing: f64,
    reversals: Vec<(u64, Duration)>,
    readings: u64,
    is_told: bool,
}

/// Readings in a row that say the same.
#[derive(Debug, Default)]
struct Run {
    since: Option<Duration>,
    readings: u32,
    amps: (f64, u32),
    percent: f64,
}

impl Run {
    /// For how long they have said it; nothing before there are enough.
    fn note(&mut self, holds: bool, at: Duration, amps: Option<f64>, percent: f64) -> Option<Duration> {
        if !holds {
            *self = Self::default();
            return None;
        }
        self.readings += 1;
        self.percent = percent;
        if let Some(amps) = amps {
            self.amps = (self.amps.0 + amps.abs(), self.amps.1 + 1);
        }
        let since = *self.since.get_or_insert(at);
        (self.readings >= LEAST_READINGS).then(|| at.saturating_sub(since))
    }

    fn mean_amps(&self) -> Option<f64> {
        (self.amps.1 > 0).then(|| self.amps.0 / f64::from(self.amps.1))
    }
}

/// One motor's readings of a sweep.
struct Measured {
    at: Duration,
    percent: Option<f64>,
    counts: Option<f64>,
    amps: Option<f64>,
}

impl MotionCheck {
    /// Takes in an event, and says once per command what it shows to be wrong.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn take(&mut self, event: &Event) -> Option<Finding> {
        match event {
            Event::Driven { address, sent_at, drive } => {
                self.address = Some(*address);
                self.driven(drive, *sent_at);
            }
            Event::Status(status) if self.is_of_unit(status.address) => self.status = Some(*status),
            Event::Sample(sample) if !self.in_job && self.is_of_unit(sample.address) => {
                return Motor::BOTH.into_iter().find_map(|motor| self.sampled(motor, sample));
            }
            Event::JobStarted { .. } => self.rest(true),
            Event::JobEnded(_) | Event::Disarmed(_) | Event::Stopped(_) => self.rest(false),
            Event::Selected { address, .. } => *self = Self { address: Some(*address), ..Self::default() },
            Event::Lost(_) | Event::Closed => *self = Self::default(),
            _ => {}
        }
        None
    }

    fn is_of_unit(&self, address: u8) -> bool {
        self.address.is_none_or(|own| own == address)
    }

    /// Nothing is commanded now.
    fn rest(&mut self, in_job: bool) {
        self.in_job = in_job;
        for axis in &mut self.axes {
            (axis.watch, axis.duty) = (None, 0.0);
        }
    }

    fn driven(&mut self, drive: &Drive, sent_at: Duration) {
        for motor in Motor::BOTH {
            let Some(command) = drive.of(motor) else { continue };
            let axis = &mut self.axes[motor.index()];
            // The same again changes nothing.
            if axis.watch.as_ref().is_some_and(|watch| watch.command == command) {
                continue;
            }
            let duty = if let DriveCommand::Duty { duty, .. } = command { duty } else { 0.0 };
            let change = (duty - std::mem::replace(&mut axis.duty, duty)).abs();
            axis.watch = is_judged(&command).then(|| Watch::new(command, sent_at, change, axis.position));
        }
    }

    fn sampled(&mut self, motor: Motor, sample: &Sample) -> Option<Finding> {
        let axis = &mut self.axes[motor.index()];
        let channel = |role: Role| {
            let readings = sample.readings().iter();
            readings
                .map(|reading| reading.channel)
                .find(|channel| channel.role == role && channel.motor == Some(motor))
        };
        let sent_at = axis.watch.as_ref().map(|watch| watch.sent_at);
        let read = |channel: Channel| {
            let (asked_at, _) = sample.span(channel)?;
            sample.get(channel).filter(|_| sent_at.is_none_or(|sent_at| asked_at > sent_at))
        };
        let value = |role| channel(role).and_then(read);
        let measured = Measured {
            at: sample.requested_at,
            percent: value(Role::Pwm),
            counts: value(Role::Position),
            amps: value(Role::Current),
        };
        if let Some(counts) = measured.counts {
            let first = *axis.first.get_or_insert(counts);
            axis.is_alive |= (counts - first).abs() > ALIVE_COUNTS;
        }
        let before = axis.position;
        axis.position = measured.counts.or(axis.position);
        let status = self.status.as_ref();
        let watch = axis.watch.as_mut().filter(|watch| !watch.is_told && measured.at > watch.sent_at)?;
        let (kind, said) = watch.judge(&measured, before, axis.is_alive, motor, status)?;
        watch.is_told = true;
        Some(Finding { motor, kind, sentence: said.into() })
    }
}

/// Whether a command is one that says what should be measured now: a move that waits for others does not.
fn is_judged(command: &DriveCommand) -> bool {
    match *command {
        DriveCommand::Duty { duty, .. } => duty.abs() * 100.0 > 2.0 * NOTHING_PERCENT,
        DriveCommand::Speed { speed_counts_per_s, .. } => speed_counts_per_s != 0,
        DriveCommand::Distance { queued, .. } | DriveCommand::Position { queued, .. } => !queued,
    }
}

impl Watch {
    fn new(command: DriveCommand, sent_at: Duration, duty_change: f64, from: Option<f64>) -> Self {
        Self {
            command,
            sent_at,
            duty_change,
            from,
            nothing: Run::default(),
            standing: Run::default(),
            stands_at: f64::NAN,
            has_restarted: false,
            swing: 0.0,
            reversals: Vec::new(),
            readings: 0,
            is_told: false,
        }
    }

    fn judge(
        &mut self,
        measured: &Measured,
        before: Option<f64>,
        is_alive: bool,
        motor: Motor,
        status: Option<&StatusReport>,
    ) -> Option<(Kind, MotionMessage)> {
        self.readings += 1;
        if self.from.is_none() {
            self.from = measured.counts;
        }
        if let (Some(before), Some(counts)) = (before, measured.counts) {
            // No motor comes from there to nothing between two readings: the counts were lost.
            self.has_restarted |= before.abs() >= COUNTS_BEFORE && counts.abs() * 10.0 < before.abs();
        }
        if let Some(percent) = measured.percent
            && let Some(found) = self.swings(percent, measured.at, motor)
        {
            return Some(found);
        }
        let is_due = self.is_due(measured.at) && self.is_on_its_way(measured.counts);
        self.gives_nothing(measured, is_due, motor, status)
            .or_else(|| self.stands(measured, is_due, is_alive, motor, status))
    }

    /// The share of its ramp that is over at a time; all of it where there is none that this program has asked for.
    fn ramp(&self, at: Duration) -> f64 {
        let since_s = at.saturating_sub(self.sent_at).as_secs_f64();
        let share = |accel: Option<f64>, of: f64| match accel {
            Some(accel) if of > 0.0 => (accel * since_s / of).min(1.0),
            _ => 1.0,
        };
        match self.command {
            DriveCommand::Duty { accel_duty_per_s, .. } => share(accel_duty_per_s, self.duty_change),
            DriveCommand::Speed { speed_counts_per_s, accel_counts_per_s2 }
            | DriveCommand::Distance { speed_counts_per_s, accel_counts_per_s2, .. } => {
                share(accel_counts_per_s2.map(f64::from), f64::from(speed_counts_per_s).abs())
            }
            DriveCommand::Position { speed_counts_per_s, accel_counts_per_s2, .. } => {
                share(Some(f64::from(accel_counts_per_s2)), f64::from(speed_counts_per_s))
            }
        }
    }

    /// Whether the command has had the time to show.
    fn is_due(&self, at: Duration) -> bool {
        match self.command {
            // Friction holds a motor through much of a ramp of its duty.
            DriveCommand::Duty { .. } => self.ramp(at) >= 1.0,
            DriveCommand::Speed { .. } | DriveCommand::Distance { .. } | DriveCommand::Position { .. } => {
                self.ramp(at) >= RAMP_SHARE
            }
        }
    }

    /// Whether a move has not come to its end yet; without counts it may have.
    fn is_on_its_way(&self, counts: Option<f64>) -> bool {
        let is_left = |of: f64, left: f64| left.abs() > (of.abs() * LEFT_SHARE).max(LEFT_COUNTS);
        match self.command {
            DriveCommand::Duty { .. } | DriveCommand::Speed { .. } => true,
            DriveCommand::Distance { distance_counts, .. } => {
                let distance = f64::from(distance_counts);
                counts
                    .zip(self.from)
                    .is_some_and(|(now, from)| is_left(distance, distance - (now - from).abs()))
            }
            DriveCommand::Position { position_counts, .. } => {
                let to = f64::from(position_counts);
                counts.zip(self.from).is_some_and(|(now, from)| is_left(to - from, to - now))
            }
        }
    }

    fn is_loop(&self) -> bool {
        !matches!(self.command, DriveCommand::Duty { .. })
    }

    /// "25.0 % duty", "12000 counts/s".
    fn commanded(&self) -> Message {
        match self.command {
            DriveCommand::Duty { duty, .. } => CommandedMessage::Duty { percent: duty * 100.0 },
            DriveCommand::Speed { speed_counts_per_s, .. } => CommandedMessage::Speed { speed_counts_per_s },
            DriveCommand::Distance { distance_counts, .. } => CommandedMessage::Distance { distance_counts },
            DriveCommand::Position { position_counts, .. } => CommandedMessage::Position { position_counts },
        }
        .into()
    }

    fn gives_nothing(
        &mut self,
        measured: &Measured,
        is_due: bool,
        motor: Motor,
        status: Option<&StatusReport>,
    ) -> Option<(Kind, MotionMessage)> {
        let percent = measured.percent?;
        let is_nothing = is_due && percent.abs() < NOTHING_PERCENT;
        let held = self.nothing.note(is_nothing, measured.at, measured.amps, percent)?;
        if held < NO_OUTPUT_FOR {
            return None;
        }
        let (kind, why) = match self.has_restarted {
            true => (Kind::StartedAnew, NoOutputMessage::StartedAnew.into()),
            false => (Kind::NoOutput, self.left_over(status)),
        };
        Some((kind, MotionMessage::NoOutput { motor, commanded: self.commanded(), why }))
    }

    /// What is left as the reason for no output.
    fn left_over(&self, status: Option<&StatusReport>) -> Message {
        let left: Message = match self.is_loop() {
            true => NoOutputMessage::LeftOfLoop.into(),
            false => NoOutputMessage::Left.into(),
        };
        let Some(status) = status else { return NoOutputMessage::Untold { left }.into() };
        let titles: Vec<&str> = status.active().map(|indicator| indicator.title).collect();
        match &titles[..] {
            [] => NoOutputMessage::NotNamed { left }.into(),
            titles => NoOutputMessage::Named { titles: titles.join(", "), left }.into(),
        }
    }

    fn stands(
        &mut self,
        measured: &Measured,
        is_due: bool,
        is_alive: bool,
        motor: Motor,
        status: Option<&StatusReport>,
    ) -> Option<(Kind, MotionMessage)> {
        let counts = measured.counts?;
        let is_limited = status.is_some_and(|status| is_at_current_limit(status, motor));
        // Where the output is not told, that of an open loop is what was commanded.
        let told = measured.percent.or(match self.command {
            DriveCommand::Duty { duty, .. } => Some(duty * 100.0),
            DriveCommand::Speed { .. } | DriveCommand::Distance { .. } | DriveCommand::Position { .. } => {
                None
            }
        });
        let percent = told.map_or(100.0, f64::abs);
        let has_output =
            percent >= NOTHING_PERCENT && (!self.is_loop() || percent >= LOOP_PERCENT || is_limited);
        if self.standing.since.is_none() {
            self.stands_at = counts;
        }
        let is_still = (counts - self.stands_at).abs() <= NOISE_COUNTS;
        let held =
            self.standing.note(is_due && has_output && is_still, measured.at, measured.amps, percent)?;
        let wanted = if measured.percent.is_some() { STANDS_FOR } else { STANDS_UNSEEN_FOR };
        if held < wanted {
            return None;
        }
        let amps = self.standing.mean_amps();
        let output: Message = match measured.percent {
            Some(_) => StandsMessage::AtOutput { percent }.into(),
            None => StandsMessage::Untold { commanded: self.commanded() }.into(),
        };
        let output = match amps {
            Some(amps) => StandsMessage::WithCurrent { output, amps }.into(),
            None => output,
        };
        let is_certain = self.is_loop() || is_alive || is_limited;
        Some(if !self.is_loop() && percent < FRICTION_PERCENT && !is_limited {
            (Kind::Stands, MotionMessage::Friction { motor, output })
        } else if !is_certain {
            (Kind::Stands, MotionMessage::NoCounts { motor, output })
        } else if amps.is_some_and(|amps| amps < NO_CURRENT_AMPS) {
            (Kind::Stall, MotionMessage::OpenLead { motor, output })
        } else if is_limited {
            (Kind::Stall, MotionMessage::BlockedAtLimit { motor, output })
        } else {
            (Kind::Stall, MotionMessage::Blocked { motor, output })
        })
    }

    /// An output that goes to and fro by a loop whose setpoint stands.
    fn swings(&mut self, percent: f64, at: Duration, motor: Motor) -> Option<(Kind, MotionMessage)> {
        if !self.is_loop() || percent.abs() < SWING_PERCENT {
            return None;
        }
        let (last, now) = (self.swing, (self.readings, at));
        self.swing = percent;
        if last * percent >= 0.0 {
            return None;
        }
        self.reversals.push(now);
        let is_recent = |(reading, then): &(u64, Duration)| {
            self.readings - reading <= REVERSALS_READINGS || at.saturating_sub(*then) <= REVERSALS_WITHIN
        };
        self.reversals.retain(is_recent);
        if self.reversals.len() < REVERSALS {
            return None;
        }
        let (low, high) = (last.min(percent), last.max(percent));
        let seconds = at.saturating_sub(self.reversals[0].1).as_secs_f64();
        let (reversals, commanded) = (self.reversals.len(), self.commanded());
        Some((
            Kind::LimitCycle,
            MotionMessage::LimitCycle { motor, low, high, reversals, seconds, commanded },
        ))
    }
}

/// Whether a unit reports that a motor's current is at its limit, by an indicator of that motor or of its only one.
fn is_at_current_limit(status: &StatusReport, motor: Motor) -> bool {
    let other = if motor == Motor::M1 { "m2" } else { "m1" };
    status.active().any(|indicator| indicator.key.contains("current") && !indicator.key.starts_with(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::device::Indicator;

    const QUARTER: DriveCommand = DriveCommand::Duty { duty: 0.25, accel_duty_per_s: None };

    fn ms(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    fn driven(command: DriveCommand) -> MotionCheck {
        let mut check = MotionCheck::default();
        let drive = Drive::one(Motor::M1, command);
        assert_eq!(check.take(&Event::Driven { address: 0x80, sent_at: ms(1000), drive }), None);
        check
    }

    /// A sweep at a time: output, counts and current, as far as they are told.
    fn sweep(at_ms: u64, values: &[(Channel, f64)]) -> Event {
        let mut sample = Sample::new(0x80);
        for (channel, value) in values {
            sample.set(*channel, *value, ms(at_ms), ms(at_ms + 2));
        }
        Event::Sample(Box::new(sample))
    }

    /// What is found of sweeps every so many ms from the command on, whose values go by the time since it.
    fn found(check: &mut MotionCheck, every_ms: u64, of: impl Fn(u64) -> Vec<(Channel, f64)>) -> Vec<Kind> {
        found_in(6000, check, every_ms, of)
    }

    fn found_in(
        within_ms: u64,
        check: &mut MotionCheck,
        every_ms: u64,
        of: impl Fn(u64) -> Vec<(Channel, f64)>,
    ) -> Vec<Kind> {
        let times = (1..within_ms / every_ms).map(|number| number * every_ms);
        times.filter_map(|ms| check.take(&sweep(1000 + ms, &of(ms)))).map(|finding| finding.kind).collect()
    }

    #[test]
    fn counts_that_begin_at_nothing_again_tell_a_unit_that_started_anew() {
        let mut check = driven(QUARTER);
        let lost = |ms: u64| {
            let (percent, counts) = if ms < 2000 { (25.0, ms as f64) } else { (0.0, 3.0) };
            vec![(Channel::M1_PWM, percent), (Channel::M1_POSITION, counts)]
        };
        assert_eq!(found(&mut check, 20, lost), [Kind::StartedAnew], "and it is told once");
    }

    #[test]
    fn a_few_readings_are_not_enough_however_long_they_take() {
        let nothing = |_: u64| vec![(Channel::M1_PWM, 0.0)];
        let mut check = driven(QUARTER);
        let slow: Vec<_> = (1..5).filter_map(|s| check.take(&sweep(1000 + 1500 * s, &nothing(0)))).collect();
        assert_eq!(slow, [], "a slow line, or a late computer");
        assert_eq!(found(&mut driven(QUARTER), 1000, nothing), [Kind::NoOutput]);
    }

    #[test]
    fn a_reading_that_was_asked_for_before_the_command_counts_for_nothing() {
        let mut check = driven(QUARTER);
        let early: Vec<_> =
            (0..50).filter_map(|n| check.take(&sweep(n * 20, &[(Channel::M1_PWM, 0.0)]))).collect();
        assert_eq!(early, []);
    }

    #[test]
    fn a_ramp_that_runs_a_queued_move_and_another_unit_are_not_judged() {
        let nothing = |_: u64| vec![(Channel::M1_PWM, 0.0), (Channel::M1_POSITION, 0.0)];
        let soft = DriveCommand::Duty { duty: 0.25, accel_duty_per_s: Some(0.01) };
        assert_eq!(found(&mut driven(soft), 20, nothing), []);
        let queued = DriveCommand::Distance {
            speed_counts_per_s: 1000,
            accel_counts_per_s2: None,
            distance_counts: 9000,
            queued: true,
        };
        assert_eq!(found(&mut driven(queued), 20, nothing), []);
        let mut check = driven(QUARTER);
        let drive = Drive::one(Motor::M1, QUARTER);
        check.take(&Event::Driven { address: 0x81, sent_at: ms(1000), drive });
        assert_eq!(found(&mut check, 20, nothing), [], "the samples are of 0x80");
    }

    #[test]
    fn a_firmware_that_does_not_tell_its_output_is_judged_by_its_counts_and_for_longer() {
        let stands = |ms: u64| vec![(Channel::M1_POSITION, if ms < 500 { ms as f64 } else { 500.0 })];
        let mut check = driven(QUARTER);
        assert_eq!(found(&mut check, 20, stands), [Kind::Stall]);
        assert_eq!(found(&mut driven(QUARTER), 20, |ms| vec![(Channel::M1_POSITION, ms as f64)]), []);
        assert_eq!(found(&mut driven(QUARTER), 20, |_| Vec::new()), [], "nothing is told");
    }

    #[test]
    fn what_the_status_reports_is_named_first() {
        static LIMIT: [Indicator; 1] = [Indicator {
            mask: 1,
            key: "positive_limit",
            short: "PL",
            title: "Positive limit input at ground",
            severity: brushwork_values::Severity::Warning,
        }];
        let mut check = driven(QUARTER);
        check.take(&Event::Status(StatusReport::new(0x80, ms(1001), 1, &LIMIT)));
        let said = (1..60).find_map(|n| check.take(&sweep(1000 + 20 * n, &[(Channel::M1_PWM, 0.0)])));
        let sentence = said.expect("it is found").sentence.to_string();
        assert!(sentence.contains("It reports: Positive limit input at ground."), "{sentence}");
    }

    #[test]
    fn a_move_that_has_come_to_its_end_rests_and_settling_is_no_limit_cycle() {
        let to = DriveCommand::Distance {
            speed_counts_per_s: 1000,
            accel_counts_per_s2: Some(4000),
            distance_counts: 1000,
            queued: false,
        };
        let done = |ms: u64| {
            let percent = match ms {
                0..1000 => 40.0,
                1000..1100 => -60.0,
                1100..1200 => 30.0,
                _ => 0.0,
            };
            vec![(Channel::M1_PWM, percent), (Channel::M1_POSITION, (ms as f64).min(1000.0))]
        };
        assert_eq!(found(&mut driven(to), 20, done), []);
        let swings = |ms: u64| {
            let percent = if (ms / 100).is_multiple_of(2) { 80.0 } else { -80.0 };
            vec![(Channel::M1_PWM, percent), (Channel::M1_POSITION, (ms % 200) as f64)]
        };
        let speed = DriveCommand::Speed { speed_counts_per_s: 3000, accel_counts_per_s2: None };
        assert_eq!(found(&mut driven(speed), 20, swings), [Kind::LimitCycle]);
        // Eight reversals that are 700 ms apart take longer than is looked back where readings are many.
        let slow = found_in(12_000, &mut driven(speed), 700, swings);
        assert_eq!(slow, [Kind::LimitCycle], "a slow line sees it too");
    }
}
