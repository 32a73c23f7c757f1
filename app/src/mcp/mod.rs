//! What is measured of an MCP or RoboClaw: link, stop, simulator, scripts.

mod link;
mod mcl;
mod sim;
mod stop;

use brushwork_link::FamilyChoice;
use brushwork_link::transport::Stream;
use brushwork_mcp_client::MCP;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_plant::machine::StreamIndex;

use crate::bench::Measure;
use crate::bench::arguments::BenchArg;
use crate::bench::rig::Far;

/// The stream that is served: one whose rate counts.
const SERVED: StreamIndex = StreamIndex::Uart1;

/// A unit of this model and generation whose TTL1 stream is set to `rate_bps`.
fn far(model: &str, generation: Generation, rate_bps: u32) -> Result<Far, String> {
    let model = models::lookup(model).ok_or_else(|| format!("there is no model {model}"))?;
    let mut config = ControllerConfig { generation, ..ControllerConfig::of(model) };
    config.set_rate(SERVED, rate_bps);
    let unit = Controller::new(config).map_err(|error| error.to_string())?;
    Ok(Far {
        machine: Box::new(Bus::single(unit, SERVED)),
        index: SERVED,
        stream: Stream::Ttl1,
        family: FamilyChoice::of(MCP),
        address: Address::DEFAULT.get(),
    })
}

/// What is measured, and what measures it.
pub const MEASURES: &[Measure] = &[
    (BenchArg::Link, link::measure),
    (BenchArg::Stop, stop::measure),
    (BenchArg::Sim, |effort, _| sim::measure(effort)),
    (BenchArg::Mcl, |effort, _| mcl::measure(effort)),
];
