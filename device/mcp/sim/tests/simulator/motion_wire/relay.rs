//! Commands 84 to 89: the relay test.

use super::bench::{Bench, Payload};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;

/// Amplitude and period of the last test, command 88 or 89.
fn result(bench: &mut Bench, command: u8) -> [u32; 2] {
    let mut reply = bench.read(command, 8);
    [reply.u32(), reply.u32()]
}

fn wait_for(bench: &mut Bench, command: u8) -> [u32; 2] {
    bench.seconds_until(|bench| result(bench, command) != [0, 0]);
    result(bench, command)
}

#[test]
fn a_speed_relay_84_reports_an_oscillation_of_the_motor_and_stops_it() {
    let mut bench = Bench::new();
    bench.write(84, Payload::new().u32(16_384));
    assert_eq!(result(&mut bench, 88), [0, 0]);
    let [amplitude, period_us] = wait_for(&mut bench, 88);
    // Half of 10650 counts/s at most; a lag of 40 ms with a tick or two of dead time.
    assert!((200..5_300).contains(&amplitude), "{amplitude}");
    assert!((8_000..60_000).contains(&period_us), "{period_us} us");
    bench.run_s(0.2);
    assert_eq!(bench.duties()[0], 0);
}

#[test]
fn hysteresis_comes_with_generation_3_and_widens_the_oscillation() {
    let mut amplitudes = Vec::new();
    for hysteresis in [0, 3_000] {
        let mut bench = Bench::of(Generation::Gen3);
        bench.write(85, Payload::new().u32(16_384).u32(hysteresis));
        amplitudes.push(wait_for(&mut bench, 89)[0]);
    }
    assert!(amplitudes[1] > 3_000 && amplitudes[1] > amplitudes[0], "{amplitudes:?}");
}

#[test]
fn a_position_relay_86_oscillates_around_its_start() {
    let mut bench = Bench::new();
    bench.write(22, Payload::new().u32(5_000));
    bench.write(86, Payload::new().u32(16_384));
    let [amplitude, period_us] = wait_for(&mut bench, 88);
    let count = bench.counts()[0];
    assert!((4_500..5_500).contains(&count), "{count}");
    assert!(amplitude > 5 && period_us > 20_000, "{amplitude} {period_us}");
}

#[test]
fn a_reversed_encoder_ends_the_test_without_a_result_and_with_the_motor_stopped() {
    let mut bench = Bench::new();
    bench.apply(&WorldAction::ReverseEncoder { motor: Motor::M2, on: true });
    bench.write(85, Payload::new().u32(16_384));
    bench.run_s(9.0);
    assert_ne!(bench.duties()[1], 0);
    bench.run_s(1.5);
    assert_eq!(bench.duties()[1], 0);
    assert_eq!(result(&mut bench, 89), [0, 0]);
}
