//! Commands 41 to 47 and 51: distances and their buffers.

use super::bench::{Bench, Payload};

const EMPTY: u8 = 0x80;

fn tuned() -> Bench {
    let mut bench = Bench::new();
    bench.tune_velocity();
    bench
}

fn wait(bench: &mut Bench) {
    bench.seconds_until(|bench| bench.buffers() == [EMPTY, EMPTY]);
    bench.run_s(1.0);
}

#[test]
fn distances_43_and_46_and_51_end_where_they_should() {
    let mut bench = tuned();
    // 46: acceleration 8000; motor 1 5000 counts/s over 8000, motor 2 -4000 over 3000; buffered.
    bench.write(46, Payload::new().u32(8_000).i32(5_000).u32(8_000).i32(-4_000).u32(3_000).u8(0));
    assert_eq!(bench.buffers(), [0, 0]);
    wait(&mut bench);
    let [m1, m2] = bench.counts();
    assert!((m1 - 8_000).abs() <= 12 && (m2 + 3_000).abs() <= 12, "{m1} {m2}");
    // 51: own accelerations, back again.
    bench.write(51, Payload::new().u32(8_000).i32(-5_000).u32(8_000).u32(4_000).i32(4_000).u32(3_000).u8(1));
    wait(&mut bench);
    let [m1, m2] = bench.counts();
    assert!(m1.abs() <= 20 && m2.abs() <= 20, "{m1} {m2}");
    // 43: no ramps; the motors run on a little by their inertia.
    bench.write(43, Payload::new().i32(3_000).u32(3_000).i32(3_000).u32(6_000).u8(0));
    wait(&mut bench);
    let [m1, m2] = bench.counts();
    assert!((m1 - 3_000).abs() <= 200 && (m2 - 6_000).abs() <= 200, "{m1} {m2}");
}

#[test]
fn the_buffer_reads_what_waits_and_flag_1_empties_it() {
    let mut bench = tuned();
    assert_eq!(bench.buffers(), [EMPTY, EMPTY]);
    // 44: acceleration, speed, distance, buffer flag.
    let forward = || Payload::new().u32(10_000).i32(4_000).u32(4_000).u8(0);
    for waiting in 0..4 {
        bench.write(44, forward());
        assert_eq!(bench.buffers(), [waiting, EMPTY]);
    }
    // 41 and 42: speed, distance, buffer flag.
    bench.write(42, Payload::new().i32(4_000).u32(100).u8(0));
    bench.write(41, Payload::new().i32(4_000).u32(100).u8(0));
    assert_eq!(bench.buffers(), [4, 0]);
    bench.run_s(1.3);
    assert_eq!(bench.buffers(), [3, EMPTY]);
    let before = bench.counts()[0];
    bench.write(44, Payload::new().u32(10_000).i32(4_000).u32(2_000).u8(1));
    assert_eq!(bench.buffers(), [0, EMPTY]);
    wait(&mut bench);
    let moved = bench.counts()[0] - before;
    assert!((moved - 2_000).abs() <= 30, "{moved}");
}

#[test]
fn sixty_four_commands_are_held_and_a_duty_empties_them() {
    let mut bench = tuned();
    for _ in 0..70 {
        // 45: acceleration, speed, distance, buffer flag.
        bench.write(45, Payload::new().u32(10_000).i32(4_000).u32(60_000).u8(0));
    }
    assert_eq!(bench.buffers(), [EMPTY, 0x3F]);
    bench.write(54, Payload::new().i16(0).u32(655_359).i16(0).u32(655_359));
    assert_eq!(bench.buffers(), [EMPTY, EMPTY]);
    bench.run_s(0.5);
    let stopped = bench.counts()[1];
    bench.run_s(1.0);
    assert_eq!(bench.counts()[1], stopped);
}

#[test]
fn the_vendors_example_of_a_move_and_a_ramp_down_goes_the_sum_of_both() {
    let mut bench = tuned();
    // 44 for motor 1 and 45 for motor 2: 10500 at 6000 and then speed 0, which takes 6000^2 / (2 * 6000) = 3000 more.
    bench.write(44, Payload::new().u32(6_000).i32(6_000).u32(10_500).u8(1));
    bench.write(45, Payload::new().u32(6_000).i32(-6_000).u32(10_500).u8(1));
    bench.write(44, Payload::new().u32(6_000).i32(0).u32(0).u8(0));
    bench.write(45, Payload::new().u32(6_000).i32(0).u32(0).u8(0));
    wait(&mut bench);
    let [m1, m2] = bench.counts();
    assert!((m1 - 13_500).abs() <= 60 && (m2 + 13_500).abs() <= 60, "{m1} {m2}");
}
