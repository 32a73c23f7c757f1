//! Questions to a firmware in bytes, for an examination: which may go out, and when their answer is whole.
//!
//! Nothing that can move a motor, changes what is kept, or is of no known command goes out here, whoever agreed to it.

use super::speaker::{Speaker, Wire};
use crate::messages::McpCauseMessage;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{Heard, Inquiry, Leave};
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing, Reply};
use brushwork_link::messages::CauseMessage;
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{ClientUse, Command, Direction, Effect, Form, lookup, number};
use brushwork_values::Values;
use std::time::Duration;

/// Bytes of the shortest answer to a read: one of data and its CRC.
const SHORTEST: usize = 3;

/// Bytes of a CRC.
const CRC: usize = 2;
/// What a packet may have beside its payload: the command, its CRC, and a byte too many.
const LONGER: usize = 1 + CRC + 1;
/// Motor 1 forward at power 0: the oldest stop, of which it is asked whether it is acknowledged.
const STANDSTILL: [u8; 2] = [number::FORWARD_M1, 0];

/// What has to be agreed to before a command is asked in bytes; `None` where it never is. What it means in another generation counts too, since
/// which one this is may be what is to be found out.
pub fn leave_for(command: &Command) -> Option<Leave> {
    let is_all = |effect: Effect| command.forms.iter().all(|form| form.effect == effect);
    let is_guess = command.forms.iter().any(|form| form.assumed.is_some())
        || matches!(command.client, ClientUse::Never(_));
    match command.forms {
        [] => None,
        _ if is_all(Effect::Query) => Some(if is_guess { Leave::Guess } else { Leave::Read }),
        _ if is_all(Effect::Setting) && !is_guess => Some(Leave::Write),
        _ => None,
    }
}

/// Asks it.
pub fn inquire(speaker: Speaker, line: &mut Line<'_>, inquiry: &Inquiry<'_>) -> Result<Heard, ExchangeError> {
    let bytes = inquiry.bytes;
    let command = check(speaker, inquiry)?;
    let mut heard = Vec::new();
    let outgoing = Outgoing {
        bytes,
        reply_length: SHORTEST,
        patience: Duration::ZERO,
        retries: inquiry.retries,
        once: false,
    };
    let is_read = command.forms.iter().any(|form| form.direction == Direction::Read);
    let retries_before = line.exchange().retries();
    let (exchange, watch) = line.parts();
    let span = exchange.exchange(&outgoing, watch, &mut |reply| {
        heard = reply.to_vec();
        if is_read && is_whole(bytes, reply) { Judgement::Good(reply.len()) } else { Judgement::More(1) }
    });
    // Other commands are not asked for by anybody, so that nobody has to know whether this firmware has them.
    let form = command.form(speaker.generation);
    if let ([_, number], true) = (bytes, form.is_some_and(|form| form.request.is_empty())) {
        let reply = span.clone().map(|span| Reply { values: Values::default(), span });
        speaker.learn(line, *number, &reply, retries_before)?;
    }
    match span {
        Ok(span) => Ok(Heard { bytes: heard, took: Some(span.replied_at.saturating_sub(span.requested_at)) }),
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        Err(_) => Ok(Heard { bytes: heard, took: None }),
    }
}

fn check(speaker: Speaker, inquiry: &Inquiry<'_>) -> Result<&'static Command, ExchangeError> {
    let impossible = |what: McpCauseMessage| Err(ExchangeError::impossible(what));
    if matches!(speaker.wire, Wire::Objects(_)) {
        return impossible(McpCauseMessage::NodeTakesNoPackets);
    }
    let own = speaker.address.get();
    // A doubled address is one of the questions.
    let after = inquiry.bytes.strip_prefix(&[own, own]).or(inquiry.bytes.strip_prefix(&[own]));
    let asked = after.and_then(|after| Some((lookup(*after.first()?)?, after)));
    let Some((command, after)) = asked else {
        return impossible(McpCauseMessage::NoCommand);
    };
    let widest = command.forms.iter().map(Form::payload_width).max().unwrap_or(0);
    if after.len() > LONGER + widest {
        return impossible(McpCauseMessage::OnePacket);
    }
    let is_standstill = after.len() == STANDSTILL.len() + CRC && after.starts_with(&STANDSTILL);
    let needed = if is_standstill { Some(Leave::Write) } else { leave_for(command) };
    match needed {
        Some(needed) if needed <= inquiry.leave => Ok(command),
        Some(_) => Err(ExchangeError::impossible(CauseMessage::NotAgreedTo)),
        None => impossible(McpCauseMessage::DoesTooMuch),
    }
}

/// Whether the bytes end with a CRC over request and data: with all that was sent, without a CRC that was appended to the request, or with the data
/// alone.
fn is_whole(request: &[u8], reply: &[u8]) -> bool {
    let Some((data, crc)) = reply.split_last_chunk::<2>().filter(|(data, _)| !data.is_empty()) else {
        return false;
    };
    let appended = request.len().saturating_sub(2).max(2).min(request.len());
    let fits = |before: &[u8]| crc16_xmodem(&[before, data].concat()) == u16::from_be_bytes(*crc);
    fits(request) || fits(&request[..appended]) || fits(&[])
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::packet_serial::COMMANDS;

    #[test]
    fn nothing_that_moves_saves_resets_or_restarts_is_ever_asked_in_bytes() {
        for command in COMMANDS {
            let is_harmless = |effect| matches!(effect, Effect::Query | Effect::Setting);
            let leave = leave_for(command);
            if leave.is_some() {
                assert!(command.forms.iter().all(|form| is_harmless(form.effect)), "{}", command.key);
            }
            if leave < Some(Leave::Write) && leave.is_some() {
                assert!(command.forms.iter().all(|form| form.effect == Effect::Query), "{}", command.key);
            }
        }
        // In generation 1 these two run the motor, whatever they read later.
        for moving in
            [100, 101, number::SAVE_SETTINGS, number::RESTORE_DEFAULTS, number::ERASE_SCRIPT, 0, 52, 255]
        {
            assert_eq!(lookup(moving).and_then(leave_for), None, "{moving}");
        }
        let leave = |number| lookup(number).and_then(leave_for);
        assert_eq!(leave(number::READ_STATUS), Some(Leave::Read));
        assert_eq!(leave(number::READ_CAN_ERRORS), Some(Leave::Guess));
        assert_eq!(leave(number::SET_VELOCITY_PID_M1), Some(Leave::Write));
    }

    #[test]
    fn an_answer_is_whole_with_any_of_the_three_ways_to_count_its_crc() {
        let request = [0x80, 191, 1, 0x10, 0, 0, 0xAB, 0xCD];
        let data = [1, 2, 3];
        for before in [&request[..], &request[..6], &[]] {
            let crc = crc16_xmodem(&[before, &data].concat()).to_be_bytes();
            assert!(is_whole(&request, &[&data[..], &crc].concat()));
        }
        assert!(!is_whole(&request, &data) && !is_whole(&request, &[]) && !is_whole(&request, &[0xFF]));
    }
}
