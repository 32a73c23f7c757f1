//! The law of the loop, by the tuner's own probe.

use crate::tuned::McpTuned;
use brushwork_family::examine::Examination;
use brushwork_family::{Target, Tuned as _};
use brushwork_link::device::JobContext;
use brushwork_mcp_axis::{LawFindings, Timing};
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::law_probe::find_law;
use brushwork_values::Motor;
use serde_json::json;

/// What the law probe answers.
const LOOPS: [&str; 5] = ["feed_forward", "proportional", "loop_rate", "position_scale", "derivative"];
/// Highest duty: that of the wiring probe.
const MAX_DUTY: f64 = 0.45;
/// Longest run, s.
const TIME_LIMIT_S: f64 = 30.0;

/// Asks. Whatever a motor does, this ends with it at rest and its gains put back.
pub fn ask(motor: Motor, context: &mut JobContext<'_>, found: &mut Examination) {
    let target = Target { motor, encoder: None, stream: None };
    let options = GuardOptions {
        motor: motor.index(),
        max_duty: MAX_DUTY,
        time_limit_s: TIME_LIMIT_S,
        ..GuardOptions::default()
    };
    let law = find_law(&mut *McpTuned::axis(context, target, false), options);
    match law {
        Err(cause) => {
            let why = format!("The motor could not be looked at. {}", cause.sentence());
            for key in LOOPS.into_iter().chain(["speed_step"]) {
                found.unclear(key, why.clone());
            }
        }
        Ok(law) => {
            speed_step(found, law.speed_step);
            match law.findings {
                Some(findings) => enter(found, &findings, law.speed_step),
                None => {
                    let why = "The controller reports no duty, so that nothing is known of its loops.";
                    for key in LOOPS {
                        found.unclear(key, why);
                    }
                }
            }
        }
    }
}

/// To half a count per second, so that every look at the same window gives the same.
fn rounded(step: f64) -> f64 {
    (step * 2.0).round() / 2.0
}

fn speed_step(found: &mut Examination, step: Option<f64>) {
    match step.map(rounded) {
        Some(step) => found.answered(
            "speed_step",
            json!(step),
            format!("All readings are multiples of {step} counts/s: it counts over 1/{step} s."),
        ),
        None => {
            found.unclear("speed_step", "The readings are no multiples of anything, or there were too few.");
        }
    }
}

fn enter(found: &mut Examination, findings: &LawFindings, step: Option<f64>) {
    match findings.known_feed_forward() {
        Some(true) => found.answered("feed_forward", json!(true), "Yes: QPPS is the feed-forward."),
        Some(false) => found.answered("feed_forward", json!(false), "No."),
        None => found.unclear("feed_forward", "A part of it is added."),
    }
    found.measured("feed_forward", json!({ "share": findings.feed_forward }));
    match findings.is_proportional_known() {
        true => found.answered("proportional", json!(65_536), "Yes."),
        false => found.unclear("proportional", "No: the duty fits another scale."),
    }
    found.measured("proportional", json!({ "gain": findings.proportional }));
    match findings.known_timing() {
        Some(Timing::PerTick { rate_hz }) => found.answered(
            "loop_rate",
            json!({ "per_tick": true, "rate_hz": rate_hz }),
            format!("I sums over ticks, of which there are {rate_hz} in a second."),
        ),
        Some(Timing::PerSecond) => {
            // The unfiltered speed is counted over whole ticks.
            let rate_hz =
                step.map(rounded).and_then(|step| [300.0, 625.0].into_iter().find(|rate| rate % step == 0.0));
            let rate = match rate_hz {
                Some(rate) => format!("the unfiltered speed speaks for {rate} ticks in a second"),
                None => "how many ticks there are in a second nothing tells".to_owned(),
            };
            found.answered(
                "loop_rate",
                json!({ "per_tick": false, "rate_hz": rate_hz }),
                format!("I sums over seconds; {rate}."),
            );
        }
        None => found.unclear("loop_rate", "I sums up at a rate that is none of the known ones."),
    }
    found.measured("loop_rate", json!({ "sums_per_s": findings.sums_per_s }));
    match findings.known_position_scale() {
        Some(scale) => found.answered("position_scale", json!(scale), format!("x{scale}.")),
        None => found.unclear("position_scale", "The position loop gave no duty, or one of another scale."),
    }
    found.measured("position_scale", json!({ "scale": findings.position_scale }));
    derivative(found, findings);
}

fn derivative(found: &mut Examination, findings: &LawFindings) {
    match (findings.known_derivative(), findings.derivative_s) {
        (Some(Timing::PerSecond), _) => {
            found.answered(
                "derivative",
                json!({ "per_tick": false }),
                "D multiplies the change in a second.",
            );
        }
        (Some(Timing::PerTick { .. }), _) => {
            found.answered("derivative", json!({ "per_tick": true }), "D multiplies the change in a tick.");
        }
        (None, Some(_)) => found.unclear("derivative", "D multiplies the change in some other time."),
        (None, None) => {
            found.unclear("derivative", "There was no room to creep, or D could not be read well.");
        }
    }
    found.measured("derivative", json!({ "seconds": findings.derivative_s }));
}
