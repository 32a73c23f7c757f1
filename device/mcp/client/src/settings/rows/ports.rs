//! Serial streams and the CAN and I2C buses that share their pins (MCP manual 1.9.3 to 1.9.7).

use brushwork_mcp_wire::codes::STREAM_TYPES;
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::Unit;

use crate::settings::rows::scales::{GEN1, GEN2, GEN3, GEN4, U32_STEPS};
use crate::settings::template::{DefaultValue, Form, Limits, Repeat, Template, mcp, settings};
use brushwork_link::settings::Group;

pub(crate) static ROWS: &[Template] = settings! {
    mcp("stream.{n}.type", "Mode", Group::STREAMS).per(Repeat::Streams).choice(STREAM_TYPES)
        .assumed_default(DefaultValue::StreamType);
        [stream(&["type"])]
        "Who uses this port: packet serial commands, or the user's script. With UART0 disabled its pins \
         are CAN, with UART1 disabled I2C, with UART2 or UART3 disabled digital inputs. MCP manual 1.9.3 \
         to 1.9.7, command 145.";
    mcp("stream.{n}.rate", "Rate", Group::STREAMS).per(Repeat::Streams)
        .int(Unit::BitsPerSecond, Limits::Between(300.0, 1_000_000.0)).default(DefaultValue::Int(115_200));
        [stream(&["rate"])]
        "Bit rate of the port; without meaning on USB. MCP manual 1.9.5, command 145.";
    mcp("stream.{n}.timeout", "Priority time-out", Group::STREAMS).per(Repeat::Streams)
        .int(Unit::Milliseconds, U32_STEPS).default(DefaultValue::Int(1000));
        [stream(&["timeout"])]
        "After this long without a byte the port counts as silent and the next priority level takes over. \
         It is what stops the motors when the computer dies, so arming refuses while it is 0. MCP manual \
         1.9.3, command 145.";
    mcp("stream.{n}.multi_unit", "Multi-unit mode", Group::STREAMS).per(Repeat::TtlStreams)
        .default(DefaultValue::Bool(false));
        [Form::hidden("No packet serial command for multi-unit mode is public: command 145 carries type, \
         rate and time-out only.")]
        "Makes the output open drain, so that several controllers can share one receive line with a \
         pull-up resistor of 1 to 10 kOhm. MCP manual 1.9.7.";
    mcp("can.rate", "CANopen rate", Group::BUSES)
        .int(Unit::BitsPerSecond, Limits::Between(10_000.0, 1_000_000.0))
        .default(DefaultValue::Int(250_000));
        [Form::hidden("No packet serial command for the CANopen rate is public.")]
        "Bit rate of the CAN bus: 1000000, 800000, 500000, 250000, 125000, 100000, 50000, 20000 or 10000. \
         MCP manual 1.9.4.";
    mcp("can.node_id", "CANopen node", Group::BUSES).int(Unit::None, Limits::Between(1.0, 127.0))
        .assumed_default(DefaultValue::Int(1));
        [Form::hidden("No packet serial command of this firmware generation carries the CANopen node; \
         later ones have 150.").only(GEN1, GEN2),
         Form::field(&[number::READ_NODE_ID], &[number::SET_NODE_ID], &["node_id"]).only(GEN3, GEN4)]
        "The number of this controller on the CANopen bus. MCP manual 1.9.4; public clients, 2018-2025, \
         command 150.";
    mcp("i2c.rate", "I2C rate", Group::BUSES)
        .int(Unit::BitsPerSecond, Limits::Between(100_000.0, 1_000_000.0))
        .default(DefaultValue::Int(100_000));
        [Form::hidden("No packet serial command for the I2C rate is public.")]
        "Bit rate of the I2C bus, which only the user's script uses: 100000, 400000 or 1000000. MCP \
         manual 1.9.6.";
};

const fn stream(fields: &'static [&'static str]) -> Form {
    Form::record(&[number::READ_STREAMS], &[number::SET_STREAM], fields)
}
