//! Limits, the emergency stop and what they do to motors, status, LEDs and outputs.

use super::support::Bench;
use crate::controller::ControllerConfig;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::status::{Condition, StatusIndicator, decode};
use brushwork_mcp_wire::packet_serial::{Generation, commands, name, number};
use brushwork_plant::BrakeResistorParams;
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::presets;
use brushwork_plant::world::Leds;
use brushwork_plant::world::{UnitFault, WorldAction};
use brushwork_values::{Motor, Severity};
use std::time::Duration;

const A_MOMENT: Duration = Duration::from_millis(200);

/// A unit whose motors run at half duty.
fn running(generation: Generation) -> Bench {
    let mut bench = Bench::new(generation);
    bench.ask(commands::DUTY_BOTH, &[16_000, 16_000]);
    bench.wait_talking(Duration::from_millis(800));
    assert_eq!(output(&bench), BridgeOutput::Duty(16_000.0 / 32_767.0));
    bench
}

fn output(bench: &Bench) -> BridgeOutput {
    bench.unit().view().axes[0].output
}

fn has(bench: &mut Bench, condition: Condition) -> bool {
    let word = bench.read(commands::READ_STATUS, name::STATUS) as u32;
    decode(word, bench.generation).contains(condition)
}

fn leds(bench: &Bench) -> Leds {
    bench.unit().unit().expect("it has power").leds()
}

#[test]
fn over_85_degrees_warns_and_takes_current_away_and_over_100_the_motors_freewheel_while_it_lasts() {
    for generation in Generation::ALL {
        let mut bench = running(generation);
        bench.apply(&WorldAction::SetBoardCelsius { celsius: Some(90.0) });
        bench.wait_talking(A_MOMENT);
        assert!(has(&mut bench, Condition::Temperature1Warning), "{generation}");
        assert!(!has(&mut bench, Condition::Temperature1Error));
        assert!(leds(&bench).err);
        bench.apply(&WorldAction::SetBoardCelsius { celsius: Some(101.0) });
        bench.wait_talking(A_MOMENT);
        assert!(has(&mut bench, Condition::Temperature1Error), "{generation}");
        assert_eq!(output(&bench), BridgeOutput::Coast);
        bench.apply(&WorldAction::SetBoardCelsius { celsius: Some(40.0) });
        bench.wait_talking(A_MOMENT);
        assert!(!has(&mut bench, Condition::Temperature1Error));
        assert!(matches!(output(&bench), BridgeOutput::Duty(duty) if duty > 0.0), "it goes on");
    }
}

#[test]
fn the_second_sensor_counts_on_boards_that_have_one() {
    for (model, second) in [("mcp266", false), ("mcp2163", true)] {
        let model = models::lookup(model).expect("in the list");
        let mut bench = Bench::of(ControllerConfig::of(model));
        bench.apply(&WorldAction::SetBoardCelsius { celsius: Some(101.0) });
        bench.wait_talking(A_MOMENT);
        assert_eq!(has(&mut bench, Condition::Temperature2Error), second, "{}", model.key);
        assert_eq!(
            bench.read(commands::READ_TEMPERATURE_2, name::TEMPERATURE_2),
            if second { 1010 } else { 0 }
        );
    }
}

#[test]
fn a_main_battery_above_its_maximum_brakes_the_motors_while_it_lasts() {
    let mut bench = running(Generation::Gen1);
    bench.ask(commands::SET_MAIN_VOLTAGES, &[100, 260]);
    bench.apply(&WorldAction::SetBatteryVolts { volts: 28.0 });
    bench.wait_talking(A_MOMENT);
    assert!(has(&mut bench, Condition::MainBatteryHighWarning));
    assert_eq!(output(&bench), BridgeOutput::Brake);
    assert!(leds(&bench).err);
    bench.apply(&WorldAction::SetBatteryVolts { volts: 24.0 });
    bench.wait_talking(A_MOMENT);
    assert!(!has(&mut bench, Condition::MainBatteryHighWarning));
    assert!(matches!(output(&bench), BridgeOutput::Duty(_)));
}

#[test]
fn a_main_battery_above_the_rating_brakes_until_a_restart() {
    let mut bench = running(Generation::Gen3);
    bench.apply(&WorldAction::SetBatteryVolts { volts: 62.0 });
    bench.wait_talking(A_MOMENT);
    bench.apply(&WorldAction::SetBatteryVolts { volts: 24.0 });
    bench.wait_talking(A_MOMENT);
    assert!(has(&mut bench, Condition::MainBatteryHighError));
    assert_eq!(output(&bench), BridgeOutput::Brake);
    bench.apply(&WorldAction::Power { on: false });
    bench.apply(&WorldAction::Power { on: true });
    bench.wait_talking(A_MOMENT);
    assert!(!has(&mut bench, Condition::MainBatteryHighError));
    bench.ask(commands::DUTY_M1, &[16_000]);
    bench.wait_talking(A_MOMENT);
    assert!(matches!(output(&bench), BridgeOutput::Duty(duty) if duty > 0.0));
}

#[test]
fn a_main_battery_below_its_minimum_lets_the_motors_freewheel() {
    let mut bench = running(Generation::Gen1);
    bench.ask(commands::SET_MAIN_VOLTAGES, &[230, 600]);
    bench.apply(&WorldAction::SetBatteryVolts { volts: 15.0 });
    bench.wait_talking(A_MOMENT);
    assert!(has(&mut bench, Condition::MainBatteryLowWarning));
    assert_eq!(output(&bench), BridgeOutput::Coast);
}

#[test]
fn logic_battery_errors_freewheel_until_a_restart() {
    for (volts, condition) in
        [(16.0, Condition::LogicBatteryHighError), (5.5, Condition::LogicBatteryLowError)]
    {
        let mut bench = running(Generation::Gen1);
        if condition == Condition::LogicBatteryLowError {
            bench.apply(&WorldAction::SetBatteryVolts { volts: 6.0 }); // else the main battery feeds the logic
        }
        bench.apply(&WorldAction::SetLogicVolts { volts });
        bench.wait_talking(Duration::from_secs(20));
        bench.apply(&WorldAction::SetBatteryVolts { volts: 24.0 });
        bench.apply(&WorldAction::SetLogicVolts { volts: 12.0 });
        bench.wait_talking(A_MOMENT);
        assert!(has(&mut bench, condition), "{condition:?}");
        assert_eq!(output(&bench), BridgeOutput::Coast, "{condition:?}");
    }
}

#[test]
fn a_locked_shaft_is_held_to_the_current_limit_and_warned_about() {
    let mut bench = Bench::new(Generation::Gen1);
    bench.ask(commands::SET_CURRENT_LIMITS_M1, &[150, -150]); // 1.5 A
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.ask(commands::DUTY_M1, &[32_767]);
    bench.wait_talking(Duration::from_millis(900));
    let current = bench.read(commands::READ_CURRENTS, name::CURRENT_M1);
    assert!((140..=160).contains(&current), "{current} x 10 mA");
    assert!(has(&mut bench, Condition::M1OverCurrentWarning));
    assert!(!has(&mut bench, Condition::M2OverCurrentWarning));
    assert_eq!(
        StatusIndicator::M1OverCurrent.lit_by(bench.unit().unit().expect("power").conditions()),
        Some(Severity::Warning)
    );
}

/// MCP manual 1.6.3: "Error LED lit while condition is active. Over Current, Warning, Motor power is automatically limited."
#[test]
fn a_locked_shaft_lights_the_error_led_whichever_loop_drives() {
    for generation in Generation::ALL {
        let mut bench = Bench::new(generation);
        bench.ask(
            commands::SET_CURRENT_LIMITS_M1,
            &[150, if generation == Generation::Gen1 { -150 } else { 150 }],
        );
        bench.ask(commands::SET_POSITION_PID_M1, &[0, 0x1000, 0, 0, 0, -100_000, 100_000]);
        bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
        for drive in ["duty", "speed", "position"] {
            match drive {
                "duty" => drop(bench.ask(commands::DUTY_M1, &[32_767])),
                "speed" => drop(bench.ask(commands::SPEED_M1, &[40_000])),
                _ => drop(bench.ask(commands::POSITION_PROFILE_M1, &[100_000, 40_000, 100_000, 50_000, 1])),
            }
            bench.wait_talking(Duration::from_millis(900));
            for look in 0..20 {
                bench.wait_talking(Duration::from_millis(10));
                assert!(leds(&bench).err, "{drive} in {generation}, look {look}");
                assert!(
                    has(&mut bench, Condition::M1OverCurrentWarning),
                    "{drive} in {generation}, look {look}"
                );
            }
            bench.ask(commands::DUTY_M1, &[0]);
            bench.wait_talking(A_MOMENT);
            assert!(!leds(&bench).err, "{drive} in {generation}: it is over");
        }
    }
}

/// MCP manual 1.4.1: "Auto detect will sample the main battery voltage on power-up or after a reset ... the Stat2 LED will blink to
/// indicate the battery cell count that was detected. Each blink indicates the number of LIPO cells detected."
#[test]
fn stat2_blinks_once_for_each_cell_that_was_detected_at_power_up_and_the_battery_is_protected() {
    for (volts, cells) in [(11.1, 3), (14.8, 4), (22.2, 6)] {
        let mut bench = Bench::new(Generation::Gen1);
        bench.apply(&WorldAction::SetBatteryVolts { volts });
        bench.apply(&WorldAction::SetBatteryDetection { on: true });
        bench.wait(Duration::from_secs(2));
        assert!(!leds(&bench).stat2, "it counts at power-up, not before");
        bench.apply(&WorldAction::Power { on: false });
        bench.wait(A_MOMENT);
        bench.apply(&WorldAction::Power { on: true });
        bench.wait(crate::supervision::POWER_UP_BLINK - Duration::from_millis(10));
        let looks: Vec<bool> = (0..500)
            .map(|_| {
                bench.wait(Duration::from_millis(10));
                leds(&bench).stat2
            })
            .collect();
        // The blink of all three at power-up runs into the first of them.
        let blinks = looks.windows(2).filter(|pair| pair[0] && !pair[1]).count();
        assert_eq!(blinks, cells, "{volts} V");
        // The lowest that so many cells may have is 3 V each.
        bench.apply(&WorldAction::SetBatteryVolts { volts: 2.9 * cells as f64 });
        bench.wait_talking(A_MOMENT);
        assert!(has(&mut bench, Condition::MainBatteryLowWarning), "{volts} V");
    }
}

/// Commands 26 and 58 "set logic input (LB- / LB+) minimum voltage level. RoboClaw will shut down with an error if the voltage is
/// below this level": a good main battery is no excuse. MCP manual 1.0.10: without a logic battery the main one feeds the logic.
#[test]
fn the_logic_minimum_is_the_logic_batterys_own_where_one_is_connected() {
    for (logic_volts, is_low) in [(0.0, false), (7.5, true), (8.5, false)] {
        let mut bench = Bench::new(Generation::Gen1);
        bench.apply(&WorldAction::SetLogicVolts { volts: logic_volts });
        bench.wait_talking(A_MOMENT);
        assert_eq!(has(&mut bench, Condition::LogicBatteryLowError), is_low, "{logic_volts} V");
    }
}

/// Command 148: "Set PWM Drive mode. Locked Antiphase(0) or Sign Magnitude(1)." The mean is the same, the ripple at rest is not.
#[test]
fn locked_antiphase_heats_a_motor_at_rest_and_sign_magnitude_does_not() {
    let watts = |mode| {
        let mut bench = Bench::new(Generation::Gen1);
        bench.ask(commands::SET_PWM_MODE, &[mode]);
        bench.ask(commands::DUTY_BOTH, &[0, 0]);
        bench.wait(Duration::from_secs(2));
        let view = bench.unit().view();
        assert_eq!(view.axes[0].truth.amps, 0.0, "no current in the mean");
        view.battery_amps * view.battery_volts
    };
    let [antiphase, magnitude] = [0, 1].map(watts);
    assert!(antiphase > magnitude + 0.02, "{antiphase} W and {magnitude} W");
}

#[test]
fn a_locked_emergency_stop_needs_a_restart() {
    for generation in Generation::ALL {
        let mut bench = running(generation);
        bench.apply(&WorldAction::EStop { pressed: true });
        bench.wait_talking(A_MOMENT);
        assert_eq!(output(&bench), BridgeOutput::Brake, "{generation}");
        assert_eq!(leds(&bench), Leds { stat1: true, stat2: true, err: true });
        bench.apply(&WorldAction::EStop { pressed: false });
        bench.ask(commands::RESET_ESTOP, &[]);
        bench.wait_talking(A_MOMENT);
        assert!(has(&mut bench, Condition::EStop), "{generation}");
        bench.apply(&WorldAction::Power { on: false });
        bench.apply(&WorldAction::Power { on: true });
        bench.wait_talking(A_MOMENT);
        assert!(!has(&mut bench, Condition::EStop), "{generation}");
    }
}

#[test]
fn an_unlocked_emergency_stop_is_reset_by_command_and_the_motors_stay_stopped_until_told() {
    let mut bench = running(Generation::Gen1);
    bench.ask(commands::SET_ESTOP_LOCK, &[0xaa]);
    bench.apply(&WorldAction::EStop { pressed: true });
    bench.wait_talking(A_MOMENT);
    bench.ask(commands::DUTY_M1, &[10_000]); // acknowledged, and refused
    bench.ask(commands::RESET_ESTOP, &[]); // still pressed
    assert!(has(&mut bench, Condition::EStop));
    bench.apply(&WorldAction::EStop { pressed: false });
    bench.ask(commands::RESET_ESTOP, &[]);
    assert!(!has(&mut bench, Condition::EStop));
    bench.wait_talking(A_MOMENT);
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0);
    bench.ask(commands::DUTY_M1, &[10_000]);
    bench.wait_talking(A_MOMENT);
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 10_000);
}

#[test]
fn a_command_right_behind_the_reset_is_taken() {
    let mut bench = running(Generation::Gen1);
    bench.ask(commands::SET_ESTOP_LOCK, &[0xaa]);
    bench.apply(&WorldAction::EStop { pressed: true });
    bench.wait_talking(A_MOMENT);
    bench.apply(&WorldAction::EStop { pressed: false });
    bench.ask(commands::RESET_ESTOP, &[]);
    bench.ask(commands::DUTY_M1, &[10_000]);
    bench.wait_talking(A_MOMENT);
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 10_000);
}

#[test]
fn generation_4_can_reset_by_itself_and_the_others_take_its_code_for_locked() {
    for generation in Generation::ALL {
        let mut bench = Bench::new(generation);
        bench.ask(commands::SET_ESTOP_LOCK, &[0x55]);
        bench.apply(&WorldAction::EStop { pressed: true });
        bench.wait_talking(A_MOMENT);
        bench.apply(&WorldAction::EStop { pressed: false });
        bench.wait_talking(A_MOMENT);
        assert_eq!(has(&mut bench, Condition::EStop), generation != Generation::Gen4, "{generation}");
        assert_eq!(bench.read(commands::READ_ESTOP_LOCK, name::LOCK), 0x55);
    }
}

#[test]
fn a_speed_error_beyond_its_limit_stops_the_motor_and_shows_until_the_next_command() {
    let mut bench = Bench::new(Generation::Gen3);
    bench.ask(commands::SET_SPEED_ERROR_LIMITS, &[500, 0]);
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.ask(commands::SPEED_ACCEL_M1, &[20_000, 3_000]);
    bench.wait_talking(Duration::from_millis(800));
    assert!(has(&mut bench, Condition::M1SpeedError));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 0);
    bench.apply(&WorldAction::LockShaft { motor: Motor::M1, on: false });
    bench.ask(commands::DUTY_M1, &[5_000]);
    bench.wait_talking(A_MOMENT);
    assert!(!has(&mut bench, Condition::M1SpeedError));
    assert_eq!(bench.read(commands::READ_PWMS, name::DUTY_M1), 5_000);
}

#[test]
fn faults_of_the_electronics_stop_both_motors_until_a_restart_and_show_where_there_is_a_bit() {
    let roboclaw = models::lookup("roboclaw").expect("it is in the list");
    let faults = [
        (UnitFault::M2Driver, Condition::M2DriverFault, [true, true, true, true]),
        (UnitFault::M1Current, Condition::M1CurrentError, [false, false, true, true]),
    ];
    for generation in Generation::ALL {
        for (fault, condition, shown) in faults {
            let mut bench = Bench::of(ControllerConfig { generation, ..ControllerConfig::of(roboclaw) });
            bench.ask(commands::DUTY_BOTH, &[16_000, 16_000]);
            bench.wait_talking(A_MOMENT);
            bench.apply(&WorldAction::SetUnitFault { fault, on: true });
            bench.wait_talking(A_MOMENT);
            let shown = shown[usize::from(generation.number()) - 1];
            assert_eq!(has(&mut bench, condition), shown, "{fault:?} in {generation}");
            assert_eq!(output(&bench), BridgeOutput::Coast, "{fault:?} in {generation}");
            bench.apply(&WorldAction::SetUnitFault { fault, on: false });
            bench.ask(commands::DUTY_BOTH, &[16_000, 16_000]);
            bench.wait_talking(A_MOMENT);
            assert_eq!(output(&bench), BridgeOutput::Coast, "{fault:?} in {generation}");
            bench.apply(&WorldAction::Power { on: false });
            bench.wait(A_MOMENT);
            bench.apply(&WorldAction::Power { on: true });
            bench.wait_talking(A_MOMENT);
            assert!(!has(&mut bench, condition));
        }
    }
}

#[test]
fn a_boot_fault_shows_from_the_next_start_on_and_a_can_fault_while_it_lasts() {
    let mut bench = Bench::new(Generation::Gen4);
    for fault in [UnitFault::Boot, UnitFault::Can] {
        bench.apply(&WorldAction::SetUnitFault { fault, on: true });
    }
    bench.wait_talking(A_MOMENT);
    assert!(has(&mut bench, Condition::CanWarning) && !has(&mut bench, Condition::BootWarning));
    bench.apply(&WorldAction::Power { on: false });
    bench.wait(A_MOMENT);
    bench.apply(&WorldAction::Power { on: true });
    for fault in [UnitFault::Boot, UnitFault::Can] {
        bench.apply(&WorldAction::SetUnitFault { fault, on: false });
    }
    bench.wait_talking(A_MOMENT);
    assert!(!has(&mut bench, Condition::CanWarning) && has(&mut bench, Condition::BootWarning));
}

#[test]
fn digital_outputs_follow_their_actions() {
    let mut bench = Bench::new(Generation::Gen1);
    let outputs = |bench: &Bench| bench.unit().unit().expect("power").outputs().to_vec();
    bench.ask(commands::SET_DOUT_ACTION, &[0, 1]); // motor 1 on
    bench.ask(commands::SET_DOUT_ACTION, &[1, 8]); // over-temperature
    bench.wait_talking(A_MOMENT);
    assert_eq!(outputs(&bench), [false, false]);
    bench.ask(commands::DUTY_M1, &[5_000]);
    bench.apply(&WorldAction::SetBoardCelsius { celsius: Some(95.0) });
    bench.wait_talking(A_MOMENT);
    assert_eq!(outputs(&bench), [true, true]);
    bench.apply(&WorldAction::SetHidden { key: "dout.2.inverted".to_owned(), value: 1 });
    bench.wait_talking(A_MOMENT);
    assert_eq!(outputs(&bench), [true, false]);
}

#[test]
fn voltage_offsets_shift_the_readings_and_not_the_limits() {
    let mut bench = Bench::new(Generation::Gen3);
    let before = bench.read(commands::READ_MAIN_BATTERY, name::MAIN_BATTERY);
    bench.ask(commands::SET_VOLTAGE_OFFSETS, &[-7, 5]);
    assert_eq!(bench.read(commands::READ_MAIN_BATTERY, name::MAIN_BATTERY), before - 7);
    assert_eq!(bench.read(commands::READ_LOGIC_BATTERY, name::LOGIC_BATTERY), 125);
}

/// A flywheel on a power supply that takes no current back, slowed from full speed: at how many of 300 looks the unit had to
/// brake because the main battery was too high.
fn looks_at_which_protection_brakes(dout_action: i64) -> usize {
    let flywheel = presets::lookup("flywheel").expect("built in");
    let mut config = ControllerConfig::default();
    config.world = presets::world_of(flywheel, flywheel, config.model.pins.len());
    config.world.supply.can_sink = false;
    config.world.supply.brake_resistor = Some(BrakeResistorParams { ohms: 2.0, dout: 0 });
    let max_tenths = (config.world.supply.open_circuit_volts * 10.0) as i64 + 30;
    let mut bench = Bench::of(config);
    bench.ask(commands::SET_MAIN_VOLTAGES, &[100, max_tenths]);
    bench.ask(commands::SET_DOUT_ACTION, &[0, dout_action]);
    bench.ask(commands::DUTY_ACCEL_M1, &[32_767, 655_359]);
    bench.wait_talking(Duration::from_secs(30));
    bench.ask(commands::DUTY_ACCEL_M1, &[16_000, 6_553]); // to half duty in about 2.5 s: regeneration
    let mut braking = 0;
    for _ in 0..300 {
        bench.wait_talking(Duration::from_millis(10));
        braking += usize::from(output(&bench) == BridgeOutput::Brake);
    }
    braking
}

#[test]
fn an_output_with_the_over_voltage_action_clamps_the_link_so_that_protection_need_not_brake() {
    let (free, clamped) = (looks_at_which_protection_brakes(0), looks_at_which_protection_brakes(7));
    assert!(free > 30 && clamped * 5 < free, "braking at {free} of 300 looks, clamped at {clamped}");
}

#[test]
fn two_machines_of_one_seed_say_the_same_and_another_seed_says_something_else() {
    let talk = |seed: u64| {
        let mut bench = Bench::of(ControllerConfig { seed, ..ControllerConfig::default() });
        bench.ask(commands::SPEED_ACCEL_BOTH, &[10_000, 2_000, -1_500]);
        let mut replies = Vec::new();
        for _ in 0..200 {
            bench.wait(Duration::from_millis(7));
            replies.push(bench.raw(&[0x80, number::READ_CURRENTS]));
            replies.push(bench.raw(&[0x80, number::READ_ENCODERS]));
        }
        replies
    };
    assert_eq!(talk(5), talk(5));
    assert_ne!(talk(5), talk(6));
}

#[test]
fn time_may_be_advanced_in_any_pieces() {
    let run = |pieces: u32| {
        let mut bench = Bench::of(ControllerConfig { seed: 9, ..ControllerConfig::default() });
        bench.ask(commands::SPEED_ACCEL_BOTH, &[10_000, 2_000, -1_500]);
        for _ in 0..pieces {
            bench.wait(Duration::from_millis(900) / pieces);
        }
        let unit = bench.unit().unit().expect("it has power");
        (bench.unit().view().axes, *unit.readings())
    };
    assert_eq!(run(1), run(900));
    assert_eq!(run(1), run(45));
}
