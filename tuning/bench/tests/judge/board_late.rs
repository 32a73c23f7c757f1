//! A board that is tuned by moves from a host that stands still for a while: what it has not seen of a move is no bad end of it.

use brushwork_suprmotr_axis::law::SuprMotrLaw;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::{Method, tune};
use brushwork_tuning_bench::run::request_of;
use brushwork_tuning_bench::suprmotr::population::{BoardSpecimen, specimen};
use brushwork_tuning_bench::unit::Unit;
use std::time::Duration;

/// When the host stands still, ms: from the strokes that measure the motor to the end of the trial, and for longer than a move takes.
const FROM_MS: u64 = 2_000;
const TO_MS: u64 = 16_000;
const EVERY_MS: usize = 410;
const STALL: Duration = Duration::from_millis(2_500);

fn run(plant: &BoardSpecimen, stall_ms: Option<u64>) -> Report<SuprMotrLaw> {
    let mut axis = Unit::axis(plant);
    let stall = stall_ms.map(|at| (Duration::from_millis(at), STALL));
    axis.carrier.line.stalls = stall.into_iter().collect();
    tune(&mut axis, &request_of(plant, Method::Pid))
}

fn integral(report: &Report<SuprMotrLaw>) -> u8 {
    report.proposed.suprmotr.map_or(0, |registers| registers.i)
}

#[test]
fn a_host_that_sleeps_through_a_move_takes_no_integral_away() {
    // A plant whose integral is several steps of DI: one step is none of lateness.
    let plant = specimen(7, 2);
    let quiet = run(&plant, None);
    assert_eq!((quiet.verdict, integral(&quiet) > 4), (Verdict::Tuned, true));
    let mut lost = Vec::new();
    for at_ms in (FROM_MS..TO_MS).step_by(EVERY_MS) {
        let late = run(&plant, Some(at_ms));
        println!("{at_ms}: {:?} {:?} DI {}", late.verdict, late.causes, integral(&late));
        if integral(&late) < 3 || late.causes.contains(&Cause::BackedOff) {
            lost.push((at_ms, late.causes.clone()));
        }
    }
    assert_eq!(lost, [], "DI of a quiet host: {}", integral(&quiet));
}
