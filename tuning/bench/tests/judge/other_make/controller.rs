//! A controller of another make: its own loop, its own line, noise on the currents it reports.

use super::machine::{Complex, Draw, Machine, Motor};
use brushwork_mcp_axis::{McpHeld, McpLaw, McpWrite, PositionRegisters, VelocityRegisters};
use brushwork_tuning::axis::{Axis, AxisError, Exchange, Sample, Status, Want};
use brushwork_tuning::setup::{LoopAxis, Setup};
use std::f64::consts::{PI, TAU};
use std::time::Duration;

/// Duty per second of the highest acceleration that is given with a duty.
const SLEW_PER_S: f64 = 20.0;
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
/// `None` where it is unstable. A loop that is stable at small gains can become unstable only by passing -1 as they grow.
pub fn sensitivity(motor: &Motor, law: &LawOptions, registers: &VelocityRegisters) -> Option<f64> {
    let (p, i, d) = law.gains(registers);
    let tick = law.tick_s();
    let share = law.filter_share();
    let open: Vec<Complex> = (0..400)
        .map(|n| {
            let w = 0.999 * PI / tick * 10_f64.powf(-4.0 * (1.0 - f64::from(n) / 399.0));
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
            let loops = controller.mul(filter).mul(slope).mul(sampled).mul(late);
            loops.times(1.0 / f64::from(registers.qpps.max(1)))
        })
        .collect();
    let at = |share: f64| open.iter().map(|l| 1.0 / l.times(share).plus(1.0).size()).fold(0.0, f64::max);
    let passes = (1..400).any(|n| at(f64::from(n) / 400.0) > 40.0);
    (!passes).then(|| at(1.0))
}

#[derive(Clone, Copy)]
enum Task {
    Duty(f64),
    Speed(f64),
}

/// The controller, its motor and the line to it, in a time that calls alone move on.
pub struct Controller {
    pub machine: Machine,
    pub law: LawOptions,
    pub velocity: VelocityRegisters,
    position: PositionRegisters,
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
    latency_s: f64,
    loss: f64,
    draw: Draw,
    /// Standard deviation of a current, A.
    pub noise_amps: f64,
    /// When it is reset, if ever.
    pub reset_at: Option<Duration>,
    zero: f64,
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
            latency_s: draw.log(0.0005, 0.003),
            loss: draw.between(0.0, 0.01),
            draw,
            noise_amps: NOISE_AMPS,
            reset_at: None,
            zero: 0.0,
        }
    }

    fn advance(&mut self, to: Duration) {
        while (self.ticks + 1) as f64 * self.law.tick_s() <= to.as_secs_f64() {
            self.ticks += 1;
            if self.reset_at.is_some_and(|at| self.ticks as f64 * self.law.tick_s() > at.as_secs_f64()) {
                self.reset();
            }
            self.machine.advance(self.duty, self.law.tick_s());
            self.tick();
        }
        self.now = self.now.max(to);
    }

    /// As after a short loss of its supply.
    fn reset(&mut self) {
        self.reset_at = None;
        self.velocity = VelocityRegisters { p: 0x1_0000, i: 0x8000, d: 0x4000, qpps: 44_000 };
        self.task = Task::Duty(0.0);
        self.zero = self.machine.count();
    }

    fn tick(&mut self) {
        let tick = self.law.tick_s();
        let count = self.machine.count();
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
            Task::Speed(goal) => {
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
        };
        self.pending.push(wanted);
        self.duty = self.pending.remove(0);
    }

    fn exchange(&mut self) -> Result<Exchange, AxisError> {
        let sent = self.now;
        let half = |draw: &mut Draw, latency: f64| Duration::from_secs_f64(latency * draw.between(0.4, 0.6));
        let there = half(&mut self.draw, self.latency_s);
        self.advance(sent + there);
        let back = half(&mut self.draw, self.latency_s);
        let received = self.now + back;
        if self.draw.uniform() < self.loss {
            self.advance(received + Duration::from_millis(15));
            return Err(AxisError::NoReply);
        }
        Ok(Exchange { sent, received })
    }

    /// A request whose effect or reading is taken in its middle.
    fn ask<T>(&mut self, of: impl FnOnce(&mut Self) -> T) -> Result<(Exchange, T), AxisError> {
        let exchange = self.exchange()?;
        let value = of(self);
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

    fn command_position(&mut self, _counts: i32, _speed: u32) -> Result<Exchange, AxisError> {
        Err(AxisError::Refused("no position loop".to_owned()))
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

    fn set_stream_timeout(&mut self, _milliseconds: u32) -> Result<(), AxisError> {
        self.ask(|_| ()).map(|_| ())
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
