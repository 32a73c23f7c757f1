//! Figures of a forecast, and how figures and verdicts are shown.

use egui::{Label, Response, RichText, Ui, vec2};

use super::messages::RunMessage;
use super::run::Shown;
use crate::theme;

type Figure = (&'static str, &'static str, fn(&Shown) -> String);

/// Figures of a forecast, by name, with what they mean.
pub const FIGURES: [Figure; 5] = [
    ("Overshoot", "How far a step goes beyond its setpoint, over the step", |shown| {
        if_stable(shown, || format!("{:.1} %", 100.0 * shown.forecast.overshoot))
    }),
    (
        "Settling",
        "How long a step takes to stay near its setpoint: 5 % of a speed, 2 % of a position",
        |shown| {
            if_stable(shown, || {
                shown.forecast.settling_s.map_or_else(|| "never".to_owned(), |s| format!("{:.0} ms", 1e3 * s))
            })
        },
    ),
    ("Load dip", "How far a load of 15 % of the stall torque drives it off, over the step", |shown| {
        if_stable(shown, || format!("{:.1} %", 100.0 * shown.forecast.load_dip))
    }),
    ("Ms", "Maximum sensitivity: 1.2 is very tame, 1.6 is firm, above 2 is close to oscillating", |shown| {
        if_stable(shown, || format!("{:.2}", shown.forecast.ms))
    }),
    ("Duty noise", "What the rounding of counts alone does to the duty", |shown| {
        if_stable(shown, || format!("{:.2} %", 100.0 * shown.forecast.noise_duty))
    }),
];

/// The range that holds the true value, where a figure has one.
pub fn likely(shown: &Shown, name: &str) -> Option<String> {
    let promise = shown.promise.filter(|_| shown.forecast.is_stable)?;
    let (ms, settling_s) = (promise.ms, promise.settling_s);
    let message = match name {
        "Settling" => RunMessage::LikelySettling { low_ms: 1e3 * settling_s.0, high_ms: 1e3 * settling_s.1 },
        "Ms" => RunMessage::LikelySensitivity { low: ms.0, high: ms.1 },
        _ => return None,
    };
    Some(message.to_string())
}

fn if_stable(shown: &Shown, text: impl FnOnce() -> String) -> String {
    if shown.forecast.is_stable { text() } else { "unstable".to_owned() }
}

/// A figure at the right of a place of fixed width.
pub fn figure_ui(ui: &mut Ui, text: &str, width: f32) -> Response {
    let size = vec2(width, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, egui::Layout::right_to_left(egui::Align::Center), |ui| {
        ui.set_min_width(width);
        ui.add(Label::new(RichText::new(text).text_style(theme::figures())).truncate())
    })
    .inner
}
