//! Machines with absolute encoders, a population of its own (MCP manual 2.4.3): tuned in position inside one turn, bounded on both
//! sides; and what runs read off beside the loops: the winding's resistance, the backlash.

use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_plant::EncoderKind;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use brushwork_tuning_bench::mcp::population::{absolute_specimen, specimen};
use brushwork_tuning_bench::run::{request_of, tune_plant};
use brushwork_tuning_bench::table::absolute_rows;

#[test]
fn eight_machines_with_absolute_encoders_come_out_as_they_did() {
    let table = absolute_rows::<ControlLaw>(7, 8);
    assert!(!table.contains_key("velocity"));
    for (task, accept, good, median) in [
        ("pd", (95.0, 100.0), (80.0, 100.0), (0.9, 1.20)),
        ("pid", (95.0, 100.0), (80.0, 100.0), (0.9, 1.60)),
        ("piv", (70.0, 100.0), (30.0, 90.0), (0.8, 1.70)),
    ] {
        let row = &table[task][0];
        println!("{task}: {row:?}");
        assert_eq!((row.method.as_str(), row.unstable), ("brushwork", 0.0), "{task}");
        assert!((accept.0..=accept.1).contains(&row.accept), "{task}: accepted {} %", row.accept);
        assert!((good.0..=good.1).contains(&row.good), "{task}: good {} %", row.good);
        assert!((median.0..=median.1).contains(&row.j_median), "{task}: median cost {}", row.j_median);
    }
}

#[test]
fn a_speed_is_refused_where_the_encoder_wraps_and_nowhere_else() {
    for number in 0..8 {
        let plant = absolute_specimen(11, number);
        assert_ne!(plant.axis.encoder.kind, EncoderKind::Quadrature);
        let (report, axis) = tune_plant(&plant, &request_of(&plant, Method::Velocity));
        let refused = report.causes.first() == Some(&Cause::WrappingEncoder);
        assert_eq!(refused, plant.axis.encoder.wraps, "plant {number}: {:?}", report.causes);
        if refused {
            assert_eq!(axis.carrier.truth.farthest_radians, 0.0, "plant {number}: it was not moved");
        } else {
            assert_ne!(report.verdict, Verdict::Refused, "plant {number}: {:?}", report.causes);
        }
    }
}

#[test]
fn the_resistance_of_the_winding_is_found_with_its_interval() {
    let (mut reported, mut covered) = (0, 0);
    for number in 0..16 {
        let plant = absolute_specimen(7, number);
        let (report, _) = tune_plant(&plant, &request_of(&plant, Method::Pd));
        let Some(winding) = report.winding else { continue };
        reported += 1;
        let off = (winding.ohms / plant.axis.motor.armature_ohms - 1.0).abs();
        let interval = winding.interval_ohms / winding.ohms;
        println!("plant {number}: off by {off:.3}, interval {interval:.3}");
        assert!(off < 2.0 * interval, "plant {number}: off by {off}, interval {interval}");
        covered += usize::from(off < interval);
    }
    assert!(reported >= 6, "{reported} of 16");
    assert!(10 * covered >= 8 * reported, "{covered} of {reported} within their interval");
}

#[test]
fn backlash_is_seen_behind_the_gear_and_claimed_nowhere_else() {
    let mut seen = 0;
    // What the pushes make of a backlash is a matter of chance: all kinds of machines, and some with backlash behind the gear besides.
    let all_kinds = (0..40).filter(|number| !matches!(number % 8, 3 | 5));
    for number in all_kinds.chain([70, 87, 102, 134, 135]) {
        let plant = specimen(7, number);
        let (report, _) = tune_plant(&plant, &request_of(&plant, Method::Pid));
        let Some(found) = report.backlash.filter(|found| found.counts > 0.0) else { continue };
        let turns = plant.axis.gear.backlash_radians / std::f64::consts::TAU;
        let true_counts = turns * plant.axis.encoder.counts_per_turn;
        println!("plant {number}: {found:?} of {true_counts:.1} counts");
        assert!(
            found.counts - 2.0 * found.interval_counts <= true_counts,
            "plant {number}: {found:?} of {true_counts} counts"
        );
        assert!(true_counts > 0.0, "plant {number} has none");
        let position = report.proposed.position.expect("it was tuned");
        assert!(f64::from(position.deadzone) >= found.counts, "plant {number}: {position:?}");
        seen += 1;
    }
    assert!(seen >= 3, "{seen} seen");
}
