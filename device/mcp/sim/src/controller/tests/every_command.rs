//! Every row of the command table against the simulator, in every generation.

use super::support::Bench;
use crate::controller::ControllerConfig;
use crate::controller::dispatch::handler;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{
    COMMANDS, Command, Direction, Form, Generation, Reply, Request, Simulated, lookup_key,
};
use brushwork_values::{Field, Kind, Value, Values};

/// The pin, output or stream that indexed writes are tried on.
const INDEX: i64 = 1;

/// A value that fits a field: the constant it always has, an end of its range or something small.
fn sample(field: &Field, salt: i64) -> Value {
    match field.kind {
        Kind::Text { .. } | Kind::Ascii36 | Kind::Utf16Le36 => Value::Text(format!("S{salt}")),
        Kind::Bytes(count) => Value::Bytes(vec![salt as u8; count]),
        Kind::Counted(_) => Value::Records(Vec::new()),
        _ => Value::Int(sample_int(field, salt)),
    }
}

fn sample_int(field: &Field, salt: i64) -> i64 {
    if let Some(fixed) = field.fixed {
        return fixed;
    }
    if field.name == "index" && !matches!(field.kind, Kind::U16) {
        return INDEX;
    }
    if let [_, ..] = field.codes {
        return field.codes[salt as usize % field.codes.len()].raw;
    }
    let (low, high) = field.raw_range.or(field.kind.limits()).unwrap_or((0, 100));
    (low.max(0) + salt).min(high)
}

fn request_for(command: &Command, generation: Generation, bench: &Bench, salt: i64) -> Option<Request> {
    let form = command.form(generation)?;
    let values = form.request.iter().enumerate().map(|(index, field)| sample(field, salt + index as i64));
    Some(Request { address: bench.address, command: command.number, values: values.collect() })
}

#[test]
fn every_command_is_answered_where_the_generation_has_it_and_only_there() {
    for generation in Generation::ALL {
        for command in COMMANDS {
            let mut bench = Bench::new(generation);
            match request_for(command, generation, &bench, 1) {
                Some(request) => {
                    let bytes = request.encode(generation).expect("a request of this generation");
                    let answered = !bench.raw(&bytes).is_empty();
                    let silent = matches!(command.simulated, Simulated::Silent(_));
                    assert_eq!(answered, !silent, "{} in {generation}", command.key);
                }
                None => {
                    assert!(bench.raw(&[0x80, command.number]).is_empty(), "{} in {generation}", command.key);
                }
            }
        }
    }
}

#[test]
fn every_command_with_a_layout_has_a_handler() {
    for command in COMMANDS {
        assert_eq!(handler(command.number).is_some(), !command.forms.is_empty(), "{}", command.key);
    }
}

/// The read that returns what a write sets, where its key is not simply `read_` for `set_`.
const READS: [(&str, &str); 11] = [
    ("set_default_accel_m1", "read_default_accels"),
    ("set_default_accel_m2", "read_default_accels"),
    ("set_default_speed_m1", "read_default_speeds"),
    ("set_default_speed_m2", "read_default_speeds"),
    ("set_encoder_mode_m1", "read_encoder_modes"),
    ("set_encoder_mode_m2", "read_encoder_modes"),
    ("set_homing_m1", "read_homing"),
    ("set_homing_m2", "read_homing"),
    ("set_dout_action", "read_dout_actions"),
    ("set_signal", "read_signals"),
    ("write_user_memory", "read_user_memory"),
];

/// Fields of a write that its read does not carry, with the generation.
const NOT_READ: [(&str, &str, Generation); 1] = [("set_address_mixed", "address", Generation::Gen1)];

fn read_for(write: &Command, generation: Generation) -> Option<&'static Command> {
    let listed = READS.iter().find(|(key, _)| *key == write.key).map(|(_, read)| (*read).to_owned());
    let key = listed.or_else(|| {
        let rest = write.key.strip_prefix("set_")?;
        Some(if rest == "stream" { "read_streams".to_owned() } else { format!("read_{rest}") })
    })?;
    let read = lookup_key(&key)?;
    let form = read.form(generation)?;
    (form.direction == Direction::Read).then_some(read)
}

#[test]
fn what_is_written_is_read_back() {
    let mut pairs = 0;
    for generation in Generation::ALL {
        for write in COMMANDS {
            let Some(form) = write.form(generation).filter(|form| form.direction == Direction::Write) else {
                continue;
            };
            if let Some(read) = read_for(write, generation) {
                check_pair(write, form, read, generation);
                pairs += 1;
            }
        }
    }
    assert!(pairs > 90, "only {pairs} pairs were found");
}

fn check_pair(write: &Command, form: &Form, read: &Command, generation: Generation) {
    // An MCP tells the configuration word from its other settings; a RoboClaw stores it.
    let model = if write.key == "set_config" { "roboclaw-2x30a" } else { "mcp266" };
    let model = models::lookup(model).expect("it is listed");
    let mut bench = Bench::of(ControllerConfig { generation, ..ControllerConfig::of(model) });
    let request = request_for(write, generation, &bench, 3).expect("the form exists");
    bench.try_send(&request).unwrap_or_else(|| panic!("{} in {generation}", write.key));
    let asked_for = read.form(generation).map_or(&[][..], |form| form.request);
    let value_of =
        |name| form.request.iter().position(|field| field.name == name).map(|at| &request.values[at]);
    let arguments: Vec<i64> =
        asked_for.iter().filter_map(|field| value_of(field.name).and_then(Value::as_int)).collect();
    let back = bench.ask_row(read.number, &arguments);
    for (field, value) in form.request.iter().zip(&request.values) {
        let is_index = field.name == "index" || asked_for.iter().any(|asked| asked.name == field.name);
        if is_index || NOT_READ.contains(&(write.key, field.name, generation)) {
            continue;
        }
        let found = is_among(field, value, write.key, &back);
        assert!(found, "{}: {} {value:?} in {generation}: {back:?}", write.key, field.name);
    }
}

/// Whether the reply carries the value: under the same name, under the name with the motor's suffix, or in the record that
/// [`sample_int`] chose.
fn is_among(field: &Field, value: &Value, write: &str, back: &Values) -> bool {
    let suffix = if write.ends_with("_m2") { "_m2" } else { "_m1" };
    let record = back.records().nth(INDEX as usize).and_then(|record| record.try_int(field.name));
    back.get(field.name) == Some(value)
        || back.get(&format!("{}{suffix}", field.name)) == Some(value)
        || (record.is_some() && record == value.as_int())
}

#[test]
fn replies_have_the_kind_the_table_says() {
    for generation in Generation::ALL {
        for command in COMMANDS {
            let mut bench = Bench::new(generation);
            let (Some(form), Some(request)) =
                (command.form(generation), request_for(command, generation, &bench, 1))
            else {
                continue;
            };
            bench.install("main\ngoto main\n");
            let bytes = request.encode(generation).expect("a valid request");
            let reply = bench.raw(&bytes);
            match form.reply {
                Reply::Ack => assert_eq!(reply, [0xff], "{}", command.key),
                Reply::AckThenStatus(_) => {
                    assert_eq!(reply, [0xff], "{}", command.key);
                    bench.wait(std::time::Duration::from_secs(5));
                    let status = bench.raw(&[]);
                    assert_eq!(status, [0xff], "{} in {generation}", command.key);
                }
                Reply::Data(_) | Reply::AckThenData(_) => {
                    if let Some(width) = form.reply.width() {
                        assert_eq!(reply.len(), width, "{} in {generation}", command.key);
                    }
                }
            }
        }
    }
}
