//! MotorVator traffic of both directions in words. No clock, no IO: bytes and times in, records out.
//!
//! A board answers nothing by itself: an answer is awaited where the host library has sent something before, and after `H`.

use std::time::Duration;

use brushwork_motorvator_client::{describe_received, describe_sent};
use brushwork_motorvator_wire::host::{HostAnswer, HostOrder, stop_bytes};
use brushwork_motorvator_wire::{LINE_END, Order};

use crate::monitor::follower::{Follower, Stop};
use crate::monitor::record::{Direction, Record};

/// A board that has not answered after this time will not.
const REPLY_LIMIT: Duration = Duration::from_millis(1000);
/// A line of the board that stops for so long is cut short.
const REPLY_GAP: Duration = Duration::from_millis(200);

/// Follows a conversation.
#[derive(Default)]
pub struct Decoder {
    to_board: Open,
    from_board: Open,
    /// The order whose answer is due, and since when.
    awaited: Option<(HostOrder, u8, Duration)>,
    /// Whether an answer of the library was seen.
    has_library: bool,
    /// Whether something was told to move and not to stop since.
    is_moving: bool,
}

/// A line that has begun.
#[derive(Default)]
struct Open {
    bytes: Vec<u8>,
    since: Duration,
    last_at: Duration,
}

impl Open {
    /// Takes a byte; the line that it ends.
    fn take(&mut self, byte: u8, now: Duration) -> Option<(Duration, Vec<u8>)> {
        if self.bytes.is_empty() {
            self.since = now;
        }
        self.last_at = now;
        self.bytes.push(byte);
        (byte == LINE_END).then(|| (self.since, std::mem::take(&mut self.bytes)))
    }

    /// What has come of a line that goes no further.
    fn cut(&mut self, direction: Direction) -> Option<Record> {
        let bytes = std::mem::take(&mut self.bytes);
        // A line feed behind the words of the command line is the start of nothing.
        let is_line = !bytes.is_empty() && bytes != b"\n";
        is_line.then(|| Record::new(self.since, direction, bytes, "no line: its end is missing".to_owned()))
    }
}

impl Decoder {
    fn sent(&mut self, since: Duration, line: Vec<u8>) -> Record {
        if let Some(Order::Data(frame)) = Order::of_line(&line[..line.len() - 1])
            && let Some((order, number)) = HostOrder::parse(&frame)
        {
            self.is_moving = (self.is_moving || order.may_move()) && order != HostOrder::Stop;
            if self.has_library {
                self.awaited = Some((order, number, since));
            }
        }
        let words = describe_sent(&line).text;
        Record::new(since, Direction::ToController, line, words)
    }

    fn heard(&mut self, since: Duration, line: Vec<u8>) -> Record {
        let text = line.strip_suffix(&[LINE_END]).unwrap_or(&line);
        if let Some(answer) = HostAnswer::parse(text.strip_prefix(b"\n").unwrap_or(text)) {
            self.has_library = true;
            let is_due = |(order, number, _): &(HostOrder, u8, Duration)| {
                (order.letter(), *number) == (answer.order, answer.number)
            };
            self.awaited.take_if(|awaited| is_due(awaited));
        }
        let words = describe_received(&line).text;
        Record::new(since, Direction::FromController, line, words)
    }

    fn give_up(&mut self) -> Option<Record> {
        let (order, number, _) = self.awaited.take()?;
        let text = format!("no answer to order {number}: {order}");
        Some(Record::new(self.from_board.last_at, Direction::FromController, Vec::new(), text))
    }
}

impl Follower for Decoder {
    fn client_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        let lines: Vec<_> = bytes.iter().filter_map(|byte| self.to_board.take(*byte, now)).collect();
        lines.into_iter().map(|(since, line)| self.sent(since, line)).collect()
    }

    fn controller_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        let lines: Vec<_> = bytes.iter().filter_map(|byte| self.from_board.take(*byte, now)).collect();
        lines.into_iter().map(|(since, line)| self.heard(since, line)).collect()
    }

    fn awaits_reply(&self) -> bool {
        self.awaited.is_some()
    }

    fn may_become_whole(&self) -> bool {
        !self.to_board.bytes.is_empty()
    }

    fn silence(&mut self, now: Duration) -> Vec<Record> {
        let mut records = Vec::new();
        if now.saturating_sub(self.from_board.last_at) > REPLY_GAP {
            records.extend(self.from_board.cut(Direction::FromController));
        }
        if self.awaited.is_some_and(|(_, _, since)| now.saturating_sub(since) > REPLY_LIMIT) {
            records.extend(self.give_up());
        }
        records
    }

    /// A line has no limit of time.
    fn client_silence(&mut self, _now: Duration) -> Vec<Record> {
        Vec::new()
    }

    fn client_left(&mut self, _now: Duration) -> Vec<Record> {
        let cut = self.to_board.cut(Direction::ToController);
        cut.into_iter().chain(self.from_board.cut(Direction::FromController)).chain(self.give_up()).collect()
    }

    fn stops(&self) -> Vec<Stop> {
        if !self.is_moving {
            return Vec::new();
        }
        let who = "the motors and steppers of the board".to_owned();
        vec![Stop { who, writes: vec![stop_bytes()], acknowledge: b"073082088" }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    fn texts(records: Vec<Record>) -> Vec<String> {
        records.into_iter().map(|record| record.text).collect()
    }

    #[test]
    fn a_conversation_with_the_library_is_told_in_words() {
        let mut decoder = Decoder::default();
        assert_eq!(texts(decoder.controller_sent(b"073082066000002", ms(0))), Vec::<String>::new());
        assert_eq!(texts(decoder.controller_sent(b"000000000000\r", ms(9))), ["host library, version 2"]);
        assert_eq!(
            texts(decoder.client_sent(b"I077004001070060\r", ms(20))),
            ["order 4: motor 1 forward 60 %"]
        );
        assert!(decoder.awaits_reply());
        assert_eq!(decoder.stops()[0].writes, [b"073\rI088000\r".to_vec()]);
        assert_eq!(
            texts(decoder.controller_sent(b"073082077004060000000000000\r", ms(60))),
            ["answer 4 to M: motors 60, 0, 0, 0 %"]
        );
        assert!(!decoder.awaits_reply());
        assert_eq!(
            texts(decoder.client_sent(b"I088006\r", ms(80))),
            ["order 6: stop all motors and steppers"]
        );
        assert!(decoder.stops().is_empty());
        assert_eq!(texts(decoder.silence(ms(1200))), ["no answer to order 6: stop all motors and steppers"]);
    }

    #[test]
    fn frames_of_other_programs_and_words_are_told_as_they_are() {
        let mut decoder = Decoder::default();
        assert_eq!(texts(decoder.client_sent(b"G\r", ms(0))), ["start the program"]);
        assert_eq!(
            texts(decoder.controller_sent(b"073084088032021082088032001\r", ms(5))),
            ["frame 84 88 32 21 82 88 32 1"]
        );
        assert_eq!(
            texts(decoder.client_sent(b"I001002003\rH\rI0", ms(10))),
            ["data for the program: 1 2 3 0 0 0 0 0", "version and help"]
        );
        assert!(!decoder.awaits_reply() && decoder.may_become_whole());
        let heard = decoder.controller_sent(b"MotorVator AWOS 2.32\r\n0730", ms(30));
        assert_eq!(texts(heard), ["MotorVator AWOS 2.32"]);
        assert_eq!(texts(decoder.silence(ms(300))), ["no line: its end is missing"]);
        assert_eq!(texts(decoder.client_left(ms(400))), ["no line: its end is missing"]);
    }
}
