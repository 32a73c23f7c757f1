//! What is read from a unit in a sweep, and which signal each register is.

use crate::controller::channels::{ANALOG_CONTROL, ANALOG_FEEDBACK, INDEX_POSITION, RC_PULSE};
use crate::controller::driving::COUNTS_PER_S_PER_STEP;
use crate::controller::facts::MotionMindFacts;
use crate::controller::indicators;
use crate::controller::registers::{mask, value_in};
use crate::controller::speaker::Speaker;
use brushwork_link::device::StatusReport;
use brushwork_link::device::controller::{Line, PollItem, PollList};
use brushwork_link::device::{Channel, Sample};
use brushwork_link::exchange::{ExchangeError, Span};
use brushwork_motion_mind_wire::{Command, Mode, Protocol, Reply, register, register_number as number};

/// What moves: one read of several registers.
const MOTION: PollItem = PollItem { id: 0, name: "position, velocity, drive, current, status" };
/// The inputs, and what changes slowly.
const INPUTS: PollItem = PollItem { id: 1, name: "inputs and temperature" };
/// In text every register comes with one read.
const EVERYTHING: PollItem = PollItem { id: 2, name: "all registers" };

const MOTION_REGISTERS: [u8; 7] = [
    number::POSITION,
    number::VELOCITY,
    number::TIME,
    number::STATUS,
    number::PWMOUT,
    number::DESIREDPOSITION,
    number::AMPS,
];
const INPUT_REGISTERS: [u8; 5] =
    [number::RCCOUNT, number::ANALOGCON, number::ANALOGFBCK, number::INDEXPOS, number::THERMISTOR];

/// Degrees Celsius of a THERMISTOR (Motion Mind manual 3.18).
fn celsius(raw: i64) -> f64 {
    (raw - 1104) as f64 * -0.165
}

pub fn list(protocol: Protocol) -> PollList {
    let (fast, slow) = match protocol {
        Protocol::Binary => (vec![MOTION], vec![INPUTS]),
        Protocol::Text => (vec![EVERYTHING], Vec::new()),
    };
    PollList { status: fast.first().copied(), fast, slow, signals: None }
}

/// Reads one item.
pub fn read(
    speaker: &mut Speaker,
    facts: Option<MotionMindFacts>,
    line: &mut Line<'_>,
    item: PollItem,
    sample: &mut Sample,
) -> Result<Option<StatusReport>, ExchangeError> {
    let registers = match item {
        MOTION => mask(&MOTION_REGISTERS),
        INPUTS => mask(&INPUT_REGISTERS),
        _ => u32::MAX,
    };
    let (reply, span) = speaker.ask(line, &Command::Read(registers))?;
    if let Some(function) = value_in(&reply, number::FUNCTION) {
        speaker.note_write(number::FUNCTION, function);
    }
    enter(&reply, facts, span, sample);
    Ok(status_of(speaker, facts, &reply, span))
}

/// Enters what the registers of a reply say.
fn enter(reply: &Reply, facts: Option<MotionMindFacts>, span: Span, sample: &mut Sample) {
    let raw = |index: u8| value_in(reply, index);
    let scaled = |index: u8| Some(raw(index)? as f64 * register(index)?.scale);
    let is_closed = facts.is_some_and(|facts| matches!(facts.mode, Mode::SerialPid | Mode::AnalogPid));
    let error = || Some((raw(number::DESIREDPOSITION)? - raw(number::POSITION)?) as f64);
    let readings = [
        (Channel::M1_POSITION, scaled(number::POSITION)),
        (Channel::M1_VELOCITY, raw(number::VELOCITY).map(|steps| steps as f64 * COUNTS_PER_S_PER_STEP)),
        (Channel::M1_PWM, scaled(number::PWMOUT)),
        (Channel::M1_CURRENT, scaled(number::AMPS)),
        (Channel::M1_POSITION_ERROR, if is_closed { error() } else { None }),
        (Channel::TEMPERATURE_1, raw(number::THERMISTOR).map(celsius)),
        (RC_PULSE, scaled(number::RCCOUNT)),
        (ANALOG_CONTROL, scaled(number::ANALOGCON)),
        (ANALOG_FEEDBACK, scaled(number::ANALOGFBCK)),
        (INDEX_POSITION, scaled(number::INDEXPOS)),
    ];
    for (channel, value) in readings {
        if let Some(value) = value {
            sample.set(channel, value, span.requested_at, span.replied_at);
        }
    }
}

fn status_of(
    speaker: &Speaker,
    facts: Option<MotionMindFacts>,
    reply: &Reply,
    span: Span,
) -> Option<StatusReport> {
    let word = u32::try_from(value_in(reply, number::STATUS)?).ok()?;
    Some(StatusReport {
        address: speaker.address.get(),
        at: span.replied_at,
        word,
        indicators: indicators::in_mode(facts.map(|facts| facts.mode)),
        running_ticks: value_in(reply, number::TIME).and_then(|ticks| u32::try_from(ticks).ok()),
    })
}
