//! Duty commands: ramps, torque mode, idle, homing.

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{
    Channel, Conditions, ControlLaw, EncoderInput, HomeOutcome, Measured, MotionCommand, MotionSettings,
    Outcome, ZeroDutyAcceleration,
};
use brushwork_plant::bridge::BridgeOutput;

fn duty(duty_raw: i16, acceleration_raw: Option<u32>) -> MotionCommand {
    MotionCommand::Duty { duty_raw, acceleration_raw }
}

fn rig_at(law: &ControlLaw) -> Rig {
    Rig::new(law, settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0))
}

fn ticks_to_duty(rig: &mut Rig, goal: i16) -> u64 {
    rig.ticks_until(|rig| rig.channel.duty_raw() == goal)
}

#[test]
fn a_duty_ramp_ends_at_its_exact_tick() {
    for (law, second) in [(ControlLaw::default(), 300), (ControlLaw::at_625_hz(), 625)] {
        let mut rig = rig_at(&law);
        assert_eq!(rig.command(duty(32_767, Some(32_768))), Outcome::Started);
        // 32768 is 100 % per second.
        assert_eq!(ticks_to_duty(&mut rig, 32_767), second);
        let _ = rig.command(duty(0, Some(65_536)));
        assert_eq!(ticks_to_duty(&mut rig, 0), second.div_ceil(2));
    }
}

#[test]
fn the_highest_duty_acceleration_reverses_in_100_ms_and_more_counts_as_that() {
    for acceleration in [655_359, u32::MAX] {
        let mut rig = rig_at(&ControlLaw::default());
        let _ = rig.command(duty(32_767, Some(acceleration)));
        assert_eq!(ticks_to_duty(&mut rig, 32_767), 15);
        let _ = rig.command(duty(i16::MIN, Some(acceleration)));
        assert_eq!(ticks_to_duty(&mut rig, -32_767), 30);
    }
}

#[test]
fn a_duty_without_acceleration_takes_the_defaults_up_and_down() {
    let mut rig = rig_at(&ControlLaw::default());
    rig.settings.default_accel_raw = 32_768;
    rig.settings.default_decel_raw = 65_536;
    let _ = rig.command(duty(-32_767, None));
    assert_eq!(ticks_to_duty(&mut rig, -32_767), 300);
    let _ = rig.command(duty(0, None));
    assert_eq!(ticks_to_duty(&mut rig, 0), 150);
}

#[test]
fn an_acceleration_of_zero_is_read_as_the_law_says() {
    for (reading, after_one_tick) in [
        (ZeroDutyAcceleration::Fastest, 2_185),
        (ZeroDutyAcceleration::NoRamp, 20_000),
        (ZeroDutyAcceleration::Frozen, 0),
    ] {
        let mut rig = rig_at(&ControlLaw { zero_duty_acceleration: reading, ..ControlLaw::default() });
        let _ = rig.command(duty(20_000, Some(0)));
        rig.tick();
        assert_eq!(rig.channel.duty_raw(), after_one_tick, "{reading:?}");
    }
}

#[test]
fn a_duty_command_after_a_speed_starts_from_the_duty_applied() {
    let mut rig = rig_at(&ControlLaw::default());
    let _ = rig.command(MotionCommand::Speed { speed_counts_per_s: 5_000, acceleration: None });
    rig.run_s(0.1);
    assert_eq!(rig.channel.duty_raw(), 16_384);
    let _ = rig.command(duty(32_767, Some(32_768)));
    rig.tick();
    assert_eq!(rig.channel.duty_raw(), 16_493);
}

#[test]
fn safe_stop_takes_the_highest_deceleration_and_coast_none() {
    let mut rig = rig_at(&ControlLaw::default());
    rig.settings.default_accel_raw = 1;
    let _ = rig.command(duty(32_767, Some(655_359)));
    rig.run_s(0.2);
    let _ = rig.command(MotionCommand::SafeStop);
    assert_eq!(ticks_to_duty(&mut rig, 0), 15);
    assert_eq!(rig.tick(), BridgeOutput::Duty(0.0));
    let _ = rig.command(duty(32_767, Some(655_359)));
    rig.run_s(0.2);
    let _ = rig.command(MotionCommand::Coast);
    assert_eq!(rig.tick(), BridgeOutput::Coast);
    let _ = rig.command(duty(32_767, Some(32_768)));
    rig.tick();
    assert_eq!(rig.channel.duty_raw(), 109, "a ramp after coasting starts at 0");
}

#[test]
fn an_idle_bridge_opens_after_its_delay_when_told_to() {
    let mut rig = rig_at(&ControlLaw::default());
    rig.settings.pwm_idle_raw = 0x80 | 5;
    let _ = rig.command(duty(10_000, None));
    rig.run_s(0.1);
    let _ = rig.command(duty(0, Some(655_359)));
    assert_eq!(ticks_to_duty(&mut rig, 0), 5);
    assert_eq!(rig.ticks_until(|rig| rig.channel.output() == BridgeOutput::Coast), 150);
    rig.settings.pwm_idle_raw = 5;
    assert_eq!(rig.tick(), BridgeOutput::Duty(0.0));
}

#[test]
fn homing_runs_until_the_switch_or_the_time_out() {
    let home = MotionCommand::Home { duty_raw: -8_192, timeout_300ths: 600 };
    for (law, timeout_ticks) in [(ControlLaw::default(), 600), (ControlLaw::at_625_hz(), 1_250)] {
        let mut rig = rig_at(&law);
        let _ = rig.command(home);
        assert_eq!(rig.ticks_until(|rig| !rig.channel.is_homing()), timeout_ticks + 1);
        assert_eq!(rig.channel.home_outcome(), Some(HomeOutcome::TimedOut));
        assert!(rig.position() < -2_000);
        ticks_to_duty(&mut rig, 0);

        let _ = rig.command(home);
        assert_eq!(rig.channel.home_outcome(), None);
        rig.run_s(0.5);
        assert!(rig.channel.reach_home());
        assert_eq!(rig.channel.home_outcome(), Some(HomeOutcome::Reached));
        ticks_to_duty(&mut rig, 0);
        assert!(!rig.channel.reach_home(), "only homing has an end at the switch");
    }
}

/// A stalled winding with current sensing, stepped ten times a tick.
fn stalled_amps(settings: &MotionSettings, command: MotionCommand, seconds: f64) -> f64 {
    const STEPS: usize = 10;
    let (ohms, henries, bus_volts) = (0.5, 0.5e-3, 24.0);
    let mut channel = Channel::new(&ControlLaw::default());
    let _ = channel.command(command, settings);
    let mut amps = 0.0;
    let dt_s = channel.law().tick_s() / STEPS as f64;
    for _ in 0..(seconds * 300.0) as usize {
        let measured = Measured { encoder: EncoderInput::Quadrature(0), current_amps: amps, bus_volts };
        let mut output = channel.tick(&measured, &Conditions::default(), settings);
        for step in 0..STEPS {
            if step > 0 {
                output = channel.refine(amps, bus_volts, dt_s);
            }
            let steady = output.duty() * bus_volts / ohms;
            amps = steady + (amps - steady) * f64::exp(-ohms * dt_s / henries);
        }
    }
    amps
}

#[test]
fn duty_is_a_share_of_the_maximum_current_once_l_and_r_are_set() {
    let torque = MotionSettings {
        inductance_raw: (0.5e-3 * 16_777_216.0) as u32,
        resistance_raw: (0.5 * 16_777_216.0) as u32,
        max_current_raw: 2_000,
        ..settings(0.0, 0.0, 0.0)
    };
    for (duty_raw, amps) in [(16_384, 10.0), (-8_192, -5.0), (32_767, 20.0)] {
        let reached = stalled_amps(&torque, duty(duty_raw, Some(655_359)), 1.0);
        assert!((reached - amps).abs() < 0.02, "duty {duty_raw}: {reached} A");
    }
    for one_missing in
        [MotionSettings { inductance_raw: 0, ..torque }, MotionSettings { resistance_raw: 0, ..torque }]
    {
        let reached = stalled_amps(&one_missing, duty(8_192, Some(655_359)), 1.0);
        assert!((reached - 12.0).abs() < 0.02, "a quarter of 24 V over 0.5 ohm: {reached} A");
    }
}

#[test]
fn the_maximum_current_caps_a_stalled_motor_in_duty_mode() {
    let limited = MotionSettings { max_current_raw: 1_500, ..settings(0.0, 0.0, 0.0) };
    let reached = stalled_amps(&limited, duty(32_767, Some(655_359)), 0.5);
    assert!((reached - 15.0).abs() < 0.3, "{reached} A");
}
