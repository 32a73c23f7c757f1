//! Commands 109 to 114 and 133 to 136: error and current limits.

use super::bench::{Bench, Payload, QPPS};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;

#[test]
fn a_current_limit_caps_a_locked_motor_and_warns() {
    let mut bench = Bench::new();
    // 133: maximum 1.00 A, minimum 0.
    bench.write(133, Payload::new().u32(100).u32(0));
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.write(34, Payload::new().i16(32_767).i16(32_767));
    bench.run_s(0.5);
    assert!((bench.currents()[0] - 100).abs() <= 5, "{:?}", bench.currents());
    assert!((bench.truth(Motor::M1).amps - 1.0).abs() < 0.05);
    // Bit 0: over-current warning of motor 1, and of motor 1 alone.
    assert_eq!(bench.status() & 0x0003, 0x0001);
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: false });
    bench.run_s(1.0);
    assert_eq!(bench.status() & 0x0003, 0);
    assert_eq!(bench.duties()[0], 32_767);
}

#[test]
fn speed_errors_109_to_111_are_read_and_flagged_beyond_their_limit() {
    let mut bench = Bench::of(Generation::Gen3);
    for command in [28, 29] {
        bench.write(command, Payload::new().u32(0).u32(0x0001_0000).u32(0).u32(QPPS));
    }
    // 109: limits of both motors.
    bench.write(109, Payload::new().u32(1_000).u32(0));
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.apply(&WorldAction::LockShaft { motor: Motor::M2, on: true });
    // 40: acceleration 20000, 3000 for both.
    bench.write(40, Payload::new().u32(20_000).i32(3_000).i32(3_000));
    // The setpoint is 800 after 40 ms.
    bench.run_s(0.04);
    let mut reply = bench.read(111, 8);
    let [m1, m2] = [reply.i32(), reply.i32()];
    assert!((600..=1_000).contains(&m1) && (600..=1_000).contains(&m2), "{m1} {m2}");
    assert_eq!(bench.read(90, 4).u32() & 0x0300, 0);
    bench.run_s(0.1);
    // Bit 8: speed error of motor 1; motor 2 has no limit.
    assert_eq!(bench.read(90, 4).u32() & 0x0300, 0x0100);
}

#[test]
fn position_errors_112_to_114_are_read_and_flagged_beyond_their_limit() {
    let mut bench = Bench::of(Generation::Gen3);
    bench.tune_velocity();
    for command in [61, 62] {
        let wide = Payload::new().u32(0).u32(15 * 1024).u32(0).u32(0).u32(0);
        bench.write(command, wide.i32(-20_000).i32(20_000));
    }
    bench.write(112, Payload::new().u32(0).u32(400));
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.apply(&WorldAction::LockShaft { motor: Motor::M2, on: true });
    let one = |payload: Payload| payload.u32(20_000).u32(5_000).u32(20_000).i32(-5_000);
    bench.write(67, one(one(Payload::new())).u8(1));
    // 20000 t^2 / 2 = 100 counts after 0.1 s.
    bench.run_s(0.1);
    let mut reply = bench.read(114, 8);
    let [m1, m2] = [reply.i32(), reply.i32()];
    assert!((-130..=-70).contains(&m1) && (-130..=-70).contains(&m2), "{m1} {m2}");
    assert_eq!(bench.read(90, 4).u32() & 0x0C00, 0);
    bench.run_s(0.3);
    // Bit 11: position error of motor 2; motor 1 has no limit.
    assert_eq!(bench.read(90, 4).u32() & 0x0C00, 0x0800);
}
