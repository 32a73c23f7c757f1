//! The trapezoid that a run proposes, followed by the simulated motor under the proposed gains: its duty is never at the end.

use brushwork_mcp_axis::{Carrier, McpLaw};
use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_mcp_wire::packet_serial::name::{ACCEL, SPEED};
use brushwork_mcp_wire::packet_serial::{commands, give};
use brushwork_tuning::axis::{Axis, Want};
use brushwork_tuning::law::Law;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::setup::LoopAxis;
use brushwork_tuning::tune::Method;
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::run::{request_of, tune_plant};
use brushwork_tuning_bench::unit::Unit;
use std::time::Duration;

const SEED: u64 = 7;
const PLANTS: usize = 16;
const FULL_RAW: f64 = 32_767.0;
const EVERY: Duration = Duration::from_millis(10);
/// How long it stays at the top of the trapezoid, s.
const PLATEAU_S: f64 = 1.0;

/// Highest duty on the way up and on the plateau, and by how much the mean speed of that is off, as a share.
fn followed(report: &Report<McpLaw>, number: usize, (speed, accel): (f64, f64)) -> (f64, f64) {
    let plant = specimen(SEED, number);
    let mut axis = ControlLaw::axis(&plant);
    for write in McpLaw::writes(&report.proposed, false) {
        axis.write(write).expect("it takes its gains");
    }
    let given = [give(ACCEL, accel.round() as i64), give(SPEED, speed.round() as i64)];
    axis.carrier.transact(commands::SPEED_ACCEL_M1, &given).expect("it takes the speed");
    let (begun, mut most) = (axis.now(), 0.0_f64);
    let rise_s = speed / accel;
    let mut plateau: Vec<(f64, f64)> = Vec::new();
    loop {
        let next = axis.now() + EVERY;
        axis.wait_until(next).expect("time goes on");
        let Ok(sample) = axis.sample(Want { duty: true, ..Want::default() }) else { continue };
        most = most.max(sample.duty_raw.map_or(0.0, |(_, raw)| f64::from(raw).abs() / FULL_RAW));
        let t = (axis.now() - begun).as_secs_f64();
        if t > rise_s + 0.5 * PLATEAU_S {
            plateau.push((t, f64::from(sample.counts[0])));
        }
        if t > rise_s + PLATEAU_S {
            break;
        }
    }
    let (first, last) = (plateau[0], plateau[plateau.len() - 1]);
    let mean = (last.1 - first.1) / (last.0 - first.0);
    (most, (mean / speed - 1.0).abs())
}

#[test]
fn motors_follow_the_trapezoid_that_is_proposed_with_duty_to_spare_and_no_quicker_one() {
    let mut quicker = 0;
    let mut tried = 0;
    for number in 0..PLANTS {
        let plant = specimen(SEED, number);
        let (report, _) = tune_plant(&plant, &request_of(&plant, Method::Velocity));
        if report.verdict == Verdict::Refused {
            continue;
        }
        let trajectory = report.trajectory().expect("a tuned motor follows something");
        let pace = (trajectory.speed_counts_per_s, trajectory.accel_counts_per_s2);
        let (duty, off) = followed(&report, number, pace);
        let (hard, _) = followed(&report, number, (1.2 * pace.0, 2.0 * pace.1));
        println!(
            "{number} {:?}: {pace:?}, duty {duty:.2}, off {:.1} %, quicker {hard:.2}",
            plant.kind,
            100.0 * off
        );
        assert!(duty < 0.995 && off < 0.03, "{number}: duty {duty}, off {off}");
        quicker += usize::from(hard > 0.99);
        tried += 1;
    }
    assert!(
        tried >= PLANTS * 3 / 4 && quicker * 2 > tried,
        "{quicker} of {tried} run out of duty when told to be quicker"
    );
}
