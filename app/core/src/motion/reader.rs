//! Readings that a job makes itself: encoder counts with their moments, and what a motor draws.

use brushwork_link::device::JobContext;
use brushwork_link::exchange::ExchangeError;
use brushwork_mcp_client::TypedWire;
use brushwork_mcp_client::packet::typed_reply;
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_values::Motor;
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

/// What a motor gets and draws.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Power {
    /// Output, -1 to 1.
    pub duty: f64,
    /// Current, A.
    pub amps: f64,
    /// Main battery, V.
    pub volts: f64,
}

impl Encoders {
    /// Reads both, dated half way between request and reply.
    pub fn read(&mut self, context: &mut JobContext<'_>) -> Result<[Reading; 2], ExchangeError> {
        let reply = typed_reply(
            context.transact_timed(commands::READ_ENCODERS.number(), &[])?,
            commands::READ_ENCODERS,
        )?;
        let at_s = (reply.span.requested_at + reply.span.replied_at).as_secs_f64() / 2.0;
        // The count is a 32 bit pattern.
        let now = [reply.values.int(ENCODER_M1) as i32, reply.values.int(ENCODER_M2) as i32];
        Ok(self.take(now).map(|counts| Reading { at_s, counts: counts as f64 }))
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

/// Reads what a motor gets and draws, with the battery that feeds it.
pub fn read_power(context: &mut JobContext<'_>, motor: Motor) -> Result<Power, ExchangeError> {
    let duties = context.ask(commands::READ_PWMS, &[])?;
    let currents = context.ask(commands::READ_CURRENTS, &[])?;
    let battery = context.ask(commands::READ_MAIN_BATTERY, &[])?;
    Ok(Power {
        duty: [duties.physical(DUTY_M1), duties.physical(DUTY_M2)][motor.index()] / 100.0,
        amps: [currents.physical(CURRENT_M1), currents.physical(CURRENT_M2)][motor.index()],
        volts: battery.physical(MAIN_BATTERY),
    })
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
