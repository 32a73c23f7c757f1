//! What a simulated unit is made of, from what was asked for.

use crate::sim_spec::UnitSpec;
use brushwork_canopen::NodeId;
use brushwork_mcp_sim::controller::ControllerConfig;
use brushwork_plant::presets;

/// What a unit is made of.
pub fn config_of(unit: &UnitSpec, seed: u64) -> ControllerConfig {
    let preset = |index: usize| {
        presets::lookup(&unit.presets[index])
            .expect("the names of presets were checked when the text was read")
    };
    let mut config = ControllerConfig {
        generation: unit.generation,
        address: unit.address,
        world: presets::world_of(preset(0), preset(1), unit.model.wired_pins()),
        seed,
        ..ControllerConfig::of(unit.model)
    };
    if unit.node != NodeId::DEFAULT {
        config.set_node(unit.node);
    }
    config
}
