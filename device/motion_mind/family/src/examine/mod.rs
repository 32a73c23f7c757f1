//! What is to be found out of a Motion Mind: its questions, how each is asked, and how its answer reads.

pub mod table;

use brushwork_family::examine::{
    CommandFound, Examination, Examiner, NotAskable, Step, if_answered, not_asked,
};
use brushwork_family::messages::ExamineActMessage;
use brushwork_link::capability::Presence;
use brushwork_link::device::{Heard, Inquiry, JobContext, Leave};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::{Failure, FamilyRef};
use brushwork_motion_mind_client::{MOTION_MIND, MotionMindFacts};
use brushwork_motion_mind_wire::{
    Address, Command, Protocol, Register, encode_frame, encode_line, numbers, register, register_number,
};
use brushwork_values::Motor;
use serde_json::json;
use std::time::Duration;

/// Registers of the manual.
const REGISTERS: u8 = 32;
/// Reads of which the quickest tells the turnaround.
const TURNS: u32 = 20;
/// For how long TIME counts, and by how much its step may be off: both clocks are quartz or ceramic, and two replies may be late.
const COUNT_FOR: Duration = Duration::from_secs(2);
const TICK_MS: f64 = 5.0;
const TICK_TOLERANCE: f64 = 0.05;

/// What examines a Motion Mind.
#[derive(Clone, Copy, Debug)]
pub struct MotionMindExaminer;

impl Examiner for MotionMindExaminer {
    fn family(&self) -> FamilyRef {
        MOTION_MIND
    }

    fn steps(&self) -> &'static [Step] {
        table::STEPS
    }

    fn not_askable(&self) -> Vec<NotAskable> {
        not_asked(table::ASSUMED)
    }

    fn ask(
        &self,
        step: &Step,
        _motor: Motor,
        context: &mut JobContext<'_>,
        found: &mut Examination,
    ) -> Result<(), Failure> {
        let asked = match step.key {
            table::REGISTERS => registers(context, found),
            table::WRITING => read_only(context, found),
            _ => store_time(context, found),
        };
        asked.map_err(|error| {
            error.failure(ExamineActMessage::TakeStep { title: step.title.to_owned() }, context.describe())
        })
    }
}

type Asked<T = ()> = Result<T, ExchangeError>;

fn registers(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let facts = facts(context);
    let protocol = match facts.protocol {
        Protocol::Binary => "binary",
        Protocol::Text => "ascii",
    };
    let mode = facts.mode.number();
    let sentence = format!("Mode {mode}, and it speaks the {protocol} protocol.");
    found.answered("switches", json!({ "mode": mode, "protocol": protocol }), sentence);
    each_alone(context, found)?;
    turnaround(context, found)?;
    back_to_back(context, found)?;
    other_lines(context, found)?;
    tick(context, found)?;
    found.line.lateness = context.lateness();
    Ok(())
}

fn facts(context: &JobContext<'_>) -> MotionMindFacts {
    let known = context.facts().get::<MotionMindFacts>().copied();
    known.unwrap_or(MotionMindFacts {
        mode: brushwork_motion_mind_wire::Mode::FactoryTest,
        protocol: Protocol::Binary,
    })
}

/// Reads each register alone, and tells which are lacking.
fn each_alone(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let rows: Vec<&Register> = (0..REGISTERS).filter_map(register).collect();
    let mut lacking = Vec::new();
    for (done, row) in rows.iter().enumerate() {
        context.report_progress(done, rows.len(), row.name);
        let reply = if_answered(context.transact_timed(numbers::READ_REGISTER, &[i64::from(row.number)]))?;
        let took = reply.map(|reply| reply.span.replied_at.saturating_sub(reply.span.requested_at));
        if took.is_none() {
            lacking.push(row.number);
        }
        found.commands.push(CommandFound {
            command: row.number,
            title: format!("register {}", row.name),
            presence: if took.is_some() { Presence::Present } else { Presence::Absent },
            reply_bytes: took.map(|_| row.kind.bytes()),
            generations: Vec::new(),
            quickest_ms: took.map(|took| took.as_secs_f64() * 1e3),
        });
    }
    let names: Vec<&str> = lacking.iter().filter_map(|number| Some(register(*number)?.name)).collect();
    let sentence =
        if names.is_empty() { "It answers all 32.".to_owned() } else { format!("{}.", names.join(", ")) };
    found.answered("lacking", json!(lacking), sentence);
    Ok(())
}

fn turnaround(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let mut quickest: Option<Duration> = None;
    for _ in 0..TURNS {
        let revision = [i64::from(register_number::REVISION)];
        if let Some(reply) = if_answered(context.transact_timed(numbers::READ_REGISTER, &revision))? {
            let took = reply.span.replied_at.saturating_sub(reply.span.requested_at);
            quickest = Some(quickest.map_or(took, |known| known.min(took)));
        }
    }
    match quickest.map(|took| took.as_secs_f64() * 1e3) {
        Some(ms) => {
            found.answered("turnaround", json!((ms * 100.0).round() / 100.0), format!("After {ms:.2} ms."));
        }
        None => found.unclear("turnaround", "REVISION was not answered."),
    }
    Ok(())
}

/// Two reads in one write.
fn back_to_back(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let Some(one) = question(context, &read(context, register_number::REVISION)) else { return Ok(()) };
    let alone = hear(context, &one, Leave::Read)?;
    let both = hear(context, &[one.clone(), one].concat(), Leave::Read)?;
    match (alone.took, both.bytes.len()) {
        (None, _) => found.unclear("back_to_back", "REVISION was not answered."),
        (Some(_), length) if length == 2 * alone.bytes.len() => {
            found.answered("back_to_back", json!(true), "Yes: both are answered.");
        }
        (Some(_), 0) => found.answered("back_to_back", json!(false), "No: neither is answered."),
        (Some(_), length) => {
            let sentence = format!("{length} bytes came, and one answer has {}.", alone.bytes.len());
            found.unclear("back_to_back", sentence);
        }
    }
    Ok(())
}

/// Lines that the manual does not promise to take.
fn other_lines(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let keys = ["small_letters", "line_feed"];
    let usual = question(context, &read(context, register_number::REVISION));
    let (Some(usual), Protocol::Text) = (usual, facts(context).protocol) else {
        keys.iter().for_each(|key| found.unclear(key, "It speaks the binary protocol."));
        return Ok(());
    };
    let mut without_return = usual.clone();
    without_return.retain(|byte| *byte != b'\r');
    for (key, bytes) in keys.into_iter().zip([usual.to_ascii_lowercase(), without_return]) {
        let is_taken = hear(context, &bytes, Leave::Read)?.took.is_some();
        found.answered(key, json!(is_taken), if is_taken { "Yes." } else { "No." });
        // What is left of a line that was not ended must not spoil the next.
        hear(context, &usual, Leave::Read)?;
    }
    Ok(())
}

fn tick(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let look = |context: &mut JobContext<'_>| -> Asked<Option<(i64, Duration)>> {
        let number = [i64::from(register_number::TIME)];
        let reply = if_answered(context.transact_timed(numbers::READ_REGISTER, &number))?;
        Ok(reply.and_then(|reply| {
            let count = reply.values.try_int("TIME")?;
            Some((count, (reply.span.requested_at + reply.span.replied_at) / 2))
        }))
    };
    let first = look(context)?;
    context.sleep(COUNT_FOR)?;
    let (Some(first), Some(second)) = (first, look(context)?) else {
        found.unclear("tick", "TIME was not answered.");
        return Ok(());
    };
    let counted = (second.0 - first.0).rem_euclid(1 << 32) as f64;
    let step_ms = second.1.saturating_sub(first.1).as_secs_f64() * 1e3 / counted.max(1.0);
    let is_usual = (step_ms / TICK_MS - 1.0).abs() < TICK_TOLERANCE;
    let sentence =
        if is_usual { "Yes.".to_owned() } else { format!("No: a step of it takes {step_ms:.2} ms.") };
    found.answered("tick", json!(is_usual), sentence);
    found.measured("tick", json!({ "step_ms": step_ms }));
    Ok(())
}

/// A write that should do nothing.
fn read_only(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let look = |context: &mut JobContext<'_>| -> Asked<Option<i64>> {
        let number = [i64::from(register_number::INDEXPOS)];
        let values = if_answered(context.transact(numbers::READ_REGISTER, &number))?;
        Ok(values.and_then(|values| values.try_int("INDEXPOS")))
    };
    let write = |context: &mut JobContext<'_>, value: i64| -> Asked<Option<Heard>> {
        let command = Command::Write { register: register_number::INDEXPOS, value };
        let Some(bytes) = question(context, &command) else { return Ok(None) };
        hear(context, &bytes, Leave::Write).map(Some)
    };
    let Some(before) = look(context)? else {
        found.unclear("read_only", "INDEXPOS was not answered.");
        return Ok(());
    };
    let other = if before == i64::from(i32::MAX) { before - 1 } else { before + 1 };
    let Some(heard) = write(context, other)? else {
        found.unclear("read_only", "The write has no form on the wire.");
        return Ok(());
    };
    let after = look(context)?;
    if after == Some(other) {
        write(context, before)?;
    }
    let is_taken = heard.took.is_some();
    let acknowledged = if is_taken { "It is acknowledged" } else { "It is not acknowledged" };
    let does = match after {
        Some(after) if after == before => "does nothing",
        Some(_) => "changes the register, which was put back",
        None => "the register was not answered afterwards",
    };
    let value = json!({ "acknowledged": is_taken, "changes": after.is_some_and(|after| after != before) });
    found.answered("read_only", value, format!("{acknowledged}, and {does}."));
    Ok(())
}

/// The same number once more into EEPROM.
fn store_time(context: &mut JobContext<'_>, found: &mut Examination) -> Asked {
    let number = i64::from(register_number::TIMER);
    let values = if_answered(context.transact(numbers::READ_REGISTER, &[number]))?;
    let Some(timer) = values.and_then(|values| values.try_int("TIMER")) else {
        found.unclear("store_time", "TIMER was not answered.");
        return Ok(());
    };
    match if_answered(context.transact_timed(numbers::WRITE_STORE, &[number, timer]))? {
        Some(reply) => {
            let took = reply.span.replied_at.saturating_sub(reply.span.requested_at);
            let ms = took.as_secs_f64() * 1e3;
            found.answered("store_time", json!(ms.round()), format!("It was acknowledged after {ms:.0} ms."));
        }
        None => found.unclear("store_time", "It was not acknowledged."),
    }
    Ok(())
}

fn read(context: &JobContext<'_>, number: u8) -> Command {
    match facts(context).protocol {
        Protocol::Binary => Command::ReadRegister(number),
        Protocol::Text => Command::ReadText(brushwork_motion_mind_wire::Part::Register(number)),
    }
}

/// The bytes of a command for the unit.
fn question(context: &JobContext<'_>, command: &Command) -> Option<Vec<u8>> {
    let address = Address::unit(context.address().get())?;
    match facts(context).protocol {
        Protocol::Binary => encode_frame(address, command).ok(),
        Protocol::Text => encode_line(address, command).map(String::into_bytes).ok(),
    }
}

fn hear(context: &mut JobContext<'_>, bytes: &[u8], leave: Leave) -> Asked<Heard> {
    context.inquire(&Inquiry { bytes, leave, retries: 0 })
}
