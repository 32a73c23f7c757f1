//! Why a result was not accepted, from what the trial on the true plant measured and what that plant is.

pub use crate::bounds::{MOST_MS, most_overshoot};
use crate::population::Specimen;
use crate::run::Judgement;
use crate::truth::Truth;
use brushwork_plant::ShaftSide;
use brushwork_tuning::law::Law;
use brushwork_tuning::tune::Method;

/// Motors below this time constant are over before a poll sees them, s.
const QUICK_S: f64 = 0.020;
/// An encoder that counts less than this in a tick at full speed, at 300 Hz, is coarse.
const COARSE_COUNTS_PER_S: f64 = 1_500.0;

/// The group of a result that was not accepted: what was measured, and on what; `None` for an accepted one.
#[must_use]
pub fn group<U, L: Law>(
    method: Method,
    specimen: &Specimen<U>,
    truth: &Truth<L>,
    judged: &Judgement,
) -> Option<String> {
    if judged.accept {
        return None;
    }
    if let Some(cause) = judged.refused {
        return Some(format!("refused: {cause:?}"));
    }
    let measured = if !judged.stable {
        "unstable"
    } else if judged.hunting {
        "limit cycle"
    } else if judged.ms > MOST_MS {
        "true Ms above 2"
    } else if judged.overshoot > most_overshoot(method) {
        "overshoot"
    } else {
        "duty noise"
    };
    Some(format!("{measured}, {}", machine(specimen, truth)))
}

fn machine<U, L: Law>(specimen: &Specimen<U>, truth: &Truth<L>) -> &'static str {
    let axis = &specimen.axis;
    let has_backlash = axis.gear.backlash_radians > 0.0;
    match (axis.is_two_mass(), axis.encoder.side) {
        (true, ShaftSide::Load) if has_backlash => "encoder behind backlash",
        (true, _) => "springy shaft",
        _ if truth.tau_s < QUICK_S => "time constant below 20 ms",
        _ if truth.qpps < COARSE_COUNTS_PER_S => "coarse encoder",
        _ => "rigid",
    }
}
