//! Conversations byte by byte, in virtual time.

use super::super::number;
use super::super::table::COMMANDS;
use super::*;

const fn ms(millis: u64) -> Duration {
    Duration::from_millis(millis)
}

/// A framer and a clock that moves 1 ms with each byte.
struct Line {
    framer: RequestFramer,
    now: Duration,
}

impl Line {
    fn new(generation: Generation) -> Self {
        Self { framer: RequestFramer::new(generation), now: Duration::ZERO }
    }

    fn send(&mut self, bytes: &[u8]) -> Vec<FramerEvent> {
        bytes.iter().filter_map(|&byte| self.send_byte(byte)).collect()
    }

    fn send_byte(&mut self, byte: u8) -> Option<FramerEvent> {
        self.now += ms(1);
        self.framer.feed(byte, self.now)
    }

    fn wait(&mut self, time: Duration) -> Option<FramerEvent> {
        self.now += time;
        self.framer.silence(self.now)
    }

    /// Sends bytes that must make exactly one request and nothing else.
    fn request(&mut self, bytes: &[u8]) -> Framed {
        match self.send(bytes).as_slice() {
            [FramerEvent::Request(framed)] => framed.clone(),
            other => panic!("{bytes:02X?} gave {other:?}"),
        }
    }

    /// Sends bytes that must make nothing.
    fn nothing(&mut self, bytes: &[u8]) {
        let events = self.send(bytes);
        assert!(events.is_empty(), "{bytes:02X?} gave {events:?}");
    }
}

fn why(event: impl IntoIterator<Item = FramerEvent>) -> Option<(Vec<u8>, DiscardReason)> {
    match event.into_iter().next()? {
        FramerEvent::Discarded(discarded) => Some((discarded.bytes.to_vec(), discarded.why)),
        FramerEvent::Request(_) => None,
    }
}

#[test]
fn a_read_without_arguments_is_whole_after_two_bytes() {
    let mut line = Line::new(Generation::Gen1);
    let framed = line.request(&[
        0x82, // address
        0x5A, // command 90, read status
    ]);
    assert_eq!((framed.address.get(), framed.command.number), (0x82, number::READ_STATUS));
    assert!(framed.values.is_empty() && framed.native);
    assert_eq!(*framed.raw, [0x82, 0x5A]);
}

#[test]
fn a_crc_appended_to_a_read_is_swallowed() {
    let mut line = Line::new(Generation::Gen1);
    line.request(&[0x80, 0x15]); // address, command 21: read version
    line.nothing(&[0x59, 0x0C]); // the CRC that some clients append
    line.request(&[0x80, 0x18]); // the next request is taken at once
}

#[test]
fn an_appended_crc_is_swallowed_when_it_comes_late_and_in_two_pieces() {
    let mut line = Line::new(Generation::Gen1);
    line.request(&[0x80, 0x15]);
    line.now += ms(9);
    line.nothing(&[0x59]); // first byte exactly 10 ms after the request
    line.now += ms(9);
    line.nothing(&[0x0C]); // second byte 10 ms after the first
    assert!(line.wait(ms(50)).is_none());
    line.request(&[0x80, 0x18]);
}

#[test]
fn an_appended_crc_that_starts_like_an_address_is_swallowed() {
    let mut line = Line::new(Generation::Gen4);
    line.request(&[0x80, 0x4D]); // command 77
    line.nothing(&[0x82, 0xF1]); // its CRC: 0x82 is also an address
    line.request(&[0x80, 0x15]);
}

#[test]
fn what_only_starts_like_an_appended_crc_is_a_packet_of_its_own() {
    let mut line = Line::new(Generation::Gen4);
    line.request(&[0x80, 0x4D]); // command 77, whose CRC is 82 F1
    let framed = line.request(&[0x82, 0x15]); // address 0x82, command 21
    assert_eq!((framed.address.get(), framed.command.number), (0x82, number::READ_VERSION));
}

#[test]
fn an_appended_crc_is_expected_once_only() {
    let mut line = Line::new(Generation::Gen1);
    line.request(&[0x80, 0x15]);
    line.nothing(&[0x59, 0x0C]);
    line.nothing(&[0x59, 0x0C]); // again: bytes that start no packet
    assert_eq!(why(line.wait(ms(11))), Some((vec![0x59, 0x0C], DiscardReason::NotAnAddress)));
}

#[test]
fn reads_with_an_argument_are_taken_with_and_without_crc() {
    let mut line = Line::new(Generation::Gen1);
    // Address, command 252, address in the user memory.
    let framed = line.request(&[0x80, 0xFC, 0x10]);
    assert_eq!(framed.values.try_int("address"), Some(0x10));
    let crc = crc16_xmodem(&[0x80, 0xFC, 0x10]).to_be_bytes();
    line.nothing(&crc);
    line.request(&[0x80, 0xFC, 0x10]);
    line.request(&[0x80, 0xFC, 0x12]);

    let mut line = Line::new(Generation::Gen4);
    let framed = line.request(&[
        0x80, // address
        0xBF, // command 191, read CANopen dictionary
        0x05, // node
        0x10, 0x18, // index
        0x02, // subindex
    ]);
    assert_eq!((framed.values.try_int("index"), framed.values.try_int("subindex")), (Some(0x1018), Some(2)));
    line.nothing(&crc16_xmodem(&framed.raw).to_be_bytes());
    // Command 182 has no argument.
    line.request(&[0x80, 0xB6]);
}

#[test]
fn a_write_is_taken_when_its_crc_has_come() {
    let mut line = Line::new(Generation::Gen1);
    let mut packet = vec![
        0x80, // address
        0x22, // command 34, duty of both motors
        0x0C, 0xCC, // M1: 3276
        0x0C, 0xCC, // M2: 3276
    ];
    packet.extend([0xD9, 0x1E]); // CRC
    let framed = line.request(&packet);
    assert_eq!(
        (framed.values.try_int("duty_m1"), framed.values.try_int("duty_m2")),
        (Some(3276), Some(3276))
    );
    line.request(&packet);
}

#[test]
fn a_write_is_taken_at_each_width_that_any_generation_knows() {
    // Number, widths of the payloads.
    let table: [(u8, &[usize]); 14] = [
        (57, &[4, 5]),
        (68, &[4, 8]),
        (69, &[4, 8]),
        (74, &[3, 5]),
        (76, &[2, 4, 24]),
        (80, &[0, 4]),
        (84, &[4, 8]),
        (94, &[0, 4]),
        (102, &[2, 10]),
        (105, &[4, 6]),
        (109, &[4, 8]),
        (143, &[46, 49, 53]),
        (148, &[1, 2]),
        (112, &[4, 8]),
    ];
    for generation in Generation::ALL {
        for (number, widths) in table {
            for &width in widths {
                let mut line = Line::new(generation);
                let events = line.send(&write_packet(number, width));
                let known = lookup(number).and_then(|row| row.form(generation));
                match (known, events.as_slice()) {
                    (Some(form), [FramerEvent::Request(framed)]) => {
                        assert_eq!(framed.native, form.payload_width() == width, "{number} with {width}");
                    }
                    (None, [FramerEvent::Discarded(discarded)]) => {
                        assert_eq!(discarded.why, DiscardReason::NotInGeneration);
                    }
                    other => panic!("{number} with {width} bytes in {generation} gave {other:?}"),
                }
            }
        }
    }
}

#[test]
fn a_write_of_unknown_width_is_dropped_until_the_line_is_silent() {
    let mut line = Line::new(Generation::Gen1);
    // Command 46 has 21 bytes; one client in the field sends 25.
    line.nothing(&write_packet(46, 25));
    line.nothing(&[0x80, 0x15]); // too soon
    assert!(matches!(why(line.wait(ms(11))), Some((_, DiscardReason::BadCrc))));
    line.request(&[0x80, 0x15]);
}

#[test]
fn a_write_with_a_damaged_crc_is_not_taken() {
    let mut line = Line::new(Generation::Gen1);
    let mut packet = write_packet(32, 2);
    packet[5] ^= 0x01;
    line.nothing(&packet);
    assert_eq!(why(line.wait(ms(11))), Some((packet, DiscardReason::BadCrc)));
    line.request(&write_packet(32, 2)[..]);
}

#[test]
fn a_write_whose_address_comes_twice_is_taken() {
    let mut line = Line::new(Generation::Gen1);
    // Address twice, command 32, duty 2000, CRC of the packet without the first address.
    let framed = line.request(&[0x80, 0x80, 32, 0x07, 0xD0, 0x09, 0x14]);
    assert_eq!((framed.command.number, framed.values.try_int("duty")), (number::DUTY_M1, Some(2000)));
    assert_eq!(&*framed.raw, [0x80, 32, 0x07, 0xD0, 0x09, 0x14]);
    // A longer one than command 128, which the second address could be.
    let mut doubled = write_packet(number::SPEED_ACCEL_DISTANCE_BOTH, 21);
    doubled.insert(0, 0x80);
    assert_eq!(line.request(&doubled).command.number, number::SPEED_ACCEL_DISTANCE_BOTH);
    // Command 128 itself, whatever its values look like: L begins as command 24 would, R as command 34.
    let mut resistance = vec![0x80, 128, 0, 24, 0, 24, 34, 0, 0, 0];
    resistance.extend(crc16_xmodem(&resistance).to_be_bytes());
    assert_eq!(line.request(&resistance).command.number, 128);
    // A damaged one is not taken, doubled or not.
    line.nothing(&[0x80, 0x80, 32, 0x07, 0xD0, 0x09, 0x15]);
    assert_eq!(why(line.wait(ms(11))).map(|(bytes, _)| bytes.len()), Some(7));
}

#[test]
fn bytes_that_start_no_packet_are_dropped_and_told_in_one_piece() {
    let mut line = Line::new(Generation::Gen1);
    line.nothing(&[0x00, 0x7F, 0x88, 0xFF]);
    assert_eq!(why(line.send_byte(0x80)), Some((vec![0x00, 0x7F, 0x88, 0xFF], DiscardReason::NotAnAddress)));
    line.request(&[0x15]);
}

#[test]
fn a_pause_of_more_than_ten_milliseconds_discards_the_packet() {
    let mut line = Line::new(Generation::Gen1);
    line.nothing(&[0x80, 0x20, 0x0C]);
    line.now += ms(9);
    line.nothing(&[0xCC]); // 10 ms after the last byte: still the same packet
    line.now += ms(10);
    // 11 ms: what came before is gone, this byte starts anew.
    assert_eq!(why(line.send_byte(0x80)), Some((vec![0x80, 0x20, 0x0C, 0xCC], DiscardReason::Gap)));
    line.request(&[0x15]);
}

#[test]
fn a_stub_frame_does_not_harm_what_follows_a_silence() {
    let mut line = Line::new(Generation::Gen1);
    line.nothing(&[0x80, 0x34]); // command 52 and nothing after it
    line.now += ms(11);
    assert_eq!(why(line.send_byte(0x80)), Some((vec![0x80, 0x34], DiscardReason::Gap)));
    line.request(&[0x18]);
}

#[test]
fn an_unknown_command_is_dropped_with_all_that_follows_until_silence() {
    let mut line = Line::new(Generation::Gen1);
    for unknown in [169, number::READ_SCRIPT] {
        line.nothing(&[0x80, unknown, 0x80, 0x15]);
        assert_eq!(
            why(line.wait(ms(11))),
            Some((vec![0x80, unknown, 0x80, 0x15], DiscardReason::UnknownCommand))
        );
        line.request(&[0x80, 0x15]);
    }
}

#[test]
fn a_read_of_another_generation_is_passed_over_with_its_crc() {
    let mut line = Line::new(Generation::Gen1);
    let events = line.send(&[0x80, 73]); // all status: generation 4 only
    assert_eq!(why(events), Some((vec![0x80, 73], DiscardReason::NotInGeneration)));
    line.nothing(&crc16_xmodem(&[0x80, 73]).to_be_bytes());
    line.request(&[0x80, 0x15]);
}

#[test]
fn a_number_that_changed_direction_is_framed_by_its_own_generation() {
    // Command 100: a read in generations 1 and 4, a write of two bytes in 2 and 3.
    for generation in [Generation::Gen1, Generation::Gen4] {
        Line::new(generation).request(&[0x80, 100]);
    }
    for generation in [Generation::Gen2, Generation::Gen3] {
        let framed = Line::new(generation).request(&write_packet(100, 2));
        assert!(framed.native);
    }
}

#[test]
fn keys_are_handed_over_as_they_came() {
    let mut line = Line::new(Generation::Gen4);
    let framed = line.request(&[
        0x80, // address
        0x5E, // command 94, save settings
        0xE2, 0x2E, 0xAB, 0x7A, // key
        0xE4, 0xA6, // CRC
    ]);
    assert_eq!(framed.values.try_int("key"), Some(0xE22E_AB7A));
    let framed = line.request(&[
        0x80, // address
        0x5E, // command 94 as the manual has it, without a key
        0xA0, 0xA3, // CRC
    ]);
    assert_eq!(framed.values.try_int("key"), None);
    assert!(!framed.native);
}

#[test]
fn requests_may_come_in_pieces_and_back_to_back() {
    let mut line = Line::new(Generation::Gen1);
    let mut bytes = Vec::new();
    for _ in 0..3 {
        bytes.extend(write_packet(37, 8));
        bytes.extend([0x81, 0x18]);
        bytes.extend([0x80, 0x15, 0x59, 0x0C]);
    }
    let requests = line.send(&bytes).len();
    assert_eq!(requests, 9);
}

#[test]
fn every_command_is_framed_from_what_the_client_encodes() {
    for generation in Generation::ALL {
        for command in COMMANDS {
            let Some(form) = command.form(generation) else { continue };
            let payload = vec![0; form.payload_width()];
            let values = parse_payload(form.request, &payload).expect("the width of the layout");
            let request =
                Request { address: Address::LAST, command: command.number, values: values.values().to_vec() };
            let framed = Line::new(generation).request(&request.encode(generation).expect("fits"));
            assert_eq!(framed.request(), request);
            assert!(framed.native && framed.values == values, "{} in {generation}", command.key);
        }
    }
}

#[test]
fn no_appended_crc_looks_like_a_packet_of_the_same_address() {
    for address in Address::ALL {
        for command in COMMANDS {
            let reads =
                command.forms.iter().any(|form| form.direction == Direction::Read && form.request.is_empty());
            let [first, second] = crc16_xmodem(&[address.get(), command.number]).to_be_bytes();
            let alike = first == address.get() && lookup(second).is_some_and(|row| !row.forms.is_empty());
            assert!(!(reads && alike), "{address} {}", command.key);
        }
    }
}

#[test]
fn time_that_stands_still_or_runs_backwards_does_no_harm() {
    let mut framer = RequestFramer::new(Generation::Gen1);
    assert!(framer.feed(0x80, ms(100)).is_none());
    assert!(matches!(framer.feed(0x15, ms(50)), Some(FramerEvent::Request(_))));
    assert!(framer.silence(Duration::MAX).is_none());
    assert!(framer.feed(0x80, Duration::MAX).is_none());
    assert!(matches!(framer.feed(0x15, Duration::MAX), Some(FramerEvent::Request(_))));
}

#[test]
fn the_longest_request_fits() {
    let longest = COMMANDS.iter().flat_map(|row| row.payloads(Direction::Write)).map(request_width).max();
    assert_eq!(longest.map(|width| width + 4), Some(LONGEST_REQUEST));
    const { assert!(LONGEST_REQUEST <= RawBytes::CAPACITY) };
}

/// A write to 0x80 with a payload of zeros.
fn write_packet(number: u8, width: usize) -> Vec<u8> {
    let mut packet = vec![0x80, number];
    packet.resize(2 + width, 0);
    packet.extend(crc16_xmodem(&packet).to_be_bytes());
    packet
}
