//! `brushwork firmware info`: what is installed and what is known about it.

use brushwork_link::device::PollRate;
use brushwork_mcp_client::{MCP, layout_of};
use brushwork_mcp_wire::loader::image_sizes;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::known::{Quirk, generation_text, quirks};
use serde_json::json;

use super::args::InfoArgs;
use crate::{Client, Exit, Interrupt, Output};

/// Connects and prints.
pub fn run(args: &InfoArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let client = Client::connect(&args.connect, PollRate::Off, interrupt)?;
    let identity = &client.identity;
    let family = models::identify(&identity.version_text).map(|model| model.family);
    // What is known is of this family's firmware; of another one it would be nonsense.
    let known: Vec<&Quirk> = match identity.family == MCP {
        true => quirks(family, layout_of(identity.generation), &identity.firmware).collect(),
        false => Vec::new(),
    };
    let sizes = family.map(image_sizes).unwrap_or_default();
    if args.json {
        out.json(&json!({
            "identity": identity,
            "generation": generation_text(layout_of(identity.generation)),
            "known": known,
            "image_bytes": sizes,
        }))?;
        return Ok(Exit::Done);
    }
    out.line(format!("Installed:   {}", identity.version_text))?;
    out.line(format!("Model:       {}", identity.model.unwrap_or("not known")))?;
    out.line(format!(
        "Generation:  {}. {}",
        identity.generation.number(),
        generation_text(layout_of(identity.generation))
    ))?;
    out.lines(identity.notes.iter().map(|note| format!("             {note}")))?;
    let sizes: Vec<_> = sizes.iter().map(ToString::to_string).collect();
    out.line(format!(
        "Update:      from a file of yours of {} bytes; no image is published",
        sizes.join(" or ")
    ))?;
    out.line("")?;
    let rows: Vec<Vec<String>> = known
        .iter()
        .map(|quirk| vec![quirk.topic.to_owned(), quirk.text.to_owned(), quirk.source.to_owned()])
        .collect();
    out.table(&["ABOUT", "WHAT IS KNOWN", "FROM"], &rows)?;
    Ok(Exit::Done)
}
