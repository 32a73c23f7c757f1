//! `brushwork eds`: the electronic data sheet of a controller as a node of a CANopen bus.

use crate::messages::CliFirmwareMessage;
use std::path::PathBuf;

use brushwork_mcp_wire::canopen::data_sheet;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use clap::Args;

use crate::{Exit, Interrupt, NewFile, Output, Replace};

/// Arguments of `brushwork eds`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork eds --model mcp266 --generation 4 --output mcp266.eds\n  \
    brushwork eds --model mcp263 | less\n\n\
    Python's canopen reads it: canopen.RemoteNode(3, \"mcp266.eds\").sdo[\"Read main battery\"].raw")]
pub struct EdsArgs {
    /// The model.
    #[arg(long, value_name = "MODEL", default_value = "mcp266")]
    pub model: String,
    /// The firmware generation.
    #[arg(long, value_name = "1..4", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=4))]
    pub generation: u8,
    /// Where it is written; without it, to standard output.
    #[arg(long, short = 'o', value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Whether an older file is replaced.
    #[command(flatten)]
    pub replace: Replace,
}

/// Makes it.
pub fn run(args: &EdsArgs, out: &mut Output, _: &Interrupt) -> Result<Exit, Exit> {
    let model = models::lookup(&args.model)
        .ok_or_else(|| Exit::Usage.saying(CliFirmwareMessage::NoModel { name: args.model.to_string() }))?;
    let generation = Generation::from_number(args.generation).unwrap_or(Generation::Gen1);
    let sheet = data_sheet(model, generation)
        .ok_or_else(|| Exit::Usage.saying(CliFirmwareMessage::NoCanPort { model: model.name }))?;
    match &args.output {
        Some(path) => {
            NewFile::new(path, args.replace).write(sheet.as_bytes())?;
            out.line(format!("{} is the data sheet of an {} ({generation}).", path.display(), model.name))?;
        }
        None => out.line(sheet.trim_end())?,
    }
    Ok(Exit::Done)
}
