//! Position moves: profile, limits, cascaded and simple control.

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{
    Buffering, ControlLaw, MotionCommand, MotionSettings, Outcome, PositionForm, PositionMove,
    PositionTarget, Refusal,
};

fn gains(p: f64, d: f64) -> MotionSettings {
    MotionSettings {
        position_p_raw: (p * 1024.0) as u32,
        position_d_raw: (d * 1024.0) as u32,
        ..settings(0.0, 0.0, 0.0)
    }
}

fn go(target: PositionTarget, speed: u32, acceleration: u32, deceleration: u32) -> MotionCommand {
    let position = PositionMove {
        acceleration: Some(acceleration),
        speed_counts_per_s: Some(speed),
        deceleration: Some(deceleration),
        target,
    };
    MotionCommand::Position(position, Buffering::Immediate)
}

fn to(counts: i32) -> MotionCommand {
    go(PositionTarget::Counts(counts), 8_000, 16_000, 16_000)
}

fn both_forms() -> [ControlLaw; 2] {
    [PositionForm::TargetError, PositionForm::ProfileTracking]
        .map(|position_form| ControlLaw { position_form, ..ControlLaw::default() })
}

#[test]
fn a_move_goes_to_its_target_and_holds_it() {
    for law in both_forms() {
        let mut rig = Rig::new(&law, gains(40.0, 0.0), Motor::ideal(10_000.0));
        for target in [12_000, -500, -499] {
            assert_eq!(rig.command(to(target)), Outcome::Started);
            rig.run_s(3.0);
            assert!((rig.position() - target).abs() <= 1, "{:?}: {}", law.position_form, rig.position());
        }
    }
}

#[test]
fn a_move_takes_the_time_of_its_trapezoid_and_keeps_its_bounds() {
    for law in both_forms() {
        let mut rig = Rig::new(&law, gains(60.0, 0.0), Motor::ideal(10_000.0));
        let _ = rig.command(go(PositionTarget::Counts(12_000), 8_000, 16_000, 32_000));
        let (mut previous, mut top) = (0, 0);
        let ticks = rig.ticks_until(|rig| {
            let setpoint = rig.setpoint();
            // A count of position error is 60 counts/s to a loop that tracks its profile.
            assert!(
                setpoint - previous <= 16_000 / 300 + 62,
                "{:?}: {previous} to {setpoint}",
                law.position_form
            );
            previous = setpoint;
            top = top.max(setpoint);
            (rig.position() - 12_000).abs() <= 2
        });
        assert!((8_000..=8_200).contains(&top), "{:?}: {top}", law.position_form);
        // 0.5 s up over 2000, 0.25 s down over 1000, 9000 at 8000 counts/s; the last counts approach exponentially.
        let seconds = f64::from(u32::try_from(ticks).unwrap()) / 300.0;
        assert!((seconds - 1.875).abs() < 0.15, "{:?}: {seconds}", law.position_form);
    }
}

#[test]
fn a_move_without_ramps_takes_the_manuals_second() {
    // MCP manual, MOVE: 1000 counts at 1000 counts/s "should take 1 second then stops".
    let mut rig = Rig::new(&ControlLaw::default(), gains(100.0, 0.0), Motor::ideal(10_000.0));
    let _ = rig.command(go(PositionTarget::Counts(1_000), 1_000, 0, 0));
    let ticks = rig.ticks_until(|rig| rig.position() >= 999);
    assert!((290..=320).contains(&ticks), "{ticks}");
}

#[test]
fn the_target_is_kept_between_minimum_and_maximum() {
    let limited = MotionSettings { position_min_counts: -200, position_max_counts: 700, ..gains(40.0, 0.0) };
    let mut rig = Rig::new(&ControlLaw::default(), limited, Motor::ideal(10_000.0));
    for (target, end) in [(5_000, 700), (-5_000, -200), (123, 123)] {
        let _ = rig.command(to(target));
        rig.run_s(2.0);
        assert!((rig.position() - end).abs() <= 1, "{target}: {}", rig.position());
    }
}

#[test]
fn minimum_and_maximum_of_zero_give_no_movement() {
    let unset = MotionSettings { position_min_counts: 0, position_max_counts: 0, ..gains(40.0, 0.0) };
    let mut rig = Rig::new(&ControlLaw::default(), unset, Motor::ideal(10_000.0));
    assert_eq!(rig.command(to(5_000)), Outcome::Refused(Refusal::NoPositionRange));
    rig.run_s(1.0);
    assert_eq!(rig.position(), 0);
    assert_eq!(rig.channel.buffer_length(), 0x80);
}

#[test]
fn percent_positions_go_to_their_share_of_the_range() {
    let ranged =
        MotionSettings { position_min_counts: -1_000, position_max_counts: 3_000, ..gains(40.0, 0.0) };
    let mut rig = Rig::new(&ControlLaw::default(), ranged, Motor::ideal(10_000.0));
    for (percent, end) in [(32_767, 3_000), (0, 1_000), (-32_767, -1_000)] {
        let _ = rig.command(go(PositionTarget::Percent(percent), 8_000, 0, 0));
        rig.run_s(2.0);
        assert!((rig.position() - end).abs() <= 1, "{percent}: {}", rig.position());
    }
}

#[test]
fn a_move_without_its_own_values_takes_the_defaults() {
    let defaults = MotionSettings {
        default_speed_raw: 16_384,
        default_accel_raw: 65_536,
        default_decel_raw: 65_536,
        ..gains(60.0, 0.0)
    };
    let mut rig = Rig::new(&ControlLaw::default(), defaults, Motor::ideal(10_000.0));
    let position = PositionMove {
        acceleration: None,
        speed_counts_per_s: None,
        deceleration: None,
        target: PositionTarget::Counts(10_000),
    };
    let _ = rig.command(MotionCommand::Position(position, Buffering::Queue));
    rig.run_s(1.0);
    let state = rig.channel.state();
    assert_eq!(
        (state.target_speed_counts_per_s, state.acceleration, state.deceleration),
        (5_000, 20_000, 20_000)
    );
    assert_eq!(rig.setpoint(), 5_000);
}

#[test]
fn simple_position_control_gives_a_duty_of_speed_over_qpps() {
    // P = 20: an error of 100 counts asks for 2000 counts/s, a fifth of QPPS; the motor is held, so nothing else changes.
    let held = Motor::held();
    for feed_forward in [true, false] {
        let law = ControlLaw { feed_forward, ..ControlLaw::default() };
        let mut rig = Rig::new(&law, gains(20.0, 0.0), held);
        let _ = rig.command(go(PositionTarget::Counts(100), 10_000, 0, 0));
        rig.run_s(0.2);
        assert_eq!(rig.channel.duty_raw(), 6_553);
    }
}

#[test]
fn the_position_gain_scale_of_the_law_halves_the_same_wire_value() {
    let held = Motor::held();
    let law = ControlLaw { position_gain_scale: 2048.0, ..ControlLaw::default() };
    let mut rig = Rig::new(&law, gains(20.0, 0.0), held);
    let _ = rig.command(go(PositionTarget::Counts(100), 10_000, 0, 0));
    rig.run_s(0.2);
    assert_eq!(rig.channel.duty_raw(), 3_277);
}

#[test]
fn the_cascade_holds_against_friction_where_simple_control_gives_up() {
    let sticky = Motor::lag(10_000.0, 0.04).with_friction(0.15);
    let rest_at = |velocity: MotionSettings| {
        let cascaded = MotionSettings { position_p_raw: 15 * 1024, ..velocity };
        let mut rig = Rig::new(&ControlLaw::default(), cascaded, sticky);
        let _ = rig.command(to(4_000));
        rig.run_s(4.0);
        rig.position()
    };
    let simple = rest_at(settings(0.0, 0.0, 0.0));
    let cascaded = rest_at(settings(2.0, 0.1, 0.0));
    // 15 % of 10000 counts/s over P = 15: simple control gives up 100 counts short and coasts some of them.
    assert!((3_900..=3_970).contains(&simple), "{simple}");
    assert!((cascaded - 4_000).abs() <= 3, "{cascaded}");
}

#[test]
fn the_dead_zone_counts_as_arrived_and_max_i_bounds_the_integral() {
    let held = Motor::held();
    let dead = MotionSettings { position_deadzone_counts: 100, ..gains(20.0, 0.0) };
    let mut rig = Rig::new(&ControlLaw::default(), dead, held);
    let _ = rig.command(go(PositionTarget::Counts(100), 10_000, 0, 0));
    rig.run_s(0.2);
    assert_eq!(rig.channel.duty_raw(), 0);

    let integral = MotionSettings { position_i_raw: 1024, position_max_i: 2_500, ..gains(0.0, 0.0) };
    let mut rig = Rig::new(&ControlLaw::default(), integral, held);
    let _ = rig.command(go(PositionTarget::Counts(100), 10_000, 0, 0));
    rig.run_ticks(10);
    assert_eq!(rig.channel.duty_raw(), 3_277, "ten ticks of 100 counts, of 10000");
    rig.run_s(2.0);
    assert_eq!(rig.channel.duty_raw(), 8_192, "2500 of 10000");
}

#[test]
fn damping_takes_the_overshoot_out_of_a_lagging_motor() {
    let overshoot = |d| {
        let mut rig = Rig::new(&ControlLaw::default(), gains(40.0, d), Motor::lag(10_000.0, 0.08));
        let _ = rig.command(go(PositionTarget::Counts(1_000), 10_000, 0, 0));
        let mut highest = 0;
        for _ in 0..900 {
            rig.tick();
            highest = highest.max(rig.position());
        }
        assert!((rig.position() - 1_000).abs() <= 2, "d {d}: {}", rig.position());
        highest - 1_000
    };
    assert!(overshoot(0.0) > 150, "{}", overshoot(0.0));
    // Td = 600 / 40 / 300 s = 50 ms.
    assert!(overshoot(600.0) < 30, "{}", overshoot(600.0));
}

#[test]
fn position_errors_count_only_with_acceleration_and_deceleration() {
    let held = Motor::held();
    for (limit, acceleration, deceleration, expected) in [
        (300, 16_000, 16_000, true),
        (0, 16_000, 16_000, false),
        (300, 0, 16_000, false),
        (300, 16_000, 0, false),
    ] {
        let limited = MotionSettings { position_error_limit: limit, ..gains(1.0, 0.0) };
        let mut rig = Rig::new(&ControlLaw::default(), limited, held);
        let _ = rig.command(go(PositionTarget::Counts(-1_000), 8_000, acceleration, deceleration));
        rig.run_s(1.0);
        assert_eq!(rig.channel.errors().position_counts, -1_000);
        assert_eq!(rig.channel.errors().position_exceeded, expected, "{limit} {acceleration} {deceleration}");
    }
}

#[test]
fn a_register_set_while_holding_moves_the_motor_back_by_as_much() {
    let mut rig = Rig::new(&ControlLaw::default(), gains(40.0, 0.0), Motor::ideal(10_000.0));
    let _ = rig.command(to(1_000));
    rig.run_s(2.0);
    rig.channel.encoder_mut().set(1_500);
    rig.run_s(2.0);
    assert!((rig.position() - 1_000).abs() <= 1);
}
