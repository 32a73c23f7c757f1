//! Inputs and protection: limits, stops, reversal, bridge overrides.

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{
    BridgeOverride, Buffering, ControlLaw, DistanceMove, MotionCommand, MotionSettings, Outcome,
    PositionMove, PositionTarget, Refusal,
};
use brushwork_plant::bridge::BridgeOutput;

fn duty(duty_raw: i16) -> MotionCommand {
    MotionCommand::Duty { duty_raw, acceleration_raw: Some(655_359) }
}

fn speed(speed_counts_per_s: i32) -> MotionCommand {
    MotionCommand::Speed { speed_counts_per_s, acceleration: Some(20_000) }
}

fn move_to(counts: i32) -> MotionCommand {
    let position = PositionMove {
        acceleration: Some(0),
        speed_counts_per_s: Some(8_000),
        deceleration: Some(0),
        target: PositionTarget::Counts(counts),
    };
    MotionCommand::Position(position, Buffering::Immediate)
}

fn rig() -> Rig {
    let tuned = MotionSettings { position_p_raw: 20 * 1024, ..settings(1.0, 0.05, 0.0) };
    Rig::new(&ControlLaw::default(), tuned, Motor::lag(10_000.0, 0.02))
}

#[test]
fn a_forward_limit_stops_forward_motion_of_every_kind_and_allows_backward() {
    for (forward, backward) in
        [(duty(16_000), duty(-16_000)), (speed(5_000), speed(-5_000)), (move_to(200_000), move_to(-200_000))]
    {
        let mut rig = rig();
        let _ = rig.command(forward);
        rig.run_s(0.5);
        assert!(rig.motor.speed() > 3_000.0);
        rig.conditions.forward_limit = true;
        // At most 15 ticks of braking from full duty.
        rig.run_ticks(16);
        assert!(rig.channel.duty_raw() <= 0, "{forward:?}");
        rig.run_s(0.5);
        assert!(rig.motor.speed().abs() < 1.0, "{forward:?}: {}", rig.motor.speed());
        let _ = rig.command(backward);
        rig.run_s(0.5);
        assert!(rig.motor.speed() < -3_000.0, "{backward:?}");
    }
}

#[test]
fn a_backward_limit_is_its_mirror() {
    let mut rig = rig();
    rig.conditions.backward_limit = true;
    let _ = rig.command(duty(-16_000));
    rig.run_s(0.5);
    assert_eq!(rig.position(), 0);
    let _ = rig.command(speed(-3_000));
    rig.run_s(0.5);
    assert_eq!(rig.position(), 0);
    let _ = rig.command(speed(3_000));
    rig.run_s(0.5);
    assert!(rig.position() > 1_000);
}

#[test]
fn motion_goes_on_through_its_ramp_once_a_limit_is_cleared() {
    let mut rig = rig();
    rig.conditions.forward_limit = true;
    let _ = rig.command(speed(5_000));
    rig.run_s(1.0);
    rig.conditions.forward_limit = false;
    rig.tick();
    assert!(rig.setpoint() <= 67, "{}", rig.setpoint());
    rig.run_s(1.0);
    assert_eq!(rig.setpoint(), 5_000);
}

#[test]
fn a_safe_stop_input_stops_and_refuses_commands_while_it_lasts() {
    let mut rig = rig();
    let _ = rig.command(duty(32_767));
    rig.run_s(0.5);
    rig.conditions.safe_stop = true;
    assert_eq!(rig.ticks_until(|rig| rig.channel.duty_raw() == 0), 15);
    assert_eq!(rig.command(duty(32_767)), Outcome::Refused(Refusal::Held));
    rig.conditions.safe_stop = false;
    rig.run_s(0.2);
    assert_eq!(rig.channel.duty_raw(), 0, "nothing starts by itself");
    assert_eq!(rig.command(duty(32_767)), Outcome::Started);
}

#[test]
fn an_off_input_opens_the_bridge_and_drops_the_buffer() {
    let mut rig = rig();
    let distance = DistanceMove { speed_counts_per_s: 5_000, acceleration: None, distance_counts: 50_000 };
    let _ = rig.command(MotionCommand::Distance(distance, Buffering::Queue));
    let _ = rig.command(MotionCommand::Distance(distance, Buffering::Queue));
    rig.run_s(0.5);
    rig.conditions.off = true;
    assert_eq!(rig.tick(), BridgeOutput::Coast);
    assert_eq!(rig.channel.buffer_length(), 0x80);
    assert_eq!(rig.command(speed(1_000)), Outcome::Refused(Refusal::Held));
    rig.conditions.off = false;
    assert_eq!(rig.tick(), BridgeOutput::Coast, "it stays off until it is told to move");
}

#[test]
fn a_reverse_input_turns_duty_and_speed_round_through_their_ramps() {
    let mut rig = rig();
    let _ = rig.command(speed(5_000));
    rig.run_s(1.0);
    rig.conditions.reverse = true;
    // From 5000 to -5000 at 20000 per second.
    assert_eq!(rig.ticks_until(|rig| rig.setpoint() == -5_000), 150);
    let _ = rig.command(duty(10_000));
    rig.run_s(0.5);
    assert_eq!(rig.channel.duty_raw(), -10_000);
    rig.conditions.reverse = false;
    rig.run_s(0.5);
    assert_eq!(rig.channel.duty_raw(), 10_000);
}

#[test]
fn bridge_overrides_win_and_what_ran_goes_on_from_zero_output() {
    for (bridge, output) in
        [(BridgeOverride::Brake, BridgeOutput::Brake), (BridgeOverride::Freewheel, BridgeOutput::Coast)]
    {
        let mut rig = rig();
        let _ = rig.command(MotionCommand::Duty { duty_raw: 32_767, acceleration_raw: Some(32_768) });
        rig.run_s(1.5);
        rig.conditions.bridge = bridge;
        assert_eq!(rig.tick(), output);
        rig.run_s(0.5);
        rig.conditions.bridge = BridgeOverride::None;
        rig.tick();
        assert_eq!(rig.channel.duty_raw(), 109);
        rig.run_s(1.0);
        assert_eq!(rig.channel.duty_raw(), 32_767);
    }
}

#[test]
fn a_distance_interrupted_by_protection_still_covers_its_counts() {
    let mut rig = rig();
    let distance =
        DistanceMove { speed_counts_per_s: 5_000, acceleration: Some(20_000), distance_counts: 10_000 };
    let _ = rig.command(MotionCommand::Distance(distance, Buffering::Queue));
    rig.run_s(1.0);
    rig.conditions.bridge = BridgeOverride::Freewheel;
    rig.run_s(1.0);
    assert_eq!(rig.channel.buffer_length(), 0);
    rig.conditions.bridge = BridgeOverride::None;
    rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
    rig.run_s(1.0);
    // What is left is the slow end of a loop of P 1, I 0.05.
    assert!((rig.position() - 10_000).abs() <= 40, "{}", rig.position());
}
