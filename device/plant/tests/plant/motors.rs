//! The plant against what a textbook says: each test compares a simulated axis with an answer worked out by hand.

use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::{
    Axis, AxisParams, CouplingParams, CurrentSensorParams, Datasheet, EncoderKind, EncoderParams,
    FrictionParams, GearParams, LoadParams, MotorParams, ParamsError, ShaftSide, StopKind, TravelParams,
};
use std::f64::consts::TAU;

/// 12 V gives 6 A at stall and, without friction, 400 rad/s; time constant 50 ms, no inductance, no friction, no gear.
fn plain() -> AxisParams {
    AxisParams {
        motor: MotorParams {
            armature_ohms: 2.0,
            armature_henries: 0.0,
            torque_constant_newton_metres_per_amp: 0.03,
            back_emf_volts_per_radian_per_second: 0.03,
            rotor_inertia_kilogram_square_metres: 0.05 * 0.03 * 0.03 / 2.0,
            friction: FrictionParams::default(),
        },
        gear: GearParams::default(),
        load: LoadParams::default(),
        encoder: quadrature(2000.0),
        current_sensor: CurrentSensorParams::default(),
    }
}

fn quadrature(counts_per_turn: f64) -> EncoderParams {
    EncoderParams {
        kind: EncoderKind::Quadrature,
        counts_per_turn,
        side: ShaftSide::Motor,
        start_counts: 0.0,
        wraps: false,
        noise_counts: 0.0,
    }
}

fn axis(params: &AxisParams) -> Axis {
    Axis::new(params, 0).expect("the test's parameters are valid")
}

fn speed(axis: &Axis) -> f64 {
    axis.state().motor_radians_per_second
}

fn assert_near(got: f64, wanted: f64, tolerance: f64, what: &str) {
    assert!((got - wanted).abs() <= tolerance, "{what}: got {got}, wanted {wanted} +- {tolerance}");
}

#[test]
fn a_voltage_step_follows_the_first_order_curve_at_every_instant() {
    let mut motor = axis(&plain());
    for tick in 1..=300 {
        motor.advance(BridgeOutput::Duty(0.5), 12.0, 1e-3);
        let t = f64::from(tick) * 1e-3;
        assert_near(speed(&motor), 200.0 * (1.0 - (-t / 0.05).exp()), 0.02, "speed");
        // The angle is the integral of that.
        let angle = 200.0 * (t - 0.05 * (1.0 - (-t / 0.05).exp()));
        assert_near(motor.state().motor_radians, angle, 0.002, "angle");
    }
}

#[test]
fn with_inductance_the_step_follows_the_second_order_curve() {
    let mut params = plain();
    params.motor.armature_henries = 0.004;
    // Poles of L J s^2 + R J s + K^2: electrical 2 ms, mechanical 50 ms.
    let (te, tm) = (0.002_f64, 0.05_f64);
    let root = (1.0 - 4.0 * te / tm).sqrt();
    let (p, q) = ((1.0 + root) / (2.0 * te), (1.0 - root) / (2.0 * te));
    let mut motor = axis(&params);
    for tick in 1..=300 {
        motor.advance(BridgeOutput::Duty(1.0), 12.0, 1e-3);
        let t = f64::from(tick) * 1e-3;
        let curve = 1.0 - (p * (-q * t).exp() - q * (-p * t).exp()) / (p - q);
        assert_near(speed(&motor), 400.0 * curve, 1e-6, "speed");
    }
}

#[test]
fn no_inductance_inertia_or_step_makes_the_axis_unstable() {
    for henries in [0.0, 1e-9, 1e-6, 1e-3, 0.1, 10.0] {
        for inertia in [1e-12, 1e-8, 1e-4, 1.0] {
            for step in [1e-6, 1e-3, 0.1] {
                let mut params = plain();
                params.motor.armature_henries = henries;
                params.motor.rotor_inertia_kilogram_square_metres = inertia;
                let mut motor = axis(&params);
                for _ in 0..200 {
                    motor.advance(BridgeOutput::Duty(1.0), 12.0, step);
                    let state = motor.state();
                    assert!(state.amps.is_finite() && state.motor_radians_per_second.is_finite());
                    // Above 400 rad/s only as far as a winding without damping can swing it.
                    assert!(state.motor_radians_per_second.abs() < 801.0, "{henries} {inertia} {step}");
                }
            }
        }
    }
}

#[test]
fn the_steady_speed_is_where_the_torques_balance() {
    let mut params = plain();
    params.motor.friction = FrictionParams {
        viscous_newton_metre_seconds_per_radian: 2e-5,
        coulomb_newton_metres: 0.01,
        stiction_newton_metres: 0.015,
    };
    params.gear.ratio = 10.0;
    params.load.torque_newton_metres = 0.1;
    params.load.inertia_kilogram_square_metres = 1e-4;
    for duty in [1.0, 0.6, -0.6, -1.0] {
        let mut motor = axis(&params);
        motor.advance(BridgeOutput::Duty(duty), 12.0, 3.0);
        let volts = 12.0 * duty;
        // K (V - K w) / R = coulomb sign + viscous w + load / ratio.
        let torque = 0.03 * volts / 2.0 - 0.01 * duty.signum() - 0.1 / 10.0;
        let wanted = torque / (2e-5 + 0.03 * 0.03 / 2.0);
        assert_near(speed(&motor), wanted, 1e-6, "speed");
        assert_near(params.steady_speed_radians_per_second(volts), wanted, 1e-9, "predicted speed");
        assert_near(motor.state().amps, (volts - 0.03 * wanted) / 2.0, 1e-6, "current");
    }
}

#[test]
fn a_locked_shaft_draws_the_stall_current_and_does_not_move() {
    let mut params = plain();
    params.motor.armature_henries = 0.004;
    let mut motor = axis(&params);
    motor.lock_shaft(true);
    motor.advance(BridgeOutput::Duty(0.5), 12.0, 0.002);
    assert_near(motor.state().amps, 3.0 * (1.0 - (-1.0_f64).exp()), 0.01, "current after one time constant");
    motor.advance(BridgeOutput::Duty(0.5), 12.0, 0.1);
    assert_near(motor.state().amps, 3.0, 1e-9, "stall current");
    assert_eq!(motor.state().motor_radians, 0.0);
    assert_eq!(speed(&motor), 0.0);
}

#[test]
fn a_shaft_sticks_until_the_breakaway_torque_and_then_slides() {
    let mut params = plain();
    params.motor.friction.coulomb_newton_metres = 0.018;
    params.motor.friction.stiction_newton_metres = 0.027;
    // Breakaway at 0.9 A = 1.8 V, sliding at 0.6 A = 1.2 V.
    let mut motor = axis(&params);
    motor.advance(BridgeOutput::Duty(1.79 / 12.0), 12.0, 1.0);
    assert_eq!(
        (speed(&motor), motor.state().motor_radians),
        (0.0, 0.0),
        "below breakaway nothing moves at all"
    );
    motor.advance(BridgeOutput::Duty(1.81 / 12.0), 12.0, 1.0);
    assert_near(speed(&motor), (1.81 - 1.2) / 0.03, 1e-6, "slides against Coulomb friction");
    motor.advance(BridgeOutput::Duty(1.3 / 12.0), 12.0, 1.0);
    assert_near(speed(&motor), 0.1 / 0.03, 1e-6, "keeps sliding below breakaway");
    motor.advance(BridgeOutput::Duty(1.15 / 12.0), 12.0, 1.0);
    let rest = motor.state().motor_radians;
    assert_eq!(speed(&motor), 0.0, "stops below Coulomb friction");
    for _ in 0..1000 {
        motor.advance(BridgeOutput::Duty(1.79 / 12.0), 12.0, 1e-3);
        assert_eq!(speed(&motor), 0.0, "and holds without chatter");
    }
    assert_eq!(motor.state().motor_radians, rest);
}

#[test]
fn coasting_slows_by_friction_alone_and_braking_through_the_winding() {
    let mut params = plain();
    params.motor.armature_henries = 0.002;
    params.motor.friction.coulomb_newton_metres = 0.001;
    params.motor.friction.stiction_newton_metres = 0.001;
    let inertia = params.motor.rotor_inertia_kilogram_square_metres;
    let mut coasting = axis(&params);
    coasting.advance(BridgeOutput::Duty(1.0), 12.0, 1.0);
    let mut braking = coasting.clone();
    let mut duty_zero = coasting.clone();
    let top = speed(&coasting);
    coasting.advance(BridgeOutput::Coast, 12.0, 0.01);
    assert_eq!(coasting.state().amps, 0.0);
    let later = speed(&coasting);
    coasting.advance(BridgeOutput::Coast, 12.0, 0.1);
    assert_near(speed(&coasting), later - 0.1 * 0.001 / inertia, 1e-6, "coasts against Coulomb friction");
    coasting.advance(BridgeOutput::Coast, 12.0, top * inertia / 0.001);
    assert_eq!(speed(&coasting), 0.0);
    braking.advance(BridgeOutput::Brake, 12.0, 0.05);
    duty_zero.advance(BridgeOutput::Duty(0.0), 12.0, 0.05);
    assert_eq!(speed(&braking), speed(&duty_zero));
    assert!(speed(&braking) < top * 0.4, "a shorted winding brakes within its time constant");
    assert!(braking.state().amps < -1.0);
}

#[test]
fn a_coasting_motor_turned_beyond_the_link_voltage_charges_it_through_the_diodes() {
    let mut motor = axis(&plain());
    motor.set_load_torque(-0.05);
    motor.advance(BridgeOutput::Coast, 12.0, 2.0);
    // The diodes hold the back EMF at 13.6 V plus what the driving torque's current needs.
    let amps = 0.05 / 0.03;
    assert_near(speed(&motor), (13.6 + 2.0 * amps) / 0.03, 1.0, "speed");
    assert_near(motor.state().amps, -amps, 0.02, "current");
    let power = motor.advance(BridgeOutput::Coast, 12.0, 0.1);
    assert_near(power.bus_amps, -amps, 0.02, "link current");
}

#[test]
fn energy_drawn_from_the_link_is_motion_plus_heat_and_flows_back_when_the_duty_drops() {
    let mut params = plain();
    params.motor.armature_henries = 0.001;
    let inertia = params.motor.rotor_inertia_kilogram_square_metres;
    let mut motor = axis(&params);
    let step = 1.0 / 3000.0;
    let run = |motor: &mut Axis, duty: f64, seconds: f64| {
        let (mut drawn, mut heat) = (0.0, 0.0);
        for _ in 0..(seconds / step) as usize {
            let before = motor.state().amps;
            drawn += motor.advance(BridgeOutput::Duty(duty), 12.0, step).bus_amps * 12.0 * step;
            let mean = (before + motor.state().amps) / 2.0;
            heat += 2.0 * mean * mean * step;
        }
        (drawn, heat)
    };
    let (drawn, heat) = run(&mut motor, 1.0, 1.0);
    let motion = inertia * speed(&motor).powi(2) / 2.0;
    assert_near(drawn, motion + heat, drawn * 0.01, "energy while speeding up");
    let (drawn, heat) = run(&mut motor, 0.5, 1.0);
    let slower = inertia * speed(&motor).powi(2) / 2.0;
    assert!(drawn < 0.0, "a falling duty gives energy back: {drawn}");
    assert_near(motion - slower, heat - drawn, motion * 0.01, "energy while slowing down");
}

fn two_mass(damping: f64) -> AxisParams {
    let mut params = plain();
    params.gear.ratio = 5.0;
    params.load.inertia_kilogram_square_metres = 1e-3;
    params.load.coupling = Some(CouplingParams {
        stiffness_newton_metres_per_radian: 90.0,
        damping_newton_metre_seconds_per_radian: damping,
    });
    params
}

/// Frequency of the load's swing about its mean speed, from the times it crosses it upwards.
fn swing_hertz(axis: &mut Axis, mean: impl Fn(&Axis) -> f64) -> f64 {
    let step = 1.0 / 3000.0;
    let (mut crossings, mut before) = (Vec::new(), 0.0);
    for n in 0..3000 {
        axis.advance(BridgeOutput::Coast, 12.0, step);
        let now = axis.state().load_radians_per_second - mean(axis);
        if before < 0.0 && now >= 0.0 {
            crossings.push((f64::from(n) - now / (now - before)) * step);
        }
        before = now;
    }
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    (crossings.len() - 1) as f64 / (last - first)
}

#[test]
fn two_masses_swing_at_the_frequencies_of_spring_and_inertias() {
    let params = two_mass(0.0);
    let motor_side = params.motor.rotor_inertia_kilogram_square_metres * 25.0;
    let mut locked = axis(&params);
    locked.lock_shaft(true);
    locked.set_load_torque(1.0);
    let wanted = (90.0 / 1e-3_f64).sqrt() / TAU;
    assert_near(swing_hertz(&mut locked, |_| 0.0), wanted, wanted * 1e-3, "motor locked");

    let mut free = axis(&params);
    free.open_lead(true);
    free.set_load_torque(-0.3);
    free.advance(BridgeOutput::Coast, 12.0, 1e-3);
    free.set_load_torque(0.0);
    let wanted = (90.0 * (1.0 / 1e-3 + 1.0 / motor_side)).sqrt() / TAU;
    let mean = move |axis: &Axis| {
        let state = axis.state();
        (motor_side * state.motor_radians_per_second / 5.0 + 1e-3 * state.load_radians_per_second)
            / (motor_side + 1e-3)
    };
    assert_near(swing_hertz(&mut free, mean), wanted, wanted * 1e-3, "both free");
}

#[test]
fn a_stiff_coupling_behaves_like_none() {
    let mut stiff = two_mass(0.5);
    stiff.load.coupling = Some(CouplingParams::with_resonance(&stiff, 5000.0, 0.5));
    let mut rigid = stiff.clone();
    rigid.load.coupling = None;
    let (mut stiff, mut rigid) = (axis(&stiff), axis(&rigid));
    for _ in 0..300 {
        stiff.advance(BridgeOutput::Duty(1.0), 12.0, 1e-3);
        rigid.advance(BridgeOutput::Duty(1.0), 12.0, 1e-3);
        assert_near(speed(&stiff), speed(&rigid), 0.5, "speed");
    }
}

#[test]
fn the_load_moves_freely_by_the_backlash_and_no_further() {
    let mut params = two_mass(0.4);
    params.gear.backlash_radians = 0.02;
    params.load.friction.viscous_newton_metre_seconds_per_radian = 1e-4;
    let mut geared = axis(&params);
    geared.lock_shaft(true);
    geared.set_load_torque(0.009);
    geared.advance(BridgeOutput::Brake, 12.0, 2.0);
    let low = geared.state().load_radians;
    geared.set_load_torque(-0.009);
    geared.advance(BridgeOutput::Brake, 12.0, 2.0);
    let high = geared.state().load_radians;
    // On top of the gap the spring gives 0.009 / 90 either way.
    assert_near(high - low, 0.02 + 2.0 * 1e-4, 1e-6, "play");
    geared.set_load_torque(0.0);
    geared.advance(BridgeOutput::Brake, 12.0, 2.0);
    let drift = geared.state().load_radians_per_second;
    assert_near(drift, 0.0, 0.05, "nothing drives it inside the gap");
}

#[test]
fn teeth_that_meet_neither_win_nor_lose_much_energy() {
    let mut params = two_mass(0.0);
    params.gear.backlash_radians = 0.02;
    let mut geared = axis(&params);
    geared.lock_shaft(true);
    // Throw the load across the gap and let it bounce between the teeth for five seconds.
    geared.set_load_torque(-2.0);
    geared.advance(BridgeOutput::Brake, 12.0, 2e-3);
    geared.set_load_torque(0.0);
    let fastest = |axis: &mut Axis| {
        (0..300).fold(0.0_f64, |most, _| {
            axis.advance(BridgeOutput::Brake, 12.0, 1.0 / 3000.0);
            most.max(axis.state().load_radians_per_second.abs())
        })
    };
    let first = fastest(&mut geared);
    geared.advance(BridgeOutput::Brake, 12.0, 5.0);
    let last = fastest(&mut geared);
    assert!(first > 1.0, "the load was thrown: {first}");
    assert!((last / first - 1.0).abs() < 0.2, "bounced from {first} to {last} rad/s");
}

#[test]
fn a_motor_takes_up_the_backlash_before_the_load_moves() {
    let mut params = two_mass(0.4);
    params.gear.backlash_radians = 0.1;
    params.motor.friction.coulomb_newton_metres = 0.001;
    params.load.friction.coulomb_newton_metres = 0.05;
    let mut geared = axis(&params);
    while geared.state().load_radians == 0.0 {
        geared.advance(BridgeOutput::Duty(0.1), 12.0, 1.0 / 3000.0);
        assert!(geared.state().motor_radians < 1.0, "the load never moved");
    }
    // Half the play lay on this side: 0.05 rad of the output, five times that at the motor, and a little of the spring.
    let motor = geared.state().motor_radians;
    assert!(motor > 0.25 && motor < 0.27, "moved at {motor} rad");
}

#[test]
fn hard_stops_hold_the_travel_exactly_and_let_the_motor_stall() {
    for coupling in [false, true] {
        let mut params = if coupling { two_mass(0.4) } else { plain() };
        params.load.travel =
            Some(TravelParams { lower_radians: -1.5, upper_radians: 2.0, stop: StopKind::Hard });
        let mut slide = axis(&params);
        slide.advance(BridgeOutput::Duty(0.5), 12.0, 2.0);
        assert_near(slide.state().load_radians, 2.0, 1e-9, "upper stop");
        assert_near(slide.state().amps, 3.0, 1e-6, "stalled");
        assert_eq!(slide.state().load_radians_per_second, 0.0);
        slide.advance(BridgeOutput::Duty(-0.5), 12.0, 0.02);
        assert!(slide.state().load_radians < 1.999, "leaves the stop at once");
        slide.advance(BridgeOutput::Duty(-0.5), 12.0, 2.0);
        assert_near(slide.state().load_radians, -1.5, 1e-9, "lower stop");
    }
}

#[test]
fn springy_stops_give_by_torque_over_stiffness_at_any_stiffness() {
    for coupling in [false, true] {
        for stiffness in [10.0, 1e3, 1e6, 1e9] {
            let mut params = if coupling { two_mass(0.4) } else { plain() };
            let ratio = params.gear.ratio;
            let stop = StopKind::Spring {
                stiffness_newton_metres_per_radian: stiffness,
                damping_newton_metre_seconds_per_radian: 0.01,
            };
            params.load.travel = Some(TravelParams { lower_radians: -1.5, upper_radians: 2.0, stop });
            let mut slide = axis(&params);
            slide.advance(BridgeOutput::Duty(0.5), 12.0, 5.0);
            let give = 3.0 * 0.03 * ratio / stiffness;
            assert_near(slide.state().load_radians, 2.0 + give, 1e-6 + give * 1e-3, "given way");
            assert_near(slide.state().amps, 3.0, 0.01, "stalled");
        }
    }
}

#[test]
fn encoders_count_every_edge_on_their_own_shaft() {
    for (side, turns) in [(ShaftSide::Motor, 1.0), (ShaftSide::Load, 0.1)] {
        let mut params = plain();
        params.gear.ratio = 10.0;
        params.encoder.side = side;
        let mut motor = axis(&params);
        motor.advance(BridgeOutput::Duty(-0.5), 12.0, 1.0);
        let wanted = motor.state().motor_radians / TAU * 2000.0 * turns;
        assert_near(motor.encoder().counts as f64, wanted, 0.5, "counts");
    }
}

#[test]
fn a_reversed_encoder_counts_back_from_where_it_is_and_a_lost_one_stands_still() {
    let mut motor = axis(&plain());
    motor.advance(BridgeOutput::Duty(0.5), 12.0, 1.0);
    let here = motor.encoder().counts;
    motor.reverse_encoder(true);
    assert_eq!(motor.encoder().counts, here);
    motor.advance(BridgeOutput::Duty(0.5), 12.0, 0.1);
    let back = motor.encoder().counts;
    assert_near((here - back) as f64, 0.1 * 200.0 / TAU * 2000.0, 2.0, "counts back");
    motor.lose_encoder(true);
    motor.advance(BridgeOutput::Duty(0.5), 12.0, 0.1);
    assert_eq!(motor.encoder().counts, back);
    motor.lose_encoder(false);
    assert_eq!(motor.encoder().counts, back, "what passed meanwhile is not made up for");
}

#[test]
fn reversed_leads_turn_the_motor_the_other_way_with_the_same_bridge_current() {
    let (mut straight, mut reversed) = (axis(&plain()), axis(&plain()));
    reversed.reverse_leads(true);
    for motor in [&mut straight, &mut reversed] {
        motor.advance(BridgeOutput::Duty(0.5), 12.0, 0.02);
    }
    assert_eq!(speed(&straight), -speed(&reversed));
    assert_eq!(straight.state().amps, reversed.state().amps);
    assert_eq!(straight.measured_amps(), reversed.measured_amps());
}

#[test]
fn absolute_encoders_read_0_to_4095_and_wrap_only_where_they_can() {
    let absolute = |kind, wraps| {
        let mut params = plain();
        params.encoder = EncoderParams {
            kind,
            counts_per_turn: 4096.0,
            side: ShaftSide::Motor,
            start_counts: 1000.0,
            wraps,
            noise_counts: 0.0,
        };
        axis(&params)
    };
    let mut pot = absolute(EncoderKind::Analog, false);
    assert_eq!(pot.encoder().counts, 1000);
    assert_near(pot.encoder().volts(), 1000.0 / 4095.0 * 5.1, 1e-12, "pin voltage");
    pot.advance(BridgeOutput::Duty(0.5), 12.0, 1.0);
    assert_eq!(pot.encoder().counts, 4095);
    pot.advance(BridgeOutput::Duty(-0.5), 12.0, 3.0);
    assert_eq!(pot.encoder().counts, 0);
    let mut turning = absolute(EncoderKind::Pulse, true);
    for _ in 0..100 {
        turning.advance(BridgeOutput::Duty(0.3), 12.0, 0.01);
        let turns = turning.state().motor_radians / TAU;
        let wanted = (1000.0 + turns * 4096.0).rem_euclid(4096.0).floor() as i64;
        assert_eq!(turning.encoder().counts, wanted);
    }
    turning.lose_encoder(true);
    assert!(!turning.encoder().present);
    pot.lose_encoder(true);
    assert_eq!(pot.encoder().counts, 0);
}

#[test]
fn an_open_lead_leaves_the_motor_without_current() {
    let mut motor = axis(&plain());
    motor.advance(BridgeOutput::Duty(1.0), 12.0, 1.0);
    motor.open_lead(true);
    let power = motor.advance(BridgeOutput::Duty(1.0), 12.0, 0.1);
    assert_eq!((power.bus_amps, motor.state().amps), (0.0, 0.0));
    assert_near(speed(&motor), 400.0, 1e-3, "nothing slows it");
}

fn record(seed: u64) -> Vec<(i64, u64)> {
    let mut params = plain();
    params.current_sensor.noise_amps = 0.05;
    let mut motor = Axis::new(&params, seed).expect("the test's parameters are valid");
    motor.set_encoder_noise(3.0);
    (0..200)
        .map(|n| {
            motor.advance(BridgeOutput::Duty(f64::from(n % 7) / 7.0), 12.0, 1.0 / 300.0);
            (motor.encoder().counts, motor.measured_amps().to_bits())
        })
        .collect()
}

#[test]
fn the_same_seed_gives_the_same_readings_and_seed_zero_no_noise() {
    assert_eq!(record(5), record(5));
    assert_ne!(record(5), record(6));
    let (noisy, quiet) = (record(5), record(0));
    let jitter: Vec<i64> = noisy.iter().zip(&quiet).map(|(a, b)| a.0 - b.0).collect();
    assert!(jitter.iter().any(|counts| *counts != 0));
    assert!(jitter.iter().all(|counts| counts.abs() <= 11), "3.5 deviations at most: {jitter:?}");
}

#[test]
fn the_measured_current_is_the_mean_since_the_last_reading() {
    let mut params = plain();
    params.current_sensor.offset_amps = 0.1;
    let mut motor = axis(&params);
    motor.lock_shaft(true);
    motor.advance(BridgeOutput::Duty(0.5), 12.0, 0.01);
    motor.advance(BridgeOutput::Duty(-0.25), 12.0, 0.01);
    assert_near(motor.measured_amps(), (3.0 - 1.5) / 2.0 + 0.1, 1e-3, "mean");
    let again = motor.measured_amps();
    assert_eq!(again, motor.measured_amps());
    motor.advance(BridgeOutput::Duty(-0.25), 12.0, 0.01);
    assert_near(motor.measured_amps(), -1.4, 1e-3, "only the last stretch");
}

/// The corners of the plants that a tuner has to cope with: (QPPS, time constant s, counts per turn).
const TUNING_CORNERS: [(f64, f64, f64); 16] = [
    (8e3, 0.03, 64.0),
    (13e3, 0.09, 64.0),
    (2e3, 0.06, 1632.0),
    (9e3, 0.25, 1632.0),
    (20e3, 0.12, 4096.0),
    (80e3, 0.6, 4096.0),
    (100e3, 0.006, 2000.0),
    (300e3, 0.02, 2000.0),
    (400.0, 0.015, 48.0),
    (1500.0, 0.05, 48.0),
    (10e3, 0.7, 2048.0),
    (60e3, 2.5, 2048.0),
    (1500.0, 0.04, 4096.0),
    (5e3, 0.15, 4096.0),
    (10e3, 0.03, 8192.0),
    (50e3, 0.12, 8192.0),
];

#[test]
fn a_data_sheet_becomes_an_axis_that_reaches_its_figures() {
    for (qpps, time_constant, counts) in TUNING_CORNERS {
        for (coulomb_share, stiction_ratio, viscous_share, electrical) in
            [(0.015, 1.0, 0.005, 0.0002), (0.12, 1.6, 0.06, 0.003)]
        {
            let sheet = Datasheet {
                volts: 12.0,
                no_load_radians_per_second: qpps / counts * TAU,
                stall_amps: 5.0,
                mechanical_time_constant_s: time_constant,
                electrical_time_constant_s: electrical,
                coulomb_share,
                stiction_ratio,
                viscous_share,
                load_share: 0.5,
            };
            let params = sheet.axis(GearParams::default(), quadrature(counts));
            assert_near(params.mechanical_time_constant_s(), time_constant, 1e-9, "time constant");
            assert_near(params.stall_amps(12.0), 5.0, 1e-9, "stall current");
            let mut motor = axis(&params);
            motor.advance(BridgeOutput::Duty(1.0), 12.0, 15.0 * (time_constant + electrical));
            let before = motor.encoder().counts;
            motor.advance(BridgeOutput::Duty(1.0), 12.0, 1.0);
            let measured = (motor.encoder().counts - before) as f64;
            assert_near(measured, qpps, 1.0 + qpps * 1e-4, "QPPS");
            assert_near(params.steady_counts_per_second(12.0), qpps, qpps * 1e-9, "predicted QPPS");
        }
    }
}

#[test]
fn parameters_that_make_no_sense_are_refused_by_name() {
    let refused = |change: fn(&mut AxisParams)| {
        let mut params = plain();
        change(&mut params);
        Axis::new(&params, 0).map(|_| ()).expect_err("the change makes no sense")
    };
    let error = refused(|params| params.motor.armature_ohms = 0.0);
    assert_eq!(error.to_string(), "motor.armature_ohms is 0: it must be above 0");
    let error = refused(|params| params.encoder.counts_per_turn = f64::NAN);
    assert_eq!(error.to_string(), "encoder.counts_per_turn is NaN: it must be above 0");
    assert_eq!(refused(|params| params.gear.backlash_radians = 0.1), ParamsError::NoLoadInertia);
    let error = refused(|params| {
        params.load.travel =
            Some(TravelParams { lower_radians: 1.0, upper_radians: 2.0, stop: StopKind::Hard });
    });
    assert_eq!(error.to_string(), "load.travel.lower_radians is 1: it must be at most 0");
}
