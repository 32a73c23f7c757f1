//! The relay test through a channel (commands 84 to 89).

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{ControlLaw, MotionCommand, RelayCommand, RelayOn};
use brushwork_plant::bridge::BridgeOutput;

fn relay(on: RelayOn, amplitude_raw: u32, hysteresis: u32) -> MotionCommand {
    MotionCommand::Relay(RelayCommand { on, amplitude_raw, hysteresis })
}

fn run_to_end(rig: &mut Rig) -> [u32; 2] {
    assert_eq!(rig.channel.relay_result_raw(), [0, 0]);
    rig.ticks_until(|rig| !rig.channel.is_relay_running());
    rig.run_s(0.2);
    assert_eq!(rig.channel.output(), BridgeOutput::Duty(0.0), "the test ends with the motor stopped");
    rig.channel.relay_result_raw()
}

/// A lag with dead time under a relay: `a = K d (1 - exp(-D / tau))`, `T = 2 tau ln(2 exp(D / tau) - 1)`, where the dead time of the
/// loop is the output delay, the hold of one tick on average half, and the tick over which the speed is counted, half.
#[test]
fn a_speed_relay_measures_what_a_lag_with_dead_time_must_give() {
    let law = ControlLaw { output_delay_ticks: 6, ..ControlLaw::default() };
    let tau_s = 0.1;
    let mut rig = Rig::new(&law, settings(1.0, 0.0, 0.0), Motor::lag(20_000.0, tau_s));
    let _ = rig.command(relay(RelayOn::Speed, 9_830, 0));
    let [amplitude, period_us] = run_to_end(&mut rig).map(f64::from);
    let dead_s = 7.5 / 300.0;
    let expected_amplitude = 20_000.0 * 0.3 * (1.0 - f64::exp(-dead_s / tau_s));
    let expected_period_s = 2.0 * tau_s * (2.0 * f64::exp(dead_s / tau_s) - 1.0).ln();
    assert!((amplitude / expected_amplitude - 1.0).abs() < 0.1, "{amplitude}, expected {expected_amplitude}");
    assert!(
        (period_us * 1e-6 / expected_period_s - 1.0).abs() < 0.1,
        "{period_us} us, expected {expected_period_s} s"
    );
}

#[test]
fn a_relay_around_a_running_speed_keeps_running_around_it() {
    let law = ControlLaw { output_delay_ticks: 3, ..ControlLaw::default() };
    let mut rig = Rig::new(&law, settings(0.0, 0.0, 0.0), Motor::lag(20_000.0, 0.1));
    let _ = rig.command(MotionCommand::Duty { duty_raw: 16_384, acceleration_raw: None });
    rig.run_s(1.0);
    let _ = rig.command(relay(RelayOn::Speed, 3_277, 400));
    rig.run_s(0.2);
    assert!(rig.channel.is_relay_running());
    assert!((rig.motor.speed() - 10_000.0).abs() < 1_500.0, "{}", rig.motor.speed());
    let [amplitude, _] = run_to_end(&mut rig);
    assert!((200..2_000).contains(&amplitude), "{amplitude}");
}

#[test]
fn a_position_relay_oscillates_around_where_it_began() {
    let mut rig = Rig::new(&ControlLaw::default(), settings(0.0, 0.0, 0.0), Motor::lag(10_000.0, 0.05));
    rig.channel.encoder_mut().set(700);
    let _ = rig.command(relay(RelayOn::Position, 10_000, 20));
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    rig.ticks_until(|rig| {
        lowest = lowest.min(rig.position());
        highest = highest.max(rig.position());
        !rig.channel.is_relay_running()
    });
    let [amplitude, period_us] = rig.channel.relay_result_raw();
    assert!(lowest < 680 && highest > 720, "{lowest} to {highest}");
    assert!(
        (20..400).contains(&amplitude) && (20_000..2_000_000).contains(&period_us),
        "{amplitude} {period_us}"
    );
}

#[test]
fn hysteresis_makes_the_oscillation_wider() {
    let amplitude_with = |hysteresis| {
        let mut rig = Rig::new(&ControlLaw::default(), settings(0.0, 0.0, 0.0), Motor::lag(20_000.0, 0.1));
        let _ = rig.command(relay(RelayOn::Speed, 9_830, hysteresis));
        run_to_end(&mut rig)[0]
    };
    assert!(amplitude_with(2_000) > amplitude_with(0) + 1_000);
}

#[test]
fn a_reversed_encoder_ends_the_test_at_its_time_limit_without_a_result() {
    let law = ControlLaw { relay_time_limit_s: 3, ..ControlLaw::default() };
    let mut rig = Rig::new(&law, settings(0.0, 0.0, 0.0), Motor::lag(10_000.0, 0.05).with_reversed_encoder());
    let _ = rig.command(relay(RelayOn::Speed, 10_000, 0));
    let ticks = rig.ticks_until(|rig| !rig.channel.is_relay_running());
    assert_eq!(ticks, 900);
    assert_eq!(rig.channel.relay_result_raw(), [0, 0]);
    rig.run_s(1.0);
    assert!(rig.motor.speed().abs() < 1.0);
}
