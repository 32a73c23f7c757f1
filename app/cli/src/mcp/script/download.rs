//! `brushwork script download`.

use crate::messages::CliScriptMessage;
use std::path::Path;

use brushwork_link::{Identity, PollRate};
use brushwork_mcp_client::messages::McpActMessage;
use brushwork_mcp_client::script::{Downloaded, Origin, ScriptImage, Verified, download};
use brushwork_script::diagnostic::Severity;
use brushwork_script::image;
use brushwork_script::mcl;
use serde_json::json;

use super::args::DownloadArgs;
use crate::scripts::{Source, read_bytes};
use crate::work;
use crate::{Client, Exit, Interrupt, Output, say};

/// Downloads and tells how far it is known to have arrived.
pub fn run(args: &DownloadArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let image = image_of(&args.file)?;
    let client = Client::connect(&args.connect, PollRate::Off, interrupt)?;
    let done = to_unit(&client, &client.identity, image, args.simulated, interrupt)?;
    let printed = if args.json { print_json(&done, out) } else { out.line(sentence(&done)) };
    printed?;
    if !args.json {
        warnings(&done).into_iter().for_each(say);
    }
    Ok(Exit::Done)
}

/// The image in a compiled file, or of a script that is compiled here.
pub fn image_of(file: &Path) -> Result<ScriptImage, Exit> {
    let bytes = read_bytes(file).map_err(|error| Exit::Failed.saying(error))?;
    let is_text = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcl"));
    let bytes = if is_text { compiled(file, bytes)? } else { bytes };
    ScriptImage::from_file(&bytes).map_err(|error| {
        Exit::Failed
            .saying(CliScriptMessage::NotUsed { file: file.display().to_string(), error: error.to_string() })
    })
}

fn compiled(file: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, Exit> {
    let source = Source::of(file.display().to_string(), bytes);
    let mut compiled = mcl::compile(&source.text);
    compiled.diagnostics.retain(|said| said.severity() == Severity::Error);
    let said = source.rendered(&compiled.diagnostics);
    if !said.is_empty() {
        say(said.trim_end());
    }
    let program = compiled.program.ok_or(Exit::ScriptWrong)?;
    Ok(image::to_file(&image::encode(&program)))
}

/// Downloads to the selected one of a link's controllers.
pub fn to_unit(
    client: &Client,
    unit: &Identity,
    image: ScriptImage,
    simulated_elsewhere: bool,
    interrupt: &Interrupt,
) -> Result<Downloaded, Exit> {
    let is_refused = image.origin() == Origin::Own && !unit.simulated && !simulated_elsewhere;
    let limit = image.download_limit();
    let finished = work::run(client, McpActMessage::DownloadScript, limit, interrupt, move |wire| {
        let is_simulated = wire.is_simulated() || simulated_elsewhere;
        download(wire, &image, is_simulated)
    })?;
    match (finished.value, finished.broken) {
        (Ok(done), None) => Ok(done),
        (Err(failure), broken) => {
            Err(broken.unwrap_or(if is_refused { Exit::Refused } else { Exit::Failed }).saying(failure))
        }
        (Ok(_), Some(exit)) => Err(exit),
    }
}

fn sentence(done: &Downloaded) -> String {
    let verified = match done.verified {
        Verified::Content => "the controller holds exactly that".to_owned(),
        Verified::Status => "every block was answered with \"done\"".to_owned(),
        Verified::Alike(status) => {
            format!("every block was acknowledged with status {status:02X}; no command reads it back")
        }
    };
    let seconds = done.took.as_secs_f64();
    format!("Downloaded {} bytes in {} blocks ({seconds:.1} s): {verified}.", done.bytes, done.blocks)
}

fn warnings(done: &Downloaded) -> Vec<String> {
    let autorun = done.autorun.map(|delay| {
        format!("Autorun is on: the controller runs it {} ms after its next power-up.", delay.as_millis())
    });
    let foreign = done.is_foreign.then(|| {
        "It is no image of Brushwork's compiler: what is in it is not public, and simulated controllers do not run it.".to_owned()
    });
    autorun.into_iter().chain(foreign).collect()
}

fn print_json(done: &Downloaded, out: &mut Output) -> Result<(), crate::output::OutputError> {
    let (verified, status) = match done.verified {
        Verified::Content => ("content", None),
        Verified::Status => ("status", Some(0xFF)),
        Verified::Alike(status) => ("acknowledged", Some(status)),
    };
    out.json(&json!({
        "bytes": done.bytes,
        "blocks": done.blocks,
        "took_s": done.took.as_secs_f64(),
        "verified": verified,
        "status": status,
        "autorun_delay_ms": done.autorun.map(|delay| delay.as_millis() as u64),
        "warnings": warnings(done),
    }))
}
