//! Whether a controller runs its script by itself after power-up (MCP manual, commands 246 and 247).

use crate::TypedWire;
use crate::messages::{McpActMessage, McpCauseMessage};
use brushwork_link::device::Job;
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_link::messages::RemedyMessage;
use brushwork_link::wire::Wire;
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::name::DELAY;
use std::time::Duration;

/// A shorter delay switches autorun off (MCP manual, command 246).
pub const MIN_AUTORUN: Duration = Duration::from_millis(100);
/// A save restarts some units.
const LIMIT: Duration = Duration::from_secs(30);

/// When a script starts by itself after power-up; `None` for never.
pub type Autorun = Option<Duration>;

/// Reads it.
///
/// # Errors
/// The exchange failed.
pub fn read_autorun(wire: &mut dyn Wire) -> Result<Autorun, ExchangeError> {
    let reply = wire.ask(commands::READ_SCRIPT_AUTORUN, &[])?;
    let delay = Duration::from_millis(u64::try_from(reply.int(DELAY)).unwrap_or(0));
    Ok(Some(delay).filter(|delay| *delay >= MIN_AUTORUN))
}

/// Sets it in the controller's RAM and reads it back. It counts at the next power-up, so that it does nothing unless the settings are saved.
///
/// # Errors
/// The exchange failed, or the controller kept something else.
pub fn set_autorun(wire: &mut dyn Wire, autorun: Autorun) -> Result<(), Failure> {
    let failure =
        |error: &ExchangeError, wire: &dyn Wire| error.failure(McpActMessage::SetAutorun, wire.describe());
    let delay_ms = autorun.map_or(0, |delay| i64::try_from(delay.max(MIN_AUTORUN).as_millis()).unwrap_or(0));
    let written = wire.ask(commands::SET_SCRIPT_AUTORUN, &[delay_ms]);
    written.map_err(|error| failure(&error, wire))?;
    let kept = read_autorun(wire).map_err(|error| failure(&error, wire))?;
    let wanted = autorun.map(|delay| Duration::from_millis(delay.max(MIN_AUTORUN).as_millis() as u64));
    if kept == wanted {
        return Ok(());
    }
    let kept_ms = kept.map_or(0, |delay| delay.as_millis());
    let came_back = McpCauseMessage::AutorunKept { wanted_ms: delay_ms, kept_ms };
    Err(Failure::new(McpActMessage::SetAutorun, wire.describe(), came_back, RemedyMessage::TryAgain))
}

/// Sets it as a job. The settings are not saved by it.
#[must_use]
pub fn autorun_job(autorun: Autorun) -> Job<()> {
    Job::new(McpActMessage::SetAutorun, LIMIT, move |context| set_autorun(context, autorun))
}
