//! The world around a controller: supply, heat, pins and faults acting together.

use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::world::{
    CanPeer, PinSignal, PinState, SwitchKind, SwitchWiring, Wiring, World, WorldAction, WorldParams,
};
use brushwork_plant::{
    AxisParams, BoardParams, BrakeResistorParams, ClampDrive, CurrentSensorParams, EncoderKind,
    EncoderParams, FrictionParams, GearParams, LoadParams, MotorParams, ShaftSide, SupplyParams,
};
use brushwork_values::Motor;
use std::time::Duration;

/// 24 V gives 30 A at stall and 800 rad/s; the flywheel holds 128 J at that speed.
fn heavy() -> AxisParams {
    AxisParams {
        motor: MotorParams {
            armature_ohms: 0.8,
            armature_henries: 0.0004,
            torque_constant_newton_metres_per_amp: 0.03,
            back_emf_volts_per_radian_per_second: 0.03,
            rotor_inertia_kilogram_square_metres: 4e-4,
            friction: FrictionParams::default(),
        },
        gear: GearParams::default(),
        load: LoadParams::default(),
        encoder: EncoderParams {
            kind: EncoderKind::Quadrature,
            counts_per_turn: 1000.0,
            side: ShaftSide::Motor,
            start_counts: 0.0,
            wraps: false,
            noise_counts: 0.0,
        },
        current_sensor: CurrentSensorParams::default(),
    }
}

fn params() -> WorldParams {
    WorldParams {
        axes: [heavy(), heavy()],
        supply: SupplyParams::default(),
        board: BoardParams::default(),
        wiring: Wiring::default(),
        i2c: Vec::new(),
        can_peer: CanPeer::default(),
        pins: 4,
    }
}

fn world(params: &WorldParams) -> World {
    World::new(params, 0).expect("the test's parameters are valid")
}

fn duties(first: f64, second: f64) -> [BridgeOutput; 2] {
    [BridgeOutput::Duty(first), BridgeOutput::Duty(second)]
}

fn run(world: &mut World, outputs: [BridgeOutput; 2], seconds: f64) {
    for _ in 0..(seconds * 300.0).round() as usize {
        world.advance(outputs, 1.0 / 300.0);
    }
}

#[test]
fn a_stalled_motor_pulls_the_battery_down_by_the_divider_of_both_resistances() {
    let mut params = params();
    params.supply.internal_ohms = 0.2;
    params.supply.bleed_ohms = 1e9;
    let mut world = world(&params);
    world.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    run(&mut world, duties(1.0, 0.0), 1.0);
    let amps = 24.0 / (0.8 + 0.2);
    assert!((world.truth(Motor::M1).amps - amps).abs() < 1e-3, "{}", world.truth(Motor::M1).amps);
    assert!((world.bus_volts() - 0.8 * amps).abs() < 1e-3, "{}", world.bus_volts());
    assert!((world.view(Duration::ZERO).battery_amps - amps).abs() < 1e-3);
}

#[test]
fn no_battery_resistance_or_capacitance_makes_the_link_unstable() {
    for internal_ohms in [0.0, 0.01, 1.0, 100.0] {
        for capacitance_farads in [0.0, 1e-4, 1e-2] {
            let mut params = params();
            params.supply.internal_ohms = internal_ohms;
            params.supply.capacitance_farads = capacitance_farads;
            params.axes[0].motor.armature_henries = 0.0;
            let mut world = world(&params);
            world.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
            run(&mut world, duties(0.8, 0.3), 0.5);
            let before = world.bus_volts();
            run(&mut world, duties(0.8, 0.3), 0.01);
            assert!((world.bus_volts() - before).abs() < 0.2, "{internal_ohms} {capacitance_farads}");
            assert!(world.bus_volts() <= 24.001 && world.bus_volts() >= 0.0);
        }
    }
}

/// Highest link voltage while a running motor is brought down by a falling duty.
fn highest_volts(world: &mut World) -> f64 {
    run(world, duties(0.9, 0.0), 8.0);
    (0..100).fold(0.0_f64, |highest, step| {
        run(world, duties(0.9 - 0.009 * f64::from(step), 0.0), 0.02);
        highest.max(world.bus_volts())
    })
}

#[test]
fn braking_into_a_battery_lifts_the_link_a_little_and_into_a_power_supply_a_lot() {
    let mut world_with_battery = world(&params());
    let battery = highest_volts(&mut world_with_battery);
    assert!(battery < 25.5, "{battery}");
    assert!(world_with_battery.view(Duration::ZERO).regenerated_joules > 5.0);
    let mut world_with_supply = world(&params());
    world_with_supply.apply(&WorldAction::SetBatterySinks { can_sink: false });
    let supply = highest_volts(&mut world_with_supply);
    assert!(supply > 40.0, "{supply}");
}

#[test]
fn a_brake_resistor_on_a_digital_output_clamps_the_link() {
    let mut params = params();
    params.supply.can_sink = false;
    params.supply.brake_resistor = Some(BrakeResistorParams { ohms: 1.0, dout: 1 });
    let mut clamped = world(&params);
    assert_eq!(clamped.brake_resistor_dout(), Some(1));
    clamped.set_clamp(ClampDrive::Above { on_volts: 30.0, off_volts: 29.0 });
    let highest = highest_volts(&mut clamped);
    assert!(highest < 32.0, "{highest}");
    let mut left_off = world(&params);
    assert!(highest_volts(&mut left_off) > 40.0, "without its output the resistor does nothing");
}

#[test]
fn losing_power_opens_both_bridges_and_the_motors_run_out() {
    let mut world = world(&params());
    run(&mut world, duties(1.0, -1.0), 1.0);
    world.apply(&WorldAction::Power { on: false });
    assert!(!world.powered());
    run(&mut world, duties(1.0, -1.0), 0.1);
    let view = world.view(Duration::ZERO);
    for axis in view.axes {
        assert_eq!(axis.output, BridgeOutput::Coast);
        assert_eq!(axis.truth.amps, 0.0);
        assert!(axis.truth.motor_radians_per_second.abs() > 300.0);
    }
}

#[test]
fn a_disconnected_battery_drains_into_the_motor() {
    let mut world = world(&params());
    world.apply(&WorldAction::ConnectBattery { connected: false });
    run(&mut world, duties(0.5, 0.0), 0.5);
    assert!(world.bus_volts() < 3.0, "{}", world.bus_volts());
    world.apply(&WorldAction::ConnectBattery { connected: true });
    run(&mut world, duties(0.5, 0.0), 0.1);
    assert!(world.bus_volts() > 22.0);
}

#[test]
fn swapped_encoders_show_each_motor_the_other_ones_counts() {
    let mut world = world(&params());
    run(&mut world, duties(0.5, 0.0), 0.5);
    let first = world.encoder(Motor::M1).counts;
    assert!(first > 1000);
    world.apply(&WorldAction::SwapEncoders { on: true });
    assert_eq!(world.encoder(Motor::M1).counts, 0);
    assert_eq!(world.encoder(Motor::M2).counts, first);
}

#[test]
fn a_switch_closes_its_pin_to_ground_by_position_or_by_hand() {
    let mut params = params();
    params.wiring = Wiring {
        estop_pin: Some(3),
        switches: vec![SwitchWiring {
            motor: Motor::M1,
            switch: SwitchKind::Forward,
            pin: 2,
            trips_at_radians: Some(10.0),
        }],
    };
    let mut world = world(&params);
    assert_eq!(world.pin(2), PinState::Volts(5.0));
    run(&mut world, duties(0.5, 0.0), 0.5);
    assert!(world.truth(Motor::M1).load_radians > 10.0);
    assert_eq!(world.pin(2), PinState::Volts(0.0));
    assert!(world.switch_closed(Motor::M1, SwitchKind::Forward));
    run(&mut world, duties(-0.5, 0.0), 2.0);
    assert_eq!(world.pin(2), PinState::Volts(5.0));
    let held = |closed| WorldAction::HoldSwitch { motor: Motor::M1, switch: SwitchKind::Forward, closed };
    world.apply(&held(true));
    assert_eq!(world.pin(2), PinState::Volts(0.0));
    world.apply(&held(false));
    assert_eq!(world.pin(2), PinState::Volts(5.0));
    assert_eq!(world.pin(3), PinState::Volts(5.0));
    world.apply(&WorldAction::EStop { pressed: true });
    assert!(world.estop_pressed());
    assert_eq!(world.pin(3), PinState::Volts(0.0));
}

#[test]
fn pins_carry_voltages_pulses_and_encoders_and_a_pin_that_is_not_there_is_open() {
    let mut world = world(&params());
    assert_eq!(world.pin(0), PinState::Open);
    world.apply(&WorldAction::SetPin { pin: 0, signal: PinSignal::Volts { volts: 2.5 } });
    assert_eq!(world.pin(0), PinState::Volts(2.5));
    world.apply(&WorldAction::SetPin { pin: 1, signal: PinSignal::Pulse { microseconds: 1500.0 } });
    assert_eq!(world.pin(1), PinState::Pulse { microseconds: 1500.0 });
    world.apply(&WorldAction::SetPin { pin: 2, signal: PinSignal::Encoder { motor: Motor::M2 } });
    run(&mut world, duties(0.0, -0.5), 0.2);
    let counts = world.encoder(Motor::M2).counts;
    assert_eq!(world.pin(2), PinState::Counts(counts));
    world.apply(&WorldAction::SetPin { pin: 99, signal: PinSignal::Volts { volts: 2.5 } });
    assert_eq!(world.pin(99), PinState::Open);
}

#[test]
fn losses_heat_the_board_and_a_heat_gun_holds_it() {
    let mut world = world(&params());
    world.apply(&WorldAction::LockShaft { motor: Motor::M2, on: true });
    run(&mut world, duties(0.0, 1.0), 20.0);
    let [cool, warm] = world.board_celsius();
    assert!(warm > cool + 5.0, "{cool} {warm}");
    world.apply(&WorldAction::SetBoardCelsius { celsius: Some(101.0) });
    assert_eq!(world.board_celsius(), [101.0; 2]);
}

#[test]
fn the_bridge_may_be_asked_between_ticks() {
    let mut world = world(&params());
    world.apply(&WorldAction::LockShaft { motor: Motor::M1, on: true });
    // A limiter that opens the bridge above 10 A, as fast as the plant goes.
    let mut highest: f64 = 0.0;
    for _ in 0..300 {
        world.advance_with(1.0 / 300.0, |motor, sense| {
            if motor == Motor::M2 {
                return BridgeOutput::Brake;
            }
            highest = highest.max(sense.amps);
            if sense.amps > 10.0 { BridgeOutput::Coast } else { BridgeOutput::Duty(1.0) }
        });
    }
    assert!(highest > 10.0 && highest < 22.0, "{highest}");
    assert!(world.measured_amps(Motor::M1) < 12.0);
}

#[test]
fn two_worlds_of_one_seed_are_the_same_and_looking_changes_nothing() {
    let mut noisy = params();
    noisy.axes[0].current_sensor.noise_amps = 0.1;
    let build = || World::new(&noisy, 3).expect("the test's parameters are valid");
    let (mut watched, mut alone) = (build(), build());
    for world in [&mut watched, &mut alone] {
        world.apply(&WorldAction::SetEncoderNoise { motor: Motor::M1, counts: 4.0 });
    }
    for _ in 0..100 {
        watched.advance(duties(0.3, 0.3), 1.0 / 300.0);
        alone.advance(duties(0.3, 0.3), 1.0 / 300.0);
        let view = watched.view(Duration::ZERO);
        assert_eq!(view, watched.view(Duration::ZERO));
        assert_eq!(watched.encoder(Motor::M1), alone.encoder(Motor::M1));
        assert_eq!(watched.measured_amps(Motor::M1), alone.measured_amps(Motor::M1));
    }
}

#[test]
fn actions_and_parameters_survive_json() {
    let action = WorldAction::HoldSwitch { motor: Motor::M2, switch: SwitchKind::Home, closed: true };
    let text = serde_json::to_string(&action).expect("an action is plain data");
    assert_eq!(text, r#"{"action":"hold_switch","motor":"M2","switch":"home","closed":true}"#);
    assert_eq!(serde_json::from_str::<WorldAction>(&text).expect("it was just written"), action);
    let text = serde_json::to_string(&params()).expect("parameters are plain data");
    assert_eq!(serde_json::from_str::<WorldParams>(&text).expect("it was just written"), params());
}
