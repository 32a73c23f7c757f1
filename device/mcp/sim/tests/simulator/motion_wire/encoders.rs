//! Commands 16, 17, 20, 22, 23: encoder registers.

use super::bench::{Bench, Payload};

/// Count and status of one motor, command 16 or 17.
fn encoder(bench: &mut Bench, command: u8) -> (u32, u8) {
    let mut reply = bench.read(command, 5);
    (reply.u32(), reply.u8())
}

#[test]
fn registers_are_set_reset_and_count_on() {
    let mut bench = Bench::new();
    bench.write(22, Payload::new().u32(1_000_000));
    bench.write(23, Payload::new().i32(-5));
    assert_eq!(encoder(&mut bench, 16), (1_000_000, 0));
    assert_eq!(encoder(&mut bench, 17), (0xFFFF_FFFB, 0));
    bench.write(34, Payload::new().i16(6_000).i16(0));
    bench.run_s(1.0);
    assert!(encoder(&mut bench, 16).0 > 1_000_500);
    bench.write(34, Payload::new().i16(0).i16(0));
    bench.run_s(0.5);
    bench.write(20, Payload::new());
    assert_eq!(bench.counts(), [0, 0]);
}

#[test]
fn underflow_and_overflow_are_flagged_once_and_the_direction_stays() {
    let mut bench = Bench::new();
    bench.write(34, Payload::new().i16(-6_000).i16(0));
    bench.run_s(0.5);
    let (count, status) = encoder(&mut bench, 16);
    assert!(count > 0xFFFF_0000, "{count:#x}");
    // Bit 0 underflow, bit 1 backwards.
    assert_eq!(status, 0b011);
    assert_eq!(encoder(&mut bench, 16).1, 0b010);
    bench.write(34, Payload::new().i16(6_000).i16(0));
    bench.run_s(1.5);
    // Bit 2 overflow.
    assert_eq!(encoder(&mut bench, 16).1, 0b100);
    assert_eq!(encoder(&mut bench, 16).1, 0);
}
