//! The loops of an MCP or RoboClaw over the device thread.

use crate::encoder;
use brushwork_family::messages::LoopActMessage;
use brushwork_family::tuned::{Registers, Restored, Target, Tuned, failed, reported, thrice};
use brushwork_link::device::JobContext;
use brushwork_link::settings::SettingValue;
use brushwork_link::{Failure, Stream};
use brushwork_mcp_axis::{Carrier, McpHeld, McpLaw, McpWrite, PacketAxis, Timed};
use brushwork_mcp_client::packet::typed_reply;
use brushwork_mcp_client::{MCP, layout_of, packet_address};
use brushwork_mcp_wire::packet_serial::{Generation, Given, Request, Typed, number};
use brushwork_tuning::axis::{AxisError, EncoderClass, Exchange};
use brushwork_tuning::experiment_guard::wait_for_rest;
use brushwork_tuning::setup::{LoopAxis, Setup};
use brushwork_values::{Motor, Value};
use std::time::Duration;

/// An exchange that took so much longer than the quickest had a retry in it, or waited for this computer, so that its middle says
/// nothing.
const LATE: Duration = Duration::from_millis(35);

/// The wire of a job as the tuner's carrier.
struct JobCarrier<'a, 'b> {
    context: &'a mut JobContext<'b>,
    stream: Option<Stream>,
    /// The quickest exchange so far.
    quickest: Option<Duration>,
}

impl JobCarrier<'_, '_> {
    /// Whether the middle of an exchange is no time at which anything was read.
    fn is_vague(&mut self, exchange: &Exchange) -> bool {
        let took = exchange.received.saturating_sub(exchange.sent);
        let quickest = self.quickest.map_or(took, |quickest| quickest.min(took));
        self.quickest = Some(quickest);
        took > quickest + LATE
    }
}

/// Whether a command reads what is of use only with the time of its reading.
fn needs_its_time(command: u8) -> bool {
    matches!(
        command,
        number::READ_ENCODERS | number::READ_ENCODER_M1 | number::READ_ENCODER_M2 | number::READ_PWMS
    )
}

impl Carrier for JobCarrier<'_, '_> {
    fn transact<const L: u8>(&mut self, command: Typed<L>, given: &[Given<L>]) -> Timed<L> {
        let address = packet_address(self.context.address()).unwrap_or_default();
        let packet = Request::typed(address, command, self.generation(), given)
            .map_err(|error| AxisError::Refused(error.to_string()))?;
        let values: Vec<i64> = packet.values.iter().filter_map(Value::as_int).collect();
        let reply = self
            .context
            .transact_timed(command.number(), &values)
            .and_then(|reply| typed_reply(reply, command));
        let reply = reply.map_err(|error| reported(&error))?;
        let exchange = Exchange { sent: reply.span.requested_at, received: reply.span.replied_at };
        let is_vague = self.is_vague(&exchange);
        if is_vague && needs_its_time(command.number()) {
            Err(AxisError::Late)
        } else {
            Ok((exchange, reply.values))
        }
    }

    fn now(&mut self) -> Duration {
        self.context.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        let left = time.saturating_sub(self.context.now());
        self.context.sleep(left).map_err(|error| reported(&error))
    }

    fn generation(&self) -> Generation {
        layout_of(self.context.generation())
    }

    fn stream(&self) -> Option<usize> {
        self.stream.and_then(|stream| Stream::ALL.iter().position(|other| *other == stream))
    }

    fn is_simulated(&self) -> bool {
        self.context.is_simulated()
    }

    fn stolen(&mut self) -> Duration {
        self.context.take_stolen()
    }

    fn progress(&mut self, text: &str) {
        self.context.progress(None, text);
    }
}

/// The loops of an MCP or RoboClaw.
#[derive(Clone, Copy, Debug)]
pub struct McpTuned;

impl Tuned for McpTuned {
    type Law = McpLaw;

    fn is_at(context: &JobContext<'_>) -> bool {
        context.address().family() == MCP
    }

    fn axis<'a>(
        context: &'a mut JobContext<'_>,
        target: Target,
        own_timeout: bool,
    ) -> Box<dyn LoopAxis<McpLaw> + 'a> {
        let stream = target.stream.filter(|_| own_timeout);
        let carrier = JobCarrier { context, stream, quickest: None };
        Box::new(PacketAxis::new(carrier, target.motor, target.encoder.unwrap_or_default()))
    }

    fn is_tried(motor: Motor, key: &str) -> bool {
        let of_motor = key.strip_prefix(&format!("motor{}.", motor.index() + 1));
        of_motor.is_some_and(|key| key.starts_with("velocity.") || key.starts_with("position."))
            || key.starts_with("stream.") && key.ends_with(".timeout")
    }

    fn tells_encoder(key: &str) -> bool {
        encoder::is_asked(key)
    }

    fn encoder(settings: &dyn Fn(&str) -> Option<SettingValue>, motor: Motor) -> Option<EncoderClass> {
        encoder::class(settings, motor)
    }

    fn restore(
        context: &mut JobContext<'_>,
        target: Target,
        before: &Setup<McpLaw>,
        kept: &Registers<McpLaw>,
        _leaves_off: bool,
    ) -> Result<Restored, Failure> {
        let place = context.describe();
        let loops = McpHeld {
            velocity: kept.velocity.unwrap_or(before.held.velocity),
            position: kept.position.unwrap_or(before.held.position),
        };
        let mut axis = Self::axis(context, target, true);
        let now =
            thrice(|| axis.read_setup()).map_err(|error| failed(LoopActMessage::ReadBack, &place, &error))?;
        put_loops_back(&mut *axis, &now.held, &loops)
            .map_err(|error| failed(LoopActMessage::WriteBack, &place, &error))?;
        if (now.max_current_raw, now.min_current_raw) != (before.max_current_raw, before.min_current_raw) {
            thrice(|| axis.write_current_limits(before.max_current_raw, before.min_current_raw))
                .map_err(|error| failed(LoopActMessage::PutCurrentLimitBack, &place, &error))?;
        }
        if now.inductance_resistance_raw != before.inductance_resistance_raw {
            wait_for_rest(&mut *axis);
            thrice(|| axis.write_winding(before.inductance_resistance_raw))
                .map_err(|error| failed(LoopActMessage::PutWindingBack, &place, &error))?;
        }
        if let Some(timeout_ms) = before.stream_timeout_ms {
            thrice(|| axis.set_stream_timeout(timeout_ms))
                .map_err(|error| failed(LoopActMessage::SetTimeoutBack, &place, &error))?;
        }
        let held =
            thrice(|| axis.read_setup()).map_err(|error| failed(LoopActMessage::ReadBack, &place, &error))?;
        if held.held != loops
            || held.max_current_raw != before.max_current_raw
            || held.inductance_resistance_raw != before.inductance_resistance_raw
            || (before.stream_timeout_ms.is_some() && held.stream_timeout_ms != before.stream_timeout_ms)
        {
            let error = AxisError::Refused("settings that read otherwise than they were written".into());
            return Err(failed(LoopActMessage::PutBack, &place, &error));
        }
        Ok(Restored::default())
    }
}

/// Writes the loops that are not as they were; a controller may not take what need not be written.
fn put_loops_back(axis: &mut dyn LoopAxis<McpLaw>, now: &McpHeld, wanted: &McpHeld) -> Result<(), AxisError> {
    if now.velocity != wanted.velocity {
        thrice(|| axis.write(McpWrite::Velocity(wanted.velocity)))?;
    }
    if now.position != wanted.position {
        thrice(|| axis.write(McpWrite::PositionLoop(wanted.position)))?;
    }
    Ok(())
}
