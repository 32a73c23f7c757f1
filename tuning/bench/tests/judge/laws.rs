//! Firmware laws other than the usual one: the probe measures them, and the design is for what was measured.

use brushwork_mcp_sim::motion::{ControlLaw, GainTiming, VelocityEstimate};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::model::Gains;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use brushwork_tuning_bench::mcp::laws::{LawRun, law_row, law_runs};
use brushwork_tuning_bench::mcp::population::{PacketSpecimen, specimen};
use brushwork_tuning_bench::optimum::Optimum;
use brushwork_tuning_bench::run::{judge_report, request_of, tune_plant};
use brushwork_tuning_bench::unit::UnderTest;

/// A gearmotor, a rover's wheel and a robot's base of seed 101.
const PLANTS: [usize; 3] = [8, 1, 10];

fn under(number: usize, law: ControlLaw) -> PacketSpecimen {
    PacketSpecimen { unit: law, ..specimen(101, number) }
}

fn laws() -> Vec<(&'static str, ControlLaw)> {
    let usual = ControlLaw::default();
    vec![
        ("the usual law", usual),
        ("625 Hz", ControlLaw::at_625_hz()),
        ("450 Hz", ControlLaw { rate_hz: 450, ..usual }),
        ("position gains x 65536", ControlLaw { position_gain_scale: 65_536.0, ..usual }),
        ("per second", ControlLaw { gain_timing: GainTiming::PerSecond, ..usual }),
        ("D alone per second", ControlLaw { derivative_timing: Some(GainTiming::PerSecond), ..usual }),
        (
            "I alone per second",
            ControlLaw {
                gain_timing: GainTiming::PerSecond,
                derivative_timing: Some(GainTiming::PerTick),
                ..usual
            },
        ),
        ("position gains x 2048", ControlLaw { position_gain_scale: 2048.0, ..usual }),
        ("without feed-forward", ControlLaw { feed_forward: false, ..usual }),
        (
            "filter and extra tick",
            ControlLaw {
                velocity_estimate: VelocityEstimate::LowPass { time_constant_s: 0.010 },
                output_delay_ticks: 1,
                ..usual
            },
        ),
    ]
}

#[test]
fn each_law_is_found_and_its_gains_hold_on_the_true_plant() {
    for (name, law) in laws() {
        for (number, method) in PLANTS.into_iter().zip([Method::Velocity, Method::Piv, Method::Pd]) {
            let plant = under(number, law);
            let (report, _) = tune_plant(&plant, &request_of(&plant, method));
            let under_test = UnderTest::new(plant);
            let truth = &under_test.truth;
            let case = format!("{name}, plant {number}, {method:?}: {:?} {:?}", report.causes, report.law);
            assert_ne!(report.verdict, Verdict::Refused, "{case}");
            let found = report.request.law;
            assert_eq!(found.per_tick, truth.law.per_tick, "{case}");
            assert_eq!(found.feed_forward, truth.law.feed_forward, "{case}");
            assert!((f64::from(found.rate_hz) / f64::from(truth.law.rate_hz) - 1.0).abs() < 0.04, "{case}");
            if method != Method::Velocity {
                let scale = found.position_scale / truth.law.position_scale;
                assert!((scale - 1.0).abs() < 0.04, "{case}");
            }
            let derivative = found.derivative_s() / truth.law.derivative_s();
            assert!(method != Method::Pd || (derivative - 1.0).abs() < 0.04, "{case}");
            let optimum = Optimum { cost: 1.0, duty_rms: 0.08, gains: Gains::default() };
            let judged = judge_report(&under_test, &optimum, &report);
            assert!(judged.accept, "{case}: {judged:?}");
        }
    }
}

/// Seed 905 was not looked at while the probe was written, but for these bounds. Below 150 Hz heavy motors are called stalled before their law
/// is asked for, and coarse ones are found rougher than predicted. `cargo run --release -p brushwork-tuning-bench --example laws -- SEED PLANTS`
/// runs others.
#[test]
fn twenty_four_plants_under_laws_of_90_to_1250_hz_are_tuned_for_the_law_that_each_has() {
    let runs = law_runs(905, 24, Method::Velocity);
    for run in &runs {
        println!("{}", run.line());
        let Some(found) = run.report.law else { continue };
        let (law, known) = (run.report.request.law, run.plant.unit);
        let case = format!("plant {}: {found:?} {law:?}", run.plant.number);
        // What is near a known rate is taken to be that.
        assert!((f64::from(law.rate_hz) / f64::from(known.rate_hz) - 1.0).abs() < 0.07, "{case}");
        assert_eq!(law.per_tick, known.gain_timing == GainTiming::PerTick, "{case}");
    }
    let row = law_row(&runs);
    println!("{row:?}");
    assert_eq!(row.refused.0, 0, "every one of these laws can be measured");
    let is_quick = |run: &&LawRun| run.plant.unit.rate_hz >= 150;
    let refused = runs.iter().filter(is_quick).filter(|run| run.report.verdict == Verdict::Refused);
    assert_eq!(refused.count(), 0, "at 150 Hz and more");
    assert!(row.accepted >= 17, "{row:?}");
    assert_eq!(row.bad, 0, "unstable, or a true Ms above 2");
}

#[test]
fn a_law_that_is_not_known_is_refused_and_the_old_gains_stay() {
    // So coarse a scale that no position gain gives a duty.
    let plant = under(8, ControlLaw { position_gain_scale: 1e10, ..ControlLaw::default() });
    let (report, axis) = tune_plant(&plant, &request_of(&plant, Method::Pd));
    assert_eq!(report.verdict, Verdict::Refused, "{:?}", report.law);
    assert_eq!(report.causes.first(), Some(&Cause::UnknownLaw));
    let before = report.before.expect("the setup was read");
    let motion = axis.carrier.unit().settings().motors[0].motion;
    assert_eq!(motion.velocity_p_raw, before.held.velocity.p);
    assert_eq!(motion.position_p_raw, before.held.position.p);
    assert_eq!(motion.qpps, before.held.velocity.qpps);
}
