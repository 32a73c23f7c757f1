//! How much of the window the graph has, on each screen that has one, and that nothing moves under a hand.

use crate::support::bench::Bench;
use brushwork_gui::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use brushwork_gui::model::Screen;
use brushwork_link::Failure;
use brushwork_link::device::{ArmScope, Event};
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use egui::accesskit::Role;
use egui::{Key, Rect, vec2};
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// What the graph has to have of the window's height at first.
const PART: f32 = 0.45;
/// Where the screens begin.
const LEFT_PANEL: f32 = 224.0;
/// What the bar above it is called.
const BAR: &str = "Height of the graph: ";

brushwork_values::messages! {
    /// What stands in the way of arming in these tests.
    enum NoticeMessage {
        Pin "Input pin 3 can also drive motor 1.",
        Script "A script may drive both motors.",
    }
}

/// From the bar above the graph's buttons to the end of the plot with its times.
fn graph_height(bench: &Bench) -> f32 {
    bar(bench).map_or(0.0, |bar| plot(bench).bottom() - bar.bottom())
}

fn bar(bench: &Bench) -> Option<Rect> {
    splitter(bench).map(|node| node.rect())
}

/// The panels at the sides have such bars too.
fn splitter(bench: &Bench) -> Option<Node<'_>> {
    let mut bars = bench.harness.query_all_by_role(Role::Splitter);
    bars.find(|node| node.accesskit_node().label().is_some_and(|label| label.starts_with(BAR)))
}

fn plot(bench: &Bench) -> Rect {
    let starts = ["Live graph of the last", "Graph, paused", "Graph of "];
    let is_plot = |label: &str| starts.iter().any(|start| label.starts_with(start));
    bench.harness.get_by(|node| node.label().is_some_and(|label| is_plot(&label))).rect()
}

/// Where everything stands that can be pressed, dragged or typed into above the graph.
fn places(bench: &Bench) -> Vec<(String, Rect)> {
    let bottom = bar(bench).expect("a graph").top();
    let roles = [Role::Button, Role::CheckBox, Role::Slider, Role::SpinButton, Role::Switch, Role::TextInput];
    let nodes = bench.harness.query_all_by(|_| true);
    let held = nodes.filter(|node| roles.contains(&node.accesskit_node().role()));
    let placed = held.map(|node| (node.accesskit_node().label().unwrap_or_default(), node.rect()));
    placed.filter(|(_, rect)| rect.bottom() < bottom && rect.left() > LEFT_PANEL).collect()
}

/// The switch changes its name; everything stays where it was.
#[track_caller]
fn assert_stays(before: &[(String, Rect)], after: &[(String, Rect)], screen: &str) {
    for (name, rect) in before {
        let is_there = after.iter().any(|(_, now)| now.min.distance(rect.min) < 0.5);
        assert!(is_there, "{screen}: {name} at {rect:?} moved: {after:?}");
    }
}

#[test]
fn the_graph_has_at_first_almost_half_of_the_window_on_every_screen_that_drives_and_on_the_status() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(2000);
    for screen in [Screen::DeviceStatus, Screen::Pwm, Screen::Velocity, Screen::Position] {
        bench.press(screen.title());
        bench.pass_ms(500);
        let part = graph_height(&bench) / 800.0;
        assert!(part >= PART, "{screen:?}: {part}");
        assert!(plot(&bench).height() >= 280.0, "{screen:?}: {}", plot(&bench).height());
    }
    let mut bench = Bench::with_minds(vec![MotionMindConfig::new(Mode::SerialPid)]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(2000);
    for title in ["Device Status", "Velocity", "Position"] {
        bench.press(title);
        bench.pass_ms(500);
        let part = graph_height(&bench) / 800.0;
        assert!(part >= PART, "{title}: {part}");
    }
}

#[test]
fn the_bar_is_dragged_and_moved_by_keys_and_each_screen_keeps_its_own() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    let at_first = graph_height(&bench);
    let from = bar(&bench).expect("a bar").center();
    bench.harness.drag_at(from);
    bench.pass_ms(100);
    for way in [20.0, 40.0, 60.0] {
        bench.harness.hover_at(from - vec2(0.0, way));
        bench.pass_ms(100);
    }
    bench.harness.drop_at(from - vec2(0.0, 60.0));
    bench.pass_ms(200);
    assert!((graph_height(&bench) - at_first - 60.0).abs() < 3.0, "{at_first} {}", graph_height(&bench));
    let dragged = graph_height(&bench);
    bench.press("PWM Settings");
    bench.pass_ms(300);
    assert!((graph_height(&bench) - at_first).abs() < 40.0, "another screen has its own");
    bench.press("Velocity Settings");
    bench.pass_ms(300);
    assert!((graph_height(&bench) - dragged).abs() < 1.0, "{dragged} {}", graph_height(&bench));
    splitter(&bench).expect("a bar").focus();
    bench.pass_ms(200);
    bench.key(Key::ArrowDown);
    bench.key(Key::ArrowDown);
    bench.pass_ms(200);
    assert!(graph_height(&bench) < dragged - 15.0, "{dragged} {}", graph_height(&bench));
    bench.key(Key::Home);
    bench.pass_ms(300);
    assert!((graph_height(&bench) - at_first).abs() < 1.0, "as at first: {}", graph_height(&bench));
}

#[test]
fn a_double_click_on_the_bar_brings_back_the_usual_height_and_two_slow_clicks_do_not() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    let at_first = graph_height(&bench);
    splitter(&bench).expect("a bar").focus();
    bench.pass_ms(200);
    for _ in 0..5 {
        bench.key(Key::ArrowUp);
    }
    bench.pass_ms(200);
    let moved = graph_height(&bench);
    assert!(moved > at_first + 20.0, "{at_first} {moved}");
    for (between_ms, is_reset) in [(1500, false), (300, true)] {
        splitter(&bench).expect("a bar").click();
        bench.pass_ms(between_ms);
        splitter(&bench).expect("a bar").click();
        bench.pass_ms(300);
        let now = graph_height(&bench);
        assert_eq!((now - at_first).abs() < 1.0, is_reset, "{between_ms} ms apart: {at_first} {moved} {now}");
        bench.pass_ms(1500);
    }
}

#[test]
fn arming_and_what_it_warns_of_moves_nothing_that_can_be_held() {
    for screen in ["PWM Settings", "Velocity Settings", "Position Settings"] {
        let mut bench = Bench::new();
        bench.connect();
        bench.press(screen);
        bench.pass_ms(1500);
        let before = places(&bench);
        assert!(before.len() > 12, "{before:?}");
        let scope = bench.model().screen.arm_scope().expect("it drives");
        let warnings = vec![NoticeMessage::Pin.into(), NoticeMessage::Script.into()];
        let armed = Event::Armed { address: 0x80, scope, controller_timeout: None, warnings };
        bench.model().front.link.take(armed);
        bench.harness.step();
        bench.harness.step();
        assert!(bench.sees_part("Input pin 3 can also drive motor 1."));
        assert_stays(&before, &places(&bench), screen);
        assert!(graph_height(&bench) > 250.0, "{}", graph_height(&bench));
    }
}

#[test]
fn one_click_makes_the_graph_large_and_one_gives_it_a_window_of_its_own() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    let at_first = plot(&bench).height();
    bench.press("Large graph");
    assert!(plot(&bench).height() > at_first + 60.0 && bench.sees("Arm"));
    bench.press("Large graph");
    assert!((plot(&bench).height() - at_first).abs() < 1.0);
    bench.press("Graph in its own window");
    assert!(bench.sees("The graph stands in a window of its own."));
    assert!(bench.sees("M1 speed exact"), "the sliders have the screen");
    // Whatever screen is open, it stays.
    bench.press("General Settings");
    bench.pass_ms(500);
    assert!(plot(&bench).height() > 200.0);
    bench.press("Put it back");
    assert!(!bench.model().front.graph.detached);
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    assert!((plot(&bench).height() - at_first).abs() < 1.0);
}

#[test]
fn a_refusal_to_arm_is_read_on_the_screen_and_moves_nothing_either() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("PWM Settings");
    bench.pass_ms(1500);
    let before = places(&bench);
    let because = WindowCauseMessage::Said { text: "no time-out is set".to_owned() };
    let remedy = WindowRemedyMessage::ConnectAgain;
    bench.model().front.link.refusals =
        vec![Failure::new(WindowActMessage::Connect, "the test", because, remedy)];
    bench.harness.step();
    bench.harness.step();
    assert!(bench.sees_part("no time-out is set"));
    assert_stays(&before, &places(&bench), "PWM Settings");
    assert_eq!(bench.model().screen.arm_scope(), Some(ArmScope::Pwm));
}
