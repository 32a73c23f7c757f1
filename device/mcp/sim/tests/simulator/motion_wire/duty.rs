//! Commands 0 to 13, 32 to 34, 52 to 54, 68, 69, and torque mode.

use super::bench::{Bench, Payload};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;

#[test]
fn duty_32_to_34_drives_the_motors_the_signed_way() {
    let mut bench = Bench::new();
    // 34: duty M1 = 16384, duty M2 = -8192.
    bench.write(34, Payload::new().i16(16_384).i16(-8_192));
    bench.run_s(1.0);
    assert_eq!(bench.duties(), [16_384, -8_192]);
    let [m1, m2] = bench.counts();
    assert!(m1 > 3_000 && m2 < -1_000, "{m1} {m2}");
    bench.write(32, Payload::new().i16(0));
    bench.write(33, Payload::new().i16(32_767));
    bench.run_s(1.0);
    assert_eq!(bench.duties(), [0, 32_767]);
    let [stopped, _] = bench.counts();
    bench.run_s(0.5);
    assert_eq!(bench.counts()[0], stopped);
}

#[test]
fn acceleration_52_to_54_ramps_in_its_own_time() {
    let mut bench = Bench::new();
    // 52: duty 32767, acceleration 32768 = 100 % per second.
    bench.write(52, Payload::new().i16(32_767).u32(32_768));
    let seconds = bench.seconds_until(|bench| bench.duties()[0] == 32_767);
    assert!((seconds - 1.0).abs() < 0.01, "{seconds}");
    // 54: both to -100 %, motor 1 in 0.1 s, motor 2 in 0.5 s.
    bench.write(54, Payload::new().i16(-32_767).u32(655_359).i16(-32_767).u32(65_536));
    let seconds = bench.seconds_until(|bench| bench.duties()[0] == -32_767);
    assert!((seconds - 0.1).abs() < 0.01, "{seconds}");
    let seconds = bench.seconds_until(|bench| bench.duties()[1] == -32_767);
    assert!((seconds - 0.4).abs() < 0.01, "{seconds}");
    // 53: motor 2 alone.
    bench.write(53, Payload::new().i16(0).u32(655_359));
    bench.run_s(0.1);
    assert_eq!(bench.duties(), [-32_767, 0]);
}

#[test]
fn default_accelerations_68_and_69_ramp_what_has_none() {
    let mut bench = Bench::new();
    // 68: acceleration 65536 = 200 % per second.
    bench.write(68, Payload::new().u32(65_536));
    bench.write(34, Payload::new().i16(32_767).i16(32_767));
    let seconds = bench.seconds_until(|bench| bench.duties()[0] == 32_767);
    assert!((seconds - 0.5).abs() < 0.01, "{seconds}");
    bench.write(34, Payload::new().i16(0).i16(0));
    let seconds = bench.seconds_until(|bench| bench.duties()[0] == 0);
    assert!((seconds - 0.5).abs() < 0.01, "generation 1 decelerates as it accelerates: {seconds}");
}

#[test]
fn default_decelerations_are_apart_from_generation_2_on() {
    for generation in [Generation::Gen2, Generation::Gen3, Generation::Gen4] {
        let mut bench = Bench::of(generation);
        // 69: acceleration 65536, deceleration 32768.
        bench.write(69, Payload::new().u32(65_536).u32(32_768));
        bench.write(33, Payload::new().i16(-32_767));
        let up = bench.seconds_until(|bench| bench.duties()[1] == -32_767);
        bench.write(33, Payload::new().i16(0));
        let down = bench.seconds_until(|bench| bench.duties()[1] == 0);
        assert!((up - 0.5).abs() < 0.01 && (down - 1.0).abs() < 0.01, "{generation}: {up} {down}");
    }
}

#[test]
fn seven_bit_commands_0_to_7_map_to_duty() {
    for (command, value, expected) in [
        (0, 127, [32_767, 0]),
        (0, 64, [16_513, 0]),
        (1, 127, [-32_767, 0]),
        (4, 127, [0, 32_767]),
        (5, 127, [0, -32_767]),
        (6, 0, [-32_767, 0]),
        (6, 64, [0, 0]),
        (6, 127, [32_767, 0]),
        (7, 0, [0, -32_767]),
        (7, 127, [0, 32_767]),
    ] {
        let mut bench = Bench::new();
        bench.write(command, Payload::new().u8(value));
        bench.run_s(0.3);
        assert_eq!(bench.duties(), expected, "command {command}, value {value}");
    }
}

#[test]
fn mixed_commands_8_to_13_wait_for_drive_and_turn() {
    let mut bench = Bench::new();
    bench.write(8, Payload::new().u8(64));
    bench.run_s(0.3);
    assert_eq!(bench.duties(), [0, 0], "no turn value yet");
    bench.write(13, Payload::new().u8(64));
    bench.run_s(0.3);
    assert_eq!(bench.duties(), [16_513, 16_513], "64 is no turn");
    bench.write(10, Payload::new().u8(32));
    bench.run_s(0.3);
    let [m1, m2] = bench.duties();
    assert!(m1 > 16_513 && m2 < 16_513, "{m1} {m2}");
    bench.write(11, Payload::new().u8(0));
    bench.write(9, Payload::new().u8(127));
    bench.run_s(0.3);
    assert_eq!(bench.duties(), [-32_767, -32_767]);
    bench.write(12, Payload::new().u8(64));
    bench.run_s(0.3);
    assert_eq!(bench.duties(), [0, 0]);
}

#[test]
fn inductance_and_resistance_128_turn_duty_into_torque() {
    let mut bench = Bench::new();
    // 128: L = 4 mH, R = 8 ohm, each times 2^24.
    bench.write(128, Payload::new().u32(67_109).u32(134_217_728));
    // 133: maximum 2.00 A, minimum 0.
    bench.write(133, Payload::new().u32(200).u32(0));
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.write(32, Payload::new().i16(16_384));
    bench.run_s(0.5);
    let amps = bench.truth(Motor::M1).amps;
    assert!((amps - 1.0).abs() < 0.02, "half of 2 A: {amps}");
    assert!((bench.currents()[0] - 100).abs() <= 3);
    // The voltage for 1 A through 8 ohm from 24 V.
    assert!((f64::from(bench.duties()[0]) / 32_767.0 - 8.0 / 24.0).abs() < 0.02);
    // With L back at 0 the same duty is half the voltage.
    bench.write(128, Payload::new().u32(0).u32(134_217_728));
    bench.run_s(0.5);
    assert_eq!(bench.duties()[0], 16_384);
}
