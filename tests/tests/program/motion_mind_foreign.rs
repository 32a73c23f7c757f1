//! The program's link to controllers that are no simulator of this project: Motion Minds written a second time, for this test alone, from
//! the tables of the manual. They share no code with the protocol crate, so that they can judge it.
//!
//! One is strict: it judges a buffer after 5 ms of silence and no sooner, refuses what the manual's ranges do not allow, stands still and
//! deaf while EEPROM is written, and blinks after a reset. Others are sloppy in the ways in which bytes on a wire are. The last one behaves
//! as the public simulator `MM3Sim` (Java, `edu.unc.ims.util.MM3SimHandler`): it looks at its line ten times a second, answers the read of
//! all registers with random numbers, every other read with an empty line and the rest with OK, each with a line feed alone.

use brushwork_link::Message;
use brushwork_tests::said::Said;
use std::collections::VecDeque;
use std::time::Duration;

use brushwork_link::Failure;
use brushwork_link::FamilyChoice;
use brushwork_link::device::{
    Addresses, ArmScope, Channel, DeviceOptions, Drive, DriveCommand, Event, Identity, Job, JobContext,
    JobEnding, Request,
};
use brushwork_link::settings::{
    SaveVerdict, SettingValue, SettingsTable, Subject, WriteOptions, read_all, save_eeprom, write,
};
use brushwork_motion_mind_wire::Protocol;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::Motor;

/// Bytes of each register, by index (manual, figure 18).
const WIDTHS: [usize; 32] =
    [4, 2, 1, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 4, 2, 1, 1, 2, 2, 2, 4, 4, 4, 2, 2, 4, 2, 2, 2, 2];
/// Those in two's complement.
const SIGNED: [usize; 7] = [0, 14, 21, 22, 23, 24, 27];
/// Those that a write does not change.
const READ_ONLY: [usize; 13] = [13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 27, 29, 31];
/// The ranges of figure 18 that are narrower than their bytes.
const RANGES: [(usize, i64, i64); 6] =
    [(1, 1, 1023), (8, 0, 32), (9, 1, 255), (25, 1, 1023), (26, 0, 1023), (28, 0, 1023)];
const DEFAULTS: [(usize, i64); 18] = [
    (1, 1023),
    (2, 128),
    (4, 6000),
    (5, 35),
    (7, 1),
    (8, 14),
    (9, 10),
    (10, 1152),
    (11, 576),
    (12, 15),
    (17, 5),
    (19, 300),
    (20, 700),
    (23, -100_000),
    (24, 100_000),
    (25, 1023),
    (26, 15),
    (28, 512),
];
const TICK: Duration = Duration::from_millis(5);

/// How it behaves where the manual leaves room.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Manner {
    /// As the manual has it, to the letter.
    Strict,
    /// Lines with more carriage returns and line feeds than needed, small letters, zeros in front, spaces behind.
    Sprawling,
    /// Lines that end with a line feed alone, and codes that nobody has heard of.
    Terse,
    /// Each byte by itself, with a pause.
    Slow,
    /// The public simulator.
    ReadsAllAlone,
}

/// One controller with a motor that does at once what it is told.
struct Foreign {
    manner: Manner,
    is_text: bool,
    now: Duration,
    ram: [i64; 32],
    eeprom: [i64; 32],
    buffer: Vec<u8>,
    last_byte_at: Duration,
    /// Deaf and without drive until then.
    busy_until: Duration,
    /// What leaves when.
    output: VecDeque<(Duration, Vec<u8>)>,
    duty: i64,
    velocity: i64,
    target: Option<i64>,
    /// Commands that were carried out, by their bytes or letters.
    done: Vec<u8>,
    refused: usize,
    dice: u32,
}

impl Foreign {
    fn new(manner: Manner, is_text: bool, mode: i64) -> Self {
        let mut ram = [0; 32];
        for (index, value) in DEFAULTS {
            ram[index] = value;
        }
        ram[18] = mode;
        ram[31] = 952;
        Self {
            manner,
            is_text,
            now: Duration::ZERO,
            ram,
            eeprom: ram,
            buffer: Vec::new(),
            last_byte_at: Duration::ZERO,
            busy_until: Duration::ZERO,
            output: VecDeque::new(),
            duty: 0,
            velocity: 0,
            target: None,
            done: Vec::new(),
            refused: 0,
            dice: 7,
        }
    }

    fn roll(&mut self, below: u32) -> u32 {
        self.dice = self.dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.dice >> 8) % below
    }

    fn say(&mut self, after: Duration, bytes: Vec<u8>) {
        let mut at = self.now + after;
        if self.manner == Manner::Slow {
            for byte in bytes {
                self.output.push_back((at, vec![byte]));
                at += Duration::from_millis(2);
            }
        } else {
            self.output.push_back((at, bytes));
        }
    }

    fn say_line(&mut self, line: &str) {
        let text = match self.manner {
            Manner::Sprawling => format!("\r\n{}  \r\n", line.to_lowercase()),
            Manner::Terse | Manner::ReadsAllAlone => format!("{line}\n"),
            _ => format!("{line}\r\n"),
        };
        let after = if self.manner == Manner::Strict { 9 } else { 5 };
        self.say(Duration::from_millis(after), text.into_bytes());
    }

    /// Stops for an EEPROM write, or starts anew.
    fn pause(&mut self, time: Duration) {
        self.busy_until = self.now + time;
        (self.duty, self.velocity, self.target) = (0, 0, None);
    }

    /// Carries a write out, or does not.
    fn put(&mut self, index: usize, value: i64, is_stored: bool) -> bool {
        let is_outside =
            RANGES.iter().any(|(row, low, high)| *row == index && !(*low..=*high).contains(&value));
        if is_outside && self.manner == Manner::Strict {
            self.refused += 1;
            return false;
        }
        if READ_ONLY.contains(&index) {
            return true;
        }
        self.ram[index] = value;
        if index == 0 {
            self.target = None;
        }
        if is_stored {
            self.eeprom[index] = value;
            self.pause(Duration::from_millis(40));
        }
        true
    }

    /// A command that moves or starts anew.
    fn act(&mut self, letter: u8, value: i64) {
        match letter {
            b'C' if self.ram[18] == 3 => self.duty = value,
            b'P' if self.ram[18] == 4 => (self.target, self.velocity) = (Some(value), 0),
            b'M' if self.ram[18] == 4 => (self.target, self.velocity) = (Some(self.ram[0] + value), 0),
            b'V' if self.ram[18] == 4 => (self.target, self.velocity) = (None, value),
            b'X' => {
                let (mode, revision) = (self.ram[18], self.ram[17]);
                *self = Self {
                    now: self.now,
                    done: std::mem::take(&mut self.done),
                    output: std::mem::take(&mut self.output),
                    ..Self::new(self.manner, self.is_text, mode)
                };
                (self.ram[18], self.ram[17]) = (mode, revision);
                self.eeprom = self.ram;
                self.pause(Duration::from_millis(400));
            }
            b'Y' => {
                self.ram = self.eeprom;
                self.ram[0] = 0;
                self.pause(Duration::from_millis(2000));
            }
            _ => {}
        }
    }

    fn returned(&self) -> Vec<(usize, &'static str)> {
        let function = self.ram[3];
        [(2, 0, "APOS"), (4, 14, "VELO"), (8, 15, "TIME")]
            .into_iter()
            .filter(|(bit, ..)| function & bit != 0)
            .map(|(_, index, code)| (index, code))
            .collect()
    }

    fn judge_frame(&mut self) {
        let bytes = std::mem::take(&mut self.buffer);
        let Some((sum, body)) = bytes.split_last() else { return };
        let total: u32 = body.iter().map(|byte| u32::from(*byte)).sum();
        let is_all = body.get(1).is_some_and(|address| *address >= 99);
        let is_ours = body.get(1).is_some_and(|address| i64::from(*address) == self.ram[7]) || is_all;
        if (total & 0xFF) as u8 != *sum || !is_ours {
            return;
        }
        let data = &body[2..];
        let four = || data.iter().rev().fold(0_i64, |value, byte| value << 8 | i64::from(*byte));
        let (letter, value) = match (body[0], data.len()) {
            (0x14, 2) => (b'C', i64::from(four() as i16)),
            (0x15, 4) => (b'P', i64::from(four() as i32)),
            (0x16, 4) => (b'M', i64::from(four() as i32)),
            (0x17, 2) => (b'V', i64::from(four() as i16)),
            (0x1B, 0) => (b'X', 0),
            (0x1C, 0) => (b'Y', 0),
            (0x1A, 4) => {
                let mask = four();
                let rows = (0..32).filter(|index| mask >> index & 1 == 1).collect::<Vec<_>>();
                return if !is_all {
                    self.send_registers(&rows);
                };
            }
            (0x1D, 1) if usize::from(data[0]) < 32 => {
                return if !is_all {
                    self.send_registers(&[usize::from(data[0])]);
                };
            }
            (0x18 | 0x19, length)
                if length >= 2 && WIDTHS.get(usize::from(data[0])) == Some(&(length - 1)) =>
            {
                let index = usize::from(data[0]);
                let raw = data[1..].iter().rev().fold(0_i64, |value, byte| value << 8 | i64::from(*byte));
                let shift = 64 - 8 * (length - 1) as u32;
                let value = if SIGNED.contains(&index) { raw << shift >> shift } else { raw };
                let is_stored = body[0] == 0x19;
                if self.put(index, value, is_stored) && !is_all {
                    self.done.push(body[0]);
                    self.say(self.busy_until.saturating_sub(self.now) + Duration::from_millis(1), vec![0x06]);
                }
                return;
            }
            _ => return,
        };
        self.done.push(body[0]);
        let rows: Vec<usize> = self.returned().iter().map(|(index, _)| *index).collect();
        self.act(letter, value);
        let wait = if letter == b'X' { Duration::from_millis(380) } else { Duration::ZERO };
        match (is_all, rows.is_empty()) {
            (true, _) => {}
            (false, true) => self.say(wait + Duration::from_millis(2), vec![0x06]),
            (false, false) => self.send_registers(&rows),
        }
    }

    fn send_registers(&mut self, rows: &[usize]) {
        let mut bytes = vec![self.ram[7] as u8];
        for row in rows {
            bytes.extend(&self.ram[*row].to_le_bytes()[..WIDTHS[*row]]);
        }
        let sum: u32 = bytes.iter().map(|byte| u32::from(*byte)).sum();
        bytes.push((sum & 0xFF) as u8);
        self.say(Duration::from_millis(2), bytes);
    }

    fn judge_line(&mut self, line: &str) {
        let words: Vec<&str> = line.split(' ').collect();
        let head = words[0].as_bytes();
        let address: i64 = words[0].get(1..3).and_then(|digits| digits.parse().ok()).unwrap_or(-1);
        let is_all = address == 99;
        if head.len() != 3 || address != self.ram[7] && !is_all {
            // Somebody else's, or nothing at all: the manual's unit complains about what it cannot read.
            if head.len() != 3 {
                self.say_line("BAD COMMAND");
            }
            return;
        }
        let numbers: Vec<i64> = words[1..].iter().filter_map(|word| word.parse().ok()).collect();
        let answer = match (head[0], numbers.as_slice()) {
            (b'R', [99]) => {
                let width = if self.manner == Manner::Sprawling { 7 } else { 0 };
                self.ram.iter().map(|value| format!("{value:0width$},")).collect()
            }
            (b'R', [97]) => (0..10).map(|bit| format!("S{bit}{}\r\n", on(self.ram[16], bit))).collect(),
            (b'R', [98]) => (0..16).map(|bit| format!("F{bit}{}\r\n", on(self.ram[3], bit))).collect(),
            (b'R', [index @ 0..=31]) => self.coded(*index as usize),
            (b'W' | b'S', [index @ 0..=31, value]) => {
                if !self.put(*index as usize, *value, head[0] == b'S') {
                    return self.say_line("BAD COMMAND");
                }
                self.done.push(head[0]);
                "OK".to_owned()
            }
            (letter @ (b'C' | b'P' | b'M' | b'V'), [value]) => self.moved(letter, *value),
            (letter @ (b'X' | b'Y'), []) => self.moved(letter, 0),
            _ => "BAD COMMAND".to_owned(),
        };
        if !is_all {
            let wait = self.busy_until.saturating_sub(self.now);
            let line = answer.trim_end().to_owned();
            if self.manner == Manner::Strict && !wait.is_zero() && head[0] != b'Y' {
                self.say(wait, format!("{line}\r\n").into_bytes());
            } else {
                self.say_line(&line);
            }
        }
    }

    fn moved(&mut self, letter: u8, value: i64) -> String {
        self.done.push(letter);
        let returned: Vec<String> = self.returned().iter().map(|(index, _)| self.coded(*index)).collect();
        self.act(letter, value);
        if returned.is_empty() { "OK".to_owned() } else { returned.join("\r\n") }
    }

    fn coded(&self, index: usize) -> String {
        let code = match (self.manner, index) {
            (Manner::Terse, _) => format!("R{index}"),
            (_, 0) => "APOS".to_owned(),
            (_, 4) => "PTRM".to_owned(),
            (_, 14) => "VELO".to_owned(),
            (_, 15) => "TIME".to_owned(),
            _ => format!("X{index:03}"),
        };
        let width = if self.manner == Manner::Sprawling { 8 } else { 0 };
        format!("{code}={:0width$}", self.ram[index])
    }

    /// What the public simulator makes of a line.
    fn judge_as_public(&mut self, line: &str) {
        let line = line.to_uppercase();
        let words: Vec<&str> = line.split(' ').collect();
        let answer = match (words[0], words.get(1)) {
            ("R01", Some(&"99")) => (0..32).map(|_| format!("{},", self.roll(16_384))).collect(),
            ("R01", _) => String::new(),
            _ => {
                self.done.push(words[0].bytes().next().unwrap_or_default());
                "OK".to_owned()
            }
        };
        // It slept up to a tenth of a second before it looked.
        let late = Duration::from_millis(u64::from(self.roll(100)));
        self.say(late, format!("{answer}\n").into_bytes());
    }

    fn hear(&mut self, byte: u8) {
        if self.now < self.busy_until {
            return;
        }
        self.last_byte_at = self.now;
        match byte {
            b'\n' if self.is_text => {
                let line = String::from_utf8_lossy(&std::mem::take(&mut self.buffer)).into_owned();
                let line = line.trim_end_matches('\r');
                match self.manner {
                    Manner::ReadsAllAlone => self.judge_as_public(line),
                    _ if line.is_empty() => {}
                    _ => self.judge_line(line),
                }
            }
            _ => self.buffer.push(byte),
        }
    }

    fn tick(&mut self) {
        self.ram[15] += 1;
        let before = self.ram[0];
        let drive = if self.ram[3] & 0x4000 != 0 && self.ram[18] != 3 { 0 } else { 1 };
        let step = match (self.target, self.ram[18]) {
            (Some(target), _) => (target - before).clamp(-40, 40) * drive,
            (None, 3) => self.duty / 20,
            (None, _) => self.velocity * drive,
        };
        self.ram[0] += step;
        self.ram[14] = step;
        self.ram[21] = if self.ram[18] == 3 { self.duty } else { (step * 20).clamp(-1023, 1023) };
        self.ram[27] = self.target.unwrap_or(self.ram[0]);
    }
}

fn on(word: i64, bit: i64) -> &'static str {
    if word >> bit & 1 == 1 { "ON" } else { "OFF" }
}

impl Machine for Foreign {
    fn now(&self) -> Duration {
        self.now
    }

    fn receive(&mut self, _: StreamIndex, bytes: &[u8]) {
        for byte in bytes {
            self.hear(*byte);
        }
    }

    fn advance(&mut self, to: Duration) {
        while self.now < to {
            let tick = Duration::from_millis((self.now.as_millis() as u64 / 5 + 1) * 5);
            // A buffer is judged 5 ms after its last byte.
            let judged = (!self.is_text && !self.buffer.is_empty()).then_some(self.last_byte_at + TICK);
            let next = judged.map_or(tick, |at| at.min(tick)).min(to).max(self.now);
            self.now = next;
            if judged.is_some_and(|at| self.now >= at) {
                self.judge_frame();
            }
            if self.now == tick {
                self.tick();
            }
        }
    }

    fn next_output_at(&self) -> Option<Duration> {
        let judged = (!self.is_text && !self.buffer.is_empty()).then_some(self.last_byte_at + TICK);
        self.output.iter().map(|(at, _)| *at).chain(judged).min()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        let now = self.now;
        let is_there = stream == StreamIndex::Uart0 && self.output.front().is_some_and(|(at, _)| *at <= now);
        if is_there { self.output.pop_front().map(|(_, bytes)| bytes) } else { None }
    }

    fn bits_per_second(&self, _: StreamIndex) -> u32 {
        19_200
    }

    fn units(&self) -> usize {
        1
    }

    fn apply(&mut self, _: usize, _: &WorldAction) {}

    fn views(&self) -> Vec<WorldView> {
        Vec::new()
    }

    fn plugged(&self) -> bool {
        true
    }
}

type Link = VirtualLink<Foreign>;

fn link_to(unit: Foreign, family: FamilyChoice, addresses: Addresses) -> Link {
    let options = DeviceOptions { addresses, family, ..DeviceOptions::default() };
    let mut link = VirtualLink::over(unit, options, Vec::new(), 1);
    link.run_for(Duration::from_secs(3));
    link
}

fn identity(link: &Link) -> Identity {
    let found = link.events.iter().find_map(|(_, event)| match event {
        Event::Connected(identity) => Some(identity.clone()),
        _ => None,
    });
    found.unwrap_or_else(|| panic!("nobody was found: {:?}", link.events))
}

fn failures(link: &Link) -> Vec<String> {
    let reported = link.events.iter().filter_map(|(_, event)| match event {
        Event::Failure(failure) | Event::Lost(failure) => Some(failure.to_string()),
        Event::ArmRefused { reasons, .. } => {
            Some(reasons.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "))
        }
        _ => None,
    });
    reported.collect()
}

fn latest(link: &Link, channel: Channel) -> Option<f64> {
    link.events.iter().rev().find_map(|(_, event)| match event {
        Event::Sample(sample) => sample.get(channel),
        _ => None,
    })
}

fn job<T: Send + 'static>(
    link: &mut Link,
    work: impl FnMut(&mut JobContext<'_>) -> Result<T, Failure> + Send + 'static,
) -> T {
    let limit = Duration::from_secs(60);
    match link.finish(Job::new(Said::Work, limit, work), limit) {
        Some(JobEnding::Done(value)) => value,
        other => panic!("{other:?}: {:?}", link.events),
    }
}

fn subject(revision: u8) -> Subject {
    brushwork_motion_mind_client::subject(revision)
}

const OPTIONS: WriteOptions = WriteOptions { own_stream: None, simulated: false, as_read: false };

fn manners() -> impl Iterator<Item = (Manner, bool)> {
    let text = [Manner::Strict, Manner::Sprawling, Manner::Terse, Manner::Slow].map(|manner| (manner, true));
    [(Manner::Strict, false), (Manner::Slow, false)].into_iter().chain(text)
}

#[test]
fn a_foreign_unit_is_found_in_whichever_protocol_and_manner_it_speaks() {
    for (manner, is_text) in manners() {
        for family in [FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND), FamilyChoice::AUTO] {
            for addresses in [Addresses::Factory, Addresses::Scan] {
                let mut unit = Foreign::new(manner, is_text, 4);
                unit.ram[0] = -12_345;
                let mut link = link_to(unit, family, addresses);
                link.run_for(Duration::from_secs(10));
                let identity = identity(&link);
                let facts = brushwork_motion_mind_client::MotionMindFacts::of(&identity)
                    .expect("it is a Motion Mind");
                let protocol = if is_text { Protocol::Text } else { Protocol::Binary };
                assert_eq!((facts.protocol, facts.mode.number()), (protocol, 4), "{manner:?}");
                assert_eq!(identity.generation.to_string(), "revision 5");
                assert_eq!(latest(&link, Channel::M1_POSITION), Some(-12_345.0), "{manner:?} {is_text}");
                assert!(failures(&link).is_empty(), "{manner:?}: {:?}", failures(&link));
                assert!(link.bus(|unit| unit.done.is_empty()), "looking changes nothing");
            }
        }
    }
}

#[test]
fn a_scan_finds_a_foreign_unit_at_its_address() {
    for (manner, is_text) in manners() {
        let mut unit = Foreign::new(manner, is_text, 3);
        unit.ram[7] = 57;
        let mut link =
            link_to(unit, FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND), Addresses::Scan);
        link.run_for(Duration::from_secs(20));
        assert_eq!(identity(&link).address, 57, "{manner:?}");
    }
}

#[test]
fn settings_of_a_foreign_unit_are_read_written_and_stored() {
    for (manner, is_text) in manners() {
        let mut link = link_to(
            Foreign::new(manner, is_text, 4),
            FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
            Addresses::Factory,
        );
        assert!(brushwork_motion_mind_client::is_motion_mind(&identity(&link)));
        let table = SettingsTable::new(subject(5));
        let read = job(&mut link, |wire| read_all(wire, subject(5)));
        assert_eq!(read.image.get("register.vnlimit"), Some(SettingValue::Int(-100_000)), "{manner:?}");
        assert_eq!(read.image.get("register.pterm"), Some(SettingValue::Int(6000)), "{manner:?}");
        let wanted = [
            ("register.pterm", SettingValue::Int(4321)),
            ("register.vplimit", SettingValue::Int(123_456)),
            ("function.satprot", SettingValue::Bool(true)),
        ];
        let image = wanted.map(|(key, value)| (key.to_owned(), value)).into_iter().collect();
        let copy = table.clone();
        let report = job(&mut link, move |wire| {
            write(wire, &copy, &image, OPTIONS)
                .map_err(|error| Failure::new(Said::Write, "it", Message::error(error), Said::Look))
        });
        assert!(report.is_complete(), "{manner:?}: {:?}", report.rows);
        assert_eq!(link.bus(|unit| (unit.ram[4], unit.ram[24], unit.ram[3])), (4321, 123_456, 0x10));
        assert_eq!(link.bus(|unit| unit.eeprom[4]), 6000, "nothing went to EEPROM");
        let saved = job(&mut link, move |wire| save_eeprom(wire, &table, OPTIONS));
        assert_eq!(saved.verdict, SaveVerdict::Stored, "{manner:?} {is_text}: {saved:?}");
        assert_eq!(link.bus(|unit| (unit.eeprom[4], unit.eeprom[24])), (4321, 123_456));
    }
}

#[test]
fn a_foreign_motor_is_driven_and_stopped() {
    for (manner, is_text) in manners() {
        let mut link = link_to(
            Foreign::new(manner, is_text, 3),
            FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
            Addresses::Factory,
        );
        assert!(link.arm(ArmScope::Pwm), "{manner:?}: {:?}", failures(&link));
        link.ask(Request::Drive(Drive::one(Motor::M1, DriveCommand::duty(0.5))));
        link.run_for(Duration::from_secs(1));
        assert_eq!(link.bus(|unit| unit.duty), 512, "{manner:?}: {:?}", failures(&link));
        link.handle.stop_all();
        link.run_for(Duration::from_secs(2));
        assert_eq!(link.bus(|unit| unit.duty), 0, "{manner:?}");
        assert!(link.stops().last().is_some_and(|stop| stop.confirmed()), "{manner:?}: {:?}", link.stops());

        let mut link = link_to(
            Foreign::new(manner, is_text, 4),
            FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
            Addresses::Factory,
        );
        assert!(link.arm(ArmScope::Position), "{manner:?}: {:?}", failures(&link));
        let speed_counts_per_s = -2000;
        let speed = DriveCommand::Speed { speed_counts_per_s, accel_counts_per_s2: None };
        link.ask(Request::Drive(Drive::one(Motor::M1, speed)));
        link.run_for(Duration::from_secs(1));
        assert_eq!(link.bus(|unit| unit.velocity), -10, "{manner:?}");
        link.freeze_window();
        link.run_for(Duration::from_secs(1));
        assert_eq!(link.bus(|unit| unit.velocity), 0, "{manner:?}: the dead-man stops it");
    }
}

#[test]
fn return_bits_that_somebody_else_sets_do_not_confuse_the_link() {
    for (manner, is_text) in manners() {
        let mut unit = Foreign::new(manner, is_text, 4);
        // RETPOS, RETVEL and RETTIME.
        unit.ram[3] = 0x0E;
        let mut link =
            link_to(unit, FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND), Addresses::Factory);
        assert!(link.arm(ArmScope::Position), "{manner:?}: {:?}", failures(&link));
        for returns in [0x0E, 0x02, 0x00, 0x08] {
            link.bus(|unit| unit.ram[3] = returns);
            link.events.clear();
            let speed = DriveCommand::Speed { speed_counts_per_s: 1000, accel_counts_per_s2: None };
            link.ask(Request::Drive(Drive::one(Motor::M1, speed)));
            link.run_for(Duration::from_millis(500));
            assert_eq!(link.bus(|unit| unit.velocity), 5, "{manner:?} {is_text} {returns:#X}");
            assert!(failures(&link).is_empty(), "{manner:?} {returns:#X}: {:?}", failures(&link));
        }
        link.handle.stop_all();
        link.run_for(Duration::from_secs(2));
        assert!(link.stops().last().is_some_and(|stop| stop.confirmed()), "{manner:?}: {:?}", link.stops());
    }
}

#[test]
fn the_public_simulator_is_connected_to_though_it_answers_the_read_of_all_registers_alone() {
    for family in [FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND), FamilyChoice::AUTO] {
        let mut link = link_to(Foreign::new(Manner::ReadsAllAlone, true, 4), family, Addresses::Factory);
        link.run_for(Duration::from_secs(10));
        let identity = identity(&link);
        assert_eq!(
            brushwork_motion_mind_client::MotionMindFacts::of(&identity).map(|facts| facts.protocol),
            Some(Protocol::Text),
            "{family}"
        );
        assert!(
            identity.notes.iter().any(|note| note.to_string().contains("simulator")),
            "{:?}",
            identity.notes
        );
        let seen: Vec<f64> = link
            .events
            .iter()
            .filter_map(|(_, event)| match event {
                Event::Sample(sample) => sample.get(Channel::M1_POSITION),
                _ => None,
            })
            .collect();
        assert!(seen.len() > 10 && seen.windows(2).any(|pair| pair[0] != pair[1]), "{family}: {seen:?}");
        assert!(failures(&link).is_empty(), "{family}: {:?}", failures(&link));
        assert!(!link.ended);
        // The line ends that part its lines from frames are the only commands it has heard.
        let heard = link.bus(|unit| unit.done.clone());
        assert!(heard.iter().all(|letter| !b"CPMVWSXYZ".contains(letter)), "{heard:?}");
    }
}

#[test]
fn a_search_does_not_count_as_errors_of_the_link() {
    let mut unit = Foreign::new(Manner::Strict, false, 4);
    unit.ram[7] = 90;
    let mut link =
        link_to(unit, FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND), Addresses::Scan);
    link.run_for(Duration::from_secs(10));
    assert_eq!(identity(&link).address, 90);
    let statistics = link.events.iter().rev().find_map(|(_, event)| match event {
        Event::Link(statistics) => Some(statistics.clone()),
        _ => None,
    });
    let statistics = statistics.expect("the link tells its figures");
    assert_eq!((statistics.timeouts, statistics.crc_errors, statistics.retries), (0, 0, 0), "{statistics:?}");
}
