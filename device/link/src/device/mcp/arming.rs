//! Whether motion may be allowed: only when the controller itself stops the motors after this program has died.
//!
//! Assumed: that a stream's time-out stops the motors when no lower priority level is active. The manual says only that the
//! next level takes over (MCP manual 1.9.3, commands 139 and 145); this is our reading of "none takes over".

use super::Speaker;
use crate::device::controller::{ArmCheck, Line};
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::transport::Stream;
use brushwork_protocol::packet_serial::status::{self, Condition, Severity};
use brushwork_protocol::packet_serial::{Generation, Values, number, scale};
use std::time::Duration;

/// The stream type "packet serial" and the priority "serial" on the wire (MCP manual 2.3.1, commands 139 and 145).
const PACKET_SERIAL: i64 = 1;
const PRIORITY_SERIAL: i64 = 1;

/// Reads everything arming depends on, and lists all that speaks against it.
pub fn check(
    speaker: Speaker,
    line: &mut Line<'_>,
    stream: Option<Stream>,
    on: &str,
) -> Result<ArmCheck, ExchangeError> {
    let mut reasons = Vec::new();
    let mut refuse = |came_back: String, mend: String| {
        reasons.push(Failure::new("arm the motors", on, came_back, mend));
    };
    let controller_timeout = match watchdog(speaker, line, stream)? {
        Watchdog::After(timeout) => Some(timeout),
        Watchdog::Off(stream) => {
            refuse(
                format!("the time-out of {stream} is 0, so the motors would run on if this program died"),
                format!("Set the priority time-out of {stream} in General Settings, to 1000 ms for example"),
            );
            None
        }
        Watchdog::UnknownStream(stream) => {
            refuse(
                format!(
                    "nobody said which connector of the controller this port is, and {stream} has no time-out"
                ),
                "Choose the connector, or give it with the port: \",stream=usb\"".to_owned(),
            );
            None
        }
        Watchdog::OtherUse(stream) => {
            refuse(
                format!("{stream} is not set to packet serial, so this port cannot be {stream}"),
                "Choose the connector that this port is really wired to".to_owned(),
            );
            None
        }
        Watchdog::Unreadable => {
            refuse(
                "the controller does not tell its serial time-out, so nobody knows whether the motors would \
                 stop if this program died"
                    .to_owned(),
                "Drive this controller with another program that you can watch".to_owned(),
            );
            None
        }
    };
    if let Some(priorities) = speaker.ask_if_known(line, number::READ_PRIORITIES, &[])?
        && !priorities.values.ints().any(|level| level == PRIORITY_SERIAL)
    {
        refuse(
            "Serial is in none of the three priority levels, so the controller does not take its motion from this \
             port"
                .to_owned(),
            "Set priority level 1 to Serial in General Settings".to_owned(),
        );
    }
    for fault in faults(speaker, line)? {
        refuse(
            format!("the controller reports {fault}"),
            "Remove the cause and reset the error first".to_owned(),
        );
    }
    Ok(ArmCheck { reasons, controller_timeout })
}

/// What the controller does when this port falls silent.
enum Watchdog {
    /// It stops after this long.
    After(Duration),
    /// The port's stream has no time-out.
    Off(Stream),
    /// It is not known which stream the port is, and this one has no time-out.
    UnknownStream(Stream),
    /// The stream named is not one that speaks packet serial.
    OtherUse(Stream),
    /// The controller does not tell.
    Unreadable,
}

fn watchdog(
    speaker: Speaker,
    line: &mut Line<'_>,
    stream: Option<Stream>,
) -> Result<Watchdog, ExchangeError> {
    if let Some(reply) = speaker.ask_if_known(line, number::READ_STREAMS, &[])? {
        return Ok(of_streams(&reply.values, stream));
    }
    // RoboClaw has one time-out for all ports. No source says which generation brought it, so generation 1 is asked too.
    let asker = Speaker { generation: speaker.generation.max(Generation::Gen2), ..speaker };
    let Some(reply) = asker.ask_if_known(line, number::READ_SERIAL_TIMEOUT, &[])? else {
        return Ok(Watchdog::Unreadable);
    };
    Ok(match reply.values.int("timeout") {
        0 => Watchdog::Off(stream.unwrap_or(Stream::Usb)),
        raw => Watchdog::After(Duration::from_secs_f64(raw as f64 * scale::DECISECOND_S)),
    })
}

/// Judges the streams of an MCP. A stream that is not known passes when every one that it could be has a time-out; the
/// longest counts.
fn of_streams(streams: &Values, stream: Option<Stream>) -> Watchdog {
    let records = streams.records().zip(Stream::ALL);
    let all: Vec<_> = records
        .map(|(record, stream)| (stream, record.int("type") == PACKET_SERIAL, record.int("timeout")))
        .collect();
    let possible = all.iter().filter(|(candidate, packet, _)| match stream {
        Some(stream) => *candidate == stream,
        None => *packet,
    });
    let mut longest = None;
    for (candidate, packet, timeout_ms) in possible {
        if !packet {
            return Watchdog::OtherUse(*candidate);
        }
        if *timeout_ms <= 0 {
            return if stream.is_some() {
                Watchdog::Off(*candidate)
            } else {
                Watchdog::UnknownStream(*candidate)
            };
        }
        longest = longest.max(Some(*timeout_ms));
    }
    let longest = longest.and_then(|timeout_ms| u64::try_from(timeout_ms).ok());
    longest.map_or(Watchdog::Unreadable, |timeout_ms| Watchdog::After(Duration::from_millis(timeout_ms)))
}

/// What the controller has stopped motors for.
fn faults(speaker: Speaker, line: &mut Line<'_>) -> Result<Vec<&'static str>, ExchangeError> {
    let Some(reply) = speaker.ask_if_known(line, number::READ_STATUS, &[])? else {
        return Ok(Vec::new());
    };
    let word = u32::try_from(reply.values.int("status")).unwrap_or(0);
    let conditions = status::decode(word, speaker.generation);
    let faults = conditions.iter().filter(|condition| condition.severity() == Severity::Error);
    Ok(faults.map(Condition::title).collect())
}
