//! A whole tuning run against an [`Axis`] of one's own: `cargo run --release -p brushwork-tuning --example tune_axis`.
//!
//! The axis is a motor behind a controller with a velocity loop at 300 Hz, in a time that only the tuner's own calls move, so that a
//! run of some seconds is over at once. To tune a real motor, put the same calls over your serial library: the comments name the
//! commands of the MCP manual.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_tuning::axis::{
    AMPS_PER_RAW, Axis, AxisError, Exchange, FULL_DUTY_RAW, Sample, Status, VOLTS_PER_RAW, Want,
};
use brushwork_tuning::law::Law;
use brushwork_tuning::model::{Gains, Motion, Pid, PlantModel};
use brushwork_tuning::plain_law::{PlainLaw, PlainRegisters};
use brushwork_tuning::setup::{LoopAxis, Setup};
use brushwork_tuning::tune::{Request, tune};
use std::time::Duration;

/// The motor: 12,000 counts/s at full duty less friction, 80 ms.
const MOTOR: PlantModel = PlantModel {
    gain_counts_per_s: 12_000.0,
    tau_s: 0.08,
    coulomb_duty: 0.05,
    load_duty: 0.0,
    drive_limit: None,
    brake_limit: None,
    sag: 0.0,
};
const BATTERY_VOLTS: f64 = 12.0;
const STALL_AMPS: f64 = 6.0;
/// What a request and its reply take.
const EXCHANGE: Duration = Duration::from_micros(1_200);
/// Duty per tick of the highest acceleration: from one full duty to the other in 100 ms (MCP manual, command 52).
const DUTY_SLEW_PER_S: f64 = 20.0;
/// The firmware's filter on the speed.
const FILTER_S: f64 = 0.004;

fn main() {
    let mut bench = Bench::default();
    let report = tune(&mut bench, &Request::default());
    println!("{:?} after {:.1} s", report.verdict, report.seconds.1);
    for cause in &report.causes {
        println!("  {}", cause.sentence());
    }
    if let Some(fit) = report.fit {
        println!(
            "speed per duty {:.0} counts/s, really {:.0}",
            fit.model.gain_counts_per_s, MOTOR.gain_counts_per_s
        );
        println!("time constant {:.1} ms, really {:.1}", 1e3 * fit.model.tau_s, 1e3 * MOTOR.tau_s);
    }
    if let Some(design) = report.design {
        let (gains, qpps) = (report.proposed.gains.velocity, report.proposed.qpps);
        println!("gains P {:.3}, I {:.2}, QPPS {qpps:.0}, predicted Ms {:.2}", gains.p, gains.i, design.ms);
    }
    if let Some(measured) = report.measured {
        println!("measured overshoot {:.1} %", 100.0 * measured.overshoot);
    }
    let again = report.replay().is_some_and(|again| again.proposed == report.proposed);
    println!(
        "{} calls recorded; a replay gives {}",
        report.record.len(),
        if again { "the same gains" } else { "others" }
    );
}

/// What the controller was last told.
#[derive(Clone, Copy)]
enum Reported {
    Duty(f64),
    Speed(f64),
}

/// A motor, its controller, and a line to it.
struct Bench {
    now: Duration,
    ticks: u32,
    motion: Motion,
    reported: Reported,
    duty: f64,
    registers: PlainRegisters,
    last_count: f64,
    filtered_speed: f64,
    error_sum: f64,
}

impl Default for Bench {
    /// As it comes from the factory.
    fn default() -> Self {
        Self {
            now: Duration::ZERO,
            ticks: 0,
            motion: Motion::default(),
            reported: Reported::Duty(0.0),
            duty: 0.0,
            registers: PlainRegisters {
                gains: Gains { velocity: Pid { p: 1.0, i: 150.0, d: 0.0 }, ..Gains::default() },
                qpps: 44_000.0,
            },
            last_count: 0.0,
            filtered_speed: 0.0,
            error_sum: 0.0,
        }
    }
}

impl Bench {
    fn advance(&mut self, to: Duration) {
        let tick_s = PlainLaw::default().tick_s();
        while f64::from(self.ticks + 1) * tick_s <= to.as_secs_f64() {
            self.ticks += 1;
            MOTOR.step(&mut self.motion, self.duty, tick_s);
            self.tick(tick_s);
        }
        self.now = self.now.max(to);
    }

    /// The firmware: counts in, duty out.
    fn tick(&mut self, tick_s: f64) {
        let count = self.motion.position.floor();
        let speed = (count - self.last_count) / tick_s;
        self.filtered_speed += tick_s / (FILTER_S + tick_s) * (speed - self.filtered_speed);
        self.last_count = count;
        self.duty = match self.reported {
            Reported::Duty(wanted) => {
                let most = DUTY_SLEW_PER_S * tick_s;
                self.duty + (wanted - self.duty).clamp(-most, most)
            }
            Reported::Speed(wanted) => {
                let PlainRegisters { gains, qpps } = self.registers;
                let gains = gains.velocity;
                let error = wanted - self.filtered_speed;
                let sum = self.error_sum + error * tick_s;
                let duty = (wanted + gains.p * error + gains.i * sum) / qpps.max(1.0);
                if duty.abs() <= 1.0 {
                    self.error_sum = sum;
                }
                duty.clamp(-1.0, 1.0)
            }
        };
    }

    fn exchange(&mut self) -> Exchange {
        let sent = self.now;
        self.advance(sent + EXCHANGE);
        Exchange { sent, received: self.now }
    }

    fn tell(&mut self, reported: Reported) -> Result<Exchange, AxisError> {
        let exchange = self.exchange();
        if matches!((self.reported, reported), (Reported::Duty(_), Reported::Speed(_))) {
            self.error_sum = 0.0;
        }
        self.reported = reported;
        Ok(exchange)
    }
}

impl Axis for Bench {
    fn now(&mut self) -> Duration {
        self.now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.advance(time);
        Ok(())
    }

    /// Commands 78 and 90, and 48, 49 and 24 as wanted.
    fn sample(&mut self, want: Want) -> Result<Sample, AxisError> {
        let counts = self.motion.position.floor() as i32;
        let counts_at = self.exchange();
        let amps = STALL_AMPS * (self.duty - self.motion.speed / MOTOR.gain_counts_per_s);
        let duty_raw = (self.duty * f64::from(FULL_DUTY_RAW)).round() as i16;
        Ok(Sample {
            counts_at,
            counts: [counts, 0],
            status: Status::default(),
            duty_raw: want.duty.then_some((counts_at, duty_raw)),
            current_raw: want.current.then_some((amps / AMPS_PER_RAW).round() as i16),
            volts_raw: want.volts.then_some((BATTERY_VOLTS / VOLTS_PER_RAW).round() as u16),
        })
    }

    /// Command 52.
    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        self.tell(Reported::Duty(f64::from(duty_raw) / f64::from(FULL_DUTY_RAW)))
    }

    /// Command 35.
    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        self.tell(Reported::Speed(f64::from(counts_per_s)))
    }

    fn command_position(&mut self, _counts: i32, _speed_counts_per_s: u32) -> Result<Exchange, AxisError> {
        Err(AxisError::Refused("this bench has no position loop".to_owned()))
    }

    fn write_winding(&mut self, _inductance_resistance_raw: [u32; 2]) -> Result<(), AxisError> {
        Ok(())
    }

    fn write_current_limits(&mut self, _max_raw: u32, _min_raw: i32) -> Result<(), AxisError> {
        Ok(())
    }

    /// Command 30.
    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        self.exchange();
        Ok(self.filtered_speed as i32)
    }

    fn set_stream_timeout(&mut self, _milliseconds: u32) -> Result<(), AxisError> {
        Ok(())
    }

    fn progress(&mut self, text: &str) {
        println!("{:6.2} s  {text}", self.now.as_secs_f64());
    }
}

impl LoopAxis<PlainLaw> for Bench {
    /// Commands 55, 63, 135, 59 and 146.
    fn read_setup(&mut self) -> Result<Setup<PlainLaw>, AxisError> {
        self.exchange();
        Ok(Setup { held: self.registers, stream_timeout_ms: Some(1_000), ..Setup::default() })
    }

    /// Commands 28 and 61.
    fn write(&mut self, registers: PlainRegisters) -> Result<(), AxisError> {
        self.exchange();
        self.registers = registers;
        self.error_sum = 0.0;
        Ok(())
    }
}
