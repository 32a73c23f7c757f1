//! The step that only reads: which commands the firmware answers and how widely, how quickly, and what it says of itself.

use super::{Asked, address, hear, if_answered, listed, with_crc};
use brushwork_family::examine::{CommandFound, Examination};
use brushwork_link::capability::{CapabilityMap, Presence};
use brushwork_link::device::{Heard, Inquiry, JobContext, Leave};
use brushwork_mcp_client::{layout_of, leave_for, sweep_of};
use brushwork_mcp_wire::models::{self, Family};
use brushwork_mcp_wire::packet_serial::name::{BUFFER_M1, BUFFER_M2, TICK};
use brushwork_mcp_wire::packet_serial::{
    COMMANDS, Command, Form, Generation, ReplyProgress, Request, commands, number, parse_reply,
};
use serde_json::json;
use std::time::Duration;

/// How often a silent command is asked once more before it counts as lacking; each time takes the usual tries.
const ROUNDS: usize = 3;
/// For how long exchanges are counted, and the tick of the unit.
const COUNT_FOR: Duration = Duration::from_secs(1);
/// Rates at which a unit may count its time, 1/s, and how far a measured one may be from one of them.
const TICK_RATES: [f64; 6] = [1_000.0, 625.0, 300.0, 100.0, 10.0, 1.0];
const TICK_TOLERANCE: f64 = 0.05;

/// Asks.
pub fn ask(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    commands_and_widths(context, found)?;
    appended_crc(context, found)?;
    idle_buffer(context, found)?;
    tick(context, found)?;
    rates(context, found)
}

/// What can be read without agreement. 182 takes a message away from whoever waits for it.
pub fn is_read(command: &Command) -> bool {
    leave_for(command) == Some(Leave::Read) && command.number != number::GET_CAN_PACKET
}

fn commands_and_widths(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let asked: Vec<&Command> = COMMANDS.iter().filter(|command| is_read(command)).collect();
    let mut heard = Vec::new();
    for (done, command) in asked.iter().enumerate() {
        context.report_progress(done, asked.len(), command.title);
        heard.push((*command, ask_for(context, command)?));
    }
    let map = context.answers();
    found.commands =
        heard.into_iter().map(|(command, heard)| found_of(context, command, &heard, &map)).collect();
    let generation = layout_of(context.generation());
    told_by(found, generation);
    let family = models::identify(&found.unit.version_text).map(|model| model.family);
    what_it_has(found, generation, family);
    Ok(())
}

/// The bytes of a read; arguments are 0.
fn request_of(context: &JobContext<'_>, command: &Command) -> Vec<u8> {
    let arguments = command.forms.first().map_or(0, Form::payload_width);
    let mut bytes = vec![address(context).get(), command.number];
    bytes.resize(bytes.len() + arguments, 0);
    bytes
}

fn ask_for(context: &mut JobContext<'_>, command: &Command) -> Asked<Heard> {
    let bytes = request_of(context, command);
    let mut heard = Heard::default();
    for _ in 0..ROUNDS {
        heard = context.inquire(&Inquiry { bytes: &bytes, leave: Leave::Read, retries: 2 })?;
        let is_known = context.answers().absent().any(|absent| absent == command.number);
        if heard.took.is_some() || is_known {
            break;
        }
    }
    Ok(heard)
}

fn found_of(context: &JobContext<'_>, command: &Command, heard: &Heard, map: &CapabilityMap) -> CommandFound {
    let learned = map.entries().find(|(number, ..)| *number == command.number);
    let presence = match learned {
        Some((_, presence @ (Presence::Slow | Presence::Absent), _)) => presence,
        _ if heard.took.is_some() => Presence::Present,
        _ if heard.bytes.is_empty() => Presence::Absent,
        _ => Presence::Refused,
    };
    let whole = heard.took.map(|_| heard.bytes.as_slice());
    let arguments = vec![0; command.forms.first().map_or(0, |form| form.request.len())];
    let request = Request::new(address(context), command.number, &arguments);
    let fits = |generation: &Generation| {
        let used = whole.map(|bytes| parse_reply(&request, *generation, bytes));
        matches!(used, Some(ReplyProgress::Done { used, .. }) if used == heard.bytes.len())
    };
    CommandFound {
        command: command.number,
        title: command.title.to_owned(),
        presence,
        reply_bytes: whole.map(<[u8]>::len),
        generations: Generation::ALL.into_iter().filter(fits).map(Generation::number).collect(),
        quickest_ms: heard.took.map(|took| took.as_secs_f64() * 1e3),
    }
}

/// By which replies the generation is told, and which speak against it.
fn told_by(found: &mut Examination, generation: Generation) {
    let own = generation.number();
    let mut told = Vec::new();
    let mut against = Vec::new();
    for reply in &found.commands {
        // What every generation that has the command answers alike tells nothing.
        let row = COMMANDS.iter().find(|row| row.number == reply.command);
        let have =
            row.map_or(0, |row| Generation::ALL.iter().filter(|one| row.form(**one).is_some()).count());
        let (Some(bytes), true) = (reply.reply_bytes, have == Generation::ALL.len()) else { continue };
        if reply.generations.len() == have {
            continue;
        }
        told.push(format!(
            "{} came in {bytes} bytes, as of {}",
            reply.command,
            generations(&reply.generations)
        ));
        if !reply.generations.contains(&own) {
            against.push(reply.command);
        }
    }
    let but = match against.as_slice() {
        [] => String::new(),
        some => format!(" Otherwise than in that generation are: {}.", listed(some)),
    };
    let told = if told.is_empty() { "no reply tells it".to_owned() } else { told.join("; ") };
    let sentence = format!("Generation {own} for the version \"{}\": {told}.{but}", found.unit.version_text);
    found.answered("generation", json!({ "generation": own, "otherwise": against }), sentence);
}

fn generations(numbers: &[u8]) -> String {
    match numbers {
        [] => "no known generation".to_owned(),
        [one] => format!("generation {one}"),
        several => format!("generations {}", listed(several)),
    }
}

/// What the firmware has of what its generation and product line should have, and beyond that.
fn what_it_has(found: &mut Examination, generation: Generation, family: Option<Family>) {
    let (mut lacks, mut has_too) = (Vec::new(), Vec::new());
    for reply in &found.commands {
        let row = COMMANDS.iter().find(|row| row.number == reply.command);
        let is_expected = row.is_some_and(|row| {
            row.form(generation).is_some() && family.is_none_or(|family| row.is_known_to(family))
        });
        match (is_expected, reply.presence) {
            (true, Presence::Absent | Presence::Refused) => lacks.push(reply.command),
            (false, Presence::Present | Presence::Slow) => has_too.push(reply.command),
            (true, Presence::Present | Presence::Slow) | (false, Presence::Absent | Presence::Refused) => {}
        }
    }
    let sentence = format!(
        "Of {} reads that were asked, those that its generation has and it lacks: {}; those that it answers beyond that: {}.",
        found.commands.len(),
        listed(&lacks),
        listed(&has_too)
    );
    found.answered("commands", json!({ "lacks": lacks, "has_too": has_too }), sentence);
}

/// Whether a read with a CRC behind it is answered like one without, and once.
fn appended_crc(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let plain = vec![address(context).get(), number::READ_VERSION];
    let usual = hear(context, &plain, Leave::Read)?;
    let appended = hear(context, &with_crc(plain.clone()), Leave::Read)?;
    let after = hear(context, &plain, Leave::Read)?;
    let is_taken = appended.bytes == usual.bytes && after.bytes == usual.bytes && usual.took.is_some();
    let sentence = match (is_taken, appended.bytes.is_empty()) {
        (true, _) => "Yes: it is answered as without one, and what follows is not disturbed.",
        (false, true) => "No: it is not answered.",
        (false, false) => "Not cleanly: the answer, or that to the next read, is another one.",
    };
    found.answered("appended_crc", json!(is_taken), sentence);
    Ok(())
}

/// What the buffers say while nothing moves.
fn idle_buffer(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let reply = if_answered(context.transact(number::READ_BUFFERS, &[]))?;
    let Some(values) = reply.and_then(|values| commands::READ_BUFFERS.reply(values)) else {
        found.unclear("idle_buffer", "The command is not answered.");
        return Ok(());
    };
    let lengths = [values.int(BUFFER_M1), values.int(BUFFER_M2)];
    let sentence = format!("It reads {} for motor 1 and {} for motor 2.", lengths[0], lengths[1]);
    found.answered("idle_buffer", json!(lengths), sentence);
    Ok(())
}

/// How quickly the unit counts its running time.
fn tick(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let is_there = |reply: &CommandFound| matches!(reply.presence, Presence::Present | Presence::Slow);
    if !found.command(number::READ_ALL_STATUS).is_some_and(is_there) {
        found.unclear("tick", "Its firmware does not have command 73.");
        return Ok(());
    }
    let look = |context: &mut JobContext<'_>| -> Asked<Option<(i64, Duration)>> {
        let reply = if_answered(context.transact_timed(number::READ_ALL_STATUS, &[]))?;
        Ok(reply.and_then(|reply| {
            let tick = commands::READ_ALL_STATUS.reply(reply.values)?.int(TICK);
            Some((tick, (reply.span.requested_at + reply.span.replied_at) / 2))
        }))
    };
    let first = look(context)?;
    context.sleep(COUNT_FOR)?;
    let (Some(first), Some(second)) = (first, look(context)?) else {
        found.unclear("tick", "Command 73 was not answered when it was asked again.");
        return Ok(());
    };
    // The register has 32 bits.
    let ticks = (second.0 - first.0).rem_euclid(1 << 32) as f64;
    let rate = ticks / second.1.saturating_sub(first.1).as_secs_f64().max(1e-3);
    match TICK_RATES.into_iter().find(|known| (rate / known - 1.0).abs() < TICK_TOLERANCE) {
        Some(known) => {
            found.answered("tick", json!(known), format!("It counts {known:.0} ticks in a second."));
        }
        None => {
            found.unclear("tick", format!("It counts {rate:.1} ticks in a second, which is no known rate."));
        }
    }
    found.measured("tick", json!({ "ticks_per_s": rate }));
    Ok(())
}

/// How much the line carries.
fn rates(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let is_answered = |number| {
        let reply = found.command(number);
        reply.is_some_and(|reply| matches!(reply.presence, Presence::Present | Presence::Slow))
    };
    let sweep: Vec<u8> = sweep_of(is_answered).into_iter().filter(|number| knows(context, *number)).collect();
    found.line.requests_per_s = rate_of(context, &[number::READ_VERSION])?;
    found.line.sweeps_per_s = rate_of(context, &sweep)?;
    found.line.lateness = context.lateness();
    Ok(())
}

fn knows(context: &JobContext<'_>, number: u8) -> bool {
    let generation = layout_of(context.generation());
    COMMANDS.iter().any(|row| row.number == number && row.form(generation).is_some())
}

/// How often in a second these can be read one after the other; `None` if one of them is not answered.
fn rate_of(context: &mut JobContext<'_>, numbers: &[u8]) -> Asked<Option<f64>> {
    if numbers.is_empty() {
        return Ok(None);
    }
    let from = context.now();
    let mut rounds = 0_u32;
    while context.now() < from + COUNT_FOR {
        for number in numbers {
            if if_answered(context.transact(*number, &[]))?.is_none() {
                return Ok(None);
            }
        }
        rounds += 1;
    }
    Ok(Some(f64::from(rounds) / context.now().saturating_sub(from).as_secs_f64()))
}
