//! What went over the wire, transaction by transaction, in bounded memory, and what of it the filter lets through.

use std::collections::VecDeque;
use std::fmt::Write as _;
use std::time::Duration;

use brushwork_link::exchange::Traffic;
use brushwork_values::hex;

/// Transactions kept; the oldest go first.
pub const MOST: usize = 20_000;
/// Bytes that their texts and packets may take together.
pub const MOST_BYTES: usize = 8 << 20;

/// The traffic of one link.
#[derive(Debug, Default)]
pub struct Log {
    transactions: VecDeque<Transaction>,
    bytes: usize,
    pub dropped: u64,
    next_number: u64,
    first_at: Option<Duration>,
    pub paused: bool,
    /// Records that went by while it was paused.
    pub missed: u64,
    /// Something was not recorded, so that a request without an answer may have had one.
    interrupted: bool,
    filter: Filter,
    /// Numbers of the transactions that the filter lets through.
    shown: VecDeque<u64>,
}

/// A request and what came after it.
#[derive(Clone, Debug, PartialEq)]
pub struct Transaction {
    /// Counts up over the whole log.
    pub number: u64,
    /// Time since the first one.
    pub at: Duration,
    /// From the request to the last byte of the answer.
    pub duration: Option<Duration>,
    pub sent: Vec<u8>,
    pub received: Vec<u8>,
    pub request: String,
    pub reply: String,
    pub outcome: Outcome,
    sent_at: Duration,
}

/// What became of a transaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The answer may still come.
    Waiting,
    /// It was not recorded whether an answer came.
    NotRecorded,
    Good,
    NoAnswer,
    /// What came is no whole and undamaged answer.
    Damaged,
    /// Bytes came that nobody had asked for.
    Unasked,
}

impl Outcome {
    pub const fn is_failure(self) -> bool {
        matches!(self, Self::NoAnswer | Self::Damaged | Self::Unasked)
    }

    pub const fn word(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::NotRecorded => "not recorded",
            Self::Good => "OK",
            Self::NoAnswer => "no answer",
            Self::Damaged => "damaged",
            Self::Unasked => "unasked",
        }
    }
}

/// What is let through.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// In the words or in the bytes of a transaction, in either case.
    pub text: String,
    pub command: Option<u8>,
    pub only_failures: bool,
}

impl Filter {
    fn passes(&self, transaction: &Transaction) -> bool {
        if self.only_failures && !transaction.outcome.is_failure() {
            return false;
        }
        if self.command.is_some_and(|command| transaction.command() != Some(command)) {
            return false;
        }
        let wanted = self.text.trim().to_lowercase();
        wanted.is_empty() || transaction.to_line().to_lowercase().contains(&wanted)
    }
}

impl Transaction {
    /// The command byte, where there was a request.
    pub fn command(&self) -> Option<u8> {
        self.sent.get(1).copied()
    }

    /// Both directions in words.
    pub fn words(&self) -> String {
        match (self.request.is_empty(), self.reply.is_empty()) {
            (false, false) => format!("{} -> {}", self.request, self.answer()),
            (true, _) => self.reply.clone(),
            (_, true) => format!("{} ({})", self.request, self.outcome.word()),
        }
    }

    /// The answer without the name of the command, which the request has already.
    fn answer(&self) -> &str {
        let repeated =
            self.reply.strip_prefix(self.request.as_str()).and_then(|rest| rest.strip_prefix(": "));
        repeated.unwrap_or(&self.reply)
    }

    /// Both directions as bytes.
    pub fn packets(&self) -> String {
        format!("{} | {}", hex(&self.sent), hex(&self.received))
    }

    /// As one line of a file: seconds, milliseconds, outcome, bytes, words, with tabs between them.
    pub fn to_line(&self) -> String {
        let duration =
            self.duration.map_or(String::new(), |time| format!("{:.2}", time.as_secs_f64() * 1000.0));
        format!(
            "{:.6}\t{duration}\t{}\t{}\t{}",
            self.at.as_secs_f64(),
            self.outcome.word(),
            self.packets(),
            self.words()
        )
    }

    fn weight(&self) -> usize {
        let texts = self.request.capacity() + self.reply.capacity();
        size_of::<Self>() + self.sent.capacity() + self.received.capacity() + texts
    }
}

impl Log {
    /// Takes in what went one way.
    pub fn take(&mut self, traffic: &Traffic, text: &str, sound: bool) {
        if self.paused {
            self.missed += 1;
            self.interrupted = true;
            return;
        }
        if traffic.sent {
            self.close_last();
            self.push_request(traffic, text);
        } else {
            self.take_reply(traffic, text, sound);
        }
        self.interrupted = false;
    }

    pub fn set_paused(&mut self, paused: bool) {
        if paused && !self.paused {
            self.interrupted = true;
            self.close_last();
        }
        self.paused = paused;
    }

    pub fn link_ended(&mut self) {
        self.interrupted = true;
        self.close_last();
    }

    pub fn clear(&mut self) {
        let (filter, paused) = (std::mem::take(&mut self.filter), self.paused);
        *self = Self { filter, paused, interrupted: true, next_number: self.next_number, ..Self::default() };
    }

    pub fn len(&self) -> usize {
        self.transactions.len()
    }

    pub fn is_empty(&self) -> bool {
        self.transactions.is_empty()
    }

    /// Bytes of memory that the log takes, about.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    pub fn filter(&self) -> &Filter {
        &self.filter
    }

    pub fn set_filter(&mut self, filter: Filter) {
        if filter == self.filter {
            return;
        }
        self.filter = filter;
        let passing = self.transactions.iter().filter(|transaction| self.filter.passes(transaction));
        self.shown = passing.map(|transaction| transaction.number).collect();
    }

    /// How many the filter lets through.
    pub fn shown_len(&self) -> usize {
        self.shown.len()
    }

    /// One of those that the filter lets through, the oldest first.
    pub fn shown(&self, index: usize) -> Option<&Transaction> {
        self.get(*self.shown.get(index)?)
    }

    /// The commands that went over the wire.
    pub fn commands(&self) -> std::collections::BTreeSet<u8> {
        self.transactions.iter().filter_map(Transaction::command).collect()
    }

    /// What the filter lets through, as text, with a line that names the columns.
    pub fn to_text(&self) -> String {
        let mut text = "time s\tduration ms\toutcome\tsent | received\tmeaning\n".to_owned();
        for transaction in self.shown.iter().filter_map(|number| self.get(*number)) {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{}", transaction.to_line());
        }
        text
    }

    fn get(&self, number: u64) -> Option<&Transaction> {
        let first = self.transactions.front()?.number;
        self.transactions.get(usize::try_from(number.checked_sub(first)?).ok()?)
    }

    fn push_request(&mut self, traffic: &Traffic, text: &str) {
        self.push(traffic.at, |transaction| {
            transaction.sent.clone_from(&traffic.bytes);
            text.clone_into(&mut transaction.request);
        });
    }

    fn take_reply(&mut self, traffic: &Traffic, text: &str, sound: bool) {
        let outcome = if sound { Outcome::Good } else { Outcome::Damaged };
        let is_open = self.transactions.back().is_some_and(|last| {
            matches!(last.outcome, Outcome::Waiting | Outcome::Good | Outcome::Damaged)
                && !last.sent.is_empty()
        });
        if !is_open || self.interrupted {
            let of_nothing = if self.interrupted { Outcome::NotRecorded } else { Outcome::Unasked };
            self.push(traffic.at, |transaction| {
                transaction.received.clone_from(&traffic.bytes);
                text.clone_into(&mut transaction.reply);
                transaction.outcome = of_nothing;
            });
            return self.look_at_last();
        }
        if let Some(last) = self.transactions.back_mut() {
            self.bytes -= last.weight();
            last.received.extend(&traffic.bytes);
            text.clone_into(&mut last.reply);
            last.duration = Some(traffic.until.saturating_sub(last.sent_at));
            last.outcome = outcome;
            self.bytes += last.weight();
        }
        self.look_at_last();
    }

    /// A request that nothing came back for has none when the next one goes out.
    fn close_last(&mut self) {
        let interrupted = self.interrupted;
        if let Some(last) = self.transactions.back_mut()
            && last.outcome == Outcome::Waiting
        {
            last.outcome = if interrupted { Outcome::NotRecorded } else { Outcome::NoAnswer };
            self.look_at_last();
        }
    }

    fn push(&mut self, sent_at: Duration, fill: impl FnOnce(&mut Transaction)) {
        let first_at = *self.first_at.get_or_insert(sent_at);
        let mut transaction = Transaction {
            number: self.next_number,
            at: sent_at.saturating_sub(first_at),
            duration: None,
            sent: Vec::new(),
            received: Vec::new(),
            request: String::new(),
            reply: String::new(),
            outcome: Outcome::Waiting,
            sent_at,
        };
        fill(&mut transaction);
        self.next_number += 1;
        self.bytes += transaction.weight();
        self.transactions.push_back(transaction);
        self.look_at_last();
        while self.transactions.len() > MOST || self.bytes > MOST_BYTES {
            let Some(oldest) = self.transactions.pop_front() else { break };
            self.bytes -= oldest.weight();
            self.dropped += 1;
            if self.shown.front() == Some(&oldest.number) {
                self.shown.pop_front();
            }
        }
    }

    /// What has become of the last one decides whether the filter lets it through.
    fn look_at_last(&mut self) {
        let Some(last) = self.transactions.back() else { return };
        let is_shown = self.shown.back() == Some(&last.number);
        match (self.filter.passes(last), is_shown) {
            (true, false) => self.shown.push_back(last.number),
            (false, true) => {
                self.shown.pop_back();
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(at_ms: u64, bytes: &[u8]) -> Traffic {
        let at = Duration::from_millis(at_ms);
        Traffic { at, until: at, sent: true, bytes: bytes.to_vec() }
    }

    fn received(at_ms: u64, bytes: &[u8]) -> Traffic {
        Traffic { sent: false, ..sent(at_ms, bytes) }
    }

    fn filled() -> Log {
        let mut log = Log::default();
        log.take(&sent(1000, &[0x80, 24]), "0x80 main battery", true);
        log.take(&received(1002, &[0x00, 0xF3, 0xE8, 0x86]), "24.3 V", true);
        log.take(&sent(1100, &[0x80, 90]), "0x80 status", true);
        log.take(&sent(1200, &[0x80, 24]), "0x80 main battery", true);
        log.take(&received(1203, &[0x00]), "part of a reply: 00", false);
        log
    }

    #[test]
    fn requests_and_answers_are_put_together_with_times_and_outcomes() {
        let log = filled();
        let reported: Vec<_> =
            (0..3).filter_map(|index| log.shown(index)).map(Transaction::to_line).collect();
        assert_eq!(
            reported,
            [
                "0.000000\t2.00\tOK\t80 18 | 00 F3 E8 86\t0x80 main battery -> 24.3 V",
                "0.100000\t\tno answer\t80 5A | \t0x80 status (no answer)",
                "0.200000\t3.00\tdamaged\t80 18 | 00\t0x80 main battery -> part of a reply: 00",
            ]
        );
    }

    #[test]
    fn the_filter_takes_words_bytes_commands_and_failures() {
        let count = |filter: Filter| {
            let mut log = filled();
            log.set_filter(filter);
            log.shown_len()
        };
        let text = |text: &str| count(Filter { text: text.to_owned(), ..Filter::default() });
        assert_eq!((text("MAIN battery"), text("e8 86"), text("nothing")), (2, 1, 0));
        assert_eq!(count(Filter { command: Some(24), ..Filter::default() }), 2);
        assert_eq!(count(Filter { only_failures: true, ..Filter::default() }), 2);
        assert_eq!(count(Filter { command: Some(24), only_failures: true, ..Filter::default() }), 1);
    }

    #[test]
    fn a_transaction_passes_the_filter_as_soon_as_it_fails_and_no_longer_when_it_is_well() {
        let mut log = Log::default();
        log.set_filter(Filter { only_failures: true, ..Filter::default() });
        log.take(&sent(0, &[0x80, 1]), "one", true);
        log.take(&received(1, &[1]), "part", false);
        assert_eq!(log.shown_len(), 1);
        log.take(&received(20, &[2]), "whole", true);
        assert_eq!(log.shown_len(), 0);
        assert_eq!(log.len(), 1);
    }

    #[test]
    fn a_pause_leaves_a_gap_and_blames_nobody_for_it() {
        let mut log = filled();
        log.take(&sent(1300, &[0x80, 90]), "0x80 status", true);
        log.set_paused(true);
        log.take(&received(1301, &[0, 0, 0, 0]), "normal", true);
        log.take(&sent(1400, &[0x80, 90]), "0x80 status", true);
        log.set_paused(false);
        log.take(&received(1401, &[0, 0, 0, 0]), "normal", true);
        log.take(&sent(1500, &[0x80, 24]), "0x80 main battery", true);
        let outcomes: Vec<_> = (3..6).filter_map(|index| log.shown(index)).map(|one| one.outcome).collect();
        assert_eq!(outcomes, [Outcome::NotRecorded, Outcome::NotRecorded, Outcome::Waiting]);
        assert_eq!((log.missed, log.len()), (2, 6));
    }

    #[test]
    fn memory_is_bounded_and_what_had_to_go_is_told() {
        let mut log = Log::default();
        for number in 0..(MOST as u64 + 5_000) {
            log.take(&sent(number * 10, &[0x80, 24]), "0x80 main battery", true);
            log.take(&received(number * 10 + 1, &[0, 243, 0, 0]), "24.3 V", true);
        }
        assert_eq!(log.dropped + log.len() as u64, MOST as u64 + 5_000);
        assert!(log.len() <= MOST && log.bytes() <= MOST_BYTES && log.shown_len() == log.len());
        let heavy = vec![0x55; 1 << 20];
        for number in 0..20 {
            log.take(&sent(number, &heavy), "", true);
        }
        assert!(log.bytes() <= MOST_BYTES);
        log.clear();
        assert!(log.is_empty() && log.bytes() == 0 && log.shown_len() == 0);
    }
}
