//! Commands 61 to 67 and 119 to 127: position moves.

use super::bench::{Bench, Payload, QPPS};
use brushwork_mcp_wire::packet_serial::Generation;

/// 61 or 62: D, P, I, MaxI, dead zone, minimum, maximum.
fn position_pid(p: f64, range: (i32, i32)) -> Payload {
    Payload::new().u32(0).u32((p * 1024.0) as u32).u32(0).u32(0).u32(0).i32(range.0).i32(range.1)
}

fn bench_of(generation: Generation) -> Bench {
    let mut bench = Bench::of(generation);
    bench.tune_velocity();
    for command in [61, 62] {
        bench.write(command, position_pid(15.0, (-20_000, 20_000)));
    }
    bench
}

/// 67: acceleration, speed, deceleration, position of each motor, buffer flag.
fn profile_both(m1: i32, m2: i32) -> Payload {
    let one = |payload: Payload, position| payload.u32(20_000).u32(6_000).u32(20_000).i32(position);
    one(one(Payload::new(), m1), m2).u8(1)
}

fn assert_near(bench: &mut Bench, expected: [i32; 2], tolerance: i32) {
    let counts = bench.counts();
    for (count, expected) in counts.into_iter().zip(expected) {
        assert!((count - expected).abs() <= tolerance, "{counts:?}, expected {expected:?}");
    }
}

#[test]
fn moves_65_to_67_go_to_their_positions_and_hold_them() {
    let mut bench = bench_of(Generation::Gen1);
    bench.write(67, profile_both(7_000, -4_000));
    bench.run_s(3.0);
    assert_near(&mut bench, [7_000, -4_000], 3);
    // 65: a negative speed counts as its magnitude.
    bench.write(65, Payload::new().u32(20_000).i32(-6_000).u32(20_000).i32(-500).u8(0));
    bench.write(66, Payload::new().u32(20_000).u32(6_000).u32(20_000).i32(900).u8(0));
    bench.run_s(3.0);
    assert_near(&mut bench, [-500, 900], 3);
}

#[test]
fn positions_stay_within_their_limits_and_do_not_move_without_any() {
    let mut bench = bench_of(Generation::Gen1);
    bench.write(61, position_pid(15.0, (-300, 1_200)));
    bench.write(62, position_pid(15.0, (0, 0)));
    bench.write(67, profile_both(15_000, 15_000));
    bench.run_s(2.0);
    assert_near(&mut bench, [1_200, 0], 3);
    bench.write(67, profile_both(-15_000, -15_000));
    bench.run_s(2.0);
    assert_near(&mut bench, [-300, 0], 3);
}

#[test]
fn simple_position_control_is_what_velocity_gains_of_zero_give() {
    let mut bench = bench_of(Generation::Gen1);
    bench.write(28, Payload::new().u32(0).u32(0).u32(0).u32(QPPS));
    bench.write(61, position_pid(30.0, (-20_000, 20_000)));
    bench.write(65, Payload::new().u32(0).u32(QPPS).u32(0).i32(3_000).u8(1));
    bench.run_s(3.0);
    let rest = bench.counts()[0];
    // Friction of some per cent over P = 30 is a few tens of counts.
    assert!((rest - 3_000).abs() < 60, "{rest}");
    assert!(bench.duties()[0].abs() < 3_000);
}

#[test]
fn moves_119_to_127_take_defaults_and_shares_of_the_range() {
    let mut bench = bench_of(Generation::Gen4);
    // 121: position M1, position M2, buffer flag.
    bench.write(121, Payload::new().i32(2_000).i32(-2_000).u8(1));
    bench.run_s(3.0);
    assert_near(&mut bench, [2_000, -2_000], 3);
    // 119, 120: one motor each.
    bench.write(119, Payload::new().i32(500).u8(1));
    bench.write(120, Payload::new().i32(-500).u8(1));
    bench.run_s(3.0);
    assert_near(&mut bench, [500, -500], 3);
    // 124: speed and position of each motor: 4000 counts at 2000 counts/s take 2 s.
    bench.write(124, Payload::new().u32(2_000).i32(4_500).u32(4_000).i32(-4_500).u8(1));
    bench.run_s(1.0);
    let [m1, m2] = bench.counts();
    assert!((m1 - 2_500).abs() < 200 && m2 < -3_500, "{m1} {m2}");
    bench.run_s(2.0);
    assert_near(&mut bench, [4_500, -4_500], 3);
    // 122, 123.
    bench.write(122, Payload::new().u32(5_000).i32(0).u8(1));
    bench.write(123, Payload::new().u32(5_000).i32(0).u8(1));
    bench.run_s(3.0);
    assert_near(&mut bench, [0, 0], 3);
    // 127: -32767 to 32767 is minimum to maximum.
    bench.write(127, Payload::new().i16(8_192).i16(-8_192).u8(1));
    bench.run_s(3.0);
    assert_near(&mut bench, [5_000, -5_000], 4);
    // 125, 126.
    bench.write(125, Payload::new().i16(0).u8(1));
    bench.write(126, Payload::new().i16(0).u8(1));
    bench.run_s(3.0);
    assert_near(&mut bench, [0, 0], 3);
}
