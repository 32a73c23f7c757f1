//! The two protocols of the Motion Mind 3 against the bytes and lines of its manual, and against bytes that are none.

use std::time::Duration;

use crate::{
    Address, BadReply, Command, EncodeError, FrameEvent, FrameReader, LineEvent, LineReader, Part, Progress,
    REGISTERS, Reply, Returned, Returns, checksum, encode_frame, encode_frame_reply, encode_line,
    encode_line_reply, parse_frame_reply, parse_line_reply, register,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

const UNIT_1: Address = Address::FACTORY;

/// Commands of the manual's chapter 5 with their bytes: command, address, data least significant byte first, checksum.
const FRAMES: &[(Command, &[u8])] = &[
    // 5.1.1: -10000 is 0xFFFFD8F0.
    (Command::MoveToAbsolute(-10_000), &[0x15, 0x01, 0xF0, 0xD8, 0xFF, 0xFF, 0xDC]),
    // 5.2.1
    (Command::ChangeSpeed(128), &[0x14, 0x01, 0x80, 0x00, 0x95]),
    (Command::MoveToAbsolute(1000), &[0x15, 0x01, 0xE8, 0x03, 0x00, 0x00, 0x01]),
    // 5.3.1; the decimal row prints the checksum 0x12 = 18 as 12.
    (Command::ChangeSpeed(763), &[0x14, 0x01, 0xFB, 0x02, 0x12]),
    // 5.4.1
    (Command::MoveToAbsolute(-100_046), &[0x15, 0x01, 0x32, 0x79, 0xFE, 0xFF, 0xBE]),
    // 5.5.1
    (Command::MoveToRelative(100_000), &[0x16, 0x01, 0xA0, 0x86, 0x01, 0x00, 0x3E]),
    // 5.6.1
    (Command::MoveAtVelocity(-200), &[0x17, 0x01, 0x38, 0xFF, 0x4F]),
    // 5.7.1: the register's index stands between address and data, and tells the width.
    (Command::Write { register: 0, value: -10_000 }, &[0x18, 0x01, 0x00, 0xF0, 0xD8, 0xFF, 0xFF, 0xDF]),
    (Command::Write { register: 1, value: 100 }, &[0x18, 0x01, 0x01, 0x64, 0x00, 0x7E]),
    (Command::Write { register: 2, value: 128 }, &[0x18, 0x01, 0x02, 0x80, 0x9B]),
    // 5.8.1
    (Command::WriteStore { register: 0, value: -10_000 }, &[0x19, 0x01, 0x00, 0xF0, 0xD8, 0xFF, 0xFF, 0xE0]),
    (Command::WriteStore { register: 1, value: 100 }, &[0x19, 0x01, 0x01, 0x64, 0x00, 0x7F]),
    (Command::WriteStore { register: 2, value: 128 }, &[0x19, 0x01, 0x02, 0x80, 0x9C]),
    // 5.9.1: registers 2, 8, 19 and 20 are bits 2 and 8, and bits 3 and 4 of the third byte.
    (Command::Read(0x0018_0104), &[0x1A, 0x01, 0x04, 0x01, 0x18, 0x00, 0x38]),
    (Command::Read(1), &[0x1A, 0x01, 0x01, 0x00, 0x00, 0x00, 0x1C]),
    // 5.10.1
    (Command::ReadRegister(1), &[0x1D, 0x01, 0x01, 0x1F]),
    (Command::ReadRegister(0), &[0x1D, 0x01, 0x00, 0x1E]),
    // 5.11.1, 5.12.1
    (Command::Restore, &[0x1B, 0x01, 0x1C]),
    (Command::Reset, &[0x1C, 0x01, 0x1D]),
    // Not in the manual, computed by its rules.
    (Command::Read(u32::MAX), &[0x1A, 0x01, 0xFF, 0xFF, 0xFF, 0xFF, 0x17]),
    (Command::Read(0x0001_0001), &[0x1A, 0x01, 0x01, 0x00, 0x01, 0x00, 0x1D]),
    (Command::ChangeSpeed(-512), &[0x14, 0x01, 0x00, 0xFE, 0x13]),
    // SATPROT, ACTIVESTOP, ENABLEDB
    (Command::Write { register: 3, value: 0x0890 }, &[0x18, 0x01, 0x03, 0x90, 0x08, 0xB4]),
    // FREQX2, ADX8
    (Command::WriteStore { register: 30, value: 0x0012 }, &[0x19, 0x01, 0x1E, 0x12, 0x00, 0x4A]),
    (Command::Write { register: 28, value: 512 }, &[0x18, 0x01, 0x1C, 0x00, 0x02, 0x37]),
    (Command::Write { register: 23, value: -123_456 }, &[0x18, 0x01, 0x17, 0xC0, 0x1D, 0xFE, 0xFF, 0x0A]),
    (Command::ReadRegister(27), &[0x1D, 0x01, 0x1B, 0x39]),
    // 3.11: -1 is eight times F.
    (Command::MoveToAbsolute(-1), &[0x15, 0x01, 0xFF, 0xFF, 0xFF, 0xFF, 0x12]),
];

/// Replies with the commands and return bits they answer.
fn frame_replies() -> Vec<(Command, Returns, Reply, &'static [u8])> {
    let none = Returns::default();
    let position = Returns { position: true, ..none };
    let all = Returns { position: true, velocity: true, time: true };
    let returned = Returned { position: Some(-10_000), velocity: Some(121), time: Some(23_986) };
    vec![
        (Command::ChangeSpeed(128), none, Reply::Acknowledged, &[0x06]),
        // 5.2.1 says "MSB first", its example is least significant byte first; the sum includes the address.
        (
            Command::MoveToAbsolute(1000),
            position,
            Reply::Returned(Returned { position: Some(1000), velocity: None, time: None }),
            &[0x01, 0xE8, 0x03, 0x00, 0x00, 0xEC],
        ),
        (
            Command::MoveToAbsolute(1000),
            all,
            Reply::Returned(returned),
            // address, position, velocity 121, time 23986, checksum
            &[0x01, 0xF0, 0xD8, 0xFF, 0xFF, 0x79, 0x00, 0xB2, 0x5D, 0x00, 0x00, 0x4F],
        ),
        // Figure 20: a write is acknowledged plainly whatever the return bits.
        (Command::Write { register: 2, value: 128 }, all, Reply::Acknowledged, &[0x06]),
        (Command::Read(1), none, Reply::Registers(vec![(0, 20_000)]), &[0x01, 0x20, 0x4E, 0x00, 0x00, 0x6F]),
        (Command::ReadRegister(1), all, Reply::Registers(vec![(1, 1023)]), &[0x01, 0xFF, 0x03, 0x03]),
        (
            Command::ReadRegister(0),
            none,
            Reply::Registers(vec![(0, 20_000)]),
            &[0x01, 0x20, 0x4E, 0x00, 0x00, 0x6F],
        ),
        (
            Command::Read(0x0018_0104),
            none,
            Reply::Registers(vec![(2, 128), (8, 14), (19, 512), (20, 256)]),
            &[0x01, 0x80, 0x0E, 0x00, 0x02, 0x00, 0x01, 0x92],
        ),
    ]
}

/// Lines of chapter 5 with the commands they are.
const LINES: &[(Command, &str)] = &[
    (Command::MoveToAbsolute(-10_000), "P01 -10000\r\n"),
    (Command::Write { register: 1, value: 120 }, "W01 01 120\r\n"),
    (Command::ChangeSpeed(763), "C01 763\r\n"),
    (Command::MoveToAbsolute(-100_046), "P01 -100046\r\n"),
    (Command::MoveToRelative(100_000), "M01 100000\r\n"),
    (Command::MoveAtVelocity(-200), "V01 -200\r\n"),
    (Command::Write { register: 0, value: -10_000 }, "W01 00 -10000\r\n"),
    (Command::Write { register: 2, value: 128 }, "W01 02 128\r\n"),
    (Command::WriteStore { register: 0, value: -10_000 }, "S01 00 -10000\r\n"),
    (Command::WriteStore { register: 1, value: 100 }, "S01 01 100\r\n"),
    (Command::WriteStore { register: 2, value: 128 }, "S01 02 128\r\n"),
    (Command::ReadText(Part::Register(4)), "R01 04\r\n"),
    (Command::ReadText(Part::StatusBits), "R01 97\r\n"),
    (Command::ReadText(Part::FunctionBits), "R01 98\r\n"),
    (Command::ReadText(Part::All), "R01 99\r\n"),
    (Command::Restore, "X01\r\n"),
    (Command::Reset, "Y01\r\n"),
];

fn frames_in(bytes: &[u8]) -> Vec<FrameEvent> {
    let mut reader = FrameReader::new();
    let mut events: Vec<_> = bytes.iter().filter_map(|byte| reader.feed(*byte, Duration::ZERO)).collect();
    events.extend(reader.silent_until(Duration::from_secs(1)));
    events
}

fn lines_in(text: &[u8]) -> Vec<LineEvent> {
    let mut reader = LineReader::new();
    text.iter().filter_map(|byte| reader.feed(*byte)).collect()
}

#[test]
fn every_frame_of_the_manual_is_written_and_read() {
    for (command, bytes) in FRAMES {
        assert_eq!(encode_frame(UNIT_1, command).as_deref(), Ok(*bytes), "{command:?}");
        assert_eq!(frames_in(bytes), [FrameEvent::Command(UNIT_1, *command)], "{command:?}");
    }
}

#[test]
fn a_broadcast_has_the_address_99_and_those_above_it_in_frames() {
    // MOVEAT_VELOCITY 0 to 99: 17 63 00 00, sum 7A.
    let stop = Command::MoveAtVelocity(0);
    assert_eq!(encode_frame(Address::BROADCAST, &stop).unwrap(), [0x17, 0x63, 0x00, 0x00, 0x7A]);
    for address in 99..=255 {
        let bytes = [0x17, address, 0, 0, 0x17_u8.wrapping_add(address)];
        assert_eq!(frames_in(&bytes), [FrameEvent::Command(Address::from_wire(address), stop)]);
        assert!(Address::from_wire(address).is_broadcast());
    }
    assert!(!Address::from_wire(98).is_broadcast());
    assert_eq!(encode_line(Address::BROADCAST, &stop).as_deref(), Ok("V99 0\r\n"));
}

#[test]
fn every_binary_reply_of_the_manual_is_written_and_read() {
    for (command, returns, reply, bytes) in frame_replies() {
        assert_eq!(encode_frame_reply(UNIT_1, &reply), bytes, "{command:?}");
        let progress = parse_frame_reply(UNIT_1, &command, returns, bytes);
        assert_eq!(progress, Progress::Done { reply, used: bytes.len() }, "{command:?}");
        for cut in 0..bytes.len() {
            assert_eq!(parse_frame_reply(UNIT_1, &command, returns, &bytes[..cut]), Progress::Incomplete);
        }
    }
}

#[test]
fn every_line_of_the_manual_is_written_and_read() {
    for (command, line) in LINES {
        assert_eq!(encode_line(UNIT_1, command).as_deref(), Ok(*line));
        assert_eq!(lines_in(line.as_bytes()), [LineEvent::Command(UNIT_1, *command)], "{line:?}");
    }
}

#[test]
fn replies_in_text_are_those_of_the_manual() {
    let none = Returns::default();
    let pterm = Part::Register(4);
    let read = Command::ReadText(pterm);
    let reply = Reply::Registers(vec![(4, 6000)]);
    assert_eq!(encode_line_reply(Some(pterm), &reply), "PTRM=6000\r\n");
    assert_eq!(
        parse_line_reply(&read, none, b"PTRM=6000\r\n"),
        Progress::Done { reply: reply.clone(), used: 11 }
    );
    // Only four codes are in the manual, so another code is as good.
    assert_eq!(parse_line_reply(&read, none, b"PTER=6000\r\n"), Progress::Done { reply, used: 11 });
    let all = Returns { position: true, velocity: true, time: true };
    let returned =
        Reply::Returned(Returned { position: Some(100_000), velocity: Some(121), time: Some(23_986) });
    let lines = "APOS=100000\r\nVELO=121\r\nTIME=23986\r\n";
    assert_eq!(encode_line_reply(None, &returned), lines);
    let move_to = Command::MoveToAbsolute(1);
    assert_eq!(
        parse_line_reply(&move_to, all, lines.as_bytes()),
        Progress::Done { reply: returned, used: lines.len() }
    );
    assert_eq!(
        parse_line_reply(&move_to, none, b"BAD COMMAND\r\n"),
        Progress::Done { reply: Reply::NotUnderstood, used: 13 }
    );
    assert_eq!(
        parse_line_reply(&move_to, none, b"OK\r\n"),
        Progress::Done { reply: Reply::Acknowledged, used: 4 }
    );
}

#[test]
fn all_registers_come_in_one_line_with_a_comma_behind_each() {
    let values: Vec<_> = REGISTERS.iter().map(|row| (row.number, row.default.unwrap_or(7))).collect();
    let reply = Reply::Registers(values);
    let line = encode_line_reply(Some(Part::All), &reply);
    assert!(line.starts_with("0,1023,128,0,6000,35,0,1,14,10,") && line.ends_with(",7,\r\n"), "{line}");
    let progress = parse_line_reply(&Command::ReadText(Part::All), Returns::default(), line.as_bytes());
    assert_eq!(progress, Progress::Done { reply, used: line.len() });
    let short = parse_line_reply(&Command::ReadText(Part::All), Returns::default(), b"0,9,\r\n");
    assert_eq!(short, Progress::Bad(BadReply::Line("0,9,".to_owned())));
}

#[test]
fn the_bits_of_status_come_as_ten_lines_or_eleven() {
    let ten = [true, false, false, false, false, false, false, false, false, true];
    let text = encode_line_reply(Some(Part::StatusBits), &Reply::Bits(ten.to_vec()));
    assert!(text.starts_with("S0ON\r\nS1OFF\r\n") && text.ends_with("S9ON\r\n"));
    let read = Command::ReadText(Part::StatusBits);
    let eleven = text.clone() + "S10ON\r\n";
    for (text, count) in [(text, 10), (eleven, 11)] {
        match parse_line_reply(&read, Returns::default(), text.as_bytes()) {
            Progress::Done { reply: Reply::Bits(bits), used } => {
                assert_eq!((bits.len(), used), (count, text.len()));
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn all_registers_take_seventy_bytes() {
    let data: usize = REGISTERS.iter().map(|row| row.kind.bytes()).sum();
    assert_eq!(data, 70);
    for (number, row) in (0..).zip(&REGISTERS) {
        assert_eq!(row.number, number);
        assert!(row.code.len() == 4 && row.kind.range().contains(row.range.start()));
        assert!(row.kind.range().contains(row.range.end()), "{}", row.name);
        assert_eq!(row.default.is_some(), row.is_writable(), "{}: what is measured has no default", row.name);
        assert!(row.default.is_none_or(|value| row.range.contains(&value)), "{}", row.name);
    }
    let codes: std::collections::HashSet<_> = REGISTERS.iter().map(|row| row.code).collect();
    assert_eq!(codes.len(), REGISTERS.len());
}

#[test]
fn a_wrong_checksum_drops_the_frame_until_the_line_is_silent() {
    let good = encode_frame(UNIT_1, &Command::Restore).expect("it has a binary form");
    let mut bytes = vec![0x14, 0x01, 0x80, 0x00, 0x96];
    bytes.extend(&good);
    assert_eq!(frames_in(&bytes), [FrameEvent::Dropped(bytes.clone())]);
    let mut reader = FrameReader::new();
    let later = Duration::from_millis(6);
    for byte in &bytes {
        assert_eq!(reader.feed(*byte, Duration::ZERO), None);
    }
    assert_eq!(reader.feed(good[0], later), Some(FrameEvent::Dropped(bytes)));
    assert_eq!(reader.feed(good[1], later), None);
    assert_eq!(reader.feed(good[2], later), Some(FrameEvent::Command(UNIT_1, Command::Restore)));
}

#[test]
fn a_pause_of_more_than_5_ms_drops_the_frame_and_one_of_5_ms_does_not() {
    let frame = encode_frame(UNIT_1, &Command::ChangeSpeed(763)).expect("it has a binary form");
    for (gap_ms, is_taken) in [(0, true), (5, true), (6, false)] {
        let mut reader = FrameReader::new();
        let mut now = Duration::ZERO;
        let mut commands = 0;
        for byte in &frame {
            let event = reader.feed(*byte, now);
            commands += usize::from(matches!(event, Some(FrameEvent::Command(..))));
            now += Duration::from_millis(gap_ms);
        }
        assert_eq!(commands == 1, is_taken, "gap of {gap_ms} ms");
    }
}

#[test]
fn commands_in_a_row_are_taken_one_by_one() {
    let mut bytes = encode_frame(UNIT_1, &Command::ChangeSpeed(1)).expect("it has a binary form");
    bytes
        .extend(encode_frame(Address::BROADCAST, &Command::MoveAtVelocity(0)).expect("it has a binary form"));
    // Broadcast: command 0x17, address 99, velocity 0, checksum.
    assert!(bytes.ends_with(&[0x17, 0x63, 0x00, 0x00, 0x7A]));
    let events = frames_in(&bytes);
    assert_eq!(events.len(), 2);
    assert_eq!(events[1], FrameEvent::Command(Address::BROADCAST, Command::MoveAtVelocity(0)));
}

#[test]
fn a_backspace_takes_a_character_away_and_zeros_in_front_do_no_harm() {
    assert_eq!(
        lines_in(b"P02\x081 -1x\x080\r\n"),
        [LineEvent::Command(UNIT_1, Command::MoveToAbsolute(-10))]
    );
    assert_eq!(lines_in(b"V01 -0200\r\n"), [LineEvent::Command(UNIT_1, Command::MoveAtVelocity(-200))]);
    assert_eq!(
        lines_in(b"W01 4 06000\n"),
        [LineEvent::Command(UNIT_1, Command::Write { register: 4, value: 6000 })]
    );
    assert_eq!(lines_in(b"\r\n\r\n"), []);
}

#[test]
fn what_is_no_command_is_told_with_its_address() {
    for line in ["C01", "C01 12 13", "C01x", "C1 12", "Q01 1", "R01 32", "W01 02 256", "C01 40000", "P01 one"]
    {
        match &lines_in(format!("{line}\r\n").as_bytes())[..] {
            [LineEvent::NotUnderstood { line: reported, .. }] => assert_eq!(reported, line),
            other => panic!("{line}: {other:?}"),
        }
    }
    assert_eq!(lines_in(b"Z07\r\n"), [LineEvent::SelfTest(Address::from_wire(7))]);
    let long = [b"C01 1".as_slice(), &[b' '; 60], b"\r\n"].concat();
    assert!(matches!(lines_in(&long)[..], [LineEvent::NotUnderstood { .. }]));
}

#[test]
fn what_has_no_form_is_refused_with_the_reason() {
    let value = Command::Write { register: 2, value: 256 };
    let error = encode_frame(UNIT_1, &value).expect_err("VELOCITYFF is one byte");
    assert_eq!(error.to_string(), "256 does not fit VELOCITYFF, which holds 0 to 255");
    assert_eq!(encode_line(UNIT_1, &value), Err(error));
    assert_eq!(encode_line(UNIT_1, &Command::Read(1)), Err(EncodeError::OtherProtocol));
    assert_eq!(encode_frame(UNIT_1, &Command::ReadText(Part::All)), Err(EncodeError::OtherProtocol));
    assert_eq!(encode_frame(Address::BROADCAST, &Command::Read(1)), Err(EncodeError::BroadcastRead));
    assert_eq!(encode_line(Address::from_wire(120), &Command::Reset), Err(EncodeError::LongAddress(120)));
}

#[test]
fn a_wrong_reply_is_told_from_a_short_one() {
    let none = Returns::default();
    let read = Command::ReadRegister(0);
    let wrong_sum = [0x01, 0x20, 0x4E, 0x00, 0x00, 0x70];
    let reported = Progress::Bad(BadReply::Checksum { expected: 0x6F, got: 0x70 });
    assert_eq!(parse_frame_reply(UNIT_1, &read, none, &wrong_sum), reported);
    let reported = Progress::Bad(BadReply::Start { expected: 0x01, got: 0x02 });
    assert_eq!(parse_frame_reply(UNIT_1, &read, none, &[0x02]), reported);
    let newer = parse_frame_reply(UNIT_1, &Command::ReadRegister(40), none, &[]);
    assert_eq!(newer, Progress::Bad(BadReply::UnknownRegister(40)));
    assert_eq!(checksum(&[0xE8, 0x04, 0xFC]), 0xE8);
}

fn any_command() -> impl Strategy<Value = Command> {
    let write = (0_u8..32, any::<i64>()).prop_map(|(index, seed)| {
        let range = register(index).expect("there are 32 registers").kind.range();
        (index, range.start() + seed.rem_euclid(range.end() - range.start() + 1))
    });
    prop_oneof![
        any::<i16>().prop_map(Command::ChangeSpeed),
        any::<i32>().prop_map(Command::MoveToAbsolute),
        any::<i32>().prop_map(Command::MoveToRelative),
        any::<i16>().prop_map(Command::MoveAtVelocity),
        write.clone().prop_map(|(register, value)| Command::Write { register, value }),
        write.prop_map(|(register, value)| Command::WriteStore { register, value }),
        any::<u32>().prop_map(Command::Read),
        any::<u8>().prop_map(Command::ReadRegister),
        (0_u8..32).prop_map(|index| Command::ReadText(Part::Register(index))),
        Just(Command::Restore),
        Just(Command::Reset),
    ]
}

proptest! {
    #![proptest_config(Config { rng_seed: RngSeed::Fixed(0x5EED), failure_persistence: None, ..Config::default() })]

    #[test]
    fn what_one_end_writes_the_other_reads(command in any_command(), unit in 0_u8..=98) {
        let address = Address::unit(unit).expect("98 is the last one");
        if let Ok(frame) = encode_frame(address, &command) {
            prop_assert_eq!(frames_in(&frame), [FrameEvent::Command(address, command)]);
        }
        if let Ok(line) = encode_line(address, &command) {
            prop_assert_eq!(lines_in(line.as_bytes()), [LineEvent::Command(address, command)]);
        }
    }

    #[test]
    fn registers_of_any_mask_come_back(mask in any::<u32>(), seed in any::<i64>()) {
        let within = |range: std::ops::RangeInclusive<i64>| {
            range.start() + seed.rem_euclid(range.end() - range.start() + 1)
        };
        let values: Vec<_> = REGISTERS
            .iter()
            .filter(|row| mask & row.mask() != 0)
            .map(|row| (row.number, within(row.kind.range())))
            .collect();
        let reply = Reply::Registers(values);
        let bytes = encode_frame_reply(UNIT_1, &reply);
        let progress = parse_frame_reply(UNIT_1, &Command::Read(mask), Returns::default(), &bytes);
        prop_assert_eq!(progress, Progress::Done { reply, used: bytes.len() });
    }

    #[test]
    fn no_bytes_make_either_end_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), command in any_command()) {
        let _ = frames_in(&bytes);
        let _ = lines_in(&bytes);
        for returns in [Returns::default(), Returns { position: true, velocity: true, time: true }] {
            let _ = parse_frame_reply(UNIT_1, &command, returns, &bytes);
            let _ = parse_line_reply(&command, returns, &bytes);
        }
    }

    #[test]
    fn text_that_looks_like_replies_makes_no_client_panic(
        text in "(S[0-9]{1,2}(ON|OFF)|[A-Z]{4}=-?[0-9]{1,12}|-?[0-9,]{0,40}|OK|BAD COMMAND)(\r\n|\n|)",
        command in any_command(),
    ) {
        for part in [Part::All, Part::StatusBits, Part::FunctionBits] {
            let _ = parse_line_reply(&Command::ReadText(part), Returns::default(), text.as_bytes());
        }
        let _ = parse_line_reply(&command, Returns { position: true, ..Returns::default() }, text.as_bytes());
    }
}
