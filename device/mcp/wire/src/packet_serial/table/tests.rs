//! What every row of the table keeps.

use std::collections::HashSet;

use super::super::command::{ClientUse, Command, Direction, Effect, Form, Reply};
use super::super::identity::Generation;
use super::super::typed::layout_of;
use super::super::{name, number};
use super::{COMMANDS, lookup, lookup_key};
use brushwork_values::{Field, Kind, width_of};

/// The numbers of the manual and those that public clients use beyond it.
fn wanted() -> Vec<u8> {
    let runs = [(0, 99), (100, 151), (160, 161), (180, 182), (190, 191), (200, 202), (246, 255)];
    runs.into_iter().flat_map(|(first, last)| first..=last).collect()
}

#[test]
fn the_table_has_every_command_once_in_number_order() {
    let numbers: Vec<u8> = COMMANDS.iter().map(|command| command.number).collect();
    assert_eq!(numbers, wanted());
}

#[test]
fn every_row_is_found_by_number_and_by_key_and_nothing_else_is() {
    for number in 0..=255 {
        assert_eq!(lookup(number).map(|row| row.number), wanted().contains(&number).then_some(number));
    }
    for command in COMMANDS {
        assert_eq!(lookup_key(command.key).map(|row| row.number), Some(command.number));
    }
    assert!(lookup_key("no_such_command").is_none());
}

#[test]
fn keys_are_the_names_of_the_number_constants() {
    let rows: Vec<(String, u8)> = COMMANDS.iter().map(|row| (row.key.to_uppercase(), row.number)).collect();
    let constants: Vec<(String, u8)> =
        number::NAMED.iter().map(|(name, number)| ((*name).to_owned(), *number)).collect();
    assert_eq!(rows, constants);
}

#[test]
fn forms_run_in_generation_order_and_do_not_overlap() {
    for command in COMMANDS {
        for form in command.forms {
            assert!(form.first <= form.last, "{}", command.key);
        }
        for pair in command.forms.windows(2) {
            assert!(pair[0].last < pair[1].first, "{}", command.key);
        }
    }
}

#[test]
fn writes_are_acknowledged_and_reads_are_not() {
    for command in COMMANDS {
        for form in command.forms {
            let read = matches!(form.reply, Reply::Data(_));
            assert_eq!(form.direction == Direction::Read, read, "{}", command.key);
            assert!(!read || !form.reply.fields().is_empty(), "{} reads nothing", command.key);
            assert_eq!(
                form.effect == Effect::Query,
                read && form.assumed.is_none_or(|why| !why.contains("run"))
            );
        }
    }
}

#[test]
fn requests_have_a_fixed_width_that_fits_a_packet() {
    for command in COMMANDS {
        let payloads = command.payloads(Direction::Write).chain(command.payloads(Direction::Read));
        for payload in payloads {
            assert!(width_of(payload).is_some_and(|width| width <= 53), "{}", command.key);
        }
    }
}

#[test]
fn names_are_snake_case_and_unique_in_their_layout() {
    for (command, fields) in layouts() {
        let names: HashSet<&str> = fields.iter().map(|field| field.name).collect();
        assert_eq!(names.len(), fields.len(), "{}", command.key);
        for field in fields {
            let clean = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
            assert!(field.name.bytes().all(clean), "{}: {}", command.key, field.name);
            assert!(!field.doc.is_empty(), "{}: {}", command.key, field.name);
        }
    }
}

#[test]
fn the_names_that_the_compiler_knows_are_those_of_the_table() {
    let used: HashSet<&str> = layouts().flat_map(|(_, fields)| fields).map(|field| field.name).collect();
    assert_eq!(name::ALL.iter().copied().collect::<HashSet<_>>(), used);
}

#[test]
fn commands_of_one_layout_have_the_same_fields_and_the_motors_share_theirs() {
    for number in COMMANDS.iter().map(|row| row.number) {
        let first = layout_of(number);
        let names = |number| {
            let forms = lookup(number).expect("in the table").forms.iter();
            let of = |fields: &[Field]| fields.iter().map(|field| field.name).collect::<Vec<_>>();
            forms
                .map(|form| (form.first, form.last, of(form.request), of(form.reply.fields())))
                .collect::<Vec<_>>()
        };
        assert!(first <= number && names(first) == names(number), "{first} and {number}");
    }
    assert_eq!(layout_of(number::READ_POSITION_PID_M2), number::READ_POSITION_PID_M1);
}

#[test]
fn counted_fields_hold_numbers_and_stand_alone_in_a_reply() {
    for (command, fields) in layouts() {
        for field in fields {
            if let Kind::Counted(records) = field.kind {
                assert_eq!(fields.len(), 1, "{}", command.key);
                assert!(records.iter().all(|field| field.kind.limits().is_some()), "{}", command.key);
                assert!(width_of(records).is_some_and(|width| width > 0), "{}", command.key);
            }
        }
    }
}

#[test]
fn ranges_and_constants_fit_their_fields() {
    for (command, fields) in layouts() {
        for field in fields {
            let fits =
                |value: i64| field.kind.limits().is_some_and(|(low, high)| low <= value && value <= high);
            if let Some((low, high)) = field.raw_range {
                assert!(low < high && fits(low) && fits(high), "{}: {}", command.key, field.name);
            }
            assert!(field.fixed.is_none_or(fits), "{}: {}", command.key, field.name);
            assert!(field.codes.iter().all(|code| fits(code.raw)), "{}: {}", command.key, field.name);
            assert!(field.scale > 0.0);
        }
    }
}

#[test]
fn what_moves_a_motor_is_repeated_only_if_it_is_absolute() {
    for command in COMMANDS {
        for form in command.forms {
            let buffered = form.request.iter().any(|field| field.name == "buffer");
            let distance = form.request.iter().any(|field| field.name.starts_with("distance"));
            if buffered || distance {
                assert!(!form.effect.may_be_repeated() && form.effect.may_move(), "{}", command.key);
            }
            if distance {
                assert_eq!(form.effect, Effect::RelativeMotion, "{}", command.key);
            }
        }
    }
}

#[test]
fn a_guess_is_never_sent_and_what_contradicts_is_never_sent() {
    for number in [number::READ_CAN_ERRORS, number::WRITE_CAN_DICTIONARY, number::READ_CAN_DICTIONARY] {
        let row = lookup(number).expect("in the table");
        assert!(matches!(row.client, ClientUse::Never(_)));
        assert!(row.forms.iter().all(|form| form.assumed.is_some()));
    }
    assert!(lookup(number::READ_SCRIPT).expect("in the table").forms.is_empty());
}

/// Widths of payload and of whole reply for the commands that changed, by generation 1 to 4; `-` where there is none.
#[test]
fn widths_follow_the_generation() {
    let table = [
        (57, ["4 1", "4 1", "4 1", "5 1"]),
        (59, ["0 6", "0 6", "0 6", "0 7"]),
        (68, ["4 1", "8 1", "8 1", "8 1"]),
        (69, ["4 1", "8 1", "8 1", "8 1"]),
        (81, ["0 10", "0 18", "0 18", "0 18"]),
        (73, ["-", "-", "-", "0 58"]),
        (74, ["3 1", "3 1", "3 1", "5 1"]),
        (75, ["0 5", "0 5", "0 5", "0 7"]),
        (76, ["2 1", "2 1", "4 1", "24 1"]),
        (77, ["0 4", "0 4", "0 6", "0 26"]),
        (80, ["0 1", "0 1", "4 1", "4 1"]),
        (84, ["4 1", "4 1", "8 1", "8 1"]),
        (87, ["4 1", "4 1", "8 1", "8 1"]),
        (90, ["0 4", "0 4", "0 6", "0 6"]),
        (94, ["4 1", "4 1", "4 1", "4 1"]),
        (96, ["-", "-", "37 1", "37 1"]),
        (97, ["-", "-", "0 39", "0 39"]),
        (100, ["0 4", "2 1", "2 1", "0 6"]),
        (101, ["0 4", "0 4", "0 4", "0 6"]),
        (102, ["-", "2 1", "2 1", "10 1"]),
        (103, ["-", "2 1", "2 1", "0 4"]),
        (104, ["-", "0 6", "0 6", "0 12"]),
        (105, ["-", "6 1", "6 1", "4 1"]),
        (107, ["-", "0 14", "0 14", "0 10"]),
        (109, ["-", "-", "8 1", "4 1"]),
        (110, ["-", "-", "0 10", "0 6"]),
        (111, ["-", "-", "0 10", "0 6"]),
        (112, ["-", "-", "8 1", "4 1"]),
        (114, ["-", "-", "0 10", "0 6"]),
        (142, ["0 3", "0 4", "0 4", "0 4"]),
        (143, ["46 1", "49 1", "53 1", "53 1"]),
        (148, ["1 1", "1 1", "2 1", "2 1"]),
        (149, ["0 3", "0 3", "0 4", "0 4"]),
        (190, ["-", "-", "-", "9 7"]),
        (191, ["-", "-", "-", "4 12"]),
    ];
    for (number, expected) in table {
        let row = lookup(number).expect("in the table");
        let widths = Generation::ALL.map(|generation| match row.form(generation) {
            None => "-".to_owned(),
            Some(form) => format!("{} {}", form.payload_width(), form.reply.width().expect("fixed")),
        });
        assert_eq!(widths, expected, "command {number}");
    }
    let records = Generation::ALL.map(|generation| record_width(number::READ_SIGNALS, generation));
    assert_eq!(records, [45, 48, 52, 52]);
    assert_eq!(record_width(number::READ_STREAMS, Generation::Gen1), 9);
    assert_eq!(record_width(number::READ_SIGNAL_VALUES, Generation::Gen1), 20);
}

fn record_width(number: u8, generation: Generation) -> usize {
    let fields = lookup(number).and_then(|row| row.form(generation)).expect("in the table").reply.fields();
    match fields {
        [Field { kind: Kind::Counted(record), .. }] => width_of(record).expect("fixed"),
        _ => panic!("not a counted reply"),
    }
}

fn layouts() -> impl Iterator<Item = (&'static Command, &'static [Field])> {
    COMMANDS.iter().flat_map(|command| {
        let of_form = |form: &'static Form| [form.request, form.reply.fields()];
        let records =
            command.forms.iter().flat_map(|form| form.reply.fields()).filter_map(|field| match field.kind {
                Kind::Counted(record) => Some(record),
                _ => None,
            });
        let layouts = command.forms.iter().flat_map(of_form).chain(command.also_accepted.iter().copied());
        layouts.chain(records).map(move |fields| (command, fields))
    })
}
