//! The family's indicators by their abbreviations, and the figures of the link.

use brushwork_link::exchange::LinkStatistics;
use egui::accesskit::Live;
use egui::{Align2, Label, RichText, Role, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2};

use crate::language::{said, word};
use crate::messages::LinkMessage;
use crate::model::{History, IndicatorState, Model};
use crate::shell::messages::ShellMessage;
use crate::theme::{self, Palette};
use crate::widgets::indicator;

const LINK_WIDTH: f32 = 226.0;
const HEIGHT: f32 = 38.0;

pub fn bottom_ui(ui: &mut Ui, model: &Model) {
    announce_ui(ui, &model.front.history);
    ui.spacing_mut().item_spacing.x = 4.0;
    ui.horizontal(|ui| {
        let indicators = model.front.family().indicators();
        let gaps = ui.spacing().item_spacing.x * indicators.len() as f32;
        let width = ((ui.available_width() - LINK_WIDTH - gaps) / indicators.len() as f32).clamp(38.0, 72.0);
        if let Some(sentence) = model.front.link.without_status() {
            let size = vec2(ui.available_width() - LINK_WIDTH, HEIGHT);
            ui.add_sized(size, Label::new(RichText::new(sentence).weak()).wrap());
            return link_ui(ui, model);
        }
        for info in indicators {
            let state = model.front.link.indicators.named(info.short);
            indicator::abbreviated_ui(
                ui,
                vec2(width.floor(), HEIGHT),
                info.short,
                &word("indicator", info.title),
                state,
            );
        }
        link_ui(ui, model);
    });
}

/// The newest event, for a screen reader alone: it is read out as it comes. What is grave breaks into what is being read.
fn announce_ui(ui: &mut Ui, history: &History) {
    let place = egui::Rect::from_min_size(ui.cursor().min, egui::Vec2::ZERO);
    let response = ui.interact(place, egui::Id::unique("newest event"), Sense::hover());
    let newest = history.from_newest(0);
    let text = newest.map_or_else(String::new, |entry| entry.text.clone());
    let is_grave = newest.is_some_and(|entry| entry.kind.state() >= IndicatorState::Warning);
    response.widget_info(|| {
        WidgetInfo::labeled(Role::Status, true, said(&ShellMessage::NewestEvent { text: text.clone() }))
    });
    let live = if is_grave { Live::Assertive } else { Live::Polite };
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_live(live));
}

/// Two lines of figures at fixed places.
fn link_ui(ui: &mut Ui, model: &Model) {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let figures = model.is_connected().then_some(&model.front.link.statistics);
    let (first, second) = lines(figures);
    response.widget_info(|| {
        WidgetInfo::labeled(
            Role::Label,
            true,
            said(&ShellMessage::Link { first: first.clone(), second: second.clone() }),
        )
    });
    let font = egui::FontId::new(12.0, theme::figures().resolve(ui.style()).family);
    let color = if figures.is_some() { palette.text } else { palette.weak_text };
    let painter = ui.painter().with_clip_rect(rect);
    painter.text(pos2(rect.right(), rect.top() + 2.0), Align2::RIGHT_TOP, first, font.clone(), color);
    let color = if figures.is_some_and(has_errors) { palette.warning } else { palette.weak_text };
    painter.text(pos2(rect.right(), rect.bottom() - 2.0), Align2::RIGHT_BOTTOM, second, font, color);
    if let Some(figures) = figures {
        let body = TextStyle::Body.resolve(ui.style());
        response.on_hover_text(RichText::new(in_full(figures)).font(body));
    }
}

fn has_errors(figures: &LinkStatistics) -> bool {
    figures.timeouts + figures.crc_errors > 0
}

/// Fixed-width figures: right-aligned, they stand still.
fn lines(figures: Option<&LinkStatistics>) -> (String, String) {
    let Some(figures) = figures else { return (word("bar", "no link"), String::new()) };
    let first =
        LinkMessage::Rates { kbit_per_s: figures.kbit_per_s, requests_per_s: figures.transactions_per_s }
            .to_string();
    let errors = figures.timeouts + figures.crc_errors;
    let round_trip = milliseconds(figures.round_trip_median_s);
    // As wide as the plural, so that the figure stands still.
    let noun = if errors == 1 { word("bar", "error ") } else { word("bar", "errors") };
    let second = format!("{round_trip} ms {errors:6} {noun}");
    (first, second)
}

fn milliseconds(seconds: f64) -> String {
    format!("{:6.2}", seconds * 1000.0)
}

/// All figures, one per line.
pub fn in_full(figures: &LinkStatistics) -> String {
    LinkMessage::InFull {
        kbit_per_s: figures.kbit_per_s,
        requests_per_s: figures.transactions_per_s,
        median: figures.round_trip_median_s * 1000.0,
        most: figures.round_trip_p99_s * 1000.0,
        timeouts: figures.timeouts,
        crc_errors: figures.crc_errors,
        retries: figures.retries,
        stray: figures.stray_bytes,
        dropped: figures.dropped_samples,
    }
    .to_string()
}
