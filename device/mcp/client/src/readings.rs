//! What an MCP or RoboClaw tells a job, by packet serial's own commands.

use crate::TypedWire;
use crate::family::layout_of;
use crate::packet::typed_reply;
use brushwork_link::device::{JobContext, Power, Readings};
use brushwork_link::exchange::{ExchangeError, Span};
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::status::{self, Condition};
use brushwork_mcp_wire::packet_serial::{commands, number};
use brushwork_values::Motor;

/// The readings of packet serial.
#[derive(Clone, Copy, Debug)]
pub struct McpReadings;

impl Readings for McpReadings {
    fn encoders(&self, context: &mut JobContext<'_>) -> Result<([i32; 2], Span), ExchangeError> {
        let reply = context.transact_timed(commands::READ_ENCODERS.number(), &[])?;
        let reply = typed_reply(reply, commands::READ_ENCODERS)?;
        // The count is a 32 bit pattern.
        Ok(([reply.values.int(ENCODER_M1) as i32, reply.values.int(ENCODER_M2) as i32], reply.span))
    }

    fn power(&self, context: &mut JobContext<'_>, motor: Motor) -> Result<Power, ExchangeError> {
        let duties = context.ask(commands::READ_PWMS, &[])?;
        let currents = context.ask(commands::READ_CURRENTS, &[])?;
        Ok(Power {
            duty: [duties.physical(DUTY_M1), duties.physical(DUTY_M2)][motor.index()] / 100.0,
            amps: [currents.physical(CURRENT_M1), currents.physical(CURRENT_M2)][motor.index()],
            volts: self.battery(context)?,
        })
    }

    fn speed(&self, context: &mut JobContext<'_>, motor: Motor) -> Result<f64, ExchangeError> {
        let commands = [commands::READ_SPEED_M1, commands::READ_SPEED_M2];
        Ok(context.ask(commands[motor.index()], &[])?.physical(SPEED))
    }

    fn battery(&self, context: &mut JobContext<'_>) -> Result<f64, ExchangeError> {
        Ok(context.ask(commands::READ_MAIN_BATTERY, &[])?.physical(MAIN_BATTERY))
    }

    /// While it lasts the controller brakes the motors by itself (MCP manual 1.6.3).
    fn is_battery_high(&self, context: &mut JobContext<'_>) -> Result<bool, ExchangeError> {
        let word = u32::try_from(context.ask(commands::READ_STATUS, &[])?.int(STATUS)).unwrap_or(0);
        let conditions = status::decode(word, layout_of(context.generation()));
        let high = [Condition::MainBatteryHighWarning, Condition::MainBatteryHighError];
        Ok(high.into_iter().any(|condition| conditions.contains(condition)))
    }

    /// With L and R both set (MCP manual 1.2.11). A RoboClaw may have neither and refuse the question.
    fn is_torque_mode(&self, context: &mut JobContext<'_>, motor: Motor) -> Result<bool, ExchangeError> {
        let commands = [number::READ_INDUCTANCE_RESISTANCE_M1, number::READ_INDUCTANCE_RESISTANCE_M2];
        match context.transact(commands[motor.index()], &[]) {
            Ok(values) => Ok(values.ints().all(|value| value != 0)),
            Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
            Err(_) => Ok(false),
        }
    }
}
