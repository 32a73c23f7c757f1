//! `brushwork mcl disasm`: the instructions of scripts and images.

use std::path::Path;

use brushwork_script::disassembly::disassemble;
use brushwork_script::image;

use super::args::DisasmArgs;
use super::source::{Source, read_bytes};
use crate::exit::Exit;
use crate::output::Output;

/// Lists every file.
pub fn run(args: &DisasmArgs, out: &mut Output) -> Exit {
    for path in &args.files {
        let listed = list(path).map(|page| match args.files.len() {
            1 => page,
            _ => format!("; {}\n{page}", path.display()),
        });
        match listed {
            Ok(page) => {
                if let Err(error) = out.line(page.trim_end()) {
                    return error.into();
                }
            }
            Err(exit) => return exit,
        }
    }
    Exit::Done
}

fn list(path: &Path) -> Result<String, Exit> {
    let bytes = read_bytes(path).map_err(|error| Exit::Failed.saying(error))?;
    if let Some(image) = image_of(&bytes) {
        let program = image::decode(image)
            .map_err(|error| Exit::Failed.saying(format!("Could not read {}: {error}.", path.display())))?;
        return Ok(disassemble(&program, None));
    }
    let source = Source::of(path.display().to_string(), bytes);
    let compiled = source.compile();
    match &compiled.program {
        Some(program) => Ok(disassemble(program, Some(&source.text))),
        None => Err(Exit::ScriptWrong.saying(source.rendered(&compiled).trim_end())),
    }
}

/// The image in a file, with or without the header for people.
pub fn image_of(bytes: &[u8]) -> Option<&[u8]> {
    image::of_file(bytes).or_else(|| bytes.starts_with(&image::MAGIC).then_some(bytes))
}
