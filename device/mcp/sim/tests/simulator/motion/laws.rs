//! Variants of the control law differ as their docs say, seen from outside as a tuner would probe them.

use super::rig::{Motor, Rig, settings};
use brushwork_mcp_sim::motion::{ControlLaw, MotionCommand, VelocityEstimate};

fn speed(speed_counts_per_s: i32) -> MotionCommand {
    MotionCommand::Speed { speed_counts_per_s, acceleration: None }
}

#[test]
fn the_greatest_common_divisor_of_raw_speeds_is_the_loop_rate() {
    for (law, rate) in
        [(ControlLaw::default(), 300), (ControlLaw { raw_speed_ticks: 1, ..ControlLaw::at_625_hz() }, 625)]
    {
        let mut rig = Rig::new(&law, settings(0.0, 0.0, 0.0), Motor::lag(10_000.0, 0.2));
        let _ = rig.command(speed(7_777));
        let mut divisor = 0;
        for _ in 0..600 {
            rig.tick();
            divisor = greatest_common_divisor(divisor, rig.channel.speeds().raw);
        }
        assert_eq!(divisor, rate);
    }
}

fn greatest_common_divisor(a: i32, b: i32) -> i32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[test]
fn without_feed_forward_only_the_error_drives() {
    let held = Motor::held();
    for (feed_forward, duty_raw) in [(true, 9_830), (false, 6_553)] {
        let law = ControlLaw { feed_forward, ..ControlLaw::default() };
        let mut rig = Rig::new(&law, settings(2.0, 0.0, 0.0), held);
        let _ = rig.command(speed(1_000));
        rig.tick();
        assert_eq!(rig.channel.duty_raw(), duty_raw);
    }
}

#[test]
fn an_extra_tick_delays_the_output_by_exactly_that() {
    for ticks in 0..=ControlLaw::MAX_DELAY_TICKS {
        let law = ControlLaw { output_delay_ticks: ticks, ..ControlLaw::default() };
        let mut rig = Rig::new(&law, settings(0.0, 0.0, 0.0), Motor::ideal(10_000.0));
        let _ = rig.command(speed(5_000));
        let waited = rig.ticks_until(|rig| rig.channel.duty_raw() != 0);
        assert_eq!(waited, u64::from(ticks) + 1);
    }
}

/// Highest P, in steps of 1, at which the loop still settles.
fn highest_stable_gain(law: &ControlLaw) -> usize {
    (1..200)
        .take_while(|&p| {
            let mut rig = Rig::new(law, settings(f64::from(p), 0.0, 0.0), Motor::lag(10_000.0, 0.05));
            let _ = rig.command(speed(5_000));
            rig.run_s(2.0);
            let swing = (0..300).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), _| {
                rig.tick();
                (low.min(rig.motor.speed()), high.max(rig.motor.speed()))
            });
            swing.1 - swing.0 < 1_000.0
        })
        .count()
}

#[test]
fn averages_delays_and_slower_rates_each_cost_gain() {
    let law = ControlLaw::default();
    let plain = highest_stable_gain(&law);
    let filtered = ControlLaw { velocity_estimate: VelocityEstimate::MovingAverage { ticks: 4 }, ..law };
    let delayed = ControlLaw { output_delay_ticks: 1, ..law };
    for (name, slower) in [("average", filtered), ("delay", delayed)] {
        let gain = highest_stable_gain(&slower);
        assert!(gain < plain, "{name}: {gain}, plain {plain}");
    }
    assert!(highest_stable_gain(&ControlLaw::at_625_hz()) > plain);
}

#[test]
fn a_low_pass_keeps_the_noise_of_counting_out_of_the_duty() {
    let ripple = |velocity_estimate| {
        let law = ControlLaw { velocity_estimate, ..ControlLaw::default() };
        let mut rig = Rig::new(&law, settings(3.0, 0.0, 0.0), Motor::lag(10_000.0, 0.1));
        let _ = rig.command(speed(4_321));
        rig.run_s(2.0);
        let (low, high) = (0..300).fold((i16::MAX, i16::MIN), |(low, high), _| {
            rig.tick();
            (low.min(rig.channel.duty_raw()), high.max(rig.channel.duty_raw()))
        });
        high - low
    };
    // One count a tick is 300 counts/s: 9 % of duty at P 3.
    assert!(ripple(VelocityEstimate::LastTick) > 2_500);
    assert!(ripple(VelocityEstimate::LowPass { time_constant_s: 0.05 }) < 500);
}
