//! The smallest family there can be, shown by the shared screens alone, in a window that has no other.

use crate::support::alone::{LIMIT, alone};
use crate::support::one::One;
use brushwork_gui::family::{Ability, Family as WindowFamily, Known, Sliders};
use brushwork_gui::model::general::Section;
use brushwork_gui::model::indicator::IndicatorInfo;
use brushwork_gui::model::screen::Screen;
use brushwork_gui::screens::face::Face;
use brushwork_link::FamilyRef;
use brushwork_link::device::{ArmScope, Channel, Drive, Identity, Request};
use brushwork_values::Motor;
use egui_kittest::kittest::Queryable as _;
use family::{CHANNELS, ECHO, Echo, EchoMachine, LOOP};

#[path = "../../../../tests/tests/program/echo/family.rs"]
#[allow(dead_code, reason = "shared with the tests of the program")]
mod family;

/// All that a window has to be told of it.
struct EchoWindow;

impl WindowFamily for EchoWindow {
    fn family(&self) -> FamilyRef {
        ECHO
    }

    fn name(&self) -> &'static str {
        "Echo"
    }

    fn screens(&self, _identity: Option<&Identity>, _known: Known<'_>) -> Vec<Screen> {
        vec![Screen::DeviceStatus, Screen::GeneralSettings, Screen::Velocity]
    }

    fn indicators(&self) -> &'static [IndicatorInfo] {
        &[IndicatorInfo { short: "HOT", title: "Too hot" }]
    }

    fn motors(&self, _: Option<&Identity>) -> &'static [Motor] {
        &[Motor::M1]
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn to_send(&self, _scope: ArmScope, sliders: Sliders) -> Option<Drive> {
        sliders.velocity.to_send()
    }

    fn lacks(&self, _ability: Ability) -> Option<&'static str> {
        Some("An echo has nothing but a speed.")
    }
}

impl Face for EchoWindow {}

type Bench = One<EchoMachine>;

fn speed(bench: &Bench) -> f64 {
    bench.line.with(|echo| echo.speed_counts_per_s)
}

#[test]
fn a_family_that_draws_nothing_itself_is_shown_by_the_shared_screens() {
    // The other tests' families are installed in their process.
    alone("echo::a_family_that_draws_nothing_itself_is_shown_by_the_shared_screens", LIMIT, show_it);
}

fn show_it() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let mut bench = Bench::new(&folder, (&Echo, &EchoWindow), EchoMachine::default(), "sim:echo-1");
    bench.app().open("sim:echo-1");
    bench.pass_ms(1500);
    assert!(bench.app().model.front.is_connected());
    let name = bench.app().model.front.link.identity().map(Identity::title).unwrap_or_default().to_owned();
    assert!(name.starts_with("Echo 1") && bench.sees(&name), "its name: {name}");
    assert_eq!(bench.app().model.front.link.indicators.named("HOT").word(), "OK");
    bench.app().model.turn_to(Screen::GeneralSettings);
    bench.app().model.front.general.turn_to(Section::Group(LOOP));
    bench.pass_ms(100);
    assert!(bench.sees("Gain"), "its one setting");
    bench.app().model.turn_to(Screen::Velocity);
    bench.pass_ms(100);
    let channels: Vec<String> = bench
        .app()
        .model
        .front
        .graph
        .live
        .channels
        .iter()
        .map(|channel| channel.info.label.clone())
        .collect();
    assert_eq!(channels, [Channel::M1_POSITION.label]);
    assert!(bench.sees(&format!("Show {}", Channel::M1_POSITION.label)), "its one channel");

    bench.app().device().expect("it is open").request(Request::Arm(ArmScope::Velocity)).expect("it has room");
    bench.pass_ms(100);
    bench.app().model.front.velocity.setpoints.set_one(Motor::M1, 100.0);
    bench.pass_ms(500);
    assert_eq!(speed(&bench), 100.0, "the window keeps it going");
    bench.harness.get_by_label("Stop All").click();
    bench.harness.step();
    bench.pass_ms(100);
    assert_eq!(speed(&bench), 0.0);

    bench.line.with(|echo| echo.is_hot = true);
    bench.pass_ms(1200);
    assert!(bench.sees("HOT: error"), "its one indicator");
}
