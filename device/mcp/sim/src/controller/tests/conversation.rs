//! What is on the wire: silence, timing, addresses, several units.

use super::support::Bench;
use crate::controller::{Bus, BusError, Controller, ControllerConfig, FAST_TURNAROUND, SLOW_TURNAROUND};
use brushwork_mcp_wire::packet_serial::{Address, Generation, commands, name, number};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use std::time::Duration;

fn unit_at(address: Address) -> Controller {
    Controller::new(ControllerConfig { address, ..ControllerConfig::default() }).expect("the preset is valid")
}

#[test]
fn the_version_is_answered_byte_for_byte() {
    let mut bench = Bench::new(Generation::Gen1);
    let reply = bench.raw(&[0x80, 0x15]); // address, command 21
    let (text, crc) = reply.split_at(reply.len() - 2);
    assert_eq!(text, b"MCP266 2x60A v1.0.0\n\0");
    let covered: Vec<u8> = [0x80, 0x15].iter().chain(text).copied().collect();
    assert_eq!(crc, brushwork_mcp_wire::crc::crc16_xmodem(&covered).to_be_bytes());
}

#[test]
fn a_duty_command_is_acknowledged_and_turns_the_motor() {
    let mut bench = Bench::new(Generation::Gen1);
    assert!(bench.ask_row(commands::DUTY_M1.number(), &[16_384]).is_empty());
    bench.wait_talking(Duration::from_millis(500));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 16_384);
    assert!(bench.read(commands::READ_ENCODER_M1, name::ENCODER) > 100);
    assert!(bench.read(commands::READ_SPEED_M1, name::SPEED) > 100);
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M2), 0);
}

#[test]
fn a_bad_crc_an_unknown_command_and_a_stub_are_met_with_silence() {
    let mut bench = Bench::new(Generation::Gen1);
    assert!(bench.raw(&[0x80, 32, 0x40, 0x00, 0x12, 0x34]).is_empty()); // duty with a wrong CRC
    assert!(bench.raw(&[0x80, 240]).is_empty()); // no such command
    assert!(bench.raw(&[0x80, 52]).is_empty()); // nothing after the command
    assert!(bench.raw(&[0x12, 0x34]).is_empty()); // no address
    assert!(!bench.raw(&[0x80, 90]).is_empty());
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0);
}

#[test]
fn a_request_in_pieces_is_one_request_unless_the_pieces_are_more_than_10_ms_apart() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.bus.receive(StreamIndex::Usb, &[0x80]);
    bench.wait(Duration::from_millis(10));
    assert!(!bench.raw(&[24]).is_empty());
    bench.bus.receive(StreamIndex::Usb, &[0x80]);
    bench.wait(Duration::from_millis(11));
    assert!(bench.raw(&[24]).is_empty());
}

#[test]
fn an_appended_crc_is_swallowed_even_after_the_reply_has_left() {
    let mut bench = Bench::new(Generation::Gen1);
    assert!(!bench.raw(&[0x80, 90]).is_empty());
    bench.bus.receive(StreamIndex::Usb, &[0xe0, 0x27]); // CRC of 80 5A
    assert!(!bench.raw(&[0x80, 24]).is_empty());
}

#[test]
fn usb_answers_all_eight_addresses_and_a_uart_only_its_own() {
    let config = ControllerConfig { address: Address::ALL[3], ..ControllerConfig::default() };
    let mut usb = Bench::of(config.clone());
    let mut uart = Bench::on(config, StreamIndex::Uart1);
    for address in Address::ALL {
        let request = [address.get(), 24];
        assert!(!usb.raw(&request).is_empty(), "{address}");
        assert_eq!(!uart.raw(&request).is_empty(), address == Address::ALL[3], "{address}");
    }
}

#[test]
fn slow_ports_wait_a_millisecond_before_they_answer() {
    for (rate, turnaround) in [(38_400, SLOW_TURNAROUND), (115_200, FAST_TURNAROUND)] {
        let mut bench = Bench::on(ControllerConfig::default(), StreamIndex::Uart0);
        bench.ask(commands::SET_STREAM, &[1, 1, rate, 0]);
        let asked_at = bench.bus.now();
        bench.bus.receive(StreamIndex::Uart0, &[0x80, 24]);
        assert_eq!(bench.bus.next_output_at(), Some(asked_at + turnaround), "{rate} bit/s");
        assert_eq!(bench.bus.take_output(StreamIndex::Uart0), None);
    }
}

#[test]
fn requests_sent_in_a_row_are_answered_in_order_one_write_each() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.bus.receive(StreamIndex::Usb, &[0x80, 24, 0x80, 90, 0x80, 21]);
    bench.wait(Duration::from_millis(1));
    let replies: Vec<usize> =
        std::iter::from_fn(|| bench.bus.take_output(StreamIndex::Usb)).map(|reply| reply.len()).collect();
    assert_eq!(replies, [4, 4, 23]); // u16 + CRC, u16 + CRC, 21 bytes of text + CRC
}

#[test]
fn units_on_one_wire_answer_each_to_their_own_address() {
    let units = vec![unit_at(Address::ALL[0]), unit_at(Address::ALL[5])];
    let mut bus = Bus::new(units, StreamIndex::Uart1).expect("a TTL wire");
    let timeout = Duration::from_millis(20);
    for (address, answers) in [(0x80, true), (0x85, true), (0x81, false)] {
        assert_eq!(!bus.exchange(&[address, 24], timeout).is_empty(), answers, "{address:02x}");
    }
    assert_eq!(bus.next_output_at(), None, "nobody else had anything to say");
}

#[test]
fn a_bus_of_several_needs_a_wire_that_takes_several() {
    let units = || vec![unit_at(Address::ALL[0]), unit_at(Address::ALL[1])];
    assert_eq!(Bus::new(units(), StreamIndex::Usb).err(), Some(BusError::NotABus(StreamIndex::Usb)));
    assert_eq!(Bus::new(units(), StreamIndex::Uart0).err(), Some(BusError::NotABus(StreamIndex::Uart0)));
    assert_eq!(Bus::new(Vec::new(), StreamIndex::Uart1).err(), Some(BusError::Empty));
}

#[test]
fn a_stream_in_mcl_mode_or_disabled_does_not_answer() {
    for kind in [0, 2] {
        let mut bench = Bench::new(Generation::Gen1);
        bench.ask(commands::SET_STREAM, &[2, kind, 115_200, 1000]); // TTL UART1
        bench.bus.receive(StreamIndex::Uart1, &[0x80, 24]);
        bench.wait(Duration::from_millis(20));
        assert_eq!(bench.bus.take_output(StreamIndex::Uart1), None);
        assert!(!bench.raw(&[0x80, 24]).is_empty(), "USB still does");
    }
}

#[test]
fn nothing_is_answered_without_power_or_with_the_plug_out() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.apply(&WorldAction::Power { on: false });
    assert!(bench.raw(&[0x80, 24]).is_empty());
    bench.apply(&WorldAction::Power { on: true });
    assert!(!bench.raw(&[0x80, 24]).is_empty());
    bench.apply(&WorldAction::Unplug { unplugged: true });
    assert!(bench.raw(&[0x80, 24]).is_empty());
    bench.apply(&WorldAction::Unplug { unplugged: false });
    assert!(!bench.raw(&[0x80, 24]).is_empty());
}

#[test]
fn legacy_commands_drive_silently_where_the_firmware_is_of_that_kind() {
    let mut config = ControllerConfig::default();
    config.options.acknowledges_legacy = false;
    let mut bench = Bench::of(config);
    assert!(bench.try_ask(number::FORWARD_M1, &[127]).is_none());
    bench.wait(Duration::from_millis(300));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 32_767);
    assert!(Bench::new(Generation::Gen1).try_ask(number::FORWARD_M1, &[127]).is_some());
}

#[test]
fn what_is_read_is_what_the_unit_knows() {
    let mut bench = Bench::new(Generation::Gen4);
    bench.ask(commands::DUTY_BOTH, &[16_384, -8_000]);
    bench.wait_talking(Duration::from_millis(700));
    let [main, logic, first, second] = bench.unit().unit().expect("it has power").supply_raw();
    let all = bench.ask(commands::READ_ALL_STATUS, &[]);
    let unit = bench.unit().unit().expect("it has power");
    assert_eq!((all.int(name::MAIN_BATTERY), all.int(name::LOGIC_BATTERY)), (main, logic));
    assert_eq!((all.int(name::TEMPERATURE_1), all.int(name::TEMPERATURE_2)), (first, second));
    let of = |m1: [i64; 4], m2: [i64; 4]| [(Motor::M1, m1), (Motor::M2, m2)];
    for (motor, [duty, encoder, speed, current]) in of(
        [
            all.int(name::DUTY_M1),
            all.int(name::ENCODER_M1),
            all.int(name::SPEED_M1),
            all.int(name::CURRENT_M1),
        ],
        [
            all.int(name::DUTY_M2),
            all.int(name::ENCODER_M2),
            all.int(name::SPEED_M2),
            all.int(name::CURRENT_M2),
        ],
    ) {
        let channel = unit.channel(motor);
        assert_eq!(duty, i64::from(channel.duty_raw()));
        assert_eq!(encoder, i64::from(channel.encoder().position()));
        assert_eq!(speed, i64::from(channel.speeds().filtered));
        assert_eq!(current, unit.current_raw(motor));
    }
    assert_eq!(all.int(name::STATUS), i64::from(unit.status_word()));
    assert!(main > 200 && all.int(name::ENCODER_M1) > 0 && all.int(name::ENCODER_M2) < 0);
}

/// MCP manual 2.2.5: "If the packet was not valid for any reason no acknowledgement will be sent back."
#[test]
fn a_value_beyond_its_valid_range_is_not_acknowledged_and_changes_nothing() {
    for generation in Generation::ALL {
        let mut bench = Bench::new(generation);
        let before = bench.unit().settings();
        // Command 0: "Valid data range is 0 - 127". 2: "0 - 140". 139: levels are 0 to 3. 141: "0x80 to 0x87", flag 0 or 1.
        // 148: 0 or 1. 32: "-32767 to +32767".
        let refused: [(u8, &[i64]); 8] = [
            (number::FORWARD_M1, &[200]),
            (number::SET_MAIN_VOLTAGE_MIN, &[141]),
            (number::SET_PRIORITIES, &[1, 2, 4]),
            (number::SET_ADDRESS_MIXED, &[0x88, 0]),
            (number::SET_ADDRESS_MIXED, &[0x80, 2]),
            (number::DUTY_M1, &[-32_768]),
            (number::DUTY_ACCEL_M1, &[100, 655_360]),
            (number::SET_DOUT_ACTION, &[0, 12]),
        ];
        for (command, values) in refused {
            assert!(bench.try_ask(command, values).is_none(), "{command} {values:?} in {generation}");
        }
        bench.wait(Duration::from_millis(100));
        assert_eq!(bench.unit().settings(), before, "{generation}");
        assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0, "{generation}");
        let taken: [(u8, &[i64]); 4] = [
            (number::FORWARD_M1, &[127]),
            (number::SET_PRIORITIES, &[1, 2, 3]),
            (number::SET_ADDRESS_MIXED, &[0x80, 1]),
            (number::DUTY_M1, &[-32_767]),
        ];
        for (command, values) in taken {
            assert!(bench.try_ask(command, values).is_some(), "{command} {values:?} in {generation}");
        }
    }
}
