//! A window that has one family alone, with one machine of it on a line, in virtual time.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use brushwork_core::keep::{Keeping, Store};
use brushwork_core::session::SessionError;
use brushwork_gui::App;
use brushwork_gui::parts::{OpenLink, Opener, Parts, PortSource, SimulatedWorld};
use brushwork_gui::screens::face::Window;
use brushwork_link::device::{Addresses, DeviceLoop, DeviceOptions};
use brushwork_link::transport::{ConnectTarget, PortInfo};
use brushwork_link::{Clock as _, Driver, Failure, FamilyChoice};
use brushwork_plant::machine::{Machine, StreamIndex};
use crossbeam_channel::{Receiver, bounded};
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, HarnessBuilder, Node};

use super::cpu::Cpu;
use super::line::Line;
use super::lockstep::{Gate, Lockstep};

const FRAME: Duration = Duration::from_millis(20);

struct NoPorts;

impl PortSource for NoPorts {
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>> {
        None
    }
}

/// The loop of the link, once it is open.
type Slot = Rc<RefCell<Option<Lockstep>>>;

struct OneOpener<M: Machine + Send + 'static> {
    line: Line<M>,
    slot: Slot,
    family: FamilyChoice,
    world: Option<Arc<dyn SimulatedWorld>>,
}

impl<M: Machine + Send + 'static> Opener for OneOpener<M> {
    fn open(&mut self, _: ConnectTarget, addresses: Addresses) -> Receiver<Result<OpenLink, SessionError>> {
        let options =
            DeviceOptions { addresses, family: self.family, simulated: true, ..DeviceOptions::default() };
        let gate = Gate::new(self.line.clock.clone());
        let transport = Box::new(self.line.through(gate.clone()));
        let (device_loop, device) = DeviceLoop::new(transport, Arc::new(gate.clone()), options);
        *self.slot.borrow_mut() = Some(Lockstep::new(gate, device_loop));
        let (sender, receiver) = bounded(1);
        sender
            .send(Ok(OpenLink { device, bus: None, world: self.world.clone() }))
            .expect("the receiver is here");
        receiver
    }
}

/// The window with its link in virtual time.
pub struct One<M: Machine + Send + 'static> {
    pub harness: Harness<'static, Option<App>>,
    pub line: Line<M>,
    slot: Slot,
}

impl<M: Machine + Send + 'static> One<M> {
    /// A window that keeps its things in the folder.
    pub fn new(
        folder: &tempfile::TempDir,
        (driver, window): (&'static dyn Driver, &'static dyn Window),
        machine: M,
        target: &'static str,
    ) -> Self {
        Self::with_world(folder, (driver, window), machine, target, |_| None)
    }

    /// The same, where the world around the machine can be seen.
    pub fn with_world(
        folder: &tempfile::TempDir,
        (driver, window): (&'static dyn Driver, &'static dyn Window),
        machine: M,
        target: &'static str,
        world: impl FnOnce(Line<M>) -> Option<Arc<dyn SimulatedWorld>>,
    ) -> Self {
        brushwork_link::install(&[driver]);
        brushwork_gui::install(&[window]);
        let line = Line::of(machine, StreamIndex::Usb, target);
        let slot = Slot::default();
        let family = FamilyChoice::of(driver.family());
        let world = world(line.clone());
        let opener = Box::new(OneOpener { line: line.clone(), slot: slot.clone(), family, world });
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

    pub fn app(&mut self) -> &mut App {
        self.harness.state_mut().as_mut().expect("the first frame made it")
    }

    pub fn pass_ms(&mut self, milliseconds: u64) {
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

    pub fn sees(&self, part: &str) -> bool {
        self.harness.query_all_by_label_contains(part).next().is_some()
    }

    /// Clicks what has this label.
    pub fn press(&mut self, label: &str) {
        let is_meant = |node: &Node<'_>| node.accesskit_node().role() != Role::Label;
        let node = self.harness.query_all_by_label(label).find(is_meant);
        node.unwrap_or_else(|| panic!("there is no {label} to be clicked")).click();
        self.harness.step();
        self.pass_ms(100);
    }
}
