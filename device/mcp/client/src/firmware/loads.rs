//! Firmware as shared code sends it.

use crate::firmware::error::{Left, SendError};
use crate::firmware::send::{Progress, Sent, send};
use brushwork_link::Message;
use brushwork_link::clock::Clock;
use brushwork_link::failure::Failure;
use brushwork_link::loader::Loads;
use brushwork_link::transport::Transport;
use brushwork_mcp_wire::loader::Image;

/// An image that is sent.
#[derive(Clone, Debug)]
pub struct Firmware(pub Image);

impl Loads for Firmware {
    type Progress = Progress;
    type Sent = Sent;

    fn send(
        &self,
        transport: &mut dyn Transport,
        clock: &dyn Clock,
        goes_on: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Sent, Failure> {
        send(transport, clock, &self.0, goes_on).map_err(|error| error.failure(transport.describe()))
    }

    fn cancelled() -> Message {
        Message::error(SendError::Cancelled)
    }

    fn nothing_sent() -> Message {
        Left::Untouched.remedy().into()
    }
}
