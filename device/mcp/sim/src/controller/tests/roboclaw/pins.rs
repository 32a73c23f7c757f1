//! S3, S4 and S5 as emergency stop, limit and home switches.

use super::*;
use brushwork_mcp_wire::packet_serial::Generation::{Gen3, Gen4};

/// Functions of a pin by generation: latching and momentary emergency stop, home switch.
fn numbers(generation: Generation) -> [i64; 3] {
    if generation < Gen3 { [1, 2, 4] } else { [0x81, 0x01, 0x62] }
}

fn running(generation: Generation) -> Bench {
    let mut bench = claw(generation);
    bench.ask(commands::DUTY_M1, &[16_000]);
    bench.wait(Duration::from_millis(300));
    assert!(duty(&mut bench) > 40.0);
    bench
}

#[test]
fn a_latching_stop_holds_until_the_power_goes_and_a_momentary_one_until_the_pin_is_let_go() {
    for generation in Generation::ALL {
        let [latching, momentary, _] = numbers(generation);
        for (function, is_latching) in [(latching, true), (momentary, false)] {
            for pin in [S3, S4, S5] {
                let mut bench = running(generation);
                let mut functions = [0; 3];
                functions[pin - S3] = function;
                set_pins(&mut bench, functions);
                pull(&mut bench, pin, true);
                bench.wait(A_MOMENT);
                assert!(has(&mut bench, Condition::EStop), "{generation} {function:#x}");
                assert_eq!(duty(&mut bench), 0.0);
                pull(&mut bench, pin, false);
                bench.wait(A_MOMENT);
                assert_eq!(has(&mut bench, Condition::EStop), is_latching, "{generation} {function:#x}");
                bench.ask(commands::DUTY_M1, &[16_000]);
                bench.wait(A_MOMENT);
                assert_eq!(duty(&mut bench) == 0.0, is_latching, "{generation} {function:#x}");
            }
        }
    }
}

#[test]
fn nothing_moves_again_by_itself_when_a_momentary_stop_ends() {
    let mut bench = running(Gen4);
    set_pins(&mut bench, [0x01, 0, 0]);
    pull(&mut bench, S3, true);
    bench.wait(A_MOMENT);
    pull(&mut bench, S3, false);
    bench.wait(A_MOMENT);
    assert_eq!(duty(&mut bench), 0.0);
}

#[test]
fn s3_is_a_latching_stop_as_it_comes_in_a_serial_mode_and_an_open_pin_is_none() {
    for generation in Generation::ALL {
        let mut bench = running(generation);
        assert!(!has(&mut bench, Condition::EStop));
        pull(&mut bench, S3, true);
        bench.wait(A_MOMENT);
        pull(&mut bench, S3, false);
        bench.wait(A_MOMENT);
        assert!(has(&mut bench, Condition::EStop), "{generation}");
        restart(&mut bench);
        bench.wait(A_MOMENT);
        assert!(!has(&mut bench, Condition::EStop), "{generation}");
    }
}

#[test]
fn an_inverted_stop_is_on_while_its_pin_is_not_pulled() {
    let mut bench = running(Gen4);
    pull(&mut bench, S4, true);
    set_pins(&mut bench, [0, 0x09, 0]);
    bench.wait(A_MOMENT);
    assert!(!has(&mut bench, Condition::EStop));
    pull(&mut bench, S4, false);
    bench.wait(A_MOMENT);
    assert!(has(&mut bench, Condition::EStop));
}

#[test]
fn a_number_without_a_name_does_nothing() {
    let mut bench = running(Gen4);
    set_pins(&mut bench, [0x41, 0x11, 0x21]);
    for pin in [S3, S4, S5] {
        pull(&mut bench, pin, true);
    }
    bench.wait(A_MOMENT);
    assert!(!has(&mut bench, Condition::EStop) && duty(&mut bench) > 40.0);
    let held = bench.ask(commands::READ_PIN_FUNCTIONS, &[]);
    assert_eq!([held.int(name::S3), held.try_int(name::S4).unwrap()], [0x41, 0x11]);
}

#[test]
fn a_limit_stops_one_way_and_lets_the_motor_go_the_other() {
    for (function, bars_forward) in [(0x12, true), (0x22, false)] {
        for generation in [Gen3, Gen4] {
            let mut bench = claw(generation);
            set_pins(&mut bench, [0, function, 0]);
            pull(&mut bench, S4, true);
            for (asked, is_forward) in [(16_000, true), (-16_000, false)] {
                bench.ask(commands::DUTY_M1, &[asked]);
                bench.wait(Duration::from_millis(300));
                let is_barred = is_forward == bars_forward;
                assert_eq!(duty(&mut bench) == 0.0, is_barred, "{generation} {function:#x} {asked}");
            }
            assert!(has(&mut bench, Condition::S4Signal), "{generation}");
            pull(&mut bench, S4, false);
            bench.wait(A_MOMENT);
            assert!(!has(&mut bench, Condition::S4Signal), "{generation}");
        }
    }
}

#[test]
fn one_switch_for_both_ends_bars_the_way_that_the_motor_ran() {
    for (asked, away) in [(16_000, -16_000), (-16_000, 16_000)] {
        let mut bench = claw(Gen4);
        set_pins(&mut bench, [0, 0x32, 0]);
        bench.ask(commands::DUTY_M1, &[asked]);
        bench.wait(Duration::from_millis(300));
        pull(&mut bench, S4, true);
        bench.wait(Duration::from_millis(300));
        assert_eq!(duty(&mut bench), 0.0, "{asked}");
        bench.ask(commands::DUTY_M1, &[away]);
        bench.wait(Duration::from_millis(300));
        assert!(duty(&mut bench).abs() > 40.0, "{away}");
    }
}

#[test]
fn a_home_switch_stops_the_motor_and_sets_its_encoder_to_zero() {
    for generation in Generation::ALL {
        let [_, _, home] = numbers(generation);
        let mut bench = claw(generation);
        set_pins(&mut bench, [0, home, 0]);
        bench.wait(A_MOMENT);
        bench.ask(commands::SET_ENCODER_M1, &[50_000]);
        bench.ask(commands::DUTY_M1, &[-16_000]);
        bench.wait(Duration::from_millis(300));
        assert!(position(&mut bench) < 50_000);
        pull(&mut bench, S4, true);
        bench.wait(Duration::from_millis(500));
        assert_eq!(duty(&mut bench), 0.0, "{generation}");
        assert!(position(&mut bench).abs() < 3000, "{generation}: {}", position(&mut bench));
        // S4 is motor 1's: motor 2 runs on.
        bench.ask(commands::DUTY_M2, &[-16_000]);
        bench.wait(Duration::from_millis(300));
        assert!(duties(&mut bench)[1] < -40.0, "{generation}");
    }
}

#[test]
fn home_and_forward_limit_on_one_pin_are_told_apart_by_the_way_the_motor_runs() {
    for (asked, is_home) in [(16_000, false), (-16_000, true)] {
        let mut bench = claw(Gen4);
        set_pins(&mut bench, [0, 0x72, 0]);
        bench.wait(A_MOMENT);
        bench.ask(commands::SET_ENCODER_M1, &[500_000]);
        bench.ask(commands::DUTY_M1, &[asked]);
        bench.wait(Duration::from_millis(300));
        pull(&mut bench, S4, true);
        bench.wait(Duration::from_millis(500));
        assert_eq!(duty(&mut bench), 0.0, "{asked}");
        assert_eq!(position(&mut bench).abs() < 100_000, is_home, "{asked}: {}", position(&mut bench));
    }
}

#[test]
fn a_switch_that_the_shaft_closes_is_seen_on_the_pin_it_is_wired_to() {
    use brushwork_plant::world::SwitchKind;
    let mut bench = claw(Gen3);
    set_pins(&mut bench, [0, 0, 0x12]);
    bench.apply(&WorldAction::WireSwitch {
        motor: Motor::M2,
        switch: SwitchKind::Forward,
        pin: Some(S5),
        trips_at_radians: Some(2.0),
    });
    bench.ask(commands::DUTY_M2, &[10_000]);
    bench.wait(Duration::from_secs(3));
    assert_eq!(duties(&mut bench)[1], 0.0);
    let stands_at = bench.unit().world().truth(Motor::M2).load_radians;
    assert!((2.0..3.0).contains(&stands_at), "{stands_at}");
    assert!(has(&mut bench, Condition::S5Signal));
}

#[test]
fn the_button_wired_to_a_pin_stops_by_that_pins_function_alone() {
    for (function, stops) in [(0x01, true), (0x14, false)] {
        let mut config = config(Gen4);
        config.world.wiring.estop_pin = Some(S3);
        let mut bench = Bench::of(config);
        set_pins(&mut bench, [function, 0, 0]);
        bench.apply(&WorldAction::EStop { pressed: true });
        bench.wait(A_MOMENT);
        assert_eq!(has(&mut bench, Condition::EStop), stops, "{function:#x}");
    }
}

#[test]
fn a_board_of_one_motor_has_no_s4_and_drives_no_second_motor() {
    let model = models::lookup("roboclaw-solo-60a").expect("it is listed");
    let mut bench = Bench::of(ControllerConfig { generation: Gen3, ..ControllerConfig::of(model) });
    set_pins(&mut bench, [0, 0x01, 0x01]);
    // Its world has S1, S2 and S3.
    pull(&mut bench, S4, true);
    bench.ask(commands::DUTY_BOTH, &[16_000, 16_000]);
    bench.wait(Duration::from_millis(300));
    assert!(!has(&mut bench, Condition::EStop));
    let [first, second] = duties(&mut bench);
    assert!(first > 40.0 && second == 0.0, "{first} {second}");
    pull(&mut bench, S3, true);
    bench.wait(A_MOMENT);
    assert!(has(&mut bench, Condition::EStop));
}
