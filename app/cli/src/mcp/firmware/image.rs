//! `brushwork firmware image`: an image for simulated controllers.

use crate::messages::CliFirmwareMessage;
use brushwork_mcp_wire::loader::SimulatedImage;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;

use super::args::ImageArgs;
use crate::{Exit, NewFile, Output};

/// Writes the image.
pub fn run(args: &ImageArgs, out: &mut Output) -> Result<Exit, Exit> {
    let model = models::lookup(&args.model)
        .ok_or_else(|| Exit::Usage.saying(CliFirmwareMessage::NoModel { name: args.model.to_string() }))?;
    let generation = Generation::from_number(args.generation).unwrap_or(Generation::Gen1);
    let image = SimulatedImage { model, version: args.version.clone(), generation };
    let bytes = image
        .bytes()
        .map_err(|error| Exit::Usage.saying(CliFirmwareMessage::NoImage { error: error.to_string() }))?;
    NewFile::new(&args.file, args.replace).write(&bytes)?;
    out.line(format!(
        "{} holds {} bytes that make a simulated {} report version {} ({generation}). No real controller can use them.",
        args.file.display(),
        bytes.len(),
        model.name,
        args.version
    ))?;
    Ok(Exit::Done)
}
