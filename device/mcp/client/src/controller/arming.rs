//! Whether motion may be allowed: only when the controller itself stops the motors after this program has died.
//!
//! Assumed: that a stream's time-out stops the motors when no lower priority level is active. The manual says only that the
//! next level takes over (MCP manual 1.9.3, commands 139 and 145); this is our reading of "none takes over".

use crate::can::{MASTER_LIMIT, Place};
use crate::controller::speaker::{Speaker, Wire};
use crate::messages::{McpActMessage, McpCauseMessage, McpDriverMessage, McpRemedyMessage};
use brushwork_canopen::bus::Monitor;
use brushwork_link::Message;
use brushwork_link::device::controller::{ArmCheck, Line};
use brushwork_link::exchange::{Exchange, ExchangeError};
use brushwork_link::failure::Failure;
use brushwork_link::transport::Stream;
use brushwork_mcp_wire::packet_serial::name::{CONFIG, STATUS, TIMEOUT, TYPE};
use brushwork_mcp_wire::packet_serial::status;
use brushwork_mcp_wire::packet_serial::status::Condition;
use brushwork_mcp_wire::packet_serial::{Generation, Read, commands, scale};
use brushwork_mcp_wire::roboclaw::{ConfigWord, ControlMode};
use brushwork_values::{Motor, Severity};
use std::time::Duration;

/// The stream type "packet serial" and the priority "serial" on the wire (MCP manual 2.3.1, commands 139 and 145).
const PACKET_SERIAL: i64 = 1;
const PRIORITY_SERIAL: i64 = 1;

/// Why motors may not be moved, and what to do about it.
struct Objection {
    came_back: McpCauseMessage,
    remedy: McpRemedyMessage,
}

/// Reads everything arming depends on, and lists all that speaks against it.
pub fn check(
    speaker: Speaker,
    monitor: Option<&Monitor>,
    line: &mut Line<'_>,
    stream: Option<Stream>,
    on: &str,
) -> Result<ArmCheck, ExchangeError> {
    let mut objections = Vec::new();
    let watchdog = match (speaker.wire, monitor) {
        (Wire::Objects(place), Some(monitor)) => node_watchdog(place, monitor, line)?,
        _ => {
            // Over CAN, functions act at all priority levels (MCP manual 1.9.4).
            objections.extend(object_to_priorities(speaker, line)?);
            watchdog(speaker, line, stream)?
        }
    };
    let controller_timeout = watchdog.map_err(|objection| objections.insert(0, objection)).ok();
    objections.extend(controller_timeout.and_then(|timeout| object_to_lateness(line.exchange(), timeout)));
    let faults = faults(speaker, line)?;
    let tells_status = faults.is_some();
    objections.extend(
        faults
            .into_iter()
            .flatten()
            .map(|fault| object(McpCauseMessage::Reports { fault }, McpRemedyMessage::ResetFirst)),
    );
    let mut warnings = if objections.is_empty() { coasting(speaker, line)? } else { Vec::new() };
    if !tells_status {
        warnings.push(McpDriverMessage::StatusUnseen.into());
    }
    let failure =
        |objection: Objection| Failure::new(McpActMessage::Arm, on, objection.came_back, objection.remedy);
    Ok(ArmCheck { reasons: objections.into_iter().map(failure).collect(), controller_timeout, warnings })
}

/// The same for a node of a CAN bus, where the manual has no time-out ("Priority Timeout - Disabled", MCP manual 1.9.4). CANopen has one: a node
/// may watch a master's heartbeat. Whether a real controller does so, and whether it stops its motors then, nobody has said, so
/// only a simulated one is armed.
fn node_watchdog(
    place: Place,
    monitor: &Monitor,
    line: &mut Line<'_>,
) -> Result<Result<Duration, Objection>, ExchangeError> {
    if !line.permit().guesses {
        return Ok(Err(object(McpCauseMessage::NoTimeoutOverCan, McpRemedyMessage::NotOverCan)));
    }
    match place.watch_master(line) {
        Ok(()) => {
            monitor.beat(true);
            Ok(Ok(MASTER_LIMIT))
        }
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        Err(_) => Ok(Err(object(McpCauseMessage::HeartbeatUnwatched, McpRemedyMessage::DriveOverSerial))),
    }
}

/// After how much silence on this port the controller stops the motors.
fn watchdog(
    speaker: Speaker,
    line: &mut Line<'_>,
    stream: Option<Stream>,
) -> Result<Result<Duration, Objection>, ExchangeError> {
    let streams = speaker.ask_if_known(line, commands::READ_STREAMS)?;
    if let Some(reply) = streams.filter(|reply| reply.values.records().next().is_some()) {
        return Ok(of_streams(&reply.values, stream));
    }
    // RoboClaw has one time-out for all ports. No source says which generation brought it, so generation 1 is asked too.
    let asker = Speaker { generation: speaker.generation.max(Generation::Gen2), ..speaker };
    let Some(reply) = asker.ask_if_known(line, commands::READ_SERIAL_TIMEOUT)? else {
        return Ok(Err(unreadable()));
    };
    if let Some(objection) = object_to_control_mode(asker, line)? {
        return Ok(Err(objection));
    }
    Ok(match reply.values.int(TIMEOUT) {
        0 => Err(object(McpCauseMessage::NoSerialTimeout, McpRemedyMessage::SetSerialTimeout)),
        raw => Ok(Duration::from_secs_f64(raw as f64 * scale::DECISECOND_S)),
    })
}

/// In R/C and analog mode S1 and S2 command the motors of a RoboClaw, and commands of packet serial move nothing (RoboClaw manual
/// 2018, "USB Control").
fn object_to_control_mode(speaker: Speaker, line: &mut Line<'_>) -> Result<Option<Objection>, ExchangeError> {
    let Some(reply) = speaker.ask_if_known(line, commands::READ_CONFIG)? else {
        return Ok(None);
    };
    let word = ConfigWord(u16::try_from(reply.values.int(CONFIG)).unwrap_or(0));
    let signal = match word.mode() {
        ControlMode::Rc => "R/C",
        ControlMode::Analog => "analog",
        ControlMode::SimpleSerial | ControlMode::PacketSerial => return Ok(None),
    };
    Ok(Some(object(McpCauseMessage::InputsInCharge { signal }, McpRemedyMessage::ChoosePacketSerial)))
}

/// Judges the streams of an MCP. A stream that is not known passes when every one that it could be has a time-out; the
/// longest counts.
fn of_streams<const L: u8>(streams: &Read<L>, stream: Option<Stream>) -> Result<Duration, Objection> {
    let possible = streams.records().zip(Stream::ALL).filter(|(record, candidate)| match stream {
        Some(stream) => *candidate == stream,
        None => record.int(TYPE) == PACKET_SERIAL,
    });
    let mut longest = None;
    for (record, candidate) in possible {
        if record.int(TYPE) != PACKET_SERIAL {
            return Err(object(
                McpCauseMessage::NotPacketSerial { stream: candidate },
                McpRemedyMessage::ChooseWired,
            ));
        }
        let timeout_ms = u64::try_from(record.int(TIMEOUT)).unwrap_or(0);
        if timeout_ms == 0 {
            return Err(no_timeout(candidate, stream.is_some()));
        }
        longest = longest.max(Some(Duration::from_millis(timeout_ms)));
    }
    longest.ok_or_else(unreadable)
}

/// On a line that is late the time-out must outlast a reply that is lost.
fn object_to_lateness(exchange: &Exchange, timeout: Duration) -> Option<Objection> {
    let latest = exchange.longest_turnaround();
    exchange.needed_timeout().filter(|needed| timeout < *needed).map(|needed| {
        // To the next 100 ms, in which RoboClaws count.
        let enough_ms = needed.as_millis().next_multiple_of(100);
        object(
            McpCauseMessage::LineIsLate { latest_ms: latest.as_millis(), timeout_ms: timeout.as_millis() },
            McpRemedyMessage::LengthenTimeout { enough_ms },
        )
    })
}

fn no_timeout(candidate: Stream, is_known: bool) -> Objection {
    if is_known {
        object(
            McpCauseMessage::NoTimeout { stream: candidate },
            McpRemedyMessage::SetTimeout { stream: candidate },
        )
    } else {
        object(McpCauseMessage::UnknownPort { stream: candidate }, McpRemedyMessage::ChooseConnector)
    }
}

fn unreadable() -> Objection {
    object(McpCauseMessage::TimeoutUntold, McpRemedyMessage::DriveOtherwise)
}

/// Serial must be in one of the priority levels. A unit without such levels has nothing to object to.
fn object_to_priorities(speaker: Speaker, line: &mut Line<'_>) -> Result<Option<Objection>, ExchangeError> {
    let Some(priorities) = speaker.ask_if_known(line, commands::READ_PRIORITIES)? else {
        return Ok(None);
    };
    let has_serial = priorities.values.ints().any(|level| level == PRIORITY_SERIAL);
    Ok((!has_serial).then(|| object(McpCauseMessage::SerialNowhere, McpRemedyMessage::SetPriority)))
}

fn object(came_back: McpCauseMessage, remedy: McpRemedyMessage) -> Objection {
    Objection { came_back, remedy }
}

/// Motors in torque control, which inductance and resistance switch on (MCP manual 1.2.11). Assumed: duty 0 is then a current of
/// 0, so that Stop lets them coast.
fn coasting(speaker: Speaker, line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError> {
    let mut warnings = Vec::new();
    let reads = [commands::READ_INDUCTANCE_RESISTANCE_M1, commands::READ_INDUCTANCE_RESISTANCE_M2];
    for (motor, command) in Motor::BOTH.into_iter().zip(reads) {
        let reply = speaker.ask_if_known(line, command)?;
        if reply.is_some_and(|reply| reply.values.ints().all(|value| value != 0)) {
            warnings.push(McpDriverMessage::Coasts { motor }.into());
        }
    }
    Ok(warnings)
}

/// What the controller has stopped motors for; `None` where it does not tell its status.
fn faults(speaker: Speaker, line: &mut Line<'_>) -> Result<Option<Vec<&'static str>>, ExchangeError> {
    let Some(reply) = speaker.ask_if_known(line, commands::READ_STATUS)? else {
        return Ok(None);
    };
    let word = u32::try_from(reply.values.int(STATUS)).unwrap_or(0);
    let conditions = status::decode(word, speaker.generation);
    let faults = conditions.iter().filter(|condition| condition.severity() == Severity::Error);
    Ok(Some(faults.map(Condition::title).collect()))
}
