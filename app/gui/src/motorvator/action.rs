//! What the terminal of a MotorVator asks for besides its lines.

use brushwork_link::device::RiskAccepted;
use brushwork_link::{Message, Request};

use crate::family_action::{FamilyAction, Host};

/// Starts the program in the board's memory: the user has seen what that means.
#[derive(Debug)]
pub struct StartProgram(pub RiskAccepted);

impl FamilyAction for StartProgram {
    fn act(&self, host: &mut dyn Host) -> Result<(), Message> {
        let id = host.model().front.id();
        // A refusal of the link is told by the window.
        host.request_of(id, Request::StartProgram(self.0));
        Ok(())
    }
}
