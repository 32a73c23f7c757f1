//! The client against units made of the wire's table, in virtual time.

mod bench;
mod settings;

use crate::{COMPUTED_TARGET, COMPUTED_VELOCITY, SuprMotrFacts};
use bench::{Link, Unit};
use brushwork_link::device::controller::Search;
use brushwork_link::device::{Addresses, Channel, DeviceOptions};
use brushwork_link::{ArmScope, Drive, DriveCommand, Event, Identity, PollRate, Request};
use brushwork_suprmotr_wire::{
    COMMANDS, Line, Mnemonic, Radix, Received, ReportForm, Selection, Single, parse_line,
};
use brushwork_values::{Motor, Value};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use std::time::Duration;

fn scan() -> DeviceOptions {
    DeviceOptions { poll: PollRate::Off, ..DeviceOptions::default() }
}

fn found(link: &Link) -> Vec<&Identity> {
    let mut found = Vec::new();
    for event in &link.events {
        if let Event::Connected(identity) = event {
            found.push(identity);
        }
    }
    found
}

fn move_to(position_counts: i32) -> Request {
    let there = DriveCommand::Position {
        position_counts,
        speed_counts_per_s: 0,
        accel_counts_per_s2: 0,
        decel_counts_per_s2: 0,
        queued: false,
    };
    Request::Drive(Drive::one(Motor::M1, there))
}

fn move_by(distance: i64) -> Request {
    let by = DriveCommand::Distance {
        speed_counts_per_s: if distance < 0 { -1 } else { 1 },
        accel_counts_per_s2: None,
        distance_counts: u32::try_from(distance.unsigned_abs()).unwrap(),
        queued: false,
    };
    Request::Drive(Drive::one(Motor::M1, by))
}

fn transact(mnemonic: Mnemonic, values: &[i64]) -> Request {
    let values = values.iter().map(|value| Value::Int(*value)).collect();
    Request::Transact { id: 1, command: mnemonic.number(), values }
}

fn raw(bytes: &[u8]) -> Request {
    Request::Raw { id: 2, bytes: bytes.to_vec() }
}

#[test]
fn units_are_found_in_every_form_of_report_by_characters_alone() {
    for form in ReportForm::ALL {
        for (echo, radix) in [(true, Radix::Decimal), (false, Radix::Decimal), (true, Radix::Hexadecimal)] {
            let make = |address| Unit { form, echo, radix, ..Unit::new(address) };
            let link = Link::open(vec![make(0), make(3), make(15)], None, scan());
            let places: Vec<_> = found(&link).iter().map(|unit| unit.place()).collect();
            assert_eq!(places, ["unit 0", "unit 3", "unit F"], "{form:?} {echo} {radix:?}");
            assert!(link.lines().is_empty() && !link.bus().written.contains(&b'\r'));
            let facts = SuprMotrFacts::of(found(&link)[0]).unwrap();
            assert_eq!((facts.has_echo(), facts.radix()), (echo, radix));
        }
    }
    let written = Link::open(vec![Unit::new(0)], None, scan());
    assert!(written.bus().written.starts_with(b"\x010'\x011'\x012'"), "each address once, and a character");
}

#[test]
fn a_line_at_another_rate_is_found_and_one_without_units_keeps_its_own() {
    let at = |baud| Link::open(vec![Unit::new(2)], Some(baud), scan());
    let slow = at(9600);
    assert!(slow.bus().rates.is_empty() && found(&slow).len() == 1);
    let fast = at(38_400);
    assert_eq!(fast.bus().rates, [19_200, 38_400]);
    let notes: Vec<_> = found(&fast)[0].notes.iter().map(ToString::to_string).collect();
    assert_eq!(notes, ["It answers at 38400 baud."]);
    let none = Link::open(Vec::new(), None, DeviceOptions { addresses: Addresses::Only(5), ..scan() });
    assert_eq!(none.bus().rates, [19_200, 38_400, 9600], "the line is left as it was");
    assert!(none.sentences().contains("no position came from the address 5"), "{}", none.sentences());
}

#[test]
fn polling_leaves_a_macro_alone_and_marks_what_is_computed() {
    let unit = Unit { runs: true, target: 50_000, ..Unit::new(0) };
    let options =
        DeviceOptions { poll: PollRate::Every(Duration::from_millis(50)), ..DeviceOptions::default() };
    let mut link = Link::open(vec![unit], None, options);
    link.run_for(Duration::from_secs(1));
    assert!(link.bus().units[0].runs && link.lines().is_empty());
    let samples: Vec<_> = link
        .events
        .iter()
        .filter_map(|event| if let Event::Sample(sample) = event { Some(sample) } else { None })
        .collect();
    let last = samples.last().unwrap();
    let (target, error) = (last.get(COMPUTED_TARGET), last.get(Channel::M1_POSITION_ERROR));
    assert_eq!((error, target), (Some(12.0), last.get(Channel::M1_POSITION).map(|position| position + 12.0)));
    let velocity = last.get(COMPUTED_VELOCITY).unwrap();
    assert!((velocity - 10_000.0).abs() < 500.0, "{velocity}");
    let facts = found(&link)[0].notes.iter().map(ToString::to_string).collect::<String>();
    assert!(facts.contains("a line, as for reading the settings, would end it"), "{facts}");
    link.ask(transact(Mnemonic::GP, &[]));
    assert!(link.sentences().contains("which GP would end; stop it first"), "{}", link.sentences());
    assert!(link.bus().units[0].runs, "so it was not sent");
    link.ask(transact(Mnemonic::TP, &[]));
    assert!(link.bus().units[0].runs, "by its character");
}

#[test]
fn a_stop_is_the_character_that_all_units_hear_on_both_sides_of_the_end_of_macros() {
    let mut link = Link::to(Unit { runs: true, target: 900_000, ..Unit::new(7) });
    link.forget();
    link.handle.stop_all();
    link.settle();
    let abort = Received::Single(Single::Abort);
    let selection = Received::Selection(Selection::from_character(b'7'));
    assert_eq!(link.written()[..4], [abort.clone(), selection, Received::Single(Single::EndMacro), abort]);
    let before_any_is_known = crate::SuprMotrs::new().stop_bytes(Addresses::Scan);
    assert_eq!(before_any_is_known.concat(), b"!\x01V\x08!");
    assert!(link.lines().is_empty(), "a loop that holds is left on");
    let report = link
        .events
        .iter()
        .find_map(|event| if let Event::Stopped(report) = event { Some(report) } else { None });
    let report = report.unwrap();
    assert!(report.confirmed() && !report.left_a_loop_off());
    assert!(!link.bus().units[0].runs && link.bus().units[0].target < 100_000);
}

#[test]
fn a_loop_that_shakes_its_motor_is_switched_off_and_the_next_arming_switches_it_on_where_it_stands() {
    let mut link = Link::to(Unit { shakes: true, target: 900_000, ..Unit::new(0) });
    link.handle.stop_all();
    link.settle();
    assert_eq!(link.lines(), ["MF"]);
    let left_off = |link: &Link| {
        link.events.iter().any(|event| matches!(event, Event::Stopped(report) if report.left_a_loop_off()))
    };
    assert!(left_off(&link));
    link.bus().units[0].shakes = false;
    link.forget();
    link.ask(Request::Arm(ArmScope::Position));
    assert_eq!(link.lines(), ["AB0", "TT", "TP", "MN"]);
    assert!(link.sentences().contains("It was switched on again where it stands"), "{}", link.sentences());
}

#[test]
fn a_motor_that_would_jump_to_its_old_target_is_not_switched_on() {
    let mut link = Link::to(Unit { is_motor_on: false, keeps_target: true, target: 5000, ..Unit::new(0) });
    link.ask(Request::Arm(ArmScope::Position));
    let told = link.sentences();
    assert!(told.contains("5000 counts from its target: switched on (MN) it would jump there"), "{told}");
    assert!(!link.lines().contains(&"MN".to_owned()) && !link.bus().units[0].is_motor_on);
}

#[test]
fn arming_tells_what_ends_a_move_and_refuses_beside_a_macro() {
    let mut link = Link::to(Unit::new(0));
    link.ask(Request::Arm(ArmScope::Position));
    let told = link.sentences();
    assert!(told.contains("no serial time-out") && told.contains("the limit switches, and a lag"), "{told}");
    let mut off = Link::to(Unit { limits: 0, ..Unit::new(0) });
    off.ask(Request::Arm(ArmScope::Position));
    assert!(off.sentences().contains("switched off (LF)"), "{}", off.sentences());
    let mut running = Link::to(Unit { runs: true, ..Unit::new(0) });
    running.ask(Request::Arm(ArmScope::Position));
    assert!(running.sentences().contains("Stop ends macros and repeated lines"), "{}", running.sentences());
}

#[test]
fn a_distance_goes_out_as_the_place_where_it_ends() {
    let mut link = Link::to(Unit { from: 300.0, target: 300, ..Unit::new(0) });
    link.ask(move_by(-1000));
    assert!(link.lines().is_empty(), "not armed: {}", link.sentences());
    link.ask(Request::Arm(ArmScope::Position));
    link.forget();
    link.ask(move_by(-1000));
    link.ask(move_to(20_000));
    assert_eq!(link.lines(), ["MA-700", "MA20000"]);
    let driven = link.events.iter().filter(|event| matches!(event, Event::Driven { .. })).count();
    assert_eq!(driven, 2);
}

#[test]
fn a_move_that_the_controller_cannot_make_is_a_sentence() {
    let mut link = Link::to(Unit { from: 1_000_000_000.0, target: 1_000_000_000, ..Unit::new(0) });
    link.ask(Request::Arm(ArmScope::Position));
    link.ask(move_to(1_073_741_824));
    link.ask(move_by(100_000_000));
    let told = link.sentences();
    assert!(told.contains("the target would be 1073741824 counts from 0"), "{told}");
    assert!(told.contains("the target would be 1100000000 counts from 0"), "{told}");
    assert!(link.lines().is_empty());
    // A relative move is the user's own at the terminal; what the controller makes of it is told by its status.
    link.ask(transact(Mnemonic::MR, &[100_000_000]));
    assert!(link.sentences().contains("error 06: the number is too large"), "{}", link.sentences());
    let duty = Drive::one(Motor::M1, DriveCommand::duty(0.5));
    let said = found(&Link::to(Unit::new(0)))[0].objection(&duty).unwrap();
    assert_eq!(said, "a SuprMotr takes moves and nothing else: a position or a distance");
}

#[test]
fn typed_bytes_go_out_as_one_whole_line_to_this_unit_or_not_at_all() {
    let mut link = Link::to(Unit::new(4));
    for (typed, told) in [
        (&b"\r"[..], "repeats the last line"),
        (b"TP\r\r", "repeats the last line"),
        (b"TP", "one whole line goes out"),
        (b"TP\rTT\r", "one whole line goes out"),
        (b"\x01V", "a selection of other units"),
        (b"MR100\r", "not armed"),
    ] {
        link.forget();
        link.ask(raw(typed));
        assert!(link.sentences().contains(told), "{typed:?}: {}", link.sentences());
        assert!(link.bus().written.is_empty(), "{typed:?}");
    }
    link.forget();
    link.ask(raw(b"tp, tt\r"));
    let heard = link.events.iter().find_map(|event| match event {
        Event::RawReply { result: Ok(bytes), .. } => Some(String::from_utf8(bytes.clone()).unwrap()),
        _ => None,
    });
    assert_eq!(heard.unwrap(), "tp, tt\r4P0:+0000000000\r\n\u{3}4T0:+0000000000\r\n\u{3}");
    link.forget();
    link.ask(raw(b"MD3,MR1000,WS500\r"));
    assert_eq!(link.bus().units[0].macros.len(), 1, "{}", link.sentences());
}

#[test]
fn the_screen_of_macros_runs_macros_when_armed_and_moves_nothing_else() {
    let mut link = Link::to(Unit::new(0));
    link.ask(raw(b"MC1\r"));
    assert!(link.sentences().contains("not armed") && link.lines().is_empty(), "{}", link.sentences());
    link.ask(Request::Arm(ArmScope::Script));
    link.forget();
    for moves in [&b"MR100\r"[..], b"MC1,MR100\r", b"MN\r"] {
        link.ask(raw(moves));
    }
    assert!(link.lines().is_empty(), "{:?}", link.lines());
    link.ask(raw(b"MC1\r"));
    assert_eq!(link.lines(), ["MC1"]);
}

/// What a user may ask for, in any order.
#[derive(Clone, Debug)]
enum Act {
    Transact(usize, Option<i64>),
    Raw(Vec<u8>),
    MoveTo(i32),
    MoveBy(i32),
    Arm,
    Disarm,
    Stop,
    Zero,
    Pass(u64),
}

fn any_act() -> impl Strategy<Value = Act> {
    let typed = prop_oneof![
        prop::collection::vec(any::<u8>(), 0..12),
        prop::sample::select(vec![
            "\r", "MR5\r", "TP\r\r", "'%", "\x010\r", "MR9,WS\r", ",\r", " \r", "MC1\r"
        ])
        .prop_map(|text| text.as_bytes().to_vec()),
    ];
    prop_oneof![
        4 => (0..COMMANDS.len() + 20, prop::option::of(-2_i64..300)).prop_map(|(at, value)| Act::Transact(at, value)),
        3 => typed.prop_map(Act::Raw),
        1 => any::<i32>().prop_map(Act::MoveTo),
        1 => any::<i32>().prop_map(Act::MoveBy),
        2 => Just(Act::Arm),
        1 => Just(Act::Disarm),
        1 => Just(Act::Stop),
        1 => Just(Act::Zero),
        1 => (1_u64..200).prop_map(Act::Pass),
    ]
}

fn request(act: Act) -> Option<Request> {
    Some(match act {
        Act::Transact(at, value) => Request::Transact {
            id: 1,
            command: u8::try_from(at).unwrap_or_else(|_| panic!("{at}")).max(if at >= COMMANDS.len() {
                0x80
            } else {
                0
            }),
            values: value.into_iter().map(Value::Int).collect(),
        },
        Act::Raw(bytes) => Request::Raw { id: 2, bytes },
        Act::MoveTo(counts) => move_to(counts),
        Act::MoveBy(counts) => move_by(counts.into()),
        Act::Arm => Request::Arm(ArmScope::CommandLine),
        Act::Disarm => Request::Disarm,
        Act::Zero => Request::ZeroEncoders,
        Act::Stop | Act::Pass(_) => return None,
    })
}

proptest! {
    #![proptest_config(Config { cases: 150, rng_seed: RngSeed::Fixed(9), failure_persistence: None, ..Config::default() })]

    /// Whatever is asked for, in whatever order and in whichever form the unit answers: no carriage return ever stands alone, no move by a distance
    /// is sent but by who typed it, and a line that moves goes out only while something is armed.
    #[test]
    fn no_carriage_return_of_the_link_ever_repeats_a_line(
        acts in prop::collection::vec(any_act(), 1..14), form in prop::sample::select(ReportForm::ALL.to_vec()),
        echo in any::<bool>(), runs in any::<bool>(),
    ) {
        let mut link = Link::to(Unit { form, echo, runs, ..Unit::new(0) });
        let mut may_type = Vec::new();
        for act in acts {
            if let Act::Raw(bytes) = &act {
                may_type.push(bytes.clone());
            }
            match act {
                Act::Stop => link.handle.stop_all(),
                Act::Pass(ms) => link.run_for(Duration::from_millis(ms)),
                other => link.handle.request(request(other).unwrap()).unwrap(),
            }
            link.settle();
        }
        for found in link.written() {
            match found {
                Received::Repeat => panic!("{:?}", String::from_utf8_lossy(&link.bus().written)),
                Received::Line(text) => {
                    let Line { defines, commands } = parse_line(&text, Radix::Decimal).line;
                    let is_typed = may_type.iter().any(|typed| typed.windows(text.len()).any(|part| part == text));
                    prop_assert!(is_typed || !commands.is_empty() && defines.is_none());
                }
                Received::Selection(selection) => {
                    let own = Selection::from_character(b'0');
                    prop_assert!(selection == own || selection == Selection::All || link_scans(selection));
                }
                Received::Single(_) => {}
            }
        }
    }
}

/// The search selects every address in turn.
fn link_scans(selection: Selection) -> bool {
    matches!(selection, Selection::Unit(_))
}
