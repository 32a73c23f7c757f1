//! Motion Mind traffic of both directions in words, in whichever of the two protocols it is. No clock, no IO: bytes and times in, records
//! out.
//!
//! Frames begin with a byte that no line has, so that the traffic itself tells which protocol is spoken.

use std::collections::VecDeque;
use std::time::Duration;

use brushwork_motion_mind_wire::{
    ACK, Address, Command, Effect, FrameEvent, FrameReader, LineEvent, LineReader, Progress, Protocol,
    Returns, checksum, describe_command, describe_reply, encode_frame, encode_line, function,
    parse_frame_reply, parse_line_reply, register_number,
};

use crate::monitor::awaited::{Awaited, take};
use crate::monitor::follower::{Follower, Stop};
use crate::monitor::record::{Direction, Record};

/// A unit that has not answered after this time will not.
const REPLY_LIMIT: Duration = Duration::from_millis(250);
/// The same for what writes all of EEPROM.
const RESTORE_LIMIT: Duration = Duration::from_millis(1500);
/// An answer that stops for so long is over.
const REPLY_GAP: Duration = Duration::from_millis(30);
/// A command that comes so much later is not one of several sent at once.
const NEXT_COMMAND: Duration = Duration::from_millis(10);

/// Follows a conversation.
#[derive(Default)]
pub struct Decoder {
    frames: FrameReader,
    lines: LineReader,
    /// What the client has sent since its last command, and since when.
    open: Vec<u8>,
    open_since: Duration,
    /// Commands whose answers are due, oldest first.
    awaited: VecDeque<Awaited<Asked>>,
    /// The return bits of units, as writes to FUNCTION tell.
    returns: Vec<(Address, Returns)>,
    moved: Vec<Moved>,
}

/// A unit that was told to move and not to stand since.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Moved {
    address: Address,
    protocol: Protocol,
    /// By a duty, else by a velocity or a move.
    is_duty: bool,
}

/// A command whose answer is due; none for a line that is no command.
struct Asked {
    address: Address,
    command: Option<Command>,
    protocol: Protocol,
}

impl Moved {
    /// What stands its motor.
    fn stop(self) -> Stop {
        // A setpoint that stands, in mode 4 and in mode 5.
        let closed = [Command::MoveAtVelocity(0), Command::MoveToRelative(0)];
        let commands = if self.is_duty { &[Command::ChangeSpeed(0)][..] } else { &closed[..] };
        let encode = |command: &Command| match self.protocol {
            Protocol::Binary => encode_frame(self.address, command).ok(),
            Protocol::Text => encode_line(self.address, command).ok().map(String::into_bytes),
        };
        Stop {
            who: format!("the motor of {}", self.address),
            writes: commands.iter().filter_map(encode).collect(),
            acknowledge: match self.protocol {
                Protocol::Binary => &[ACK],
                Protocol::Text => b"OK",
            },
        }
    }
}

impl Decoder {
    fn take_command(
        &mut self,
        address: Address,
        command: Command,
        protocol: Protocol,
        now: Duration,
        records: &mut Vec<Record>,
    ) {
        while self.awaited.front().is_some_and(|awaited| now >= awaited.sent_at + NEXT_COMMAND) {
            records.extend(self.give_up());
        }
        records.push(self.close(describe_command(address, &command)));
        match protocol {
            Protocol::Binary => self.lines = LineReader::new(),
            Protocol::Text => self.frames = FrameReader::new(),
        }
        self.note_motion(address, command, protocol);
        if !address.is_broadcast() {
            self.wait_for(address, Some(command), protocol, now);
        }
    }

    fn wait_for(&mut self, address: Address, command: Option<Command>, protocol: Protocol, now: Duration) {
        self.awaited.push_back(Awaited::new(Asked { address, command, protocol }, now));
    }

    /// What the client has sent, as a record.
    fn close(&mut self, text: String) -> Record {
        Record::new(self.open_since, Direction::ToController, std::mem::take(&mut self.open), text)
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn note_motion(&mut self, address: Address, command: Command, protocol: Protocol) {
        match command {
            Command::ChangeSpeed(0) | Command::MoveAtVelocity(0) | Command::Restore | Command::Reset => {
                self.moved.retain(|moved| moved.address != address && !address.is_broadcast());
            }
            _ if matches!(command.effect(), Effect::Motion | Effect::RelativeMotion) => {
                let is_duty = matches!(command, Command::ChangeSpeed(_));
                self.moved.retain(|moved| moved.address != address);
                self.moved.push(Moved { address, protocol, is_duty });
            }
            _ => {}
        }
    }

    /// The answer to the oldest command if it is whole, and the bytes that came after it.
    fn whole_reply(&mut self) -> Option<(Record, Vec<u8>)> {
        let awaited = self.awaited.front()?;
        let (text, used) = awaited.read(self.returns_of(awaited.request.address))?;
        let Awaited { mut bytes, first_at, request, .. } = self.awaited.pop_front()?;
        let rest = bytes.split_off(used);
        self.note_write(request.address, request.command);
        Some((Record::new(first_at, Direction::FromController, bytes, text), rest))
    }

    fn returns_of(&self, address: Address) -> Option<Returns> {
        self.returns.iter().find(|(known, _)| *known == address).map(|(_, returns)| *returns)
    }

    /// A write to FUNCTION that was acknowledged tells what moves are answered with.
    fn note_write(&mut self, address: Address, command: Option<Command>) {
        let Some(Command::Write { register, value } | Command::WriteStore { register, value }) = command
        else {
            return;
        };
        if register == register_number::FUNCTION {
            let bits = u16::try_from(value).unwrap_or_default();
            self.returns.retain(|(known, _)| *known != address);
            self.returns.push((address, Returns::of_function(bits)));
        }
    }

    /// Ends the wait for the oldest answer and tells what there is of it.
    fn give_up(&mut self) -> Option<Record> {
        let awaited = self.awaited.pop_front()?;
        let what = match (awaited.bytes.is_empty(), awaited.bad()) {
            (true, _) => "no answer".to_owned(),
            (false, Some(why)) => format!("bad reply ({why})"),
            (false, None) => "a reply cut short".to_owned(),
        };
        let text = format!("{}: {what}", awaited.request.address);
        Some(Record::new(awaited.first_at, Direction::FromController, awaited.bytes, text))
    }
}

impl Follower for Decoder {
    fn client_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        let mut records = self.client_silence(now);
        for &byte in bytes {
            if self.open.is_empty() {
                self.open_since = now;
            }
            self.open.push(byte);
            let frame = self.frames.feed(byte, now);
            let line = self.lines.feed(byte).filter(|_| is_text(&self.open));
            match (frame, line) {
                (Some(FrameEvent::Command(address, command)), _) => {
                    self.take_command(address, command, Protocol::Binary, now, &mut records);
                }
                (_, Some(LineEvent::Command(address, command))) => {
                    self.take_command(address, command, Protocol::Text, now, &mut records);
                }
                (_, Some(LineEvent::SelfTest(address))) => {
                    records.push(
                        self.close(format!("{address}: self-test; it answers again after a power cycle")),
                    );
                }
                (_, Some(LineEvent::NotUnderstood { address, line })) => {
                    records.push(self.close(format!("no command: {line:?}")));
                    let address = address.unwrap_or(Address::FACTORY);
                    self.wait_for(address, None, Protocol::Text, now);
                }
                _ => {}
            }
        }
        records
    }

    fn controller_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        if let Some(unasked) = take(&mut self.awaited, bytes, now) {
            return vec![unasked];
        }
        let mut records = Vec::new();
        if let Some((record, rest)) = self.whole_reply() {
            records.push(record);
            if !rest.is_empty() {
                records.extend(self.controller_sent(&rest, now));
            }
        }
        records
    }

    fn awaits_reply(&self) -> bool {
        !self.awaited.is_empty()
    }

    fn may_become_whole(&self) -> bool {
        !self.open.is_empty()
    }

    fn silence(&mut self, now: Duration) -> Vec<Record> {
        let mut records = self.client_silence(now);
        let limit = |asked: &Asked| match asked.command {
            Some(Command::Restore) => RESTORE_LIMIT,
            _ => REPLY_LIMIT,
        };
        let is_over = |due: &Awaited<Asked>| due.is_over(now, limit(&due.request), REPLY_GAP);
        while self.awaited.front().is_some_and(is_over) {
            records.extend(self.give_up());
        }
        records
    }

    /// A frame that stopped half way is dropped, a line is not.
    fn client_silence(&mut self, now: Duration) -> Vec<Record> {
        let is_dropped = self.frames.silent_until(now).is_some();
        if !is_dropped || self.open.is_empty() || is_text(&self.open) {
            return Vec::new();
        }
        self.lines = LineReader::new();
        let why = why_no_frame(&self.open);
        vec![self.close(format!("no command: {why}"))]
    }

    fn client_left(&mut self, now: Duration) -> Vec<Record> {
        let mut records = self.client_silence(Duration::MAX);
        if !self.open.is_empty() {
            records.push(self.close("no command: a line without its end".to_owned()));
        }
        while self.awaits_reply() {
            records.extend(self.give_up());
        }
        (self.frames, self.lines) = (FrameReader::new(), LineReader::new());
        records.iter_mut().for_each(|record| record.at = record.at.map(|at| at.min(now)));
        records
    }

    fn stops(&self) -> Vec<Stop> {
        self.moved.iter().map(|moved| moved.stop()).collect()
    }
}

impl Awaited<Asked> {
    /// What it says and how many bytes it takes, if it is whole. Return bits that nobody has told are found out by what fits.
    fn read(&self, known: Option<Returns>) -> Option<(String, usize)> {
        let whole = |progress| match progress {
            Progress::Done { reply, used } => Some((describe_reply(&reply), used)),
            Progress::Incomplete | Progress::Bad(_) => None,
        };
        let Some(command) = &self.request.command else {
            return whole(parse_line_reply(&Command::Reset, Returns::default(), &self.bytes));
        };
        if let Some(read) = known.and_then(|returns| whole(self.parse(command, returns))) {
            return Some(read);
        }
        let all = (0..8).map(|bits| Returns::of_function(bits * function::RETPOS));
        let fits = |(_, used): &(String, usize)| *used == self.bytes.len();
        all.into_iter().find_map(|returns| whole(self.parse(command, returns)).filter(fits))
    }

    fn parse(&self, command: &Command, returns: Returns) -> Progress {
        match self.request.protocol {
            Protocol::Binary => parse_frame_reply(self.request.address, command, returns, &self.bytes),
            Protocol::Text => parse_line_reply(command, returns, &self.bytes),
        }
    }

    fn bad(&self) -> Option<String> {
        match self.parse(self.request.command.as_ref()?, Returns::default()) {
            Progress::Bad(bad) => Some(bad.to_string()),
            Progress::Incomplete | Progress::Done { .. } => None,
        }
    }
}

/// Whether bytes can be a line, or the beginning of one.
fn is_text(bytes: &[u8]) -> bool {
    bytes.iter().all(|byte| matches!(byte, 0x08 | b'\r' | b'\n' | b' '..=b'~'))
}

/// Why a unit is silent to these bytes.
fn why_no_frame(bytes: &[u8]) -> String {
    let is_command = bytes.first().is_some_and(|first| (0x14..=0x1D).contains(first));
    match bytes {
        [first, ..] if !is_command => format!("{first:#04X} begins none"),
        [.., sum] if bytes.len() >= 3 && checksum(&bytes[..bytes.len() - 1]) != *sum => {
            let expected = checksum(&bytes[..bytes.len() - 1]);
            format!("stopped half way, or its checksum is {sum:#04X} and not {expected:#04X}")
        }
        _ => "stopped half way, or of another length than the command has".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(millis: u64) -> Duration {
        Duration::from_millis(millis)
    }

    fn texts(records: &[Record]) -> Vec<&str> {
        records.iter().map(|record| record.text.as_str()).collect()
    }

    #[test]
    fn frames_and_lines_are_told_from_the_traffic_itself() {
        let mut decoder = Decoder::default();
        // READ REGISTER 1 byte by byte, and its answer in two pieces: address, 1023, checksum.
        let mut reported = Vec::new();
        for (at, byte) in [0x1D, 0x01, 0x01, 0x1F].into_iter().enumerate() {
            reported.extend(decoder.client_sent(&[byte], ms(at as u64)));
        }
        assert_eq!(texts(&reported), ["unit 1: read VELOCITYLIMIT"]);
        assert_eq!((reported[0].at, reported[0].bytes.len()), (Some(ms(0)), 4));
        assert!(decoder.controller_sent(&[0x01, 0xFF], ms(6)).is_empty() && decoder.awaits_reply());
        let reported = decoder.controller_sent(&[0x03, 0x03], ms(7));
        assert_eq!((texts(&reported), reported[0].at), (vec!["VELOCITYLIMIT 1023"], Some(ms(6))));
        // The same in lines, on the same line of a moment later.
        let reported = decoder.client_sent(b"R01 04\r\n", ms(100));
        assert_eq!(texts(&reported), ["unit 1: read PTERM"]);
        assert_eq!(texts(&decoder.controller_sent(b"PTRM=6000\r\n", ms(110))), ["PTERM 6000"]);
    }

    #[test]
    fn what_is_no_command_is_told_with_its_reason() {
        let mut decoder = Decoder::default();
        // MOVETO_ABSOLUTE 1000 with a wrong checksum.
        assert!(decoder.client_sent(&[0x15, 0x01, 0xE8, 0x03, 0x00, 0x00, 0x02], ms(0)).is_empty());
        let reported = decoder.silence(ms(20));
        assert!(reported[0].text.contains("checksum is 0x02 and not 0x01"), "{reported:?}");
        decoder.client_sent(&[0x80, 0x15], ms(30));
        assert!(decoder.silence(ms(50))[0].text.contains("0x80 begins none"));
        let reported = decoder.client_sent(b"Q01\r\n", ms(60));
        assert_eq!(texts(&reported), ["no command: \"Q01\""]);
        assert_eq!(texts(&decoder.controller_sent(b"BAD COMMAND\r\n", ms(70))), ["not understood"]);
        assert!(decoder.client_sent(b"Z01\r\n", ms(80))[0].text.contains("self-test"));
    }

    #[test]
    fn missing_wrong_and_unasked_answers_are_told_as_such() {
        let mut decoder = Decoder::default();
        assert_eq!(texts(&decoder.controller_sent(&[6], ms(0))), ["answer to nothing"]);
        decoder.client_sent(&[0x1D, 0x02, 0x01, 0x20], ms(10));
        assert!(decoder.silence(ms(200)).is_empty());
        assert_eq!(texts(&decoder.silence(ms(300))), ["unit 2: no answer"]);
        decoder.client_sent(&[0x1D, 0x01, 0x01, 0x1F], ms(400));
        decoder.controller_sent(&[0x01, 0xFF, 0x03, 0x04], ms(405));
        let reported = decoder.silence(ms(500));
        assert!(reported[0].text.contains("bad reply (the checksum is 0x04, not 0x03)"), "{reported:?}");
        // A broadcast is answered by nobody.
        decoder.client_sent(&[0x17, 0x63, 0x00, 0x00, 0x7A], ms(600));
        assert!(!decoder.awaits_reply());
    }

    #[test]
    fn answers_follow_the_return_bits_that_were_written_and_unknown_ones_are_found_out() {
        let mut decoder = Decoder::default();
        // MOVETO_ABSOLUTE 1000 answered by POSITION 1000.
        decoder.client_sent(&[0x15, 0x01, 0xE8, 0x03, 0x00, 0x00, 0x01], ms(0));
        let reported = decoder.controller_sent(&[0x01, 0xE8, 0x03, 0x00, 0x00, 0xEC], ms(5));
        assert_eq!(texts(&reported), ["POSITION 1000"]);
        // WRITE FUNCTION 4: RETVEL.
        decoder.client_sent(&[0x18, 0x01, 0x03, 0x04, 0x00, 0x20], ms(20));
        assert_eq!(texts(&decoder.controller_sent(&[0x06], ms(25))), ["acknowledged"]);
        decoder.client_sent(&[0x17, 0x01, 0x38, 0xFF, 0x4F], ms(40));
        let reported = decoder.controller_sent(&[0x01, 0x05, 0x00, 0x06], ms(45));
        assert_eq!(texts(&reported), ["VELOCITY 5"]);
    }

    #[test]
    fn units_that_were_told_to_move_are_remembered_with_what_stands_them() {
        let mut decoder = Decoder::default();
        let mut send = |bytes: &[u8]| {
            decoder.client_sent(bytes, ms(0));
            decoder.stops().into_iter().map(|stop| stop.writes).collect::<Vec<_>>()
        };
        // CHANGE_SPEED 763 to unit 1, then 0.
        assert_eq!(send(&[0x14, 0x01, 0xFB, 0x02, 0x12]), [[vec![0x14, 0x01, 0x00, 0x00, 0x15]]]);
        assert!(send(&[0x14, 0x01, 0x00, 0x00, 0x15]).is_empty());
        assert_eq!(send(b"P02 500\r\n"), [[b"V02 0\r\n".to_vec(), b"M02 0\r\n".to_vec()]]);
        assert!(send(b"V99 0\r\n").is_empty(), "all units stand");
    }
}
