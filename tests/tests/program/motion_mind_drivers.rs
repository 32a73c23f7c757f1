//! The simulated Motion Mind 3 under clients that talk as drivers do which other people have published. Each client here was written for
//! this test from what such a driver puts on the wire, how it waits and what it takes for an answer; none uses the protocol crate.
//!
//! Drivers whose manner this is, as public repositories had them:
//! - `motionmind_hardware` (ROS 2, C++, and its Python tools): github.com/Rick-v-E/motionmind_hardware
//! - `motionmind` (QNX and Linux, C++, 2006): github.com/cvilas/motionmind
//! - the driver `motionmind` of Player 3 (C++): playerstage.sourceforge.net
//! - class `MotionMind` of a robot server (C++, "GLK"), with RETPOS set
//! - class `MM3` of UNC's profiler (Java, `edu.unc.ims.instruments.motionmind3`) and `MM3Command` for lines
//! - `SerialMotorDriverMMBinary` and `SerialMotorDriverMM` of RoboServerA (C++)
//! - class `MM3Class` of a winch (Arduino, C++)
//!
//! Each runs twice: in virtual time at the baud rate, where its patience is that of the original, and against the built program on a
//! socket and a pseudo-terminal, where a busy computer may need more.
#![cfg(unix)]

use std::time::{Duration, Instant};

use brushwork_link::Transport;
use brushwork_link::transport::ConnectTarget;
use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig, Protocol};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::pacing::Paced;
use brushwork_tests::program::Program;
use brushwork_tests::virtual_line::VirtualLine;
use brushwork_tests::wait::LIMIT;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

/// A serial port as a driver sees it.
struct Port {
    line: Box<dyn Transport>,
    /// Time of the port: virtual, or the wall's.
    virtual_line: Option<VirtualLine<Paced<MotionMindBus>>>,
    began: Instant,
    waiting: Vec<u8>,
}

impl Port {
    /// Units in virtual time, their bytes at 19,200 baud.
    fn in_virtual_time(mode: Mode, protocol: Protocol, addresses: &[u8]) -> Self {
        let unit = |number: &u8| {
            let address = brushwork_motion_mind_wire::Address::unit(*number).expect("a unit's address");
            let config = MotionMindConfig { address, protocol, ..MotionMindConfig::new(mode) };
            MotionMind::new(config).expect("the preset is sound")
        };
        let bus = MotionMindBus::new(addresses.iter().map(unit).collect());
        let line = VirtualLine::new(Paced::new(bus, true), StreamIndex::Usb);
        let port = line.clone();
        Self { line: Box::new(line), virtual_line: Some(port), began: Instant::now(), waiting: Vec::new() }
    }

    fn now(&self) -> Duration {
        match &self.virtual_line {
            Some(line) => brushwork_link::Clock::now(line.clock()),
            None => self.began.elapsed(),
        }
    }

    fn sleep(&self, time: Duration) {
        match &self.virtual_line {
            Some(line) => line.pass(time),
            None => std::thread::sleep(time),
        }
    }

    /// As patient as the driver is; on a real computer, which may be busy, a good deal more.
    fn patience(&self, of_driver: Duration) -> Duration {
        if self.virtual_line.is_some() { of_driver } else { of_driver.max(Duration::from_secs(6)) }
    }

    fn write(&mut self, bytes: &[u8]) {
        self.line.write(bytes).expect("the line is open");
    }

    /// One write for each byte, with a pause after each.
    fn write_slowly(&mut self, bytes: &[u8], pause: Duration) {
        for byte in bytes {
            self.write(&[*byte]);
            if !pause.is_zero() {
                self.sleep(pause);
            }
        }
    }

    /// Throws away what was not read.
    fn flush(&mut self) {
        self.waiting.clear();
        self.line.discard_input().expect("the line is open");
    }

    /// So many bytes, or fewer if the time is over.
    fn read(&mut self, count: usize, patience: Duration) -> Vec<u8> {
        let until = self.now() + self.patience(patience);
        let mut buffer = [0; 256];
        while self.waiting.len() < count && self.now() < until {
            let left = until.saturating_sub(self.now());
            let got = self.line.read(&mut buffer, left).expect("the line is open");
            self.waiting.extend_from_slice(&buffer[..got]);
        }
        let count = count.min(self.waiting.len());
        self.waiting.drain(..count).collect()
    }

    /// All until a line feed, without it.
    fn read_line(&mut self, patience: Duration) -> Option<String> {
        let mut line = Vec::new();
        loop {
            match self.read(1, patience).first()? {
                b'\n' => return Some(String::from_utf8(line).expect("answers are text")),
                byte => line.push(*byte),
            }
        }
    }
}

fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum: u32 = bytes.iter().map(|byte| u32::from(*byte)).sum();
    bytes.push((sum & 0xFF) as u8);
    bytes
}

/// The value in a reply: address, value, checksum.
fn value_of(reply: &[u8], address: u8, width: usize) -> Option<i64> {
    let (sum, body) = reply.split_last()?;
    let total: u32 = body.iter().map(|byte| u32::from(*byte)).sum();
    let is_good = reply.len() == width + 2 && body[0] == address && (total & 0xFF) as u8 == *sum;
    is_good.then(|| body[1..].iter().rev().fold(0, |value, byte| value << 8 | i64::from(*byte)))
}

/// The ROS 2 driver and its Python tools: the input is flushed, the frame written whole, the reply read by its exact length.
/// A move is answered by POSITION, since RETPOS is set; registers are read by their mask and written with one acknowledge.
fn ros_hardware(port: &mut Port, address: u8, mode: u8) {
    let time_out = Duration::from_secs(2);
    let read = |port: &mut Port, mask: u32, width: usize| {
        port.flush();
        let mut frame = vec![26, address];
        frame.extend(mask.to_le_bytes());
        port.write(&summed(frame));
        let reply = port.read(width + 2, time_out);
        value_of(&reply, address, width).unwrap_or_else(|| panic!("mask {mask:#X}: {reply:02X?}"))
    };
    assert_eq!(read(port, 1 << 18, 1), i64::from(mode), "it checks the mode first");
    for (register, value) in [(4_u8, 4000_u16), (5, 12), (6, 900)] {
        port.write(&summed([vec![24, address, register], value.to_le_bytes().to_vec()].concat()));
        assert_eq!(port.read(1, time_out), [0x06]);
        assert_eq!(read(port, 1 << register, 2), i64::from(value));
    }
    // RETPOS | ADSERIAL, so that moves are taken in mode 5 too.
    port.write(&summed(vec![24, address, 3, 0x02, 0x04]));
    assert_eq!(port.read(1, time_out), [0x06]);
    // POSITION and STATUS with one read: 4 + 2 bytes.
    let both = read(port, 1 | 1 << 16, 6);
    let here = both & 0xFFFF_FFFF;
    port.flush();
    let target = u32::try_from(here).expect("four bytes");
    port.write(&summed([vec![21, address], target.to_le_bytes().to_vec()].concat()));
    let reply = port.read(6, time_out);
    assert!(value_of(&reply, address, 4).is_some(), "{reply:02X?}");
    if mode == 4 {
        // RETVEL instead: a velocity is answered by two bytes.
        port.write(&summed(vec![24, address, 3, 0x04, 0x00]));
        assert_eq!(port.read(1, time_out), [0x06]);
        port.flush();
        port.write(&summed(vec![23, address, 0, 0]));
        let reply = port.read(4, time_out);
        assert!(value_of(&reply, address, 2).is_some(), "{reply:02X?}");
    }
}

/// The driver of 2006: its port gives what has come within two seconds; FUNCTION is read and written back without the return bits, then
/// gains, moves and a reset, each with one acknowledge.
fn qnx_class(port: &mut Port) {
    let v_time = Duration::from_secs(2);
    let read = |port: &mut Port, register: u8, width: usize| {
        let mut frame = vec![0x1A, 1];
        frame.extend((1_u32 << register).to_le_bytes());
        port.write(&summed(frame));
        let reply = port.read(width + 2, v_time);
        value_of(&reply, 1, width).unwrap_or_else(|| panic!("register {register}: {reply:02X?}"))
    };
    let acknowledged = |port: &mut Port, frame: Vec<u8>| {
        port.write(&summed(frame.clone()));
        assert_eq!(port.read(1, v_time), [0x06], "{frame:02X?}");
    };
    let function = read(port, 3, 2);
    let without = u16::try_from(function & 0xFFF1).expect("two bytes").to_le_bytes();
    acknowledged(port, [vec![0x18, 1, 3], without.to_vec()].concat());
    assert_eq!((read(port, 17, 1), read(port, 18, 1)), (10, 4));
    for (register, gain) in [(4, 6000_u16), (5, 35), (6, 200)] {
        acknowledged(port, [vec![0x18, 1, register], gain.to_le_bytes().to_vec()].concat());
    }
    acknowledged(port, vec![0x17, 1, 0, 0]);
    acknowledged(port, vec![0x15, 1, 0, 0, 0, 0]);
    acknowledged(port, vec![0x16, 1, 0, 0, 0, 0]);
    acknowledged(port, vec![0x14, 1, 0, 0]);
    // A register to EEPROM: the acknowledge comes later, and the next command is heard.
    acknowledged(port, vec![0x19, 1, 2, 128]);
    assert_eq!(read(port, 2, 1), 128);
    let _ = read(port, 0, 4);
    acknowledged(port, vec![0x1C, 1]);
}

/// Player's driver: 20 ms between commands, a request for POSITION and one for STATUS in turn, and whatever does not begin with the address
/// is thrown away byte by byte, acknowledges of earlier moves among it.
fn player(port: &mut Port, address: u8) {
    let mut ask = |frame: Vec<u8>, width: usize| {
        port.sleep(ms(20));
        port.write(&summed(frame));
        port.sleep(Duration::from_micros(2500));
        let mut buffer: Vec<u8> = Vec::new();
        let until = port.now() + port.patience(ms(250));
        loop {
            buffer.extend(port.read(1, ms(10)));
            while !buffer.is_empty() && buffer[0] != address {
                buffer.remove(0);
            }
            if buffer.len() >= width + 2 {
                if let Some(value) = value_of(&buffer[..width + 2], address, width) {
                    return value;
                }
                buffer.remove(0);
            }
            assert!(port.now() < until, "message timeout triggered: {buffer:02X?}");
        }
    };
    let position = vec![0x1A, address, 1, 0, 0, 0];
    let status = vec![0x1A, address, 0, 0, 1, 0];
    let before = ask(position.clone(), 4);
    let _ = ask(status.clone(), 2);
    // Sets the count: the acknowledge stays in the line until the next read of it throws it away.
    port.sleep(ms(20));
    port.write(&summed(vec![0x18, address, 0, 0x39, 0x05, 0, 0]));
    port.sleep(ms(20));
    let mut frame = vec![0x15, address];
    frame.extend(1337_i32.to_le_bytes());
    port.write(&summed(frame));
    port.sleep(ms(20));
    let mut rest: Vec<u8> = port.read(2, ms(250));
    assert_eq!(rest, [0x06, 0x06], "position was {before}");
    port.write(&summed(position));
    rest = port.read(6, ms(250));
    let now = value_of(&rest, address, 4).expect("six bytes of the position");
    assert!((now - 1337).abs() <= 2, "{now}");
}

/// The robot server's class: RETPOS is set, an answer must have begun 10 ms after the command was written and be whole within three looks
/// 2 ms apart; a write is acknowledged within 20 ms, a register read within 20 ms.
fn glk(port: &mut Port, addresses: [u8; 2]) {
    for address in addresses {
        // AMPSLIMIT 75, PWMLIMIT 614, FUNCTION RETPOS.
        for (register, value) in [(28, 75_u16), (25, 614), (3, 2)] {
            port.write(&summed([vec![0x18, address, register], value.to_le_bytes().to_vec()].concat()));
            assert_eq!(port.read(1, ms(20)), [0x06]);
            port.flush();
        }
        port.write(&summed(vec![0x18, address, 0, 0, 0, 0, 0]));
        assert_eq!(port.read(1, ms(20)), [0x06]);
    }
    for _ in 0..5 {
        for address in addresses {
            for frame in [vec![0x17, address, 0, 0], vec![0x16, address, 0, 0, 0, 0]] {
                port.write(&summed(frame));
                let mut reply = port.read(1, ms(10));
                reply.extend(port.read(5, ms(6)));
                assert!(value_of(&reply, address, 4).is_some(), "{reply:02X?}");
                port.flush();
            }
        }
    }
    let mut frame = vec![26, addresses[1]];
    frame.extend((1_u32 << 29).to_le_bytes());
    port.write(&summed(frame));
    let reply = port.read(4, ms(20));
    assert!(value_of(&reply, addresses[1], 2).is_some(), "{reply:02X?}");
}

/// The Java class: 20 ms between exchanges, up to 250 ms for the first byte (400 ms for a store) and 30 ms after each; an answer is what
/// came by then, with a checksum that fits - also for the lone acknowledge - and the address or 6 in front. Three tries.
fn java_class(port: &mut Port) {
    let mut send = |frame: Vec<u8>, patience: Duration| {
        for _ in 0..3 {
            port.sleep(ms(20));
            port.flush();
            port.write(&summed(frame.clone()));
            let mut reply = port.read(1, patience);
            let quiet = ms(30);
            loop {
                let until = port.now() + quiet;
                let more = match &port.virtual_line {
                    Some(_) => port.read(1, quiet),
                    None => {
                        let mut buffer = [0; 1];
                        let count = port.line.read(&mut buffer, quiet).expect("the line is open");
                        let mut more = std::mem::take(&mut port.waiting);
                        more.extend_from_slice(&buffer[..count]);
                        more
                    }
                };
                if more.is_empty() && port.now() >= until {
                    break;
                }
                reply.extend(more);
            }
            let is_acknowledge = reply == [0x06];
            let is_answer = reply.first() == Some(&frame[1])
                && reply.len() > 1
                && value_of(&reply, frame[1], reply.len() - 2).is_some();
            if is_acknowledge || is_answer {
                return reply;
            }
        }
        panic!("no answer to {frame:02X?} in three tries");
    };
    let read = |register: u8| vec![0x1D, 1, register];
    assert_eq!(send(read(3), ms(250)).len(), 4, "FUNCTION, when it connects");
    // stop() writes 0 to PWMLIMIT, which the manual's table does not allow, and expects it to be taken; so it is set again later.
    for (register, value) in [(25, 0_u16), (1, 99), (25, 1023), (28, 3500 / 20), (26, 50)] {
        let frame = [vec![0x18, 1, register], value.to_le_bytes().to_vec()].concat();
        assert_eq!(send(frame, ms(250)), [0x06]);
        assert_eq!(&send(read(register), ms(250))[1..3], value.to_le_bytes());
    }
    // DISABLEPID and VELLIMIT as bits of FUNCTION.
    assert_eq!(send(vec![0x18, 1, 3, 0x40, 0x40], ms(250)), [0x06]);
    assert_eq!(send(vec![0x17, 1, 0, 0], ms(250)), [0x06]);
    // Several registers at once: 0, 14, 16, 29, 31 are 4 + 2 + 2 + 2 + 2 bytes.
    let mask: u32 = 1 | 1 << 14 | 1 << 16 | 1 << 29 | 1 << 31;
    let reply = send([vec![0x1A, 1], mask.to_le_bytes().to_vec()].concat(), ms(250));
    assert_eq!(reply.len(), 14);
    assert_eq!(send(vec![0x19, 1, 0, 1, 2, 3, 0], ms(400)), [0x06], "a position to EEPROM");
    assert_eq!(send(vec![0x1B, 1], ms(400)), [0x06], "RESTORE");
    assert_eq!(&send(read(1), ms(400))[1..3], [0xFF, 0x03], "1023 again");
}

/// RoboServerA in frames: one write for each byte, three tries, and a read of one-byte registers that leaves the number out, to which a unit
/// is silent.
fn robo_server_binary(port: &mut Port) {
    let mut try_three_times = |frame: &[u8], length: usize| {
        for _ in 0..if port.virtual_line.is_some() { 3 } else { 60 } {
            port.flush();
            port.write_slowly(&summed(frame.to_vec()), Duration::ZERO);
            let reply = port.read(length, ms(100));
            if reply.len() == length {
                return reply;
            }
            port.sleep(ms(20));
        }
        Vec::new()
    };
    assert_eq!(try_three_times(&[0x1D, 1, 4], 4).len(), 4, "PTERM");
    assert_eq!(try_three_times(&[0x18, 1, 4, 0x88, 0x13], 1), [0x06]);
    assert_eq!(try_three_times(&[0x1D, 1, 4], 4), [0x01, 0x88, 0x13, 0x9C]);
    assert_eq!(try_three_times(&[0x18, 1, 8, 11], 1), [0x06], "PIDSCALAR");
    // POSITION to 0, then where it is sent: DESIREDPOSITION.
    assert_eq!(try_three_times(&[0x18, 1, 0, 0, 0, 0, 0], 1), [0x06]);
    assert_eq!(try_three_times(&[0x15, 1, 0, 0, 0, 0], 1), [0x06]);
    assert_eq!(try_three_times(&[0x1D, 1, 27], 6), [0x01, 0, 0, 0, 0, 0x01]);
    assert_eq!(try_three_times(&[0x17, 1, 0, 0], 1), [0x06]);
    // The slip: command and address, no register. It is no command; the next one is taken.
    port.flush();
    port.write_slowly(&summed(vec![0x1D, 1]), Duration::ZERO);
    let silence = port.line.read(&mut [0; 8], ms(60)).expect("the line is open");
    assert_eq!(silence, 0, "a frame of the wrong length is met with silence");
    // On a real line, which may be late, the two can come as one, which is no command either: then it is sent again.
    let sent = if port.virtual_line.is_some() { 1 } else { 10 };
    let mut replies = (0..sent).map(|_| {
        port.sleep(ms(20));
        port.write(&summed(vec![0x1D, 1, 8]));
        port.read(3, ms(100))
    });
    assert_eq!(replies.find(|reply| !reply.is_empty()).unwrap_or_default(), [0x01, 11, 12]);
}

/// RoboServerA in lines: three writes a command, zeros in front of the numbers, the value from the sixth character on.
fn robo_server_lines(port: &mut Port) {
    let say = |port: &mut Port, words: &str, number: &str| {
        port.write(words.as_bytes());
        port.write(number.as_bytes());
        port.write(b"\r\n");
        port.read_line(ms(500)).unwrap_or_else(|| panic!("no answer to {words}{number}"))
    };
    for (words, number) in [
        ("W01 04 ", "5000"),
        ("W01 05 ", "0012"),
        ("W01 06 ", "0900"),
        ("W01 08 ", "0011"),
        ("V01 ", "0000"),
        ("P01 ", "000000"),
        ("P01 ", "-00012"),
    ] {
        let answer = say(port, words, number);
        assert!(answer.starts_with("OK"), "{words}{number}: {answer}");
    }
    let answer = say(port, "R01 00", "");
    assert_eq!(&answer[4..5], "=");
    let position: i64 = answer[5..].trim().parse().expect("a number from the sixth character on");
    assert!(position.abs() < 5000, "{position}");
    assert!(say(port, "R01 08", "").ends_with("=11\r"));
}

/// The winch: each command with carriage return and line feed, an answer until the line feed within a second, `OK` in front or a number
/// behind `=`; registers set to 0 against the manual's range when it stops.
fn winch(port: &mut Port) {
    let stopped = 0x0001 | 0x0020 | 0x0040 | 0x0080 | 0x0800 | 0x2000 | 0x4000;
    let moving = stopped & !0x4000;
    let write = |port: &mut Port, command: &str| {
        port.write(format!("{command}\r\n").as_bytes());
        let answer = port.read_line(Duration::from_secs(1)).unwrap_or_default();
        assert!(answer.starts_with("OK"), "{command}: {answer}");
        assert!(answer.len() < 16, "it fits the winch's buffer");
    };
    let read = |port: &mut Port, register: &str| -> i64 {
        port.write(format!("R01 {register}\r\n").as_bytes());
        let answer = port.read_line(Duration::from_secs(1)).unwrap_or_default();
        let (_, value) = answer.split_once('=').unwrap_or_else(|| panic!("{register}: {answer}"));
        value.trim().parse().expect("a number")
    };
    assert_eq!(read(port, "17"), 10);
    for command in [
        "W01 00 12345",
        "W01 01 1023",
        &format!("W01 03 {stopped}"),
        "W01 07 1",
        "W01 09 10",
        "W01 10 1152",
        "W01 11 576",
        "W01 12 15",
        "W01 23 -200000",
        "W01 24 200000",
        "W01 25 0",
        "W01 26 50",
        "W01 28 700",
        "W01 30 0",
    ] {
        write(port, command);
    }
    assert_eq!(read(port, "00"), 12345);
    for register in ["14", "29", "16"] {
        let _ = read(port, register);
    }
    write(port, "W01 25 1023");
    write(port, &format!("W01 03 {moving}"));
    write(port, "W01 01 7");
    write(port, "V01 0");
    write(port, "P01 12345");
    write(port, "M01 0");
    for command in ["S01 04 6000", "S01 05 35", "S01 06 0", "S01 08 14", "S01 02 128"] {
        write(port, command);
    }
    // stopMoving
    write(port, &format!("W01 03 {stopped}"));
    write(port, "W01 01 0");
    write(port, "W01 25 0");
    assert_eq!((read(port, "01"), read(port, "25"), read(port, "03")), (0, 0, stopped));
}

/// The Java class for lines: two digits for the index, all registers with index 99, whose fields are split at commas.
fn java_lines(port: &mut Port) {
    port.write(b"W01 04 6100\r\n");
    assert_eq!(port.read_line(ms(500)).as_deref(), Some("OK\r"));
    port.write(b"R01 99\r\n");
    let all = port.read_line(ms(500)).expect("all registers come");
    let fields: Vec<&str> = all.trim_end().split(',').collect();
    assert_eq!((fields.len(), fields[4], fields[18], fields[32]), (33, "6100", "4", ""));
    for (index, letter, count) in [(97, 'S', 10), (98, 'F', 16)] {
        port.write(format!("R01 {index}\r\n").as_bytes());
        for bit in 0..count {
            let line = port.read_line(ms(500)).expect("a line a bit");
            let is_on = line == format!("{letter}{bit}ON\r");
            assert!(is_on || line == format!("{letter}{bit}OFF\r"), "{line}");
        }
    }
    port.write(b"Y01\r\n");
    assert_eq!(port.read_line(ms(500)).as_deref(), Some("OK\r"));
}

#[test]
fn drivers_of_the_binary_protocol_find_what_they_expect_in_their_own_time() {
    let binary = |mode, addresses: &[u8]| Port::in_virtual_time(mode, Protocol::Binary, addresses);
    ros_hardware(&mut binary(Mode::SerialPid, &[1]), 1, 4);
    ros_hardware(&mut binary(Mode::AnalogPid, &[2, 4, 6, 8]), 6, 5);
    qnx_class(&mut binary(Mode::SerialPid, &[1]));
    player(&mut binary(Mode::SerialPid, &[1, 2]), 2);
    glk(&mut binary(Mode::SerialPid, &[1, 2]), [1, 2]);
    java_class(&mut binary(Mode::SerialPid, &[1]));
    robo_server_binary(&mut binary(Mode::SerialPid, &[1]));
}

#[test]
fn drivers_of_the_text_protocol_find_what_they_expect_in_their_own_time() {
    for driver in [robo_server_lines, winch, java_lines] {
        driver(&mut Port::in_virtual_time(Mode::SerialPid, Protocol::Text, &[1]));
    }
}

#[test]
fn bytes_up_to_5_ms_apart_make_a_command_and_with_longer_pauses_none() {
    for (pause, is_heard) in [(0, true), (1, true), (4, true), (6, false), (20, false)] {
        let mut port = Port::in_virtual_time(Mode::Serial, Protocol::Binary, &[1]);
        port.write_slowly(&[0x1D, 1, 18, 0x30], ms(pause));
        assert_eq!(port.read(3, ms(50)) == [1, 3, 4], is_heard, "{pause} ms");
    }
    // In text there is no limit.
    let mut port = Port::in_virtual_time(Mode::Serial, Protocol::Text, &[1]);
    port.write_slowly(b"R01 18\r\n", ms(700));
    assert_eq!(port.read_line(ms(50)).as_deref(), Some("MODE=3\r"));
}

/// The built program with units behind a socket or a pseudo-terminal, and a port to them.
fn served(is_pty: bool, options: &[&str]) -> (Program, Option<tempfile::TempDir>, Port) {
    let folder = is_pty.then(|| tempfile::tempdir().expect("a folder can be made"));
    let link = folder.as_ref().map(|folder| folder.path().join("mm").display().to_string());
    let place = match &link {
        Some(link) => ["--pty", link.as_str()],
        None => ["--tcp", "127.0.0.1:0"],
    };
    let arguments = [&["sim", "--model", "motion-mind-3"], &place[..], options].concat();
    let mut program = Program::start(BRUSHWORK, &arguments);
    let greeting = program.next_line(LIMIT).expect("it says where it is");
    let target = link
        .unwrap_or_else(|| format!("tcp:{}", greeting.rsplit("tcp:").next().expect("there is a last part")));
    let target: ConnectTarget = target.parse().expect("the place is a target");
    let line = target.open().expect("somebody is there");
    (program, folder, Port { line, virtual_line: None, began: Instant::now(), waiting: Vec::new() })
}

/// Some drivers leave return bits behind, which others do not expect.
fn clear_function(port: &mut Port) {
    port.write(&summed(vec![24, 1, 3, 0, 0]));
    assert_eq!(port.read(1, ms(100)), [0x06]);
}

#[test]
fn the_same_drivers_run_against_the_built_program_on_a_socket_and_a_pseudo_terminal() {
    for is_pty in [false, true] {
        let (_program, _folder, mut port) = served(is_pty, &["--mode", "4", "--address", "1,2"]);
        ros_hardware(&mut port, 1, 4);
        clear_function(&mut port);
        robo_server_binary(&mut port);
        qnx_class(&mut port);
        // The reset of the last one takes a moment.
        port.sleep(ms(100));
        player(&mut port, 2);
        glk(&mut port, [1, 2]);
        clear_function(&mut port);
        java_class(&mut port);
        for driver in [robo_server_lines, winch, java_lines] {
            let (_program, _folder, mut port) = served(is_pty, &["--mode", "4", "--protocol", "ascii"]);
            driver(&mut port);
        }
    }
}
