//! Bytes that others have put on the wire, in both directions: captures, vendor examples, CRCs that public clients send.

use std::time::Duration;

use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{
    Address, Framed, FramerEvent, Generation, ReplyProgress, Request, RequestFramer, encode_reply, number,
    parse_reply,
};
use brushwork_values::Value;

const AT_80: Address = Address::DEFAULT;

fn framed(generation: Generation, bytes: &[u8]) -> Framed {
    let mut framer = RequestFramer::new(generation);
    let mut events: Vec<FramerEvent> =
        bytes.iter().filter_map(|&byte| framer.feed(byte, Duration::ZERO)).collect();
    match (events.pop(), events.is_empty()) {
        (Some(FramerEvent::Request(framed)), true) => framed,
        other => panic!("{bytes:02X?} gave {other:?} after {events:?}"),
    }
}

/// The request encodes to these bytes, and these bytes are framed as the request.
fn both_ways(generation: Generation, request: &Request, bytes: &[u8]) {
    assert_eq!(request.encode(generation).expect("fits"), bytes);
    let framed = framed(generation, bytes);
    assert_eq!(framed.address, request.address);
    assert_eq!(framed.command.number, request.command);
    assert_eq!(framed.values, request.arguments(generation).expect("fits"));
}

/// The controller answers with these bytes, and the client reads these values from them.
fn reply_both_ways(generation: Generation, request: &Request, values: &[Value], bytes: &[u8]) {
    assert_eq!(encode_reply(request, generation, values).expect("fits"), bytes);
    match parse_reply(request, generation, bytes) {
        ReplyProgress::Done { values: got, used } => {
            assert_eq!(got.values(), values);
            assert_eq!(used, bytes.len());
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn version_of_a_roboclaw_2x7a_as_captured() {
    let request = Request::new(AT_80, number::READ_VERSION, &[]);
    both_ways(
        Generation::Gen3,
        &request,
        &[
            0x80, // address
            0x15, // command 21
        ],
    );
    // Some clients append this CRC; hardware ignored it.
    assert_eq!(crc16_xmodem(&[0x80, 0x15]), 0x590C);

    let mut bytes = b"USB Roboclaw 2x7a v4.2.8".to_vec(); // model, blank, version
    bytes.push(0x0A); // line feed
    bytes.push(0x00); // end of text
    bytes.extend([0xAC, 0x9E]); // CRC over address, command, text
    reply_both_ways(Generation::Gen3, &request, &["USB Roboclaw 2x7a v4.2.8".into()], &bytes);
}

#[test]
fn position_move_of_the_vendors_example_has_a_negative_speed() {
    let request = Request::new(AT_80, number::POSITION_PROFILE_M2, &[3000, -2000, 3000, 11_520, 1]);
    let bytes = [
        0x80, // address
        0x42, // command 66, M2 position with profile
        0x00, 0x00, 0x0B, 0xB8, // acceleration 3000 counts/s²
        0xFF, 0xFF, 0xF8, 0x30, // speed -2000 counts/s
        0x00, 0x00, 0x0B, 0xB8, // deceleration 3000 counts/s²
        0x00, 0x00, 0x2D, 0x00, // position 11520
        0x01, // buffer: at once
        0xC6, 0x0E, // CRC
    ];
    both_ways(Generation::Gen1, &request, &bytes);
}

#[test]
fn the_loader_is_entered_with_its_marks() {
    let request = Request::new(AT_80, number::ENTER_LOADER, &[]);
    let bytes = [
        0x80, // address
        0xFF, // command 255
        0xFF, // mark
        0xA5, 0xA5, 0x12, 0x34, // key
        0xB6, 0x70, // CRC
    ];
    both_ways(Generation::Gen1, &request, &bytes);
}

#[test]
fn crcs_of_short_packets_are_those_that_several_clients_send() {
    let table = [
        (0x10, 0x09A9), // read M1 encoder
        (0x11, 0x1988), // read M2 encoder
        (0x12, 0x29EB), // read M1 speed
        (0x13, 0x39CA), // read M2 speed
        (0x14, 0x492D), // zero both encoders
        (0x18, 0x88A1), // read main battery
        (0x19, 0x9880), // read logic battery
        (0x31, 0x3DEA), // read motor currents
        (0x37, 0x5D2C), // read M1 velocity PID
        (0x38, 0xACC3), // read M2 velocity PID
        (0x3B, 0x9CA0), // read main voltage limits
        (0x3C, 0xEC47), // read logic voltage limits
        (0x3F, 0xDC24), // read M1 position PID
        (0x52, 0x612F), // read temperature 1
        (0x5A, 0xE027), // read status
        (0x5F, 0xB082), // reload settings
        (0x63, 0x475D), // read configuration word
        (0x50, 0x416D), // restore defaults without key
        (0x5E, 0xA0A3), // save settings without key
        (0xC8, 0x43DC), // reset E-stop
    ];
    for (command, crc) in table {
        assert_eq!(crc16_xmodem(&[0x80, command]), crc, "command {command}");
        // Appended to a read or needed by a write, the packet is framed either way.
        let [high, low] = u16::to_be_bytes(crc);
        let mut framer = RequestFramer::new(Generation::Gen1);
        let events: Vec<FramerEvent> = [0x80, command, high, low]
            .into_iter()
            .filter_map(|byte| framer.feed(byte, Duration::ZERO))
            .collect();
        assert!(matches!(events.as_slice(), [FramerEvent::Request(_)]), "command {command} gave {events:?}");
    }
}

#[test]
fn settings_are_saved_and_restored_with_the_key() {
    both_ways(
        Generation::Gen1,
        &Request::new(AT_80, number::SAVE_SETTINGS, &[]),
        &[
            0x80, // address
            0x5E, // command 94
            0xE2, 0x2E, 0xAB, 0x7A, // key
            0xE4, 0xA6, // CRC
        ],
    );
    both_ways(
        Generation::Gen3,
        &Request::new(AT_80, number::RESTORE_DEFAULTS, &[]),
        &[
            0x80, // address
            0x50, // command 80
            0xE2, 0x2E, 0xAB, 0x7A, // key
            0x2B, 0x0E, // CRC
        ],
    );
    both_ways(
        Generation::Gen1,
        &Request::new(AT_80, number::RESTORE_DEFAULTS, &[]),
        &[
            0x80, // address
            0x50, // command 80, as the manual has it
            0x41, 0x6D, // CRC
        ],
    );
}

#[test]
fn writes_without_data_and_writes_with_data() {
    both_ways(
        Generation::Gen1,
        &Request::new(AT_80, number::RESET_ESTOP, &[]),
        &[
            0x80, // address
            0xC8, // command 200
            0x43, 0xDC, // CRC
        ],
    );
    both_ways(
        Generation::Gen1,
        &Request::new(AT_80, number::DUTY_BOTH, &[0x0CCC, 0x0CCC]),
        &[
            0x80, // address
            0x22, // command 34
            0x0C, 0xCC, // M1: 10 % of 32767
            0x0C, 0xCC, // M2: 10 % of 32767
            0xD9, 0x1E, // CRC
        ],
    );
    both_ways(
        Generation::Gen1,
        &Request::new(AT_80, number::SET_VELOCITY_PID_M1, &[0x4000, 0x1_0000, 0x8000, 44_000]),
        &[
            0x80, // address
            0x1C, // command 28
            0x00, 0x00, 0x40, 0x00, // D 0.25
            0x00, 0x01, 0x00, 0x00, // P 1.0
            0x00, 0x00, 0x80, 0x00, // I 0.5
            0x00, 0x00, 0xAB, 0xE0, // QPPS 44000
            0x26, 0xFA, // CRC
        ],
    );
}

#[test]
fn a_battery_of_24_3_volts_is_read() {
    let request = Request::new(AT_80, number::READ_MAIN_BATTERY, &[]);
    let bytes = [
        0x00, 0xF3, // 243 tenths of a volt
        0xE8, 0x86, // CRC over 80 18 00 F3
    ];
    reply_both_ways(Generation::Gen1, &request, &[Value::Int(243)], &bytes);
}

#[test]
fn a_write_is_answered_with_ff_and_no_crc() {
    let request = Request::new(AT_80, number::RESET_ENCODERS, &[]);
    reply_both_ways(Generation::Gen1, &request, &[], &[0xFF]);
    assert_eq!(parse_reply(&request, Generation::Gen1, &[0x00]), ReplyProgress::BadAck { got: 0x00 });
}

#[test]
fn the_crc_of_a_read_with_an_argument_covers_the_argument() {
    let request = Request::new(AT_80, number::READ_USER_MEMORY, &[0x10]);
    let mut bytes = vec![
        0x12, 0x34, // the word
    ];
    let crc = crc16_xmodem(&[0x80, 0xFC, 0x10, 0x12, 0x34]);
    bytes.extend(crc.to_be_bytes());
    reply_both_ways(Generation::Gen1, &request, &[Value::Int(0x1234)], &bytes);
}

#[test]
fn a_can_dictionary_write_is_answered_in_two_parts_with_a_crc_that_starts_anew() {
    let request = Request::new(AT_80, number::WRITE_CAN_DICTIONARY, &[1, 0x1018, 2, 7, 4]);
    let mut bytes = vec![
        0xFF, // acknowledgement, outside the CRC
        0x00, 0x00, 0x00, 0x05, // result
    ];
    bytes.extend(crc16_xmodem(&[0x00, 0x00, 0x00, 0x05]).to_be_bytes());
    reply_both_ways(Generation::Gen4, &request, &[Value::Int(5)], &bytes);
}

#[test]
fn an_erased_script_is_acknowledged_twice() {
    let request = Request::new(AT_80, number::ERASE_SCRIPT, &[]);
    let packet = request.encode(Generation::Gen1).expect("fits");
    assert_eq!(packet[..4], [0x80, 0xFA, 0x55, 0xAA]);
    reply_both_ways(Generation::Gen1, &request, &[Value::Int(0)], &[0xFF, 0x00]);
    // Between the two bytes seconds may pass.
    let after_first = parse_reply(&request, Generation::Gen1, &[0xFF]);
    assert_eq!(after_first, ReplyProgress::NeedMore { at_least: 2 });
}

#[test]
fn a_serial_number_is_padded_to_36_bytes() {
    let request = Request::new(AT_80, number::READ_SERIAL_NUMBER, &[]);
    let text = [Value::from("AB-12")];

    let mut ascii = vec![5]; // length
    ascii.extend(b"AB-12"); // text
    ascii.resize(37, 0); // padding
    ascii.extend(crc16_xmodem(&[&[0x80, 0x61], ascii.as_slice()].concat()).to_be_bytes());
    reply_both_ways(Generation::Gen4, &request, &text, &ascii);

    let mut utf16 = vec![10]; // length in bytes
    utf16.extend([b'A', 0, b'B', 0, b'-', 0, b'1', 0, b'2', 0]); // text, low byte first
    utf16.resize(37, 0); // padding
    utf16.extend(crc16_xmodem(&[&[0x80, 0x61], utf16.as_slice()].concat()).to_be_bytes());
    reply_both_ways(Generation::Gen3, &request, &text, &utf16);
}

#[test]
fn digital_output_actions_come_with_their_count() {
    let request = Request::new(AT_80, number::READ_DOUT_ACTIONS, &[]);
    let mut bytes = vec![
        0x03, // count
        0x07, // over voltage
        0x00, // none
        0x0B, // error LED
    ];
    bytes.extend(crc16_xmodem(&[0x80, 0x8A, 0x03, 0x07, 0x00, 0x0B]).to_be_bytes());
    let records = Value::Records(vec![vec![7], vec![0], vec![11]]);
    reply_both_ways(Generation::Gen1, &request, &[records], &bytes);
}

#[test]
fn a_reply_of_another_generation_shows_by_its_crc_and_length() {
    let request = Request::new(AT_80, number::READ_STATUS, &[]);
    let wide = encode_reply(&request, Generation::Gen3, &[Value::Int(0x0001_0001)]).expect("fits");
    assert_eq!(wide.len(), 6);
    assert!(matches!(parse_reply(&request, Generation::Gen1, &wide), ReplyProgress::BadCrc { used: 4, .. }));
    let narrow = encode_reply(&request, Generation::Gen1, &[Value::Int(1)]).expect("fits");
    let wanted = ReplyProgress::NeedMore { at_least: 6 };
    assert_eq!(parse_reply(&request, Generation::Gen3, &narrow), wanted);
}
