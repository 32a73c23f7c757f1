//! Reading and writing against a fake controller: how few commands, and what is told when something goes
//! wrong.

use brushwork_mcp_wire::packet_serial::{Address, Generation};

use crate::tests::settings::fake::{FakeUnit, Mishap};
use crate::tests::settings::{every_table, table};
use brushwork_link::settings::{
    RowState, SettingValue, SettingsImage, SettingsTable, WriteError, WriteOptions, WriteReport, diff,
    read_all, write,
};
use brushwork_link::wire::{HiddenSettings, Wire};

const OPTIONS: WriteOptions = WriteOptions { own_stream: None, simulated: true, as_read: false };

fn image(table: &SettingsTable, values: &[(&str, &str)]) -> SettingsImage {
    let parse = |(key, text): &(&str, &str)| {
        let row = table.row(key).unwrap_or_else(|| panic!("{key} is missing"));
        ((*key).to_owned(), row.parse_any(text).unwrap_or_else(|why| panic!("{key}: {why}")))
    };
    values.iter().map(parse).collect()
}

fn written(unit: &mut FakeUnit, table: &SettingsTable, changes: &[(&str, &str)]) -> WriteReport {
    write(unit, table, &image(table, changes), OPTIONS).unwrap_or_else(|error| panic!("{error}"))
}

fn states(report: &WriteReport) -> Vec<(&str, &RowState)> {
    report.rows.iter().map(|row| (row.key.as_str(), &row.state)).collect()
}

#[test]
fn everything_is_read_with_one_command_for_each_reply() {
    for table in every_table() {
        let mut unit = FakeUnit::new(&table);
        let report = read_all(&mut unit, *table.subject()).unwrap_or_else(|failure| panic!("{failure}"));
        assert!(report.failures.is_empty(), "{:?}", report.failures);
        assert_eq!(diff(&table, &report.image, &table.default_image()), [], "{:?}", table.subject());
        let mut commands: Vec<u8> = unit.log.iter().map(|(command, _)| *command).collect();
        assert_eq!(report.transactions, commands.len());
        commands.sort_unstable();
        commands.dedup();
        assert_eq!(report.transactions, commands.len(), "a command was sent twice");
    }
}

#[test]
fn the_minimum_number_of_commands_is_known() {
    for (generation, expected) in [(1, 20), (2, 21), (3, 27), (4, 27)] {
        let table = table("mcp266", Generation::from_number(generation).expect("there are four"));
        let mut unit = FakeUnit::new(&table);
        let report = read_all(&mut unit, *table.subject()).expect("it answers");
        assert_eq!(report.transactions, expected, "generation {generation}");
    }
}

#[test]
fn the_counts_that_the_controller_returns_win() {
    let real = table("mcp266", Generation::Gen1);
    let mut listed = *real.subject();
    (listed.pins, listed.douts) = (4, 8);
    let report = read_all(&mut FakeUnit::new(&real), listed).expect("it answers");
    assert_eq!((report.table.subject().pins, report.table.subject().douts), (10, 2));
    assert!(report.image.get("pin.10.type").is_some() && report.image.get("dout.3.action").is_none());
}

#[test]
fn a_command_that_is_not_answered_costs_only_its_own_rows() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    unit.silent = [63, 146].into();
    let report = read_all(&mut unit, *table.subject()).expect("the rest answers");
    let failed: Vec<(u8, usize)> =
        report.failures.iter().map(|failure| (failure.command, failure.keys.len())).collect();
    assert_eq!(failed, [(63, 7), (146, 15)]);
    assert_eq!(report.image.len(), table.rows().len() - 22);
    assert_eq!(
        report.failures[0].failure.to_string(),
        "Could not read M1 position PID (63) on 0x80 at the test: no answer within 20 ms (3 tries). Check \
         the controller's power, the wiring, the baud rate and the address."
    );
}

#[test]
fn a_controller_that_never_answers_is_given_up_soon() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    unit.unit_address = crate::unit_address(Address::LAST);
    let failure = read_all(&mut unit, *table.subject()).expect_err("nobody answers");
    assert!(
        failure.to_string().starts_with("Could not read the settings on 0x80 at the test: no answer"),
        "{failure}"
    );
    // Three commands that it may not know, then the version, which every controller tells.
    assert_eq!(unit.log.len(), 4);
}

#[test]
fn a_change_is_written_with_its_neighbours_as_they_are_and_read_back() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    unit.set("motor1.velocity.i", "0.75");
    let report = written(&mut unit, &table, &[("motor1.velocity.p", "2")]);
    assert!(report.is_complete());
    // 55 before, 28 with D 0.25, P 2.0, I as the controller had it, QPPS 44000, 55 after.
    let expected = [(55, vec![]), (28, vec![0x4000, 0x20000, 0xC000, 44_000]), (55, vec![])];
    assert_eq!(unit.log, expected);
    assert_eq!(report.transactions, 3);
}

#[test]
fn a_neighbour_that_came_back_with_the_other_sign_gets_its_own_register() {
    let table = table("mcp266", Generation::Gen4);
    let write_with_minimum = |raw: i64, is_stubborn: bool| {
        let mut unit = FakeUnit::new(&table);
        unit.ram.insert("motor1.current.min_amps".to_owned(), raw);
        if is_stubborn {
            unit.stubborn.insert("motor1.current.min_amps".to_owned());
        }
        let report = written(&mut unit, &table, &[("motor1.current.max_amps", "20")]);
        assert!(report.is_complete() && report.warnings.is_empty(), "{:?}", report.sentences(&table));
        assert_eq!(unit.ram["motor1.current.min_amps"], raw);
        unit.log.into_iter().filter(|(command, _)| *command == 133).map(|(_, sent)| sent).collect::<Vec<_>>()
    };
    // The usual form first. A firmware that takes it and reports the other sign needs no more.
    assert_eq!(write_with_minimum(-500, false), [[2000, 500], [2000, -500]]);
    assert_eq!(write_with_minimum(-500, true), [[2000, 500]]);
    assert_eq!(write_with_minimum(500, false), [[2000, 500]]);
    // The lowest number of the field has no magnitude in it.
    assert_eq!(write_with_minimum(-0x8000_0000, false), [[2000, -0x8000_0000]]);
}

#[test]
fn what_the_controller_holds_already_is_not_sent() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    let report = written(&mut unit, &table, &[("motor1.velocity.p", "1"), ("unit.mixing", "no")]);
    assert!(report.is_complete() && report.rows.len() == 2);
    assert_eq!(unit.count(28) + unit.count(141), 0);
}

#[test]
fn all_rows_of_every_table_can_be_written_and_come_back() {
    for table in every_table() {
        let mut unit = FakeUnit::new(&table);
        let wanted: SettingsImage = table
            .rows()
            .iter()
            .filter(|row| row.locked(true).is_none())
            .map(|row| (row.key.clone(), another_value(row)))
            .collect();
        let report = write(&mut unit, &table, &wanted, OPTIONS).unwrap_or_else(|error| panic!("{error}"));
        assert!(report.is_complete(), "{:?}: {:#?}", table.subject(), report.sentences(&table));
        let after = read_all(&mut unit, *table.subject()).expect("it answers").image;
        for (key, value) in wanted.iter() {
            assert_eq!(after.get(key), Some(value), "{key}");
        }
    }
}

/// A value in range that is not the default, where there is one.
fn another_value(row: &brushwork_link::settings::Row) -> SettingValue {
    use brushwork_link::settings::Kind;
    match row.kind {
        Kind::Bool => SettingValue::Bool(row.default != SettingValue::Bool(true)),
        Kind::Choice(codes) => {
            let other = codes.iter().rev().find(|code| row.default != SettingValue::Choice(code.key));
            SettingValue::Choice(other.map_or("", |code| code.key))
        }
        Kind::Int | Kind::Fixed { .. } => {
            // A quarter up the range for what is called a minimum, three quarters for everything else.
            let share = if row.key.contains("min") { 0.25 } else { 0.75 };
            let number = row.range.min + (row.range.max - row.range.min) * share;
            match row.kind {
                Kind::Int => SettingValue::Int(number as i64),
                _ => row.settle(SettingValue::Number(number)),
            }
        }
    }
}

#[test]
fn what_did_not_take_is_named_with_both_values() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    unit.stubborn.insert("motor1.velocity.i".to_owned());
    let report = written(&mut unit, &table, &[("motor1.velocity.p", "2"), ("motor1.velocity.i", "0.75")]);
    assert!(!report.is_complete());
    assert_eq!(
        report.sentences(&table),
        ["Motor 1: velocity I was to be 0.750 and is 0.500: the controller acknowledged it and did not \
             take it."]
    );
    let mut ram = table.default_image();
    report.merge_into(&mut ram);
    assert_eq!(ram.get("motor1.velocity.p"), Some(SettingValue::Number(2.0)));
    assert_eq!(ram.get("motor1.velocity.i"), Some(SettingValue::Number(0.5)));
}

#[test]
fn a_neighbour_that_changed_by_itself_is_told() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    // The first reading is given by hand: the controller's D is another one when it is read back.
    let wanted = image(&table, &[("motor1.velocity.p", "2")]);
    unit.stubborn.insert("motor1.velocity.d".to_owned());
    let report = write(&mut Twitching { unit, at: 2 }, &table, &wanted, OPTIONS).expect("it answers");
    assert_eq!(
        report.warnings,
        ["Motor 1: velocity D changed from 0.250 to 3.000, which was not asked for."]
    );
}

/// A controller in which another hand sets D of motor 1 before command number `at`.
struct Twitching {
    unit: FakeUnit,
    at: usize,
}

impl Wire for Twitching {
    fn transact_values(
        &mut self,
        command: u8,
        values: Vec<brushwork_values::Value>,
    ) -> Result<brushwork_values::Values, brushwork_link::exchange::ExchangeError> {
        if self.unit.log.len() == self.at {
            self.unit.set("motor1.velocity.d", "3");
        }
        self.unit.transact_values(command, values)
    }

    fn address(&self) -> brushwork_link::unit::UnitAddress {
        self.unit.address()
    }

    fn generation(&self) -> brushwork_link::unit::FirmwareGeneration {
        self.unit.generation()
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn now(&self) -> std::time::Duration {
        self.unit.now()
    }

    fn sleep(&mut self, time: std::time::Duration) -> Result<(), brushwork_link::exchange::ExchangeError> {
        self.unit.sleep(time)
    }

    fn port(&self) -> String {
        self.unit.port()
    }
}

/// Two commands: 28 is number 2 in the log, 29 number 3; 55 and 56 come before and after.
const BOTH_GAINS: [(&str, &str); 2] = [("motor1.velocity.p", "2"), ("motor2.velocity.p", "3")];

#[test]
fn an_acknowledgement_that_is_lost_is_no_failure_when_the_value_is_there() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    unit.mishaps.insert(2, Mishap::DoneUnanswered);
    let report = written(&mut unit, &table, &BOTH_GAINS);
    assert!(report.is_complete() && report.ended_early.is_none(), "{:?}", states(&report));
}

#[test]
fn a_command_without_an_answer_costs_its_own_rows_and_the_rest_goes_on() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    unit.silent.insert(28);
    let report = written(&mut unit, &table, &BOTH_GAINS);
    let reported = report.sentences(&table);
    assert_eq!(reported.len(), 1);
    assert!(
        reported[0].to_string().starts_with(
            "Motor 1: velocity P was to be 2.000 and is 1.000. Could not write M1 velocity PID (28)"
        ),
        "{reported:?}"
    );
    assert_eq!(states(&report)[1], ("motor2.velocity.p", &RowState::Taken));
    assert!(report.ended_early.is_none());
}

#[test]
fn a_controller_that_falls_silent_ends_the_write_and_nothing_is_claimed() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    // 28 is carried out and not acknowledged, then the unit is away for good.
    unit.mishaps.insert(2, Mishap::DoneUnanswered);
    for turn in 3..20 {
        unit.mishaps.insert(turn, Mishap::Silence);
    }
    let report = written(&mut unit, &table, &BOTH_GAINS);
    let [(_, first), (_, second)] = states(&report)[..] else { panic!("two rows") };
    assert!(matches!(first, RowState::Unverified { .. }), "{first:?}");
    assert!(matches!(second, RowState::NotSent { .. }), "{second:?}");
    assert!(report.ended_early.is_some());
    assert_eq!(unit.count(29), 0);
    let mut ram = table.default_image();
    report.merge_into(&mut ram);
    assert_eq!(ram.get("motor1.velocity.p"), None, "it may be either");
    assert_eq!(ram.get("motor2.velocity.p"), Some(SettingValue::Number(1.0)));
}

#[test]
fn a_link_lost_at_any_command_leaves_a_report_that_is_true() {
    let table = table("mcp266", Generation::Gen1);
    let changes = image(&table, &BOTH_GAINS);
    for turn in 0..6 {
        for mishap in [Mishap::LinkLost, Mishap::Stopped] {
            let mut unit = FakeUnit::new(&table);
            unit.mishaps.insert(turn, mishap);
            match write(&mut unit, &table, &changes, OPTIONS) {
                Err(WriteError::NotRead { failure }) => {
                    assert!(turn < 2, "{turn}: {failure}");
                    assert_eq!(unit.image(), FakeUnit::new(&table).image(), "nothing was written");
                }
                Err(error) => panic!("{turn}: {error}"),
                Ok(report) => {
                    assert!(turn >= 2 && report.ended_early.is_some());
                    for row in &report.rows {
                        let holds = unit.image().get(&row.key) == Some(row.wanted);
                        match row.state {
                            RowState::Taken => assert!(holds, "{turn}: {row:?}"),
                            RowState::NotSent { .. } | RowState::DidNotTake { .. } => {
                                assert!(!holds, "{turn}: {row:?}");
                            }
                            RowState::Unverified { .. } => {}
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_refused_value_leaves_the_controller_untouched() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    let wanted = image(&table, &[("motor1.velocity.p", "2"), ("motor1.current.max_amps", "80")]);
    let error = write(&mut unit, &table, &wanted, OPTIONS).expect_err("80 A is too much");
    assert_eq!(
        error.to_string(),
        "Nothing was written:\nMotor 1: maximum current 80.00 A is above the MCP266's 60.00 A."
    );
    assert!(unit.log.iter().all(|(command, _)| [55, 135].contains(command)), "{:?}", unit.log);
}

#[test]
fn a_neighbour_that_cannot_be_read_refuses_the_write_and_says_why() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = FakeUnit::new(&table);
    unit.silent.insert(55);
    let error = write(&mut unit, &table, &image(&table, &BOTH_GAINS), OPTIONS).expect_err("55 is silent");
    let reported = error.to_string();
    assert!(reported.contains("Motor 1: velocity P cannot be written, since"), "{reported}");
    assert!(
        reported.contains("Could not read M1 velocity PID (55) on 0x80 at the test: no answer within 20 ms"),
        "{reported}"
    );
    assert_eq!(unit.count(28) + unit.count(29), 0);
}

#[test]
fn a_new_address_is_followed_and_proven() {
    for generation in Generation::ALL {
        let table = table("mcp266", generation);
        let mut unit = FakeUnit::new(&table);
        let report = written(&mut unit, &table, &[("unit.address", "0x83"), ("motor1.velocity.p", "2")]);
        assert!(report.is_complete(), "{:?}", report.sentences(&table));
        assert_eq!(report.address.get(), 0x83);
        assert_eq!(
            unit.log.iter().position(|(command, _)| *command == 141),
            unit.log.iter().rposition(|(c, _)| *c == 141)
        );
        let address_at = unit.log.iter().position(|(command, _)| *command == 141);
        assert!(
            address_at > unit.log.iter().position(|(command, _)| *command == 28),
            "the address comes last"
        );
    }
}

#[test]
fn an_address_that_did_not_take_is_found_at_the_old_one() {
    for generation in [Generation::Gen1, Generation::Gen4] {
        let table = table("mcp266", generation);
        let mut unit = FakeUnit::new(&table);
        unit.stubborn.insert("unit.address".to_owned());
        let report = written(&mut unit, &table, &[("unit.address", "0x83")]);
        assert_eq!(
            report.sentences(&table),
            ["Packet serial address was to be 131 and is 128: the controller acknowledged it and did \
                 not take it."]
        );
        assert_eq!(report.address, crate::unit_address(Address::DEFAULT));
    }
}

#[test]
fn a_wire_that_cannot_follow_says_where_the_controller_went() {
    let table = table("mcp266", Generation::Gen4);
    let mut unit = FakeUnit::new(&table);
    unit.can_follow = false;
    let report = written(&mut unit, &table, &[("unit.address", "0x83")]);
    assert!(matches!(states(&report)[0].1, RowState::Unverified { .. }));
    assert!(
        report
            .warnings
            .iter()
            .any(|warning| *warning == "The controller is at 0x83 now; connect to it there.")
    );
}

#[test]
fn hidden_settings_reach_a_simulated_controller_only() {
    let table = table("mcp266", Generation::Gen1);
    let changes = image(&table, &[("unit.bridge_channels", "yes"), ("pin.2.low_pass", "6")]);
    let mut unit = FakeUnit::new(&table);
    let report = write(&mut unit, &table, &changes, OPTIONS).expect("it is simulated");
    assert!(report.is_complete(), "{:?}", report.sentences(&table));
    assert_eq!(unit.hidden.get(crate::unit_address(Address::DEFAULT), "unit.bridge_channels"), Some(1));
    assert_eq!(unit.hidden.get(crate::unit_address(Address::DEFAULT), "pin.2.low_pass"), Some(6));
    assert!(unit.log.is_empty(), "nothing of it goes over the wire");

    let mut real = FakeUnit::new(&table);
    real.simulated = false;
    let error = write(&mut real, &table, &changes, OPTIONS).expect_err("whatever the options say");
    assert!(error.to_string().contains("Bridge channels is not written."), "{error}");
}

#[test]
fn a_guess_about_the_wire_is_never_written_to_a_real_controller() {
    let table = table("mcp266", Generation::Gen1);
    for (key, text) in [("pin.1.min_action", "m1_off"), ("motor1.encoder.pin", "3")] {
        let mut real = FakeUnit::new(&table);
        real.simulated = false;
        let error =
            write(&mut real, &table, &image(&table, &[(key, text)]), OPTIONS).expect_err("it is a guess");
        assert!(matches!(error, WriteError::Refused { .. }));
        // What is not known is passed through unchanged with a neighbour of the same command.
        real.ram.insert("pin.1.min_action".to_owned(), 77);
        let neighbour = image(&table, &[("pin.1.deadband", "5")]);
        let report = write(&mut real, &table, &neighbour, OPTIONS).expect("the deadband is no guess");
        assert!(report.is_complete());
        assert_eq!(real.ram["pin.1.min_action"], 77);
    }
}
