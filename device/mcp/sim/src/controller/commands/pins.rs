//! Pins and streams: commands 137 to 140, 143 to 147.

use super::super::answer::{Answer, Arguments, Handlers, On, tell, tell_value};
use super::super::firmware::Firmware;
use crate::settings::{SignalSettings, StreamSettings};
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_values::Value;

/// Assumed: an index that the model does not have is refused by silence.
pub(super) const HANDLERS: Handlers = &[
    &On(commands::SET_DOUT_ACTION, |unit, args| {
        let is_there = unit.set_output_action(args.u8(INDEX).into(), args.u8(ACTION));
        if is_there { Answer::Ack } else { Answer::Silence }
    }),
    &On(commands::READ_DOUT_ACTIONS, |unit, _| {
        records(DOUTS, unit.settings.outputs.iter().map(|output| vec![output.action.into()]))
    }),
    &On(commands::SET_PRIORITIES, |unit, args| {
        unit.settings.priority = [args.u8(LEVEL_1), args.u8(LEVEL_2), args.u8(LEVEL_3)];
        Answer::Ack
    }),
    &On(commands::READ_PRIORITIES, |unit, _| {
        let [first, second, third] = unit.settings.priority.map(i64::from);
        Answer::of([tell(LEVEL_1, first), tell(LEVEL_2, second), tell(LEVEL_3, third)])
    }),
    &On(commands::SET_SIGNAL, set_signal),
    &On(commands::READ_SIGNALS, |unit, _| {
        let generation = unit.generation;
        records(SIGNALS, unit.settings.signals.iter().map(|signal| signal_record(signal, generation)))
    }),
    &On(commands::SET_STREAM, |unit, args| {
        match unit.settings.streams.get_mut(usize::from(args.u8(INDEX))) {
            Some(stream) => {
                stream.kind = args.u8(TYPE);
                stream.rate_bps = args.u32(RATE);
                stream.timeout_ms = args.u32(TIMEOUT);
                Answer::Ack
            }
            None => Answer::Silence,
        }
    }),
    &On(commands::READ_STREAMS, |unit, _| {
        let streams = &unit.settings.streams[..unit.model.streams.min(unit.settings.streams.len())];
        records(STREAMS, streams.iter().map(stream_record))
    }),
    &On(commands::READ_SIGNAL_VALUES, |unit, _| {
        let values = unit.signals.iter().zip(&unit.settings.signals).map(|(signal, settings)| {
            let values = signal.values(settings);
            [values.command, values.position, values.percent, values.speed, values.average_speed]
                .map(i64::from)
                .to_vec()
        });
        records(SIGNALS, values)
    }),
];

fn set_signal<const L: u8>(unit: &mut Firmware, args: &Arguments<'_, L>) -> Answer<L> {
    let Some(signal) = unit.settings.signals.get_mut(usize::from(args.u8(INDEX))) else {
        return Answer::Silence;
    };
    let kind = args.u8(TYPE);
    *signal = SignalSettings {
        kind,
        mode: args.u8(MODE),
        target: args.u8(TARGET),
        min_action: args.u16(MIN_ACTION),
        max_action: args.u16(MAX_ACTION),
        low_pass: args.int_or(LOW_PASS, signal.low_pass.into()) as u8,
        timeout_ms: args.u32(TIMEOUT),
        load_home: args.i32(LOAD_HOME),
        min: args.i32(MIN),
        max: args.i32(MAX),
        center: args.i32(CENTER),
        deadband: args.u32(DEADBAND),
        power_exp_raw: args.i32(POWER_EXPONENT),
        min_output: args.i32(MIN_OUTPUT),
        max_output: args.i32(MAX_OUTPUT),
        power_min: args.u32(POWER_MIN),
        potentiometer: args.int_or(POTENTIOMETER, signal.potentiometer.into()) as u32,
        digital: signal.digital && kind == 0,
    };
    Answer::Ack
}

/// In the order of the generation's record.
fn signal_record(signal: &SignalSettings, generation: Generation) -> Vec<i64> {
    let mut record: Vec<i64> = vec![
        signal.kind.into(),
        signal.mode.into(),
        signal.target.into(),
        signal.min_action.into(),
        signal.max_action.into(),
    ];
    if generation > Generation::Gen1 {
        record.push(signal.low_pass.into());
    }
    record.extend([
        i64::from(signal.timeout_ms),
        signal.load_home.into(),
        signal.min.into(),
        signal.max.into(),
        signal.center.into(),
        signal.deadband.into(),
        signal.power_exp_raw.into(),
        signal.min_output.into(),
        signal.max_output.into(),
        signal.power_min.into(),
    ]);
    if generation > Generation::Gen2 {
        record.push(signal.potentiometer.into());
    }
    record
}

fn stream_record(stream: &StreamSettings) -> Vec<i64> {
    vec![stream.kind.into(), stream.rate_bps.into(), stream.timeout_ms.into()]
}

fn records<const L: u8>(name: impl Name, records: impl Iterator<Item = Vec<i64>>) -> Answer<L> {
    Answer::of([tell_value(name, Value::Records(records.collect()))])
}
