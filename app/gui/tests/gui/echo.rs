//! The smallest family there can be, shown by the shared screens alone, in a window that has no other.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use crate::support::alone::{LIMIT, alone};
use crate::support::cpu::Cpu;
use crate::support::line::Line;
use crate::support::lockstep::{Gate, Lockstep};
use brushwork_core::keep::{Keeping, Store};
use brushwork_core::session::SessionError;
use brushwork_gui::App;
use brushwork_gui::family::{Ability, Family as WindowFamily, Known, Sliders};
use brushwork_gui::model::general::Section;
use brushwork_gui::model::indicator::IndicatorInfo;
use brushwork_gui::model::screen::Screen;
use brushwork_gui::parts::{OpenLink, Opener, Parts, PortSource};
use brushwork_gui::screens::face::Face;
use brushwork_link::device::{
    Addresses, ArmScope, Channel, DeviceLoop, DeviceOptions, Drive, Identity, Request,
};
use brushwork_link::transport::{ConnectTarget, PortInfo};
use brushwork_link::{Clock as _, Failure, FamilyChoice, FamilyRef};
use brushwork_plant::machine::StreamIndex;
use brushwork_values::Motor;
use crossbeam_channel::{Receiver, bounded};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, HarnessBuilder};
use family::{CHANNELS, ECHO, Echo, EchoMachine, LOOP};

#[path = "../../../../tests/tests/program/echo/family.rs"]
#[allow(dead_code, reason = "shared with the tests of the program")]
mod family;

const FRAME: Duration = Duration::from_millis(20);

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

struct NoPorts;

impl PortSource for NoPorts {
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>> {
        None
    }
}

/// The loop of the link, once it is open.
type Slot = Rc<RefCell<Option<Lockstep>>>;

struct EchoOpener {
    line: Line<EchoMachine>,
    slot: Slot,
}

impl Opener for EchoOpener {
    fn open(&mut self, _: ConnectTarget, _: Addresses) -> Receiver<Result<OpenLink, SessionError>> {
        let options =
            DeviceOptions { family: FamilyChoice::of(ECHO), simulated: true, ..DeviceOptions::default() };
        let gate = Gate::new(self.line.clock.clone());
        let transport = Box::new(self.line.through(gate.clone()));
        let (device_loop, device) = DeviceLoop::new(transport, Arc::new(gate.clone()), options);
        *self.slot.borrow_mut() = Some(Lockstep::new(gate, device_loop));
        let (sender, receiver) = bounded(1);
        sender.send(Ok(OpenLink { device, bus: None, world: None })).expect("the receiver is here");
        receiver
    }
}

/// The window with its link in virtual time.
struct Bench {
    harness: Harness<'static, Option<App>>,
    line: Line<EchoMachine>,
    slot: Slot,
}

impl Bench {
    fn new(folder: &tempfile::TempDir) -> Self {
        brushwork_link::install(&[&Echo]);
        brushwork_gui::install(&[&EchoWindow]);
        let line = Line::of(EchoMachine::default(), StreamIndex::Usb, "sim:echo-1");
        let slot = Slot::default();
        let opener = Box::new(EchoOpener { line: line.clone(), slot: slot.clone() });
        let keeping = Keeping::new(Store::at(folder.path()));
        let mut parts = Some(Parts { ports: Box::new(NoPorts), opener, keeping });
        let harness = HarnessBuilder::default()
            .with_size([1280.0, 800.0])
            .with_step_dt(FRAME.as_secs_f32())
            .with_context_setup(brushwork_gui::theme::install)
            .renderer(Cpu::default())
            .build_ui_state(
                move |ui, slot: &mut Option<App>| {
                    let made = || App::new(ui.ctx(), parts.take().expect("the window is made once"));
                    slot.get_or_insert_with(made).contents(ui);
                },
                None,
            );
        Self { harness, line, slot }
    }

    fn app(&mut self) -> &mut App {
        self.harness.state_mut().as_mut().expect("the first frame made it")
    }

    fn pass_ms(&mut self, milliseconds: u64) {
        let end = self.line.clock.now() + Duration::from_millis(milliseconds);
        while self.line.clock.now() < end {
            let until = self.line.clock.now() + FRAME;
            match self.slot.borrow().as_ref() {
                Some(device_loop) => device_loop.run_until(until),
                None => self.line.clock.advance_to(until),
            }
            self.harness.step();
        }
    }

    fn sees(&self, part: &str) -> bool {
        self.harness.query_all_by_label_contains(part).next().is_some()
    }

    fn speed(&self) -> f64 {
        self.line.with(|echo| echo.speed_counts_per_s)
    }
}

#[test]
fn a_family_that_draws_nothing_itself_is_shown_by_the_shared_screens() {
    // The other tests' families are installed in their process.
    alone("echo::a_family_that_draws_nothing_itself_is_shown_by_the_shared_screens", LIMIT, show_it);
}

fn show_it() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let mut bench = Bench::new(&folder);
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
    assert_eq!(bench.speed(), 100.0, "the window keeps it going");
    bench.harness.get_by_label("Stop All").click();
    bench.harness.step();
    bench.pass_ms(100);
    assert_eq!(bench.speed(), 0.0);

    bench.line.with(|echo| echo.is_hot = true);
    bench.pass_ms(1200);
    assert!(bench.sees("HOT: error"), "its one indicator");
}
