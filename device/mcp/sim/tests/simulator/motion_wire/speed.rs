//! Commands 18, 19, 28 to 31, 35 to 40, 50, 79, 108.

use super::bench::{Bench, Payload, QPPS};
use brushwork_mcp_wire::packet_serial::Generation;

#[test]
fn speeds_35_to_37_are_reached_and_read_back() {
    let mut bench = Bench::new();
    bench.tune_velocity();
    bench.write(37, Payload::new().i32(5_000).i32(-3_000));
    bench.run_s(3.0);
    // 18, 19: magnitude and direction, over a tenth of a second in steps of 10.
    let [m1, m2] = bench.speeds();
    assert!((m1 - 5_000).abs() <= 20 && (m2 + 3_000).abs() <= 20, "{m1} {m2}");
    // 30, 79: the counts of the last 1/300 s.
    let mut reply = bench.read(30, 5);
    assert_eq!(reply.u32() % 300, 0);
    let mut reply = bench.read(79, 8);
    let [m1, m2] = [reply.i32(), reply.i32()];
    assert!(m1 % 300 == 0 && m2 % 300 == 0 && m1 > 4_000 && m2 < -2_000, "{m1} {m2}");

    bench.write(35, Payload::new().i32(0));
    bench.write(36, Payload::new().i32(0));
    bench.run_s(2.0);
    let before = bench.counts();
    bench.run_s(1.0);
    let after = bench.counts();
    assert!((after[0] - before[0]).abs() <= 2 && (after[1] - before[1]).abs() <= 2, "{before:?} {after:?}");
}

#[test]
fn accelerations_38_to_40_and_50_take_their_time() {
    let mut bench = Bench::new();
    bench.tune_velocity();
    // 40: acceleration 4000 for both, 6000 and -6000: 1.5 s, which is 4500 counts.
    bench.write(40, Payload::new().u32(4_000).i32(6_000).i32(-6_000));
    bench.run_s(1.5);
    let [m1, m2] = bench.counts();
    assert!((m1 - 4_500).abs() < 200 && (m2 + 4_500).abs() < 200, "{m1} {m2}");
    // 50: own accelerations, both to a stop in 0.5 s and in 1 s.
    bench.write(50, Payload::new().u32(12_000).i32(0).u32(6_000).i32(0));
    bench.run_s(0.75);
    let mut reply = bench.read(79, 8);
    let [m1, m2] = [reply.i32(), reply.i32()];
    assert!(m1.abs() <= 300 && (-2_400..-600).contains(&m2), "{m1} {m2}");
    // 38, 39: one motor each.
    bench.run_s(1.0);
    bench.write(38, Payload::new().u32(8_000).i32(-4_000));
    bench.write(39, Payload::new().u32(8_000).i32(4_000));
    bench.run_s(2.5);
    let [m1, m2] = bench.speeds();
    assert!((m1 + 4_000).abs() <= 20 && (m2 - 4_000).abs() <= 20, "{m1} {m2}");
}

#[test]
fn feed_forward_alone_follows_the_battery_and_the_friction() {
    let mut bench = Bench::new();
    // P, I and D 0: what is left is speed over QPPS as duty.
    bench.write(28, Payload::new().u32(0).u32(0).u32(0).u32(QPPS));
    bench.write(35, Payload::new().i32(5_325));
    bench.run_s(2.0);
    assert_eq!(bench.duties()[0], 16_384);
    let [m1, _] = bench.speeds();
    assert!((4_700..5_325).contains(&m1), "{m1}");
}

#[test]
fn averages_108_are_the_mean_of_a_second() {
    let mut bench = Bench::of(Generation::Gen3);
    bench.tune_velocity();
    bench.write(37, Payload::new().i32(5_000).i32(-3_000));
    bench.run_s(3.0);
    let mut reply = bench.read(108, 8);
    let [m1, m2] = [reply.i32(), reply.i32()];
    assert!((m1 - 5_000).abs() <= 3 && (m2 + 3_000).abs() <= 3, "{m1} {m2}");
}
