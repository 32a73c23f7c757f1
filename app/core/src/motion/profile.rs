//! Setpoint profiles: a single step, a square wave, a trapezoid, and jogging between two points. Pure: a profile becomes a
//! list of legs, which [`super::player`] plays.
//!
//! A step and a square wave change at once, a trapezoid and a jog at the pace of their screen. "At once" is, on the
//! Position screen, a move at QPPS that gets there within `AT_ONCE_S`; packet serial of generation 1 has no other.

use std::ops::RangeInclusive;
use std::time::Duration;

use crate::messages::ProfilePlanMessage;
use brushwork_link::device::DriveCommand;

/// In which a move on the Position screen that is to be a step reaches its full speed.
const AT_ONCE_S: f64 = 0.01;

/// How long a profile may take, so that nothing runs for ever that was forgotten.
pub const LONGEST: Duration = Duration::from_secs(600);
/// How often a profile may be repeated.
pub const COUNT_RANGE: RangeInclusive<u32> = 1..=1000;
/// How long a setpoint may be held.
pub const DWELL_RANGE_S: RangeInclusive<f64> = 0.1..=60.0;
/// How long a motor may take from one point to the other.
pub const WAY_LIMIT: Duration = Duration::from_secs(60);

/// What a profile looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    #[default]
    Step,
    Square,
    Trapezoid,
    Jog,
}

/// What the setpoints are: one for each screen that drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Percent of full duty.
    Duty,
    /// Counts/s.
    Speed,
    /// Counts.
    Position,
}

/// A profile as a person sets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    pub shape: Shape,
    /// Where it begins and comes back to: a setpoint, or a point in counts for a jog.
    pub from: f64,
    /// Where it goes.
    pub to: f64,
    /// How fast a jog of the PWM and the Velocity screen goes, in the unit of their sliders.
    pub rate: f64,
    /// How long each setpoint is held.
    pub dwell_s: f64,
    /// How often there and back; a single step is done once.
    pub count: u32,
}

/// How fast the screen lets its setpoints change: %/s on the PWM screen, counts/s² on the others; 0 is at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    pub accel: f64,
    /// Of the Position screen.
    pub decel: f64,
    /// Of the Position screen, counts/s.
    pub speed: f64,
}

/// What the chosen motors can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Setpoints that all of them can take.
    pub low: f64,
    pub high: f64,
    /// QPPS of the slowest.
    pub qpps: f64,
}

/// One part of a profile: a command, and when the next one follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leg {
    /// A setpoint that is held for a time.
    Hold { command: DriveCommand, time: Duration, is_step: bool },
    /// A setpoint that is held until the motors stand still, and then for a time.
    Settle { command: DriveCommand, dwell: Duration },
    /// A setpoint towards a count until that is passed; then rest for a time.
    GoTo { counts: f64, forward: DriveCommand, backward: DriveCommand, rest: DriveCommand, dwell: Duration },
}

impl Shape {
    pub const ALL: [Self; 4] = [Self::Step, Self::Square, Self::Trapezoid, Self::Jog];

    pub const fn title(self) -> &'static str {
        match self {
            Self::Step => "Single step",
            Self::Square => "Square wave",
            Self::Trapezoid => "Trapezoid",
            Self::Jog => "Jog between two points",
        }
    }
}

impl Mode {
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Duty => "%",
            Self::Speed => "counts/s",
            Self::Position => "counts",
        }
    }
}

impl Leg {
    /// What a marker in the graph says of it.
    pub fn text(&self) -> String {
        match self {
            Self::Hold { command, .. } | Self::Settle { command, .. } => setpoint_text(command),
            Self::GoTo { counts, forward, .. } => {
                format!("to {counts:.0} counts at {}", setpoint_text(forward))
            }
        }
    }

    /// The least time it takes.
    pub fn time(&self) -> Duration {
        match self {
            Self::Hold { time, .. } => *time,
            Self::Settle { dwell, .. } | Self::GoTo { dwell, .. } => *dwell,
        }
    }
}

/// "50.0 %", "8000 counts/s", "-1200 counts".
pub fn setpoint_text(command: &DriveCommand) -> String {
    match command {
        DriveCommand::Duty { duty, .. } => format!("{:.1} %", duty * 100.0),
        DriveCommand::Speed { speed_counts_per_s, .. }
        | DriveCommand::Distance { speed_counts_per_s, .. } => {
            format!("{speed_counts_per_s} counts/s")
        }
        DriveCommand::Position { position_counts, .. } => format!("{position_counts} counts"),
    }
}

/// The legs of a profile, or why there are none: a sentence.
pub fn legs(mode: Mode, profile: &Profile, pace: Pace, reach: Reach) -> Result<Vec<Leg>, ProfilePlanMessage> {
    check(mode, profile, pace, reach)?;
    let planner = Planner { mode, profile, pace, reach };
    let mut legs = planner.lead_in();
    for _ in 0..planner.rounds() {
        legs.extend(planner.round());
    }
    legs.extend(planner.lead_out());
    let time: Duration = legs.iter().map(Leg::time).sum();
    if time > LONGEST {
        return Err(ProfilePlanMessage::TooLong { seconds: time.as_secs_f64(), longest: LONGEST.as_secs() });
    }
    Ok(legs)
}

/// How long the whole takes, where time alone decides.
pub fn total_time(legs: &[Leg]) -> Duration {
    legs.iter().map(Leg::time).sum()
}

fn check(mode: Mode, profile: &Profile, pace: Pace, reach: Reach) -> Result<(), ProfilePlanMessage> {
    let unit = mode.unit();
    if !DWELL_RANGE_S.contains(&profile.dwell_s) || !COUNT_RANGE.contains(&profile.count) {
        return Err(ProfilePlanMessage::Bounds);
    }
    if profile.from == profile.to || !profile.from.is_finite() || !profile.to.is_finite() {
        return Err(ProfilePlanMessage::NoTravel);
    }
    let by_points = profile.shape == Shape::Jog && mode != Mode::Position;
    let asked = if by_points { vec![profile.rate, -profile.rate] } else { vec![profile.from, profile.to] };
    if asked.iter().any(|value| *value < reach.low || *value > reach.high) {
        return Err(ProfilePlanMessage::OutOfReach { low: reach.low, high: reach.high, unit });
    }
    if by_points && profile.rate <= 0.0 {
        return Err(ProfilePlanMessage::NoSpeed);
    }
    if profile.shape == Shape::Trapezoid && (pace.accel <= 0.0 || mode == Mode::Position && pace.decel <= 0.0)
    {
        return Err(ProfilePlanMessage::NoAcceleration);
    }
    if mode == Mode::Position && reach.qpps < 1.0 {
        return Err(ProfilePlanMessage::NoQpps);
    }
    Ok(())
}

struct Planner<'a> {
    mode: Mode,
    profile: &'a Profile,
    pace: Pace,
    reach: Reach,
}

impl Planner<'_> {
    fn dwell(&self) -> Duration {
        Duration::from_secs_f64(self.profile.dwell_s)
    }

    fn is_by_points(&self) -> bool {
        self.profile.shape == Shape::Jog && self.mode != Mode::Position
    }

    fn rounds(&self) -> u32 {
        if self.profile.shape == Shape::Step { 1 } else { self.profile.count }
    }

    /// To where it begins, at the screen's pace.
    fn lead_in(&self) -> Vec<Leg> {
        let from = self.profile.from;
        match self.mode {
            _ if self.is_by_points() => vec![self.go_to(from)],
            Mode::Position => vec![Leg::Settle { command: self.at_pace(from), dwell: self.dwell() }],
            Mode::Duty | Mode::Speed => {
                let time = self.dwell() + self.change_time(from);
                vec![Leg::Hold { command: self.at_pace(from), time, is_step: false }]
            }
        }
    }

    fn round(&self) -> Vec<Leg> {
        let Profile { from, to, .. } = *self.profile;
        let step = |value| Leg::Hold { command: self.at_once(value), time: self.dwell(), is_step: true };
        let ramp = |value| {
            let time = self.change_time(to - from) + self.dwell();
            Leg::Hold { command: self.at_pace(value), time, is_step: false }
        };
        match self.profile.shape {
            Shape::Step => vec![step(to)],
            Shape::Square => vec![step(to), step(from)],
            Shape::Jog if self.is_by_points() => vec![self.go_to(to), self.go_to(from)],
            Shape::Trapezoid | Shape::Jog => vec![ramp(to), ramp(from)],
        }
    }

    /// Back to rest at the screen's pace, so that the stop at the end finds a motor that stands.
    fn lead_out(&self) -> Option<Leg> {
        let last = if self.profile.shape == Shape::Step { self.profile.to } else { self.profile.from };
        let is_held = self.mode == Mode::Position || self.is_by_points() || last == 0.0;
        let time = self.change_time(last);
        (!is_held && !time.is_zero()).then(|| Leg::Hold { command: self.at_pace(0.0), time, is_step: false })
    }

    fn go_to(&self, counts: f64) -> Leg {
        let rate = self.profile.rate;
        Leg::GoTo {
            counts,
            forward: self.at_pace(rate),
            backward: self.at_pace(-rate),
            rest: self.at_pace(0.0),
            dwell: self.dwell(),
        }
    }

    /// Time that a change by `by` takes at the screen's pace.
    fn change_time(&self, by: f64) -> Duration {
        let by = by.abs();
        let Pace { accel, decel, speed } = self.pace;
        let seconds = match self.mode {
            Mode::Duty | Mode::Speed => by / accel,
            Mode::Position => move_time_s(by, speed.min(self.reach.qpps), accel, decel),
        };
        if seconds.is_finite() { Duration::from_secs_f64(seconds.min(1e6)) } else { Duration::ZERO }
    }

    fn at_pace(&self, value: f64) -> DriveCommand {
        let Pace { accel, decel, speed } = self.pace;
        match self.mode {
            Mode::Duty => duty(value, (accel > 0.0).then_some(accel / 100.0)),
            Mode::Speed => speed_command(value, (accel > 0.0).then(|| whole(accel))),
            Mode::Position => position(value, speed.min(self.reach.qpps), accel, decel),
        }
    }

    fn at_once(&self, value: f64) -> DriveCommand {
        match self.mode {
            Mode::Duty => duty(value, None),
            Mode::Speed => speed_command(value, None),
            Mode::Position => {
                let accel = self.reach.qpps / AT_ONCE_S;
                position(value, self.reach.qpps, accel, accel)
            }
        }
    }
}

/// Time of a move over `way` with a ramp at either end.
fn move_time_s(way: f64, speed: f64, accel: f64, decel: f64) -> f64 {
    let ramps = 1.0 / accel + 1.0 / decel;
    let ramps = if ramps.is_finite() { ramps } else { 0.0 };
    if speed * speed * ramps / 2.0 > way {
        (2.0 * way * ramps).sqrt()
    } else {
        way / speed + speed * ramps / 2.0
    }
}

fn duty(percent: f64, accel_duty_per_s: Option<f64>) -> DriveCommand {
    DriveCommand::Duty { duty: (percent / 100.0).clamp(-1.0, 1.0), accel_duty_per_s }
}

fn speed_command(counts_per_s: f64, accel_counts_per_s2: Option<u32>) -> DriveCommand {
    DriveCommand::Speed { speed_counts_per_s: counts_per_s.round() as i32, accel_counts_per_s2 }
}

fn position(counts: f64, speed: f64, accel: f64, decel: f64) -> DriveCommand {
    DriveCommand::Position {
        position_counts: counts.round() as i32,
        speed_counts_per_s: whole(speed),
        accel_counts_per_s2: whole(accel),
        decel_counts_per_s2: whole(decel),
        queued: false,
    }
}

/// A whole number that the wire takes; conversion saturates.
fn whole(value: f64) -> u32 {
    value.round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    const PACE: Pace = Pace { accel: 1000.0, decel: 500.0, speed: 2000.0 };
    const REACH: Reach = Reach { low: -10_000.0, high: 10_000.0, qpps: 10_000.0 };

    fn profile(shape: Shape) -> Profile {
        Profile { shape, from: 0.0, to: 4000.0, rate: 3000.0, dwell_s: 0.5, count: 3 }
    }

    fn speeds(legs: &[Leg]) -> Vec<f64> {
        let setpoint = |leg: &Leg| match leg {
            Leg::Hold { command, .. } | Leg::Settle { command, .. } => command.setpoint(),
            Leg::GoTo { counts, .. } => *counts,
        };
        legs.iter().map(setpoint).collect()
    }

    #[test]
    fn a_step_holds_its_base_then_steps_once_and_comes_to_rest_at_the_screens_pace() {
        let legs = legs(Mode::Speed, &profile(Shape::Step), PACE, REACH).unwrap();
        assert_eq!(speeds(&legs), [0.0, 4000.0, 0.0]);
        let Leg::Hold { command, is_step, time } = legs[1] else { panic!("{legs:?}") };
        assert_eq!(command, DriveCommand::Speed { speed_counts_per_s: 4000, accel_counts_per_s2: None });
        assert!(is_step && time == Duration::from_millis(500));
        // 4000 counts/s at 1000 counts/s².
        assert_eq!(legs[2].time(), Duration::from_secs(4));
    }

    #[test]
    fn a_square_wave_goes_there_and_back_as_often_as_asked() {
        let wave = Profile { from: -20.0, to: 20.0, ..profile(Shape::Square) };
        let reach = Reach { low: -100.0, high: 100.0, qpps: 0.0 };
        let legs = legs(Mode::Duty, &wave, Pace { accel: 100.0, ..PACE }, reach).unwrap();
        assert_eq!(speeds(&legs), [-20.0, 20.0, -20.0, 20.0, -20.0, 20.0, -20.0, 0.0]);
    }

    #[test]
    fn a_trapezoid_takes_its_ramps_and_its_dwell() {
        let legs = legs(Mode::Speed, &profile(Shape::Trapezoid), PACE, REACH).unwrap();
        assert_eq!(speeds(&legs)[..3], [0.0, 4000.0, 0.0]);
        assert_eq!(legs[1].time(), Duration::from_millis(4500));
    }

    #[test]
    fn a_move_takes_the_time_of_its_ramps_and_its_way() {
        // 2000 counts/s: 2 s up over 2000 counts, 4 s down over 4000, the rest of 10 000 in 2 s.
        assert!((move_time_s(10_000.0, 2000.0, 1000.0, 500.0) - 8.0).abs() < 1e-9);
        // Too short for full speed: 1500 counts end to end in sqrt(2 * 1500 * 0.003) s.
        assert!((move_time_s(1500.0, 2000.0, 1000.0, 500.0) - 3.0).abs() < 1e-9);
    }

    #[test]
    fn a_step_of_position_goes_at_full_speed_and_a_jog_at_the_screens() {
        let step = legs(Mode::Position, &profile(Shape::Step), PACE, REACH).unwrap();
        let Leg::Hold { command: DriveCommand::Position { speed_counts_per_s, .. }, .. } = step[1] else {
            panic!("{step:?}")
        };
        assert_eq!(speed_counts_per_s, 10_000);
        let jog = legs(Mode::Position, &profile(Shape::Jog), PACE, REACH).unwrap();
        assert_eq!(speeds(&jog), [0.0, 4000.0, 0.0, 4000.0, 0.0, 4000.0, 0.0]);
        let Leg::Hold { command: DriveCommand::Position { speed_counts_per_s, .. }, .. } = jog[1] else {
            panic!("{jog:?}")
        };
        assert_eq!(speed_counts_per_s, 2000);
    }

    #[test]
    fn a_jog_by_duty_goes_by_the_encoder_whatever_the_setpoints_reach() {
        let jog = Profile { from: -50_000.0, to: 50_000.0, rate: 25.0, ..profile(Shape::Jog) };
        let reach = Reach { low: -100.0, high: 100.0, qpps: 0.0 };
        let legs = legs(Mode::Duty, &jog, Pace { accel: 100.0, ..PACE }, reach).unwrap();
        assert_eq!(speeds(&legs)[..3], [-50_000.0, 50_000.0, -50_000.0]);
        let Leg::GoTo { forward, backward, .. } = legs[0] else { panic!("{legs:?}") };
        assert_eq!((forward.setpoint(), backward.setpoint()), (25.0, -25.0));
    }

    #[test]
    fn what_cannot_be_done_is_refused_in_a_sentence() {
        let refused = |mode, profile, pace| legs(mode, &profile, pace, REACH).unwrap_err().to_string();
        let step = profile(Shape::Step);
        assert!(refused(Mode::Speed, Profile { to: 10_001.0, ..step }, PACE).contains("-10000 to 10000"));
        assert!(refused(Mode::Speed, Profile { to: 0.0, ..step }, PACE).contains("the same"));
        assert!(refused(Mode::Speed, Profile { to: f64::NAN, ..step }, PACE).contains("the same"));
        let slow = Pace { accel: 0.0, ..PACE };
        assert!(refused(Mode::Speed, profile(Shape::Trapezoid), slow).contains("acceleration"));
        let long = Profile { count: 1000, dwell_s: 10.0, ..profile(Shape::Square) };
        assert!(refused(Mode::Speed, long, PACE).contains("20010 s"), "{}", refused(Mode::Speed, long, PACE));
        assert!(
            refused(Mode::Speed, Profile { rate: 0.0, ..profile(Shape::Jog) }, PACE).contains("how fast")
        );
    }
}
