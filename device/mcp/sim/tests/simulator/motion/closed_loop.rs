//! Speed and distance commands.

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{
    AntiWindup, Buffering, ControlLaw, DistanceEnd, DistanceMove, GainTiming, MotionCommand, MotionSettings,
    Outcome,
};

fn speed(speed_counts_per_s: i32, acceleration: u32) -> MotionCommand {
    MotionCommand::Speed { speed_counts_per_s, acceleration: Some(acceleration) }
}

fn distance(
    speed_counts_per_s: i32,
    acceleration: u32,
    distance_counts: u32,
    buffering: Buffering,
) -> MotionCommand {
    let distance = DistanceMove { speed_counts_per_s, acceleration: Some(acceleration), distance_counts };
    MotionCommand::Distance(distance, buffering)
}

#[test]
fn speed_ramps_take_the_times_the_manual_gives() {
    // MCP manual, command 38: 12000 at 12000 per second in 1 s, at 24000 in 0.5 s.
    for law in [ControlLaw::default(), ControlLaw::at_625_hz()] {
        for (acceleration, seconds) in [(12_000, 1.0), (24_000, 0.5)] {
            let mut rig = Rig::new(&law, settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0));
            let _ = rig.command(speed(12_000, acceleration));
            let ticks = rig.ticks_until(|rig| rig.setpoint() == 12_000);
            assert_eq!(ticks, (seconds * f64::from(law.rate_hz)).ceil() as u64);
        }
    }
}

#[test]
fn a_new_speed_ramps_on_from_the_setpoint_reached() {
    let mut rig = Rig::new(&ControlLaw::default(), settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0));
    let _ = rig.command(speed(6_000, 6_000));
    rig.run_s(0.5);
    assert_eq!(rig.setpoint(), 3_000);
    let _ = rig.command(speed(-3_000, 12_000));
    assert_eq!(rig.ticks_until(|rig| rig.setpoint() == -3_000), 150);
}

#[test]
fn a_speed_without_acceleration_is_set_at_once() {
    let mut rig = Rig::new(&ControlLaw::default(), settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0));
    let _ = rig.command(MotionCommand::Speed { speed_counts_per_s: -7_000, acceleration: None });
    rig.tick();
    assert_eq!(rig.setpoint(), -7_000);
}

#[test]
fn a_closed_loop_takes_over_a_running_motor_at_its_speed() {
    let mut rig = Rig::new(&ControlLaw::default(), settings(0.0, 0.0, 0.0), Motor::ideal(12_000.0));
    let _ = rig.command(MotionCommand::Duty { duty_raw: 16_384, acceleration_raw: Some(655_359) });
    rig.run_s(1.0);
    let _ = rig.command(speed(9_000, 3_000));
    rig.tick();
    assert!((rig.setpoint() - 6_010).abs() <= 300, "{}", rig.setpoint());
}

#[test]
fn feed_forward_alone_gives_the_target_speed_on_an_ideal_motor() {
    for target in [-9_000, -300, 600, 4_500, 10_000] {
        let mut rig = Rig::new(&ControlLaw::default(), settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0));
        let _ = rig.command(speed(target, 0));
        rig.run_s(1.5);
        assert!((rig.channel.speeds().average - target).abs() <= 1, "{target}");
    }
}

#[test]
fn proportional_control_leaves_a_friction_offset_that_the_integral_removes() {
    let motor = Motor::lag(10_000.0, 0.1).with_friction(0.1);
    let average_with = |p, i| {
        let mut rig = Rig::new(&ControlLaw::default(), settings(p, i, 0.0), motor);
        let _ = rig.command(speed(5_000, 0));
        rig.run_s(4.0);
        rig.channel.speeds().average
    };
    // (1 + P) e = 0.1 QPPS.
    assert!((average_with(0.0, 0.0) - 4_000).abs() <= 2);
    assert!((average_with(1.0, 0.0) - 4_500).abs() <= 5);
    assert!((average_with(3.0, 0.0) - 4_750).abs() <= 5);
    assert!((average_with(1.0, 0.05) - 5_000).abs() <= 1);
}

#[test]
fn factory_gains_hold_a_small_gearmotor_stable_per_tick() {
    let factory = MotionSettings { qpps: 10_000, ..MotionSettings::default() };
    let mut rig = Rig::new(&ControlLaw::default(), factory, Motor::lag(10_000.0, 0.06).with_friction(0.05));
    let _ = rig.command(speed(6_000, 0));
    rig.run_s(3.0);
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..300 {
        rig.tick();
        lowest = lowest.min(rig.motor.speed());
        highest = highest.max(rig.motor.speed());
    }
    assert!(lowest > 5_700.0 && highest < 6_300.0, "{lowest} to {highest}");
}

#[test]
fn a_loop_that_could_not_reach_its_setpoint_leaves_saturation_at_once() {
    let overshoot_s = |anti_windup| {
        let law = ControlLaw { anti_windup, ..ControlLaw::default() };
        let mut rig = Rig::new(&law, settings(1.0, 0.05, 0.0), Motor::lag(10_000.0, 0.05));
        let _ = rig.command(speed(20_000, 0));
        rig.run_s(1.0);
        let _ = rig.command(speed(5_000, 0));
        let ticks = rig.ticks_until(|rig| rig.motor.speed() < 5_500.0);
        f64::from(u32::try_from(ticks).unwrap()) / 300.0
    };
    assert!(overshoot_s(AntiWindup::BackCalculation) < 0.2);
    assert!(overshoot_s(AntiWindup::Hold) < 0.3);
    assert!(overshoot_s(AntiWindup::None) > 1.0);
}

/// What the law probe of a tuner looks at: the slope of the duty under a pure integral tells the unit of I.
#[test]
fn the_slope_of_a_pure_integral_tells_per_tick_from_per_second() {
    let duty_after_a_second = |gain_timing| {
        let law = ControlLaw { gain_timing, feed_forward: false, ..ControlLaw::default() };
        let mut rig = Rig::new(&law, settings(0.0, 1.0 / 1024.0, 0.0), Motor::held());
        let _ = rig.command(speed(1_000, 0));
        rig.run_s(1.0);
        rig.channel.duty_raw()
    };
    assert_eq!(duty_after_a_second(GainTiming::PerTick), 960, "1000 counts/s x 300 ticks / 1024 of 10000");
    assert_eq!(duty_after_a_second(GainTiming::PerSecond), 3);
}

#[test]
fn distance_moves_end_on_the_count_on_an_ideal_motor() {
    for law in [ControlLaw::default(), ControlLaw::at_625_hz()] {
        for (speed, acceleration, length) in [
            (8_000, 16_000, 12_000),
            (-8_000, 16_000, 12_000),
            (8_000, 4_000, 500),
            (900, 0, 1_234),
            (30, 10, 45),
        ] {
            let mut rig = Rig::new(&law, settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0));
            assert_eq!(
                rig.command(distance(speed, acceleration, length, Buffering::Queue)),
                Outcome::Started
            );
            let ticks = rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
            rig.run_s(1.0);
            let end = i32::try_from(length).unwrap() * speed.signum();
            assert!((rig.position() - end).abs() <= 2, "{speed} {acceleration} {length}: {}", rig.position());
            let (speed, rate) = (f64::from(speed.abs()), f64::from(acceleration));
            let length = f64::from(length);
            let ideal_s = match acceleration {
                0 => length / speed,
                _ if speed * speed / rate > length => 2.0 * (length / rate).sqrt(),
                _ => length / speed + speed / rate,
            };
            let seconds = f64::from(u32::try_from(ticks).unwrap()) * law.tick_s();
            assert!((seconds / ideal_s - 1.0).abs() < 0.08, "{seconds} s of {ideal_s} s");
        }
    }
}

#[test]
fn distance_moves_of_a_tuned_motor_end_close_to_the_distance() {
    let motor = Motor::lag(10_000.0, 0.05).with_friction(0.05);
    let mut rig = Rig::new(&ControlLaw::default(), settings(2.0, 0.1, 0.0), motor);
    for (number, speed) in [6_000, -6_000, 3_000].into_iter().enumerate() {
        let start = rig.position();
        let _ = rig.command(distance(speed, 12_000, 9_000, Buffering::Queue));
        rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
        rig.run_s(1.0);
        let moved = (rig.position() - start) * speed.signum();
        assert!((moved - 9_000).abs() <= 12, "move {number}: {moved}");
    }
}

#[test]
fn a_move_followed_by_a_ramp_to_zero_adds_the_ramps_distance() {
    // The vendor's example: 42000 at 12000, then speed 0 at 12000 per second: "the total move is 48000".
    let example = |distance_end| {
        let law = ControlLaw { distance_end, ..ControlLaw::default() };
        let mut rig = Rig::new(
            &law,
            MotionSettings { qpps: 20_000, ..settings(0.0, 0.0, 0.0) },
            Motor::ideal(20_000.0),
        );
        assert_eq!(rig.command(distance(12_000, 12_000, 42_000, Buffering::Immediate)), Outcome::Started);
        assert_eq!(rig.command(distance(0, 12_000, 0, Buffering::Queue)), Outcome::Queued);
        assert_eq!(rig.channel.buffer_length(), 1);
        rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
        rig.position()
    };
    let carried_on = example(DistanceEnd::CarryOn);
    assert!((carried_on - 48_000).abs() <= 40, "{carried_on}");
    let stopped = example(DistanceEnd::AlwaysStop);
    assert!((stopped - 42_000).abs() <= 2, "{stopped}");
}

#[test]
fn chained_moves_do_not_add_up_their_overruns() {
    let mut rig = Rig::new(&ControlLaw::default(), settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0));
    // 33.3 counts a tick: single ends would overrun by up to 33 counts each.
    for _ in 0..20 {
        let _ = rig.command(distance(10_000, 0, 1_003, Buffering::Queue));
    }
    rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
    rig.run_s(0.1);
    assert!((rig.position() - 20_060).abs() <= 2, "{}", rig.position());
}

#[test]
fn speed_errors_count_only_under_an_acceleration_and_a_limit() {
    let blocked = Motor::held();
    for (limit, acceleration, expected) in
        [(500, 100_000, true), (0, 100_000, false), (500, 0, false), (5_000, 100_000, false)]
    {
        let limited = MotionSettings { speed_error_limit: limit, ..settings(1.0, 0.0, 0.0) };
        let mut rig = Rig::new(&ControlLaw::default(), limited, blocked);
        let _ = rig.command(speed(-2_000, acceleration));
        rig.run_s(0.5);
        assert_eq!(rig.channel.errors().speed_counts_per_s, -2_000);
        assert_eq!(
            rig.channel.errors().speed_exceeded,
            expected,
            "limit {limit}, acceleration {acceleration}"
        );
        let _ = rig.command(MotionCommand::SafeStop);
        rig.tick();
        assert_eq!(rig.channel.errors().speed_counts_per_s, 0, "no loop, no error");
        assert_eq!(rig.channel.errors().speed_exceeded, expected, "a stop leaves the reason to be read");
        let _ = rig.command(MotionCommand::Duty { duty_raw: 100, acceleration_raw: None });
        assert!(!rig.channel.errors().speed_exceeded);
    }
}
