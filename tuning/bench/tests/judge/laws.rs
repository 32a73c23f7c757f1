//! Firmware laws other than the usual one: the probe finds which, the design uses it, and an unknown one is refused.

use brushwork_mcp_sim::motion::{ControlLaw, GainTiming, VelocityEstimate};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::model::Gains;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
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
        ("per second", ControlLaw { gain_timing: GainTiming::PerSecond, ..usual }),
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
            if found.per_tick {
                assert_eq!(found.rate_hz, truth.law.rate_hz, "{case}");
            }
            if method != Method::Velocity {
                assert_eq!(found.position_scale, truth.law.position_scale, "{case}");
            }
            let optimum = Optimum { cost: 1.0, duty_rms: 0.08, gains: Gains::default() };
            let judged = judge_report(&under_test, &optimum, &report);
            assert!(judged.accept, "{case}: {judged:?}");
        }
    }
}

#[test]
fn a_law_that_is_not_known_is_refused_and_the_old_gains_stay() {
    let usual = ControlLaw::default();
    let odd = [
        ("450 Hz", ControlLaw { rate_hz: 450, ..usual }, Method::Velocity),
        ("position gains x 65536", ControlLaw { position_gain_scale: 65_536.0, ..usual }, Method::Pd),
    ];
    for (name, law, method) in odd {
        let plant = under(8, law);
        let (report, axis) = tune_plant(&plant, &request_of(&plant, method));
        assert_eq!(report.verdict, Verdict::Refused, "{name}: {:?}", report.law);
        assert_eq!(report.causes.first(), Some(&Cause::UnknownLaw), "{name}");
        let before = report.before.expect("the setup was read");
        let motion = axis.carrier.unit().settings().motors[0].motion;
        assert_eq!(motion.velocity_p_raw, before.held.velocity.p, "{name}");
        assert_eq!(motion.position_p_raw, before.held.position.p, "{name}");
        assert_eq!(motion.qpps, before.held.velocity.qpps, "{name}");
    }
}
