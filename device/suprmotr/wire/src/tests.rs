//! The protocol against every example of the manual, against itself both ways, and against bytes that are none.

use crate::{
    Absent, Address, BadReport, COMMANDS, CONTRADICTIONS, Command, Effect, EncodeError, ErrorCode,
    LINE_BUFFER, Line, Mnemonic, Parsed, Progress, Radix, Reader, Received, Report, ReportForm, ReportLine,
    Reports, SELECT, Selection, Single, Source, Status, describe_line, describe_report, describe_single,
    echo_length, encode_report, motion, operation, parse_line, parse_listing, parse_report,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

const DECIMAL: Radix = Radix::Decimal;

fn budget(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(16), failure_persistence: None, ..Config::default() }
}

fn line(text: &str) -> Line {
    let parsed = parse_line(text.as_bytes(), DECIMAL);
    assert_eq!(parsed.error, None, "{text}");
    parsed.line
}

fn refused(text: &str) -> (u8, usize) {
    let error = parse_line(text.as_bytes(), DECIMAL).error.unwrap_or_else(|| panic!("{text} is taken"));
    (error.code.number(), error.at)
}

/// Every line of commands that the manual shows, with what it is as sent by a client.
const LINES: &[(&str, &str)] = &[
    // Compound Commands
    ("ma0,ws,mr500", "MA0,WS,MR500"),
    ("ma0,ws,mr2000,ws,rp10", "MA0,WS,MR2000,WS,RP10"),
    // Macro Commands
    ("MD3,MR1000,WS500,MR-1000,WS,RP5", "MD3,MR1000,WS500,MR-1000,WS,RP5"),
    ("MD1,MC2,MC3,MC4,MC5,MC6", "MD1,MC2,MC3,MC4,MC5,MC6"),
    // Address Selection, without the selections
    ("DV2000", "DV2000"),
    ("MR2000", "MR2000"),
    ("DP55,DI10,DL100,DP200", "DP55,DI10,DL100,DP200"),
    ("TG", "TG"),
    ("TT", "TT"),
    // Command Reference, section by section
    ("tp", "TP"),
    ("tt", "TT"),
    ("ud", "UD"),
    ("dv20000", "DV20000"),
    ("gv", "GV"),
    ("da200000", "DA200000"),
    ("ga", "GA"),
    ("dp80", "DP80"),
    ("GP", "GP"),
    ("di200", "DI200"),
    ("gi", "GI"),
    ("dL200", "DL200"),
    ("gL", "GL"),
    ("SM2000", "SM2000"),
    ("br0", "BR0"),
    ("rt", "RT"),
    ("ef", "EF"),
    ("en", "EN"),
    ("mn", "MN"),
    ("mf", "MF"),
    ("ab1", "AB1"),
    ("mr5000", "MR5000"),
    ("ma2000", "MA2000"),
    ("ma0,ws,ma2000,ws,rp99", "MA0,WS,MA2000,WS,RP99"),
    ("FE0", "FE0"),
    ("fe1", "FE1"),
    ("FE4", "FE4"),
    ("dh", "DH"),
    ("gh", "GH"),
    ("mr2000,ws500,ma0", "MR2000,WS500,MA0"),
    ("md1,ma0,ws,ma2000,ws", "MD1,MA0,WS,MA2000,WS"),
    ("mc1", "MC1"),
    ("tm1", "TM1"),
    ("rm", "RM"),
    ("rm1", "RM1"),
    ("so255", "SO255"),
    ("io2", "IO2"),
    // The manual prints mc2 in front, a slip.
    ("md2,io1,wa1,rp", "MD2,IO1,WA1,RP"),
    ("to", "TO"),
    ("ta", "TA"),
    ("ta1", "TA1"),
    ("ta2", "TA2"),
    ("tc", "TC"),
    ("tc1", "TC1"),
    ("cf 0", "CF0"),
    ("cf", "CF"),
    ("cf1", "CF1"),
    ("cn0", "CN0"),
    ("cn", "CN"),
    ("cn1", "CN1"),
    ("wn1,ma1000", "WN1,MA1000"),
    ("wn1,ma1000,wf1,ma0", "WN1,MA1000,WF1,MA0"),
    ("xn1,mr555,ws10", "XN1,MR555,WS10"),
    ("xn1,xn2,mr599,ws10", "XN1,XN2,MR599,WS10"),
    ("xn1,xn2,xf3,mr599,ws10", "XN1,XN2,XF3,MR599,WS10"),
    // Some examples
    ("DV10000,FE1,WS,DV500,FE4,WS,DH", "DV10000,FE1,WS,DV500,FE4,WS,DH"),
    ("MA0,WS500,MR500,WS100,RP49", "MA0,WS500,MR500,WS100,RP49"),
    ("MD2, EM10,EM11,EM12,MA,WS500,RP", "MD2,EM10,EM11,EM12,MA,WS500,RP"),
    ("MD10,MR20000,WS1,CN1,WA200,CF1", "MD10,MR20000,WS1,CN1,WA200,CF1"),
    ("MD11, MR500,WS100,RP9", "MD11,MR500,WS100,RP9"),
    ("MD11, MR+0000000500,WS+0000000100,RP+000000009", "MD11,MR500,WS100,RP9"),
    ("MD12, MR500,WS100,RP5", "MD12,MR500,WS100,RP5"),
    // Factory Settings
    ("DV20000", "DV20000"),
    ("DA200000", "DA200000"),
    ("DP75", "DP75"),
    ("DI0", "DI0"),
    ("DD0", "DD0"),
    ("DL100", "DL100"),
    ("SM10000", "SM10000"),
    ("EN", "EN"),
    ("LN", "LN"),
    ("LL", "LL"),
];

#[test]
fn every_line_of_the_manual_is_read_and_written() {
    for (manual, sent) in LINES {
        let read = line(manual);
        let bytes = read.encode(DECIMAL).unwrap();
        assert_eq!(String::from_utf8(bytes).unwrap(), format!("{sent}\r"), "{manual}");
        assert_eq!(line(sent), read);
    }
}

/// Every reply that the manual shows, with the line that asks for it and the number in it.
const NUMBERS: &[(&str, &str, i32)] = &[
    // Address Selection, with the addresses of their boards; Command Reference.
    ("TP", "5p0:+000300", 300),
    ("TP", "2p0:+0002300", 2300),
    ("TT", "5T:+0000000000", 0),
    ("TT", "1T:+0000000000", 0),
    ("TP", "0P0:+0000020002", 20_002),
    ("TT", "0T0:+0000020002", 20_002),
    ("GV", "0Y0:+0000020000", 20_000),
    ("GA", "0L0:+0000200000", 200_000),
    ("GA", "0A0:+0000200000", 200_000),
    ("GP", "0G0:+0000000080", 80),
    ("GI", "0I0:+0000000200", 200),
    ("GL", "0L0:+0000000200", 200),
    ("TO", "0o0:255", 255),
    // Controllers of the same kind report the letter alone.
    ("TP", "P:-0000020002", -20_002),
    ("GL", "M:+0000002000", 2000),
    ("GA", "AA0:+0000000001", 1),
    ("TB", "BB0:+0000000011", 11),
    ("GA", "A0: 7", 7),
];

fn done(asked: &str, sent: &[u8], text: &str) -> Report {
    let asked = line(asked).commands[0];
    match parse_report(&asked, DECIMAL, sent, text.as_bytes()) {
        Progress::Done { report, used } => {
            assert_eq!(used, text.len(), "{text:?}");
            report
        }
        other => panic!("{text:?}: {other:?}"),
    }
}

#[test]
fn every_reply_of_the_manual_is_read() {
    for (asked, reply, value) in NUMBERS {
        let report = done(asked, b"", &format!("{reply}\r\n\x03"));
        assert_eq!(report.number(line(asked).commands[0].mnemonic), Some(*value), "{reply}");
    }
    let analog = |asked, reply: &str| done(asked, b"", reply).lines;
    assert_eq!(
        analog("ta", "0A0: 127 230\r\n\x03"),
        [ReportLine::Analog { channel: 0, values: vec![127, 230] }]
    );
    assert_eq!(analog("ta1", "0A1 :127\r\n\x03"), [ReportLine::Analog { channel: 1, values: vec![127] }]);
    assert_eq!(analog("ta2", "0A2 :230\r\n\x03"), [ReportLine::Analog { channel: 2, values: vec![230] }]);
    assert_eq!(analog("tc", "0H0: 00 00\r\n\x03"), [ReportLine::Channels { outputs: 0, inputs: 0 }]);
    assert_eq!(
        analog("tc", "H: 8001 0102\r\n\x03"),
        [ReportLine::Channels { outputs: 0x8001, inputs: 0x0102 }]
    );
    assert_eq!(analog("tc1", "0H1: 1\r\n\x03"), [ReportLine::Channel { channel: 1, is_on: true }]);
    let listed = line("MD1,MR555,WS,GH");
    assert_eq!(analog("tm1", "mc1,mr555,ws,gh\r\n\x03"), [ReportLine::Macro(listed)]);
    assert_eq!(
        analog("tm", "MD11, MR+0000000500,WS+0000000100,RP+000000009\r\n\x03"),
        [ReportLine::Macro(line("MD11,MR500,WS100,RP9"))]
    );
    assert_eq!(analog("tz", "\r\n\x03"), [], "no macro 0");
}

#[test]
fn a_status_has_six_bytes_and_its_error_is_the_last() {
    let report = done("TS", b"", "0S:81 80 01 08 00 0A\r\n\x03");
    let status = report.status().unwrap();
    assert_eq!((report.address, status.bytes()), (Address::new(0), [0x81, 0x80, 0x01, 0x08, 0, 0x0A]));
    assert!(status.is_complete() && status.is_motor_on());
    assert_eq!(status.operation, operation::ECHO | operation::ADDRESSED);
    assert_eq!(ErrorCode::from_number(status.error), Some(ErrorCode::MacroOverflow));
    let five = done("TS", b"", "S:81 01 01 08 06\r\n\x03").status().unwrap();
    assert_eq!((five.mode, five.error, five.motion), (0, 6, motion::MOTOR_OFF));
    assert_eq!(
        describe_report(&report),
        "unit 0: status: Echo, Addressed, Trajectory complete, Limits on, Negative limit, error 0A (the macro is too long)"
    );
    for bad in ["0S:81 80\r\n\x03", "0S:81 80 01 08 00 0A 00\r\n\x03", "0S:181 80 01 08 00 0A\r\n\x03"] {
        let asked = Command::plain(Mnemonic::TS);
        assert!(matches!(parse_report(&asked, DECIMAL, b"", bad.as_bytes()), Progress::Bad(_)), "{bad}");
    }
}

#[test]
fn selections_are_those_of_the_manual() {
    let unit = Selection::Unit(Address::new(5).unwrap());
    assert_eq!(unit.bytes(), [0x01, 0x35]);
    assert_eq!(Selection::All.bytes(), [0x01, b'V']);
    let mut sent = unit.bytes().to_vec();
    sent.extend(line("TT").encode(DECIMAL).unwrap());
    assert_eq!(
        sent,
        [0x01, 0x35, 0x54, 0x54, 0x0D],
        "the manual's sequence, with the carriage return in hexadecimal"
    );
    for (character, address) in [(b'0', 0), (b'9', 9), (b'a', 10), (b'F', 15)] {
        assert_eq!(Selection::from_character(character), Selection::Unit(Address::new(address).unwrap()));
    }
    assert_eq!(Selection::from_character(b'v'), Selection::All);
    assert_eq!(Selection::from_character(b'G'), Selection::Nobody(b'G'));
    let four = Selection::from_character(b'4');
    assert!(!four.selects(Address::new(5).unwrap()) && Selection::All.selects(Address::new(5).unwrap()));
    assert_eq!((Address::new(16), Address::ALL.len()), (None, 16));
}

#[test]
fn the_table_has_every_command_of_the_manual_once() {
    let with_section = COMMANDS.iter().filter(|row| row.source == Source::Section).count();
    assert_eq!((COMMANDS.len(), with_section), (81, 44));
    for (number, row) in COMMANDS.iter().enumerate() {
        assert_eq!(usize::from(row.mnemonic.number()), number);
        assert_eq!(Mnemonic::from_number(row.mnemonic.number()), Some(row.mnemonic));
        let letters = [row.name.as_bytes()[0], row.name.as_bytes()[1]];
        assert_eq!(
            Mnemonic::from_letters(letters.map(|letter| letter.to_ascii_lowercase())),
            Some(row.mnemonic)
        );
        // What reports does nothing else.
        assert_eq!(row.reports != Reports::Nothing, row.effect == Effect::Report, "{}", row.name);
    }
    let ids = |mnemonic: Mnemonic| match mnemonic.row().reports {
        Reports::Number { id, .. } => char::from(id),
        _ => '-',
    };
    let letters = [
        (Mnemonic::TP, 'P'),
        (Mnemonic::TT, 'T'),
        (Mnemonic::TE, 'E'),
        (Mnemonic::TF, 'F'),
        (Mnemonic::TD, 'N'),
        (Mnemonic::TV, 'V'),
        (Mnemonic::TY, 'Y'),
        (Mnemonic::TL, 'A'),
        (Mnemonic::GP, 'G'),
        (Mnemonic::GI, 'I'),
        (Mnemonic::GD, 'D'),
        (Mnemonic::GL, 'L'),
        (Mnemonic::TI, 'X'),
        (Mnemonic::TB, 'B'),
        (Mnemonic::CS, 'C'),
        (Mnemonic::TJ, 'J'),
        (Mnemonic::TQ, 'Q'),
        (Mnemonic::GV, 'Y'),
        (Mnemonic::GA, 'A'),
    ];
    for (mnemonic, letter) in letters {
        assert_eq!(ids(mnemonic), letter, "{}", mnemonic.name());
    }
    let moves: Vec<_> = COMMANDS.iter().filter(|row| row.effect.may_move()).map(|row| row.name).collect();
    assert_eq!(moves, ["RT", "MN", "MR", "MA", "FE", "GH", "MC", "SQ", "SJ", "EM", "PH"]);
    assert_eq!(CONTRADICTIONS.len(), 32);
    assert!(CONTRADICTIONS.iter().enumerate().all(|(at, row)| usize::from(row.number) == at + 1));
}

#[test]
fn each_error_of_the_manual_is_found_where_it_is() {
    for (text, code, at) in [
        ("XX", 0x01, 0),
        ("DE100", 0x01, 0),
        ("TP,QQ", 0x01, 3),
        ("T", 0x01, 0),
        ("TP,MD1,TP", 0x01, 3),
        ("5TP", 0x02, 0),
        ("TP, $", 0x02, 4),
        ("MA0,,WS", 0x03, 4),
        ("MA0,", 0x03, 4),
        ("MD3", 0x03, 3),
        ("   ", 0x03, 3),
        ("DV-5", 0x04, 2),
        ("DP", 0x05, 2),
        ("MR,WS", 0x05, 2),
        ("DVX", 0x05, 2),
        ("MA-", 0x05, 3),
        ("DP256", 0x06, 2),
        ("MD15,TP", 0x06, 2),
        ("TA3", 0x06, 2),
        ("FE2", 0x06, 2),
        ("MA1073741824", 0x06, 2),
        ("MA99999999999999999999999", 0x06, 2),
        ("WN0", 0x07, 2),
        ("IO-256", 0x07, 2),
        ("MA-1073741824", 0x07, 2),
        ("MA5X", 0x08, 3),
        ("TP5", 0x08, 2),
    ] {
        assert_eq!(refused(text), (code, at), "{text}");
    }
    let long = vec!["MA5"; 16].join(",");
    assert_eq!(refused(&long), (0x09, 60));
    assert_eq!(refused(&format!("MD1,{long}")), (0x0A, 64));
    assert_eq!(parse_line(&long.as_bytes()[..59], DECIMAL).line.commands.len(), 15);
    assert_eq!(refused(&" ".repeat(LINE_BUFFER + 1)), (0x09, LINE_BUFFER));
    let Parsed { line: before, error } = parse_line(b"MA5,WS,DP300", DECIMAL);
    assert_eq!(
        (before, error.map(|error| error.to_string())),
        (line("MA5,WS"), Some("character 10: the number is too large".to_owned()))
    );
    assert_eq!(line("MA1073741823").commands, [Command::with(Mnemonic::MA, 1_073_741_823)]);
}

#[test]
fn what_a_controller_would_refuse_is_not_written() {
    let encode =
        |defines, commands: &[Command]| Line { defines, commands: commands.to_vec() }.encode(DECIMAL);
    let tp = Command::plain(Mnemonic::TP);
    assert_eq!(encode(None, &[]), Err(EncodeError::Empty), "a carriage return alone repeats the last line");
    assert_eq!(encode(Some(3), &[]), Err(EncodeError::Empty));
    assert_eq!(encode(None, &[tp; 16]), Err(EncodeError::TooManyCommands(16)));
    assert_eq!(encode(Some(15), &[tp]), Err(EncodeError::Macro(15)));
    assert_eq!(encode(None, &[Command::with(Mnemonic::MD, 1)]), Err(EncodeError::Definition));
    assert_eq!(encode(None, &[Command::with(Mnemonic::TP, 1)]), Err(EncodeError::TakesNone("TP")));
    assert_eq!(encode(None, &[Command::plain(Mnemonic::DP)]), Err(EncodeError::NeedsNumber("DP")));
    let range = EncodeError::Number { name: "DP", low: 0, high: 255, number: 256 };
    assert_eq!(encode(None, &[Command::with(Mnemonic::DP, 256)]), Err(range.clone()));
    assert_eq!(range.to_string(), "DP takes 0 to 255, not 256");
    assert!(encode(None, &[Command::with(Mnemonic::FE, 2)]).is_err());
}

#[test]
fn numbers_without_a_value_mean_what_the_manual_says() {
    let value = |text: &str| line(text).commands[0].value();
    assert_eq!(
        [value("RP"), value("WS"), value("MA"), value("AB"), value("TM")],
        [Some(65_535), Some(1000), Some(0), Some(0), Some(0)]
    );
    assert_eq!((value("RM"), value("RM0")), (None, Some(0)), "all, and macro 0");
}

#[test]
fn hexadecimal_counts_both_ways_and_from_within_a_line() {
    let hex = Radix::Hexadecimal;
    let parsed = parse_line(b"MA4E20,DPff,MR-10,DM,MA10", hex);
    let expected = line("MA20000,DP255,MR-16,DM,MA10");
    assert_eq!((&parsed.line, parsed.error), (&expected, None));
    assert_eq!(parse_line(expected.text(hex).as_bytes(), hex).line, expected);
    assert_eq!(expected.text(hex), "MA4E20,DPFF,MR-10,DM,MA10");
    assert_eq!(parse_line(b"HM,MAF", DECIMAL).line.commands[1].number, Some(15));
    let of = Mnemonic::TP;
    for (value, text) in [(20_000, "0P0:00004E20\r\n\x03"), (-1, "0P0:FFFFFFFF\r\n\x03")] {
        let bytes =
            encode_report(ReportForm::Full, hex, Address::FACTORY, &[ReportLine::Number { of, value }]);
        assert_eq!(bytes, text.as_bytes());
        let read = parse_report(&Command::plain(of), hex, b"", &bytes);
        let report =
            Report { address: Some(Address::FACTORY), lines: vec![ReportLine::Number { of, value }] };
        assert_eq!(read, Progress::Done { report, used: bytes.len() });
    }
    let signed = parse_report(&Command::plain(of), hex, b"", b"P:-0010\r\n\x03");
    assert!(matches!(signed, Progress::Done { report, .. } if report.number(of) == Some(-16)));
}

#[test]
fn a_macro_is_listed_as_the_manual_shows_it() {
    let text = "MD11, MR+0000000500,WS+0000000100,RP+0000000009";
    assert_eq!(line("MD11,MR500,WS100,RP9").listing(DECIMAL), text);
    assert_eq!(parse_listing(text, DECIMAL), Some(line("MD11,MR500,WS100,RP9")));
    assert_eq!(line("MD2,EM10,MA,RP").listing(DECIMAL), "MD2, EM+0000000010,MA,RP");
    assert_eq!(parse_listing("MR500,WS", DECIMAL), None, "no macro");
    assert_eq!(describe_line(&line("MD1,MR500,GH")), "define macro 1: Move Relative 500 counts, Go Home");
}

fn received(bytes: &[u8]) -> Vec<Received> {
    let mut reader = Reader::new();
    bytes.iter().filter_map(|byte| reader.feed(*byte, true)).collect()
}

#[test]
fn single_characters_are_taken_within_a_line_and_a_return_alone_repeats() {
    assert_eq!(
        received(b"MA'50%\r\r!\x08\n"),
        [
            Received::Single(Single::Position),
            Received::Single(Single::Status),
            Received::Line(b"MA50".to_vec()),
            Received::Repeat,
            Received::Single(Single::Abort),
            Received::Single(Single::EndMacro),
        ]
    );
    let five = Selection::Unit(Address::new(5).unwrap());
    assert_eq!(
        received(b"MA\x015TT\r\x01\x01\r"),
        [
            Received::Selection(five),
            Received::Line(b"TT".to_vec()),
            Received::Selection(Selection::Nobody(SELECT)),
            Received::Repeat
        ],
        "a selection drops the line before it"
    );
    let mut deselected = Reader::new();
    let taken: Vec<_> =
        b"MA50\r'!\x08\x015".iter().filter_map(|byte| deselected.feed(*byte, false)).collect();
    assert_eq!(taken, [Received::Single(Single::Abort), Received::Selection(five)], "`!` reaches everybody");
    for single in Single::ALL {
        assert_eq!(Single::from_character(single.character()), Some(single));
        assert!(!describe_single(single).is_empty());
    }
    let long = vec![b'A'; 10_000];
    let mut reader = Reader::new();
    assert!(long.iter().all(|byte| reader.feed(*byte, true).is_none()));
    let Some(Received::Line(kept)) = reader.feed(b'\r', true) else { panic!("a line") };
    assert_eq!(kept.len(), LINE_BUFFER + 1, "no more is kept than refuses it");
}

#[test]
fn an_echo_is_taken_off_whole_or_not_at_all() {
    let mut sent = Selection::Unit(Address::FACTORY).bytes().to_vec();
    sent.push(b'\'');
    for heard in ["0P0:+7\r\n\x03", "'0P0:+7\r\n\x03", "0'0P0:+7\r\n\x03", "\x010'P:+7\r\n\x03"] {
        assert_eq!(done("TP", &sent, heard).number(Mnemonic::TP), Some(7), "{heard:?}");
    }
    for heard in ["TP\r0P0:+7\r\n\x03", "TP\r\n0P0:+7\r\n\x03", "0P0:+7\r\n\x03"] {
        assert_eq!(done("TP", b"TP\r", heard).number(Mnemonic::TP), Some(7), "{heard:?}");
    }
    // A line that switches the echo off or on is echoed in part.
    for heard in ["EF\r0S:80 80 01 00 00 00\r\n\x03", "%0S:80 80 01 00 00 00\r\n\x03"] {
        assert_eq!(done("TS", b"\x010EF\r%", heard).status().unwrap().operation, operation::ADDRESSED);
    }
    assert_eq!(echo_length(b"MA5\r", b"MA5\r"), 4);
    assert_eq!(echo_length(b"MA5\r", b"MA5"), 0);
    assert_eq!(echo_length(b"", b"P:"), 0);
}

#[test]
fn two_controllers_that_answer_at_once_are_noticed() {
    let asked = Command::plain(Mnemonic::TG);
    let heard = b"0G0:+1\r\n1I0:+2\r\n0D0:+3\r\n0L0:+4\r\n\x03";
    let clash = BadReport::TwoUnits(Address::new(0).unwrap(), Address::new(1).unwrap());
    assert_eq!(parse_report(&asked, DECIMAL, b"", heard), Progress::Bad(clash.clone()));
    assert_eq!(clash.to_string(), "units 0 and 1 answered at once");
    let asked = Command::plain(Mnemonic::TP);
    let heard = b"01PP00::++00000000\r\r\n\n\x03";
    assert!(matches!(parse_report(&asked, DECIMAL, b"", heard), Progress::Bad(_)));
    let silent = parse_report(&Command::plain(Mnemonic::MF), DECIMAL, b"", b"0P0:+1\r\n\x03");
    assert_eq!(silent, Progress::Bad(BadReport::Silent("MF")));
    let endless = vec![b'0'; 9000];
    assert_eq!(parse_report(&asked, DECIMAL, b"", &endless), Progress::Bad(BadReport::Endless));
}

/// A command as a client may send it, with a number that it takes.
fn any_command() -> impl Strategy<Value = Command> {
    (0..COMMANDS.len(), any::<prop::sample::Index>(), any::<bool>()).prop_filter_map(
        "MD stands first",
        |(at, index, with)| {
            let row = &COMMANDS[at];
            if row.mnemonic == Mnemonic::MD {
                return None;
            }
            let number = row.takes.filter(|takes| with || takes.absent == Absent::Refused).map(|takes| {
                if takes.only.is_empty() {
                    let span = usize::try_from(i64::from(takes.high) - i64::from(takes.low) + 1).unwrap();
                    i32::try_from(i64::from(takes.low) + i64::try_from(index.index(span)).unwrap()).unwrap()
                } else {
                    takes.only[index.index(takes.only.len())]
                }
            });
            Some(Command { mnemonic: row.mnemonic, number })
        },
    )
}

fn any_question() -> impl Strategy<Value = Command> {
    let reporting: Vec<_> = COMMANDS.iter().filter(|row| row.reports != Reports::Nothing).collect();
    (prop::sample::select(reporting), any::<prop::sample::Index>(), any::<bool>()).prop_map(
        |(row, index, with)| {
            let number = row
                .takes
                .filter(|_| with)
                .map(|takes| i32::try_from(index.index(usize::try_from(takes.high).unwrap() + 1)).unwrap());
            Command { mnemonic: row.mnemonic, number }
        },
    )
}

fn any_line() -> impl Strategy<Value = Line> {
    let defines = prop::option::of(0..=crate::LAST_MACRO);
    (defines, prop::collection::vec(any_command(), 1..=crate::MOST_COMMANDS))
        .prop_map(|(defines, commands)| Line { defines, commands })
}

fn any_radix() -> impl Strategy<Value = Radix> {
    prop::sample::select(vec![Radix::Decimal, Radix::Hexadecimal])
}

/// A report that a controller may give to a command.
fn report_to(command: Command, value: i32, bytes: [u8; 6], listed: Line) -> Vec<ReportLine> {
    let asked = command.value().and_then(|value| u8::try_from(value).ok()).unwrap_or_default();
    let of = command.mnemonic;
    match command.row().reports {
        Reports::Nothing => Vec::new(),
        Reports::Number { .. } | Reports::Plain => vec![ReportLine::Number { of, value }],
        Reports::Status => vec![ReportLine::Status(Status::from_bytes(&bytes).unwrap())],
        Reports::Analog if asked == 0 => vec![ReportLine::Analog { channel: 0, values: bytes[..2].to_vec() }],
        Reports::Analog => vec![ReportLine::Analog { channel: asked, values: bytes[..1].to_vec() }],
        Reports::Channels if asked == 0 => {
            let word = |at: usize| u16::from_be_bytes([bytes[at], bytes[at + 1]]);
            vec![ReportLine::Channels { outputs: word(0), inputs: word(2) }]
        }
        Reports::Channels => vec![ReportLine::Channel { channel: asked, is_on: value % 2 == 0 }],
        Reports::Each(parts) => parts
            .iter()
            .flat_map(|part| report_to(Command::plain(*part), value, bytes, listed.clone()))
            .collect(),
        Reports::Text => vec![ReportLine::Text("SuprMotr V9".to_owned())],
        Reports::Macros => {
            vec![ReportLine::Macro(Line { defines: Some(listed.defines.unwrap_or(3)), ..listed })]
        }
    }
}

proptest! {
    #![proptest_config(budget(1000))]

    #[test]
    fn every_line_that_can_be_sent_is_read_as_it_was_meant(line in any_line(), radix in any_radix()) {
        match line.encode(radix) {
            Err(EncodeError::TooLong(characters)) => prop_assert!(characters > LINE_BUFFER),
            encoded => {
                let bytes = encoded.unwrap();
                prop_assert!(bytes.len() > 2 && bytes.iter().filter(|byte| **byte == b'\r').count() == 1);
                let found = received(&bytes);
                let [Received::Line(text)] = found.as_slice() else { panic!("{found:?}") };
                prop_assert_eq!(parse_line(text, radix), Parsed { line: line.clone(), error: None });
            }
        }
        if line.defines.is_some() && line.listing(radix).len() <= LINE_BUFFER {
            prop_assert_eq!(parse_listing(&line.listing(radix), radix), Some(line));
        }
    }

    #[test]
    fn every_report_is_read_in_each_form_with_echo_and_without(
        command in any_question(), value in any::<i32>(), bytes in any::<[u8; 6]>(), number in 0_u8..16, radix in any_radix(),
        with_echo in any::<bool>(), with_selection in any::<bool>(),
    ) {
        let address = Address::new(number).unwrap();
        let lines = report_to(command, value, bytes, line("MD3,MR500,WS,RP5"));
        let mut sent = if with_selection { Selection::Unit(address).bytes().to_vec() } else { Vec::new() };
        sent.extend(Line::of(command).encode(radix).unwrap());
        for form in ReportForm::ALL {
            let mut heard = if with_echo { sent.clone() } else { Vec::new() };
            heard.extend(encode_report(form, radix, address, &lines));
            for cut in 0..heard.len() {
                prop_assert_eq!(parse_report(&command, radix, &sent, &heard[..cut]), Progress::Incomplete);
            }
            let Progress::Done { report, used } = parse_report(&command, radix, &sent, &heard) else {
                panic!("{:?}", String::from_utf8_lossy(&heard))
            };
            prop_assert_eq!(used, heard.len());
            prop_assert_eq!(&report.lines, &lines);
            let has_address = form != ReportForm::Id
                && !matches!(command.row().reports, Reports::Text | Reports::Macros);
            prop_assert_eq!(report.address, has_address.then_some(address));
        }
    }
}

proptest! {
    #![proptest_config(budget(4000))]

    #[test]
    fn no_bytes_upset_a_reader_and_each_line_it_reads_is_bounded(bytes in prop::collection::vec(any::<u8>(), 0..600), radix in any_radix()) {
        for found in received(&bytes) {
            if let Received::Line(text) = found {
                let parsed = parse_line(&text, radix);
                prop_assert!(text.len() <= LINE_BUFFER + 1 && parsed.line.commands.len() <= crate::MOST_COMMANDS);
                prop_assert!(parsed.error.is_none_or(|error| error.at <= text.len()));
                // What was read can be written, and is then the same.
                if parsed.error.is_none() {
                    let again = parsed.line.text(radix);
                    prop_assert_eq!(parse_line(again.as_bytes(), radix).line, parsed.line);
                }
            }
        }
    }

    #[test]
    fn a_changed_line_is_refused_in_a_place_or_read_as_another(
        of in prop::sample::select(LINES.iter().map(|(_, sent)| *sent).collect::<Vec<_>>()),
        at in any::<prop::sample::Index>(), byte in any::<u8>(), radix in any_radix(),
    ) {
        let mut text = of.as_bytes().to_vec();
        let at = at.index(text.len());
        text[at] = byte;
        let parsed = parse_line(&text, radix);
        if let Some(error) = parsed.error {
            prop_assert!(error.at <= text.len());
        } else {
            prop_assert!(parsed.line.commands.iter().all(|command| command.check().is_ok()));
        }
    }

    #[test]
    fn no_bytes_upset_the_reading_of_a_report(
        command in any_command(), sent in prop::collection::vec(any::<u8>(), 0..8),
        of in prop::sample::select(NUMBERS.iter().map(|(_, reply, _)| *reply).collect::<Vec<_>>()),
        at in any::<prop::sample::Index>(), bytes in prop::collection::vec(any::<u8>(), 0..40), radix in any_radix(),
    ) {
        let mut heard = format!("{of}\r\n\x03").into_bytes();
        let at = at.index(heard.len());
        heard.splice(at..at, bytes);
        match parse_report(&command, radix, &sent, &heard) {
            Progress::Done { used, .. } => prop_assert!(used <= heard.len() && heard[used - 1] == 3),
            Progress::Bad(bad) => prop_assert!(!bad.to_string().is_empty()),
            Progress::Incomplete => prop_assert!(!heard.contains(&3)),
        }
    }
}
