//! Any bytes with any pauses into both ends of both Motion Mind protocols: no panic, what is read can be written again, and after a silence
//! or a line end a good command is taken.
#![no_main]

use std::time::Duration;

use brushwork_motion_mind_wire::{Address, COMMANDS, Command, FrameEvent, FrameReader, LineEvent, LineReader, Part, Progress, Returns, describe_command, describe_reply, encode_frame, encode_line, parse_all_loosely, parse_frame_reply, parse_line_reply};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    frames(data);
    lines(data);
    replies(data);
});

fn frames(data: &[u8]) {
    let mut reader = FrameReader::new();
    let mut now = Duration::ZERO;
    for arrival in data.chunks_exact(2) {
        // The low bits of the second byte are the pause in milliseconds, mostly none.
        now += Duration::from_millis(u64::from(arrival[1].saturating_sub(246)));
        if let Some(FrameEvent::Command(address, command)) = reader.feed(arrival[0], now) {
            let _ = describe_command(address, &command);
            let is_read = matches!(command, Command::Read(_) | Command::ReadRegister(_));
            if !(is_read && address.is_broadcast()) {
                encode_frame(address, &command).expect("what came as a frame goes as one");
            }
        }
    }
    now += Duration::from_millis(6);
    let good: Vec<_> = [0x1D, 0x01, 0x12, 0x30].into_iter().filter_map(|byte| reader.feed(byte, now)).collect();
    assert!(good.contains(&FrameEvent::Command(Address::FACTORY, Command::ReadRegister(18))));
}

fn lines(data: &[u8]) {
    let mut reader = LineReader::new();
    for byte in data {
        if let Some(LineEvent::Command(address, command)) = reader.feed(*byte) {
            let _ = describe_command(address, &command);
            if !(matches!(command, Command::ReadText(_)) && address.is_broadcast()) {
                encode_line(address, &command).expect("what came as a line goes as one");
            }
        }
    }
    let events: Vec<_> = b"\nR01 18\r\n".iter().filter_map(|byte| reader.feed(*byte)).collect();
    let wanted = LineEvent::Command(Address::FACTORY, Command::ReadText(Part::Register(18)));
    assert_eq!(events.last(), Some(&wanted));
}

fn replies(data: &[u8]) {
    let &[first, second, ref bytes @ ..] = data else { return };
    let row = &COMMANDS[usize::from(first) % COMMANDS.len()];
    let values = vec![i64::from(second % 32); row.values.len()];
    let Some(command) = Command::from_parts(row.number, &values) else { return };
    let text = match command {
        Command::Read(_) => Command::ReadText([Part::All, Part::StatusBits, Part::FunctionBits][usize::from(second % 3)]),
        Command::ReadRegister(number) => Command::ReadText(Part::Register(number)),
        other => other,
    };
    let returns = Returns::of_function(u16::from(second));
    for progress in [
        parse_frame_reply(Address::FACTORY, &command, returns, bytes),
        parse_line_reply(&text, returns, bytes),
        parse_all_loosely(bytes),
    ] {
        if let Progress::Done { reply, used } = progress {
            assert!(0 < used && used <= bytes.len());
            let _ = describe_reply(&reply);
        }
    }
}
