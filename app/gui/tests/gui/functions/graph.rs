//! The graph of each drive screen: divisions, scale, channels, clear.

use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::Row;
use crate::support::bench::Bench;

pub fn play(bench: &mut Bench, row: &Row, name: &str) {
    match name {
        "channel" => {
            let label = row.label.trim_start_matches("Show ");
            let shown = |bench: &mut Bench| {
                let channels = &bench.model().front.graph.live.channels;
                channels.iter().find(|channel| channel.info.label == label).map(|channel| channel.shown)
            };
            let before = shown(bench).unwrap_or_else(|| panic!("no channel {label}"));
            bench.harness.get_by_role_and_label(Role::CheckBox, row.label).scroll_to_me();
            bench.pass_ms(300);
            bench.press(row.label);
            assert_eq!(shown(bench), Some(!before), "{row:?}");
            bench.press(row.label);
            assert_eq!(shown(bench), Some(before), "{row:?}");
        }
        "graph_scale" => {
            let scale = |bench: &mut Bench| {
                let live = &bench.model().front.graph.live;
                format!("{:?}", live.channels[live.selected].scale)
            };
            bench.pass_ms(1000);
            select(bench, "M1 PWM");
            let before = scale(bench);
            bench.press(row.label);
            assert_ne!(scale(bench), before, "the channel was at rest, so its own range is smaller");
        }
        "graph_clear" => {
            bench.pass_ms(500);
            select(bench, "M1 PWM");
            bench.press(row.label);
            let live = &bench.model().front.graph.live;
            assert!(live.channels[live.selected].cleared_at_s > 0.0, "{row:?}");
        }
        _ => {
            bench.pass_ms(5000);
            // 100 ms update: ten samples a second, each kept with its time; one-second divisions: ten in view.
            assert!(bench.sees_part("10.0 samples/s"));
            let node =
                bench.harness.get_by_label(row.label).accesskit_node().description().unwrap_or_default();
            let live = &bench.model().front.graph.live;
            assert!((live.span_s() - 10.0).abs() < 1e-9);
            assert!(node.contains("1 s") || live.newest_s() > 4.0, "{node}");
        }
    }
}

/// Selects a channel by its row in the list.
fn select(bench: &mut Bench, channel: &str) {
    let start = format!("{channel}: ");
    let row = bench.harness.query_all_by_label_contains(&start).find(|node| {
        let node = node.accesskit_node();
        node.role() == Role::Button && node.label().is_some_and(|label| label.starts_with(&start))
    });
    row.unwrap_or_else(|| panic!("no row of {channel}")).click();
    bench.pass_ms(300);
}
