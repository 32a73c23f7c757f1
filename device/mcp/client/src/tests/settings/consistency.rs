//! The table against itself and against the protocol table.

use std::collections::{BTreeMap, HashSet};

use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{COMMANDS, Effect, Generation, Reply, lookup};
use brushwork_values::{Field, Kind as WireKind, Unit};

use crate::settings::rows::{NOT_SETTINGS, templates};
use crate::tests::settings::every_table;
use brushwork_link::settings::{
    Access, Bits, Bound, Carrier, Coding, Kind, Place, Row, SettingValue, SettingsTable, Source,
};

/// The field that a row is read from, if it is read with a command.
fn read_field(row: &Row, generation: Generation) -> Option<&'static Field> {
    let Carrier::Wire { read: Source::Reply { command, place, record }, .. } = row.carrier else {
        return None;
    };
    let form = lookup(command).and_then(|command| command.form(generation));
    let form = form.unwrap_or_else(|| panic!("{}: {generation} has no command {command}", row.key));
    let Reply::Data(fields) = form.reply else { panic!("{}: command {command} returns no data", row.key) };
    let fields = match (record, fields) {
        (Some(_), [Field { kind: WireKind::Counted(fields), .. }]) => fields,
        (None, fields) => fields,
        (Some(_), _) => panic!("{}: command {command} returns no records", row.key),
    };
    Some(named(fields, place, row))
}

/// The field that a row is written to, if it is written at all.
fn write_field(row: &Row, generation: Generation) -> Option<&'static Field> {
    let sink = row.sink()?;
    let form = lookup(sink.command).and_then(|command| command.form(generation));
    let form = form.unwrap_or_else(|| panic!("{}: {generation} has no command {}", row.key, sink.command));
    assert_eq!(form.effect, Effect::Setting, "{}: command {} is no setting", row.key, sink.command);
    assert!(form.assumed.is_none(), "{}: the form of command {} is a guess", row.key, sink.command);
    let indexed = form.request.first().is_some_and(|field| field.name == "index");
    assert_eq!(indexed, sink.index.is_some(), "{}: index of command {}", row.key, sink.command);
    Some(named(form.request, sink.place, row))
}

fn named(fields: &'static [Field], place: Place, row: &Row) -> &'static Field {
    let field = fields.iter().find(|field| field.name == place.field);
    field.unwrap_or_else(|| panic!("{}: no field {} among {fields:?}", row.key, place.field))
}

fn each_row(mut check: impl FnMut(&SettingsTable, &Row)) {
    for table in every_table() {
        for row in table.rows() {
            check(&table, row);
        }
    }
}

#[test]
fn keys_are_unique_and_well_formed() {
    for table in every_table() {
        let mut seen = HashSet::new();
        for row in table.rows() {
            assert!(seen.insert(&row.key), "{} stands twice in {:?}", row.key, table.subject());
            let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '.' || c == '_';
            assert!(row.key.chars().all(legal) && !row.key.starts_with('.'), "{}", row.key);
            assert_eq!(table.row(&row.key).map(|found| &found.key), Some(&row.key));
        }
    }
}

#[test]
fn every_carrier_names_a_command_and_a_field_of_its_generation() {
    each_row(|table, row| {
        let generation = crate::layout_of(table.subject().generation);
        let read = read_field(row, generation);
        let write = write_field(row, generation);
        // Generation 1 has no command that returns the address: it is the one the link speaks to.
        let own_address = row.key == "unit.address" && generation == Generation::Gen1;
        assert_eq!(read.is_none(), !row.has_wire_form() || own_address, "{}", row.key);
        let is_whole = row.key == "roboclaw.config.word" || row.key.ends_with(".encoder.mode");
        assert_eq!(write.is_none(), !row.has_wire_form() || is_whole, "{}", row.key);
        for field in read.into_iter().chain(write) {
            assert!(field.kind.limits().is_some(), "{}: {} is no number", row.key, field.name);
        }
    });
}

#[test]
fn unit_scale_and_codes_are_those_of_the_wire_field() {
    each_row(|table, row| {
        let generation = crate::layout_of(table.subject().generation);
        for field in read_field(row, generation).into_iter().chain(write_field(row, generation)) {
            let bits = matches!(row.carrier, Carrier::Wire { read: Source::Reply { place, .. }, .. } if place.bits.is_some());
            if !matches!(field.unit, Unit::None | Unit::Bits) {
                assert_eq!(row.unit, field.unit, "{}", row.key);
            }
            if !bits {
                let one = row.coding.to_physical(1).abs();
                assert!((one / field.scale - 1.0).abs() < 1e-12, "{}: {one} is not {}", row.key, field.scale);
            }
            match row.kind {
                Kind::Choice(codes) if !field.codes.is_empty() => {
                    assert_eq!(codes, field.codes, "{}", row.key);
                }
                Kind::Choice(_) => {}
                _ => assert!(field.codes.is_empty(), "{}: the field has named values", row.key),
            }
        }
    });
}

#[test]
fn every_allowed_value_fits_its_wire_fields() {
    each_row(|table, row| {
        let generation = crate::layout_of(table.subject().generation);
        for field in read_field(row, generation).into_iter().chain(write_field(row, generation)) {
            let (low, high) = wire_limits(row, field);
            for value in ends(row) {
                let raw =
                    row.encode(value).unwrap_or_else(|| panic!("{}: {value:?} has no wire form", row.key));
                assert!((low..=high).contains(&raw), "{}: {raw} is not in {low}..={high}", row.key);
            }
        }
    });
}

/// What the field, or the row's bits of it, can carry.
fn wire_limits(row: &Row, field: &Field) -> (i64, i64) {
    match row.carrier {
        Carrier::Wire {
            read: Source::Reply { place: Place { bits: Some(Bits { width, .. }), .. }, .. },
            ..
        } => (0, (1 << width) - 1),
        _ => field.kind.limits().expect("checked by another test"),
    }
}

/// The lowest and highest value of a row, or every value of a choice.
fn ends(row: &Row) -> Vec<SettingValue> {
    match row.kind {
        Kind::Bool => vec![SettingValue::Bool(false), SettingValue::Bool(true)],
        Kind::Choice(codes) => codes.iter().map(|code| SettingValue::Choice(code.key)).collect(),
        Kind::Int => vec![SettingValue::Int(row.range.min as i64), SettingValue::Int(row.range.max as i64)],
        Kind::Fixed { .. } => [row.range.min, row.range.max].map(SettingValue::Number).to_vec(),
    }
}

#[test]
fn defaults_are_inside_their_ranges() {
    each_row(|_, row| {
        assert_eq!(row.check(row.default), Ok(()), "{}", row.key);
        assert_eq!(row.settle(row.default), row.default, "{}: the default is no whole step", row.key);
    });
}

#[test]
fn every_settable_field_is_carried_by_a_row_or_listed_as_not_a_setting() {
    for family in [Family::Mcp, Family::RoboClaw] {
        for table in every_table()
            .filter(|table| crate::model_of(table.subject()).is_some_and(|model| model.family == family))
        {
            let generation = crate::layout_of(table.subject().generation);
            let sinks: Vec<_> = table.rows().iter().filter_map(Row::sink).collect();
            for command in COMMANDS {
                let Some(form) = command.form(generation) else { continue };
                let listed = NOT_SETTINGS.iter().any(|(number, _)| *number == command.number);
                let has_motor = !command.key.ends_with("_m2")
                    || crate::model_of(table.subject()).is_some_and(|model| model.motors == 2);
                if form.effect != Effect::Setting
                    || listed
                    || !has_motor
                    || belongs_to_other_family(command.number, family)
                {
                    continue;
                }
                for field in
                    form.request.iter().filter(|field| field.name != "index" && field.fixed.is_none())
                {
                    if is_of_a_missing_part(&table, field.name) {
                        continue;
                    }
                    let carried = |sink: &&brushwork_link::settings::Sink| {
                        sink.command == command.number && sink.place.field == field.name
                    };
                    assert!(
                        sinks.iter().any(|sink| carried(&sink)),
                        "{} {}: {generation}",
                        command.key,
                        field.name
                    );
                }
            }
        }
    }
}

/// Whether a field is of an output that the board does not have: all of its command are, and it is never written.
fn is_of_a_missing_part(table: &SettingsTable, field: &str) -> bool {
    let model = crate::model_of(table.subject()).expect("the table is of a model");
    match field {
        "mode_1" | "mode_2" => model.family == Family::RoboClaw && model.control_outputs == 0,
        _ => false,
    }
}

/// Commands that only the other product line has settings for.
fn belongs_to_other_family(number: u8, family: Family) -> bool {
    match family {
        Family::Mcp => matches!(number, 14 | 74 | 76 | 98 | 100 | 117),
        Family::RoboClaw => matches!(number, 137 | 139 | 141 | 143 | 145 | 150 | 246),
    }
}

#[test]
fn what_is_no_setting_is_a_command_of_the_table_and_has_a_reason() {
    for (number, reason) in NOT_SETTINGS {
        let command = lookup(*number).unwrap_or_else(|| panic!("there is no command {number}"));
        assert!(
            Generation::ALL.iter().any(|generation| command.effect(*generation) == Effect::Setting),
            "{number}"
        );
        assert!(!reason.is_empty());
    }
}

#[test]
fn all_fields_of_a_write_can_be_read_back() {
    each_row(|table, row| {
        // A write fills the fields of its neighbours from what was read: each must have a readable row.
        let Some(sink) = row.sink() else { return };
        let form = lookup(sink.command)
            .and_then(|command| command.form(crate::layout_of(table.subject().generation)));
        for field in
            form.expect("checked by another test").request.iter().filter(|field| field.name != "index")
        {
            if is_of_a_missing_part(table, field.name) {
                continue;
            }
            let same = |other: &&Row| {
                other.sink().is_some_and(|other| {
                    other.command == sink.command
                        && other.index == sink.index
                        && other.place.field == field.name
                })
            };
            assert!(table.rows().iter().any(|other| same(&other)), "{}: {}", row.key, field.name);
        }
    });
}

#[test]
fn generations_of_a_template_do_not_overlap() {
    for template in templates() {
        for generation in Generation::ALL {
            let count = template.forms.iter().filter(|form| form.serves(generation)).count();
            assert!(count <= 1, "{} has {count} forms in {generation}", template.key);
        }
        assert!(!template.generations().is_empty(), "{} stands in no generation", template.key);
    }
}

#[test]
fn every_row_explains_itself() {
    each_row(|_, row| {
        assert!(row.help.ends_with('.') && row.help.len() > 20, "{}: {}", row.key, row.help);
        assert!(
            row.help.contains("MCP manual")
                || row.help.contains("RoboClaw manual")
                || row.help.contains("ublic clients")
                || row.help.contains("Command")
        );
        assert!(!row.label.is_empty());
        if let Access::ReadOnly { reason } | Access::SimulatedOnly { reason } = row.access {
            assert!(reason.ends_with('.'), "{}: {reason}", row.key);
        }
        let numeric = matches!(row.kind, Kind::Int | Kind::Fixed { .. });
        // The functions of these pins have no names for all of their numbers.
        let takes_numbers = numeric || row.pattern == "roboclaw.pin.{n}";
        assert_eq!(takes_numbers, row.range.bound != Bound::Unbounded, "{}", row.key);
    });
}

#[test]
fn what_has_no_public_wire_form_is_a_row_that_real_controllers_refuse() {
    let table = crate::tests::settings::table("mcp266", Generation::Gen1);
    for key in [
        "unit.bridge_channels",
        "dout.1.inverted",
        "stream.ttl1.multi_unit",
        "pin.1.digital",
        "pin.10.low_pass",
        "can.rate",
        "can.node_id",
        "i2c.rate",
    ] {
        let row = table.row(key).unwrap_or_else(|| panic!("{key} is missing"));
        assert!(!row.has_wire_form() && row.locked(true).is_none() && row.locked(false).is_some(), "{key}");
    }
    for key in ["pin.1.min_action", "motor1.encoder.pin"] {
        let row = table.row(key).unwrap_or_else(|| panic!("{key} is missing"));
        assert!(row.has_wire_form() && row.locked(true).is_none() && row.locked(false).is_some(), "{key}");
    }
    assert!(
        crate::tests::settings::table("mcp266", Generation::Gen2)
            .row("pin.10.low_pass")
            .is_some_and(Row::has_wire_form)
    );
}

#[test]
fn each_generation_has_the_rows_it_is_known_for() {
    let counts: BTreeMap<u8, usize> = Generation::ALL
        .map(|generation| {
            (generation.number(), crate::tests::settings::table("mcp266", generation).rows().len())
        })
        .into();
    // Generation 1: 10 pins x 17, 5 streams x 3, 3 multi-unit modes, 2 outputs x 2, 3 buses, 13 of the unit,
    // 2 motors x 17.
    assert_eq!(counts, BTreeMap::from([(1, 242), (2, 248), (3, 271), (4, 270)]));
    for (key, generations) in [
        ("unit.pwm_mode", &[1, 2][..]),
        ("motor2.pwm_mode", &[3, 4]),
        ("motor1.default_decel", &[2, 3, 4]),
        ("motor1.home.duty", &[2, 3]),
        ("motor1.home.timeout_seconds", &[2, 3, 4]),
        ("limits.main_battery.auto_offset_volts", &[4]),
        ("pin.1.potentiometer", &[3, 4]),
        ("motor1.error_limit.speed", &[3, 4]),
    ] {
        let has =
            |generation: &Generation| crate::tests::settings::table("mcp266", *generation).row(key).is_some();
        let found: Vec<u8> = Generation::ALL.into_iter().filter(has).map(Generation::number).collect();
        assert_eq!(found, generations, "{key}");
    }
}

#[test]
fn the_minimum_current_is_a_magnitude_on_the_wire_from_generation_3() {
    for (generation, raw) in [(1, -4000), (2, -4000), (3, 4000), (4, 4000)] {
        let generation = Generation::from_number(generation).expect("there are four");
        let table = crate::tests::settings::table("mcp266", generation);
        let row = table.row("motor1.current.min_amps").expect("every MCP has it");
        assert!(matches!(row.coding, Coding::NegativePerUnit { .. }));
        assert_eq!(row.encode(SettingValue::Number(-40.0)), Some(raw));
        // Whatever sign the controller reports.
        assert_eq!(row.decode(4000), SettingValue::Number(-40.0));
        assert_eq!(row.decode(-4000), SettingValue::Number(-40.0));
    }
}
