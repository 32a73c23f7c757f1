//! Lines, single characters, errors and number forms (SuprMotr manual, "Communications").

use crate::SuprMotrConfig;
use brushwork_plant::machine::Machine;
use brushwork_suprmotr_wire::{Address, COMMANDS, ReportForm, operation};

use crate::tests::bench::Bench;

#[test]
fn letters_of_either_case_and_spaces_make_the_same_line() {
    let mut bench = Bench::new();
    for line in ["dv12000,tt", "DV 12000 , TT", " D V1 2000,tT "] {
        assert_eq!(bench.ask(line), "0T0:+0000000000\r\n\u{3}", "{line}");
    }
    assert_eq!(bench.number("gv"), 12_000);
}

#[test]
fn several_reports_of_a_line_come_one_after_the_other() {
    let mut bench = Bench::new();
    bench.begin("GP,GI");
    bench.ms(100);
    assert_eq!(bench.raw(b""), "0G0:+0000000075\r\n\u{3}0I0:+0000000000\r\n\u{3}");
}

#[test]
fn reports_of_several_lines_end_once() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.ask("TG"),
        "0G0:+0000000075\r\n0I0:+0000000000\r\n0D0:+0000000000\r\n0L0:+0000000100\r\n\u{3}"
    );
    let dump = bench.ask("DU");
    assert!(dump.starts_with("0T0:+0000000000\r\n0P0:+0000000000\r\n0N0:+0000000000\r\n0S:"), "{dump}");
    assert_eq!(dump.matches('\u{3}').count(), 1);
    let help = bench.ask("HE");
    assert!(COMMANDS.iter().all(|row| help.contains(row.name)), "{help}");
    assert!(bench.ask("VE").contains("SuprMotr V9"));
}

/// Every report of the table is answered, in every form, and reads as what was asked.
#[test]
fn every_command_that_reports_is_answered_in_every_form() {
    use brushwork_suprmotr_wire::{Command, Progress, Radix, Reports, parse_report};
    for form in ReportForm::ALL {
        let mut bench =
            Bench::of(SuprMotrConfig { reply_form: form, ..SuprMotrConfig::new(Address::FACTORY) });
        for row in COMMANDS.iter().filter(|row| row.reports != Reports::Nothing) {
            let command = Command {
                mnemonic: row.mnemonic,
                number: row.takes.and_then(|takes| takes.allows(1).then_some(1)),
            };
            let line = format!("{}\r", command.text(Radix::Decimal));
            bench.ms(20);
            let reply = bench.bus.exchange(line.as_bytes(), std::time::Duration::from_millis(5));
            match parse_report(&command, Radix::Decimal, line.as_bytes(), &reply) {
                Progress::Done { report, used } => {
                    assert_eq!(used, reply.len(), "{}", row.name);
                    let told =
                        form != ReportForm::Id && !matches!(row.reports, Reports::Text | Reports::Macros);
                    assert_eq!(report.address, told.then_some(Address::FACTORY), "{}", row.name);
                }
                other => panic!("{} in the form {}: {other:?}", row.name, form.key()),
            }
        }
    }
}

/// Every command without a report is taken with its least and its greatest number, silently.
#[test]
fn every_command_without_a_report_is_taken_in_silence() {
    use brushwork_suprmotr_wire::{Command, Mnemonic, Radix, Reports};
    for row in COMMANDS.iter().filter(|row| row.reports == Reports::Nothing && row.mnemonic != Mnemonic::MD) {
        let numbers = row.takes.map_or(vec![None], |takes| vec![Some(takes.low), Some(takes.high)]);
        for number in numbers {
            // A relative move is refused where it ends too far away, which a move forward before it makes it.
            let command = Command { mnemonic: row.mnemonic, number };
            let mut bench = Bench::new();
            // DB, EN and RT make it fall silent or loud by rights.
            bench.begin(&command.text(Radix::Decimal));
            bench.ms(200);
            bench.raw(b"\x01Vef\r");
            let status = bench.status();
            assert_eq!(status.error, 0, "{}", command.text(Radix::Decimal));
        }
    }
}

#[test]
fn a_carriage_return_alone_repeats_the_last_line() {
    let mut bench = Bench::new();
    bench.tell("MR100");
    bench.ms(500);
    let position = bench.unit().position();
    bench.tell("");
    assert_eq!(bench.number("TT"), position + 100);
    // Now the last line is TT.
    assert_eq!(bench.ask(""), bench.ask("TT"));
    // Neither a single character nor a selection comes before it.
    bench.raw(b"'");
    assert_eq!(bench.ask(""), bench.ask("TT"));
    bench.raw(b"\x010");
    assert_eq!(bench.ask(""), bench.ask("TT"));
}

#[test]
fn before_the_first_line_a_carriage_return_has_nothing_to_repeat() {
    let mut bench = Bench::line(vec![SuprMotrConfig::new(Address::FACTORY)]);
    bench.raw(b"\x010\r");
    let status = bench.raw(b"%");
    // The echo of the question, echo on, selected, zeros kept, an error: 03.
    assert_eq!(status, "%0S:A5 80 01 04 00 03\r\n\u{3}");
}

#[test]
fn each_error_is_told_by_the_status_once() {
    let mut bench = Bench::new();
    let long = "CN1,".repeat(70);
    for (line, number) in [
        ("QQ", 0x01),
        ("DE100", 0x01),
        ("CN1,MD1,CN2", 0x01),
        ("1MA", 0x02),
        ("MA5,,MA6", 0x03),
        ("DV-5", 0x04),
        ("DV", 0x05),
        ("DVX", 0x05),
        ("DP256", 0x06),
        ("MC15", 0x06),
        ("FE3", 0x06),
        ("TA3", 0x06),
        ("MA1073741824", 0x06),
        ("MA-1073741824", 0x07),
        ("WN0", 0x07),
        ("CN1 CN2", 0x08),
        (long.as_str(), 0x09),
    ] {
        bench.tell(line.trim_end_matches(','));
        let status = bench.status();
        assert_eq!(
            (status.error, status.operation & operation::COMMAND_ERROR),
            (number, operation::COMMAND_ERROR),
            "{line}"
        );
        let status = bench.status();
        assert_eq!(
            (status.error, status.operation & operation::COMMAND_ERROR),
            (0, 0),
            "{line}: it is told once"
        );
    }
}

#[test]
fn an_error_makes_the_light_blink_until_the_status_is_read() {
    let mut bench = Bench::new();
    let is_lit = |bench: &Bench| bench.unit().view().leds.expect("it has power").err;
    assert!(!is_lit(&bench));
    bench.tell("QQ");
    assert!(is_lit(&bench));
    bench.ask("TS");
    assert!(!is_lit(&bench));
}

#[test]
fn a_move_beyond_the_furthest_place_is_refused_where_it_is_asked_for() {
    let mut bench = Bench::new();
    bench.tell("MA1000");
    bench.ms(500);
    bench.tell("MR1073741823");
    assert_eq!((bench.status().error, bench.number("TT")), (0x06, 1_000));
    bench.tell("MA-1000");
    bench.ms(500);
    bench.tell("MR-1073741823");
    assert_eq!((bench.status().error, bench.number("TT")), (0x07, -1_000));
}

#[test]
fn commands_before_a_mistake_are_done() {
    let mut bench = Bench::new();
    bench.tell("CN1,QQ,CN2");
    assert_eq!(bench.unit().outputs(), 1);
}

#[test]
fn every_character_comes_back_while_the_echo_is_on() {
    let mut bench = Bench::new();
    bench.tell("EN");
    assert_eq!(bench.ask("dv 5000"), "dv 5000\r");
    assert_eq!(bench.ask("GV"), "GV\r0Y0:+0000005000\r\n\u{3}");
    assert_eq!(bench.raw(b"'"), "'0P0:+0000000000\r\n\u{3}");
    assert_eq!(bench.raw(b"\x010"), "\u{1}0");
    assert_eq!(bench.raw(b"\x015GV\r"), "", "what it is not selected for does not come back");
    assert_eq!(bench.raw(b"\x010EF\r"), "\u{1}0EF\r");
    assert_eq!(bench.ask("GV"), "0Y0:+0000005000\r\n\u{3}");
}

#[test]
fn line_feeds_and_ends_of_text_are_passed_over() {
    let mut bench = Bench::new();
    assert_eq!(bench.raw(b"G\nV\x03\r\n"), "0Y0:+0000020000\r\n\u{3}");
    assert_eq!(bench.raw(b"\n\x03\r"), "0Y0:+0000020000\r\n\u{3}", "they come before no carriage return");
}

#[test]
fn numbers_are_hexadecimal_after_hm() {
    let mut bench = Bench::new();
    bench.tell("HM");
    bench.tell("MA1F4");
    bench.ms(500);
    assert_eq!(bench.ask("TT"), "0T0:000001F4\r\n\u{3}");
    assert_eq!(bench.status().operation & operation::HEXADECIMAL, operation::HEXADECIMAL);
    bench.tell("MA-A");
    assert_eq!(bench.ask("TT"), "0T0:FFFFFFF6\r\n\u{3}");
    bench.tell("DM");
    assert_eq!(bench.ask("TT"), "0T0:-0000000010\r\n\u{3}");
}

#[test]
fn other_settings_come_back_as_they_were_set() {
    let mut bench = Bench::new();
    bench.tell("DP1,DI2,DD3,DL4,SJ-5");
    let numbers: Vec<i64> = ["GP", "GI", "GD", "GL", "TJ"].iter().map(|line| bench.number(line)).collect();
    assert_eq!(numbers, [1, 2, 3, 4, -5]);
}

#[test]
fn an_unplugged_cable_carries_nothing() {
    use brushwork_plant::world::WorldAction;
    let mut bench = Bench::new();
    bench.bus.apply(0, &WorldAction::Unplug { unplugged: true });
    assert_eq!(bench.ask("TP"), "");
    bench.bus.apply(0, &WorldAction::Unplug { unplugged: false });
    assert_eq!(bench.ask("TP"), "0P0:+0000000000\r\n\u{3}");
}
