//! Which bound keeps the considered gains from being stiffer, in a sentence: so that a slider that does little is understood.

use brushwork_tuning::cause::Cause;
use brushwork_tuning::design::{Bound, Limit};
use brushwork_tuning::whatif::limit_at;
use egui::{Label, RichText, Ui};

use super::run::Run;
use crate::theme::Palette;
use crate::tune::messages::{BoundMessage, RunMessage};

pub fn limits_ui(ui: &mut Ui, run: &Run) {
    let Some((text, is_beyond)) = sentence(run) else { return };
    let palette = Palette::of(ui);
    let color = if is_beyond { palette.warning } else { palette.weak_text };
    let hint = "A stiffer loop meets one of these first: the maximum sensitivity Ms as the motor is, with the largest likely lag, or with \
                half the inertia; or what the rounding of counts does to the duty.";
    ui.add(Label::new(RichText::new(text).small().color(color)).wrap()).on_hover_text(hint);
}

/// What limits, and whether the gains are beyond it.
fn sentence(run: &Run) -> Option<(String, bool)> {
    let (task, shown) = (run.task()?, run.shown.as_ref()?);
    if !shown.forecast.is_stable {
        return None;
    }
    let limit = limit_at(task, run.report.request.level, run.level, &shown.gains);
    let mut said = limit.map_or(RunMessage::Unlimited, |limit| limited(&limit, run.level));
    if run.is_as_proposed() && run.report.causes.contains(&Cause::BackedOff) {
        said = RunMessage::TookBack { limit: said.into() };
    }
    Some((said.to_string(), limit.is_some_and(|limit| limit.used > BEYOND)))
}

/// Rounding to registers may pass a bound by a little.
const BEYOND: f64 = 1.02;

fn limited(limit: &Limit, level: f64) -> RunMessage {
    let percent = 100.0 * limit.used;
    let by = match limit.by {
        Bound::Sensitivity => BoundMessage::Sensitivity,
        Bound::Lag => BoundMessage::Lag,
        Bound::LightLoad => BoundMessage::LightLoad,
        Bound::DutyNoise => BoundMessage::DutyNoise,
        Bound::Backlash => BoundMessage::Backlash,
    };
    let by = by.into();
    match (limit.by, limit.used > BEYOND) {
        (Bound::Backlash, true) => RunMessage::BeyondAtAnyLevel { by },
        (Bound::Backlash, false) => RunMessage::LimitedAtAnyLevel { by },
        (Bound::Sensitivity | Bound::Lag | Bound::LightLoad | Bound::DutyNoise, true) => {
            RunMessage::Beyond { by, percent, level }
        }
        (Bound::Sensitivity | Bound::Lag | Bound::LightLoad | Bound::DutyNoise, false) => {
            RunMessage::Limited { by, percent, level }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bound_has_its_own_words() {
        let bounds = [Bound::Sensitivity, Bound::Lag, Bound::LightLoad, Bound::DutyNoise, Bound::Backlash];
        let said: Vec<String> =
            bounds.iter().map(|by| limited(&Limit { by: *by, used: 0.9 }, 50.0).to_string()).collect();
        for (n, text) in said.iter().enumerate() {
            assert!(text.starts_with("Limited by") && text.ends_with('.'), "{text}");
            assert!(!said[..n].contains(text), "{text}");
        }
        let beyond = limited(&Limit { by: Bound::DutyNoise, used: 1.4 }, 50.0).to_string();
        assert!(beyond.starts_with("Beyond the duty noise"), "{beyond}");
    }
}
