//! What a MotorVator has of its own in the window: its steppers, its servos and its terminal.

pub mod family;
pub mod search;
pub mod servos;
pub mod stepper;
pub mod terminal;

use brushwork_link::{Event, Identity};
use brushwork_motorvator_client::{Half, is_motorvator};

use crate::family::Own;
use crate::model::{Connection, Screen};
use servos::Servos;
use stepper::Stepper;
use terminal::Terminal;

/// The state of its screens.
#[derive(Debug, Default)]
pub struct MotorvatorConnection {
    pub stepper: Stepper,
    pub servos: Servos,
    pub terminal: Terminal,
    /// Which half of the board is selected.
    half: Option<Half>,
}

impl Own for MotorvatorConnection {
    fn take(&mut self, event: &Event) -> bool {
        if let Event::Selected { address, .. } = event {
            self.half = Half::of(*address);
        }
        self.terminal.note(event);
        let is_of_servos = self.servos.take(event);
        self.stepper.take(event, self.half) || is_of_servos
    }

    fn shows_unasked(&self, unit: &Identity, screen: Screen) -> bool {
        screen == Screen::Terminal && is_motorvator(unit)
    }

    fn rest(&mut self) {
        self.stepper.rest();
    }

    fn forget_unit(&mut self) {
        self.stepper = Stepper::default();
        self.servos.forget();
    }

    fn link_ended(&mut self) {
        self.stepper.give_up();
        self.servos.forget();
        self.terminal.link_ended();
    }

    fn not_sent(&mut self, id: u64) {
        self.terminal.lines.not_sent(id);
    }
}

impl Connection {
    /// What is kept of a MotorVator.
    pub fn motorvator(&self) -> &MotorvatorConnection {
        self.own()
    }

    pub fn motorvator_mut(&mut self) -> &mut MotorvatorConnection {
        self.own_mut()
    }
}
