//! Erasing the script memory and writing an image into it, block by block.

use crate::TypedWire;
use crate::messages::{McpActMessage, McpCauseMessage, McpRemedyMessage};
use crate::packet::typed;
use crate::script::autorun::{Autorun, read_autorun};
use crate::script::image::{Origin, ScriptImage};
use brushwork_link::device::Job;
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_link::wire::Wire;
use brushwork_mcp_wire::packet_serial::name::STATUS;
use brushwork_mcp_wire::packet_serial::{Read, Typed, commands};
use brushwork_mcp_wire::script_image::Block;
use brushwork_values::Value;
use std::collections::BTreeSet;
use std::time::Duration;

/// The key under which a simulated controller tells the CRC-16 of what its script memory holds
/// ([`HiddenSettings`](brushwork_link::HiddenSettings)).
pub const CHECKSUM_KEY: &str = "script.checksum";
/// Key of the erase command (public clients, 2015-2020).
const ERASE_KEY: i64 = 0x55AA;
/// How often a block is sent again whose answer did not come. The same bytes at the same place do no harm.
const BLOCK_TRIES: u32 = 4;
/// Blocks between two reports of progress.
const REPORT_EVERY: usize = 16;
/// Second byte of the answers to 250 and 251 of a simulated controller that has done its work. What a real one says is not public.
const STATUS_DONE: i64 = 0xFF;

/// A download that was completed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Downloaded {
    /// Bytes of the image.
    pub bytes: usize,
    /// Blocks sent.
    pub blocks: usize,
    /// How long it took.
    pub took: Duration,
    /// How far it is known to have arrived.
    pub verified: Verified,
    /// When the controller will run it by itself; as it was set before.
    pub autorun: Autorun,
    /// Whether a simulated controller will refuse to run it.
    pub is_foreign: bool,
}

/// How far an image is known to have arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verified {
    /// The controller holds it: its checksum was compared past the wire, in this program.
    Content,
    /// Each block was answered with status FF, "done" among simulated controllers.
    Status,
    /// Each block was acknowledged and answered alike with this byte, whose meaning is not public. No command reads an image back.
    Alike(u8),
}

/// Downloads as a job. `simulated_elsewhere`: the user says that the controller is simulated by another program.
#[must_use]
pub fn download_job(image: ScriptImage, simulated_elsewhere: bool) -> Job<Downloaded> {
    Job::new(McpActMessage::DownloadScript, image.download_limit(), move |context| {
        let is_simulated = context.is_simulated() || simulated_elsewhere;
        download(context, &image, is_simulated)
    })
}

/// Stops the script, erases the memory, writes the image and verifies it as far as that can be done. The script is not started.
///
/// # Errors
/// The image is not for this controller, in which case nothing was sent; or why it broke, and what that leaves.
pub fn download(wire: &mut dyn Wire, image: &ScriptImage, is_simulated: bool) -> Result<Downloaded, Failure> {
    if let Some((came_back, remedy)) = image.objection(is_simulated) {
        return Err(Failure::new(McpActMessage::DownloadScript, wire.describe(), came_back, remedy));
    }
    let begun_at = wire.now();
    wire.report_progress(0, 0, "stopping the script");
    let untouched =
        |error: ExchangeError, wire: &dyn Wire| error.failure(McpActMessage::DownloadScript, wire.describe());
    wire.ask(commands::STOP_SCRIPT, &[]).map_err(|error| untouched(error, wire))?;
    let autorun = read_autorun(wire).map_err(|error| untouched(error, wire))?;
    wire.report_progress(0, 0, "erasing the script memory");
    let mut sending = Sending { statuses: BTreeSet::new(), autorun, is_simulated };
    sending.erase(wire)?;
    let blocks = image.blocks();
    let count = blocks.len();
    for (index, block) in blocks.enumerate() {
        if index % REPORT_EVERY == 0 {
            wire.report_progress(index, count, &format!("writing block {} of {count}", index + 1));
        }
        sending.write(wire, &block)?;
    }
    wire.report_progress(count, count, "verifying");
    let verified = sending.verify(wire, image)?;
    Ok(Downloaded {
        bytes: image.len(),
        blocks: count,
        took: wire.now().saturating_sub(begun_at),
        verified,
        autorun,
        is_foreign: image.origin() == Origin::Foreign,
    })
}

/// What is learned on the way.
struct Sending {
    /// Status bytes of the blocks.
    statuses: BTreeSet<u8>,
    autorun: Autorun,
    is_simulated: bool,
}

impl Sending {
    fn erase(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        let reply = repeated(wire, commands::ERASE_SCRIPT, || vec![Value::Int(ERASE_KEY)]);
        let values = reply
            .map_err(|error| self.left(wire, McpCauseMessage::BrokeErasing { cause: error.message() }))?;
        self.check(wire, values.int(STATUS), |status| McpCauseMessage::EraseStatus { status })
    }

    fn write(&mut self, wire: &mut dyn Wire, block: &Block) -> Result<(), Failure> {
        let values = || vec![Value::Int(block.address.into()), Value::Bytes(block.wire_bytes().to_vec())];
        let address = block.address;
        let reply = repeated(wire, commands::WRITE_SCRIPT, values);
        let broken = |cause| McpCauseMessage::BrokeWriting { address, cause };
        let values = reply.map_err(|error| self.left(wire, broken(error.message())))?;
        let status = values.int(STATUS);
        self.statuses.insert(status as u8);
        self.check(wire, status, |status| McpCauseMessage::BlockStatus { address, status })
    }

    /// A simulated controller says plainly what it did.
    fn check(
        &self,
        wire: &dyn Wire,
        status: i64,
        refused: impl FnOnce(i64) -> McpCauseMessage,
    ) -> Result<(), Failure> {
        if !self.is_simulated || status == STATUS_DONE {
            return Ok(());
        }
        Err(self.left(wire, refused(status)))
    }

    fn verify(&self, wire: &dyn Wire, image: &ScriptImage) -> Result<Verified, Failure> {
        let held = wire.hidden_settings().and_then(|hidden| hidden.get(wire.address(), CHECKSUM_KEY));
        if let Some(held) = held {
            return if held == i64::from(image.checksum()) {
                Ok(Verified::Content)
            } else {
                Err(self.left(wire, McpCauseMessage::HoldsSomethingElse))
            };
        }
        let mut statuses = self.statuses.iter();
        match (statuses.next(), statuses.next()) {
            (Some(status), None) if self.is_simulated && i64::from(*status) == STATUS_DONE => {
                Ok(Verified::Status)
            }
            (Some(status), None) => Ok(Verified::Alike(*status)),
            _ => Err(self.left(wire, McpCauseMessage::DifferentStatuses)),
        }
    }

    fn left(&self, wire: &dyn Wire, came_back: McpCauseMessage) -> Failure {
        let remedy = match self.autorun {
            Some(delay) => McpRemedyMessage::DownloadAgainAutorun { delay_ms: delay.as_millis() },
            None => McpRemedyMessage::DownloadAgain,
        };
        Failure::new(McpActMessage::DownloadScript, wire.describe(), came_back, remedy)
    }
}

/// Sends a command again whose answer did not come, which the exchange itself does not do with what works on memory.
fn repeated<const L: u8>(
    wire: &mut dyn Wire,
    command: Typed<L>,
    values: impl Fn() -> Vec<Value>,
) -> Result<Read<L>, ExchangeError> {
    let mut tries = 1;
    loop {
        match wire.transact_values(command.number(), values()).and_then(|values| typed(command, values)) {
            Err(error) if tries < BLOCK_TRIES && is_lost_answer(&error) => tries += 1,
            done => return done,
        }
    }
}

fn is_lost_answer(error: &ExchangeError) -> bool {
    error.interruption().is_none() && !error.is_link_lost() && error.is_unusable_answer()
}
