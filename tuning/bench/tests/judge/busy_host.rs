//! A host that reads replies late makes counts look rough. That is no roughness of the motor, no reason to lower gains, and no fault.

use brushwork_tuning::model::Gains;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Method, tune};
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::optimum::Optimum;
use brushwork_tuning_bench::run::{judge_report, request_of};
use brushwork_tuning_bench::unit::{UnderTest, Unit};

/// Share of replies that are read late, and by how much at the most, s: a machine with more to do than it can.
const BUSY: (f64, f64) = (0.35, 0.015);
/// One plant of each kind but the coreless servo, which is over before such polls see it (`MEASURED.md`).
const PLANTS: [usize; 7] = [0, 1, 2, 4, 5, 6, 7];

#[test]
fn a_busy_host_lowers_no_gains_and_raises_no_alarm() {
    let optimum = Optimum { cost: 1.0, duty_rms: 0.08, gains: Gains::default() };
    for number in PLANTS {
        let plant = specimen(31, number);
        let costs = [None, Some(BUSY)].map(|late_reads| {
            let mut axis = Unit::axis(&plant);
            axis.carrier.late_reads = late_reads;
            let report = tune(&mut axis, &request_of(&plant, Method::Velocity));
            println!("plant {number}, {late_reads:?}: {:?} {:?}", report.causes, report.measured);
            assert_ne!(
                report.verdict,
                Verdict::Refused,
                "plant {number}, {late_reads:?}: {:?}",
                report.causes
            );
            judge_report(&UnderTest::new(plant.clone()), &optimum, &report).j
        });
        let ratio = costs[1] / costs[0];
        assert!(ratio < 2.0, "plant {number}: the cost is {ratio:.2} times that of a quiet host");
    }
}
