//! Encoder counts with their moments, as a job reads them.

use brushwork_link::ExchangeError;
use brushwork_link::device::JobContext;
use std::time::Duration;

use super::speed::Reading;

/// Time between two readings of a job. The window's own readings go in between.
pub const INTERVAL: Duration = Duration::from_millis(5);

/// Follows both encoders over the ends of their 32 bits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Encoders {
    last: Option<[i32; 2]>,
    counts: [i64; 2],
}

impl Encoders {
    /// Reads both, dated half way between request and reply.
    pub fn read(&mut self, context: &mut JobContext<'_>) -> Result<[Reading; 2], ExchangeError> {
        let (now, span) = context.address().family().readings().encoders(context)?;
        let at_s = (span.requested_at + span.replied_at).as_secs_f64() / 2.0;
        let half_s = span.replied_at.saturating_sub(span.requested_at).as_secs_f64() / 2.0;
        Ok(self.take(now).map(|counts| Reading { at_s, counts: counts as f64, half_s }))
    }

    fn take(&mut self, now: [i32; 2]) -> [i64; 2] {
        match self.last {
            None => self.counts = now.map(i64::from),
            Some(last) => {
                for index in 0..2 {
                    self.counts[index] += i64::from(now[index].wrapping_sub(last[index]));
                }
            }
        }
        self.last = Some(now);
        self.counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_go_on_over_the_end_of_32_bits() {
        let mut encoders = Encoders::default();
        assert_eq!(encoders.take([i32::MAX - 5, 7]), [i64::from(i32::MAX) - 5, 7]);
        assert_eq!(encoders.take([i32::MIN + 4, -3]), [i64::from(i32::MAX) + 5, -3]);
        assert_eq!(encoders.take([i32::MAX, -3]), [i64::from(i32::MAX), -3]);
    }
}
