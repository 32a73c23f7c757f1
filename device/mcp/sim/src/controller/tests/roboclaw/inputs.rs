//! R/C and analog inputs, and simple serial.

use super::*;
use brushwork_mcp_wire::packet_serial::Generation::{Gen1, Gen4};
use brushwork_mcp_wire::roboclaw::ControlMode;
use brushwork_plant::machine::Machine;

const MIXING: u16 = 1 << 5;
const EXPONENTIAL: u16 = 1 << 6;
const MCU: u16 = 1 << 7;
const RC_FLIP: u16 = 1 << 8;
const RC_TIMEOUT: u16 = 1 << 9;

fn in_mode(generation: Generation, mode: ControlMode, options: u16) -> Bench {
    let word = ConfigWord(options).with_mode(mode);
    claw_with(generation, word, StreamIndex::Usb)
}

/// A unit in R/C mode with both sticks at rest.
fn radio(generation: Generation, options: u16) -> Bench {
    let mut bench = in_mode(generation, ControlMode::Rc, options);
    pulse(&mut bench, S1, 1500.0);
    pulse(&mut bench, S2, 1500.0);
    bench.wait(A_MOMENT);
    bench
}

/// Duties once the ramp is over.
fn settled(bench: &mut Bench) -> [f64; 2] {
    bench.wait(Duration::from_millis(500));
    duties(bench)
}

#[test]
fn pulses_drive_their_motors_with_a_deadband_of_two_and_a_half_percent() {
    for generation in Generation::ALL {
        let mut bench = radio(generation, 0);
        for (microseconds, wanted) in [
            (1510.0, 0.0),
            (1512.0, 0.0),
            (2000.0, 100.0),
            (1000.0, -100.0),
            (1756.25, 50.0),
            (1243.75, -50.0),
        ] {
            pulse(&mut bench, S1, microseconds);
            let [first, second] = settled(&mut bench);
            assert!(is_near(first, wanted), "{generation}: {microseconds} us gave {first} %");
            assert_eq!(second, 0.0);
        }
        pulse(&mut bench, S2, 2000.0);
        assert!(is_near(settled(&mut bench)[1], 100.0), "{generation}");
    }
}

#[test]
fn each_side_has_its_own_deadband_and_limit() {
    let mut bench = radio(Gen4, 0);
    // Reverse 20 %, forward none; no more than half backward.
    let input = [200, 0, 16_384, 0, 0, 0, 0];
    bench.ask(commands::SET_CONTROL_SETTINGS, &[input, input].concat());
    for (microseconds, wanted) in [(1450.0, 0.0), (1510.0, 2.0), (1000.0, -50.0), (2000.0, 100.0)] {
        pulse(&mut bench, S1, microseconds);
        let first = settled(&mut bench)[0];
        assert!(is_near(first, wanted), "{microseconds} us gave {first} %");
    }
}

#[test]
fn a_range_of_its_own_takes_the_place_of_the_usual_one() {
    let mut bench = radio(Gen4, 0);
    let input = [0, 0, 0, 0, 1400, 900, 1900];
    bench.ask(commands::SET_CONTROL_SETTINGS, &[input, input].concat());
    for (microseconds, wanted) in [(1400.0, 0.0), (1650.0, 50.0), (900.0, -100.0)] {
        pulse(&mut bench, S1, microseconds);
        let first = settled(&mut bench)[0];
        assert!(is_near(first, wanted), "{microseconds} us gave {first} %");
    }
}

#[test]
fn the_first_pulse_is_the_center_but_with_mcu() {
    for (options, wanted) in [(0, 0.0), (MCU, 17.9)] {
        let mut bench = in_mode(Gen4, ControlMode::Rc, options);
        pulse(&mut bench, S1, 1600.0);
        let first = settled(&mut bench)[0];
        assert!(is_near(first, wanted), "{options:#x}: {first}");
    }
}

#[test]
fn lost_pulses_stop_the_motors_unless_mcu_holds_the_last_one() {
    for (options, goes_on) in [(0, false), (MCU, true), (MCU | RC_TIMEOUT, false)] {
        let mut bench = radio(Gen4, options);
        pulse(&mut bench, S1, 2000.0);
        assert!(is_near(settled(&mut bench)[0], 100.0));
        put(&mut bench, S1, PinSignal::Open);
        bench.wait(Duration::from_millis(200));
        assert!(is_near(duty(&mut bench), 100.0), "{options:#x}: not lost yet");
        let first = settled(&mut bench)[0];
        assert_eq!(is_near(first, 100.0), goes_on, "{options:#x}: {first}");
    }
}

#[test]
fn mixing_drives_with_s1_and_turns_with_s2() {
    let mut bench = radio(Gen4, MIXING);
    pulse(&mut bench, S1, 1756.25);
    let [left, right] = settled(&mut bench);
    assert!(is_near(left, 50.0) && is_near(right, 50.0), "{left} {right}");
    pulse(&mut bench, S2, 1756.25);
    let [left, right] = settled(&mut bench);
    assert!(is_near(left, 100.0) && is_near(right, 0.0), "{left} {right}");
}

#[test]
fn exponential_softens_the_middle_and_keeps_the_ends() {
    let mut bench = radio(Gen4, EXPONENTIAL);
    for (microseconds, wanted) in [(1756.25, 25.0), (2000.0, 100.0), (1243.75, -25.0)] {
        pulse(&mut bench, S1, microseconds);
        let first = settled(&mut bench)[0];
        assert!(is_near(first, wanted), "{microseconds} us gave {first} %");
    }
}

#[test]
fn the_flip_switch_turns_both_motors_round_by_a_level_or_by_a_pulse() {
    let mut bench = radio(Gen4, 0);
    pulse(&mut bench, S1, 2000.0);
    pull(&mut bench, S3, true);
    assert!(is_near(settled(&mut bench)[0], -100.0));
    assert!(!has(&mut bench, Condition::EStop), "it is no emergency stop in this mode");
    let mut bench = radio(Gen4, RC_FLIP);
    pulse(&mut bench, S1, 2000.0);
    pulse(&mut bench, S3, 1100.0);
    assert!(is_near(settled(&mut bench)[0], 100.0));
    pulse(&mut bench, S3, 1900.0);
    assert!(is_near(settled(&mut bench)[0], -100.0));
}

#[test]
fn voltages_from_0_to_2_volts_drive_in_analog_mode_and_an_open_input_stops() {
    for generation in [Gen1, Gen4] {
        let mut bench = in_mode(generation, ControlMode::Analog, 0);
        volts(&mut bench, S2, 1.0);
        for (input, wanted) in
            [(1.0, 0.0), (1.02, 0.0), (2.0, 100.0), (3.0, 100.0), (0.0, -100.0), (1.5125, 50.0)]
        {
            volts(&mut bench, S1, input);
            let first = settled(&mut bench)[0];
            assert!(is_near(first, wanted), "{generation}: {input} V gave {first} %");
        }
        put(&mut bench, S1, PinSignal::Open);
        assert_eq!(settled(&mut bench)[0], 0.0);
    }
}

#[test]
fn packet_serial_reads_over_usb_in_these_modes_and_moves_nothing() {
    for mode in [ControlMode::Rc, ControlMode::Analog] {
        let mut bench = in_mode(Gen4, mode, 0);
        bench.ask(commands::DUTY_M1, &[16_000]);
        assert_eq!(settled(&mut bench), [0.0, 0.0], "{mode:?}");
    }
}

#[test]
fn an_emergency_stop_holds_an_input_back_and_the_input_counts_again_afterwards() {
    let mut bench = radio(Gen4, 0);
    set_pins(&mut bench, [0, 0x01, 0]);
    pulse(&mut bench, S1, 2000.0);
    assert!(is_near(settled(&mut bench)[0], 100.0));
    pull(&mut bench, S4, true);
    assert_eq!(settled(&mut bench)[0], 0.0);
    pull(&mut bench, S4, false);
    assert!(is_near(settled(&mut bench)[0], 100.0));
}

#[test]
fn an_input_commands_speed_where_the_encoder_serves_it() {
    let mut bench = radio(Gen4, 0);
    let qpps = 8_000;
    bench.ask(commands::SET_VELOCITY_PID_M1, &[0, 0x10000, 0x8000, qpps]);
    bench.ask(commands::SET_ENCODER_MODE_M1, &[0x80]);
    pulse(&mut bench, S1, 1756.25);
    bench.wait(Duration::from_secs(3));
    let speed = bench.read(commands::READ_SPEED_M1, name::SPEED);
    assert!((speed - qpps / 2).abs() < qpps / 20, "{speed} counts/s");
}

#[test]
fn single_bytes_drive_in_simple_serial() {
    let word = ConfigWord::packet_serial(0).with_mode(ControlMode::SimpleSerial);
    let mut bench = claw_with(Gen4, word, StreamIndex::Uart1);
    let mut say = |byte: u8| {
        bench.bus.receive(StreamIndex::Uart1, &[byte]);
        bench.wait(Duration::from_millis(500));
        let unit = bench.unit().unit().expect("it has power");
        Motor::BOTH.map(|motor| f64::from(unit.channel(motor).duty_raw()) * scale::DUTY_PERCENT)
    };
    assert!(is_near(say(127)[0], 100.0));
    let [first, second] = say(128);
    assert!(is_near(first, 100.0) && is_near(second, -100.0));
    assert!(is_near(say(1)[0], -100.0));
    assert!(is_near(say(64)[0], 0.0));
    assert_eq!(say(0), [0.0, 0.0]);
}
