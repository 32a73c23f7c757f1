//! A few small pictures of the whole window, drawn on the CPU, at the smallest size it has to work at.
//!
//! What they show is fed by hand, event by event, so that they change only when the window does.
//! After a wanted change: `UPDATE_SNAPSHOTS=1 cargo test -p brushwork-gui --test gui pictures::`, then look at them.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_core::tune::file;
use brushwork_gui::messages::WindowCauseMessage;
use brushwork_gui::model::drawer::Tab;
use brushwork_gui::model::screen::Screen;
use brushwork_gui::model::{Model, Phase};
use brushwork_gui::tune::Loop;
use brushwork_gui::tune::looked_at::Kind;
use brushwork_link::device::{ArmScope, Channel, Event, Identity, Sample, StatusReport};
use brushwork_link::exchange::LinkStatistics;
use brushwork_link::transport::Stream;
use brushwork_mcp_client::indicators::indicators;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_values::Motor;
use egui::Theme;

const SMALLEST: [f32; 2] = [1024.0, 700.0];

brushwork_values::messages! {
    /// What else drives a motor in the pictures.
    enum PictureMessage {
        OtherDriver "Input pin 3 can also drive motor 1.",
    }
}

fn picture(mut bench: Bench, name: &str) {
    bench.harness.set_render_cursor(false);
    bench.pass_ms(200);
    bench.harness.snapshot(name);
}

/// A unit that has answered, with the status word given.
fn fed(model: &mut Model, word: u32) {
    model.front.target = Some("sim:mcp266".to_owned());
    model.front.phase = Phase::Open { target: "sim:mcp266".to_owned() };
    let identity = Identity {
        family: brushwork_mcp_client::MCP,
        address: 0x80,
        protocol: "packet serial",
        version_text: "MCP266 2x60A v1.0.0".to_owned(),
        model: Some("MCP266"),
        firmware: "1.0.0".to_owned(),
        generation: brushwork_mcp_client::firmware_of(Generation::Gen1),
        facts: brushwork_link::device::Facts::new(brushwork_mcp_client::McpFacts {
            generation: Generation::Gen1,
            is_mcp: true,
            is_node: false,
            motors: 2,
        }),
        also_answers: vec![0x81],
        simulated: true,
        port: "sim:mcp266".to_owned(),
        notes: Vec::new(),
    };
    let status = StatusReport::new(0x80, Duration::ZERO, word, indicators(Generation::Gen1));
    let figures = LinkStatistics { kbit_per_s: 5.8, transactions_per_s: 70.0, ..LinkStatistics::default() };
    for event in [
        Event::Connected(identity),
        Event::Selected { address: 0x80, stream: Some(Stream::Usb) },
        Event::Status(status),
        Event::Link(figures),
    ] {
        model.front.take(event);
    }
    for tick in 0..110 {
        let sample = sample(Duration::from_millis(100) * tick);
        model.front.graph.take(&sample);
        model.front.link.take(Event::Sample(Box::new(sample)));
    }
}

/// What two motors on a slow sine would give.
fn sample(at: Duration) -> Sample {
    let mut sample = Sample::new(0x80);
    let turn = at.as_secs_f64();
    let readings = [
        (Channel::M1_PWM, 60.0 * turn.sin()),
        (Channel::M1_VELOCITY, 6300.0 * (turn - 0.3).sin()),
        (Channel::M1_POSITION, -6300.0 * turn.cos()),
        (Channel::M1_CURRENT, turn.cos() * 0.8),
        (Channel::M2_PWM, 0.0),
        (Channel::M2_POSITION, -2_147_483_648.0),
        (Channel::M2_CURRENT, -12.34),
        (Channel::TEMPERATURE_1, 41.2),
        (Channel::MAIN_BATTERY, 24.1),
        (Channel::LOGIC_BATTERY, 12.0),
    ];
    for (channel, value) in readings {
        sample.set(channel, value, at, at);
    }
    sample
}

#[test]
fn the_window_before_a_controller_is_connected() {
    let bench = Bench::sized(SMALLEST, Theme::Light);
    bench.plug_in_port("/dev/ttyACM0");
    picture(bench, "not_connected");
}

#[test]
fn the_status_screen_with_an_error_a_warning_and_a_failure_to_read() {
    let mut bench = Bench::sized(SMALLEST, Theme::Light);
    fed(bench.model(), 0x1004);
    let text = "Could not set the encoder on 0x80 at /dev/ttyACM0: no answer within 60 ms (3 tries). \
                Check the cable and the power.";
    bench.model().messages.fail(WindowCauseMessage::Said { text: text.to_owned() });
    picture(bench, "status");
}

#[test]
fn the_pwm_screen_while_it_is_armed() {
    let mut bench = Bench::sized(SMALLEST, Theme::Dark);
    let model = bench.model();
    fed(model, 0);
    model.turn_to(Screen::Pwm);
    model.front.link.take(Event::Armed {
        address: 0x80,
        scope: ArmScope::Pwm,
        controller_timeout: Some(Duration::from_secs(1)),
        warnings: vec![PictureMessage::OtherDriver.into()],
    });
    model.front.pwm.set_duty(Motor::M1, 55.5);
    picture(bench, "pwm");
}

/// Guided tuning with a report of `tests/reports` shown: what it is made of does not change with the tuner.
fn tuning(name: &str, theme: Theme) -> Bench {
    let mut bench = Bench::sized([1280.0, 800.0], theme);
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reports").join(name);
    let report = file::read(&path).expect("it is in the repository");
    let model = bench.model();
    fed(model, 0);
    model.screen = Screen::Velocity;
    model.front.drawers.press(Screen::Velocity, Tab::Tune);
    model.front.tune.panel_mut(Loop::Velocity, Motor::M1).add(report);
    model.front.tune.view.kind = Kind::Step;
    bench
}

#[test]
fn guided_tuning_with_a_result_in_the_dark() {
    picture(tuning("tuned.json", Theme::Dark), "tuned_dark");
}

#[test]
fn guided_tuning_with_a_result_in_the_light() {
    picture(tuning("tuned.json", Theme::Light), "tuned_light");
}

#[test]
fn guided_tuning_with_a_refusal_in_the_dark() {
    picture(tuning("refused.json", Theme::Dark), "refused_dark");
}

#[test]
fn guided_tuning_with_a_refusal_in_the_light() {
    picture(tuning("refused.json", Theme::Light), "refused_light");
}

#[test]
fn a_wheel_a_drag_and_a_pinch_leave_a_chart_where_it_is() {
    let mut bench = tuning("tuned.json", Theme::Dark);
    bench.harness.set_render_cursor(false);
    bench.pass_ms(200);
    let before = bench.harness.render().expect("a picture");
    let at = egui::pos2(900.0, 450.0);
    bench.harness.hover_at(at);
    bench.pass_ms(200);
    assert!(bench.harness.render().expect("a picture") != before, "the values under the pointer are shown");
    for button in [egui::PointerButton::Primary, egui::PointerButton::Secondary] {
        let modifiers = egui::Modifiers::NONE;
        bench.harness.event(egui::Event::PointerButton { pos: at, button, pressed: true, modifiers });
        bench.pass_ms(100);
        bench.harness.hover_at(at + egui::vec2(80.0, 40.0));
        bench.pass_ms(100);
        bench.harness.event(egui::Event::PointerButton { pos: at, button, pressed: false, modifiers });
    }
    for event in [
        egui::Event::Zoom(1.5),
        egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: egui::vec2(30.0, -60.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: egui::Modifiers::NONE,
        },
    ] {
        bench.harness.event(event);
        bench.pass_ms(200);
    }
    bench.harness.event(egui::Event::PointerGone);
    bench.pass_ms(500);
    assert!(bench.harness.render().expect("a picture") == before, "the chart has moved");
}
