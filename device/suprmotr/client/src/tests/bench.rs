//! A bus of units made of the wire's table alone, a link to it in virtual time, and all that was written.

use brushwork_link::clock::{Clock, VirtualClock};
use brushwork_link::device::{DeviceHandle, DeviceLoop, DeviceOptions, Step};
use brushwork_link::{Event, Request, Transport, TransportError};
use brushwork_suprmotr_wire::{
    Address, Command, ErrorCode, Line, Mnemonic, Radix, Reader, Received, ReportForm, ReportLine, Reports,
    Status, encode_report, limits, motion, operation, parse_line,
};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

/// Counts per second of every move.
const SPEED: f64 = 10_000.0;

pub struct Unit {
    pub address: Address,
    pub form: ReportForm,
    pub radix: Radix,
    pub echo: bool,
    pub is_selected: bool,
    pub is_motor_on: bool,
    /// A macro runs.
    pub runs: bool,
    /// The loop does not hold the motor still.
    pub shakes: bool,
    /// AB leaves the target of a motor that is off where it was.
    pub keeps_target: bool,
    pub macros: Vec<Line>,
    pub parameters: BTreeMap<Mnemonic, i32>,
    pub limits: u8,
    pub from: f64,
    pub target: i32,
    pub left_at: Duration,
    pub error: u8,
    pub restarts: u32,
    pub reader: Reader,
    pub last: Option<Line>,
    /// Lines that were carried out.
    pub lines: Vec<Line>,
}

impl Unit {
    pub fn new(address: u8) -> Self {
        let parameters = [
            (Mnemonic::DV, 20_000),
            (Mnemonic::DA, 200_000),
            (Mnemonic::DP, 75),
            (Mnemonic::DI, 0),
            (Mnemonic::DD, 0),
            (Mnemonic::DL, 100),
        ];
        Self {
            address: Address::new(address).unwrap(),
            form: ReportForm::Full,
            radix: Radix::Decimal,
            echo: true,
            is_selected: false,
            is_motor_on: true,
            runs: false,
            shakes: false,
            keeps_target: false,
            macros: Vec::new(),
            parameters: BTreeMap::from(parameters),
            limits: limits::ENABLED,
            from: 0.0,
            target: 0,
            left_at: Duration::ZERO,
            error: 0,
            restarts: 0,
            reader: Reader::new(),
            last: None,
            lines: Vec::new(),
        }
    }

    pub fn position(&self, now: Duration) -> i32 {
        let shake = if self.shakes && self.is_motor_on { (now.as_millis() % 7) as i32 * 30 } else { 0 };
        let way = f64::from(self.target) - self.from;
        let gone = SPEED * now.saturating_sub(self.left_at).as_secs_f64();
        let moved = if self.is_motor_on { way.signum() * gone.min(way.abs()) } else { 0.0 };
        (self.from + moved) as i32 + shake
    }

    fn is_there(&self, now: Duration) -> bool {
        !self.is_motor_on
            || (f64::from(self.target) - self.from).abs()
                <= SPEED * now.saturating_sub(self.left_at).as_secs_f64()
    }

    fn status(&self, now: Duration) -> Status {
        let flag = |is: bool, bit: u8| if is { bit } else { 0 };
        Status {
            operation: flag(self.echo, operation::ECHO)
                | flag(self.runs, operation::MACRO)
                | flag(self.error != 0, operation::COMMAND_ERROR)
                | flag(self.radix == Radix::Hexadecimal, operation::HEXADECIMAL)
                | operation::ADDRESSED,
            motion: flag(!self.is_motor_on, motion::MOTOR_OFF) | flag(self.is_there(now), motion::COMPLETE),
            limits: self.limits,
            error: self.error,
            ..Status::default()
        }
    }

    fn stop(&mut self, now: Duration) {
        self.from = self.position(now).into();
        if !self.keeps_target {
            self.target = self.from as i32;
        }
        self.left_at = now;
    }

    /// What comes back for a byte.
    fn take(&mut self, byte: u8, now: Duration) -> Vec<u8> {
        let mut said = if self.echo && self.is_selected { vec![byte] } else { Vec::new() };
        let found = self.reader.feed(byte, self.is_selected);
        match found {
            Some(Received::Selection(selection)) => self.is_selected = selection.selects(self.address),
            Some(Received::Single(single)) => match single.mnemonic() {
                Some(Mnemonic::AB) => self.stop(now),
                None => self.runs = false,
                Some(asked) => said.extend(self.report(&Command::plain(asked), now)),
            },
            Some(Received::Repeat) => {
                if let Some(last) = self.last.clone() {
                    said.extend(self.carry_out(&last, now));
                }
            }
            Some(Received::Line(text)) => {
                let parsed = parse_line(&text, self.radix);
                self.runs = false;
                if let Some(error) = parsed.error {
                    self.error = error.code.number();
                }
                said.extend(self.carry_out(&parsed.line, now));
                self.last = Some(parsed.line);
            }
            None => {}
        }
        said
    }

    fn carry_out(&mut self, line: &Line, now: Duration) -> Vec<u8> {
        self.lines.push(line.clone());
        if line.defines.is_some() {
            self.macros.push(line.clone());
            return Vec::new();
        }
        line.commands.iter().flat_map(|command| self.command(command, now)).collect()
    }

    fn command(&mut self, command: &Command, now: Duration) -> Vec<u8> {
        use Mnemonic as M;
        if command.row().reports != Reports::Nothing {
            return self.report(command, now);
        }
        let number = command.value().unwrap_or_default();
        match command.mnemonic {
            M::MA | M::MR | M::GH => {
                let from = self.position(now);
                let goal = if command.mnemonic == M::MR { from.saturating_add(number) } else { number };
                if goal.abs() > brushwork_suprmotr_wire::FURTHEST_COUNTS {
                    self.error = ErrorCode::TooLarge.number();
                } else {
                    (self.from, self.target, self.left_at) = (from.into(), goal, now);
                }
            }
            M::AB | M::ST => self.stop(now),
            M::MF => {
                self.from = self.position(now).into();
                self.is_motor_on = false;
            }
            M::MN => (self.is_motor_on, self.left_at) = (true, now),
            M::MC | M::EM => self.runs = true,
            M::RT => {
                self.restarts += 1;
                self.is_selected = false;
            }
            M::EF | M::EN => self.echo = command.mnemonic == M::EN,
            M::LN => self.limits |= limits::ENABLED,
            M::LF => self.limits &= !limits::ENABLED,
            M::LH => self.limits |= limits::ACTIVE_HIGH,
            M::LL => self.limits &= !limits::ACTIVE_HIGH,
            M::DB => self.address = Address::new(number as u8).unwrap(),
            M::HM => self.radix = Radix::Hexadecimal,
            M::DM => self.radix = Radix::Decimal,
            other => {
                self.parameters.insert(other, number);
            }
        }
        Vec::new()
    }

    fn report(&mut self, command: &Command, now: Duration) -> Vec<u8> {
        let asked = command.value().and_then(|value| u8::try_from(value).ok()).unwrap_or_default();
        let lines = match command.row().reports {
            Reports::Each(parts) => {
                parts.iter().map(|part| self.line_of(&Command::plain(*part), 0, now)).collect()
            }
            Reports::Macros => {
                let zero = command.mnemonic == Mnemonic::TZ;
                let listed = self.macros.iter().filter(|line| line.defines == Some(0) || !zero);
                listed.cloned().map(ReportLine::Macro).collect()
            }
            _ => vec![self.line_of(command, asked, now)],
        };
        encode_report(self.form, self.radix, self.address, &lines)
    }

    fn line_of(&mut self, command: &Command, asked: u8, now: Duration) -> ReportLine {
        use Mnemonic as M;
        let set = |name: M| self.parameters.get(&name).copied().unwrap_or_default();
        let of = command.mnemonic;
        let value = match of {
            M::TP => self.position(now),
            M::TT => self.target,
            M::TF => {
                if self.is_there(now) {
                    0
                } else {
                    12
                }
            }
            M::GV | M::TY => set(M::DV),
            M::GA | M::TL => set(M::DA),
            M::GP => set(M::DP),
            M::GI => set(M::DI),
            M::GD => set(M::DD),
            M::GL => set(M::DL),
            M::TB => self.address.get().into(),
            _ => 0,
        };
        match command.row().reports {
            Reports::Status => {
                let status = self.status(now);
                self.error = 0;
                ReportLine::Status(status)
            }
            Reports::Channels if asked == 0 => ReportLine::Channels { outputs: 0, inputs: 0 },
            Reports::Channels => ReportLine::Channel { channel: asked, is_on: false },
            Reports::Analog => {
                let values = if asked == 0 { vec![127, 230] } else { vec![127] };
                ReportLine::Analog { channel: asked, values }
            }
            Reports::Text => ReportLine::Text("SuprMotr".to_owned()),
            _ => ReportLine::Number { of, value },
        }
    }
}

/// What hangs on the line.
pub struct Bus {
    pub units: Vec<Unit>,
    /// The rate that they have; `None` for any.
    pub baud: Option<u32>,
    /// All that was written at that rate.
    pub written: Vec<u8>,
    pub rates: Vec<u32>,
}

struct Wire {
    bus: Arc<Mutex<Bus>>,
    clock: VirtualClock,
    baud: u32,
    waiting: Vec<u8>,
    due: Duration,
}

impl Transport for Wire {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let mut bus = self.bus.lock().unwrap();
        if bus.baud.is_some_and(|baud| baud != self.baud) {
            return Ok(());
        }
        bus.written.extend(bytes);
        let now = self.clock.now();
        for byte in bytes {
            let said: Vec<u8> = bus.units.iter_mut().flat_map(|unit| unit.take(*byte, now)).collect();
            self.waiting.extend(said);
        }
        self.due = now + Duration::from_millis(5);
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        let until = self.clock.now() + timeout;
        if self.waiting.is_empty() || self.due > until {
            self.clock.advance_to(until);
            return Ok(0);
        }
        self.clock.advance_to(self.due);
        let count = self.waiting.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.waiting[..count]);
        self.waiting.drain(..count);
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        Ok(std::mem::take(&mut self.waiting).len())
    }

    fn describe(&self) -> String {
        "the bench".to_owned()
    }

    fn byte_time(&self) -> Option<Duration> {
        Some(Duration::from_secs(10) / self.baud)
    }

    fn set_baud(&mut self, baud: u32) -> Result<bool, TransportError> {
        self.bus.lock().unwrap().rates.push(baud);
        self.baud = baud;
        Ok(true)
    }
}

/// A link in virtual time, with what it told.
pub struct Link {
    pub clock: VirtualClock,
    pub bus: Arc<Mutex<Bus>>,
    pub handle: DeviceHandle,
    pub events: Vec<Event>,
    device_loop: DeviceLoop,
}

impl Link {
    pub fn open(units: Vec<Unit>, baud: Option<u32>, options: DeviceOptions) -> Self {
        brushwork_link::register(&crate::SuprMotrDriver);
        let clock = VirtualClock::new();
        let bus = Arc::new(Mutex::new(Bus { units, baud, written: Vec::new(), rates: Vec::new() }));
        let wire = Wire {
            bus: Arc::clone(&bus),
            clock: clock.clone(),
            baud: 9600,
            waiting: Vec::new(),
            due: Duration::ZERO,
        };
        let family = Box::new(crate::SuprMotrs::new());
        let (device_loop, handle) =
            DeviceLoop::for_family(Box::new(wire), Arc::new(clock.clone()), options, family);
        let mut link = Self { clock, bus, handle, events: Vec::new(), device_loop };
        link.settle();
        link
    }

    /// A link to one unit whose signals are not read until it is asked.
    pub fn to(unit: Unit) -> Self {
        let options = DeviceOptions {
            poll: brushwork_link::PollRate::Off,
            simulated: true,
            ..DeviceOptions::default()
        };
        Self::open(vec![unit], None, options)
    }

    pub fn bus(&self) -> MutexGuard<'_, Bus> {
        self.bus.lock().unwrap()
    }

    pub fn ask(&mut self, request: Request) {
        self.handle.request(request).unwrap();
        self.settle();
    }

    /// Turns the loop until it idles.
    pub fn settle(&mut self) {
        for _ in 0..20_000 {
            self.handle.renew();
            let step = self.device_loop.step();
            self.events.extend(self.handle.events().try_iter());
            if step != Step::Again {
                return;
            }
        }
        panic!("the loop never idles");
    }

    /// Turns the loop for a time.
    pub fn run_for(&mut self, time: Duration) {
        let end = self.clock.now() + time;
        while self.clock.now() < end {
            self.handle.renew();
            match self.device_loop.step() {
                Step::Again => {}
                Step::IdleUntil(until) => {
                    let breath = self.clock.now() + Duration::from_millis(16);
                    self.clock.advance_to(until.min(end).min(breath));
                }
                Step::Ended => return,
            }
            self.events.extend(self.handle.events().try_iter());
        }
    }

    /// What was written, in the words of a controller.
    pub fn written(&self) -> Vec<Received> {
        let mut reader = Reader::new();
        self.bus().written.iter().filter_map(|byte| reader.feed(*byte, true)).collect()
    }

    /// The lines among it.
    pub fn lines(&self) -> Vec<String> {
        let line = |found: Received| match found {
            Received::Line(text) => Some(String::from_utf8(text).unwrap()),
            Received::Selection(_) | Received::Single(_) | Received::Repeat => None,
        };
        self.written().into_iter().filter_map(line).collect()
    }

    pub fn forget(&mut self) {
        self.bus().written.clear();
        self.events.clear();
    }

    /// Every sentence that was told.
    pub fn sentences(&self) -> String {
        let told = self.events.iter().flat_map(|event| match event {
            Event::Failure(failure) | Event::Lost(failure) => vec![failure.to_string()],
            Event::ArmRefused { reasons, .. } => reasons.iter().map(ToString::to_string).collect(),
            Event::Transacted { result: Err(failure), .. } | Event::RawReply { result: Err(failure), .. } => {
                vec![failure.to_string()]
            }
            Event::Armed { warnings, .. } => warnings.iter().map(ToString::to_string).collect(),
            _ => Vec::new(),
        });
        told.collect::<Vec<_>>().join("\n")
    }
}
