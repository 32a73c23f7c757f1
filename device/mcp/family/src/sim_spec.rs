//! What simulated controllers to make: the text behind `sim:` and the arguments of `brushwork sim`.

use std::fmt;

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::Model;
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_values::parse_byte;

/// One line with one or more simulated controllers on it.
#[derive(Debug, Clone, PartialEq)]
pub struct SimSpec {
    /// The units, in the order of their addresses as given.
    pub units: Vec<UnitSpec>,
    /// Seed of noise and faults.
    pub seed: u64,
    /// The units are nodes of a CAN bus, behind an adapter of this form.
    pub can: Option<Form>,
    /// What the served port is set to; none for the rate that it leaves the factory with.
    pub rate_bps: Option<u32>,
}

/// One simulated controller.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitSpec {
    /// Its model.
    pub model: &'static Model,
    /// Firmware generation.
    pub generation: Generation,
    /// Address on the line.
    pub address: Address,
    /// Preset of motor 1 and motor 2.
    pub presets: [String; 2],
    /// Its node id on a CAN bus.
    pub node: NodeId,
}

/// Text that describes no simulated controller.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SimSpecError {
    /// No such model.
    #[error("\"{given}\" is no simulated model. There are {known}")]
    Model {
        /// As given.
        given: String,
        /// All models.
        known: String,
    },
    /// No such preset.
    #[error("\"{given}\" is no motor preset. There are {known}")]
    Preset {
        /// As given.
        given: String,
        /// All presets.
        known: String,
    },
    /// An option that does not exist.
    #[error(
        "\"{given}\" is no option of a simulated controller. There are generation=1..4, preset=NAME, address=0x80..0x87, seed=N, can or can=binary, and node=1..127"
    )]
    Option {
        /// As given.
        given: String,
    },
    /// A value out of range.
    #[error("\"{given}\" is no {what}. Use {range}")]
    Value {
        /// What the option sets.
        what: &'static str,
        /// As given.
        given: String,
        /// What may be given.
        range: &'static str,
    },
    /// Two units on one address.
    #[error(
        "two simulated controllers are given the address {address}; units on one line need different ones"
    )]
    SameAddress {
        /// The address.
        address: Address,
    },
    /// Lists of different lengths.
    #[error("{models} models are given for {addresses} addresses; give one model, or one for each address")]
    Counts {
        /// Number of models.
        models: usize,
        /// Number of addresses.
        addresses: usize,
    },
    /// More presets than motors.
    #[error("{given} presets are given; a controller has two motors")]
    Presets {
        /// How many.
        given: usize,
    },
}

/// What both ways of writing it have in common, as text.
#[derive(Debug, Clone)]
pub struct SimOptions<'a> {
    /// One model for all units, or one for each.
    pub models: Vec<&'a str>,
    /// Firmware generation 1 to 4.
    pub generation: u8,
    /// None, one for both motors, or one for each.
    pub presets: Vec<&'a str>,
    /// At least one address.
    pub addresses: Vec<u8>,
    /// Seed of noise and faults.
    pub seed: u64,
    /// The units are nodes of a CAN bus, behind an adapter of this form.
    pub can: Option<Form>,
    /// Node ids on the CAN bus, one unit for each; none means one unit with the id it leaves the factory with.
    pub nodes: Vec<u8>,
    /// What the served port is set to.
    pub rate_bps: Option<u32>,
}

impl SimSpec {
    /// Reads the text behind `sim:`, for example `mcp266,generation=4,preset=flywheel`.
    ///
    /// # Errors
    /// A sentence that names the part at fault and what may stand there.
    pub fn parse(text: &str) -> Result<Self, SimSpecError> {
        let mut parts = text.split(',').map(str::trim);
        let model = parts.next().filter(|name| !name.is_empty()).unwrap_or("mcp266");
        let mut options = SimOptions {
            models: vec![model],
            generation: 1,
            presets: vec![],
            addresses: vec![],
            seed: 1,
            can: None,
            nodes: vec![],
            rate_bps: None,
        };
        for part in parts {
            if part == "can" {
                options.can = Some(Form::default());
                continue;
            }
            let Some((key, value)) = part.split_once('=') else {
                return Err(SimSpecError::Option { given: part.to_owned() });
            };
            set_option(&mut options, key.trim(), value.trim())?;
        }
        if options.addresses.is_empty() {
            options.addresses.push(0x80);
        }
        Self::from_options(&options)
    }

    /// Checks names, counts and ranges.
    ///
    /// # Errors
    /// A sentence that names the part at fault and what may stand there.
    pub fn from_options(options: &SimOptions<'_>) -> Result<Self, SimSpecError> {
        if options.can.is_some() {
            return Self::on_can(options);
        }
        let (n_models, n_addresses) = (options.models.len(), options.addresses.len());
        if n_models != 1 && n_models != n_addresses {
            return Err(SimSpecError::Counts { models: n_models, addresses: n_addresses });
        }
        let generation = Generation::from_number(options.generation).ok_or_else(|| SimSpecError::Value {
            what: "firmware generation",
            given: options.generation.to_string(),
            range: "1 to 4",
        })?;
        let presets = presets_of(&options.presets)?;
        let mut units: Vec<UnitSpec> = Vec::new();
        for (index, &number) in options.addresses.iter().enumerate() {
            let model = model_of(options.models[if n_models == 1 { 0 } else { index }])?;
            let address = Address::new(number).ok_or_else(|| bad_address(&format!("{number:#04x}")))?;
            if units.iter().any(|unit| unit.address == address) {
                return Err(SimSpecError::SameAddress { address });
            }
            units.push(UnitSpec {
                model,
                generation,
                address,
                presets: presets.clone(),
                node: NodeId::DEFAULT,
            });
        }
        let rate_bps = options.rate_bps.map(rate_of).transpose()?;
        Ok(Self { units, seed: options.seed, can: None, rate_bps })
    }

    /// Units on a CAN bus: told apart by their node ids, all at the address they leave the factory with.
    fn on_can(options: &SimOptions<'_>) -> Result<Self, SimSpecError> {
        let nodes =
            if options.nodes.is_empty() { vec![NodeId::DEFAULT.get()] } else { options.nodes.clone() };
        let mut units: Vec<UnitSpec> = Vec::new();
        for (index, id) in nodes.iter().enumerate() {
            let name =
                if options.models.len() == nodes.len() { options.models[index] } else { options.models[0] };
            let alone = SimOptions {
                models: vec![name],
                addresses: vec![0x80],
                can: None,
                nodes: vec![],
                ..options.clone()
            };
            let node = NodeId::new(*id).filter(|node| units.iter().all(|unit| unit.node != *node));
            let node = node.ok_or_else(|| bad_node(&id.to_string()))?;
            units.extend(Self::from_options(&alone)?.units.into_iter().map(|unit| UnitSpec { node, ..unit }));
        }
        Ok(Self { units, seed: options.seed, can: options.can, rate_bps: None })
    }
}

impl fmt::Display for SimSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, unit) in self.units.iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            let place = if self.can.is_some() { unit.node.to_string() } else { unit.address.to_string() };
            write!(f, "{comma}{} at {place} ({})", unit.model.name, unit.generation)?;
        }
        Ok(())
    }
}

fn set_option<'a>(options: &mut SimOptions<'a>, key: &str, value: &'a str) -> Result<(), SimSpecError> {
    let bad = |what, range| SimSpecError::Value { what, given: value.to_owned(), range };
    match key {
        "generation" => {
            options.generation = value.parse().map_err(|_| bad("firmware generation", "1 to 4"))?;
        }
        "preset" => options.presets = value.split('/').collect(),
        "address" => {
            let parsed = parse_address(value).map_err(|_| bad_address(value))?;
            options.addresses.push(parsed);
        }
        "can" => {
            options.can =
                Some(Form::from_key(value).ok_or_else(|| bad("form of a CAN adapter", "ascii or binary"))?);
        }
        "node" => options.nodes.push(value.parse().map_err(|_| bad_node(value))?),
        "seed" => options.seed = value.parse().map_err(|_| bad("seed", "a whole number"))?,
        _ => return Err(SimSpecError::Option { given: key.to_owned() }),
    }
    Ok(())
}

/// Reads an address, 0x80 to 0x87, in hexadecimal or decimal.
///
/// # Errors
/// A sentence that says what an address is.
pub fn parse_address(text: &str) -> Result<u8, String> {
    match parse_byte(text) {
        Some(address @ 0x80..=0x87) => Ok(address),
        _ => Err(format!("\"{text}\" is no address: use 0x80 to 0x87 (128 to 135)")),
    }
}

/// The rates that public clients and the configuration word know, and what the manual allows around them (MCP manual 2.2.1).
fn rate_of(rate_bps: u32) -> Result<u32, SimSpecError> {
    let range = "300 to 1000000";
    let is_one = (300..=1_000_000).contains(&rate_bps);
    is_one.then_some(rate_bps).ok_or_else(|| SimSpecError::Value {
        what: "baud rate",
        given: rate_bps.to_string(),
        range,
    })
}

fn bad_node(given: &str) -> SimSpecError {
    let range = "1 to 127, each once";
    SimSpecError::Value { what: "node id", given: given.to_owned(), range }
}

fn bad_address(given: &str) -> SimSpecError {
    SimSpecError::Value { what: "address", given: given.to_owned(), range: "0x80 to 0x87" }
}

fn model_of(name: &str) -> Result<&'static Model, SimSpecError> {
    models::lookup(name).ok_or_else(|| SimSpecError::Model {
        given: name.to_owned(),
        known: models::MODELS.iter().map(|model| model.key).collect::<Vec<_>>().join(", "),
    })
}

fn presets_of(names: &[&str]) -> Result<[String; 2], SimSpecError> {
    let check = |name: &str| {
        brushwork_plant::presets::lookup(name).map(|preset| preset.key.clone()).ok_or_else(|| {
            SimSpecError::Preset {
                given: name.to_owned(),
                known: brushwork_plant::presets::keys().join(", "),
            }
        })
    };
    match names {
        [] => {
            Ok([brushwork_plant::presets::DEFAULT.to_owned(), brushwork_plant::presets::DEFAULT.to_owned()])
        }
        [both] => Ok([check(both)?, check(both)?]),
        [first, second] => Ok([check(first)?, check(second)?]),
        more => Err(SimSpecError::Presets { given: more.len() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_but_the_scheme_means_one_mcp266_at_0x80() {
        let spec = SimSpec::parse("").unwrap();
        assert_eq!(spec.units.len(), 1);
        assert_eq!(spec.units[0].model.key, "mcp266");
        assert_eq!(spec.to_string(), "MCP266 at 0x80 (generation 1)");
    }

    #[test]
    fn options_are_read_and_two_units_share_a_line() {
        let spec = SimSpec::parse("mcp266,generation=4,address=0x80,address=129,seed=7").unwrap();
        let addresses: Vec<u8> = spec.units.iter().map(|unit| unit.address.get()).collect();
        assert_eq!((addresses, spec.seed), (vec![0x80, 0x81], 7));
        assert_eq!(spec.units[0].generation, Generation::Gen4);
    }

    #[test]
    fn nodes_of_a_can_bus_are_told_apart_by_their_ids() {
        let spec = SimSpec::parse("mcp266,can=binary,node=3,node=5").unwrap();
        assert_eq!(spec.can, Some(Form::Binary));
        assert_eq!(spec.to_string(), "MCP266 at node 3 (generation 1), MCP266 at node 5 (generation 1)");
        assert_eq!(SimSpec::parse("mcp266,can").unwrap().to_string(), "MCP266 at node 1 (generation 1)");
    }

    #[test]
    fn what_is_wrong_is_named_together_with_what_would_be_right() {
        for (text, named) in [
            ("mcp999", "mcp266"),
            ("mcp266,generation=9", "1 to 4"),
            ("mcp266,preset=nothing", "gearmotor"),
            ("mcp266,address=7", "0x80 to 0x87"),
            ("mcp266,colour=red", "seed=N"),
            ("mcp266,can=slcan", "ascii or binary"),
            ("mcp266,can,node=0", "1 to 127"),
            ("mcp266,can,node=3,node=3", "each once"),
            ("mcp266,address=0x80,address=0x80", "0x80"),
        ] {
            let error = SimSpec::parse(text).unwrap_err().to_string();
            assert!(error.contains(named), "{text}: {error}");
        }
    }
}
