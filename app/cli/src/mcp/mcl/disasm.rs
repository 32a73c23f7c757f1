//! `brushwork mcl disasm`: the instructions of scripts and images.

use crate::messages::CliScriptMessage;
use std::path::Path;

use brushwork_script::disassembly::disassemble;
use brushwork_script::image;
use brushwork_script::mcl;
use brushwork_script::program::Program;

use super::args::DisasmArgs;
use crate::scripts::{Source, read_bytes};
use crate::{Exit, Output};

/// Lists every file.
pub fn run(args: &DisasmArgs, out: &mut Output) -> Result<Exit, Exit> {
    for path in &args.files {
        let page = list(path)?;
        match args.files.len() {
            1 => out.line(page.trim_end())?,
            _ => out.line(format!("; {}\n{}", path.display(), page.trim_end()))?,
        }
    }
    Ok(Exit::Done)
}

fn list(path: &Path) -> Result<String, Exit> {
    let bytes = read_bytes(path).map_err(|error| Exit::Failed.saying(error))?;
    if let Some(program) = program_in(&bytes, path)? {
        return Ok(disassemble(&program, None));
    }
    let source = Source::of(path.display().to_string(), bytes);
    let compiled = mcl::compile(&source.text);
    match &compiled.program {
        Some(program) => Ok(disassemble(program, Some(&source.text))),
        None => Err(Exit::ScriptWrong.saying(source.rendered(&compiled.diagnostics).trim_end())),
    }
}

/// The program in a file that holds an image, with or without the header for people.
pub fn program_in(bytes: &[u8], path: &Path) -> Result<Option<Program>, Exit> {
    let image = image::of_file(bytes).or_else(|| bytes.starts_with(&image::MAGIC).then_some(bytes));
    let failed = |error: image::ImageError| {
        Exit::Failed
            .saying(CliScriptMessage::NotRead { file: path.display().to_string(), error: error.to_string() })
    };
    image.map(image::decode).transpose().map_err(failed)
}
