//! What is to be found out of an MCP or RoboClaw: its questions, how each is asked, and how its answer reads.
//!
//! The tables stand in [`table`]; each step has a file.

mod firmware;
mod guesses;
mod layout;
mod motor;
mod saving;
pub mod table;

use brushwork_family::examine::{Examination, Examiner, NotAskable, Step, if_answered};
use brushwork_family::messages::ExamineActMessage;
use brushwork_link::device::{Heard, Inquiry, JobContext, Leave};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::{Failure, FamilyRef};
use brushwork_mcp_client::{MCP, packet_address};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::Address;
use brushwork_values::Motor;

/// What examines an MCP or RoboClaw.
#[derive(Clone, Copy, Debug)]
pub struct McpExaminer;

impl Examiner for McpExaminer {
    fn family(&self) -> FamilyRef {
        MCP
    }

    fn steps(&self) -> &'static [Step] {
        table::STEPS
    }

    fn not_askable(&self) -> Vec<NotAskable> {
        table::not_askable()
    }

    fn ask(
        &self,
        step: &Step,
        motor: Motor,
        context: &mut JobContext<'_>,
        found: &mut Examination,
    ) -> Result<(), Failure> {
        let asked = match step.key {
            table::FIRMWARE => firmware::ask(context, found),
            table::GUESSES => guesses::ask(context, found),
            table::LAYOUT => layout::ask(context, found),
            table::SAVING => saving::ask(context, found),
            _ => {
                motor::ask(motor, context, found);
                Ok(())
            }
        };
        asked.map_err(|error| {
            error.failure(ExamineActMessage::TakeStep { title: step.title.to_owned() }, context.describe())
        })
    }
}

type Asked<T = ()> = Result<T, ExchangeError>;

/// The address that is spoken to.
fn address(context: &JobContext<'_>) -> Address {
    packet_address(context.address()).unwrap_or_default()
}

/// Bytes with their CRC.
fn with_crc(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(crc16_xmodem(&bytes).to_be_bytes());
    bytes
}

/// Asks in bytes, once.
fn hear(context: &mut JobContext<'_>, bytes: &[u8], leave: Leave) -> Asked<Heard> {
    context.inquire(&Inquiry { bytes, leave, retries: 0 })
}

/// "1, 5 and 7", or "none".
fn listed(numbers: &[u8]) -> String {
    let texts: Vec<String> = numbers.iter().map(u8::to_string).collect();
    match texts.split_last() {
        None => "none".to_owned(),
        Some((only, [])) => only.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}
