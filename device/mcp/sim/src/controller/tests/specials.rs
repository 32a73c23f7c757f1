//! Relay tests, scripts, the loader, CAN, and requests in the widths of other generations.

use super::support::Bench;
use crate::controller::ERASE_TIME;
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{Generation, Request, commands, name, number};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_values::Value;
use std::time::Duration;

fn with_crc(bytes: &[u8]) -> Vec<u8> {
    [bytes, &crc16_xmodem(bytes).to_be_bytes()].concat()
}

fn next_write(bench: &mut Bench, within: Duration) -> Option<Vec<u8>> {
    bench.wait(within);
    bench.bus.take_output(StreamIndex::Usb)
}

#[test]
fn a_relay_test_finds_an_amplitude_and_a_period() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SET_VELOCITY_PID_M1, &[0, 65_536, 0, 8_000]);
    assert_eq!(bench.read(commands::READ_AUTOTUNE_M1, name::PERIOD), 0);
    bench.ask(commands::AUTOTUNE_VELOCITY_M1, &[12_000]);
    bench.wait_talking(Duration::from_secs(12));
    let result = bench.ask(commands::READ_AUTOTUNE_M1, &[]);
    assert!(result.int(name::AMPLITUDE) > 0 && result.int(name::PERIOD) > 0, "{result:?}");
    assert_eq!(bench.read(commands::READ_AUTOTUNE_M2, name::PERIOD), 0);
}

#[test]
fn an_erase_is_acknowledged_at_once_and_confirmed_when_it_is_done() {
    let mut bench = Bench::new(Generation::Gen1);
    let block: Vec<u8> = [&[0x80, 251, 0, 1, 0][..], &[0xab; 16]].concat(); // 16 bytes at 0x000100
    assert_eq!(bench.raw(&with_crc(&block)), [0xff]);
    assert_eq!(next_write(&mut bench, Duration::from_millis(10)), Some(vec![0xff]));
    assert_eq!(bench.unit().script_image()[0x100..], [0xab; 16]);
    assert_eq!(bench.raw(&with_crc(&[0x80, 250, 0x55, 0xaa])), [0xff]);
    assert_eq!(next_write(&mut bench, Duration::from_millis(1_000)), None);
    assert_eq!(next_write(&mut bench, Duration::from_millis(600)), Some(vec![0xff]));
    assert!(bench.unit().script_image().is_empty());
}

#[test]
fn a_block_outside_the_memory_is_not_stored_and_said_to_be_so() {
    let mut bench = Bench::new(Generation::Gen1);
    let block: Vec<u8> = [&[0x80, 251, 0xff, 0xff, 0xf8][..], &[1; 16]].concat();
    assert_eq!(bench.raw(&with_crc(&block)), [0xff]);
    assert_eq!(next_write(&mut bench, Duration::from_millis(10)), Some(vec![0]));
}

#[test]
fn a_stored_script_is_started_stopped_and_run_by_itself_after_its_delay() {
    use brushwork_plant::world::WorldAction;
    let mut bench = Bench::new(Generation::Gen1);
    let runs = |bench: &Bench| bench.unit().unit().expect("it has power").script_is_running();
    assert_eq!(bench.raw(&with_crc(&[0x80, 248])), [0], "there is none");
    bench.raw(&with_crc(&[&[0x80, 251, 0, 0, 0][..], &[0xab; 16]].concat()));
    bench.wait(Duration::from_millis(10));
    let _ = bench.bus.take_output(StreamIndex::Usb);
    assert_eq!(bench.raw(&with_crc(&[0x80, 248])), [0], "it is no image of ours");
    bench.install("main\ngoto main\n");
    bench.ask(commands::START_SCRIPT, &[]);
    assert!(runs(&bench));
    bench.ask(commands::STOP_SCRIPT, &[]);
    assert!(!runs(&bench));
    bench.ask(commands::SET_SCRIPT_AUTORUN, &[500]);
    bench.ask(commands::SAVE_SETTINGS, &[]);
    bench.wait(Duration::from_secs(1));
    bench.apply(&WorldAction::Power { on: false });
    bench.apply(&WorldAction::Power { on: true });
    bench.wait(Duration::from_millis(450));
    assert!(!runs(&bench));
    bench.wait(Duration::from_millis(100));
    assert!(runs(&bench));
}

#[test]
fn the_loader_takes_an_image_and_restarts_the_unit() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::DUTY_M1, &[10_000]);
    assert_eq!(bench.raw(&with_crc(&[0x80, 255, 0xff, 0xa5, 0xa5, 0x12, 0x34])), [0xff]);
    assert!(bench.raw(&[0x80, 24]).is_empty(), "packets are over");
    assert!(bench.unit().unit().expect("it has power").is_in_loader());
    assert!(bench.raw(&[0x01]).is_empty(), "it erases");
    bench.wait(ERASE_TIME);
    assert_eq!(bench.bus.take_output(StreamIndex::Usb), Some(vec![0xaa]));
    for _ in 0..0xf_0000 / 256 {
        assert_eq!(bench.raw(&[0x5a; 256]), [0xaa]);
    }
    bench.raw(&[0x04]);
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0);
    assert!(!bench.unit().unit().expect("it has power").is_in_loader());
}

#[test]
fn can_frames_come_back_and_the_dictionary_mirrors_commands() {
    let mut bench = Bench::new(Generation::Gen4);
    assert_eq!(bench.read(commands::GET_CAN_PACKET, name::PRESENT), 0);
    let put = Request {
        address: bench.address,
        command: number::PUT_CAN_PACKET,
        values: vec![
            Value::Int(0x181),
            Value::Int(0),
            Value::Int(3),
            Value::Bytes(vec![1, 2, 3, 0, 0, 0, 0, 0]),
        ],
    };
    bench.try_send(&put).expect("acknowledged");
    let got = bench.ask(commands::GET_CAN_PACKET, &[]);
    assert_eq!((got.int(name::PRESENT), got.int(name::COB_ID), got.int(name::LENGTH)), (0xff, 0x181, 3));
    assert_eq!(got.bytes(name::DATA), Some(&[1, 2, 3, 0, 0, 0, 0, 0][..]));

    let main = bench.read(commands::READ_MAIN_BATTERY, name::MAIN_BATTERY);
    let object = bench.ask(commands::READ_CAN_DICTIONARY, &[1, 0x2000 + 24, 0]);
    assert_eq!((object.int(name::VALUE), object.int(name::SIZE), object.int(name::RESULT)), (main, 2, 0));
    let missing = bench.ask(commands::READ_CAN_DICTIONARY, &[1, 0x1f50, 1]);
    assert_eq!(missing.int(name::RESULT), 0x0602_0000);
    // Node 1, object 0x6000 sub 2, value 77 in one byte.
    assert_eq!(bench.ask(commands::WRITE_CAN_DICTIONARY, &[1, 0x6000, 2, 77, 1]).int(name::RESULT), 0);
    assert_eq!(bench.ask(commands::READ_CAN_DICTIONARY, &[1, 0x6000, 2]).int(name::VALUE), 77);
}

#[test]
fn writes_in_the_width_of_another_generation_are_taken_and_leave_the_rest_as_it_was() {
    let mut bench = Bench::new(Generation::Gen4);
    bench.ask(commands::SET_MAIN_VOLTAGES, &[100, 300, 9]);
    // 57 in the four bytes of generations 1 to 3: min 11.0 V, max 29.0 V.
    assert_eq!(bench.raw(&with_crc(&[0x80, 57, 0, 110, 1, 34])), [0xff]);
    let limits = bench.ask(commands::READ_MAIN_VOLTAGES, &[]);
    assert_eq!(
        (limits.int(name::MIN), limits.int(name::MAX), limits.try_int(name::AUTO_OFFSET)),
        (110, 290, Some(9))
    );
    // 148 in the one byte of generations 1 and 2 sets both motors.
    assert_eq!(bench.raw(&with_crc(&[0x80, 148, 1])), [0xff]);
    let modes = bench.ask(commands::READ_PWM_MODE, &[]);
    assert_eq!((modes.try_int(name::MODE_M1), modes.try_int(name::MODE_M2)), (Some(1), Some(1)));
    // 68 in the four bytes of generation 1 leaves the deceleration.
    bench.ask(commands::SET_DEFAULT_ACCEL_M1, &[1_000, 2_000]);
    assert_eq!(bench.raw(&with_crc(&[0x80, 68, 0, 0, 0x0b, 0xb8])), [0xff]);
    let accels = bench.ask(commands::READ_DEFAULT_ACCELS, &[]);
    assert_eq!((accels.int(name::ACCEL_M1), accels.try_int(name::DECEL_M1)), (3_000, Some(2_000)));
}

#[test]
fn generation_1_keeps_one_default_acceleration_for_both_directions() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SET_DEFAULT_ACCEL_M2, &[32_768]);
    let motion = bench.unit().settings().motors[1].motion;
    assert_eq!((motion.default_accel_raw, motion.default_decel_raw), (32_768, 32_768));
}

#[test]
fn seven_bit_and_mixed_commands_drive_as_the_manual_says() {
    let mut bench = Bench::new(Generation::Gen1);
    let duties = |bench: &mut Bench| {
        bench.wait_talking(Duration::from_millis(400));
        let pwm = bench.ask(commands::READ_PWMS, &[]);
        (pwm.int(name::DUTY_M1), pwm.int(name::DUTY_M2))
    };
    bench.ask(commands::FORWARD_M1, &[127]);
    bench.ask(commands::BACKWARD_M2, &[127]);
    assert_eq!(duties(&mut bench), (32_767, -32_767));
    bench.ask(commands::DRIVE_7BIT_M1, &[64]);
    bench.ask(commands::DRIVE_7BIT_M2, &[0]);
    assert_eq!(duties(&mut bench), (0, -32_767));
    bench.ask(commands::DRIVE_7BIT_M2, &[64]);
    bench.ask(commands::MIXED_FORWARD, &[127]);
    assert_eq!(duties(&mut bench), (0, 0), "mixed mode waits for drive and turn");
    bench.ask(commands::MIXED_RIGHT, &[0]);
    assert_eq!(duties(&mut bench), (32_767, 32_767));
    bench.ask(commands::MIXED_TURN_7BIT, &[64]); // 64 stops the turn, whatever the manual's text for 13 says
    assert_eq!(duties(&mut bench), (32_767, 32_767));
}

#[test]
fn the_old_voltage_commands_set_single_limits() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SET_MAIN_VOLTAGE_MIN, &[25]); // 6 V + 25 x 0.2 V = 11 V
    bench.ask(commands::SET_MAIN_VOLTAGE_MAX, &[123]); // 123 / 5.12 = 24.0 V
    bench.ask(commands::SET_LOGIC_VOLTAGE_MIN, &[0]);
    bench.ask(commands::SET_LOGIC_VOLTAGE_MAX, &[62]); // 12.1 V
    let (main, logic) =
        (bench.ask(commands::READ_MAIN_VOLTAGES, &[]), bench.ask(commands::READ_LOGIC_VOLTAGES, &[]));
    assert_eq!((main.int(name::MIN), main.int(name::MAX)), (110, 240));
    assert_eq!((logic.int(name::MIN), logic.int(name::MAX)), (60, 121));
}

#[test]
fn a_serial_number_of_any_bytes_does_not_upset_the_unit() {
    for generation in [Generation::Gen3, Generation::Gen4] {
        for fill in [0x00, 0x41, 0x80, 0xd8, 0xff] {
            for length in [0, 1, 35, 36, 37, 255] {
                let mut bench = Bench::new(generation);
                let label: Vec<u8> = [&[0x80, 96, length][..], &[fill; 36]].concat();
                bench.raw(&with_crc(&label));
                bench.wait(Duration::from_millis(20));
                let back = bench.raw(&[0x80, 97]);
                assert_eq!(back.len(), 39, "{generation}, {length} bytes of {fill:02x}"); // length, 36 bytes, CRC
            }
        }
    }
}
