//! Pins and streams: commands 137 to 140, 143 to 147.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use crate::settings::{SignalSettings, StreamSettings};
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_values::Value;

/// Assumed: an index that the model does not have is refused by silence.
pub(super) const HANDLERS: Handlers = &[
    (number::SET_DOUT_ACTION, |unit, args| {
        let is_there = unit.set_output_action(args.u8("index").into(), args.u8("action"));
        if is_there { Answer::Ack } else { Answer::Silence }
    }),
    (number::READ_DOUT_ACTIONS, |unit, _| {
        records("douts", unit.settings.outputs.iter().map(|output| vec![output.action.into()]))
    }),
    (number::SET_PRIORITIES, |unit, args| {
        unit.settings.priority = [args.u8("level_1"), args.u8("level_2"), args.u8("level_3")];
        Answer::Ack
    }),
    (number::READ_PRIORITIES, |unit, _| {
        let [first, second, third] = unit.settings.priority.map(i64::from);
        Answer::ints([("level_1", first), ("level_2", second), ("level_3", third)])
    }),
    (number::SET_SIGNAL, set_signal),
    (number::READ_SIGNALS, |unit, _| {
        let generation = unit.generation;
        records("signals", unit.settings.signals.iter().map(|signal| signal_record(signal, generation)))
    }),
    (number::SET_STREAM, |unit, args| match unit.settings.streams.get_mut(usize::from(args.u8("index"))) {
        Some(stream) => {
            stream.kind = args.u8("type");
            stream.rate_bps = args.u32("rate");
            stream.timeout_ms = args.u32("timeout");
            Answer::Ack
        }
        None => Answer::Silence,
    }),
    (number::READ_STREAMS, |unit, _| {
        let streams = &unit.settings.streams[..unit.model.streams.min(unit.settings.streams.len())];
        records("streams", streams.iter().map(stream_record))
    }),
    (number::READ_SIGNAL_VALUES, |unit, _| {
        let values = unit.signals.iter().zip(&unit.settings.signals).map(|(signal, settings)| {
            let values = signal.values(settings);
            [values.command, values.position, values.percent, values.speed, values.average_speed]
                .map(i64::from)
                .to_vec()
        });
        records("signals", values)
    }),
];

fn set_signal(unit: &mut Firmware, args: &Arguments<'_>) -> Answer {
    let Some(signal) = unit.settings.signals.get_mut(usize::from(args.u8("index"))) else {
        return Answer::Silence;
    };
    let kind = args.u8("type");
    *signal = SignalSettings {
        kind,
        mode: args.u8("mode"),
        target: args.u8("target"),
        min_action: args.u16("min_action"),
        max_action: args.u16("max_action"),
        low_pass: args.int_or("low_pass", signal.low_pass.into()) as u8,
        timeout_ms: args.u32("timeout"),
        load_home: args.i32("load_home"),
        min: args.i32("min"),
        max: args.i32("max"),
        center: args.i32("center"),
        deadband: args.u32("deadband"),
        power_exp_raw: args.i32("power_exponent"),
        min_output: args.i32("min_output"),
        max_output: args.i32("max_output"),
        power_min: args.u32("power_min"),
        potentiometer: args.int_or("potentiometer", signal.potentiometer.into()) as u32,
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

fn records(name: &'static str, records: impl Iterator<Item = Vec<i64>>) -> Answer {
    Answer::Data(vec![(name, Value::Records(records.collect()))])
}
