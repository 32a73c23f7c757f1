//! Homing at power-up (commands 105 to 107).

use super::*;
use brushwork_mcp_wire::packet_serial::Generation::{Gen3, Gen4};
use brushwork_plant::world::SwitchKind;

const HOME_AUTO: i64 = 0xE2;

/// A unit that homes motor 1 at the next power-up: switch at -1 radian, time-out in seconds.
fn homing(generation: Generation, duty_raw: i64, timeout_s: i64) -> Bench {
    let mut bench = claw(generation);
    bench.apply(&WorldAction::WireSwitch {
        motor: Motor::M1,
        switch: SwitchKind::Home,
        pin: Some(S4),
        trips_at_radians: Some(-1.0),
    });
    set_pins(&mut bench, [0, HOME_AUTO, 0]);
    let timeout = timeout_s * 300;
    match generation {
        Gen4 => bench.ask(commands::SET_HOMING_M1, &[timeout]),
        _ => bench.ask(commands::SET_HOMING_M1, &[duty_raw, timeout]),
    };
    bench
}

/// A home switch of motor 1 that it does not reach.
fn wire_far_switch(bench: &mut Bench) {
    bench.apply(&WorldAction::WireSwitch {
        motor: Motor::M1,
        switch: SwitchKind::Home,
        pin: Some(S4),
        trips_at_radians: Some(-1_000.0),
    });
}

#[test]
fn the_motor_looks_backward_for_its_switch_at_power_up_and_zeroes_its_encoder_there() {
    for generation in [Gen3, Gen4] {
        let mut bench = homing(generation, 8_000, 20);
        save_and_restart(&mut bench);
        bench.wait(A_MOMENT);
        assert!(duty(&mut bench) < 0.0, "{generation}");
        bench.wait(Duration::from_secs(10));
        assert_eq!(duty(&mut bench), 0.0, "{generation}");
        let stands_at = shaft(&bench);
        assert!((-1.6..=-1.0).contains(&stands_at), "{generation}: {stands_at}");
        assert!(position(&mut bench) <= 0 && position(&mut bench) > -2000, "{}", position(&mut bench));
    }
}

#[test]
fn a_motor_on_its_switch_first_runs_forward_off_it() {
    let mut bench = homing(Gen3, 8_000, 20);
    bench.ask(commands::DUTY_M1, &[-8_000]);
    bench.wait(Duration::from_secs(5));
    assert!(shaft(&bench) < -1.0);
    save_and_restart(&mut bench);
    let mut is_forward = || {
        bench.wait(Duration::from_millis(5));
        duty(&mut bench) > 0.0
    };
    assert!((0..20).any(|_| is_forward()), "it stands on its switch");
    bench.wait(Duration::from_secs(10));
    assert_eq!(duty(&mut bench), 0.0);
    assert!((-1.6..=-1.0).contains(&shaft(&bench)), "{}", shaft(&bench));
}

#[test]
fn a_switch_that_never_opens_ends_the_way_forward_after_three_seconds() {
    let mut bench = homing(Gen3, 8_000, 20);
    bench.apply(&WorldAction::HoldSwitch { motor: Motor::M1, switch: SwitchKind::Home, closed: true });
    save_and_restart(&mut bench);
    bench.wait(Duration::from_millis(2_900));
    assert!(duty(&mut bench) > 0.0);
    bench.wait(Duration::from_millis(500));
    // Backward is barred by the closed switch.
    assert_eq!(duty(&mut bench), 0.0);
}

#[test]
fn the_time_out_ends_it_and_the_motor_stands() {
    let mut bench = homing(Gen3, 3_000, 2);
    wire_far_switch(&mut bench);
    save_and_restart(&mut bench);
    bench.wait(Duration::from_millis(1_900));
    assert!(duty(&mut bench) < 0.0);
    bench.wait(Duration::from_millis(500));
    assert_eq!(duty(&mut bench), 0.0);
}

#[test]
fn motor_2_looks_for_its_switch_after_motor_1() {
    let mut bench = homing(Gen3, 3_000, 2);
    wire_far_switch(&mut bench);
    set_pins(&mut bench, [0, HOME_AUTO, HOME_AUTO]);
    bench.ask(commands::SET_HOMING_M2, &[3_000, 600]);
    save_and_restart(&mut bench);
    bench.wait(Duration::from_secs(1));
    let [first, second] = duties(&mut bench);
    assert!(first < 0.0 && second == 0.0, "{first} {second}");
    bench.wait(Duration::from_secs(2));
    let [first, second] = duties(&mut bench);
    assert!(first == 0.0 && second < 0.0, "{first} {second}");
}

#[test]
fn a_stop_ends_homing_of_both_motors_for_good() {
    let mut bench = homing(Gen3, 3_000, 20);
    set_pins(&mut bench, [0, HOME_AUTO, HOME_AUTO]);
    bench.ask(commands::SET_HOMING_M2, &[3_000, 6_000]);
    save_and_restart(&mut bench);
    bench.wait(A_MOMENT);
    assert!(duties(&mut bench).iter().any(|duty| *duty < 0.0), "a motor looks for its switch");
    bench.ask(commands::DUTY_BOTH, &[0, 0]);
    bench.wait(Duration::from_secs(2));
    assert_eq!(duties(&mut bench), [0.0, 0.0]);
}

#[test]
fn without_a_time_out_or_by_a_user_switch_nothing_moves_by_itself() {
    for (function, timeout_s) in [(HOME_AUTO, 0), (0x62, 20)] {
        let mut bench = homing(Gen4, 0, timeout_s);
        set_pins(&mut bench, [0, function, 0]);
        save_and_restart(&mut bench);
        bench.wait(Duration::from_millis(500));
        assert_eq!(duty(&mut bench), 0.0, "{function:#x}");
    }
}
