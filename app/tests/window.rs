//! The window against a simulated controller, in virtual time, by what a person reads and presses.

mod support;

use brushwork::gui::model::message::Gravity;
use brushwork::gui::model::screen::Screen;
use brushwork_protocol::packet_serial::Motor;
use brushwork_sim::world::WorldAction;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use std::time::Duration;
use support::bench::Bench;

#[test]
fn the_simulated_controller_is_in_the_list_and_connects() {
    let mut bench = Bench::new();
    assert!(bench.sees("Simulated MCP266: in this program, available"));
    bench.connect();
    assert!(bench.sees("Simulated MCP266: in this program, connected"));
    assert!(bench.sees("Model: MCP266 (simulated)"));
    assert!(bench.sees("M1OC: OK"));
    assert!(bench.sees_part("Main battery: 24.0 V"), "{:?}", bench.model().link.readings);
}
