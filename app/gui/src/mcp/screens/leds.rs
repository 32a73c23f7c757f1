//! The three LEDs of the board with their blink code, live and in words (MCP manual 1.6).
//!
//! A simulated controller's are shown as it lights them. A real one does not tell: its LEDs are derived from the status word
//! and the PWM outputs.

use std::time::Duration;

use brushwork_link::device::Channel;
use brushwork_mcp_client::indicators::conditions;
use brushwork_mcp_wire::packet_serial::led::{BlinkCode, Light, blink_code};
use egui::{Align2, Color32, RichText, Role, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2};

use crate::mcp::messages::McpScreenMessage;
use crate::model::connection::Connection;
use crate::theme::Palette;
use crate::widgets::heading::heading_ui;

const LED_WIDTH: f32 = 92.0;
const HEIGHT: f32 = 30.0;
/// How often a simulated controller's LEDs are looked at while one of them blinks.
const LOOK_INTERVAL: Duration = Duration::from_millis(100);
/// While data comes in, STAT1 goes dark and bright again in this time.
const DATA_BLINK: Duration = Duration::from_millis(400);

pub fn leds_ui(ui: &mut Ui, connection: &Connection) {
    heading_ui(ui, "LEDs on the board");
    let Some(code) = code(connection) else { return };
    let now = Duration::try_from_secs_f64(ui.input(|input| input.time)).unwrap_or_default();
    let real = lit_by_simulation(connection);
    let lit = real.unwrap_or_else(|| {
        // Frames come with the data anyway: this asks for none of its own.
        let receiving = connection.link.statistics.transactions_per_s > 0.0 && code.err != Light::Lit;
        let dark = receiving && now.as_millis() % DATA_BLINK.as_millis() < DATA_BLINK.as_millis() / 4;
        [
            code.stat1.is_lit(now) && !(dark && code.stat1 == Light::Lit),
            code.stat2.is_lit(now),
            code.err.is_lit(now),
        ]
    });
    let lights = [("STAT1", code.stat1), ("STAT2", code.stat2), ("ERR", code.err)];
    ui.horizontal(|ui| {
        for ((name, light), lit) in lights.into_iter().zip(lit) {
            led_ui(ui, name, light, lit);
        }
    });
    ui.label(format!("{}.", sentence(&code)));
    let source = match real {
        Some(_) => "As the simulated controller lights them.",
        None => "Derived from the status word and the PWM outputs: the controller does not tell its LEDs.",
    };
    ui.label(RichText::new(source).small().weak());
    let next = lights.into_iter().filter_map(|(_, light)| light.changes_in(now)).min();
    if let Some(next) = next {
        ui.ctx().request_repaint_after(if real.is_some() { LOOK_INTERVAL } else { next });
    }
}

fn code(connection: &Connection) -> Option<BlinkCode> {
    let status = connection.link.status?;
    let driving = [Channel::M1_PWM, Channel::M2_PWM]
        .into_iter()
        .any(|channel| connection.link.readings.get(channel).is_some_and(|duty| duty != 0.0));
    Some(blink_code(conditions(&status), driving))
}

/// Which LEDs a controller that is simulated in this program has lit.
fn lit_by_simulation(connection: &Connection) -> Option<[bool; 3]> {
    connection.link.identity().filter(|identity| identity.simulated)?;
    let leds = connection.worlds.as_ref()?.get(connection.world_unit)?.leds?;
    Some([leds.stat1, leds.stat2, leds.err])
}

/// "ERR flashes 3 times: logic battery high: the motors freewheel until a restart".
fn sentence(code: &BlinkCode) -> String {
    let err = code.err.words();
    let bridge = if code.stat2 == Light::Lit { "a bridge drives" } else { "no bridge drives" };
    McpScreenMessage::Leds {
        err,
        meaning: code.meaning.to_string(),
        bridge,
        stat2: code.stat2.words(),
        stat1: stat1(code),
    }
    .to_string()
}

fn stat1(code: &BlinkCode) -> String {
    match code.stat1 {
        Light::Lit if code.err != Light::Lit || code.stat2 != Light::Lit => {
            "lit, going dark for a moment with each byte received".to_owned()
        }
        light @ (Light::Dark | Light::Lit | Light::Flashes(_) | Light::TakesTurns { .. }) => light.words(),
    }
}

fn led_ui(ui: &mut Ui, name: &str, light: Light, lit: bool) {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(LED_WIDTH, HEIGHT), Sense::hover());
    let words = light.words();
    response.widget_info(|| {
        WidgetInfo::labeled(
            Role::Status,
            true,
            McpScreenMessage::Led { name: name.to_string(), light: words.to_string() }.to_string(),
        )
    });
    let color = if name == "ERR" { palette.error } else { palette.ok };
    let center = pos2(rect.left() + 14.0, rect.center().y);
    let fill = if lit { color } else { Color32::TRANSPARENT };
    ui.painter().circle(center, 7.0, fill, Stroke::new(1.5, if lit { color } else { palette.weak_text }));
    let font = TextStyle::Body.resolve(ui.style());
    ui.painter().text(pos2(rect.left() + 28.0, center.y), Align2::LEFT_CENTER, name, font, palette.text);
    response.on_hover_text(format!("{name}: {words}"));
}
