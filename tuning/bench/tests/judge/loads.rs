//! Axes that something pulls at all the time: an arm, a slope, a spring. A load that friction holds is no reason to refuse; one that
//! it does not hold is named.

use brushwork_mcp_axis::McpLaw;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Excitation, Method, Request};
use brushwork_tuning_bench::mcp::population::{PacketSpecimen, specimen};
use brushwork_tuning_bench::run::{request_of, tune_plant};
use brushwork_tuning_bench::unit::Unit;

type Report = brushwork_tuning::report::Report<McpLaw>;

/// Two of each kind, from seed 7.
const PLANTS: usize = 16;

/// A plant with a constant load, as a share of the torque at stall.
fn pulled(number: usize, share: f64) -> PacketSpecimen {
    let mut plant = specimen(7, number);
    plant.axis.load.torque_newton_metres = plant.load_torque(share);
    plant
}

/// Tunes a position loop in a window of 0.4 s of full speed to either side.
fn tuned_inside(plant: &PacketSpecimen, method: Method) -> Report {
    let half = (0.4 * Unit::truth(plant).gain_counts_per_s) as i64;
    let usual: Request<McpLaw> = request_of(plant, method);
    let guard = GuardOptions { travel: Some((-half, half)), ..usual.guard };
    tune_plant(plant, &Request { excitation: Excitation::Window(2.0 * half as f64), guard, ..usual }).0
}

/// What the refused ones were refused for.
fn refusals(method: Method, share: f64) -> Vec<(usize, Vec<Cause>)> {
    (0..PLANTS)
        .map(|number| (number, tuned_inside(&pulled(number, share), method)))
        .filter(|(_, report)| report.verdict == Verdict::Refused)
        .map(|(number, report)| (number, report.causes))
        .collect()
}

fn unexplained(refused: &[(usize, Vec<Cause>)]) -> usize {
    refused.iter().filter(|(_, causes)| !causes.contains(&Cause::HeavyLoad)).count()
}

#[test]
fn a_load_of_3_percent_is_tuned_as_pid_whichever_way_it_pulls() {
    for share in [0.03, -0.03] {
        let refused = refusals(Method::Pid, share);
        assert!(refused.len() <= 2, "{share}: {refused:?}");
        assert!(unexplained(&refused) <= 2, "{share}: {refused:?}");
        let stopped =
            |causes: &[Cause]| causes.contains(&Cause::Stalled) || causes.contains(&Cause::TravelLimit);
        assert!(!refused.iter().any(|(_, causes)| stopped(causes)), "{share}: {refused:?}");
    }
}

#[test]
fn a_load_of_6_percent_is_tuned_as_piv_or_called_heavy() {
    for share in [0.06, -0.06] {
        let refused = refusals(Method::Piv, share);
        assert!(refused.len() <= 3, "{share}: {refused:?}");
        assert!(unexplained(&refused) <= 1, "{share}: {refused:?}");
    }
}

#[test]
fn a_load_that_friction_does_not_hold_is_reported() {
    let report = tuned_inside(&pulled(6, 0.1), Method::Piv);
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
    assert!(report.causes.contains(&Cause::HeavyLoad), "{:?}", report.causes);
    let pd = tuned_inside(&pulled(6, 0.1), Method::Pd);
    assert!(pd.causes.contains(&Cause::HeavyLoad), "{:?}", pd.causes);
}
