//! Link use: the time that the bytes of status sweeps must take on the wire over the time that they took.

use std::time::{Duration, Instant};

use brushwork_link::device::Event;
use brushwork_mcp_sim::controller::turnaround;
use brushwork_mcp_wire::packet_serial::Generation;

use super::{SERVED, far};
use crate::bench::Effort;
use crate::bench::figure::{Figure, Target};
use crate::bench::rig::Rig;
use crate::bench::spread::{median, range};
use crate::bench::tap::Noted;
use brushwork_cli::interrupt::Interrupt;

/// Bits a byte takes on the wire: start, eight data bits, stop.
const BITS_PER_BYTE: f64 = 10.0;
/// Polling before the first round.
const WARM_UP: Duration = Duration::from_millis(500);
/// What link use must reach where the wire is the slow part.
const REQUIRED: f64 = 0.9;

/// One row for each rate and generation.
pub fn measure(effort: Effort, interrupt: &Interrupt) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for rate_bps in [115_200, 1_000_000] {
        for generation in [Generation::Gen1, Generation::Gen4] {
            figures.push(measure_at(generation, rate_bps, effort, interrupt)?);
        }
    }
    Ok(figures)
}

fn measure_at(
    generation: Generation,
    rate_bps: u32,
    effort: Effort,
    interrupt: &Interrupt,
) -> Result<Figure, String> {
    let rig = Rig::start(far("mcp266", generation, rate_bps)?)?;
    let device = rig.connect(interrupt)?;
    let mut sweeps = 0;
    let mut poll_for = |time: Duration| {
        let end = Instant::now() + time;
        sweeps = 0;
        while Instant::now() < end {
            let left = end.saturating_duration_since(Instant::now());
            if let Ok(Event::Sample(_)) = device.events().recv_timeout(left) {
                sweeps += 1;
            }
        }
        if interrupt.is_raised() { Err("interrupted".to_owned()) } else { Ok(sweeps) }
    };
    poll_for(WARM_UP)?;
    let mut rounds = Vec::new();
    for _ in 0..effort.rounds {
        rig.log.clear();
        let sweeps = poll_for(effort.round)?;
        let log = rig.log.all();
        let figures = LinkUse::of(&log, rig.rate_bps(), turnaround(SERVED, rate_bps))
            .ok_or_else(|| "the controller was not polled".to_owned())?;
        rounds.push((figures, f64::from(sweeps) / effort.round.as_secs_f64()));
    }
    Ok(figure(generation, &rig, &rounds))
}

fn figure(generation: Generation, rig: &Rig, rounds: &[(LinkUse, f64)]) -> Figure {
    let of = |value: fn(&(LinkUse, f64)) -> f64| rounds.iter().map(value).collect::<Vec<_>>();
    let uses = of(|(link, _)| link.part());
    let note = format!(
        "{}; {:.0} sweeps/s, {:.0} transactions/s of {:.1} bytes, {:.0} us each beyond the wire (half of them under {:.0} us), {}",
        range(&uses, 3),
        median(&of(|(_, sweeps)| *sweeps)),
        median(&of(|(link, _)| link.transactions as f64 / link.took.as_secs_f64())),
        median(&of(|(link, _)| link.bytes as f64 / link.transactions as f64)),
        median(&of(|(link, _)| link.beyond_the_wire_us())),
        median(&of(|(link, _)| link.typically_beyond_us)),
        rig.line(),
    );
    let name = format!("use at {} bit/s, {generation}", rig.rate_bps());
    let figure = Figure::new("link", name, median(&uses), "", 3).cannot_exceed(1.0).note(note);
    if rig.rate_bps() <= 115_200 { figure.target(Target::AtLeast(REQUIRED)) } else { figure }
}

/// What went over a wire in some time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LinkUse {
    transactions: usize,
    bytes: usize,
    wire_time: Duration,
    took: Duration,
    /// The median of what single transactions took beyond the wire: what there would be without the rare long pauses
    /// of a machine that has other things to do.
    typically_beyond_us: f64,
}

impl LinkUse {
    /// From the first write to the last one, which only marks the end: whole transactions, and the pauses between them.
    /// None for less than one.
    fn of(log: &[Noted], rate_bps: u32, turnaround: Duration) -> Option<Self> {
        let (last, whole) = log.split_last()?;
        let first = whole.first()?;
        let bytes = whole.iter().map(|noted| noted.request.len() + noted.reply_bytes).sum();
        let total = wire_time(bytes, whole.len(), rate_bps, turnaround);
        let took = last.begun_at.duration_since(first.begun_at);
        let beyond_us = log.windows(2).map(|pair| {
            let least = wire_time(pair[0].request.len() + pair[0].reply_bytes, 1, rate_bps, turnaround);
            (pair[1].begun_at.duration_since(pair[0].begun_at).as_secs_f64() - least.as_secs_f64()) * 1e6
        });
        let typically_beyond_us = median(&beyond_us.collect::<Vec<_>>());
        Some(Self { transactions: whole.len(), bytes, wire_time: total, took, typically_beyond_us })
    }

    /// 1 is a wire that never waits.
    fn part(&self) -> f64 {
        self.wire_time.as_secs_f64() / self.took.as_secs_f64()
    }

    fn beyond_the_wire_us(&self) -> f64 {
        (self.took.as_secs_f64() - self.wire_time.as_secs_f64()) * 1e6 / self.transactions as f64
    }
}

/// The least time that transactions can take: their bytes at the rate, and the controller's turnaround for each.
fn wire_time(bytes: usize, transactions: usize, rate_bps: u32, turnaround: Duration) -> Duration {
    let bits = bytes as f64 * BITS_PER_BYTE;
    Duration::from_secs_f64(bits / f64::from(rate_bps) + turnaround.as_secs_f64() * transactions as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noted(start: Instant, at_ms: u64, request: usize, reply: usize) -> Noted {
        let at = start + Duration::from_millis(at_ms);
        let request = vec![0; request];
        Noted { begun_at: at, written_at: at, request, reply_bytes: reply, replied_at: None }
    }

    #[test]
    fn wire_time_is_ten_bits_a_byte_and_a_turnaround_for_each_transaction() {
        // 1152 bytes of 10 bits at 115200 bit/s are 100 ms; 20 turnarounds of 50 us are 1 ms.
        let time = wire_time(1_152, 20, 115_200, Duration::from_micros(50));
        assert!(time.abs_diff(Duration::from_millis(101)) < Duration::from_nanos(10), "{time:?}");
        assert_eq!(wire_time(0, 0, 9_600, Duration::from_secs(1)), Duration::ZERO);
    }

    #[test]
    fn the_last_write_marks_the_end_and_its_bytes_do_not_count() {
        let start = Instant::now();
        let log = [noted(start, 0, 2, 8), noted(start, 10, 2, 8), noted(start, 20, 2, 800)];
        let link = LinkUse::of(&log, 10_000, Duration::ZERO).unwrap();
        // 20 bytes at a millisecond each in 20 ms.
        assert_eq!((link.transactions, link.bytes), (2, 20));
        assert!((link.part() - 1.0).abs() < 1e-9, "{link:?}");
        assert!(link.beyond_the_wire_us().abs() < 1e-6);
    }

    #[test]
    fn a_rare_long_pause_counts_but_is_not_typical() {
        let start = Instant::now();
        let log = [0, 12, 24, 136].map(|at_ms| noted(start, at_ms, 2, 8));
        let link = LinkUse::of(&log, 10_000, Duration::ZERO).unwrap();
        // Three transactions of 10 ms in 136 ms, of which two took 2 ms more and one 102 ms more.
        assert!((link.part() - 30.0 / 136.0).abs() < 1e-9, "{link:?}");
        assert!((link.typically_beyond_us - 2_000.0).abs() < 1e-3, "{link:?}");
    }

    #[test]
    fn fewer_than_two_writes_measure_nothing() {
        let start = Instant::now();
        assert_eq!(LinkUse::of(&[], 9_600, Duration::ZERO), None);
        assert_eq!(LinkUse::of(&[noted(start, 0, 2, 8)], 9_600, Duration::ZERO), None);
    }
}
