//! Commands by number and reports as named values: the words in which settings and shared code speak of any family.

use brushwork_suprmotr_wire::{COMMANDS, Command, Mnemonic, Report, ReportLine, Status, limits, operation};
use brushwork_values::{Field, Kind, Value, Values};
use std::sync::LazyLock;

/// The fields of the status, in the order of its bytes.
pub static STATUS_FIELDS: [Field; 6] = [
    Field::new("operation", Kind::U8, "what the controller is about"),
    Field::new("motion", Kind::U8, "the motion"),
    Field::new("limits", Kind::U8, "what limit switches do"),
    Field::new("inputs", Kind::U8, "limit switches and reference as they are"),
    Field::new("mode", Kind::U8, "the mode of moving, which the manual does not describe"),
    Field::new("error", Kind::U8, "the number of the last error"),
];

static CHANNEL_FIELDS: [Field; 2] = [
    Field::new("outputs", Kind::U16, "the outputs, channel 1 in bit 0"),
    Field::new("inputs", Kind::U16, "the inputs, channel 1 in bit 0"),
];

static LINES: [Field; 1] = [Field::new("lines", Kind::U16, "how many lines came")];

static ONE_CHANNEL: [Field; 1] = [Field::new("input", Kind::U8, "whether the input is on")];

static ANALOG_FIELDS: [Field; 2] = [
    Field::new("analog_1", Kind::U8, "analog input 1, 5 V at 255"),
    Field::new("analog_2", Kind::U8, "analog input 2, 5 V at 255"),
];

/// For each command a field that carries the number it reports, by its letters.
static NUMBER_FIELDS: LazyLock<Vec<[Field; 1]>> =
    LazyLock::new(|| COMMANDS.iter().map(|row| [Field::new(row.name, Kind::I32, row.help)]).collect());

/// The numbers of a report by name.
pub fn values_of(report: &Report) -> Values {
    match report.lines.as_slice() {
        [ReportLine::Number { of, value }] => {
            let fields: &'static [Field; 1] = &NUMBER_FIELDS[usize::from(of.number())];
            Values::new(fields, vec![Value::Int((*value).into())])
        }
        [ReportLine::Status(status)] => status_values(*status),
        [ReportLine::Channels { outputs, inputs }] => {
            let values = [*outputs, *inputs].map(|word| Value::Int(word.into()));
            Values::new(&CHANNEL_FIELDS, values.to_vec())
        }
        [ReportLine::Channel { is_on, .. }] => Values::new(&ONE_CHANNEL, vec![Value::Int((*is_on).into())]),
        [ReportLine::Analog { channel, values }] => {
            let first = usize::from(channel.saturating_sub(1));
            let named =
                values.iter().enumerate().map(|(at, value)| (first + at, Value::Int((*value).into())));
            Values::picked(&ANALOG_FIELDS, named)
        }
        // Text, macros and lists of several have no names; who wants them reads the bytes.
        lines => Values::new(&LINES, vec![Value::Int(i64::try_from(lines.len()).unwrap_or(i64::MAX))]),
    }
}

/// The status by name.
pub fn status_values(status: Status) -> Values {
    Values::new(&STATUS_FIELDS, status.bytes().map(|byte| Value::Int(byte.into())).to_vec())
}

/// A setting of two values that two commands without a number change.
#[derive(Debug)]
pub struct Switch {
    /// Its number, behind those of the commands.
    pub number: u8,
    /// What it is, and the name of its value.
    pub name: &'static str,
    /// What sets it to 0 and to 1.
    pub commands: [Mnemonic; 2],
    /// The byte of the status that tells it, and its bit.
    pub told_by: (&'static str, u8),
}

/// Numbers from here on are switches.
const FIRST_SWITCH: u8 = 0x80;
/// The limit of the following error, as it was last set.
pub const FOLLOWING_ERROR: u8 = 0x8F;

/// A restart, which loads EEPROM, where no macro 0 would run.
pub const RESTART: u8 = 0x8E;

/// The limit of the following error as a value.
pub static FOLLOWING_ERROR_FIELD: [Field; 1] =
    [Field::new("SM", Kind::U16, "the limit of the following error as it was last set here")];

/// All of them.
pub static SWITCHES: [Switch; 3] = [
    Switch {
        number: FIRST_SWITCH,
        name: "limits_on",
        commands: [Mnemonic::LF, Mnemonic::LN],
        told_by: ("limits", limits::ENABLED),
    },
    Switch {
        number: FIRST_SWITCH + 1,
        name: "limits_high",
        commands: [Mnemonic::LL, Mnemonic::LH],
        told_by: ("limits", limits::ACTIVE_HIGH),
    },
    Switch {
        number: FIRST_SWITCH + 2,
        name: "echo",
        commands: [Mnemonic::EF, Mnemonic::EN],
        told_by: ("operation", operation::ECHO),
    },
];

/// The command of a number with its values, switches included.
pub fn command_of(number: u8, values: &[i64]) -> Option<Command> {
    if let Some(switch) = SWITCHES.iter().find(|switch| switch.number == number) {
        let [value] = values else { return None };
        return switch.commands.get(usize::try_from(*value).ok()?).copied().map(Command::plain);
    }
    let mnemonic = Mnemonic::from_number(number)?;
    let command = match values {
        [] => Command::plain(mnemonic),
        [value] => Command::with(mnemonic, i32::try_from(*value).ok()?),
        _ => return None,
    };
    command.check().is_ok().then_some(command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_suprmotr_wire::{Address, Line, Progress, Radix, ReportForm, encode_report, parse_report};

    #[test]
    fn a_number_stands_for_its_command_with_a_value_that_it_takes() {
        for row in COMMANDS {
            let value = row.takes.map(|takes| takes.only.first().copied().unwrap_or(takes.high));
            let values: Vec<i64> = value.into_iter().map(i64::from).collect();
            let command = command_of(row.mnemonic.number(), &values).unwrap();
            assert_eq!((command.mnemonic, command.number), (row.mnemonic, value), "{}", row.name);
        }
        assert_eq!(command_of(Mnemonic::DP.number(), &[256]), None);
        assert_eq!(command_of(Mnemonic::TP.number(), &[1]), None);
        assert_eq!(command_of(0x80, &[0]), Some(Command::plain(Mnemonic::LF)));
        assert_eq!(command_of(0x82, &[1]), Some(Command::plain(Mnemonic::EN)));
        assert_eq!(
            (command_of(0x82, &[2]), command_of(0x83, &[1]), command_of(0x82, &[])),
            (None, None, None)
        );
        assert!(COMMANDS.len() < usize::from(FIRST_SWITCH));
    }

    #[test]
    fn what_a_report_says_has_names() {
        let named = |command: Command, lines: &[ReportLine]| {
            let bytes = encode_report(ReportForm::Full, Radix::Decimal, Address::FACTORY, lines);
            let sent = Line::of(command).encode(Radix::Decimal).unwrap();
            match parse_report(&command, Radix::Decimal, &sent, &bytes) {
                Progress::Done { report, .. } => values_of(&report),
                other => panic!("{other:?}"),
            }
        };
        let value =
            named(Command::plain(Mnemonic::GP), &[ReportLine::Number { of: Mnemonic::GP, value: 75 }]);
        assert_eq!(value.try_int("GP"), Some(75));
        let analog =
            named(Command::with(Mnemonic::TA, 2), &[ReportLine::Analog { channel: 2, values: vec![9] }]);
        assert_eq!((analog.try_int("analog_2"), analog.try_int("analog_1")), (Some(9), None));
        let status = Status { operation: 1, error: 6, ..Status::default() };
        let values = named(Command::plain(Mnemonic::TS), &[ReportLine::Status(status)]);
        assert_eq!((values.try_int("operation"), values.try_int("error")), (Some(1), Some(6)));
    }
}
