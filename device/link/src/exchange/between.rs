//! An acknowledgement that nothing else can be, on a line on which late replies may come.
//!
//! An acknowledgement may be one byte without a checksum (MCP manual 2.2.5), and any byte of a reply that was given up
//! looks like it, or like a refusal. So the request is put between two reads: controllers answer in order, and an acknowledgement between the
//! replies to both reads, which carry checksums over their requests, answers what was between the reads. Nothing that comes is thrown
//! away on the way there, since what is waited for may be behind it.

use super::error::{ExchangeError, Tries};
use super::link::{Exchange, RECOVERY};
use super::watch::Watch;
use std::time::Duration;

/// Pause between two tries, beyond their time on the wire: as often as a stop is repeated that nobody confirms.
const AGAIN: Duration = Duration::from_millis(100);
/// How long an answer is waited for beyond what late replies take: radio links and serial servers are 50 to 400 ms late.
const LIMIT: Duration = Duration::from_millis(450);
/// Late replies are waited for no longer than this.
const LONGEST: Duration = Duration::from_secs(6);
/// A byte at 2400 bit/s, the slowest rate of a RoboClaw, where the rate of the line is not known.
const SLOWEST_BYTE: Duration = Duration::from_micros(4167);
/// Both reads answered and nothing between them: so often, and the unit does not acknowledge the request.
const UNACKNOWLEDGED_TRIES: u32 = 3;
/// Bytes of one try with its answers, at least: two reads, two packets of duties, the shortest replies.
const TRY_BYTES: u32 = 48;

/// A request that is put between reads, and how its answers are told from theirs.
pub struct Bracketed<'a> {
    /// The request. It may be repeated.
    pub request: &'a [u8],
    /// Its acknowledgement.
    pub acknowledgement: u8,
    /// Reads that the unit is known to answer with a checksum, two or more, so that the tries can be told apart.
    pub reads: Vec<Vec<u8>>,
    /// Where the reply to the read of this number ends, if one begins these bytes.
    pub end_of: &'a dyn Fn(usize, &[u8]) -> Option<usize>,
}

/// The reads around a request, as they were written: numbers of the list.
struct Try {
    before: usize,
    after: usize,
}

/// Sends a request until its acknowledgement is certain. It comes first in each try, then once more between two reads, so that a stop is never
/// later than by itself.
///
/// # Errors
/// No acknowledgement in time, or whatever breaks in.
pub fn transact_between(
    exchange: &mut Exchange,
    watch: &dyn Watch,
    ask: &Bracketed<'_>,
) -> Result<(), ExchangeError> {
    let request = ask.request;
    let reads = reads_to_be_told_apart(exchange, ask);
    let begun_at = exchange.clock().now();
    let byte_time = exchange.byte_time().unwrap_or(SLOWEST_BYTE);
    let late = byte_time * u32::try_from(exchange.given_up.reply_bytes()).unwrap_or(u32::MAX);
    let until = begun_at + (LIMIT + late).min(LONGEST);
    let pause = AGAIN + exchange.byte_time().unwrap_or_default() * TRY_BYTES;
    exchange.received.clear();
    exchange.unsettled = true;
    // A unit that has lost the thread finds it after a silence.
    while exchange.clock().now() < begun_at + RECOVERY {
        exchange.hear(watch, begun_at + RECOVERY)?;
    }

    let mut tries: Vec<Try> = Vec::new();
    let mut next_try_at = exchange.clock().now();
    let mut acknowledged_until = None;
    let mut unacknowledged = 0;
    loop {
        let now = exchange.clock().now();
        match acknowledged_until {
            // Heard, but what was sent after that may still be answered.
            Some(until) if now >= until => {
                give_up(exchange, ask, &tries);
                return Ok(());
            }
            None if now >= until || unacknowledged >= UNACKNOWLEDGED_TRIES => {
                give_up(exchange, ask, &tries);
                exchange.counters.totals.timeouts += 1;
                let (waited, heard) = (now.saturating_sub(begun_at), exchange.received.len());
                let tries = Tries(u32::try_from(tries.len()).unwrap_or(u32::MAX));
                return Err(ExchangeError::TimedOut { waited, tries, heard });
            }
            None if now >= next_try_at => {
                let pair = pair(&reads, tries.len());
                let bytes = [request, &ask.reads[pair.before], request, &ask.reads[pair.after]].concat();
                exchange.write_now(&bytes)?;
                tries.push(pair);
                next_try_at = now + pause;
            }
            Some(_) | None => {}
        }
        exchange.hear(watch, acknowledged_until.unwrap_or(next_try_at.min(until)))?;
        let Some((index, is_acknowledged)) = newest_answer(&tries, ask, &exchange.received) else { continue };
        exchange.received.clear();
        let now = exchange.clock().now();
        match is_acknowledged {
            false => unacknowledged += 1,
            true if index + 1 == tries.len() => {
                exchange.given_up.forget();
                exchange.unsettled = false;
                exchange.last_reply_at = now;
                return Ok(());
            }
            // The later tries are answered as late as this one was.
            true => {
                acknowledged_until =
                    acknowledged_until.or(Some(now + now.saturating_sub(begun_at).max(AGAIN)));
            }
        }
    }
}

/// The reads whose replies cannot be late ones; all of them where there is no such read.
fn reads_to_be_told_apart(exchange: &Exchange, ask: &Bracketed<'_>) -> Vec<usize> {
    let fresh: Vec<_> =
        (0..ask.reads.len()).filter(|read| !exchange.given_up.holds(&ask.reads[*read])).collect();
    if fresh.is_empty() { (0..ask.reads.len()).collect() } else { fresh }
}

/// The reads around the try of this number: no two tries in a row, and as many as there are reads squared, have the same ones.
fn pair(reads: &[usize], index: usize) -> Try {
    let read = |index: usize| reads[index % reads.len().max(1)];
    Try { before: read(index), after: read(index + index / reads.len().max(1)) }
}

/// The latest try of which both reads were answered, and whether an acknowledgement stands between the two replies.
fn newest_answer(tries: &[Try], ask: &Bracketed<'_>, bytes: &[u8]) -> Option<(usize, bool)> {
    tries.iter().enumerate().rev().find_map(|(index, pair)| {
        let end_of = |read: usize, start: usize| Some(start + (ask.end_of)(read, bytes.get(start..)?)?);
        (0..bytes.len()).find_map(|start| {
            let middle = end_of(pair.before, start)?;
            let acknowledged = (bytes.get(middle) == Some(&ask.acknowledgement))
                .then(|| end_of(pair.after, middle + 1))
                .flatten();
            if acknowledged.is_some() {
                return Some((index, true));
            }
            end_of(pair.after, middle).map(|_| (index, false))
        })
    })
}

/// Nobody waits for what these tries may still bring.
fn give_up(exchange: &mut Exchange, ask: &Bracketed<'_>, tries: &[Try]) {
    let now = exchange.clock().now();
    for pair in tries {
        exchange.given_up.note(&ask.reads[pair.before], 0, now, true);
        exchange.given_up.note(ask.request, 0, now, true);
        exchange.given_up.note(&ask.reads[pair.after], 0, now, true);
    }
}
