//! What a run on a Motion Mind does about its modes, its inputs, its protections and a host that dies.

use brushwork_motion_mind_axis::MindAxis;
use brushwork_motion_mind_sim::{MotionMind, pin};
use brushwork_motion_mind_wire::{Address, Command, encode_frame, function2, status};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Method, tune};
use brushwork_tuning_bench::line::Event;
use brushwork_tuning_bench::motion_mind::line::MindLine;
use brushwork_tuning_bench::motion_mind::population::{MindSetup, MindSpecimen, specimen};
use brushwork_tuning_bench::run::request_of;
use brushwork_tuning_bench::unit::{self, Unit};
use std::time::Duration;

type Report = unit::Report<MindSetup>;
type Request = unit::Request<MindSetup>;
type SimulatedMind = MindAxis<MindLine>;

const FUNCTION: u8 = 3;
const FUNCTION2: u8 = 30;
const STATUS: u8 = 16;
const AMPSLIMIT: u8 = 28;

fn unit(axis: &SimulatedMind) -> &MotionMind {
    axis.carrier.line.unit()
}

/// A run in which something happens after so many seconds.
fn struck(
    plant: &MindSpecimen,
    request: &Request,
    after_s: f64,
    action: WorldAction,
) -> (Report, SimulatedMind) {
    let mut axis = Unit::axis(plant);
    let at = unit(&axis).now() + Duration::from_secs_f64(after_s);
    axis.carrier.line.schedule(vec![Event { at, action }]);
    let report = tune(&mut axis, request);
    (report, axis)
}

#[test]
fn a_limit_or_the_brake_struck_in_a_run_ends_it_by_its_name_with_the_motor_off_and_the_registers_back() {
    let plant = specimen(7, 0);
    let request = request_of(&plant, Method::Velocity);
    for (number, after_s) in [(pin::POSITIVE_LIMIT, 1.6), (pin::NEGATIVE_LIMIT, 3.5), (pin::BRAKE, 2.0)] {
        let before = unit(&Unit::axis(&plant)).read_one(FUNCTION);
        let low = WorldAction::SetPin { pin: number, signal: PinSignal::Volts { volts: 0.0 } };
        let (report, axis) = struck(&plant, &request, after_s, low);
        assert_eq!(report.causes, vec![Cause::LimitInput], "pin {number}");
        assert_eq!(unit(&axis).read_one(FUNCTION), before);
        assert!(unit(&axis).duty().abs() < 0.02, "pin {number}: the motor stands");
    }
}

#[test]
fn a_bridge_that_got_too_hot_ends_a_run_and_leaves_the_loop_off() {
    let plant = specimen(7, 1);
    let hot = WorldAction::SetBoardCelsius { celsius: Some(95.0) };
    let (report, axis) = struck(&plant, &request_of(&plant, Method::Pd), 2.0, hot);
    assert_eq!(report.causes, vec![Cause::ControllerFault, Cause::LoopOff]);
    assert_ne!(unit(&axis).read_one(STATUS) & i64::from(status::TEMPFAULT), 0);
    assert_eq!(unit(&axis).duty(), 0.0);
}

#[test]
fn the_highest_current_of_a_run_is_amps_limit_and_the_users_is_put_back() {
    let plant = specimen(7, 0);
    let request = request_of(&plant, Method::Velocity);
    let users = unit(&Unit::axis(&plant)).read_one(AMPSLIMIT);
    let most = 0.02 * users as f64 * 0.8;
    let guard = GuardOptions { max_amps: Some(most), ..request.guard };
    let mut axis = Unit::axis(&plant);
    let report = tune(&mut axis, &Request { guard, ..request });
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
    let written = axis.carrier.line.sent.iter().any(|bytes| {
        let steps = (most / 0.02).round() as i64;
        bytes.len() == 6
            && bytes[0] == 0x18
            && bytes[2] == AMPSLIMIT
            && i64::from(bytes[3]) + 256 * i64::from(bytes[4]) == steps
    });
    assert!(written, "the limit was written");
    assert_eq!(unit(&axis).read_one(AMPSLIMIT), users);
}

#[test]
fn pulse_feedback_is_refused_before_anything_moves_and_other_bits_are_set_aside_and_put_back() {
    let plant = specimen(7, 0);
    for (bit, refused) in [
        (function2::PULSEFB, Some(Cause::WrongMode)),
        (function2::NEWVELMODE, None),
        (function2::FASTPID, None),
    ] {
        let mut fresh = plant.controller();
        let word = fresh.read_one(FUNCTION2) | i64::from(bit);
        let write = Command::Write { register: FUNCTION2, value: word };
        fresh.receive(&encode_frame(Address::FACTORY, &write).expect("a word"));
        fresh.advance(fresh.now() + Duration::from_millis(50));
        while fresh.take_output().is_some() {}
        let mut axis = MindAxis::new(MindLine::of(fresh, &plant));
        let report = tune(&mut axis, &request_of(&plant, Method::Pd));
        assert_eq!(unit(&axis).read_one(FUNCTION2), word, "bit {bit:#x} is put back");
        match refused {
            Some(cause) => {
                assert_eq!(report.causes, vec![cause]);
                assert_eq!(axis.carrier.line.truth.peak_amps, 0.0);
            }
            None => {
                assert_ne!(report.verdict, Verdict::Refused, "bit {bit:#x}: {:?}", report.causes);
                let proposed = report.proposed.motion_mind.expect("registers");
                assert_eq!(proposed.function2 & bit, 0, "the gains are for the usual loop");
            }
        }
    }
}

#[test]
fn a_host_that_dies_at_any_moment_leaves_a_motor_that_stands_soon_by_the_fence() {
    let plant = specimen(7, 1);
    let request = request_of(&plant, Method::Velocity);
    let whole_s = tune(&mut Unit::axis(&plant), &request).seconds.1;
    for nth in 1..12 {
        let mut axis = Unit::axis(&plant);
        let dies_at = unit(&axis).now() + Duration::from_secs_f64(whole_s * f64::from(nth) / 12.0);
        axis.carrier.line.dead_at = Some(dies_at);
        tune(&mut axis, &request);
        let line = &mut axis.carrier.line;
        line.idle(Duration::from_secs(2));
        let position = line.unit().read_one(0);
        line.idle(Duration::from_secs(2));
        let travelled = line.unit().read_one(0) - position;
        assert!(travelled.abs() < 30, "{nth}/12 of the run: it went on by {travelled} counts");
        assert!(line.unit().duty().abs() < 0.1, "{nth}/12 of the run: {}", line.unit().duty());
    }
}

#[test]
fn what_moves_in_a_run_is_never_written_to_eeprom() {
    for method in [Method::Velocity, Method::Pd, Method::Pid] {
        let plant = specimen(7, 1);
        let mut axis = Unit::axis(&plant);
        let before = unit(&axis).eeprom_writes();
        tune(&mut axis, &Request { keep: true, ..request_of(&plant, method) });
        assert_eq!(unit(&axis).eeprom_writes(), before, "{method:?}");
        let stores = [0x19, 0x1B, 0x1C];
        assert!(axis.carrier.line.sent.iter().all(|bytes| !stores.contains(&bytes[0])), "{method:?}");
    }
}
