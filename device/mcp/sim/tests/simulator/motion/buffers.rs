//! The buffer of each channel and its reading (MCP manual, command 47).

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{
    Buffering, ControlLaw, DistanceMove, MotionCommand, MotionSettings, Outcome, PositionMove,
    PositionTarget, Refusal,
};

fn distance(length: u32, buffering: Buffering) -> MotionCommand {
    let distance = DistanceMove { speed_counts_per_s: 3_000, acceleration: None, distance_counts: length };
    MotionCommand::Distance(distance, buffering)
}

fn position(counts: i32, buffering: Buffering) -> MotionCommand {
    let position = PositionMove {
        acceleration: Some(0),
        speed_counts_per_s: Some(3_000),
        deceleration: Some(0),
        target: PositionTarget::Counts(counts),
    };
    MotionCommand::Position(position, buffering)
}

fn rig() -> Rig {
    let with_position = MotionSettings { position_p_raw: 50 * 1024, ..settings(0.0, 0.0, 0.0) };
    Rig::new(&ControlLaw::default(), with_position, Motor::ideal(10_000.0))
}

#[test]
fn the_reading_is_0x80_empty_0_executing_the_last_and_else_what_waits() {
    let mut rig = rig();
    assert_eq!(rig.channel.buffer_length(), 0x80);
    assert_eq!(rig.command(distance(600, Buffering::Queue)), Outcome::Started);
    assert_eq!(rig.channel.buffer_length(), 0);
    assert_eq!(rig.command(distance(600, Buffering::Queue)), Outcome::Queued);
    assert_eq!(rig.command(distance(600, Buffering::Queue)), Outcome::Queued);
    assert_eq!(rig.channel.buffer_length(), 2);
    // 600 counts at 3000 counts/s: 60 ticks each.
    rig.run_ticks(30);
    assert_eq!(rig.channel.buffer_length(), 2);
    rig.run_ticks(60);
    assert_eq!(rig.channel.buffer_length(), 1);
    rig.run_ticks(60);
    assert_eq!(rig.channel.buffer_length(), 0);
    rig.run_ticks(60);
    assert_eq!(rig.channel.buffer_length(), 0x80);
    assert!((rig.position() - 1_800).abs() <= 2, "{}", rig.position());
}

#[test]
fn sixty_four_commands_fit_the_executing_one_included() {
    let mut rig = rig();
    assert_eq!(rig.command(distance(100, Buffering::Queue)), Outcome::Started);
    for _ in 0..63 {
        assert_eq!(rig.command(distance(100, Buffering::Queue)), Outcome::Queued);
    }
    assert_eq!(rig.channel.buffer_length(), 0x3F);
    assert_eq!(rig.command(distance(100, Buffering::Queue)), Outcome::Refused(Refusal::BufferFull));
    assert_eq!(rig.channel.buffer_length(), 0x3F);
    rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
    rig.run_s(0.1);
    assert!((rig.position() - 6_400).abs() <= 2, "{}", rig.position());
}

#[test]
fn flag_1_stops_the_running_command_empties_the_queue_and_executes_at_once() {
    let mut rig = rig();
    for _ in 0..5 {
        let _ = rig.command(distance(30_000, Buffering::Queue));
    }
    rig.run_ticks(30);
    let start = rig.position();
    assert_eq!(rig.command(distance(900, Buffering::Immediate)), Outcome::Started);
    assert_eq!(rig.channel.buffer_length(), 0);
    rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
    rig.run_s(0.2);
    assert!((rig.position() - start - 900).abs() <= 12, "{}", rig.position() - start);
    assert_eq!(rig.setpoint(), 0);
}

#[test]
fn an_unbuffered_command_takes_over_at_once_and_empties_the_buffer() {
    for unbuffered in [
        MotionCommand::Duty { duty_raw: 0, acceleration_raw: Some(655_359) },
        MotionCommand::Speed { speed_counts_per_s: 0, acceleration: None },
        MotionCommand::SafeStop,
        MotionCommand::Coast,
    ] {
        let mut rig = rig();
        for _ in 0..3 {
            let _ = rig.command(distance(30_000, Buffering::Queue));
        }
        rig.run_ticks(30);
        assert_eq!(rig.command(unbuffered), Outcome::Started);
        assert_eq!(rig.channel.buffer_length(), 0x80);
        rig.run_s(0.1);
        let stopped_at = rig.position();
        rig.run_s(1.0);
        assert_eq!(rig.position(), stopped_at, "{unbuffered:?}");
    }
}

#[test]
fn a_running_speed_or_duty_does_not_make_a_buffered_command_wait() {
    for running in [
        MotionCommand::Duty { duty_raw: 9_000, acceleration_raw: None },
        MotionCommand::Speed { speed_counts_per_s: 3_000, acceleration: None },
    ] {
        let mut rig = rig();
        let _ = rig.command(running);
        rig.run_ticks(60);
        assert_eq!(rig.command(distance(600, Buffering::Queue)), Outcome::Started);
        assert_eq!(rig.channel.buffer_length(), 0);
    }
}

#[test]
fn position_moves_queue_hold_and_mix_with_distance_moves() {
    let mut rig = rig();
    assert_eq!(rig.command(position(1_500, Buffering::Queue)), Outcome::Started);
    assert_eq!(rig.command(position(-300, Buffering::Queue)), Outcome::Queued);
    assert_eq!(rig.command(distance(900, Buffering::Queue)), Outcome::Queued);
    // 1500 counts at 3000 counts/s: half a second.
    assert!((rig.ticks_until(|rig| rig.channel.buffer_length() == 1) as i64 - 151).abs() <= 2);
    assert!((rig.position() - 1_500).abs() <= 60, "{}", rig.position());
    rig.ticks_until(|rig| rig.channel.buffer_length() == 0);
    let start = rig.position();
    assert!((start + 300).abs() <= 60, "{start}");
    rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
    rig.run_s(0.2);
    assert!((rig.position() - start - 900).abs() <= 20, "{}", rig.position() - start);

    let _ = rig.command(position(0, Buffering::Queue));
    rig.ticks_until(|rig| rig.channel.buffer_length() == 0x80);
    rig.run_s(1.0);
    assert!(rig.channel.state().position_loop, "the position is held after its move");
    assert!(rig.position().abs() <= 1);
}

#[test]
fn a_buffer_flag_other_than_0_counts_as_1() {
    assert_eq!(Buffering::from_wire(0), Buffering::Queue);
    assert_eq!(Buffering::from_wire(1), Buffering::Immediate);
    assert_eq!(Buffering::from_wire(7), Buffering::Immediate);
}
