//! Moves, the loop and the motor (SuprMotr manual, commands DV to DH), against its formulas.

use brushwork_plant::machine::Machine;
use brushwork_plant::world::WorldAction;
use brushwork_suprmotr_wire::{motion, operation};
use brushwork_values::Motor;

use crate::tests::bench::Bench;

/// What friction alone holds back at factory gain: 4.8 % of the stall torque over 75 of 32,768 a count, and a step of the bridge.
const STUCK_COUNTS: i64 = 23;

fn near(got: i64, wanted: i64, within: i64) {
    assert!((got - wanted).abs() <= within, "{got}, not {wanted} within {within}");
}

/// 5000 counts at 20,000 counts/s and 200,000 counts/s^2: 0.1 s up, 0.15 s at speed, 0.1 s down.
#[test]
fn a_move_follows_a_trapezoid_and_ends_at_its_target() {
    let mut bench = Bench::new();
    bench.begin("MA5000");
    for (at_ms, dynamic) in [(50, 250), (100, 1_000), (175, 2_500), (250, 4_000), (300, 4_750)] {
        let now = u64::try_from(bench.bus.suprmotrs()[0].now().as_millis()).expect("it is early");
        bench.ms(at_ms + 4 - now);
        assert_eq!(bench.unit().position() + bench.unit().following_error(), dynamic, "{at_ms} ms");
    }
    near(bench.unit().following_error(), 0, 120);
    assert_eq!(bench.until_complete(), 50);
    bench.ms(200);
    near(bench.number("TP"), 5_000, STUCK_COUNTS);
    assert_eq!((bench.number("TT"), bench.number("TD")), (5_000, 5_000));
    assert_eq!(bench.number("TE"), 5_000 - bench.number("TP"));
    assert_eq!(bench.number("TF"), bench.number("TE"));
}

#[test]
fn the_simulated_motor_goes_as_far_as_its_encoder_counts() {
    let mut bench = Bench::new();
    bench.tell("MA-7000");
    bench.ms(1_000);
    // 2000 counts a turn.
    let turns = bench.unit().truth().motor_radians / std::f64::consts::TAU;
    near((turns * 2_000.0).round() as i64, bench.number("TP"), 1);
}

/// 500 counts are too few for DV: 2 sqrt(500 / 200,000) = 0.1 s.
#[test]
fn a_short_move_is_a_triangle() {
    let mut bench = Bench::new();
    bench.begin("MR-500");
    assert_eq!(bench.until_complete(), 100);
}

/// 2000 counts at 10,000 counts/s and 100,000 counts/s^2: 0.1 s up, 0.1 s at speed, 0.1 s down; what is said meanwhile holds for the next.
#[test]
fn velocity_and_acceleration_hold_for_the_moves_to_come() {
    let mut bench = Bench::new();
    bench.tell("DV10000,DA100000");
    bench.begin("MA2000");
    bench.ms(150);
    assert_eq!(
        (bench.number("GV"), bench.number("TY"), bench.number("GA"), bench.number("TL")),
        (10_000, 10_000, 100_000, 100_000)
    );
    bench.tell("SV20000,SA200000");
    // Each question took 3 ms.
    assert_eq!(bench.until_complete(), 300 - 150 - 5 * 3);
    bench.begin("MA0");
    assert_eq!(bench.until_complete(), 200, "2000 counts are a triangle now: 2 sqrt(2000 / 200,000)");
}

#[test]
fn the_velocity_is_told_in_counts_per_second() {
    let mut bench = Bench::new();
    bench.begin("MA20000");
    bench.ms(600);
    near(bench.number("TV"), 20_000, 400);
    bench.ms(2_000);
    assert_eq!(bench.number("TV"), 0);
    bench.begin("MA0");
    bench.ms(600);
    near(bench.number("TV"), -20_000, 400);
}

#[test]
fn a_relative_move_is_from_where_the_motor_is() {
    let mut bench = Bench::new();
    bench.tell("MA1000");
    bench.ms(500);
    let position = bench.number("TP");
    bench.begin("MR500");
    assert_eq!(bench.number("TT"), position + 500);
}

/// 0.1 s and 1000 counts from 20,000 counts/s.
#[test]
fn a_stop_is_abrupt_or_takes_the_acceleration() {
    for (line, is_abrupt) in [("AB", true), ("AB0", true), ("AB1", false), ("ST", false)] {
        let mut bench = Bench::new();
        bench.begin("MA50000");
        bench.ms(500);
        let (position, dynamic) =
            (bench.unit().position(), bench.unit().position() + bench.unit().following_error());
        bench.begin(line);
        let target = bench.number("TT");
        if is_abrupt {
            assert_eq!(target, position, "{line}");
            assert!(bench.unit().is_motion_complete(), "{line}");
        } else {
            assert_eq!(target, dynamic + 1_000, "{line}");
            assert_eq!(bench.until_complete(), 97, "{line}: the question took 3 ms");
        }
        bench.ms(300);
        near(bench.number("TP"), target, STUCK_COUNTS);
    }
}

#[test]
fn the_exclamation_mark_stops_at_once_in_the_midst_of_a_line() {
    let mut bench = Bench::new();
    bench.begin("MA50000");
    bench.ms(300);
    let position = bench.unit().position();
    bench.raw(b"MA!");
    assert_eq!(bench.ask("-20,TT"), "0T0:-0000000020\r\n\u{3}", "what was typed is still there");
    bench.raw(b"!");
    near(bench.number("TT"), position, 200);
}

/// MF lets the motor go where it is pushed; MN brings it back with full force, with no trajectory.
#[test]
fn motor_off_counts_on_and_motor_on_jumps_back() {
    let mut bench = Bench::new();
    bench.tell("MA2000");
    bench.ms(500);
    bench.tell("MF");
    assert_eq!(bench.status().motion & motion::MOTOR_OFF, motion::MOTOR_OFF);
    let push = |bench: &mut Bench, newton_metres| {
        bench.bus.apply(0, &WorldAction::SetLoadTorque { motor: Motor::M1, newton_metres });
    };
    push(&mut bench, 0.006);
    bench.ms(50);
    push(&mut bench, 0.0);
    bench.ms(1_000);
    let position = bench.number("TP");
    assert!(position < 1_500, "it was pushed back: {position}");
    assert_eq!((bench.number("TT"), bench.number("TQ")), (2_000, 0));
    assert_eq!(bench.number("TF"), 2_000 - position);
    bench.begin("MN");
    assert!(bench.unit().is_motion_complete(), "no trajectory leads back");
    bench.ms(2);
    assert_eq!(bench.number("TQ"), ((2_000 - bench.unit().position()) * 75 * 255 / 32_768).min(255));
    bench.ms(500);
    near(bench.number("TP"), 2_000, STUCK_COUNTS);
    assert_eq!(bench.status().motion & motion::MOTOR_OFF, 0);
}

#[test]
fn a_move_while_the_motor_is_off_sets_the_target_alone() {
    let mut bench = Bench::new();
    bench.tell("MF,MA3000");
    bench.ms(500);
    assert_eq!((bench.number("TP"), bench.number("TT")), (0, 3_000));
    bench.tell("MF,AB,MN");
    bench.ms(500);
    assert_eq!((bench.number("TP"), bench.number("TT")), (0, 0), "AB makes the position the target");
}

/// A shaft held fast at DV 20,000: the trajectory is 2000 counts ahead after 0.1 + 0.05 s.
#[test]
fn an_error_greater_than_allowed_lets_the_motor_go() {
    let mut bench = Bench::new();
    bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.tell("SM2000");
    bench.begin("MA20000");
    assert_eq!(bench.until(|unit| !unit.is_motor_on()), 151);
    let status = bench.status();
    assert_eq!(
        status.motion & (motion::EXCESSIVE_ERROR | motion::MOVE_ERROR | motion::MOTOR_OFF | motion::COMPLETE),
        motion::EXCESSIVE_ERROR | motion::MOVE_ERROR | motion::MOTOR_OFF | motion::COMPLETE
    );
    bench.tell("AB,MN");
    assert_eq!(bench.status().motion & motion::EXCESSIVE_ERROR, 0);
    assert!(bench.unit().is_motor_on());
}

#[test]
fn motor_on_after_an_excessive_error_trips_again_while_the_target_is_far() {
    let mut bench = Bench::new();
    bench.tell("SM100,MF,MA5000,MN");
    bench.ms(1);
    assert!(!bench.unit().is_motor_on(), "5000 counts are more than 100");
    assert_eq!(bench.number("TP"), 0);
}

#[test]
fn home_is_where_the_motor_is_and_nothing_jumps() {
    let mut bench = Bench::new();
    bench.tell("MA4000");
    bench.ms(500);
    let error = bench.number("TF");
    bench.tell("DH");
    assert_eq!((bench.number("TP"), bench.number("TF")), (0, error));
    bench.begin("GH");
    bench.ms(300);
    near(bench.number("TP"), 0, STUCK_COUNTS);
    bench.tell("MA-4000");
    bench.ms(500);
    // Back where it was switched on.
    near(bench.unit().view().axes[0].encoder_counts, 0, 2 * STUCK_COUNTS);
}

#[test]
fn without_velocity_or_acceleration_a_move_never_begins() {
    for line in ["DV0", "DA0"] {
        let mut bench = Bench::new();
        bench.tell(&format!("{line},MA3000"));
        bench.ms(1_000);
        assert_eq!((bench.number("TP"), bench.status().motion & motion::COMPLETE), (0, 0), "{line}");
        bench.tell("AB");
        assert_eq!(bench.status().motion & motion::COMPLETE, motion::COMPLETE);
    }
}

/// The drive is P x error of 32,768 in 255 steps: 75 x 100 gives 58.
#[test]
fn gains_act_on_a_motor_that_is_held() {
    let mut bench = Bench::new();
    bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.tell("MA100");
    bench.ms(200);
    assert_eq!(bench.number("TQ"), 58);
    bench.tell("DP150");
    assert_eq!(bench.number("TQ"), 116);
    // SQ 40 limits it.
    bench.tell("SQ40");
    assert_eq!(bench.number("TQ"), 40);
    // The integral term goes up to DL and no further: 100 of 255 beside P.
    bench.tell("SQ255,DP75,DI255");
    bench.ms(3_000);
    near(bench.number("TQ"), 58 + 100, 1);
    bench.tell("DL0");
    bench.ms(2);
    assert_eq!(bench.number("TQ"), 58, "without a limit there is no I");
}

#[test]
fn the_integral_takes_away_what_friction_leaves() {
    let mut bench = Bench::new();
    bench.tell("MA3000");
    bench.ms(1_000);
    let left = bench.number("TF").abs();
    assert!(left > 5, "friction leaves {left}");
    bench.tell("DI3");
    bench.ms(20_000);
    let now = bench.number("TF").abs();
    assert!(now < left, "{now} instead of {left}");
}

/// 12 V over 7.5 ohms would be 1.6 A.
#[test]
fn the_bridge_gives_an_ampere_and_no_more() {
    let mut bench = Bench::new();
    bench.bus.apply(0, &WorldAction::LockShaft { motor: Motor::M1, on: true });
    bench.tell("SM32767,DP255,MA20000");
    bench.ms(1_000);
    for _ in 0..50 {
        bench.ms(7);
        let amps = bench.unit().truth().amps;
        assert!((0.9..=1.1).contains(&amps), "{amps} A");
    }
    assert_eq!(bench.number("TQ"), 255);
}

#[test]
fn faults_of_the_machine_are_felt() {
    // Leads changed round: the loop runs away until the error is too great.
    let mut bench = Bench::new();
    bench.bus.apply(0, &WorldAction::ReverseLeads { motor: Motor::M1, on: true });
    bench.tell("SM3000,MA500");
    bench.until(|unit| !unit.is_motor_on());
    // PH turns the count round, so that the loop is closed again.
    bench.ms(1_000);
    bench.tell("PH1,AB,MN,MR500");
    bench.ms(1_000);
    assert!(bench.unit().is_motor_on());
    near(bench.unit().following_error(), 0, STUCK_COUNTS);
    assert_eq!(bench.status().motion & motion::PHASE, motion::PHASE);
    // Encoder plug out: nothing is counted and the motor runs off.
    let mut bench = Bench::new();
    bench.bus.apply(0, &WorldAction::LoseEncoder { motor: Motor::M1, on: true });
    bench.tell("SM1000,MA20000");
    bench.until(|unit| !unit.is_motor_on());
    assert_eq!(bench.number("TP"), 0);
    assert!(bench.unit().truth().motor_radians > 1.0);
    // A broken bridge gives nothing.
    let mut bench = Bench::new();
    let fault = brushwork_plant::world::UnitFault::M1Driver;
    bench.bus.apply(0, &WorldAction::SetUnitFault { fault, on: true });
    bench.tell("SM1000,MA20000");
    bench.until(|unit| !unit.is_motor_on());
    assert_eq!(bench.unit().truth().motor_radians, 0.0);
}

#[test]
fn the_status_tells_which_way_the_move_goes_and_when_it_ends() {
    let mut bench = Bench::new();
    let bits = |bench: &mut Bench| {
        let status = bench.status();
        let has = |bit| status.motion & bit != 0;
        [
            has(motion::FORWARD),
            has(motion::DECELERATION_POLARITY),
            has(motion::ERROR_POLARITY),
            has(motion::COMPLETE),
        ]
    };
    bench.begin("MA5000");
    bench.ms(200);
    assert_eq!(bits(&mut bench), [true, false, true, false]);
    bench.ms(80);
    assert!(bits(&mut bench)[1], "it slows down");
    bench.ms(500);
    assert!(bits(&mut bench)[3]);
    bench.begin("MA0");
    bench.ms(200);
    assert_eq!(bits(&mut bench), [false, true, false, false]);
    bench.ms(80);
    assert!(!bits(&mut bench)[1]);
    assert_eq!(bench.status().operation & operation::ADDRESSED, operation::ADDRESSED);
}
