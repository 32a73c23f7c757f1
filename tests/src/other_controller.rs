//! A motor controller that shares nothing with `brushwork-mcp-sim`: a few commands of packet serial, a first-order motor, another tick.
//!
//! It is what the tuner meets when somebody else's controller is on the line: it may tell no current, answer optional commands with
//! silence, have no status bits, and be slow. Only the CRC is taken from the protocol crate. Leaves out: buffers, ramps, two motors
//! (the second one stands), priorities.

use brushwork_mcp_wire::crc::crc16_xmodem;
use std::collections::VecDeque;
use std::time::Duration;

/// A packet that is not complete after this long without a byte is forgotten.
const GAP: Duration = Duration::from_millis(10);
/// Scales of the gains.
const POSITION_SCALE: f64 = 1024.0;
const VELOCITY_SCALE: f64 = 65_536.0;
const FULL_DUTY: f64 = 32_767.0;
/// From full duty backwards to full duty forwards in 100 ms.
const DUTY_PER_S: f64 = 20.0;

/// How it differs from what the tuner would like best.
#[derive(Clone, Debug)]
pub struct Manner {
    /// Width of replies, 1 to 4.
    pub generation: u8,
    /// Control ticks in a second.
    pub tick_hz: f64,
    /// Whether I is summed by ticks or by seconds.
    pub sums_ticks: bool,
    /// Whether the position's D takes differences of ticks, or of seconds.
    pub derives_ticks: bool,
    /// Filter on what the position's D takes, s.
    pub derivative_filter_s: f64,
    /// How much of the setpoint itself goes into the duty.
    pub feed_forward: f64,
    /// Whether currents are told; else they are 0.
    pub tells_current: bool,
    /// Whether the bits of the status are ever set.
    pub tells_status: bool,
    /// Commands that it answers with silence.
    pub silent: Vec<u8>,
    /// Whether a duty is in force at once; else the ramp of its highest acceleration leads there (MCP manual, command 52).
    pub is_abrupt: bool,
    /// Highest speed that it tells.
    pub speed_clip: Option<i32>,
    /// Time before it answers.
    pub delay: Duration,
    /// Share of the replies that do not come, one in so many; 0 for none.
    pub loses_one_in: u32,
}

impl Default for Manner {
    fn default() -> Self {
        Self {
            generation: 1,
            tick_hz: 300.0,
            sums_ticks: true,
            derives_ticks: true,
            derivative_filter_s: 0.0,
            feed_forward: 1.0,
            tells_current: true,
            tells_status: true,
            silent: Vec::new(),
            is_abrupt: false,
            speed_clip: None,
            delay: Duration::from_micros(700),
            loses_one_in: 0,
        }
    }
}

/// A first-order motor with friction.
#[derive(Clone, Copy, Debug)]
pub struct Motor {
    /// Speed per duty, counts/s.
    pub gain: f64,
    /// Time constant, s.
    pub tau_s: f64,
    /// Duty that friction eats.
    pub friction: f64,
    /// Amperes per duty at rest.
    pub stall_amps: f64,
    /// Where it cannot go on, counts on either side; infinite for a motor that turns freely.
    pub end_stop: f64,
    /// Whether the shaft is held.
    pub held: bool,
    /// Whether the encoder counts the wrong way.
    pub reversed: bool,
}

impl Default for Motor {
    fn default() -> Self {
        Self {
            gain: 6_200.0,
            tau_s: 0.085,
            friction: 0.05,
            stall_amps: 9.0,
            end_stop: f64::INFINITY,
            held: false,
            reversed: false,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Duty(f64),
    Speed(f64),
    Position { goal: f64, speed: f64 },
}

/// The controller.
#[derive(Clone, Debug)]
pub struct OtherController {
    /// How it behaves.
    pub manner: Manner,
    /// Its motor, and what it is doing.
    pub motor: Motor,
    /// Speed, counts/s.
    pub speed: f64,
    /// Place, counts.
    pub place: f64,
    /// Duty in force.
    pub duty: f64,
    /// D, P, I, QPPS of the velocity loop as they were sent.
    pub velocity: [u32; 4],
    /// D, P, I, MaxI, deadzone, min, max of the position loop.
    pub position: [i32; 7],
    /// Serial time-out, 0.1 s.
    pub timeout_raw: u8,
    /// How many packets it has heard.
    pub heard: usize,
    now: Duration,
    tick_at: Duration,
    mode: Mode,
    last_count: i64,
    sum: f64,
    before: f64,
    slope: f64,
    inbox: Vec<u8>,
    byte_at: Duration,
    outbox: VecDeque<(Duration, Vec<u8>)>,
    replies: u32,
}

impl OtherController {
    /// One at rest.
    #[must_use]
    pub fn new(manner: Manner, motor: Motor) -> Self {
        Self {
            manner,
            motor,
            speed: 0.0,
            place: 0.0,
            duty: 0.0,
            velocity: [0x4000, 0x1_0000, 0x8000, 44_000],
            position: [0, 2_000, 0, 0, 0, -2_000_000, 2_000_000],
            timeout_raw: 10,
            heard: 0,
            now: Duration::ZERO,
            tick_at: Duration::ZERO,
            mode: Mode::Duty(0.0),
            last_count: 0,
            sum: 0.0,
            before: 0.0,
            slope: 0.0,
            inbox: Vec::new(),
            byte_at: Duration::ZERO,
            outbox: VecDeque::new(),
            replies: 0,
        }
    }

    /// The time.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Lets time pass: the motor turns, the loop ticks, the time-out watches.
    pub fn advance(&mut self, to: Duration) {
        let tick = Duration::from_secs_f64(1.0 / self.manner.tick_hz);
        while self.tick_at <= to {
            let step_s = self.tick_at.saturating_sub(self.now).as_secs_f64();
            self.turn(step_s);
            self.now = self.tick_at;
            self.tick_at += tick;
            self.tick();
        }
        self.turn(to.saturating_sub(self.now).as_secs_f64());
        self.now = self.now.max(to);
    }

    fn turn(&mut self, seconds: f64) {
        if self.motor.held {
            self.speed = 0.0;
            return;
        }
        let drive = self.motor.gain * self.duty;
        let friction = self.motor.gain * self.motor.friction;
        let (before, pull) = if self.speed == 0.0 {
            (0.0, drive.signum() * (drive.abs() - friction).max(0.0))
        } else {
            (self.speed, drive - friction * self.speed.signum())
        };
        let share = 1.0 - (-seconds / self.motor.tau_s).exp();
        self.speed += (pull - self.speed) * share;
        if before * self.speed < 0.0 && drive.abs() <= friction {
            self.speed = 0.0;
        }
        self.place += 0.5 * (before + self.speed) * seconds;
        if self.place.abs() > self.motor.end_stop {
            self.place = self.place.signum() * self.motor.end_stop;
            self.speed = 0.0;
        }
    }

    /// What the encoder register holds.
    #[must_use]
    pub fn count(&self) -> i64 {
        let place = if self.motor.reversed { -self.place } else { self.place };
        place.floor() as i64
    }

    /// Motor current, A.
    #[must_use]
    pub fn amps(&self) -> f64 {
        self.motor.stall_amps * (self.duty - self.speed / self.motor.gain).abs()
    }

    fn tick(&mut self) {
        let count = self.count();
        let speed = (count - self.last_count) as f64 * self.manner.tick_hz;
        self.last_count = count;
        let silent = self.now.saturating_sub(self.byte_at);
        if self.timeout_raw > 0 && silent > Duration::from_millis(100) * u32::from(self.timeout_raw) {
            self.mode = Mode::Duty(0.0);
        }
        self.duty = match self.mode {
            Mode::Duty(duty) if self.manner.is_abrupt => duty,
            Mode::Duty(duty) => {
                let most = DUTY_PER_S / self.manner.tick_hz;
                self.duty + (duty - self.duty).clamp(-most, most)
            }
            Mode::Speed(goal) => self.velocity_loop(goal, speed),
            Mode::Position { goal, speed: most } => {
                let mut error = goal - count as f64;
                if error.abs() <= f64::from(self.position[4]) {
                    error = 0.0;
                }
                let [d, p, ..] = self.position.map(|raw| f64::from(raw) / POSITION_SCALE);
                let parts = if self.manner.derives_ticks { 1.0 } else { self.manner.tick_hz };
                let tick_s = 1.0 / self.manner.tick_hz;
                let share = tick_s / (self.manner.derivative_filter_s + tick_s);
                self.slope += share * (error - self.before - self.slope);
                let wanted = p * error + d * parts * self.slope;
                self.before = error;
                self.velocity_loop(wanted.clamp(-most, most), speed)
            }
        };
    }

    fn velocity_loop(&mut self, goal: f64, speed: f64) -> f64 {
        let [_, p, i, qpps] = self.velocity.map(f64::from);
        let qpps = qpps.max(1.0);
        let error = goal - speed;
        let weight = if self.manner.sums_ticks { 1.0 } else { 1.0 / self.manner.tick_hz };
        let sum = self.sum + error * weight;
        let free =
            (self.manner.feed_forward * goal + p / VELOCITY_SCALE * error + i / VELOCITY_SCALE * sum) / qpps;
        if free.abs() < 1.0 {
            self.sum = sum;
        }
        free.clamp(-1.0, 1.0)
    }

    fn begin(&mut self, mode: Mode) {
        if std::mem::discriminant(&mode) != std::mem::discriminant(&self.mode) {
            self.sum = 0.0;
        }
        if let Mode::Position { goal, .. } = mode {
            self.before = goal - self.count() as f64;
            self.slope = 0.0;
        }
        self.mode = mode;
    }

    /// Takes bytes that arrive now.
    pub fn receive(&mut self, bytes: &[u8]) {
        if self.now.saturating_sub(self.byte_at) > GAP {
            self.inbox.clear();
        }
        self.byte_at = self.now;
        self.inbox.extend_from_slice(bytes);
        while let Some(used) = self.packet() {
            self.inbox.drain(..used);
        }
    }

    /// Acts on the packet at the head of the inbox; how long it was, or nothing while it is not complete.
    fn packet(&mut self) -> Option<usize> {
        let (&address, &command) = (self.inbox.first()?, self.inbox.get(1)?);
        if address != 0x80 {
            return Some(1);
        }
        if let Some(reply) = self.read(command) {
            self.heard += 1;
            if !self.manner.silent.contains(&command) {
                let crc = crc16_xmodem(&[&[address, command], &reply[..]].concat());
                self.say([&reply[..], &crc.to_be_bytes()].concat());
            }
            return Some(2);
        }
        let length = 2 + write_length(command)? + 2;
        let packet = self.inbox.get(..length)?.to_vec();
        let crc = crc16_xmodem(&packet[..length - 2]).to_be_bytes();
        if crc == packet[length - 2..] && !self.manner.silent.contains(&command) {
            self.heard += 1;
            self.write(command, &packet[2..length - 2]);
            self.say(vec![0xFF]);
        }
        Some(length)
    }

    fn say(&mut self, bytes: Vec<u8>) {
        self.replies += 1;
        if self.manner.loses_one_in == 0 || !self.replies.is_multiple_of(self.manner.loses_one_in) {
            self.outbox.push_back((self.now + self.manner.delay, bytes));
        }
    }

    /// When the next reply leaves.
    #[must_use]
    pub fn next_output_at(&self) -> Option<Duration> {
        self.outbox.front().map(|(at, _)| *at)
    }

    /// A reply that has left by now.
    pub fn take_output(&mut self) -> Option<Vec<u8>> {
        let is_due = self.outbox.front().is_some_and(|(at, _)| *at <= self.now);
        is_due.then(|| self.outbox.pop_front()).flatten().map(|(_, bytes)| bytes)
    }

    /// The reply to a command that reads, without its CRC.
    fn read(&self, command: u8) -> Option<Vec<u8>> {
        let widens = self.manner.generation >= 3;
        let speed = self.last_speed();
        let direction = u8::from(self.speed < 0.0);
        Some(match command {
            16 => [&(self.count() as i32).to_be_bytes()[..], &[0]].concat(),
            17 => vec![0; 5],
            18 | 30 => [&speed.unsigned_abs().to_be_bytes()[..], &[direction]].concat(),
            19 | 31 => vec![0; 5],
            21 => b"USB Roboclaw 2x15a v4.1.11\n\0".to_vec(),
            24 => 121_u16.to_be_bytes().to_vec(),
            25 => 50_u16.to_be_bytes().to_vec(),
            47 => vec![0x80, 0x80],
            48 => [((self.duty * FULL_DUTY) as i16).to_be_bytes(), [0, 0]].concat(),
            49 => {
                let amps = if self.manner.tells_current { self.amps() } else { 0.0 };
                [((amps * 100.0) as i16).to_be_bytes(), [0, 0]].concat()
            }
            55 | 56 => {
                let [d, p, i, qpps] = self.velocity;
                [p, i, d, qpps].iter().flat_map(|raw| raw.to_be_bytes()).collect()
            }
            59 => {
                let narrow = [60_u16, 300].iter().flat_map(|raw| raw.to_be_bytes());
                narrow.chain((self.manner.generation >= 4).then_some(0)).collect()
            }
            60 => [45_u16, 60].iter().flat_map(|raw| raw.to_be_bytes()).collect(),
            63 | 64 => {
                let [d, p, i, max_i, deadzone, min, max] = self.position;
                [p, i, d, max_i, deadzone, min, max].iter().flat_map(|raw| raw.to_be_bytes()).collect()
            }
            78 => [(self.count() as i32).to_be_bytes(), [0; 4]].concat(),
            79 => [speed.to_be_bytes(), [0; 4]].concat(),
            81 => vec![0; if self.manner.generation >= 2 { 16 } else { 8 }],
            90 => {
                let bits = if self.manner.tells_status && self.motor.held { 1_u32 } else { 0 };
                if widens { bits.to_be_bytes().to_vec() } else { (bits as u16).to_be_bytes().to_vec() }
            }
            91 => vec![0, 0],
            135 | 136 => [1_000_u32, 0].iter().flat_map(|raw| raw.to_be_bytes()).collect(),
            15 => vec![self.timeout_raw],
            130 | 131 => vec![0; 8],
            _ => return None,
        })
    }

    fn last_speed(&self) -> i32 {
        let speed = if self.motor.reversed { -self.speed } else { self.speed };
        let most = self.manner.speed_clip.unwrap_or(i32::MAX);
        (speed as i32).clamp(-most, most)
    }

    fn write(&mut self, command: u8, data: &[u8]) {
        let word = |at: usize| {
            let mut bytes = [0; 4];
            bytes.copy_from_slice(&data[at..at + 4]);
            i32::from_be_bytes(bytes)
        };
        let half = |at: usize| f64::from(i16::from_be_bytes([data[at], data[at + 1]])) / FULL_DUTY;
        match command {
            14 => self.timeout_raw = data[0],
            28 => self.velocity = [0, 4, 8, 12].map(|at| word(at) as u32),
            61 => self.position = [0, 4, 8, 12, 16, 20, 24].map(word),
            32 | 34 | 52 | 54 => self.begin(Mode::Duty(half(0))),
            35 | 37 => self.begin(Mode::Speed(f64::from(word(0)))),
            65 => {
                let (speed, goal) = (f64::from(word(4) as u32), f64::from(word(12)));
                self.begin(Mode::Position { goal, speed });
            }
            _ => {}
        }
    }
}

/// How many bytes of values a command that writes has.
fn write_length(command: u8) -> Option<usize> {
    Some(match command {
        0..=14 => 1,
        20 => 0,
        22 | 23 => 4,
        28 | 29 => 16,
        32 | 33 => 2,
        34 => 4,
        35 | 36 => 4,
        37 => 8,
        52 | 53 => 6,
        54 => 12,
        57 | 58 => 4,
        61 | 62 => 28,
        65 | 66 => 17,
        128 | 129 | 133 | 134 => 8,
        // Unknown: silence, and forgotten with the next gap.
        _ => return None,
    })
}
