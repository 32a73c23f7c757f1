//! Who commands the motors, and what happens when nobody does any more.

use super::support::Bench;
use crate::controller::ControllerConfig;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, commands, name, number};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_values::Motor;
use std::time::Duration;

fn duty(bench: &Bench, motor: Motor) -> i16 {
    bench.unit().unit().expect("it has power").channel(motor).duty_raw()
}

fn running(generation: Generation) -> Bench {
    let mut bench = Bench::new(generation);
    bench.ask(commands::DUTY_BOTH, &[16_000, -16_000]);
    bench.wait(Duration::from_millis(500));
    assert_eq!(duty(&bench, Motor::M1), 16_000);
    bench
}

#[test]
fn a_silent_port_stops_both_motors_after_its_time_out() {
    for generation in Generation::ALL {
        let mut bench = running(generation);
        bench.wait(Duration::from_millis(490));
        assert_eq!(duty(&bench, Motor::M1), 16_000, "{generation}");
        bench.wait(Duration::from_millis(200));
        assert_eq!((duty(&bench, Motor::M1), duty(&bench, Motor::M2)), (0, 0), "{generation}");
        bench.wait_talking(Duration::from_millis(300));
        assert_eq!(duty(&bench, Motor::M1), 0, "the command is forgotten");
        assert_eq!(bench.read(commands::READ_BUFFERS, name::BUFFER_M1), 0x80);
    }
}

#[test]
fn any_byte_at_all_feeds_the_time_out() {
    let mut bench = running(Generation::Gen1);
    for _ in 0..20 {
        bench.bus.receive(StreamIndex::Usb, &[0x00]);
        bench.wait(Duration::from_millis(500));
    }
    assert_eq!(duty(&bench, Motor::M1), 16_000);
}

#[test]
fn bytes_on_another_port_count_by_that_ports_own_time_out() {
    let mut bench = running(Generation::Gen1);
    bench.ask(commands::SET_STREAM, &[2, 1, 115_200, 3_000]); // TTL UART1: three seconds
    bench.bus.receive(StreamIndex::Uart1, &[0x00]);
    bench.wait(Duration::from_millis(2_900));
    assert_eq!(duty(&bench, Motor::M1), 16_000);
    bench.wait(Duration::from_millis(300));
    assert_eq!(duty(&bench, Motor::M1), 0);
}

#[test]
fn a_time_out_of_zero_lets_the_motors_run_on() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SET_STREAM, &[0, 1, 115_200, 0]);
    bench.ask(commands::DUTY_M1, &[16_000]);
    bench.wait(Duration::from_secs(60));
    assert_eq!(duty(&bench, Motor::M1), 16_000);
}

#[test]
fn with_serial_in_no_priority_level_motion_is_acknowledged_and_does_nothing() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SET_PRIORITIES, &[2, 3, 0]);
    bench.ask(commands::DUTY_BOTH, &[16_000, 16_000]);
    bench.wait(Duration::from_millis(300));
    assert_eq!((duty(&bench, Motor::M1), duty(&bench, Motor::M2)), (0, 0));
    assert_eq!(bench.unit().unit().expect("it has power").priority_level(), None);
}

#[test]
fn taking_serial_out_of_the_levels_stops_what_it_had_started() {
    let mut bench = running(Generation::Gen1);
    bench.ask(commands::SET_PRIORITIES, &[2, 3, 0]);
    bench.wait(Duration::from_millis(300));
    assert_eq!((duty(&bench, Motor::M1), duty(&bench, Motor::M2)), (0, 0));
}

#[test]
fn the_serial_time_out_of_command_14_stops_motors_that_no_port_would_stop() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.ask(commands::SET_STREAM, &[0, 1, 115_200, 0]);
    bench.ask(commands::SET_SERIAL_TIMEOUT, &[5]); // 0.5 s
    bench.ask(commands::DUTY_M1, &[16_000]);
    bench.wait(Duration::from_millis(490));
    assert_eq!(duty(&bench, Motor::M1), 16_000);
    bench.wait(Duration::from_millis(200));
    assert_eq!(duty(&bench, Motor::M1), 0);
    bench.ask(commands::DUTY_M1, &[16_000]);
    bench.wait(Duration::from_millis(300));
    assert_eq!(duty(&bench, Motor::M1), 16_000, "a new command starts it again");
}

#[test]
fn a_roboclaw_has_no_priorities_and_only_the_serial_time_out() {
    let model = models::lookup("roboclaw-2x7a").expect("in the list");
    let config = ControllerConfig { generation: Generation::Gen3, ..ControllerConfig::of(model) };
    let mut bench = Bench::of(config);
    bench.ask(commands::DUTY_M1, &[16_000]);
    bench.wait(Duration::from_secs(20));
    assert_eq!(duty(&bench, Motor::M1), 16_000);
    assert_eq!(bench.ask(commands::READ_SIGNALS, &[]).records().count(), 0);
    assert_eq!(bench.ask(commands::READ_STREAMS, &[]).records().count(), 0);
    bench.ask(commands::SET_SERIAL_TIMEOUT, &[10]);
    bench.wait(Duration::from_millis(1_300));
    assert_eq!(duty(&bench, Motor::M1), 0);
}

#[test]
fn the_roboclaw_speaks_as_the_captured_one_did() {
    let model = models::lookup("roboclaw-2x7a").expect("in the list");
    let mut bench =
        Bench::of(ControllerConfig { generation: Generation::Gen3, ..ControllerConfig::of(model) });
    // A capture of a RoboClaw 2x7A: "USB Roboclaw 2x7a v4.2.8", line feed, null, CRC AC 9E.
    let mut expected = b"USB Roboclaw 2x7a v4.2.8\n\0".to_vec();
    expected.extend([0xac, 0x9e]);
    assert_eq!(bench.raw(&[0x80, 0x15, 0x59, 0x0c]), expected); // with the CRC that client appended
}

#[test]
fn a_roboclaw_knows_no_script_command_and_drops_what_follows_one_until_the_line_was_silent() {
    let model = models::lookup("roboclaw-2x7a").expect("in the list");
    for generation in Generation::ALL {
        let mut bench = Bench::of(ControllerConfig { generation, ..ControllerConfig::of(model) });
        for command in [number::SET_SCRIPT_AUTORUN, number::START_SCRIPT, number::STOP_SCRIPT] {
            let request = Request::new(bench.address, command, if command == 246 { &[0] } else { &[] });
            assert!(bench.try_send(&request).is_none(), "{command} in {generation}");
            bench.wait(Duration::from_millis(11));
        }
        bench.ask(commands::DUTY_M1, &[16_000]);
        let encode = |command, args: &[i64]| {
            Request::new(Address::DEFAULT, command, args).encode(generation).expect("known")
        };
        let stop = encode(number::DUTY_ACCEL_BOTH, &[0, 655_359, 0, 655_359]);
        let unknown_first = [encode(number::STOP_SCRIPT, &[]), stop.clone()].concat();
        assert_eq!(bench.raw(&unknown_first), [0; 0], "{generation}");
        bench.wait(Duration::from_millis(50));
        assert_eq!(duty(&bench, Motor::M1), 16_000, "the stop behind it was dropped");
        let stop_first = [stop, encode(number::STOP_SCRIPT, &[])].concat();
        assert_eq!(bench.raw(&stop_first), [0xFF]);
        bench.wait(Duration::from_millis(60));
        assert_eq!(duty(&bench, Motor::M1), 0);
    }
}

#[test]
fn bridged_one_motor_takes_the_current_of_both_and_motor_2_is_refused() {
    use brushwork_plant::world::WorldAction;
    let mut bench = Bench::new(Generation::Gen1);
    for command in [commands::SET_CURRENT_LIMITS_M1, commands::SET_CURRENT_LIMITS_M2] {
        bench.ask(command, &[100, -100]); // 1 A a bridge
    }
    bench.apply(&WorldAction::SetHidden { key: "unit.bridge_channels".to_owned(), value: 1 });
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    for command in [number::DUTY_M2, number::FORWARD_M2] {
        assert!(bench.try_ask(command, &[100]).is_none(), "command {command}");
    }
    bench.ask(commands::DUTY_BOTH, &[32_767, 32_767]);
    bench.wait_talking(Duration::from_millis(800));
    let currents = bench.ask(commands::READ_CURRENTS, &[]);
    assert!((190..=210).contains(&currents.int(name::CURRENT_M1)), "{currents:?}");
    assert_eq!(currents.int(name::CURRENT_M2), 0);
    assert_eq!(bench.unit().view().axes[1].output, BridgeOutput::Coast);
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M2), 0);
}
