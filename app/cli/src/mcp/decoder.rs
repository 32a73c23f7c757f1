//! Traffic of packet serial in words, in both directions. No clock, no IO: bytes and times in, records out.
//!
//! The firmware generation is followed as the traffic shows it: by commands that only a later one has, and by replies that
//! have the width of another one.

use std::collections::VecDeque;
use std::time::Duration;

use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{
    self, ACK, Address, DiscardReason, Effect, Framed, FramerEvent, Generation, PACKET_GAP, ReplyProgress,
    Request, RequestFramer, describe_event, describe_reply, number, parse_reply, scale,
};

use crate::monitor;
use crate::monitor::awaited::{Awaited, take};
use crate::monitor::follower::{Follower, Stop};
use crate::monitor::record::{Direction, Record};

/// A controller that has not answered after this time will not.
const REPLY_LIMIT: Duration = Duration::from_millis(250);

/// Follows a conversation.
pub struct Decoder {
    generation: Generation,
    is_fixed: bool,
    framer: RequestFramer,
    /// The last read and the bytes after it: together perhaps a CRC that the client appends.
    after_read: Option<AfterRead>,
    /// Requests whose replies are due, oldest first: some clients send several at once.
    awaited: VecDeque<Awaited<Request>>,
    moved: Vec<Address>,
}

struct AfterRead {
    crc: [u8; 2],
    until: Duration,
    bytes: Vec<u8>,
}

impl Decoder {
    /// Starts at the generation given and keeps it, or at the first and follows the traffic.
    pub fn new(fixed: Option<Generation>) -> Self {
        let generation = fixed.unwrap_or(Generation::Gen1);
        Self {
            generation,
            is_fixed: fixed.is_some(),
            framer: RequestFramer::new(generation),
            after_read: None,
            awaited: VecDeque::new(),
            moved: Vec::new(),
        }
    }

    fn take_event(&mut self, event: FramerEvent, now: Duration, records: &mut Vec<Record>) {
        self.after_read = None;
        let event = self.follow_generation(event);
        let text = describe_event(&event, self.generation);
        let bytes = match &event {
            FramerEvent::Request(framed) => framed.raw,
            FramerEvent::Discarded(discarded) => discarded.bytes,
        };
        if let FramerEvent::Request(framed) = event {
            while self.awaited.front().is_some_and(|awaited| awaited.is_cut_off(now)) {
                records.extend(self.give_up_reply(now));
            }
            self.take_request(&framed, now);
        }
        records.push(Record::new(now, Direction::ToController, bytes.to_vec(), text));
    }

    fn take_request(&mut self, framed: &Framed, now: Duration) {
        let form = framed.command.form(self.generation);
        let is_read = form.is_some_and(|form| form.direction == packet_serial::Direction::Read);
        self.after_read = is_read.then(|| AfterRead {
            crc: crc16_xmodem(&framed.raw).to_be_bytes(),
            until: now.saturating_add(PACKET_GAP),
            bytes: Vec::new(),
        });
        self.awaited.push_back(Awaited::new(framed.request(), now));
        if form.is_some_and(|form| can_move(form.effect)) {
            self.note_motion(framed);
        }
    }

    fn note_motion(&mut self, framed: &Framed) {
        let zero = setpoints(framed).all(|raw| raw == 0);
        match (zero, setpoints(framed).count()) {
            (true, 2..) => self.moved.retain(|moved| *moved != framed.address),
            // One motor's standstill says nothing about the other.
            (true, 1) => {}
            _ if !self.moved.contains(&framed.address) => self.moved.push(framed.address),
            _ => {}
        }
    }

    /// The framer swallows a CRC that a client appends to a read; here it is shown.
    fn take_appended(&mut self, byte: u8, now: Duration, records: &mut Vec<Record>) {
        let Some(after) = &mut self.after_read else { return };
        if after.bytes.is_empty() && now > after.until {
            self.after_read = None;
            return;
        }
        after.bytes.push(byte);
        if after.bytes == after.crc {
            let bytes = std::mem::take(&mut after.bytes);
            self.after_read = None;
            match records.last_mut() {
                Some(read) => read.bytes.extend(bytes),
                None => {
                    records.push(Record::new(now, Direction::ToController, bytes, "CRC of that read".into()));
                }
            }
        } else if after.bytes.len() >= after.crc.len() {
            self.after_read = None;
        }
    }

    /// A command that this generation lacks moves the decoder to the first one that has it.
    fn follow_generation(&mut self, event: FramerEvent) -> FramerEvent {
        let FramerEvent::Discarded(discarded) = &event else { return event };
        if self.is_fixed || discarded.why != DiscardReason::NotInGeneration {
            return event;
        }
        for generation in Generation::ALL.into_iter().filter(|known| *known > self.generation) {
            let mut framer = RequestFramer::new(generation);
            let mut events = discarded.bytes.iter().filter_map(|&byte| framer.feed(byte, Duration::ZERO));
            if let Some(found @ FramerEvent::Request(_)) = events.next() {
                self.set_generation(generation);
                return found;
            }
        }
        event
    }

    fn set_generation(&mut self, generation: Generation) {
        self.generation = generation;
        self.framer = RequestFramer::new(generation);
    }

    /// The reply to the oldest request if it is whole; gives the bytes that came after it. What looks wrong may be the first
    /// part of something longer: the silence after it decides.
    fn take_reply(&mut self, records: &mut Vec<Record>) -> Option<Vec<u8>> {
        let awaited = self.awaited.front()?;
        let progress = parse_reply(&awaited.request, self.generation, &awaited.bytes);
        let ReplyProgress::Done { values, used } = progress else { return None };
        let Awaited { request, mut bytes, first_at, .. } = self.awaited.pop_front()?;
        let rest = bytes.split_off(used);
        let text = describe_reply(&request, &values, self.generation);
        records.push(Record::new(first_at, Direction::FromController, bytes, text));
        Some(rest)
    }

    /// Bytes that are no reply to the oldest request but one to the next mean that the oldest was not answered.
    fn skip_unanswered(&mut self, now: Duration, records: &mut Vec<Record>) {
        let fits = |request: &Request, bytes: &[u8]| {
            use ReplyProgress::{Done, NeedMore};
            matches!(parse_reply(request, self.generation, bytes), Done { .. } | NeedMore { .. })
        };
        let (Some(first), Some(second)) = (self.awaited.front(), self.awaited.get(1)) else { return };
        if fits(&first.request, &first.bytes) || !fits(&second.request, &first.bytes) {
            return;
        }
        let (bytes, first_at) = (first.bytes.clone(), first.first_at);
        if let Some(first) = self.awaited.front_mut() {
            first.bytes.clear();
        }
        records.extend(self.give_up_reply(now));
        if let Some(second) = self.awaited.front_mut() {
            (second.bytes, second.first_at, second.last_at) = (bytes, first_at, now);
        }
    }

    /// Ends the wait for the oldest reply and tells what there is of it.
    fn give_up_reply(&mut self, now: Duration) -> Option<Record> {
        let Awaited { request, bytes, first_at, .. } = self.awaited.pop_front()?;
        if bytes.is_empty() {
            let title = request.row().map_or("", |row| row.title(self.generation));
            let text = format!("{} {title}: no answer", request.address);
            return Some(Record::new(now, Direction::FromController, bytes, text));
        }
        let text = self.foreign_reply(&request, &bytes).unwrap_or_else(|| self.fault_of(&request, &bytes));
        Some(Record::new(first_at, Direction::FromController, bytes, text))
    }

    /// A reply that fits another generation moves the decoder there.
    fn foreign_reply(&mut self, request: &Request, bytes: &[u8]) -> Option<String> {
        if self.is_fixed {
            return None;
        }
        let others = Generation::ALL.into_iter().filter(|other| *other != self.generation);
        let (generation, values) =
            others.into_iter().find_map(|other| match parse_reply(request, other, bytes) {
                ReplyProgress::Done { values, used } if used == bytes.len() => Some((other, values)),
                ReplyProgress::NeedMore { .. }
                | ReplyProgress::Done { .. }
                | ReplyProgress::BadCrc { .. }
                | ReplyProgress::BadAck { .. }
                | ReplyProgress::Malformed { .. } => None,
            })?;
        self.set_generation(generation);
        Some(describe_reply(request, &values, generation))
    }

    fn fault_of(&self, request: &Request, bytes: &[u8]) -> String {
        let what = match parse_reply(request, self.generation, bytes) {
            ReplyProgress::NeedMore { at_least } => format!("cut short, at least {at_least} bytes are due"),
            ReplyProgress::BadCrc { expected, got, .. } => format!("CRC {got:04X} instead of {expected:04X}"),
            ReplyProgress::BadAck { got } => format!("{got:02X} instead of the acknowledgement FF"),
            ReplyProgress::Malformed { what } => what.to_owned(),
            ReplyProgress::Done { .. } => "more bytes than the reply has".to_owned(),
        };
        let title = request.row().map_or("", |row| row.title(self.generation));
        format!("{} {title}: bad reply ({what})", request.address)
    }
}

impl Follower for Decoder {
    fn client_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        let mut records = Vec::new();
        for &byte in bytes {
            let event = self.framer.feed(byte, now);
            match event {
                Some(event) => self.take_event(event, now, &mut records),
                None => self.take_appended(byte, now, &mut records),
            }
        }
        records
    }

    fn controller_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        if let Some(unasked) = take(&mut self.awaited, bytes, now) {
            return vec![unasked];
        }
        let mut records = Vec::new();
        self.skip_unanswered(now, &mut records);
        if let Some(rest) = self.take_reply(&mut records)
            && !rest.is_empty()
        {
            records.extend(self.controller_sent(&rest, now));
        }
        records
    }

    fn awaits_reply(&self) -> bool {
        !self.awaited.is_empty()
    }

    fn may_become_whole(&self) -> bool {
        let mut ended = self.framer.clone();
        matches!(
            ended.silence(Duration::MAX),
            Some(FramerEvent::Discarded(discarded)) if discarded.why == DiscardReason::Gap
        )
    }

    fn silence(&mut self, now: Duration) -> Vec<Record> {
        let mut records = self.client_silence(now);
        while self.awaited.front().is_some_and(|awaited| awaited.is_over(now, REPLY_LIMIT, PACKET_GAP)) {
            records.extend(self.give_up_reply(now));
        }
        records
    }

    fn client_silence(&mut self, now: Duration) -> Vec<Record> {
        let mut records = Vec::new();
        if let Some(event) = self.framer.silence(now) {
            self.take_event(event, now, &mut records);
        }
        records
    }

    fn client_left(&mut self, now: Duration) -> Vec<Record> {
        let mut records = Vec::new();
        if let Some(event) = self.framer.silence(Duration::MAX) {
            self.take_event(event, now, &mut records);
        }
        while self.awaits_reply() {
            records.extend(self.give_up_reply(now));
        }
        self.framer.reset();
        self.after_read = None;
        records
    }

    fn stops(&self) -> Vec<Stop> {
        self.moved.iter().filter_map(|address| stop_of(*address, self.generation)).collect()
    }
}

impl Awaited<Request> {
    /// A request that comes now is not one of several sent at once: the client waits no longer.
    fn is_cut_off(&self, now: Duration) -> bool {
        !self.bytes.is_empty() || now.saturating_sub(self.sent_at) >= PACKET_GAP
    }
}

fn can_move(effect: Effect) -> bool {
    matches!(effect, Effect::Motion | Effect::RelativeMotion | Effect::Buffered | Effect::Script)
}

/// The duties and speeds that a command sets, raw.
fn setpoints(framed: &Framed) -> impl Iterator<Item = i64> {
    let names = framed.values.iter().map(|(field, _)| field.name);
    let setpoints = names.filter(|name| name.starts_with("duty") || name.starts_with("speed"));
    setpoints.filter_map(|name| framed.values.try_int(name))
}

/// What stands both motors of a unit.
fn stop_of(address: Address, generation: Generation) -> Option<Stop> {
    const DUTY_ZERO: [i64; 4] = [0, scale::MAX_DUTY_ACCEL_RAW, 0, scale::MAX_DUTY_ACCEL_RAW];
    let request = Request::new(address, number::DUTY_ACCEL_BOTH, &DUTY_ZERO);
    let writes = vec![request.encode(generation).ok()?];
    Some(Stop { who: format!("both motors of {address}"), writes, acknowledge: &[ACK] })
}

/// What the requests of packet serial in a text of bytes mean, a sentence each.
///
/// # Errors
/// Something is no byte; a clause names it with its place.
pub fn meanings(text: &str) -> Result<Vec<String>, String> {
    monitor::meanings(text, &mut Decoder::new(None))
}

#[cfg(test)]
mod tests {
    use brushwork_mcp_wire::packet_serial::{encode_reply, number};
    use brushwork_values::Value;

    use super::*;

    const fn ms(millis: u64) -> Duration {
        Duration::from_millis(millis)
    }

    fn request(number: u8, values: &[i64]) -> Request {
        Request::new(Address::DEFAULT, number, values)
    }

    fn bytes(number: u8, values: &[i64], generation: Generation) -> Vec<u8> {
        request(number, values).encode(generation).unwrap()
    }

    fn texts(records: &[Record]) -> Vec<&str> {
        records.iter().map(|record| record.text.as_str()).collect()
    }

    #[test]
    fn a_reply_in_pieces_is_one_record_at_the_time_of_its_first_byte() {
        let mut decoder = Decoder::new(None);
        let asked = decoder.client_sent(&[0x80, 24], ms(1)); // 0x80, command 24: main battery
        assert_eq!(texts(&asked), ["0x80 read main battery"]);
        let reply = encode_reply(&request(24, &[]), Generation::Gen1, &[Value::Int(243)]).unwrap();
        assert!(decoder.awaits_reply());
        assert!(decoder.controller_sent(&reply[..1], ms(2)).is_empty());
        let answered = decoder.controller_sent(&reply[1..], ms(3));
        assert_eq!(texts(&answered), ["0x80 read main battery: 24.3 V"]);
        assert_eq!((answered[0].at, &answered[0].bytes), (Some(ms(2)), &reply));
        assert!(!decoder.awaits_reply());
    }

    #[test]
    fn a_crc_appended_to_a_read_is_shown_with_it_or_after_it() {
        let mut decoder = Decoder::new(None);
        let at_once = decoder.client_sent(&[0x80, 21, 0x59, 0x0C], ms(0)); // read version and its CRC
        assert_eq!(at_once[0].bytes, [0x80, 21, 0x59, 0x0C]);
        decoder.client_sent(&[0x80, 21], ms(20));
        let late = decoder.client_sent(&[0x59, 0x0C], ms(25));
        assert_eq!(
            (late[0].text.as_str(), late[0].bytes.as_slice()),
            ("CRC of that read", &[0x59, 0x0C][..])
        );
    }

    #[test]
    fn what_is_not_answered_is_told_once_the_time_is_over_or_the_next_request_comes() {
        let mut decoder = Decoder::new(None);
        decoder.client_sent(&[0x81, 24], ms(0));
        assert!(decoder.silence(ms(200)).is_empty());
        assert_eq!(texts(&decoder.silence(ms(300))), ["0x81 read main battery: no answer"]);
        decoder.client_sent(&[0x82, 24], ms(400));
        let next = decoder.client_sent(&[0x80, 25], ms(410));
        assert_eq!(texts(&next), ["0x82 read main battery: no answer", "0x80 read logic battery"]);
    }

    #[test]
    fn several_requests_at_once_are_matched_with_their_replies_in_order() {
        let mut decoder = Decoder::new(None);
        let stop_script = bytes(number::STOP_SCRIPT, &[], Generation::Gen1);
        decoder.client_sent(&[&stop_script[..], &[0x81, 24, 0x80, 24]].concat(), ms(0));
        let battery = encode_reply(&request(24, &[]), Generation::Gen1, &[Value::Int(243)]).unwrap();
        // FF acknowledges the first; 0x81 is not there; the CRC tells that 0x80 has answered.
        let reported = decoder.controller_sent(&[&[0xFF][..], &battery].concat(), ms(3));
        let wanted = [
            "0x80 stop script: acknowledged",
            "0x81 read main battery: no answer",
            "0x80 read main battery: 24.3 V",
        ];
        assert_eq!(texts(&reported), wanted);
        assert!(!decoder.awaits_reply());
    }

    #[test]
    fn a_damaged_reply_and_an_answer_to_nothing_are_told_as_such() {
        let mut decoder = Decoder::new(Some(Generation::Gen1));
        assert_eq!(texts(&decoder.controller_sent(&[7], ms(0))), ["answer to nothing"]);
        decoder.client_sent(&[0x80, 24], ms(1));
        assert!(decoder.controller_sent(&[0, 243, 1, 2], ms(2)).is_empty(), "more may come");
        let reported = decoder.silence(ms(20));
        assert!(
            reported[0].text.contains("read main battery: bad reply (CRC 0102 instead of"),
            "{reported:?}"
        );
    }

    #[test]
    fn a_reply_of_another_width_moves_the_decoder_to_its_generation() {
        let reply = encode_reply(&request(90, &[]), Generation::Gen3, &[Value::Int(0)]).unwrap();
        assert_eq!(reply.len(), 6, "32 bits of status and the CRC");
        let mut decoder = Decoder::new(None);
        decoder.client_sent(&[0x80, 90], ms(0));
        decoder.controller_sent(&reply, ms(1));
        assert_eq!(texts(&decoder.silence(ms(20))), ["0x80 read status: 0x00000000 (normal)"]);
        assert!(decoder.generation > Generation::Gen1);
        let mut fixed = Decoder::new(Some(Generation::Gen1));
        fixed.client_sent(&[0x80, 90], ms(0));
        fixed.controller_sent(&reply, ms(1));
        assert!(fixed.silence(ms(20))[0].text.contains("bad reply"));
    }

    #[test]
    fn a_command_of_a_later_generation_moves_the_decoder_there() {
        let mut decoder = Decoder::new(None);
        let reported = decoder.client_sent(&[0x80, number::READ_ALL_STATUS], ms(0));
        assert_eq!(texts(&reported), ["0x80 read all status"]);
        assert!(decoder.generation > Generation::Gen1);
    }

    #[test]
    fn units_that_were_told_to_move_are_remembered_until_both_motors_are_told_to_stand_still() {
        let mut decoder = Decoder::new(None);
        let mut send = |number, values: &[i64]| {
            decoder.client_sent(&bytes(number, values, Generation::Gen1), ms(0));
            !decoder.moved.is_empty()
        };
        assert!(!send(number::READ_STATUS, &[]));
        assert!(send(number::DUTY_M1, &[1000]));
        assert!(send(number::DUTY_M2, &[0]), "motor 1 runs on");
        assert!(!send(number::DUTY_BOTH, &[0, 0]));
        assert!(send(number::SPEED_BOTH, &[0, 5]));
        assert!(!send(number::DUTY_ACCEL_BOTH, &[0, 655_359, 0, 655_359]));
    }
}
