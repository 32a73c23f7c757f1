//! The window's own widgets, by role and label, and one small picture of them in both themes.

use brushwork_gui::model::indicator::IndicatorState;
use brushwork_gui::theme;
use brushwork_gui::widgets::numeric::Numeric;
use brushwork_gui::widgets::readout::Readout;
use brushwork_gui::widgets::setpoint::Setpoint;
use brushwork_gui::widgets::{indicator, stop, text_field};
use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme, Ui, vec2};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, HarnessBuilder, SnapshotResults};

const DUTY: Setpoint<'_> =
    Setpoint { name: "M1 duty", unit: "%", range: -100.0..=100.0, decimals: 1, step: 0.1 };

fn themed<State>(width: f32, height: f32) -> HarnessBuilder<State> {
    HarnessBuilder::default().with_size([width, height]).with_context_setup(theme::install)
}

fn slider(value: f64) -> Harness<'static, f64> {
    themed(600.0, 60.0).build_ui_state(
        |ui, value| {
            DUTY.ui(ui, value);
        },
        value,
    )
}

#[test]
fn arrow_keys_move_the_slider_by_its_step_and_by_ten_with_shift() {
    let mut harness = slider(0.0);
    harness.get_by_role_and_label(Role::Slider, "M1 duty").focus();
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    assert!((harness.state() - 0.1).abs() < 1e-9);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowLeft);
    harness.run();
    assert!((harness.state() + 0.9).abs() < 1e-9);
    harness.key_press(Key::PageUp);
    harness.run();
    assert!((harness.state() - 9.1).abs() < 1e-9);
    harness.key_press(Key::Home);
    harness.run();
    assert_eq!(*harness.state(), 0.0);
}

#[test]
fn dragging_the_rail_sets_whole_steps() {
    let mut harness = slider(0.0);
    let rail = harness.get_by_role_and_label(Role::Slider, "M1 duty").rect();
    harness.drag_at(rail.center());
    harness.run();
    harness.drop_at(rail.right_center() - vec2(1.0, 0.0));
    harness.run();
    assert_eq!(*harness.state(), 100.0);
}

#[test]
fn an_exact_number_counts_only_when_enter_is_pressed() {
    let mut harness = slider(0.0);
    harness.get_by_role_and_label(Role::SpinButton, "M1 duty exact").focus();
    harness.run();
    let field = harness.get_by_role_and_label(Role::SpinButton, "M1 duty exact");
    field.type_text("37.5");
    harness.run();
    assert_eq!(*harness.state(), 0.0, "nothing happens while typing");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(*harness.state(), 37.5);
}

#[test]
fn a_number_beyond_the_range_is_held_at_its_end() {
    let mut harness = slider(0.0);
    harness.get_by_role_and_label(Role::SpinButton, "M1 duty exact").focus();
    harness.run();
    harness.get_by_role_and_label(Role::SpinButton, "M1 duty exact").type_text("1e9");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(*harness.state(), 100.0);
}

#[test]
fn the_zero_button_goes_to_zero() {
    let mut harness = slider(42.0);
    harness.get_by_label("M1 duty to zero").click();
    harness.run();
    assert_eq!(*harness.state(), 0.0);
}

#[test]
fn stop_is_pressed_when_the_pointer_goes_down_and_only_once_per_press() {
    let mut harness = Harness::builder().with_size([200.0, 80.0]).build_ui_state(
        |ui, presses: &mut u32| {
            let response = stop::stop_ui(ui, true);
            *presses += u32::from(stop::pressed(&response));
        },
        0,
    );
    let at = harness.get_by_role_and_label(Role::Button, "Stop All").rect().center();
    harness.drag_at(at);
    harness.run();
    assert_eq!(*harness.state(), 1);
    harness.drop_at(at);
    harness.run();
    assert_eq!(*harness.state(), 1);
    harness.get_by_role_and_label(Role::Button, "Stop All").focus();
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(*harness.state(), 2);
}

#[test]
fn an_indicator_says_its_word() {
    let harness = Harness::new_ui(|ui| {
        indicator::abbreviated_ui(
            ui,
            vec2(60.0, 34.0),
            "M1OC",
            "Motor 1 over current",
            IndicatorState::Warning,
        );
        indicator::full_ui(ui, "ESTP", "Emergency stop", IndicatorState::Error, None);
    });
    harness.get_by_role_and_label(Role::Status, "M1OC: warning");
    harness.get_by_role_and_label(Role::Status, "Emergency stop: error");
}

#[test]
fn only_a_text_field_with_focus_takes_a_space() {
    let mut harness = Harness::new_ui_state(
        |ui, (text, number, taken): &mut (String, f64, bool)| {
            text_field::text_field_ui(ui, text, "Path", "");
            let range = 0.0..=1.0;
            Numeric { name: "Number", unit: "", range, decimals: 1, step: 0.1, width: 60.0 }.ui(ui, number);
            *taken = text_field::takes_space(ui.ctx());
        },
        (String::new(), 0.0, false),
    );
    assert!(!harness.state().2);
    harness.get_by_role_and_label(Role::TextInput, "Path").focus();
    harness.run();
    assert!(harness.state().2);
    harness.get_by_role_and_label(Role::SpinButton, "Number").focus();
    harness.run();
    assert!(!harness.state().2);
}

fn gallery_ui(ui: &mut Ui) {
    egui::Frame::central_panel(ui.style()).show(ui, |ui| {
        ui.horizontal(|ui| {
            let states = [
                IndicatorState::Unknown,
                IndicatorState::NotApplicable,
                IndicatorState::Ok,
                IndicatorState::Warning,
                IndicatorState::Error,
            ];
            for state in states {
                indicator::abbreviated_ui(ui, vec2(52.0, 36.0), "MBHI", "Main battery high", state);
            }
        });
        indicator::full_ui(ui, "ESTP", "Emergency stop", IndicatorState::Error, None);
        indicator::full_ui(ui, "TMP1", "Temperature 1", IndicatorState::Ok, None);
        ui.horizontal(|ui| {
            let readout = Readout { label: "M1 speed", unit: "counts/s", digits: 8, unit_letters: 6 };
            readout.ui(ui, Some("-12345"));
            readout.ui(ui, Some("7"));
            readout.ui(ui, None);
        });
        DUTY.ui(ui, &mut 37.5);
        stop::stop_ui(ui, true);
    });
}

#[test]
fn the_widgets_look_as_they_did() {
    let mut results = SnapshotResults::new();
    for (theme, name) in [(Theme::Dark, "widgets_dark"), (Theme::Light, "widgets_light")] {
        let mut harness = themed(460.0, 290.0)
            .with_theme(theme)
            .renderer(crate::support::cpu::Cpu::default())
            .build_ui(gallery_ui);
        harness.run();
        harness.snapshot(name);
        results.extend_harness(&mut harness);
    }
}
