//! A controller of another make: its own loop, its own line, noise on the currents it reports.

use super::machine::{Complex, Draw, Machine, Motor};
use brushwork_mcp_axis::{McpHeld, McpLaw, McpWrite, PositionRegisters, VelocityRegisters};
use brushwork_tuning::axis::{Axis, AxisError, Exchange, Sample, Status, Want};
use brushwork_tuning::setup::{LoopAxis, Setup};
use std::f64::consts::{PI, TAU};
use std::time::Duration;

/// Duty per second of the highest acceleration that is given with a duty.
const SLEW_PER_S: f64 = 20.0;
/// A drive is over after such a pause, s; a loop that is given a motor drives it clearly from such a duty on.
const PAUSE_S: f64 = 0.2;
const CLEAR_DUTY: f64 = 0.25;
/// At how many frequencies the response is worked out, evenly by their logarithm, and the lowest as a share of the highest.
const POINTS: u32 = 1_200;
const LEAST_SHARE: f64 = 1e-7;
/// Standard deviation of a current of a usual sensor, A.
pub const NOISE_AMPS: f64 = 0.02;

/// The law of its loop.
#[derive(Clone, Copy, Debug)]
pub struct LawOptions {
    pub rate_hz: f64,
    pub per_tick: bool,
    /// Share of the setpoint over QPPS that is added.
    pub feed_forward: f64,
    /// What a P register of 65536 multiplies the error with.
    pub proportional: f64,
    /// The position register of a gain of 1.
    pub position_scale: f64,
    /// Whether D of the position sees the filtered speed.
    pub filters_derivative: bool,
    /// Low pass on the speed, s; 0 = none.
    pub filter_s: f64,
    /// Ticks by which the duty comes late.
    pub late_ticks: usize,
}

impl LawOptions {
    fn tick_s(&self) -> f64 {
        1.0 / self.rate_hz
    }

    /// P, I in 1/s and D in s of registers.
    fn gains(&self, registers: &VelocityRegisters) -> (f64, f64, f64) {
        let step = if self.per_tick { self.rate_hz } else { 1.0 };
        let of = |raw: u32| f64::from(raw) / 65_536.0;
        (self.proportional * of(registers.p), of(registers.i) * step, of(registers.d) / step)
    }

    /// P in 1/s, I in 1/s^2 and D of the position's registers.
    fn position_gains(&self, registers: &PositionRegisters) -> (f64, f64, f64) {
        let step = if self.per_tick { self.rate_hz } else { 1.0 };
        let of = |raw: u32| f64::from(raw) / self.position_scale;
        (of(registers.p), of(registers.i) * step, of(registers.d) / step)
    }

    fn filter_share(&self) -> f64 {
        if self.filter_s > 0.0 { 1.0 - (-self.tick_s() / self.filter_s).exp() } else { 1.0 }
    }

    /// Filter and late ticks together, s. A sampled filter of a share `a` is late by `(1 - a) / a` ticks.
    pub fn lag_s(&self) -> f64 {
        let share = self.filter_share();
        ((1.0 - share) / share + self.late_ticks as f64) * self.tick_s()
    }
}

/// The highest sensitivity of the loop of registers on a motor, by the sampled response of winding, shaft, hold, difference and filter;
/// `None` where it is unstable.
pub fn sensitivity(
    motor: &Motor,
    law: &LawOptions,
    registers: &VelocityRegisters,
    position: Option<&PositionRegisters>,
) -> Option<f64> {
    let (p, i, d) = law.gains(registers);
    let around = position.map(|registers| law.position_gains(registers));
    let tick = law.tick_s();
    let share = law.filter_share();
    let open: Vec<Complex> = (0..POINTS)
        .map(|n| {
            let w = 0.999 * PI / tick * LEAST_SHARE.powf(1.0 - f64::from(n) / f64::from(POINTS - 1));
            let back = Complex::turn(-w * tick);
            let hold = Complex(1.0, 0.0).add(back.times(-1.0));
            let sampled = (-30..=30).fold(Complex(0.0, 0.0), |sum, k| {
                let s = Complex(0.0, w + f64::from(k) * TAU / tick);
                sum.add(motor.response(s).mul(hold).over(s.times(tick)))
            });
            let slope = hold.times(1.0 / tick);
            let filter = Complex(share, 0.0).over(Complex(1.0, 0.0).add(back.times(share - 1.0)));
            // The sum is taken before the present error is added to it.
            let sum = back.over(slope);
            let controller = Complex(p, 0.0).add(sum.times(i)).add(slope.times(d));
            let late = Complex::turn(-w * tick * law.late_ticks as f64);
            let speed = filter.mul(slope);
            let mut back_to_duty = controller.mul(speed);
            if let Some((p, i, d)) = around {
                let seen = if law.filters_derivative { speed } else { slope };
                // The sum takes the present error first.
                let wanted = Complex(p, 0.0).add(Complex(i, 0.0).over(slope)).add(seen.times(d));
                back_to_duty = back_to_duty.add(wanted.mul(controller.plus(law.feed_forward)));
            }
            let loops = back_to_duty.mul(sampled).mul(late);
            loops.times(1.0 / f64::from(registers.qpps.max(1)))
        })
        .collect();
    let returned: Vec<Complex> = open.iter().map(|l| l.plus(1.0)).collect();
    // The argument begins at a quarter turn back for each integrator. It ends at nought where nothing is unstable: Nyquist's criterion.
    let integrators = [true, i > 0.0, around.is_some_and(|gains| gains.1 > 0.0)];
    let of_motor = usize::from(around.is_none());
    let begins = -0.5 * PI * (integrators.into_iter().filter(|is| *is).count() - of_motor) as f64;
    let first = returned[0].angle();
    let first = first + TAU * ((begins - first) / TAU).round();
    let turned: f64 = returned.windows(2).map(|two| two[1].over(two[0]).angle()).sum();
    let highest = returned.iter().map(|r| 1.0 / r.size()).fold(0.0, f64::max);
    ((first + turned).abs() < 0.5 * PI).then_some(highest)
}

#[derive(Clone, Copy)]
enum Task {
    Duty(f64),
    Speed(f64),
    /// A count, and the highest speed.
    Position(f64, f64),
}

/// What may happen to it in the midst of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    Locked,
    MotorOpened,
    EncoderLost,
    EncoderFlipped,
    /// Nothing arrives any more, or what arrives is not answered.
    LinkLost,
    RepliesLost,
}

/// How long the bridge gives a duty after a fault.
#[derive(Clone, Copy, Default)]
pub struct Driven {
    /// From when on without a pause, and until when, s.
    now: Option<(f64, f64)>,
    /// Whether the duty was clear in that time.
    is_clear: bool,
    /// The longest of them, s.
    pub longest_s: f64,
}

impl Driven {
    fn see(&mut self, t: f64, duty: f64) {
        if duty == 0.0 {
            return;
        }
        let goes_on = self.now.is_some_and(|(_, until)| t - until < PAUSE_S);
        if !goes_on {
            *self = Self { now: None, is_clear: false, ..*self };
        }
        // A creep before it is no part of it.
        let from = self.now.filter(|_| self.is_clear).map_or(t, |now| now.0);
        self.is_clear |= duty.abs() >= CLEAR_DUTY;
        self.now = Some((from, t));
        self.longest_s = self.longest_s.max(t - from);
    }
}

/// The controller, its motor and the line to it, in a time that calls alone move on.
pub struct Controller {
    pub machine: Machine,
    pub law: LawOptions,
    pub velocity: VelocityRegisters,
    pub position: PositionRegisters,
    limits: (u32, i32),
    now: Duration,
    ticks: u64,
    task: Task,
    duty: f64,
    pending: Vec<f64>,
    count: f64,
    raw_speed: f64,
    speed: f64,
    sum: f64,
    last_error: f64,
    position_sum: f64,
    latency_s: f64,
    loss: f64,
    draw: Draw,
    /// Standard deviation of a current, A.
    pub noise_amps: f64,
    /// When it is reset, if ever.
    pub reset_at: Option<Duration>,
    zero: f64,
    /// When it was asked last, and after how long a silence it switches off.
    heard: Duration,
    stream_timeout: Duration,
    /// What happens, and when; and the bridge since.
    pub fault: Option<(Fault, Duration)>,
    pub driven: Driven,
    /// What the encoder counts of the shaft's counts, and the counts at which that was not all: those of the shaft and those counted.
    counted: f64,
    turned_at: (f64, f64),
}

impl Controller {
    pub fn new(motor: Motor, law: LawOptions, mut draw: Draw) -> Self {
        let machine = Machine::new(motor);
        Self {
            count: machine.count(),
            machine,
            law,
            velocity: VelocityRegisters { p: 0x1_0000, i: 0x8000, d: 0x4000, qpps: 44_000 },
            position: PositionRegisters {
                min: -2_000_000_000,
                max: 2_000_000_000,
                ..PositionRegisters::default()
            },
            limits: ((100.0 * motor.limit_amps) as u32, 0),
            now: Duration::from_millis(700),
            ticks: 0,
            task: Task::Duty(0.0),
            duty: 0.0,
            pending: vec![0.0; law.late_ticks],
            raw_speed: 0.0,
            speed: 0.0,
            sum: 0.0,
            last_error: 0.0,
            position_sum: 0.0,
            latency_s: draw.log(0.0005, 0.003),
            loss: draw.between(0.0, 0.01),
            draw,
            noise_amps: NOISE_AMPS,
            reset_at: None,
            zero: 0.0,
            heard: Duration::ZERO,
            stream_timeout: Duration::from_secs(1),
            fault: None,
            driven: Driven::default(),
            counted: 1.0,
            turned_at: (0.0, 0.0),
        }
    }

    fn has_struck(&self) -> Option<Fault> {
        let t = self.ticks as f64 * self.law.tick_s();
        self.fault.filter(|(_, at)| t > at.as_secs_f64()).map(|(fault, _)| fault)
    }

    /// Sees to what has happened.
    fn suffer(&mut self, fault: Fault) {
        let counted = match fault {
            Fault::EncoderLost => 0.0,
            Fault::EncoderFlipped => -1.0,
            Fault::Locked | Fault::MotorOpened | Fault::LinkLost | Fault::RepliesLost => 1.0,
        };
        if counted != self.counted {
            self.turned_at = (self.machine.count(), self.shaft_count());
            self.counted = counted;
        }
        self.machine.is_locked = fault == Fault::Locked;
        self.machine.is_open = fault == Fault::MotorOpened;
    }

    fn shaft_count(&self) -> f64 {
        self.turned_at.1 + self.counted * (self.machine.count() - self.turned_at.0)
    }

    fn advance(&mut self, to: Duration) {
        while (self.ticks + 1) as f64 * self.law.tick_s() <= to.as_secs_f64() {
            self.ticks += 1;
            if self.reset_at.is_some_and(|at| self.ticks as f64 * self.law.tick_s() > at.as_secs_f64()) {
                self.reset();
            }
            self.machine.advance(self.duty, self.law.tick_s());
            self.tick();
            let silent = to.min(Duration::from_secs_f64(self.ticks as f64 * self.law.tick_s()));
            if silent.saturating_sub(self.heard) > self.stream_timeout {
                self.task = Task::Duty(0.0);
                self.duty = 0.0;
            }
            if let Some(fault) = self.has_struck() {
                self.suffer(fault);
                self.driven.see(self.ticks as f64 * self.law.tick_s(), self.duty);
            }
        }
        self.now = self.now.max(to);
    }

    /// As after a short loss of its supply.
    fn reset(&mut self) {
        self.reset_at = None;
        self.velocity = VelocityRegisters { p: 0x1_0000, i: 0x8000, d: 0x4000, qpps: 44_000 };
        self.position_sum = 0.0;
        self.task = Task::Duty(0.0);
        self.zero = self.machine.count();
    }

    fn tick(&mut self) {
        let tick = self.law.tick_s();
        let count = self.shaft_count();
        self.raw_speed = (count - self.count) / tick;
        self.count = count;
        self.speed += self.law.filter_share() * (self.raw_speed - self.speed);
        let wanted = match self.task {
            Task::Duty(goal) => {
                let most = SLEW_PER_S * tick;
                self.sum = 0.0;
                self.last_error = 0.0;
                self.duty + (goal - self.duty).clamp(-most, most)
            }
            Task::Speed(goal) => self.duty_for(goal),
            Task::Position(goal, most) => {
                let goal = self.speed_for(goal).clamp(-most, most);
                self.duty_for(goal)
            }
        };
        self.pending.push(wanted);
        self.duty = self.pending.remove(0);
    }

    /// The duty for a speed.
    fn duty_for(&mut self, goal: f64) -> f64 {
        let tick = self.law.tick_s();
        let (p, i, d) = self.law.gains(&self.velocity);
        let qpps = f64::from(self.velocity.qpps.max(1));
        let error = goal - self.speed;
        let slope = (error - self.last_error) / tick;
        self.last_error = error;
        let wanted = (self.law.feed_forward * goal + p * error + self.sum + d * slope) / qpps;
        if wanted.abs() <= 1.0 || wanted * error < 0.0 {
            self.sum += i * error * tick;
        }
        wanted.clamp(-1.0, 1.0)
    }

    /// The speed for a count, which is kept within the limits of the position.
    fn speed_for(&mut self, goal: f64) -> f64 {
        let registers = self.position;
        let (p, i, d) = self.law.position_gains(&registers);
        let goal = goal.clamp(f64::from(registers.min), f64::from(registers.max));
        let off = goal - (self.count - self.zero);
        let error = if off.abs() <= f64::from(registers.deadzone) { 0.0 } else { off };
        // The limit is of a sum over ticks where I counts by them.
        let step = if self.law.per_tick { 1.0 } else { self.law.tick_s() };
        let most = f64::from(registers.max_i);
        self.position_sum = (self.position_sum + error * step).clamp(-most, most);
        let seen = if self.law.filters_derivative { self.speed } else { self.raw_speed };
        p * error + i * self.law.tick_s() / step * self.position_sum - d * seen
    }

    fn exchange(&mut self) -> Result<Exchange, AxisError> {
        let sent = self.now;
        let half = |draw: &mut Draw, latency: f64| Duration::from_secs_f64(latency * draw.between(0.4, 0.6));
        let there = half(&mut self.draw, self.latency_s);
        self.advance(sent + there);
        let back = half(&mut self.draw, self.latency_s);
        let received = self.now + back;
        let is_cut = matches!(self.has_struck(), Some(Fault::LinkLost | Fault::RepliesLost));
        if self.draw.uniform() < self.loss || is_cut {
            self.advance(received + Duration::from_millis(15));
            return Err(AxisError::NoReply);
        }
        self.heard = self.now;
        Ok(Exchange { sent, received })
    }

    /// A request whose effect or reading is taken in its middle.
    fn ask<T>(&mut self, of: impl FnOnce(&mut Self) -> T) -> Result<(Exchange, T), AxisError> {
        let exchange = self.exchange();
        if exchange.is_err() && self.has_struck() != Some(Fault::RepliesLost) {
            return Err(AxisError::NoReply);
        }
        self.heard = self.now;
        let value = of(self);
        let exchange = exchange?;
        self.advance(exchange.received);
        Ok((exchange, value))
    }
}

impl Axis for Controller {
    fn now(&mut self) -> Duration {
        self.now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        let late = Duration::from_secs_f64(0.001 * self.draw.normal().abs());
        self.advance(time + late);
        Ok(())
    }

    fn sample(&mut self, want: Want) -> Result<Sample, AxisError> {
        let (counts_at, count) = self.ask(|unit| unit.count - unit.zero)?;
        let duty = |unit: &mut Self| (32_767.0 * unit.duty).round() as i16;
        let duty_raw = if want.duty { Some(self.ask(duty)?) } else { None };
        let amps = |unit: &mut Self| {
            let noise = unit.noise_amps * unit.draw.normal();
            (100.0 * (unit.machine.amps.abs() + noise)).round() as i16
        };
        let current_raw = if want.current { Some(self.ask(amps)?.1) } else { None };
        let volts =
            |unit: &mut Self| (10.0 * (unit.machine.volts + 0.01 * unit.draw.normal())).round() as u16;
        let volts_raw = if want.volts { Some(self.ask(volts)?.1) } else { None };
        let limited = |unit: &mut Self| unit.machine.is_limited();
        let (_, over_current) = self.ask(limited)?;
        let status = Status { over_current, ..Status::default() };
        Ok(Sample { counts_at, counts: [count as i32, 0], status, duty_raw, current_raw, volts_raw })
    }

    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        Ok(self.ask(|unit| unit.task = Task::Duty(f64::from(duty_raw) / 32_767.0))?.0)
    }

    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        let start = |unit: &mut Self| {
            if matches!(unit.task, Task::Duty(_)) {
                unit.sum = 0.0;
                unit.last_error = f64::from(counts_per_s) - unit.speed;
            }
            unit.task = Task::Speed(f64::from(counts_per_s));
        };
        Ok(self.ask(start)?.0)
    }

    fn command_position(&mut self, counts: i32, speed_counts_per_s: u32) -> Result<Exchange, AxisError> {
        let start = |unit: &mut Self| {
            if !matches!(unit.task, Task::Position(..)) {
                unit.position_sum = 0.0;
            }
            if matches!(unit.task, Task::Duty(_)) {
                unit.sum = 0.0;
                unit.last_error = -unit.speed;
            }
            unit.task = Task::Position(f64::from(counts), f64::from(speed_counts_per_s));
        };
        Ok(self.ask(start)?.0)
    }

    fn write_winding(&mut self, _inductance_resistance_raw: [u32; 2]) -> Result<(), AxisError> {
        self.ask(|_| ()).map(|_| ())
    }

    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError> {
        self.ask(|unit| {
            unit.limits = (max_raw, min_raw);
            unit.machine.motor.limit_amps = unit.machine.motor.limit_amps.min(0.01 * f64::from(max_raw));
        })
        .map(|_| ())
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        Ok(self.ask(|unit| unit.raw_speed.round() as i32)?.1)
    }

    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError> {
        self.ask(|unit| unit.stream_timeout = Duration::from_millis(milliseconds.into())).map(|_| ())
    }
}

impl LoopAxis<McpLaw> for Controller {
    fn read_setup(&mut self) -> Result<Setup<McpLaw>, AxisError> {
        let held = |unit: &mut Self| McpHeld { velocity: unit.velocity, position: unit.position };
        let (_, held) = self.ask(held)?;
        let min_volts_raw = (7.0 * self.machine.motor.volts) as u16;
        Ok(Setup {
            held,
            max_current_raw: self.limits.0,
            min_volts_raw,
            stream_timeout_ms: Some(1_000),
            ..Setup::default()
        })
    }

    fn write(&mut self, write: McpWrite) -> Result<(), AxisError> {
        self.ask(|unit| match write {
            McpWrite::Velocity(registers) => unit.velocity = registers,
            McpWrite::PositionLoop(registers) => unit.position = registers,
        })
        .map(|_| ())
    }
}
