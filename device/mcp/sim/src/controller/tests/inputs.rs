//! Pins as inputs: readings, actions, steering, encoders.

use super::support::Bench;
use crate::controller::ControllerConfig;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::status::{Condition, decode};
use brushwork_mcp_wire::packet_serial::{Generation, commands, name};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;
use std::time::Duration;

const A_MOMENT: Duration = Duration::from_millis(100);
/// DIN4/AN4/P4 of the MCP266: analog and pulse, shared with no UART.
const PIN: usize = 3;

/// What a test sets of a pin; the rest is as from the factory.
#[derive(Clone, Copy)]
struct Pin {
    kind: i64,
    mode: i64,
    target: i64,
    min_action: i64,
    max_action: i64,
    timeout_ms: i64,
    load_home: i64,
    range: [i64; 3],
}

impl Default for Pin {
    fn default() -> Self {
        Self {
            kind: 1,
            mode: 0,
            target: 0,
            min_action: 0,
            max_action: 0,
            timeout_ms: 1000,
            load_home: 0,
            range: [0, 2048, 4095],
        }
    }
}

fn set_pin(bench: &mut Bench, index: usize, pin: Pin) {
    let [min, center, max] = pin.range;
    let mut args = vec![index as i64, pin.kind, pin.mode, pin.target, pin.min_action, pin.max_action];
    if bench.generation > Generation::Gen1 {
        args.push(0); // low pass
    }
    args.extend([pin.timeout_ms, pin.load_home, min, max, center, 0, 0, -32_767, 32_767, 0]);
    if bench.generation > Generation::Gen2 {
        args.push(0); // potentiometer
    }
    bench.ask(commands::SET_SIGNAL, &args);
}

fn volts(bench: &mut Bench, pin: usize, volts: f64) {
    bench.apply(&WorldAction::SetPin { pin, signal: PinSignal::Volts { volts } });
}

fn pulse(bench: &mut Bench, pin: usize, microseconds: f64) {
    bench.apply(&WorldAction::SetPin { pin, signal: PinSignal::Pulse { microseconds } });
}

fn values(bench: &mut Bench, pin: usize) -> [i64; 3] {
    let reply = bench.ask(commands::READ_SIGNAL_VALUES, &[]);
    let record = reply.records().nth(pin).expect("the pin is there");
    [record.int(name::COMMAND), record.int(name::POSITION), record.int(name::PERCENT)]
}

/// A unit on which the serial port gives way to inputs after 100 ms.
fn steered(generation: Generation) -> Bench {
    let mut bench = Bench::new(generation);
    bench.ask(commands::SET_STREAM, &[0, 1, 115_200, 100]);
    bench
}

#[test]
fn an_analog_pin_reads_as_on_the_manuals_screen() {
    for generation in Generation::ALL {
        let mut bench = Bench::new(generation);
        set_pin(&mut bench, PIN, Pin::default());
        volts(&mut bench, PIN, 5.0 / 4095.0 * 5.1); // five counts
        bench.wait(A_MOMENT);
        assert_eq!(values(&mut bench, PIN), [-32_687, -2043, -32_687], "{generation}");
    }
}

#[test]
fn a_pin_without_the_capability_reads_nothing() {
    let mut bench = Bench::new(Generation::Gen1);
    set_pin(&mut bench, 2, Pin { kind: 2, ..Pin::default() }); // DIN3/AN3 has no pulse function
    pulse(&mut bench, 2, 1900.0);
    bench.wait(A_MOMENT);
    assert_eq!(values(&mut bench, 2), [0; 3]);
}

#[test]
fn a_pin_that_a_uart_uses_is_no_input_until_the_uart_is_disabled() {
    let mut bench = Bench::new(Generation::Gen1);
    set_pin(&mut bench, 0, Pin::default()); // DIN1/AN1/P1/TX3
    volts(&mut bench, 0, 5.1);
    bench.wait(A_MOMENT);
    assert_eq!(values(&mut bench, 0), [0; 3]);
    bench.ask(commands::SET_STREAM, &[4, 2, 115_200, 1000]); // UART3 off
    bench.wait(A_MOMENT);
    assert_eq!(values(&mut bench, 0)[1], 2047);
}

#[test]
fn a_digital_pin_reads_low_or_high() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.apply(&WorldAction::SetHidden { key: "pin.4.digital".to_owned(), value: 1 });
    for (level, position) in [(0.0, -2048), (5.0, 2047), (2.4, -2048)] {
        volts(&mut bench, PIN, level);
        bench.wait(A_MOMENT);
        assert_eq!(values(&mut bench, PIN)[1], position, "{level} V");
    }
}

#[test]
fn an_analog_stick_drives_a_motor_once_the_serial_port_has_timed_out() {
    let mut bench = steered(Generation::Gen1);
    bench.ask(commands::SET_VELOCITY_PID_M1, &[0, 0, 0, 10_000]); // no velocity loop: duty
    set_pin(&mut bench, PIN, Pin { target: 1, ..Pin::default() });
    volts(&mut bench, PIN, 5.1);
    bench.wait(Duration::from_millis(90));
    assert_eq!(bench.unit().unit().expect("power").priority_level(), Some(1));
    bench.wait(Duration::from_millis(500));
    let unit = bench.unit().unit().expect("power");
    assert_eq!(unit.priority_level(), Some(3));
    assert_eq!(unit.channel(Motor::M1).duty_raw(), 32_767);
    assert_eq!(unit.channel(Motor::M2).duty_raw(), 0);
}

#[test]
fn a_byte_on_the_serial_port_takes_control_back_and_stops_the_motor() {
    let mut bench = steered(Generation::Gen1);
    bench.ask(commands::SET_VELOCITY_PID_M1, &[0, 0, 0, 10_000]);
    set_pin(&mut bench, PIN, Pin { target: 1, ..Pin::default() });
    volts(&mut bench, PIN, 5.1);
    bench.wait(Duration::from_millis(500));
    bench.raw(&[0x00]); // no packet at all
    bench.wait_talking(Duration::from_millis(200));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0);
    assert_eq!(bench.unit().unit().expect("power").priority_level(), Some(1));
}

#[test]
fn with_a_velocity_loop_a_stick_commands_speed_and_with_a_position_loop_position() {
    let mut bench = steered(Generation::Gen1);
    bench.ask(commands::SET_VELOCITY_PID_M1, &[0, 65_536, 6_554, 4_000]);
    set_pin(&mut bench, PIN, Pin { target: 1, ..Pin::default() });
    volts(&mut bench, PIN, 3.825); // three quarters: half speed forward
    bench.wait(Duration::from_secs(3));
    let speed = bench.unit().unit().expect("power").channel(Motor::M1).speeds().filtered;
    assert!((1900..2100).contains(&speed), "{speed}");

    let mut bench = steered(Generation::Gen1);
    bench.ask(commands::SET_VELOCITY_PID_M1, &[0, 65_536, 6_554, 4_000]);
    bench.ask(commands::SET_POSITION_PID_M1, &[0, 8_192, 0, 0, 5, -2_000, 2_000]);
    set_pin(&mut bench, PIN, Pin { target: 1, ..Pin::default() });
    volts(&mut bench, PIN, 3.825);
    bench.wait(Duration::from_secs(4));
    let position = bench.unit().unit().expect("power").channel(Motor::M1).encoder().position();
    assert!((950..1050).contains(&position), "{position}");
}

#[test]
fn pulses_rank_above_analog_and_give_way_when_they_stop() {
    let mut bench = steered(Generation::Gen1);
    for motor in [commands::SET_VELOCITY_PID_M1, commands::SET_VELOCITY_PID_M2] {
        bench.ask(motor, &[0, 0, 0, 10_000]);
    }
    set_pin(
        &mut bench,
        PIN,
        Pin { kind: 2, target: 1, timeout_ms: 200, range: [1000, 1500, 2000], ..Pin::default() },
    );
    set_pin(&mut bench, 2, Pin { target: 2, ..Pin::default() });
    pulse(&mut bench, PIN, 1750.0);
    volts(&mut bench, 2, 0.0);
    bench.wait(Duration::from_millis(600));
    let unit = bench.unit().unit().expect("power");
    assert_eq!(unit.priority_level(), Some(2));
    assert_eq!((unit.channel(Motor::M1).duty_raw(), unit.channel(Motor::M2).duty_raw()), (16_384, 0));
    bench.apply(&WorldAction::SetPin { pin: PIN, signal: PinSignal::Open });
    bench.wait(Duration::from_millis(600));
    let unit = bench.unit().unit().expect("power");
    assert_eq!(unit.priority_level(), Some(3));
    assert_eq!((unit.channel(Motor::M1).duty_raw(), unit.channel(Motor::M2).duty_raw()), (0, -32_767));
}

#[test]
fn mixed_inputs_drive_and_turn() {
    let mut bench = steered(Generation::Gen1);
    for motor in [commands::SET_VELOCITY_PID_M1, commands::SET_VELOCITY_PID_M2] {
        bench.ask(motor, &[0, 0, 0, 10_000]);
    }
    bench.ask(commands::SET_ADDRESS_MIXED, &[0x80, 1]);
    set_pin(&mut bench, PIN, Pin { target: 1, range: [0, 2000, 4000], ..Pin::default() });
    set_pin(&mut bench, 2, Pin { target: 2, range: [0, 2000, 4000], ..Pin::default() });
    volts(&mut bench, PIN, 3000.0 / 4095.0 * 5.1); // half forward
    volts(&mut bench, 2, 2500.0 / 4095.0 * 5.1); // a quarter right
    bench.wait(Duration::from_millis(600));
    let unit = bench.unit().unit().expect("power");
    assert_eq!((unit.channel(Motor::M1).duty_raw(), unit.channel(Motor::M2).duty_raw()), (24_576, 8_192));
}

#[test]
fn a_limit_switch_stops_forward_motion_and_allows_backward_and_lights_the_indicator() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.ask(commands::DUTY_M1, &[10_000]);
    // At or below 500: M1 forward limit; switches close to ground.
    set_pin(&mut bench, PIN, Pin { min_action: 0x0008, range: [500, 2048, 4095], ..Pin::default() });
    volts(&mut bench, PIN, 5.0);
    bench.wait_talking(Duration::from_millis(300));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 10_000);
    volts(&mut bench, PIN, 0.0);
    bench.wait_talking(Duration::from_millis(300));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0);
    // An MCP's word has no bit for it (MCP manual command 90).
    let word = bench.read(commands::READ_STATUS, name::STATUS) as u32;
    assert!(decode(word, Generation::Gen2).is_empty());
    assert!(bench.unit().unit().expect("power").conditions().contains(Condition::M1Home));
    bench.ask(commands::DUTY_M1, &[-10_000]);
    bench.wait_talking(Duration::from_millis(300));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), -10_000);
}

#[test]
fn a_home_switch_loads_its_value_and_a_reverse_switch_turns_the_motor_round() {
    let mut bench = Bench::new(Generation::Gen2);
    set_pin(&mut bench, PIN, Pin { max_action: 0x0024, load_home: 5000, ..Pin::default() }); // load home and reverse
    volts(&mut bench, PIN, 0.0);
    bench.ask(commands::DUTY_M1, &[8_000]);
    bench.wait_talking(Duration::from_millis(300));
    volts(&mut bench, PIN, 5.1);
    bench.wait(Duration::from_millis(4));
    assert!((4_900..5_100).contains(&bench.read(commands::READ_ENCODER_M1, name::ENCODER)));
    bench.wait_talking(Duration::from_millis(500));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), -8_000);
}

#[test]
fn an_emergency_stop_on_a_pin_stops_both_motors() {
    for (generation, action) in [(Generation::Gen1, 22), (Generation::Gen4, 0x8000)] {
        let mut bench = Bench::new(generation);
        bench.ask(commands::DUTY_BOTH, &[8_000, 8_000]);
        set_pin(&mut bench, PIN, Pin { min_action: action, ..Pin::default() });
        volts(&mut bench, PIN, 5.0);
        bench.wait_talking(A_MOMENT);
        assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 8_000, "{generation}");
        volts(&mut bench, PIN, 0.0);
        bench.wait_talking(A_MOMENT);
        assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M2), 0, "{generation}");
        let word = bench.read(commands::READ_STATUS, name::STATUS) as u32;
        assert!(decode(word, generation).contains(Condition::EStop), "{generation}");
    }
}

#[test]
fn any_input_can_be_a_motors_encoder() {
    let mut bench = Bench::new(Generation::Gen1);
    set_pin(&mut bench, PIN, Pin::default());
    volts(&mut bench, PIN, 2.55);
    bench.ask(commands::SET_ENCODER_MODE_M1, &[PIN as i64]);
    bench.wait(A_MOMENT);
    assert_eq!(bench.read(commands::READ_ENCODER_M1, name::ENCODER), 2048);
    bench.ask(commands::SET_ENCODER_MODE_M1, &[0xff]);
    bench.ask(commands::DUTY_M1, &[8_000]);
    bench.wait(Duration::from_millis(300));
    assert_eq!(bench.read(commands::READ_ENCODER_M1, name::ENCODER), 0, "no encoder");
    // Motor 2 can be given motor 1's encoder.
    bench.ask(commands::SET_ENCODER_MODE_M2, &[6]); // ENC1A
    bench.wait(Duration::from_millis(300));
    assert!(bench.read(commands::READ_ENCODER_M2, name::ENCODER) > 100);
}

#[test]
fn the_number_of_a_pin_without_a_function_leaves_the_motors_own_encoder() {
    for mode in [0, 1] {
        let mut bench = Bench::new(Generation::Gen4);
        bench.ask(commands::SET_ENCODER_MODE_M1, &[mode]);
        bench.ask(commands::DUTY_M1, &[8_000]);
        bench.wait(Duration::from_millis(300));
        assert!(bench.read(commands::READ_ENCODER_M1, name::ENCODER) > 100, "mode {mode}");
    }
}

#[test]
fn an_actuator_with_an_analog_encoder_comes_with_its_input_set() {
    let model = models::lookup("mcp236").expect("in the list");
    let axis = brushwork_plant::presets::lookup("linear-actuator").expect("built in");
    let world = brushwork_plant::presets::world_of(axis, axis, model.pins.len());
    let mut bench = Bench::of(ControllerConfig { world, ..ControllerConfig::of(model) });
    bench.wait(A_MOMENT);
    let count = bench.read(commands::READ_ENCODER_M1, name::ENCODER);
    assert!((2_000..2_100).contains(&count), "{count}");
}

#[test]
fn a_stored_script_is_started_and_stopped_by_inputs() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.install("main\ngoto main\n");
    set_pin(&mut bench, PIN, Pin { min_action: 0x4000, max_action: 0x0040, ..Pin::default() });
    let runs = |bench: &Bench| bench.unit().unit().expect("power").script_is_running();
    for (level, running) in [(2.5, false), (5.1, true), (2.5, true), (0.0, false)] {
        volts(&mut bench, PIN, level);
        bench.wait(A_MOMENT);
        assert_eq!(runs(&bench), running, "{level} V");
    }
}
