//! What a unit of packet serial says of its motors before a move.

use brushwork_link::device::{DeviceHandle, Event, Request};
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::name::QPPS;
use brushwork_values::Motor;

use crate::client::{ask, wait};
use crate::exit::Exit;
use crate::interrupt::Interrupt;

/// The motor's own full speed: of both motors, the slower one's.
pub fn qpps(motors: &[Motor], device: &DeviceHandle, interrupt: &Interrupt) -> Result<u32, Exit> {
    let mut slowest = u32::MAX;
    for motor in motors {
        let command = match motor {
            Motor::M1 => commands::READ_VELOCITY_PID_M1,
            Motor::M2 => commands::READ_VELOCITY_PID_M2,
        };
        let request = Request::Transact {
            id: u64::from(command.number()),
            command: command.number(),
            values: Vec::new(),
        };
        ask(device, request)?;
        let values = wait(device, interrupt, |event| match event {
            Event::Transacted { result, .. } => Some(result),
            _ => None,
        })?
        .map_err(|failure| Exit::Refused.saying(failure))?;
        let reply = command.reply(values).ok_or(Exit::Refused)?;
        slowest = slowest.min(u32::try_from(reply.int(QPPS)).unwrap_or(0));
    }
    if slowest == 0 {
        return Err(Exit::Refused.saying(
            "The motor's QPPS is 0, so a position move would not move. Give --speed-limit or set QPPS first.",
        ));
    }
    Ok(slowest)
}
