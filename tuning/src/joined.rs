//! The laws of two kinds of controllers as one, so that a run, its report and its file are the same whichever is at the wire.
//!
//! What is of a controller stands beside the same of the other one, which is left empty. Reports say the first kind's law of every
//! controller, so that they can be read without knowing the second.

use crate::axis::{Axis, AxisError, Exchange, Sample, TestedLoop, Want};
use crate::cause::Cause;
use crate::duty_limiter::DutyLimit;
use crate::experiment_guard::ExperimentGuard;
use crate::gains::Gains;
use crate::law::{Ending, Facts, Law, Seen, Stamps, Windup};
use crate::law_probe::LawProbe;
use crate::model::DerivativeFilter;
use crate::open_loop_record::Actuation;
use crate::registers::{FeedForward, RegisterField, RegisterTable};
use crate::request::Method;
use crate::setpoint::Setpoint;
use crate::setup::{LoopAxis, Setup};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::time::Duration;

/// Something of each, of which that of the controller at the wire is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Both<A, B> {
    /// Of the first kind; of a law, what reports say of every one.
    #[serde(flatten)]
    pub first: A,
    /// Of the second kind, where the controller is one.
    #[serde(flatten)]
    pub second: B,
}

/// One or the other: what goes over in a write, and what is noted of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Either<A, B> {
    /// The first kind's.
    First(A),
    /// The second kind's.
    Second(B),
}

/// A law that stands first, so that reports say it of every controller.
pub trait LeadingLaw: LawProbe {
    /// What is said of a loop of this rate that is none of this law.
    fn standing_in(rate_hz: u32) -> Self;
}

/// What a law of the second kind has, or nothing of it.
pub trait Part {
    /// Whether the controller is of this kind.
    fn is_there(&self) -> bool;
}

/// A law of the second kind, or none.
pub trait LawPart:
    Part + Copy + Debug + Default + PartialEq + Send + Sync + Serialize + DeserializeOwned + 'static
{
    /// The law.
    type Law: Law<Held: Part, Registers: Part>;
    /// It, where the controller has it.
    fn law(&self) -> Option<Self::Law>;
    /// That of a controller that has it.
    fn of(law: Self::Law) -> Self;
}

type Held<L> = <L as Law>::Held;
type Registers<L> = <L as Law>::Registers;
type Write<L> = <L as Law>::Write;

impl<A: LeadingLaw, P: LawPart> Both<A, P> {
    /// The law of a controller of the second kind.
    pub fn second(law: P::Law) -> Self {
        Self { first: A::standing_in(law.rate_hz()), second: P::of(law) }
    }
}

fn first<A, B>(writes: Vec<A>) -> Vec<Either<A, B>> {
    writes.into_iter().map(Either::First).collect()
}

fn second<A, B>(writes: Vec<B>) -> Vec<Either<A, B>> {
    writes.into_iter().map(Either::Second).collect()
}

/// What the law of the controller's kind says of something that is held or registered.
macro_rules! of_kind {
    ($of:ident.$what:ident($($with:expr),*)) => {
        if $of.second.is_there() {
            P::Law::$what(&$of.second, $($with),*)
        } else {
            A::$what(&$of.first, $($with),*)
        }
    };
}

/// What the law itself says.
macro_rules! of_law {
    ($of:ident.$what:ident($($with:expr),*)) => {
        match $of.second.law() {
            Some(law) => law.$what($($with),*),
            None => $of.first.$what($($with),*),
        }
    };
}

impl<A: LeadingLaw, P: LawPart> Law for Both<A, P> {
    type Held = Both<Held<A>, Held<P::Law>>;
    type Registers = Both<Registers<A>, Registers<P::Law>>;
    type Write = Either<Write<A>, Write<P::Law>>;
    type Note = Either<A::Note, <P::Law as Law>::Note>;
    type Findings = A::Findings;
    type Loop = Both<A::Loop, <P::Law as Law>::Loop>;

    fn facts(&self) -> &'static Facts {
        of_law!(self.facts())
    }

    fn rate_hz(&self) -> u32 {
        of_law!(self.rate_hz())
    }

    fn at_rate(&self, rate_hz: u32) -> Self {
        match self.second.law() {
            Some(law) => Self::second(law.at_rate(rate_hz)),
            None => Self { first: self.first.at_rate(rate_hz), ..*self },
        }
    }

    fn feed_forward(&self) -> f64 {
        of_law!(self.feed_forward())
    }

    fn derivative_filter(&self) -> Option<DerivativeFilter> {
        of_law!(self.derivative_filter())
    }

    fn with_other_sum(&self, gains: &Gains) -> Option<(Self, Gains)> {
        match self.second.law() {
            Some(law) => law.with_other_sum(gains).map(|(law, gains)| (Self::second(law), gains)),
            None => self.first.with_other_sum(gains).map(|(first, gains)| (Self { first, ..*self }, gains)),
        }
    }

    fn windup(&self) -> Windup {
        of_law!(self.windup())
    }

    fn with_windup(&self, windup: Windup) -> Option<Self> {
        match self.second.law() {
            Some(law) => law.with_windup(windup).map(Self::second),
            None => self.first.with_windup(windup).map(|first| Self { first, ..*self }),
        }
    }

    fn duty_limit(&self) -> Option<DutyLimit> {
        of_law!(self.duty_limit())
    }

    fn tick(&self, state: &mut Self::Loop, gains: (&Gains, f64), setpoint: Setpoint, seen: &Seen<'_>) -> f64 {
        match self.second.law() {
            Some(law) => law.tick(&mut state.second, gains, setpoint, seen),
            None => self.first.tick(&mut state.first, gains, setpoint, seen),
        }
    }

    fn steady(&self, gains: (&Gains, f64), speed: f64, duty: f64) -> Self::Loop {
        match self.second.law() {
            Some(law) => Both { second: law.steady(gains, speed, duty), ..Both::default() },
            None => Both { first: self.first.steady(gains, speed, duty), ..Both::default() },
        }
    }

    fn rounded(&self, gains: &Gains, qpps: f64) -> Gains {
        of_law!(self.rounded(gains, qpps))
    }

    fn steps_around(&self, gains: &Gains, qpps: f64) -> Vec<Gains> {
        of_law!(self.steps_around(gains, qpps))
    }

    fn sum_bounds(&self, wanted: f64) -> Vec<f64> {
        of_law!(self.sum_bounds(wanted))
    }

    fn registers(
        &self,
        held: &Self::Held,
        gains: &Gains,
        qpps: f64,
        travel: Option<(i64, i64)>,
    ) -> Self::Registers {
        match self.second.law() {
            Some(law) => Both { second: law.registers(&held.second, gains, qpps, travel), ..Both::default() },
            None => Both { first: self.first.registers(&held.first, gains, qpps, travel), ..Both::default() },
        }
    }

    fn gains(&self, registers: &Self::Registers, qpps: f64, is_position: bool) -> Gains {
        match self.second.law() {
            Some(law) => law.gains(&registers.second, qpps, is_position),
            None => self.first.gains(&registers.first, qpps, is_position),
        }
    }

    fn with_registers(&self, registers: &Self::Registers) -> Self {
        match self.second.law() {
            Some(law) => Self::second(law.with_registers(&registers.second)),
            None => Self { first: self.first.with_registers(&registers.first), ..*self },
        }
    }

    fn rows(&self, held: &Self::Held, proposed: &Self::Registers) -> Vec<[String; 4]> {
        if held.second.is_there() {
            self.second.law().unwrap_or_default().rows(&held.second, &proposed.second)
        } else {
            self.first.rows(&held.first, &proposed.first)
        }
    }

    fn refuse(registers: &Self::Registers) -> Result<(), Cause> {
        of_kind!(registers.refuse())
    }

    fn writes(registers: &Self::Registers, is_position: bool) -> Vec<Self::Write> {
        if registers.second.is_there() {
            second(P::Law::writes(&registers.second, is_position))
        } else {
            first(A::writes(&registers.first, is_position))
        }
    }

    fn before(held: &Self::Held) -> Self::Registers {
        if held.second.is_there() {
            Both { second: P::Law::before(&held.second), ..Both::default() }
        } else {
            Both { first: A::before(&held.first), ..Both::default() }
        }
    }

    fn take(registers: &mut Self::Registers, write: &Self::Write) {
        match write {
            Either::First(write) => A::take(&mut registers.first, write),
            Either::Second(write) => P::Law::take(&mut registers.second, write),
        }
    }

    fn step_duty(&self, registers: &Self::Registers) -> f64 {
        match self.second.law() {
            Some(law) => law.step_duty(&registers.second),
            None => self.first.step_duty(&registers.first),
        }
    }

    fn note(write: Self::Write, answer: Result<(), AxisError>) -> Self::Note {
        match write {
            Either::First(write) => Either::First(A::note(write, answer)),
            Either::Second(write) => Either::Second(P::Law::note(write, answer)),
        }
    }

    fn noted(note: &Self::Note) -> (Self::Write, Result<(), AxisError>) {
        match note {
            Either::First(note) => {
                let (write, answer) = A::noted(note);
                (Either::First(write), answer)
            }
            Either::Second(note) => {
                let (write, answer) = P::Law::noted(note);
                (Either::Second(write), answer)
            }
        }
    }

    fn of_unit(&self, held: &Self::Held) -> Self {
        if held.second.is_there() {
            Self::second(P::Law::default().of_unit(&held.second))
        } else {
            Self { first: self.first.of_unit(&held.first), ..*self }
        }
    }

    fn of_motor(&self, qpps: f64, max_current_raw: u32) -> Self {
        match self.second.law() {
            Some(law) => Self::second(law.of_motor(qpps, max_current_raw)),
            None => Self { first: self.first.of_motor(qpps, max_current_raw), ..*self },
        }
    }

    fn why_not_found(findings: &Self::Findings) -> Cause {
        A::why_not_found(findings)
    }

    fn is_rate_known(findings: &Self::Findings) -> bool {
        A::is_rate_known(findings)
    }

    fn is_derivative_known(findings: &Self::Findings) -> bool {
        A::is_derivative_known(findings)
    }

    fn derivative_noise(findings: &Self::Findings) -> Option<f64> {
        A::derivative_noise(findings)
    }

    fn found(&self, findings: &Self::Findings, is_position: bool) -> Option<Self> {
        self.first.found(findings, is_position).map(|first| Self { first, ..*self })
    }

    fn ready(held: &Self::Held) -> Result<(), Cause> {
        of_kind!(held.ready())
    }

    fn position_limits(held: &Self::Held) -> Option<(i64, i64)> {
        of_kind!(held.position_limits())
    }

    fn fault(held: &Self::Held, status_raw: u32) -> Cause {
        of_kind!(held.fault(status_raw))
    }

    fn actuation(held: &Self::Held, max_current_raw: u32) -> Actuation {
        of_kind!(held.actuation(max_current_raw))
    }

    fn stamps(held: &Self::Held) -> Stamps {
        of_kind!(held.stamps())
    }

    fn goes_on(held: &Self::Held) -> bool {
        of_kind!(held.goes_on())
    }

    fn keeping(registers: &Self::Registers) -> Vec<Self::Write> {
        if registers.second.is_there() {
            second(P::Law::keeping(&registers.second))
        } else {
            first(A::keeping(&registers.first))
        }
    }

    fn ending(held: &Self::Held, ending: Ending<'_, Self>) -> Vec<Self::Write> {
        let Ending { kept, is_touched, stays_off } = ending;
        if held.second.is_there() {
            let kept = kept.map(|kept| &kept.second);
            second(P::Law::ending(&held.second, Ending { kept, is_touched, stays_off }))
        } else {
            let kept = kept.map(|kept| &kept.first);
            first(A::ending(&held.first, Ending { kept, is_touched, stays_off }))
        }
    }
}

impl<A: RegisterTable + Default, B: RegisterTable + Part + Default> RegisterTable for Both<A, B> {
    fn fields() -> Vec<&'static RegisterField> {
        [A::fields(), B::fields()].concat()
    }

    fn raw(&self, key: &str) -> Option<i64> {
        if self.second.is_there() { self.second.raw(key) } else { self.first.raw(key) }
    }

    fn set_raw(&mut self, key: &str, raw: i64) {
        if self.second.is_there() { self.second.set_raw(key, raw) } else { self.first.set_raw(key, raw) }
    }

    fn blank(with_position: bool) -> Self {
        Self { first: A::blank(with_position), ..Self::default() }
    }

    fn of_speed(self) -> Self {
        Self { first: self.first.of_speed(), second: self.second.of_speed() }
    }

    fn has_a_loop(&self) -> bool {
        if self.second.is_there() { self.second.has_a_loop() } else { self.first.has_a_loop() }
    }

    fn is_one_set(&self) -> bool {
        if self.second.is_there() { self.second.is_one_set() } else { self.first.is_one_set() }
    }

    fn feed_forward(&self, qpps: f64) -> Option<FeedForward> {
        if self.second.is_there() { self.second.feed_forward(qpps) } else { self.first.feed_forward(qpps) }
    }

    /// Of the kind whose settings the controller has.
    fn of_values(raw: &dyn Fn(&RegisterField) -> Option<i64>, with_position: bool) -> Option<Self> {
        match B::of_values(raw, with_position) {
            Some(second) => Some(Self { second, ..Self::default() }),
            None => Some(Self { first: A::of_values(raw, with_position)?, ..Self::default() }),
        }
    }
}

/// Only a law of the first kind is found out: where [`Facts::can_be_probed`] says so of the second, nothing is.
impl<A: LeadingLaw, P: LawPart> LawProbe for Both<A, P> {
    fn probe<J: Law>(
        guard: &mut ExperimentGuard<'_, J>,
        held: &Self::Held,
        write: &dyn Fn(Self::Write) -> J::Write,
        start_duty: f64,
        method: Method,
    ) -> Result<Option<Self::Findings>, Cause> {
        A::probe(guard, &held.first, &|one| write(Either::First(one)), start_duty, method)
    }
}

/// Joined laws stand first for a third.
impl<A: LeadingLaw, P: LawPart> LeadingLaw for Both<A, P> {
    fn standing_in(rate_hz: u32) -> Self {
        Self { first: A::standing_in(rate_hz), second: P::default() }
    }
}

/// An axis with the loops of one law, as one with those of a joined law.
pub struct Joined<'a, L: Law, J: Law> {
    axis: Box<dyn LoopAxis<L> + 'a>,
    held: fn(L::Held) -> J::Held,
    write: fn(J::Write) -> Option<L::Write>,
}

impl<'a, A: LeadingLaw, P: LawPart> Joined<'a, A, Both<A, P>> {
    /// An axis on a controller of the first kind.
    pub fn first(axis: Box<dyn LoopAxis<A> + 'a>) -> Self {
        let write = |write| match write {
            Either::First(write) => Some(write),
            Either::Second(_) => None,
        };
        Self { axis, held: |first| Both { first, ..Both::default() }, write }
    }
}

impl<'a, A: LeadingLaw, P: LawPart> Joined<'a, P::Law, Both<A, P>> {
    /// An axis on a controller of the second kind.
    pub fn second(axis: Box<dyn LoopAxis<P::Law> + 'a>) -> Self {
        let write = |write| match write {
            Either::First(_) => None,
            Either::Second(write) => Some(write),
        };
        Self { axis, held: |second| Both { second, ..Both::default() }, write }
    }
}

impl<L: Law, J: Law> LoopAxis<J> for Joined<'_, L, J> {
    fn read_setup(&mut self) -> Result<Setup<J>, AxisError> {
        Ok(self.axis.read_setup()?.with_held(self.held))
    }

    fn write(&mut self, write: J::Write) -> Result<(), AxisError> {
        match (self.write)(write) {
            Some(write) => self.axis.write(write),
            None => Err(AxisError::Refused("gains of another family".into())),
        }
    }
}

impl<L: Law, J: Law> Axis for Joined<'_, L, J> {
    fn now(&mut self) -> Duration {
        self.axis.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.axis.wait_until(time)
    }

    fn sample(&mut self, want: Want) -> Result<Sample, AxisError> {
        self.axis.sample(want)
    }

    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        self.axis.drive_duty(duty_raw)
    }

    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        self.axis.command_speed(counts_per_s)
    }

    fn command_position(&mut self, counts: i32, speed_counts_per_s: u32) -> Result<Exchange, AxisError> {
        self.axis.command_position(counts, speed_counts_per_s)
    }

    fn write_winding(&mut self, inductance_resistance_raw: [u32; 2]) -> Result<(), AxisError> {
        self.axis.write_winding(inductance_resistance_raw)
    }

    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError> {
        self.axis.write_current_limits(max_raw, min_raw)
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        self.axis.raw_speed()
    }

    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError> {
        self.axis.set_stream_timeout(milliseconds)
    }

    fn start_own_test(
        &mut self,
        tested: TestedLoop,
        height_raw: u32,
        hysteresis: u32,
    ) -> Result<(Exchange, u32), AxisError> {
        self.axis.start_own_test(tested, height_raw, hysteresis)
    }

    fn read_own_test(&mut self) -> Result<[u32; 2], AxisError> {
        self.axis.read_own_test()
    }

    fn set_travel(&mut self, counts: (i64, i64)) -> Result<(), AxisError> {
        self.axis.set_travel(counts)
    }

    fn stolen(&mut self) -> Duration {
        self.axis.stolen()
    }

    fn progress(&mut self, text: &str) {
        self.axis.progress(text);
    }
}
